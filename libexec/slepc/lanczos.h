/* Block Lanczos iteration on (K - sigma M)^-1 M, on distributed vectors: eight
 * right-hand sides cost MUMPS little more than one. */
#ifndef RITZ_LIBEXEC_SLEPC_LANCZOS_H
#define RITZ_LIBEXEC_SLEPC_LANCZOS_H

#include "pencil.h"

/**
 * The pairs of largest magnitude, which are those of the pencil nearest to
 * sigma, where K - sigma M is factored. Collective. There is no restart: a
 * problem that needs too many vectors is left to krylov_lowest.
 *
 * @param[in]  ask     how many
 * @param[out] X       their vectors, M-orthonormal
 * @param[out] lambda  ask, ascending, in every rank; the caller's to free
 * @param[out] found   @p ask; 0, with nothing in @p X, if they did not converge
 */
ritz_status lanczos_lowest(const rank_pencil *p, int64_t ask, Mat *X,
                           double **lambda, int64_t *found);

#endif
