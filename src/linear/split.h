/*
 * Spectral separation of a linear system: poles left of the imaginary axis by
 * more than rounding, in Schur form, and the others.
 */
#ifndef RITZ_LINEAR_SPLIT_H
#define RITZ_LINEAR_SPLIT_H

#include <ritz/matrix.h>

/* E x' = A x with x = X z + T a; n states, m of them stable. */
typedef struct ritz_split {
    ritz_dense S, P; /* m x m, Y'A X quasi-triangular, Y'E X triangular; P {0}
                        is the identity */
    ritz_dense X, Y; /* n x m */
    ritz_dense T, W; /* n x (n - m), W'E T = I, Y'E T = 0, W'E X = 0 */
} ritz_split;

/**
 * A pole is no stable one if it is right of the axis or not further left than
 * rounding may move it (ritz_eigenvalues), unless a Lyapunov equation proves
 * that rounding of A cannot make any pole unstable.
 *
 * E that is symmetric and definite is reduced by its Cholesky factor; with
 * another one the pair is kept.
 *
 * @param[in] E  invertible; {0}: the identity
 * @return RITZ_ERR_SINGULAR if E is, to rounding; RITZ_ERR_CONVERGENCE if
 *         poles to be separated are too close to each other
 * @cost   some 30 n^3, of a pair 70 n^3
 */
ritz_status ritz_split_new(const ritz_dense *A, const ritz_dense *E,
                           ritz_split *out);

void ritz_split_free(ritz_split *split);

/**
 * E x' = A x + B u, y = C x in coordinates in which A is well scaled, E divided
 * out.
 *
 * @param[in]  E                    {0}: the identity
 * @param[out] out_A, out_B, out_C  the caller's to free, if it fails too
 */
ritz_status ritz_split_scaled(const ritz_dense *A, const ritz_dense *E,
                              const ritz_dense *B, const ritz_dense *C,
                              ritz_dense *out_A, ritz_dense *out_B,
                              ritz_dense *out_C);

#endif
