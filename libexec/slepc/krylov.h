/* Krylov-Schur iteration of SLEPc [HernandezRomanVidal2005]. */
#ifndef RITZ_LIBEXEC_SLEPC_KRYLOV_H
#define RITZ_LIBEXEC_SLEPC_KRYLOV_H

#include "pencil.h"

/**
 * The pairs of (K - sigma M)^-1 M of largest magnitude, which are those of the
 * pencil nearest to sigma, where K - sigma M is factored. Collective.
 *
 * @param[in]  ask     how many
 * @param[in]  room    vectors that are kept before a restart
 * @param[out] X       their vectors, not yet polished
 * @param[out] lambda  ask, in every rank; the caller's to free
 * @param[out] found   how many converged, at most @p ask
 */
ritz_status krylov_lowest(rank_pencil *p, int64_t ask, int64_t room, Mat *X,
                          double **lambda, int64_t *found);

#endif
