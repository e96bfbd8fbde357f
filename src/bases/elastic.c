/*
 * A free body responds to forces F by rigid motion and by deformation. With the
 * rigid modes Phi, Phi' M Phi = I, and P = I - M Phi Phi', the deformation is
 *
 *     X = P' S P F,    S = | K_ww^-1  0 |  w: all dofs but the support r
 *                          |    0     0 |  r: as many dofs as rigid modes
 *
 * and does not depend on r [LeeTsuha1992, eq. 6]: P F is in equilibrium, so
 * that the support forces are zero, and P' removes the rigid motion that S
 * implies. This costs one definite factorization and one solution a column.
 * Away from 0 Hz, rigid and elastic motion are decoupled in A = K - sigma M; P
 * only removes rounding.
 *
 * r is chosen so that Phi at r is far from singular, by the part that each dof
 * has in the mass of rigid motion: rows of diag(M)^1/2 Phi, the largest first.
 */
#include "bases/elastic.h"
#include "base/alloc.h"
#include "base/tolerances.h"

#include <math.h>
#include <stdlib.h>

/* Row of W, r columns and stored row by row, with the largest square. */
static int64_t largest_row(int64_t n, int64_t r, const double *W)
{
    int64_t best = 0;
    double most = -1.0;

    for (int64_t i = 0; i < n; i++) {
        double sum = 0.0;

        for (int64_t k = 0; k < r; k++)
            sum += W[i * r + k] * W[i * r + k];
        if (sum > most * RITZ_TIE) {
            most = sum;
            best = i;
        }
    }
    return best;
}

/* Rows of W less their part along row `pivot`, which becomes zero. */
static void deflate_rows(int64_t n, int64_t r, int64_t pivot, double *W)
{
    double size = 0.0;

    for (int64_t k = 0; k < r; k++)
        size += W[pivot * r + k] * W[pivot * r + k];
    if (!(size > 0.0))
        return;
    for (int64_t i = 0; i < n; i++) {
        double part = 0.0;

        if (i == pivot)
            continue;
        for (int64_t k = 0; k < r; k++)
            part += W[i * r + k] * W[pivot * r + k] / size;
        for (int64_t k = 0; k < r; k++)
            W[i * r + k] -= part * W[pivot * r + k];
    }
    for (int64_t k = 0; k < r; k++)
        W[pivot * r + k] = 0.0;
}

/* As many dofs as there are rigid modes. */
static ritz_status choose_support(ritz_elastic *E)
{
    int64_t n = E->Phi.nrow;
    int64_t r = E->Phi.ncol;
    RITZ_OWN_ARRAY double *W = NULL;

    RITZ_CHECK_NEW(W, n * r);
    RITZ_CHECK_NEW(E->held.at, r);
    for (int64_t i = 0; i < n; i++)
        for (int64_t k = 0; k < r; k++)
            W[i * r + k] = sqrt(fabs(ritz_sparse_diagonal(E->M, i))) *
                           ritz_dense_col(&E->Phi, k)[i];
    for (; E->held.count < r; E->held.count++) {
        int64_t pivot = largest_row(n, r, W);

        E->held.at[E->held.count] = pivot;
        deflate_rows(n, r, pivot, W);
    }
    return ritz_dofs_complement(&E->held, n, &E->rest);
}

static ritz_status find_rigid(const ritz_pairs *known, ritz_elastic *E)
{
    const ritz_span rigid_only = {.modes = 0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    if (known)
        RITZ_CHECK(ritz_pairs_copy(known, known->num_rigid, &pairs));
    else
        RITZ_CHECK_IN("rigid modes",
                      ritz_eigen_sparse(E->K, E->M, &rigid_only, &pairs));
    RITZ_MOVE(E->Phi, pairs.Phi);
    RITZ_MOVE(E->residual, pairs.residual);
    return ritz_sparse_mul(E->M, &E->Phi, &E->MPhi);
}

/* Why K has no factorization, apart from its rigid modes. */
static ritz_status refuse_stiffness(const ritz_elastic *E)
{
    const ritz_span one = {.modes = 1};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_eigen_sparse(E->K, E->M, &one, &pairs));
    RITZ_REFUSE_IF(pairs.Phi.ncol > 0 && pairs.lambda[0] < 0.0,
                   RITZ_ERR_SINGULAR,
                   "K is not positive semidefinite: an eigenvalue is %.3g",
                   pairs.lambda[0]);
    return ritz_fail(RITZ_ERR_SINGULAR,
                     "K is singular, but for no rigid motion that has mass");
}

static ritz_status factor_stiffness(ritz_elastic *E)
{
    const ritz_dofs *w = &E->rest;
    RITZ_OWN(ritz_sparse) K_ww = {0};
    ritz_status status = RITZ_OK;

    if (w->count == 0)
        return RITZ_OK;
    RITZ_CHECK(
        ritz_sparse_extract(E->K, w->count, w->at, w->count, w->at, &K_ww));
    status = ritz_factor_spd(&K_ww, &E->L);
    return status == RITZ_ERR_SINGULAR ? refuse_stiffness(E) : status;
}

ritz_status ritz_elastic_new(const ritz_sparse *K, const ritz_sparse *M,
                             const ritz_pairs *known, ritz_elastic *out)
{
    RITZ_OWN(ritz_elastic) E = {.K = K, .M = M};

    RITZ_CHECK(find_rigid(known, &E));
    RITZ_CHECK(choose_support(&E));
    RITZ_CHECK(factor_stiffness(&E));
    RITZ_MOVE(*out, E);
    return RITZ_OK;
}

/* X := X - left (right' X), twice, which is enough. */
static ritz_status take_out_twice(const ritz_dense *left,
                                  const ritz_dense *right, ritz_dense *X)
{
    for (int k = 0; k < 2 && left->ncol > 0 && X->ncol > 0; k++)
        RITZ_CHECK(ritz_dense_take_out(left, right, X));
    return RITZ_OK;
}

ritz_status ritz_elastic_relieve(const ritz_elastic *E, ritz_dense *F)
{
    return take_out_twice(&E->MPhi, &E->Phi, F);
}

/* X := S X. */
static ritz_status solve_supported(const ritz_elastic *E, ritz_dense *X)
{
    const ritz_dofs *w = &E->rest;
    RITZ_OWN(ritz_dense) X_w = {0};

    if (E->held.count == 0)
        return E->L ? ritz_factor_solve(E->L, X) : RITZ_OK;
    RITZ_CHECK(ritz_dense_rows(X, w->count, w->at, &X_w));
    if (E->L)
        RITZ_CHECK(ritz_factor_solve(E->L, &X_w));
    ritz_dense_spread(&X_w, w->at, X);
    return RITZ_OK;
}

ritz_status ritz_elastic_respond(const ritz_elastic *E, ritz_ldl *A,
                                 ritz_dense *X)
{
    if (X->ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_elastic_relieve(E, X));
    RITZ_CHECK(A ? ritz_ldl_solve(A, X) : solve_supported(E, X));
    return take_out_twice(&E->Phi, &E->MPhi, X);
}

void ritz_elastic_free(ritz_elastic *E)
{
    ritz_dense_free(&E->Phi);
    ritz_dense_free(&E->MPhi);
    free(E->residual);
    ritz_dofs_free(&E->held);
    ritz_dofs_free(&E->rest);
    ritz_factor_free(&E->L);
    *E = (ritz_elastic){0};
}
