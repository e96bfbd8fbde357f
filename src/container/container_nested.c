/* What containers hold of prefixes: group `nested` of a reduced component. */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

ritz_status ritz_part_write_nested(hid_t at, const ritz_nested *nested)
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape shape = ritz_h5_vector(nested->count);
    hid_t group = 0, errors = 0;
    ritz_name name = "";

    if (nested->smallest == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_h5_group(at, "nested", &group));
    RITZ_TRY(ritz_part_set_whole(group, "smallest", nested->smallest));
    RITZ_TRY(
        ritz_h5_write(group, "order", H5T_STD_I64LE, shape, nested->order));
    RITZ_TRY(ritz_h5_group(group, "error", &errors));
    for (int64_t j = 0; j < nested->num_errors; j++) {
        RITZ_TRY(ritz_name_copy(nested->error[j], name));
        RITZ_TRY(ritz_h5_write(errors, name, H5T_IEEE_F64LE, shape,
                               ritz_dense_col(&nested->value, j)));
    }
done:
    ritz_h5_close(errors);
    ritz_h5_close(group);
    return ritz_context(status, "nested");
}

static ritz_status read_orders(hid_t group, int64_t r, ritz_nested *nested)
{
    RITZ_CHECK(ritz_part_get_size(group, "smallest", 1, r, &nested->smallest));
    RITZ_CHECK(ritz_h5_count(group, "order", &nested->count));
    RITZ_CHECK_NEW(nested->order, nested->count);
    RITZ_CHECK(ritz_part_read_whole(group, "order", nested->count,
                                    nested->smallest, r, nested->order));
    for (int64_t k = 1; k < nested->count; k++)
        RITZ_REFUSE_IF(nested->order[k] <= nested->order[k - 1],
                       RITZ_ERR_FORMAT,
                       "'order' does not ascend at value %" PRId64, k + 1);
    return RITZ_OK;
}

static ritz_status read_errors(hid_t group, ritz_nested *nested)
{
    ritz_status status = RITZ_OK;
    hid_t errors = 0;

    RITZ_TRY(ritz_h5_enter(group, "error", &errors));
    RITZ_TRY(ritz_h5_list(errors, &nested->num_errors, &nested->error));
    RITZ_TRY(ritz_dense_new(nested->count, nested->num_errors, &nested->value));
    for (int64_t j = 0; j < nested->num_errors; j++)
        RITZ_TRY(ritz_h5_read_real(errors, nested->error[j],
                                   ritz_h5_vector(nested->count), true,
                                   ritz_dense_col(&nested->value, j)));
done:
    ritz_h5_close(errors);
    return ritz_context(status, "error");
}

ritz_status ritz_part_read_nested(hid_t at, int64_t r, ritz_nested *out)
{
    ritz_status status = RITZ_OK;
    ritz_nested nested = {0};
    hid_t group = 0;

    if (!ritz_h5_has(at, "nested"))
        return RITZ_OK;
    RITZ_TRY(ritz_h5_enter(at, "nested", &group));
    RITZ_TRY(read_orders(group, r, &nested));
    RITZ_TRY(read_errors(group, &nested));
    *out = nested;
    nested = (ritz_nested){0};
done:
    ritz_nested_free(&nested);
    ritz_h5_close(group);
    return ritz_context(status, "nested");
}
