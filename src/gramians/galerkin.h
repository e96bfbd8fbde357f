/* The Gramian of a state space in the span of given columns. */
#ifndef RITZ_GRAMIANS_GALERKIN_H
#define RITZ_GRAMIANS_GALERKIN_H

#include "linear/pencil.h"

#include <ritz/matrix.h>

/**
 * The approximate solution X = Z Z' of A X E' + E X A' + F F' = 0 that Galerkin's
 * condition V'R V = 0 selects in the span of the columns of S, and the 2-norm of
 * its residual R:
 *
 *     X = V Y V',  V'V = I,  span V = span S,  V'R V = 0,
 *     R = A X E' + E X A' + F F'
 *
 * @param[in]  transposed  A' and E' in place of A and E
 * @param[in]  S           n x k, k > 0, no column 0
 * @param[out] Z           n x k
 * @param[out] residual    |R|, from an orthogonal factorisation of [E V, A V, F]
 * @return RITZ_ERR_ARGUMENT if the projected model is not stable; it is stable
 *         if E and -(A + A') are definite
 * @cost   O(n (k + p)^2 + k^3)
 * @see    [DruskinSimoncini2011]
 */
ritz_status ritz_galerkin_gramian(const ritz_pencil *pencil, bool transposed,
                                  const ritz_dense *S, const ritz_dense *F,
                                  ritz_dense *Z, double *residual);

#endif
