/* Residuals of eigenpairs of sparse matrices, and what rounding leaves there. */
#ifndef RITZ_LINEAR_RESIDUALS_H
#define RITZ_LINEAR_RESIDUALS_H

#include <ritz/matrix.h>

/**
 * Fill in the residual of each pair and the number of rigid modes, and give the
 * worst residual: NaN if one is.
 *
 * @cost  a pass over K and M for every eight pairs, on all threads
 */
ritz_status ritz_pairs_assess(const ritz_sparse *K, const ritz_sparse *M,
                              ritz_pairs *P, double *worst);

/**
 * |x|'|A||x| of each column x of @p X: rounding of x'A x is about eps times
 * this.
 *
 * @param[in]  A    n x n, symmetric, both triangles stored
 * @param[in]  X    n x k
 * @param[out] out  k numbers
 * @cost  a pass over A for every eight columns, on all threads
 */
ritz_status ritz_energy_terms(const ritz_sparse *A, const ritz_dense *X,
                              double *out);

#endif
