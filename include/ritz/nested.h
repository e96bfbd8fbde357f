/*
 * Nested reduced components: columns in an order in which the first of them,
 * if they are not fewer than some, are a reduced component too. How many are
 * used is then a matter of use, and no new reduction.
 *
 * A prefix is Galerkin's model in the subspace of its columns: its matrices are
 * the leading blocks, so it is as stable as the whole, and its frequencies lie
 * above those of the whole.
 */
#ifndef RITZ_NESTED_H
#define RITZ_NESTED_H

#include <ritz/reduced.h>

#pragma GCC visibility push(default)

/**
 * The columns in another order, and with them all that has columns: matrices,
 * dampers, ports, inputs and outputs, invariants, T.
 *
 * If all columns are there, what is known of the errors stays as it is; if some
 * are left out, none of that is true of the result, and it is left out too.
 *
 * @param[in] order_of_columns  count of them, from 0 and distinct: the one that
 *                              becomes first, ...
 * @param[in] smallest          1 .. count: no prefix shorter than that
 * @return RITZ_ERR_ARGUMENT if a column is not there, or there twice
 */
ritz_status ritz_reduced_nest(const ritz_reduced *in, int64_t count,
                              const int64_t *order_of_columns, int64_t smallest,
                              ritz_reduced *out);

/**
 * Its first columns alone. Of its errors what was noted of that order when it
 * was made becomes known: names that end in "-bound" as estimates, others as
 * errors. Errors of more columns are none of fewer.
 *
 * @param[in] order  smallest .. columns; of all columns it is a copy
 * @return RITZ_ERR_ARGUMENT if it is not nested or has no such prefix
 */
ritz_status ritz_reduced_prefix(const ritz_reduced *in, int64_t order,
                                ritz_reduced *out);

/**
 * Note what a measure of a prefix came to; a second value replaces the first.
 *
 * @return RITZ_ERR_ARGUMENT as above, or if the name cannot be one
 */
ritz_status ritz_nested_note(ritz_reduced *reduced, int64_t order,
                             const char *name, double value);

#pragma GCC visibility pop

#endif
