/* Krylov-Schur iteration of SLEPc [HernandezRomanVidal2005]. */
#ifndef RITZ_LIBEXEC_SLEPC_KRYLOV_H
#define RITZ_LIBEXEC_SLEPC_KRYLOV_H

#include "pencil.h"

/**
 * The eigenpairs of K x = lambda M x nearest to sigma, at which @p p is
 * factored. Collective.
 *
 * @param[in]  ask     number of pairs requested
 * @param[in]  room    number of Krylov vectors at which SLEPc restarts
 * @param[out] X       n x *found, to be improved by block_polish()
 * @param[out] lambda  room for @p ask eigenvalues, of which *found are set, in
 *                     every rank; to be freed
 * @param[out] found   how many converged, at most @p ask
 */
ritz_status krylov_lowest(rank_pencil *p, int64_t ask, int64_t room, Mat *X,
                          double **lambda, int64_t *found);

#endif
