/* Containers of frequency responses. */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const ritz_text_member members[] = {
    {"method", offsetof(ritz_response, method)},
    {NULL, 0},
};

static ritz_h5_shape shape_of(const ritz_response *response)
{
    return ritz_h5_stack(response->count, response->num_outputs,
                         response->num_inputs);
}

static int64_t count_values(const ritz_response *response)
{
    return response->count * response->num_outputs * response->num_inputs;
}

/* H as two data sets of shape (hertz, outputs, inputs). */
static ritz_status write_values(hid_t file, const ritz_response *response)
{
    ritz_status status = RITZ_OK;
    int64_t count = count_values(response);
    double *part = NULL;
    hid_t group = 0;

    RITZ_NEW(part, count);
    RITZ_TRY(ritz_h5_group(file, "H", &group));
    for (int64_t k = 0; k < count; k++)
        part[k] = creal(response->H[k]);
    RITZ_TRY(
        ritz_h5_write(group, "real", H5T_IEEE_F64LE, shape_of(response), part));
    for (int64_t k = 0; k < count; k++)
        part[k] = cimag(response->H[k]);
    RITZ_TRY(
        ritz_h5_write(group, "imag", H5T_IEEE_F64LE, shape_of(response), part));
done:
    free(part);
    ritz_h5_close(group);
    return ritz_context(status, "H");
}

/* One of the parts, alternating with the other in H. */
static ritz_status read_part(hid_t group, const char *name, int offset,
                             ritz_response *response)
{
    ritz_status status = RITZ_OK;
    int64_t count = count_values(response);
    double *H = (double *)response->H; /* re, im, re, im, ... (C 6.2.5) */
    double *part = NULL;

    RITZ_NEW(part, count);
    RITZ_TRY(ritz_h5_read_real(group, name, shape_of(response), false, part));
    for (int64_t k = 0; k < count; k++)
        H[2 * k + offset] = part[k];
done:
    free(part);
    return status;
}

static ritz_status read_values(hid_t file, ritz_response *response)
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape found = {0};
    ritz_h5_shape due = shape_of(response);
    hid_t group = 0;

    RITZ_TRY(ritz_h5_enter(file, "H", &group));
    RITZ_TRY(ritz_h5_shape_of(group, "real", 3, &found));
    for (int k = 0; k < 3; k++) /* before anything of that size is allocated */
        RITZ_FAIL_IF(found.dims[k] != due.dims[k], RITZ_ERR_FORMAT,
                     "'real' is not hertz x outputs x inputs");
    RITZ_NEW(response->H, count_values(response));
    RITZ_TRY(read_part(group, "real", 0, response));
    RITZ_TRY(read_part(group, "imag", 1, response));
done:
    ritz_h5_close(group);
    return ritz_context(status, "H");
}

static ritz_status write_singular(hid_t file, const ritz_response *response)
{
    if (response->num_singular == 0)
        return RITZ_OK;
    RITZ_CHECK(
        ritz_h5_write(file, "singular_values", H5T_IEEE_F64LE,
                      ritz_h5_table(response->count, response->num_singular),
                      response->singular));
    if (response->singular_peak[1] > 0.0)
        RITZ_CHECK(ritz_part_set_real(file, "singular_peak", 2,
                                      response->singular_peak));
    return RITZ_OK;
}

/* An infinite one is that of a pole which nothing damps. */
static ritz_status read_peak(hid_t file, ritz_response *response)
{
    double peak[2] = {0.0, 0.0};

    if (H5Aexists(file, "singular_peak") <= 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_h5_get(file, "singular_peak", H5T_NATIVE_DOUBLE, 2, peak));
    RITZ_REFUSE_IF(!(peak[0] >= 0.0) || isinf(peak[0]) || !(peak[1] > 0.0),
                   RITZ_ERR_FORMAT,
                   "'singular_peak' is no frequency and no value above 0");
    response->singular_peak[0] = peak[0];
    response->singular_peak[1] = peak[1];
    return RITZ_OK;
}

static ritz_status read_singular(hid_t file, ritz_response *response)
{
    ritz_h5_shape found = {0};
    int64_t most = response->num_outputs < response->num_inputs
                       ? response->num_outputs
                       : response->num_inputs;

    if (!ritz_h5_has(file, "singular_values"))
        return RITZ_OK;
    RITZ_CHECK(ritz_h5_shape_of(file, "singular_values", 2, &found));
    RITZ_REFUSE_IF(found.dims[0] != (hsize_t)response->count ||
                       found.dims[1] != (hsize_t)most,
                   RITZ_ERR_FORMAT,
                   "'singular_values' is not hertz x the fewer of outputs and "
                   "inputs");
    RITZ_CHECK_NEW(response->singular, response->count * most);
    RITZ_CHECK(ritz_h5_read_real(file, "singular_values", found, false,
                                 response->singular));
    response->num_singular = most;
    return read_peak(file, response);
}

/* How to go between points, where they were chosen for it. */
static ritz_status write_between(hid_t file, const ritz_response *response)
{
    if (!response->interpolation[0])
        return RITZ_OK;
    RITZ_CHECK(
        ritz_h5_set_text(file, "interpolation", response->interpolation));
    return ritz_h5_set(file, "tolerance", H5T_IEEE_F64LE, ritz_h5_scalar(),
                       &response->tolerance);
}

static ritz_status read_between(hid_t file, ritz_response *response)
{
    double tolerance = 0.0;

    if (H5Aexists(file, "interpolation") <= 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_h5_get_text(file, "interpolation",
                                sizeof response->interpolation,
                                response->interpolation));
    RITZ_CHECK(
        ritz_h5_get(file, "tolerance", H5T_NATIVE_DOUBLE, 1, &tolerance));
    RITZ_REFUSE_IF(!(tolerance >= 0.0) || !(tolerance < 1.0), RITZ_ERR_FORMAT,
                   "'tolerance' is %g, not between 0 and 1", tolerance);
    response->tolerance = tolerance;
    return RITZ_OK;
}

static ritz_status read_all(hid_t file, ritz_response *response)
{
    RITZ_CHECK(ritz_part_get_members(file, members, response));
    RITZ_CHECK(ritz_h5_get_text(file, "damping", sizeof response->damping,
                                response->damping));
    RITZ_CHECK(ritz_h5_count(file, "hertz", &response->count));
    RITZ_CHECK_NEW(response->hertz, response->count);
    RITZ_CHECK(ritz_h5_read_real(file, "hertz", ritz_h5_vector(response->count),
                                 false, response->hertz));
    for (int64_t k = 1; k < response->count; k++)
        RITZ_REFUSE_IF(response->hertz[k] < response->hertz[k - 1],
                       RITZ_ERR_FORMAT, "'hertz' descends at value %" PRId64,
                       k + 1);
    RITZ_CHECK(ritz_part_read_group_names(file, "inputs", &response->num_inputs,
                                          &response->input));
    RITZ_CHECK(ritz_part_read_group_names(
        file, "outputs", &response->num_outputs, &response->output));
    RITZ_CHECK(read_values(file, response));
    RITZ_CHECK(read_between(file, response));
    return read_singular(file, response);
}

ritz_status ritz_container_read_response(const char *path, ritz_response *out)
{
    ritz_status status = RITZ_OK;
    ritz_response response = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_part_open(path, "response", &file));
    RITZ_TRY(read_all(file, &response));
    *out = response;
    response = (ritz_response){0};
done:
    ritz_response_free(&response);
    ritz_h5_close(file);
    return ritz_context(status, path);
}

ritz_status ritz_container_write_response(const char *path,
                                          const ritz_response *response,
                                          const ritz_stamp *stamp)
{
    ritz_status status = RITZ_OK;
    ritz_writer writer = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_writer_new(path, "response", "", stamp, &writer));
    file = writer.file;
    RITZ_TRY(ritz_part_set_members(file, members, response));
    RITZ_TRY(ritz_h5_set_text(file, "damping", response->damping));
    RITZ_TRY(ritz_h5_write(file, "hertz", H5T_IEEE_F64LE,
                           ritz_h5_vector(response->count), response->hertz));
    RITZ_TRY(ritz_part_write_group_names(file, "inputs", response->num_inputs,
                                         response->input));
    RITZ_TRY(ritz_part_write_group_names(file, "outputs", response->num_outputs,
                                         response->output));
    RITZ_TRY(write_values(file, response));
    RITZ_TRY(write_between(file, response));
    RITZ_TRY(write_singular(file, response));
    RITZ_TRY(ritz_writer_finish(&writer));
done:
    ritz_writer_free(&writer);
    return ritz_context(status, path);
}
