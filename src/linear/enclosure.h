/* Inverse iteration on several vectors at a time, and lower bounds of
 * eigenvalues from what it computes. */
#ifndef RITZ_LINEAR_ENCLOSURE_H
#define RITZ_LINEAR_ENCLOSURE_H

#include "linear/general.h"

/** X'M B X and X'M B^2 X of vectors X, B = (K - sigma M)^-1 M. */
typedef struct ritz_moments {
    ritz_dense first, second;
} ritz_moments;

void ritz_moments_free(ritz_moments *moments);

/**
 * X := the Ritz vectors in the span of A^-1 M X, A = K - sigma M: M-orthonormal,
 * by ascending Ritz value.
 *
 * @param[in]     S        K, M, sigma, factor of A
 * @param[in,out] X        n x k
 * @param[out]    lambda   k Ritz values  [rad^2/s^2]
 * @param[out]    moments  of X as it was on entry; NULL: not wanted
 * @return RITZ_ERR_CONVERGENCE if columns of X depend on each other;
 *         RITZ_ERR_MEMORY
 * @cost   k solves, two products by M, 6 n k^2 operations
 */
ritz_status ritz_vectors_polish(const ritz_shifted *S, ritz_dense *X,
                                double *lambda, ritz_moments *moments);

/**
 * Lower bounds of the @p count lowest eigenvalues, up to rounding.
 *
 * @param[in]  moments  of M-orthonormal vectors
 * @param[in]  sigma    below all eigenvalues
 * @param[in]  tau      there are exactly @p count eigenvalues below it
 * @param[out] lower    count bounds, ascending; -HUGE_VAL where the vectors
 *                      give none  [rad^2/s^2]
 * @return RITZ_ERR_SINGULAR if 1 / (tau - sigma) is an eigenvalue of B within
 *         rounding; RITZ_ERR_CONVERGENCE; RITZ_ERR_MEMORY
 * @cost   O(k^3) for k vectors
 * @see    [Lehmann1963]
 */
ritz_status ritz_moments_enclose(const ritz_moments *moments, double sigma,
                                 double tau, int64_t count, double *lower);

/**
 * Bounds of the relative errors of the eigenvalues of P. That of a rigid-body
 * mode is relative to the first flexible eigenvalue.
 *
 * @param[in,out] P     upper bounds of eigenvalues; P->error is set: infinite
 *                      from the @p count-th on, and where the vectors give none
 * @param[in]  moments  of the vectors of P, or of these before an inverse
 *                      iteration
 * @param[in]  tau, count  as for ritz_moments_enclose()
 * @return as ritz_moments_enclose()
 */
ritz_status ritz_pairs_bound(ritz_pairs *P, const ritz_moments *moments,
                             double sigma, double tau, int64_t count);

#endif
