/*
 * All finite modes, where only the columns h of M are not zero, and so only the
 * rows h of M x:
 *
 *     x = theta W M_hh x_h,   W = A^-1 E_h,   G = E_h' W = (A^-1)_hh
 *
 * and x_h solves the dense pencil G^-1 x_h = theta M_hh x_h, theta = lambda -
 * sigma: G^-1 is A condensed to h.
 */
#include "linear/condensed.h"

#include <lapacke.h>

/* G := G^-1, symmetric positive definite. */
static ritz_status invert_matrix(ritz_dense *G)
{
    int n = (int)G->nrow;
    int info = LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, G->val, n);

    if (info == 0)
        info = LAPACKE_dpotri(LAPACK_COL_MAJOR, 'L', n, G->val, n);
    RITZ_REFUSE_IF(
        info != 0, RITZ_ERR_SINGULAR,
        "stiffness condensed to the masses is not positive definite");
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < j; i++)
            G->val[i + j * n] = G->val[j + i * n];
    return RITZ_OK;
}

/* M_hh. */
static ritz_status pick_mass(const ritz_sparse *M, int64_t count,
                             const int64_t *h, ritz_dense *out)
{
    RITZ_OWN(ritz_sparse) M_hh = {0};

    RITZ_CHECK(ritz_sparse_extract(M, count, h, count, h, &M_hh));
    return ritz_sparse_dense(&M_hh, out);
}

ritz_status ritz_modes_condensed(const ritz_shifted *S, int64_t count,
                                 const int64_t *heavy, ritz_dense *X)
{
    RITZ_OWN(ritz_dense) W = {0}, G = {0}, M_hh = {0}, MX_h = {0};
    RITZ_OWN(ritz_pairs) small = {0};

    RITZ_CHECK(ritz_dense_new(S->K->nrow, count, &W));
    if (count > 0) {
        for (int64_t j = 0; j < count; j++)
            ritz_dense_col(&W, j)[heavy[j]] = 1.0;
        RITZ_CHECK(ritz_factor_solve(S->A, &W));
        RITZ_CHECK(ritz_dense_rows(&W, count, heavy, &G));
        RITZ_CHECK(invert_matrix(&G));
    }
    RITZ_CHECK(pick_mass(S->M, count, heavy, &M_hh));
    RITZ_CHECK(ritz_eigen_dense(&G, &M_hh, &small));
    RITZ_CHECK(ritz_dense_mul(&M_hh, &small.Phi, &MX_h));
    RITZ_CHECK(ritz_dense_mul(&W, &MX_h, X));
    for (int64_t j = 0; j < X->ncol; j++)
        for (int64_t i = 0; i < X->nrow; i++)
            ritz_dense_col(X, j)[i] *= small.lambda[j];
    return RITZ_OK;
}
