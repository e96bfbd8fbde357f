/* A Cholesky factor P A P' = L L', for solvers that work in the order of its
 * rows. */
#ifndef RITZ_LINEAR_FACTOR_H
#define RITZ_LINEAR_FACTOR_H

#include <ritz/matrix.h>

/** n numbers: row k of the factor is row order[k] of A. Borrowed from @p F. */
const int64_t *ritz_factor_order(const ritz_factor *F);

/**
 * x := A^-1 x for a block of eight vectors: x[8 k + c] is row k, in the
 * factor's order, of vector c.
 */
void ritz_factor_solve_rows(ritz_factor *F, double *x);

/** How many threads each solve uses; products of vectors of this length may use
 * as many. */
int ritz_factor_threads(const ritz_factor *F);

#endif
