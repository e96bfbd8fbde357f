/* Residuals of eigenpairs of sparse matrices, and the size of the rounding of
 * x'A x. */
#ifndef RITZ_LINEAR_RESIDUALS_H
#define RITZ_LINEAR_RESIDUALS_H

#include <ritz/matrix.h>

/**
 * Compute the residual of each pair, | K x - lambda M x | divided by
 * | |K||x| + |lambda||M||x| |, and how many pairs are rigid-body modes.
 *
 * @param[in]     K, M   n x n, symmetric, both triangles stored
 * @param[in,out] P      Phi and lambda are read; residual, one number for each
 *                       column of Phi, and num_rigid are set
 * @param[out]    worst  largest residual; NaN if one is NaN, 0 without pairs
 * @return RITZ_ERR_MEMORY
 * @cost  one pass over K and M for every eight pairs, on all threads. The last
 *        bits depend on the number of threads, as sums are divided among them.
 */
ritz_status ritz_pairs_assess(const ritz_sparse *K, const ritz_sparse *M,
                              ritz_pairs *P, double *worst);

/**
 * |x|'|A||x| of each column x of @p X. The rounding error of x'A x is of the
 * order of eps times this.
 *
 * @param[in]  A    n x n, symmetric, both triangles stored
 * @param[in]  X    n x k
 * @param[out] out  k numbers, of which the last bits depend on the number of
 *                  threads
 * @return RITZ_ERR_MEMORY
 * @cost  one pass over A for every eight columns, on all threads
 */
ritz_status ritz_energy_terms(const ritz_sparse *A, const ritz_dense *X,
                              double *out);

#endif
