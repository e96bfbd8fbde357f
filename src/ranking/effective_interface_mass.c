/*
 * Effective interface masses: of a component in fixed-interface modes and
 * constraint modes,
 *
 *     M = [M_s  P'; P  I],   P = Phi' M Psi,
 *
 * mode k, moved by the interface alone, answers it with the mass P_k' P_k. All
 * modes of the full component together give M_s less what the interface holds
 * by itself. As interfaces mix translations and rotations, the value is free of
 * units,
 *
 *     s_k = trace(M_s^-1 P_k'P_k) / p = P_k M_s^-1 P_k' / p,    sum_k s_k <= 1
 *
 * p being the rank of M_s. On an interface that moves as a rigid body it weighs
 * the effective masses of the component held there, which are its parts.
 *
 * [KammerTriller1996]
 */
#include "base/alloc.h"
#include "ranking/mass.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* Of M_s with a unit diagonal: motions of the interface that move no mass. */
static const double massless = 1e-12;

/*
 * X' X = M_s^-1 on the motions that have mass: with S = diag(M_s)^-1/2 and
 * S M_s S = V Lambda V', X = Lambda^-1/2 V' S.
 */
static ritz_status invert(const ritz_dense *M_s, ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    int64_t p = M_s->nrow, r = 0;
    ritz_dense V = {0};
    double *scale = NULL, *lambda = NULL;
    int info = 0;

    RITZ_NEW(scale, p);
    RITZ_NEW(lambda, p);
    RITZ_TRY(ritz_dense_copy(M_s, &V));
    for (int64_t i = 0; i < p; i++) {
        double m = ritz_dense_col(M_s, i)[i];

        scale[i] = m > 0.0 ? 1.0 / sqrt(m) : 0.0;
    }
    for (int64_t k = 0; k < p * p; k++)
        V.val[k] *= scale[k % p] * scale[k / p];
    info = LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', (int)p, V.val, (int)p,
                         lambda);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE,
                 "the mass of the interface has no eigenvalues");
    while (r < p && !(lambda[r] > massless * lambda[p - 1]))
        r++;
    RITZ_TRY(ritz_dense_new(p - r, p, X));
    for (int64_t i = 0; i < p; i++)
        for (int64_t k = r; k < p; k++)
            ritz_dense_col(X, i)[k - r] =
                ritz_dense_col(&V, k)[i] * scale[i] / sqrt(lambda[k]);
done:
    free(scale);
    free(lambda);
    ritz_dense_free(&V);
    return status;
}

static ritz_status rank(const ritz_rank_request *request, ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    ritz_dense X = {0}, Y = {0};

    RITZ_TRY(invert(&request->interface, &X));
    RITZ_TRY(ritz_dense_mul(&X, &request->coupling, &Y));
    for (int64_t k = 0; k < Y.ncol; k++)
        for (int64_t i = 0; i < Y.nrow; i++)
            ranking->value[k] += ritz_dense_col(&Y, k)[i] *
                                 ritz_dense_col(&Y, k)[i] / (double)Y.nrow;
    if (request->momentum.val)
        RITZ_TRY(ritz_mass_parts(request, ranking));
    ranking->total = 0.0;
    for (int64_t k = 0; k < Y.ncol; k++)
        ranking->total += ranking->value[k];
done:
    ritz_dense_free(&X);
    ritz_dense_free(&Y);
    return status;
}

const ritz_ranker ritz_ranker_effective_interface_mass = {
    .name = "effective-interface-mass",
    .summary = "share of fixed-interface modes in the interface's mass",
    .reference = "KammerTriller1996",
    .needs = RITZ_RANK_INTERFACE,
    .sums = true,
    .rank = rank,
};
