/* Implicitly restarted Lanczos iterations of ARPACK, with real vectors and a
 * factor of Ritz. [LehoucqSorensenYang1998] */
#ifndef RITZ_LINEAR_ARPACK_H
#define RITZ_LINEAR_ARPACK_H

#include "linear/general.h"

/**
 * Vectors of the @p k eigenvalues nearest above sigma.
 *
 * @param[out] X     n x k, in no order; empty unless FOUND
 * @param[out] reach the k-th eigenvalue, or an estimate of it if SLOW
 * @return RITZ_ERR_ARGUMENT if there are more than ARPACK can find;
 *         RITZ_ERR_CONVERGENCE if it fails
 */
ritz_status ritz_lanczos_lowest(const ritz_shifted *S, int64_t k, ritz_dense *X,
                                double *reach, ritz_lanczos_end *end);

/** A x = theta B x, with the lowest and the highest theta wanted. */
typedef struct ritz_ended {
    const ritz_sparse *A; /* n x n, symmetric, of any sign and rank */
    const ritz_sparse *B; /* n x n, symmetric positive definite */
    ritz_factor *F;       /* of B */
} ritz_ended;

typedef enum ritz_spectrum_end {
    RITZ_END_LOWEST,
    RITZ_END_HIGHEST,
} ritz_spectrum_end;

/**
 * Eigenvalues at both ends of the spectrum. One that is far smaller than the
 * other is among many of its size, and may not converge.
 *
 * @param[out] theta  lowest and highest, NaN if it did not converge or is not
 *                    accurate; both 0 if A is zero
 * @return RITZ_ERR_CONVERGENCE if both are NaN
 * @cost   a product with A and B and a solve a step, up to 140 steps; 23 n
 *         numbers
 */
ritz_status ritz_lanczos_ends(const ritz_ended *of, double theta[2]);

/**
 * The eigenvalue at one end of the spectrum.
 *
 * @param[out] theta  0 if A is zero
 * @return RITZ_ERR_CONVERGENCE if it does not converge, or rounding of B may
 *         change it by more than RITZ_END_ERROR
 */
ritz_status ritz_lanczos_end_of(const ritz_ended *of, ritz_spectrum_end end,
                                double *theta);

#endif
