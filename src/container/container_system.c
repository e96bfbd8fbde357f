/* Containers of systems: `blocks`, and `configurations/0`, 1, ... */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const ritz_text_member members[] = {
    {"name", offsetof(ritz_system, name)},
    {NULL, 0},
};

static const ritz_text_member configuration_members[] = {
    {"at", offsetof(ritz_configuration, at)},
    {NULL, 0},
};

/* What each component brings: rows first .. first + order - 1 of q. */
static ritz_status write_blocks(hid_t file, const ritz_system *system)
{
    ritz_status status = RITZ_OK;
    int64_t first = 0;
    ritz_name name = "";
    hid_t blocks = 0;
    hid_t group = 0;

    RITZ_TRY(ritz_h5_group(file, "blocks", &blocks));
    for (int64_t c = 0; c < system->num_components; c++) {
        RITZ_TRY(ritz_name_copy(system->component[c], name));
        RITZ_TRY(ritz_h5_group(blocks, name, &group));
        RITZ_TRY(ritz_part_set_whole(group, "index", c));
        RITZ_TRY(ritz_part_set_whole(group, "first", first));
        RITZ_TRY(ritz_part_set_whole(group, "order", system->order[c]));
        RITZ_TRY(
            ritz_part_set_whole(group, "order_full", system->order_full[c]));
        first += system->order[c];
        ritz_h5_close(group);
        group = 0;
    }
done:
    ritz_h5_close(group);
    ritz_h5_close(blocks);
    return ritz_context(status, "blocks");
}

static ritz_status read_block(hid_t blocks, int64_t due, int64_t c,
                              ritz_system *system)
{
    ritz_status status = RITZ_OK;
    int64_t first = 0;
    hid_t group = 0;

    RITZ_TRY(ritz_h5_enter(blocks, system->component[c], &group));
    RITZ_TRY(ritz_part_get_size(group, "first", due, due, &first));
    RITZ_TRY(
        ritz_part_get_size(group, "order", 0, INT32_MAX, &system->order[c]));
    RITZ_TRY(ritz_part_get_size(group, "order_full", 0, INT64_MAX,
                                &system->order_full[c]));
done:
    ritz_h5_close(group);
    return ritz_context(status, system->component[c]);
}

static ritz_status read_blocks(hid_t file, ritz_system *system)
{
    ritz_status status = RITZ_OK;
    int64_t first = 0;
    hid_t blocks = 0;

    RITZ_TRY(ritz_h5_enter(file, "blocks", &blocks));
    RITZ_TRY(ritz_h5_list(blocks, &system->num_components, &system->component));
    RITZ_NEW(system->order, system->num_components);
    RITZ_NEW(system->order_full, system->num_components);
    for (int64_t c = 0; c < system->num_components; c++) {
        RITZ_TRY(read_block(blocks, first, c, system));
        first += system->order[c];
    }
done:
    ritz_h5_close(blocks);
    return ritz_context(status, "blocks");
}

/* The way back from x to each component: q_c = P_c x. */
static ritz_status write_maps(hid_t at, const ritz_system *system,
                              const ritz_configuration *configuration)
{
    ritz_status status = RITZ_OK;
    hid_t blocks = 0;

    RITZ_FAIL_IF(configuration->num_blocks != system->num_components,
                 RITZ_ERR_ARGUMENT,
                 "%" PRId64 " blocks for %" PRId64 " components",
                 configuration->num_blocks, system->num_components);
    RITZ_TRY(ritz_h5_group(at, "blocks", &blocks));
    for (int64_t c = 0; c < system->num_components; c++)
        RITZ_TRY(ritz_h5_write_dense(blocks, system->component[c],
                                     &configuration->P[c]));
done:
    ritz_h5_close(blocks);
    return status;
}

static ritz_status read_maps(hid_t at, const ritz_system *system,
                             ritz_configuration *configuration)
{
    ritz_status status = RITZ_OK;
    hid_t blocks = 0;

    RITZ_TRY(ritz_h5_enter(at, "blocks", &blocks));
    for (int64_t c = 0; c < system->num_components; c++)
        RITZ_TRY(ritz_h5_read_dense(blocks, system->component[c],
                                    system->order[c], configuration->K.ncol,
                                    &configuration->P[c]));
done:
    ritz_h5_close(blocks);
    return ritz_context(status, "blocks");
}

/* What rigid motions of the whole carry; absent where a body's is not known. */
static ritz_status write_mass(hid_t at, const ritz_configuration *c)
{
    if (!c->momentum.val)
        return RITZ_OK;
    RITZ_CHECK(ritz_h5_write_dense(at, "momentum", &c->momentum));
    return ritz_h5_write(at, "rigid", H5T_IEEE_F64LE, ritz_h5_table(6, 6),
                         c->rigid);
}

static ritz_status read_mass(hid_t at, ritz_configuration *c)
{
    if (!ritz_h5_has(at, "momentum"))
        return RITZ_OK;
    RITZ_CHECK(ritz_h5_read_dense(at, "momentum", 6, c->K.ncol, &c->momentum));
    return ritz_h5_read_real(at, "rigid", ritz_h5_table(6, 6), false, c->rigid);
}

static ritz_status write_configuration(hid_t at, const ritz_system *system,
                                       const ritz_configuration *c)
{
    RITZ_CHECK(ritz_part_set_members(at, configuration_members, c));
    RITZ_CHECK(ritz_part_set_whole(at, "rank", c->rank));
    RITZ_CHECK(ritz_part_set_whole(at, "num_rigid", c->num_rigid));
    RITZ_CHECK(ritz_h5_write(at, "settings", H5T_IEEE_F64LE,
                             ritz_h5_vector(c->num_settings), c->setting));
    RITZ_CHECK(ritz_h5_write_dense(at, "K", &c->K));
    RITZ_CHECK(ritz_h5_write_dense(at, "M", &c->M));
    RITZ_CHECK(ritz_part_write_dense(at, "D", &c->D));
    RITZ_CHECK(ritz_part_write_dense(at, "K4", &c->K4));
    RITZ_CHECK(ritz_part_write_dampers(at, &c->dampers));
    RITZ_CHECK(ritz_h5_write(at, "lambda", H5T_IEEE_F64LE,
                             ritz_h5_vector(c->K.ncol), c->lambda));
    RITZ_CHECK(ritz_part_write_io(at, &c->io));
    RITZ_CHECK(write_maps(at, system, c));
    RITZ_CHECK(write_mass(at, c));
    return ritz_part_write_measures(at, "errors", &c->errors);
}

static ritz_status read_configuration(hid_t at, const ritz_system *system,
                                      ritz_configuration *c)
{
    int64_t e = 0;

    RITZ_CHECK(ritz_part_get_members(at, configuration_members, c));
    RITZ_CHECK(ritz_h5_read_dense(at, "K", -1, -1, &c->K));
    e = c->K.ncol;
    RITZ_REFUSE_IF(c->K.nrow != e, RITZ_ERR_FORMAT, "'K' is not square");
    RITZ_CHECK(ritz_h5_read_dense(at, "M", e, e, &c->M));
    RITZ_CHECK(ritz_part_read_dense(at, "D", e, e, &c->D));
    RITZ_CHECK(ritz_part_read_dense(at, "K4", e, e, &c->K4));
    RITZ_CHECK(ritz_part_read_dampers(at, e, &c->dampers));
    RITZ_CHECK(ritz_part_get_size(at, "rank", 0, INT64_MAX, &c->rank));
    RITZ_CHECK(ritz_part_get_size(at, "num_rigid", 0, e, &c->num_rigid));
    RITZ_CHECK_NEW(c->setting, system->num_sweeps);
    c->num_settings = system->num_sweeps;
    RITZ_CHECK(ritz_h5_read_real(
        at, "settings", ritz_h5_vector(c->num_settings), false, c->setting));
    RITZ_CHECK_NEW(c->lambda, e);
    RITZ_CHECK(
        ritz_h5_read_real(at, "lambda", ritz_h5_vector(e), false, c->lambda));
    RITZ_CHECK(ritz_part_read_io(at, e, &c->io));
    RITZ_CHECK(read_maps(at, system, c));
    RITZ_CHECK(read_mass(at, c));
    return ritz_part_read_measures(at, "errors", &c->errors);
}

static ritz_status write_configurations(hid_t file, const ritz_system *system)
{
    ritz_status status = RITZ_OK;
    char name[24];
    hid_t all = 0;
    hid_t group = 0;

    RITZ_TRY(ritz_h5_group(file, "configurations", &all));
    for (int64_t k = 0; k < system->num_configurations; k++) {
        snprintf(name, sizeof name, "%" PRId64, k);
        RITZ_TRY(ritz_h5_group(all, name, &group));
        RITZ_TRY(ritz_part_set_whole(group, "index", k));
        RITZ_TRY_IN(name, write_configuration(group, system,
                                              &system->configuration[k]));
        ritz_h5_close(group);
        group = 0;
    }
done:
    ritz_h5_close(group);
    ritz_h5_close(all);
    return ritz_context(status, "configurations");
}

static ritz_status read_one(hid_t all, const char *name, ritz_system *system)
{
    ritz_status status = RITZ_OK;
    ritz_configuration *c = &system->configuration[system->num_configurations];
    hid_t group = 0;

    system->num_configurations++;
    RITZ_NEW(c->P, system->num_components);
    c->num_blocks = system->num_components;
    RITZ_TRY(ritz_h5_enter(all, name, &group));
    RITZ_TRY(read_configuration(group, system, c));
done:
    ritz_h5_close(group);
    return ritz_context(status, name);
}

static ritz_status read_configurations(hid_t file, ritz_system *system)
{
    ritz_status status = RITZ_OK;
    ritz_name *name = NULL;
    int64_t count = 0;
    hid_t all = 0;

    RITZ_TRY(ritz_h5_enter(file, "configurations", &all));
    RITZ_TRY(ritz_h5_list(all, &count, &name));
    RITZ_NEW(system->configuration, count);
    for (int64_t k = 0; k < count; k++)
        RITZ_TRY(read_one(all, name[k], system));
done:
    free(name);
    ritz_h5_close(all);
    return ritz_context(status, "configurations");
}

static ritz_status read_all(hid_t file, ritz_system *system)
{
    RITZ_CHECK(
        ritz_h5_get_text(file, "units", sizeof system->units, system->units));
    RITZ_CHECK(ritz_part_get_members(file, members, system));
    RITZ_CHECK(ritz_h5_get_text(file, "damping", sizeof system->damping,
                                system->damping));
    RITZ_CHECK(ritz_part_get_real(file, "band_hz", false, 2, system->band_hz));
    RITZ_CHECK(ritz_h5_count(file, "sweeps", &system->num_sweeps));
    RITZ_CHECK_NEW(system->sweep, system->num_sweeps);
    RITZ_CHECK(ritz_part_read_names(file, "sweeps", system->num_sweeps,
                                    system->sweep));
    RITZ_CHECK(read_blocks(file, system));
    return read_configurations(file, system);
}

ritz_status ritz_container_read_system(const char *path, ritz_system *out)
{
    ritz_status status = RITZ_OK;
    ritz_system system = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_part_open(path, "system", &file));
    RITZ_TRY(read_all(file, &system));
    *out = system;
    system = (ritz_system){0};
done:
    ritz_system_free(&system);
    ritz_h5_close(file);
    return ritz_context(status, path);
}

ritz_status ritz_container_write_system(const char *path,
                                        const ritz_system *system,
                                        const ritz_stamp *stamp)
{
    ritz_status status = RITZ_OK;
    ritz_writer writer = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_writer_new(path, "system", system->units, stamp, &writer));
    file = writer.file;
    RITZ_TRY(ritz_part_set_members(file, members, system));
    RITZ_TRY(ritz_h5_set_text(file, "damping", system->damping));
    RITZ_TRY(ritz_part_set_real(file, "band_hz", 2, system->band_hz));
    RITZ_TRY(ritz_part_write_names(file, "sweeps", system->num_sweeps,
                                   system->sweep));
    RITZ_TRY(write_blocks(file, system));
    RITZ_TRY(write_configurations(file, system));
    RITZ_TRY(ritz_writer_finish(&writer));
done:
    ritz_writer_free(&writer);
    return ritz_context(status, path);
}
