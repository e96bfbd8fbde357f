/* The exponential of a matrix, and integrals of quadratic forms along it. */
#ifndef RITZ_LINEAR_EXPONENTIAL_H
#define RITZ_LINEAR_EXPONENTIAL_H

#include <ritz/matrix.h>

/**
 * E = exp(A h), and of each symmetric Q_k
 *
 *     W_k = integral from 0 to h of exp(A s)'Q_k exp(A s) ds
 *
 * by a power series over h / 2^j and j doublings, A balanced first. What it
 * loses to rounding is about eps |A| h.
 *
 * @param[in]  Q  count, n x n
 * @param[out] W  count
 * @return RITZ_ERR_ARGUMENT if |A| h is beyond 2^60
 */
ritz_status ritz_exponential(const ritz_dense *A, double h, int count,
                             const ritz_dense *Q, ritz_dense *E, ritz_dense *W);

#endif
