/* Containers of time responses. */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const ritz_text_member members[] = {
    {"method", offsetof(ritz_simulation, integrator)},
    {"hold", offsetof(ritz_simulation, hold)},
    {NULL, 0},
};

/* What there may be of energies: all of them or none. */
static const struct energy {
    const char *name;
    size_t offset; /* of its double * */
} energies[] = {
    {"kinetic", offsetof(ritz_simulation, kinetic)},
    {"potential", offsetof(ritz_simulation, potential)},
    {"dissipated", offsetof(ritz_simulation, dissipated)},
    {"work", offsetof(ritz_simulation, work)},
    {"balance", offsetof(ritz_simulation, balance)},
};

enum { NUM_ENERGIES = sizeof energies / sizeof *energies };

static ritz_status write_energies(hid_t file, const ritz_simulation *s)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;

    if (!s->balance)
        return RITZ_OK;
    RITZ_TRY(ritz_h5_group(file, "energies", &group));
    for (int k = 0; k < NUM_ENERGIES; k++)
        RITZ_TRY(ritz_h5_write(
            group, energies[k].name, H5T_IEEE_F64LE, ritz_h5_vector(s->count),
            *(double *const *)((const char *)s + energies[k].offset)));
done:
    ritz_h5_close(group);
    return ritz_context(status, "energies");
}

static ritz_status read_energies(hid_t file, ritz_simulation *s)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;

    if (!ritz_h5_has(file, "energies"))
        return RITZ_OK;
    RITZ_TRY(ritz_h5_enter(file, "energies", &group));
    for (int k = 0; k < NUM_ENERGIES; k++) {
        double **place = (double **)((char *)s + energies[k].offset);

        RITZ_NEW(*place, s->count);
        RITZ_TRY(ritz_h5_read_real(group, energies[k].name,
                                   ritz_h5_vector(s->count), false, *place));
    }
done:
    ritz_h5_close(group);
    return ritz_context(status, "energies");
}

/* A table of seconds x names, looked at before anything is allocated. */
static ritz_status read_table(hid_t file, const char *name, int64_t rows,
                              int64_t columns, double **out)
{
    ritz_h5_shape found = {0};

    RITZ_CHECK(ritz_h5_shape_of(file, name, 2, &found));
    RITZ_REFUSE_IF(found.dims[0] != (hsize_t)rows ||
                       found.dims[1] != (hsize_t)columns,
                   RITZ_ERR_FORMAT, "'%s' does not fit times and names", name);
    RITZ_CHECK_NEW(*out, rows * columns);
    return ritz_h5_read_real(file, name, found, false, *out);
}

static ritz_status read_all(hid_t file, ritz_simulation *s)
{
    RITZ_CHECK(ritz_part_get_members(file, members, s));
    RITZ_CHECK(
        ritz_h5_get_text(file, "damping", sizeof s->damping, s->damping));
    RITZ_CHECK(ritz_part_get_real(file, "step", false, 1, &s->step));
    RITZ_CHECK(ritz_part_get_size(file, "order", 0, INT64_MAX, &s->order));
    RITZ_CHECK(ritz_h5_count(file, "seconds", &s->count));
    RITZ_CHECK_NEW(s->seconds, s->count);
    RITZ_CHECK(ritz_h5_read_real(file, "seconds", ritz_h5_vector(s->count),
                                 false, s->seconds));
    for (int64_t k = 1; k < s->count; k++)
        RITZ_REFUSE_IF(s->seconds[k] <= s->seconds[k - 1], RITZ_ERR_FORMAT,
                       "'seconds' does not ascend at value %" PRId64, k + 1);
    RITZ_CHECK(
        ritz_part_read_group_names(file, "inputs", &s->num_inputs, &s->input));
    RITZ_CHECK(ritz_part_read_group_names(file, "outputs", &s->num_outputs,
                                          &s->output));
    RITZ_CHECK(read_table(file, "u", s->count, s->num_inputs, &s->u));
    RITZ_CHECK(read_table(file, "y", s->count, s->num_outputs, &s->y));
    return read_energies(file, s);
}

ritz_status ritz_container_read_simulation(const char *path,
                                           ritz_simulation *out)
{
    ritz_status status = RITZ_OK;
    ritz_simulation s = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_part_open(path, "simulation", &file));
    RITZ_TRY(read_all(file, &s));
    *out = s;
    s = (ritz_simulation){0};
done:
    ritz_simulation_free(&s);
    ritz_h5_close(file);
    return ritz_context(status, path);
}

ritz_status ritz_container_write_simulation(const char *path,
                                            const ritz_simulation *simulation,
                                            const ritz_stamp *stamp)
{
    ritz_status status = RITZ_OK;
    const ritz_simulation *s = simulation;
    ritz_writer writer = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_writer_new(path, "simulation", "", stamp, &writer));
    file = writer.file;
    RITZ_TRY(ritz_part_set_members(file, members, s));
    RITZ_TRY(ritz_h5_set_text(file, "damping", s->damping));
    RITZ_TRY(ritz_part_set_real(file, "step", 1, &s->step));
    RITZ_TRY(ritz_part_set_whole(file, "order", s->order));
    RITZ_TRY(ritz_h5_write(file, "seconds", H5T_IEEE_F64LE,
                           ritz_h5_vector(s->count), s->seconds));
    RITZ_TRY(
        ritz_part_write_group_names(file, "inputs", s->num_inputs, s->input));
    RITZ_TRY(ritz_part_write_group_names(file, "outputs", s->num_outputs,
                                         s->output));
    RITZ_TRY(ritz_h5_write(file, "u", H5T_IEEE_F64LE,
                           ritz_h5_table(s->count, s->num_inputs), s->u));
    RITZ_TRY(ritz_h5_write(file, "y", H5T_IEEE_F64LE,
                           ritz_h5_table(s->count, s->num_outputs), s->y));
    RITZ_TRY(write_energies(file, s));
    RITZ_TRY(ritz_writer_finish(&writer));
done:
    ritz_writer_free(&writer);
    return ritz_context(status, path);
}
