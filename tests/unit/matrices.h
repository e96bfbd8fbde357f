/* Questions to matrices, answered apart from the library's own ways. */
#ifndef RITZ_TESTS_MATRICES_H
#define RITZ_TESTS_MATRICES_H

#include <ritz/sparse.h>

/** A(i, j), 0 where nothing is stored. */
double entry(const ritz_sparse *A, int64_t i, int64_t j);

/** Largest singular value, by the eigenvalues of A'A. */
double norm_2(const ritz_dense *A);

/**
 * X less its part in the span of K-orthonormal V, V V'K X: the largest entry
 * over that of X.
 */
double outside(const ritz_sparse *K, const ritz_dense *V, const ritz_dense *X);

#endif
