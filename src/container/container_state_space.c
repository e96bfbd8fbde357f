/* Containers of models in first-order form. */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <stdlib.h>

/* A group of names, with limits beside them or not; none if empty. */
static ritz_status write_group(hid_t file, const char *name, int64_t count,
                               const ritz_name *names, const double *limit)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;

    if (count == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_h5_group(file, name, &group));
    RITZ_TRY_IN(name, ritz_part_write_names(group, "names", count, names));
    if (limit)
        RITZ_TRY_IN(name, ritz_h5_write(group, "limits", H5T_IEEE_F64LE,
                                        ritz_h5_vector(count), limit));
done:
    ritz_h5_close(group);
    return status;
}

/* limit may be NULL: there are none. */
static ritz_status read_group(hid_t file, const char *name, int64_t *count,
                              ritz_name **names, double **limit)
{
    ritz_status status = RITZ_OK;
    int64_t found = 0;
    hid_t group = 0;

    if (ritz_h5_has(file, name)) {
        RITZ_TRY(ritz_h5_enter(file, name, &group));
        RITZ_TRY_IN(name, ritz_h5_count(group, "names", &found));
    }
    RITZ_NEW(*names, found);
    if (limit)
        RITZ_NEW(*limit, found);
    if (group != 0)
        RITZ_TRY_IN(name, ritz_part_read_names(group, "names", found, *names));
    if (group != 0 && limit)
        RITZ_TRY_IN(name,
                    ritz_h5_read_real(group, "limits", ritz_h5_vector(found),
                                      true, *limit));
    *count = found;
done:
    ritz_h5_close(group);
    return status;
}

static ritz_status read_matrices(hid_t file, ritz_state_space *model)
{
    int64_t n = 0;

    RITZ_CHECK(ritz_h5_read_dense(file, "A", -1, -1, &model->A));
    n = model->A.ncol;
    RITZ_REFUSE_IF(model->A.nrow != n, RITZ_ERR_FORMAT, "'A' is not square");
    RITZ_CHECK(ritz_h5_read_dense(file, "B", n, model->num_inputs, &model->B));
    RITZ_CHECK(ritz_h5_read_dense(file, "C", model->num_outputs, n, &model->C));
    RITZ_CHECK(ritz_h5_read_dense(file, "D", model->num_outputs,
                                  model->num_inputs, &model->D));
    return ritz_part_read_dense(file, "E", n, n, &model->E);
}

static ritz_status read_all(hid_t file, ritz_state_space *model)
{
    RITZ_CHECK(
        ritz_h5_get_text(file, "units", sizeof model->units, model->units));
    RITZ_CHECK(ritz_h5_get_text(file, "damping", sizeof model->damping,
                                model->damping));
    RITZ_CHECK(ritz_part_get_origin(file, &model->origin));
    RITZ_CHECK(
        read_group(file, "inputs", &model->num_inputs, &model->input, NULL));
    RITZ_CHECK(read_group(file, "outputs", &model->num_outputs, &model->output,
                          &model->limit));
    RITZ_CHECK(read_matrices(file, model));
    RITZ_CHECK(ritz_part_read_columns(file, 0, model->A.ncol, &model->columns));
    RITZ_CHECK(ritz_part_read_measures(file, "estimates", &model->estimates));
    RITZ_CHECK(ritz_part_read_measures(file, "errors", &model->errors));
    return ritz_state_space_check(model);
}

ritz_status ritz_container_read_state_space(const char *path,
                                            ritz_state_space *out)
{
    ritz_status status = RITZ_OK;
    ritz_state_space model = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_part_open(path, "state-space", &file));
    RITZ_TRY(read_all(file, &model));
    *out = model;
    model = (ritz_state_space){0};
done:
    ritz_state_space_free(&model);
    ritz_h5_close(file);
    return ritz_context(status, path);
}

static ritz_status write_all(hid_t file, const ritz_state_space *model)
{
    RITZ_CHECK(ritz_h5_set_text(file, "damping", model->damping));
    RITZ_CHECK(ritz_part_set_origin(file, &model->origin));
    RITZ_CHECK(ritz_h5_write_dense(file, "A", &model->A));
    RITZ_CHECK(ritz_h5_write_dense(file, "B", &model->B));
    RITZ_CHECK(ritz_h5_write_dense(file, "C", &model->C));
    RITZ_CHECK(ritz_h5_write_dense(file, "D", &model->D));
    RITZ_CHECK(ritz_part_write_dense(file, "E", &model->E));
    RITZ_CHECK(
        write_group(file, "inputs", model->num_inputs, model->input, NULL));
    RITZ_CHECK(write_group(file, "outputs", model->num_outputs, model->output,
                           model->limit));
    RITZ_CHECK(ritz_part_write_columns(file, &model->columns));
    RITZ_CHECK(ritz_part_write_measures(file, "estimates", &model->estimates));
    return ritz_part_write_measures(file, "errors", &model->errors);
}

ritz_status ritz_container_write_state_space(const char *path,
                                             const ritz_state_space *model,
                                             const ritz_stamp *stamp)
{
    ritz_status status = RITZ_OK;
    ritz_writer writer = {0};

    RITZ_TRY(ritz_state_space_check(model));
    RITZ_TRY(
        ritz_writer_new(path, "state-space", model->units, stamp, &writer));
    RITZ_TRY(write_all(writer.file, model));
    RITZ_TRY(ritz_writer_finish(&writer));
done:
    ritz_writer_free(&writer);
    return ritz_context(status, path);
}
