/* What is known of prefixes: orders ascend, and names do. */
#include "base/alloc.h"
#include "model/nested_parts.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void ritz_nested_free(ritz_nested *nested)
{
    free(nested->order);
    free(nested->error);
    ritz_dense_free(&nested->value);
    *nested = (ritz_nested){0};
}

ritz_status ritz_nested_new(int64_t smallest, int64_t count, int64_t errors,
                            ritz_nested *out)
{
    ritz_status status = RITZ_OK;
    ritz_nested made = {
        .smallest = smallest, .count = count, .num_errors = errors};

    RITZ_NEW(made.order, count);
    RITZ_NEW(made.error, errors);
    RITZ_TRY(ritz_dense_new(count, errors, &made.value));
    for (int64_t k = 0; k < count * errors; k++)
        made.value.val[k] = nan("");
    *out = made;
    made = (ritz_nested){0};
done:
    ritz_nested_free(&made);
    return status;
}

ritz_status ritz_nested_check(const ritz_reduced *in, int64_t order)
{
    RITZ_REFUSE_IF(in->nested.smallest == 0, RITZ_ERR_ARGUMENT,
                   "it is not nested: its %" PRId64
                   " columns are one model, and some of them are none",
                   in->K.ncol);
    RITZ_REFUSE_IF(
        order < in->nested.smallest || order > in->K.ncol, RITZ_ERR_ARGUMENT,
        "there is no prefix of %" PRId64 " columns, there are those of "
        "%" PRId64 " to %" PRId64,
        order, in->nested.smallest, in->K.ncol);
    return RITZ_OK;
}

/* A place for an order and a name, each where it belongs. */
static ritz_status widen(const ritz_nested *in, int64_t row, bool new_row,
                         int64_t col, bool new_col, ritz_nested *out)
{
    RITZ_CHECK(ritz_nested_new(in->smallest, in->count + new_row,
                               in->num_errors + new_col, out));
    for (int64_t k = 0; k < in->count; k++)
        out->order[k + (new_row && k >= row)] = in->order[k];
    for (int64_t j = 0; j < in->num_errors; j++) {
        int64_t to = j + (new_col && j >= col);

        memcpy(out->error[to], in->error[j], sizeof in->error[j]);
        for (int64_t k = 0; k < in->count; k++)
            ritz_dense_col(&out->value, to)[k + (new_row && k >= row)] =
                ritz_dense_col(&in->value, j)[k];
    }
    return RITZ_OK;
}

ritz_status ritz_nested_note(ritz_reduced *reduced, int64_t order,
                             const char *name, double value)
{
    ritz_status status = RITZ_OK;
    ritz_nested *n = &reduced->nested;
    ritz_nested wide = {0};
    char copy[RITZ_NAME_SIZE] = "";
    int64_t row = 0, col = 0;

    RITZ_TRY(ritz_nested_check(reduced, order));
    RITZ_TRY(ritz_name_copy(name, copy));
    RITZ_FAIL_IF(!isfinite(value), RITZ_ERR_ARGUMENT,
                 "'%s' of %" PRId64 " columns is %g, which is no measure", name,
                 order, value);
    while (row < n->count && n->order[row] < order)
        row++;
    while (col < n->num_errors && strcmp(n->error[col], copy) < 0)
        col++;
    RITZ_TRY(widen(n, row, row == n->count || n->order[row] != order, col,
                   col == n->num_errors || strcmp(n->error[col], copy) != 0,
                   &wide));
    wide.order[row] = order;
    memcpy(wide.error[col], copy, sizeof copy);
    ritz_dense_col(&wide.value, col)[row] = value;
    ritz_nested_free(n);
    *n = wide;
    wide = (ritz_nested){0};
done:
    ritz_nested_free(&wide);
    return status;
}
