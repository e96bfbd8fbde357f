/* A Cholesky factor, as solvers see it that work in its own order. */
#ifndef RITZ_LINEAR_FACTOR_H
#define RITZ_LINEAR_FACTOR_H

#include <ritz/matrix.h>

/** Row of A at each place of the factor's order; borrowed. */
const int64_t *ritz_factor_order(const ritz_factor *F);

/** x := A^-1 x, n x 8 row by row, rows in the factor's order. */
void ritz_factor_solve_rows(ritz_factor *F, double *x);

/** Threads that a solve takes, and that other work of this size is worth. */
int ritz_factor_threads(const ritz_factor *F);

#endif
