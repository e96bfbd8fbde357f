/* Lowest eigenpairs of a sparse pencil whose stiffness is already factored. */
#ifndef RITZ_LINEAR_EIGEN_SPARSE_H
#define RITZ_LINEAR_EIGEN_SPARSE_H

#include <ritz/matrix.h>

/**
 * ritz_eigen_sparse() for a positive definite K whose Cholesky factor the
 * caller has. The search uses this factor (sigma = 0) instead of making one of
 * K - sigma M. The factor is freed once the pairs are found, before the count
 * makes its own, so that memory holds one factor at a time.
 *
 * @param[in,out] L  the factor of K; freed and NULL afterwards, also on failure
 */
ritz_status ritz_eigen_factored(const ritz_sparse *K, const ritz_sparse *M,
                                ritz_factor **L, const ritz_span *span,
                                ritz_pairs *out);

#endif
