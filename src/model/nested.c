/*
 * Nested reduced components: with S the unit vectors of some columns,
 *
 *     K := S'K S, ..., T := T S
 *
 * which selects entries and rounds nothing. What is known of each prefix, its
 * errors by measure, is a table; orders ascend in it, and so do names.
 */
#include "base/alloc.h"

#include <ritz/model.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static ritz_status new_nested(int64_t smallest, int64_t count, int64_t errors,
                              ritz_nested *out)
{
    RITZ_OWN(ritz_nested)
    made = {.smallest = smallest, .count = count, .num_errors = errors};

    RITZ_CHECK_NEW(made.order, count);
    RITZ_CHECK_NEW(made.error, errors);
    RITZ_CHECK(ritz_dense_new(count, errors, &made.value));
    for (int64_t k = 0; k < count * errors; k++)
        made.value.val[k] = nan("");
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

static ritz_status check_order(const ritz_reduced *in, int64_t order)
{
    RITZ_REFUSE_IF(in->nested.smallest == 0, RITZ_ERR_ARGUMENT,
                   "it is not nested: its %" PRId64
                   " columns are one model, and fewer of them are none; "
                   "ritz-fit writes nested files",
                   in->K.ncol);
    RITZ_REFUSE_IF(
        order < in->nested.smallest || order > in->K.ncol, RITZ_ERR_ARGUMENT,
        "there is no prefix of %" PRId64 " columns, there are those of "
        "%" PRId64 " to %" PRId64,
        order, in->nested.smallest, in->K.ncol);
    return RITZ_OK;
}

/* Rows below `count` of a table: behind `row` and `col` one further on. */
static void copy_table(const ritz_nested *in, int64_t count, int64_t row,
                       int64_t col, ritz_nested *out)
{
    for (int64_t k = 0; k < count; k++)
        out->order[k + (k >= row)] = in->order[k];
    for (int64_t j = 0; j < in->num_errors; j++) {
        memcpy(out->error[j + (j >= col)], in->error[j], sizeof in->error[j]);
        for (int64_t k = 0; k < count; k++)
            ritz_dense_col(&out->value, j + (j >= col))[k + (k >= row)] =
                ritz_dense_col(&in->value, j)[k];
    }
}

ritz_status ritz_nested_note(ritz_reduced *reduced, int64_t order,
                             const char *name, double value)
{
    ritz_nested *n = &reduced->nested;
    RITZ_OWN(ritz_nested) wide = {0};
    char copy[RITZ_NAME_SIZE] = "";
    int64_t row = 0, col = 0;
    bool new_row = false, new_col = false;

    RITZ_CHECK(check_order(reduced, order));
    RITZ_CHECK(ritz_name_copy(name, copy));
    RITZ_REFUSE_IF(!isfinite(value), RITZ_ERR_ARGUMENT,
                   "'%s' of %" PRId64 " columns is %g, which is no measure",
                   name, order, value);
    while (row < n->count && n->order[row] < order)
        row++;
    while (col < n->num_errors && strcmp(n->error[col], copy) < 0)
        col++;
    new_row = row == n->count || n->order[row] != order;
    new_col = col == n->num_errors || strcmp(n->error[col], copy) != 0;
    RITZ_CHECK(new_nested(n->smallest, n->count + new_row,
                          n->num_errors + new_col, &wide));
    copy_table(n, n->count, new_row ? row : n->count,
               new_col ? col : n->num_errors, &wide);
    wide.order[row] = order;
    memcpy(wide.error[col], copy, sizeof copy);
    ritz_dense_col(&wide.value, col)[row] = value;
    ritz_nested_free(n);
    RITZ_MOVE(*n, wide);
    return RITZ_OK;
}

/* Columns b r + k for the three axes b. */
static ritz_status pick_invariants(const ritz_invariants *in, int64_t r,
                                   int64_t count, const int64_t *at,
                                   ritz_invariants *out)
{
    RITZ_OWN(ritz_dense) rows = {0};
    RITZ_OWN_ARRAY int64_t *thrice = NULL;

    if (!in->momentum.val)
        return RITZ_OK;
    RITZ_CHECK_NEW(thrice, 3 * count);
    for (int64_t k = 0; k < 3 * count; k++)
        thrice[k] = k / count * r + at[k % count];
    memcpy(out->rigid, in->rigid, sizeof out->rigid);
    RITZ_CHECK(ritz_dense_pick(&in->momentum, count, at, &out->momentum));
    RITZ_CHECK(
        ritz_dense_pick(&in->position, 3 * count, thrice, &out->position));
    RITZ_CHECK(ritz_dense_rows(&in->product, 3 * count, thrice, &rows));
    return ritz_dense_pick(&rows, 3 * count, thrice, &out->product);
}

/* A projection on unit vectors, but columns of T and of the invariants, which
   are large, are copied instead of multiplied. */
static ritz_status select_columns(const ritz_reduced *in, int64_t count,
                                  const int64_t *at, ritz_reduced *out)
{
    ritz_reduced bare = *in; /* borrowed */
    RITZ_OWN(ritz_reduced) made = {0};
    RITZ_OWN(ritz_dense) S = {0};

    bare.T.nrow = 0;
    bare.invariants = (ritz_invariants){0};
    RITZ_CHECK(ritz_dense_new(in->K.ncol, count, &S));
    for (int64_t j = 0; j < count; j++)
        ritz_dense_col(&S, j)[at[j]] = 1.0;
    RITZ_CHECK(ritz_reduced_project(&bare, &S, &made));
    RITZ_CHECK(ritz_columns_pick(&in->columns, count, at, &made.columns));
    ritz_dense_free(&made.T);
    if (in->T.val)
        RITZ_CHECK(ritz_dense_pick(&in->T, count, at, &made.T));
    RITZ_CHECK(pick_invariants(&in->invariants, in->K.ncol, count, at,
                               &made.invariants));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

static ritz_status check_columns(int64_t r, int64_t count, const int64_t *at,
                                 int64_t smallest)
{
    RITZ_OWN_ARRAY bool *taken = NULL;

    RITZ_REFUSE_IF(smallest < 1 || smallest > count, RITZ_ERR_ARGUMENT,
                   "a smallest prefix of %" PRId64
                   " columns is not in 1..%" PRId64,
                   smallest, count);
    RITZ_CHECK_NEW(taken, r);
    for (int64_t j = 0; j < count; j++) {
        RITZ_REFUSE_IF(at[j] < 0 || at[j] >= r, RITZ_ERR_ARGUMENT,
                       "there is no column %" PRId64 ", there are %" PRId64,
                       at[j] + 1, r);
        RITZ_REFUSE_IF(taken[at[j]], RITZ_ERR_ARGUMENT,
                       "column %" PRId64 " is named twice", at[j] + 1);
        taken[at[j]] = true;
    }
    return RITZ_OK;
}

ritz_status ritz_reduced_nest(const ritz_reduced *in, int64_t count,
                              const int64_t *order_of_columns, int64_t smallest,
                              ritz_reduced *out)
{
    RITZ_OWN(ritz_reduced) made = {0};

    RITZ_CHECK(check_columns(in->K.ncol, count, order_of_columns, smallest));
    RITZ_CHECK(select_columns(in, count, order_of_columns, &made));
    RITZ_CHECK(new_nested(smallest, 0, 0, &made.nested));
    if (count == in->K.ncol) {
        RITZ_CHECK(ritz_measures_copy(&in->estimates, &made.estimates));
        RITZ_CHECK(ritz_measures_copy(&in->errors, &made.errors));
    }
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

static bool is_bound(const char *name)
{
    static const char ending[] = "-bound";
    size_t length = strlen(name);
    size_t end = sizeof ending - 1;

    return length > end && strcmp(name + length - end, ending) == 0;
}

/* Measures of a prefix: the errors noted of just its order. */
static ritz_status note_measures(int64_t order, ritz_reduced *reduced)
{
    const ritz_nested *n = &reduced->nested;
    int64_t row = n->count - 1;
    char where[RITZ_NAME_SIZE];

    if (row < 0 || n->order[row] != order)
        return RITZ_OK;
    snprintf(where, sizeof where, "%" PRId64 " columns, when it was made",
             order);
    for (int64_t j = 0; j < n->num_errors; j++) {
        double value = ritz_dense_col(&n->value, j)[row];

        if (!isnan(value))
            RITZ_CHECK(ritz_measures_add(
                is_bound(n->error[j]) ? &reduced->estimates : &reduced->errors,
                n->error[j], value, nan(""), where));
    }
    return RITZ_OK;
}

ritz_status ritz_reduced_prefix(const ritz_reduced *in, int64_t order,
                                ritz_reduced *out)
{
    const ritz_nested *n = &in->nested;
    RITZ_OWN(ritz_reduced) made = {0};
    RITZ_OWN_ARRAY int64_t *first = NULL;
    int64_t count = 0;

    RITZ_CHECK(check_order(in, order));
    RITZ_CHECK_NEW(first, order);
    for (int64_t j = 0; j < order; j++)
        first[j] = j;
    RITZ_CHECK(ritz_reduced_nest(in, order, first, n->smallest, &made));
    ritz_nested_free(&made.nested);
    while (count < n->count && n->order[count] <= order)
        count++;
    RITZ_CHECK(new_nested(n->smallest, count, n->num_errors, &made.nested));
    copy_table(n, count, count, n->num_errors, &made.nested);
    if (order < in->K.ncol)
        RITZ_CHECK(note_measures(order, &made));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}
