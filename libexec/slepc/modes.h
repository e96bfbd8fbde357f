/*
 * Lowest pairs of a distributed pencil, as src/linear/eigen_sparse.c finds those
 * of one process: Krylov-Schur iteration of SLEPc on (K - sigma M)^-1 M, then
 * inverse iteration on what was found, then a count of the eigenvalues below the
 * last of them, by the inertia of K - tau M.
 */
#ifndef RITZ_LIBEXEC_SLEPC_MODES_H
#define RITZ_LIBEXEC_SLEPC_MODES_H

#include "pencil.h"

typedef struct modes {
    /* Eigenvalues, residuals, number of rigid modes, in every rank. Phi has its
       columns alone, unless rank 0 has all of it. */
    ritz_pairs pairs;
    Mat X; /* the vectors; NULL: rank 0 has them in pairs.Phi */
} modes;

/**
 * Before anything is factored: how many modes are below the frequency of the
 * span, by a factor of its own. Collective.
 *
 * @param[out] limit   of lambda, a little above the frequency; 0 by number
 * @param[out] target  modes below it
 */
ritz_status modes_foresee(rank_pencil *p, const ritz_span *span, double *limit,
                          int64_t *target);

/**
 * Shift and factor. Collective.
 *
 * @param[in] held  K is positive definite, and is factored itself
 * @return RITZ_ERR_SINGULAR if K is not, or if no shift makes it so
 */
ritz_status modes_shift(rank_pencil *p, bool held, double limit);

/**
 * The requested pairs, whose number is proven. Collective; the factor of @p p is
 * then that of the count.
 *
 * @param[in] limit,target  of modes_foresee
 * @return as ritz_eigen_sparse
 */
ritz_status modes_find(rank_pencil *p, const ritz_span *span, double limit,
                       int64_t target, modes *out);

void modes_free(modes *m);

#endif
