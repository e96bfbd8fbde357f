/* The eigenvalue at one end of the spectrum of a pencil. */
#ifndef RITZ_LINEAR_EXTREME_H
#define RITZ_LINEAR_EXTREME_H

#include <ritz/matrix.h>

typedef enum ritz_spectrum_end {
    RITZ_END_LOWEST,
    RITZ_END_HIGHEST,
    RITZ_END_LARGEST, /* of larger magnitude */
} ritz_spectrum_end;

/**
 * The eigenvalue of A x = theta B x at one end of the spectrum, by Lanczos
 * iterations on B^-1 A in the inner product of B, fully reorthogonalised and
 * restarted.
 *
 * @param[in]  A      n x n, symmetric, of any sign and rank
 * @param[in]  B      n x n, symmetric positive definite
 * @param[in]  F      factor of B
 * @param[out] theta  0 if A is zero
 * @return RITZ_ERR_CONVERGENCE if its residual does not become small
 * @cost   a solve and four products a step, up to 60 n numbers
 */
ritz_status ritz_extreme_value(const ritz_sparse *A, const ritz_sparse *B,
                               ritz_factor *F, ritz_spectrum_end end,
                               double *theta);

#endif
