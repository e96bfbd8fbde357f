/*
 * Lowest eigenpairs of distributed matrices, by the steps that
 * src/linear/eigen_sparse.c makes in one process: block Lanczos, or
 * Krylov-Schur of SLEPc if that does not converge, with (K - sigma M)^-1 M;
 * inverse iteration if residuals are too large; and a count of the eigenvalues
 * below the last of them, by the inertia of K - tau M.
 */
#ifndef RITZ_LIBEXEC_SLEPC_MODES_H
#define RITZ_LIBEXEC_SLEPC_MODES_H

#include "pencil.h"

typedef struct modes {
    /* Eigenvalues, residuals and number of rigid modes, in every rank. Of Phi
       only ncol is set, except in rank 0 if X is NULL. */
    ritz_pairs pairs;
    Mat X; /* the vectors; NULL: they are in pairs.Phi of rank 0 */
} modes;

/**
 * Count the modes up to the frequency of the span, by a factor that is made for
 * this. To be called before modes_shift(), as it replaces the factor of @p p.
 * Collective.
 *
 * @param[out] limit   eigenvalue slightly above the frequency, below which
 *                     modes are counted; 0 if the span has a number of modes
 * @param[out] target  modes below limit; a guess if the span is uncounted; 0 if
 *                     the span has a number of modes
 */
ritz_status modes_foresee(rank_pencil *p, const ritz_span *span, double *limit,
                          int64_t *target);

/**
 * Choose sigma and factor K - sigma M. Collective.
 *
 * @param[in] held   sigma = 0, as K must be positive definite; false: sigma < 0
 * @param[in] limit  of modes_foresee()
 * @return RITZ_ERR_SINGULAR if K is not positive definite, or K - sigma M is
 *         not for any sigma that was tried
 */
ritz_status modes_shift(rank_pencil *p, bool held, double limit);

/**
 * The requested pairs, verified by a count that none is missing, unless the
 * span is uncounted. Collective. The factor of @p p may be another one
 * afterwards.
 *
 * @param[in]  limit,target  of modes_foresee()
 * @param[out] out           if K has a negative eigenvalue, the lowest pair
 *                           alone, of which neither the residual nor the count
 *                           is verified
 * @return as ritz_eigen_sparse()
 */
ritz_status modes_find(rank_pencil *p, const ritz_span *span, double limit,
                       int64_t target, modes *out);

void modes_free(modes *m);

#endif
