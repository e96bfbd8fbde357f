/* Values of data sets, all at once. */
#include "container/h5.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static hsize_t count_bytes(const ritz_h5_shape *shape, hid_t memory)
{
    return ritz_h5_volume(shape, INT64_MAX) * H5Tget_size(memory);
}

ritz_status ritz_h5_write(hid_t at, const char *name, hid_t type,
                          ritz_h5_shape shape, const void *values)
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape chunk = {0};
    hid_t memory = H5Tget_native_type(type, H5T_DIR_ASCEND);
    hid_t set = 0;
    herr_t result = 0;

    RITZ_TRY(ritz_h5_create_set(at, name, type, shape, &chunk, &set));
    if (ritz_h5_volume(&shape, 1) > 0)
        result = H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    RITZ_FAIL_IF(result < 0, RITZ_ERR_FILE, "cannot write '%s'", name);
    RITZ_TRY(
        ritz_h5_seal(set, name, (int64_t)count_bytes(&shape, memory), values));
done:
    ritz_h5_close(set);
    ritz_h5_close(memory);
    return status;
}

static bool is_same(const ritz_h5_shape *a, const ritz_h5_shape *b)
{
    bool same = a->rank == b->rank;

    for (int k = 0; k < a->rank; k++)
        same = same && a->dims[k] == b->dims[k];
    return same;
}

/* "3 x 4" */
static const char *print_shape(const ritz_h5_shape *shape, char text[80])
{
    int used = 0;

    text[0] = '\0';
    for (int k = 0; k < shape->rank; k++)
        used += snprintf(text + used, 80 - (size_t)used, "%s%" PRIuHSIZE,
                         k > 0 ? " x " : "", shape->dims[k]);
    return text;
}

ritz_status ritz_h5_read(hid_t at, const char *name, hid_t type,
                         ritz_h5_shape shape, void *values)
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape found = {0};
    char have[80];
    char want[80];
    hid_t set = 0;
    hid_t on_file = 0;
    hid_t memory = 0;
    herr_t result = 0;

    RITZ_TRY(ritz_h5_open_set(at, name, shape.rank, &found, &set));
    RITZ_FAIL_IF(!is_same(&found, &shape), RITZ_ERR_FORMAT,
                 "'%s' is of %s values where %s are due", name,
                 print_shape(&found, have), print_shape(&shape, want));
    on_file = H5Dget_type(set);
    RITZ_TRY(ritz_h5_match(name, on_file, type, &memory));
    if (ritz_h5_volume(&shape, 1) > 0)
        result = H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    RITZ_FAIL_IF(result < 0, RITZ_ERR_FORMAT, "'%s' is damaged", name);
    RITZ_TRY(ritz_h5_verify(set, name, (int64_t)count_bytes(&shape, memory),
                            values));
done:
    ritz_h5_close(memory);
    ritz_h5_close(on_file);
    ritz_h5_close(set);
    return status;
}

ritz_status ritz_h5_read_real(hid_t at, const char *name, ritz_h5_shape shape,
                              bool nan_allowed, double *values)
{
    int64_t count = (int64_t)ritz_h5_volume(&shape, INT64_MAX);

    RITZ_CHECK(ritz_h5_read(at, name, H5T_IEEE_F64LE, shape, values));
    for (int64_t k = 0; k < count; k++)
        RITZ_REFUSE_IF(!isfinite(values[k]) &&
                           !(nan_allowed && isnan(values[k])),
                       RITZ_ERR_FORMAT,
                       "value %" PRId64 " of '%s' is not finite", k + 1, name);
    return RITZ_OK;
}
