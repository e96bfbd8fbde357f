/* Lowest pairs of a sparse pencil whose stiffness is factored. */
#ifndef RITZ_LINEAR_EIGEN_SPARSE_H
#define RITZ_LINEAR_EIGEN_SPARSE_H

#include <ritz/matrix.h>

/**
 * ritz_eigen_sparse() with K positive definite: no other matrix is factored to
 * find them. *L is freed as soon as they are found, before they are counted, so
 * that there is one factor at a time.
 *
 * @param[in,out] L  the factor of K, which is taken
 */
ritz_status ritz_eigen_factored(const ritz_sparse *K, const ritz_sparse *M,
                                ritz_factor **L, const ritz_span *span,
                                ritz_pairs *out);

#endif
