/* One call of LAPACK for all pairs of a dense pencil. */
#ifndef RITZ_LINEAR_EIGEN_DENSE_H
#define RITZ_LINEAR_EIGEN_DENSE_H

#include <ritz/matrix.h>

/**
 * K x = lambda M x, M semidefinite; lambda ascending, in error by few eps of
 * the largest.
 *
 * @param[out] lambda  n
 * @param[out] X       n x r, X'MX = I, infinite ones left out
 * @return RITZ_ERR_SINGULAR if K + M is, or M has a negative eigenvalue
 */
ritz_status ritz_eigen_dense_once(const ritz_dense *K, const ritz_dense *M,
                                  double *lambda, ritz_dense *X);

#endif
