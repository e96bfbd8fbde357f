/* The largest eigenvalues of a dense symmetric matrix, and their vectors. */
#ifndef RITZ_LINEAR_LARGEST_H
#define RITZ_LINEAR_LARGEST_H

#include <ritz/base.h>

#include <stdint.h>

/**
 * Eigenpairs A x = theta x of a symmetric matrix: the @p most largest theta, or
 * all above @p least.
 *
 * @param[in,out] A       n x n, column-major, lower triangle read; overwritten
 * @param[in]     most    1 to n; 0: all above @p least
 * @param[in]     least   not read if @p most is positive
 * @param[out]    count   number of pairs
 * @param[out]    theta   count numbers, descending; freed by the caller
 * @param[out]    vector  n x count, column-major, orthonormal; freed by the
 *                        caller
 * @return RITZ_ERR_CONVERGENCE, also if A holds a NaN; RITZ_ERR_MEMORY
 * @cost   4/3 n^3 for the tridiagonal form, and 2 n^2 a vector
 */
ritz_status ritz_largest_pairs(int64_t n, double *A, int64_t most, double least,
                               int64_t *count, double **theta, double **vector);

#endif
