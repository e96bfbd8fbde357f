/* Block Lanczos iteration on (K - sigma M)^-1 M with distributed vectors, four
 * or eight in a block: MUMPS solves for eight in some four times the time of
 * one. */
#ifndef RITZ_LIBEXEC_SLEPC_LANCZOS_H
#define RITZ_LIBEXEC_SLEPC_LANCZOS_H

#include "pencil.h"

/**
 * The lowest eigenpairs of K x = lambda M x, where @p p is factored at a sigma
 * below all of them. Collective. There is no restart: what needs more than
 * 3 ask + 200 vectors is left to krylov_lowest().
 *
 * @param[in]  ask     number of pairs requested
 * @param[out] X       n x ask, M-orthonormal
 * @param[out] lambda  ask eigenvalues, ascending, in every rank; to be freed
 * @param[out] found   @p ask; or 0 if not all have converged, and X and lambda
 *                     are not set
 */
ritz_status lanczos_lowest(const rank_pencil *p, int64_t ask, Mat *X,
                           double **lambda, int64_t *found);

#endif
