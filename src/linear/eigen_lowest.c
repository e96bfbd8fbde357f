/*
 * Lowest pairs of a sparse pencil: a small one is solved by LAPACK, any other by
 * the search of eigen_sparse.c.
 */
#include "base/tolerances.h"
#include "linear/eigen_sparse.h"
#include "linear/general.h"
#include "linear/requested.h"
#include "linear/residuals.h"
#include "linear/spectra.h"
#include "linear/trial.h"

#include <inttypes.h>
#include <math.h>

/* Every mode, so that none can be missing; from the store that is lent, if the
   pencil was solved before. */
static ritz_status solve_all(const ritz_sparse *K, const ritz_sparse *M,
                             ritz_pairs *out)
{
    RITZ_OWN(ritz_dense) K_d = {0}, M_d = {0};
    RITZ_OWN(ritz_pairs) P = {0};

    RITZ_CHECK(ritz_sparse_dense(K, &K_d));
    RITZ_CHECK(ritz_sparse_dense(M, &M_d));
    RITZ_CHECK(ritz_eigen_unchecked(&K_d, &M_d, &P));
    if (K->nrow <= ritz_trial_here()->small)
        RITZ_CHECK(ritz_spectra_keep(K, M, &P));
    RITZ_MOVE(*out, P);
    return RITZ_OK;
}

/* Residuals that LAPACK's pairs have not got yet. All pairs are here, so that
   their rigid ones are known already. */
static ritz_status find_residuals(const ritz_sparse *K, const ritz_sparse *M,
                                  ritz_pairs *P)
{
    const int64_t rigid = P->num_rigid;
    double worst = 0.0;

    if (P->Phi.ncol > 0 && isnan(P->residual[0]))
        RITZ_CHECK(ritz_pairs_assess(K, M, P, NULL, &worst));
    P->num_rigid = rigid;
    return RITZ_OK;
}

/* The requested ones of all modes, with their residuals. */
static ritz_status by_lapack(const ritz_sparse *K, const ritz_sparse *M,
                             const ritz_span *span, ritz_pairs *out)
{
    const ritz_pairs *known = ritz_spectra_find(K, M);
    RITZ_OWN(ritz_pairs) P = {0};
    double limit = 0.0;
    int64_t end = 0;

    if (known)
        RITZ_CHECK(ritz_pairs_copy(known, known->Phi.ncol, &P));
    else
        RITZ_CHECK(solve_all(K, M, &P));
    if (span->modes < 0)
        limit = ritz_eigen_lambda(span->up_to_hz) * (1.0 + RITZ_SPAN_ROUNDING);
    end = ritz_pairs_wanted(&P, span, limit);
    if (end < P.Phi.ncol) /* limit is 0 for a number of modes */
        P.proven_to =
            fmax(limit, ritz_pairs_between(&P, end, RITZ_COUNT_PLACE));
    ritz_pairs_truncate(&P, end);
    RITZ_CHECK(find_residuals(K, M, &P));
    RITZ_MOVE(*out, P);
    return RITZ_OK;
}

/* @param[in] given  what a search may take over; NULL: nothing */
static ritz_status find_lowest(const ritz_sparse *K, const ritz_sparse *M,
                               const ritz_eigen_given *given,
                               const ritz_span *span,
                               const ritz_factor_use *use, ritz_pairs *out)
{
    const ritz_trial *size = ritz_trial_here();
    const int64_t n = K->nrow;

    RITZ_CHECK(ritz_eigen_refuse(n, K->ncol, M->nrow, M->ncol));
    RITZ_REFUSE_IF(span->modes < -1, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " modes cannot be asked for", span->modes);
    RITZ_REFUSE_IF(span->modes < 0 &&
                       !(span->up_to_hz > 0.0 && isfinite(span->up_to_hz)),
                   RITZ_ERR_ARGUMENT, "modes up to %g Hz cannot be asked for",
                   span->up_to_hz);
    RITZ_CHECK(ritz_eigen_refuse_accuracy(span));
    if (n <= size->small || (n <= size->medium && span->modes > n / 4))
        return by_lapack(K, M, span, out);
    return ritz_eigen_search(K, M, given, span, use, out);
}

ritz_status ritz_eigen_sparse(const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_span *span, ritz_pairs *out)
{
    return find_lowest(K, M, NULL, span, NULL, out);
}

ritz_status ritz_eigen_lending(const ritz_sparse *K, const ritz_sparse *M,
                               const ritz_span *span,
                               const ritz_factor_use *use, ritz_pairs *out)
{
    return find_lowest(K, M, NULL, span, use, out);
}

ritz_status ritz_eigen_factored(ritz_sparse *K, ritz_sparse *M, ritz_factor **L,
                                const ritz_span *span,
                                const ritz_factor_use *use, ritz_pairs *out)
{
    const ritz_eigen_given given = {.L = L, .K = K, .M = M};
    ritz_status status = find_lowest(K, M, &given, span, use, out);

    if (status == RITZ_OK && use && *L) /* LAPACK did not take it */
        status = use->call(use->of, out, out->Phi.ncol, *L, 0.0);
    ritz_factor_free(L);
    return status;
}
