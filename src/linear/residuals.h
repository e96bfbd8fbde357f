/* How accurate eigenpairs of sparse matrices are. */
#ifndef RITZ_LINEAR_RESIDUALS_H
#define RITZ_LINEAR_RESIDUALS_H

#include <ritz/matrix.h>

/**
 * Compute the residual of each pair, and how many pairs are rigid-body modes.
 *
 * @param[in]     K, M   n x n, symmetric
 * @param[in,out] P      Phi and lambda are read; residual, one number for each
 *                       column of Phi, and num_rigid are set
 * @param[out]    worst  largest residual; NaN if one is NaN, 0 without pairs
 * @return RITZ_ERR_MEMORY
 * @cost  one pass over K and M for every eight pairs, on all threads
 */
ritz_status ritz_pairs_assess(const ritz_sparse *K, const ritz_sparse *M,
                              ritz_pairs *P, double *worst);

#endif
