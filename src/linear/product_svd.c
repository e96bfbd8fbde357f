/*
 * With D the lengths of the rows of X (it has no fewer columns than Y, or the
 * two change places):
 *
 *     X'Y = (D^-1 X)' (D Y),   (D Y)' P = Q R,   F = (P' D^-1 X)' R'
 *
 *     F P_F = Q_F R_F,   G = P_F R_F',   G = U_G diag(s) V_G'
 *
 *     U = Q_F V_G,   V = Q U_G
 *
 * D Y carries the scaling of all rows, pivoting sorts it, and both F and G are
 * well behaved matrices times diagonal ones: one-sided Jacobi (LAPACK dgejsv)
 * then finds small values to a small relative error. Rows of R_F below eps^2 of
 * the first, which is the rounding of rounding, are left out. [Drmac1998]
 */
#include "linear/general.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* A P = Q R as LAPACK leaves it. */
typedef struct pivoted {
    ritz_dense A;   /* reflectors below R */
    double *tau;    /* of the reflectors */
    lapack_int *at; /* column j of A P is column at[j] - 1 of A */
    int64_t rank;   /* min(nrow, ncol), or as far as R is not negligible */
} pivoted;

static void pivoted_free(pivoted *f)
{
    ritz_dense_free(&f->A);
    RITZ_FREE(f->tau, f->at);
}

static ritz_status check_factor(const ritz_dense *A)
{
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        RITZ_REFUSE_IF(!isfinite(A->val[k]), RITZ_ERR_ARGUMENT,
                       "a factor of a product is not finite");
    return RITZ_OK;
}

/* QR factors of f->A with pivoted columns. */
static ritz_status factor_pivoted(pivoted *f)
{
    int m = (int)f->A.nrow;
    int n = (int)f->A.ncol;

    f->rank = m < n ? m : n;
    RITZ_CHECK_NEW(f->tau, f->rank);
    RITZ_CHECK_NEW(f->at, n);
    if (f->rank > 0)
        RITZ_REFUSE_IF(LAPACKE_dgeqp3(LAPACK_COL_MAJOR, m, n, f->A.val, m,
                                      f->at, f->tau) != 0,
                       RITZ_ERR_ARGUMENT, "a product is not finite");
    return RITZ_OK;
}

/* Q V, V of as many rows as R has. */
static ritz_status turn_columns(const pivoted *f, const ritz_dense *V,
                                ritz_dense *out)
{
    int m = (int)f->A.nrow;

    RITZ_CHECK(ritz_dense_new(m, V->ncol, out));
    ritz_dense_put(V, 0, 0, out);
    if (V->ncol > 0)
        RITZ_REFUSE_IF(
            LAPACKE_dormqr(LAPACK_COL_MAJOR, 'L', 'N', m, (int)V->ncol,
                           (int)V->nrow, f->A.val, m, f->tau, out->val, m) != 0,
            RITZ_ERR_CONVERGENCE, "vectors of a product were not found");
    return RITZ_OK;
}

/* D of X */
static ritz_status row_lengths(const ritz_dense *X, double **out)
{
    RITZ_OWN_ARRAY double *length = NULL;

    RITZ_CHECK_NEW(length, X->nrow);
    for (int64_t j = 0; j < X->ncol; j++)
        for (int64_t i = 0; i < X->nrow; i++)
            length[i] = hypot(length[i], ritz_dense_col(X, j)[i]);
    RITZ_MOVE(*out, length);
    return RITZ_OK;
}

/* (D Y)' */
static ritz_status scale_rows(const ritz_dense *Y, const double *length,
                              ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(Y->ncol, Y->nrow, out));
    for (int64_t j = 0; j < Y->ncol; j++)
        for (int64_t i = 0; i < Y->nrow; i++)
            ritz_dense_col(out, i)[j] = length[i] * ritz_dense_col(Y, j)[i];
    return RITZ_OK;
}

/* F = (P' D^-1 X)' R' */
static ritz_status multiply_scaled(const ritz_dense *X, const double *length,
                                   const pivoted *of_Y, ritz_dense *F)
{
    int64_t n = X->nrow;
    RITZ_OWN(ritz_dense) sorted = {0}, R = {0}; /* R', n x rank */

    RITZ_CHECK(ritz_dense_new(n, X->ncol, &sorted));
    RITZ_CHECK(ritz_dense_new(n, of_Y->rank, &R));
    for (int64_t j = 0; j < X->ncol; j++)
        for (int64_t i = 0; i < n; i++) {
            int64_t row = of_Y->at[i] - 1;

            if (length[row] > 0.0)
                ritz_dense_col(&sorted, j)[i] =
                    ritz_dense_col(X, j)[row] / length[row];
        }
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j <= i && j < of_Y->rank; j++)
            ritz_dense_col(&R, j)[i] = ritz_dense_col(&of_Y->A, i)[j];
    return ritz_dense_mul_tn(&sorted, &R, F);
}

/* G = P_F R_F', as far as R_F is not negligible. */
static ritz_status compress_factor(pivoted *of_F, ritz_dense *G)
{
    const ritz_dense *R = &of_F->A;
    int64_t r = of_F->rank;

    while (r > 0 && !(fabs(ritz_dense_col(R, r - 1)[r - 1]) >
                      RITZ_NEGLIGIBLE_SQUARE * fabs(R->val[0])))
        r--;
    of_F->rank = r;
    RITZ_CHECK(ritz_dense_new(R->ncol, r, G));
    for (int64_t i = 0; i < R->ncol; i++)
        for (int64_t j = 0; j <= i && j < r; j++)
            ritz_dense_col(G, j)[of_F->at[i] - 1] = ritz_dense_col(R, i)[j];
    return RITZ_OK;
}

/* G = U diag(s) V'; LAPACK scales values that would over- or underflow. */
static ritz_status rotate_columns(ritz_dense *G, bool vectors, double *s,
                                  ritz_dense *U, ritz_dense *V)
{
    int q = (int)G->nrow;
    int r = (int)G->ncol;
    double stat[7] = {0};
    lapack_int istat[3] = {0};
    int info = 0;

    RITZ_CHECK(ritz_dense_new(q, vectors ? r : 0, U));
    RITZ_CHECK(ritz_dense_new(r, vectors ? r : 0, V));
    if (r > 0)
        info = LAPACKE_dgejsv(LAPACK_COL_MAJOR, 'C', vectors ? 'U' : 'N',
                              vectors ? 'V' : 'N', 'R', 'N', 'N', q, r, G->val,
                              q, s, U->val, q, V->val, r, stat, istat);
    RITZ_REFUSE_IF(info < 0, RITZ_ERR_ARGUMENT, "a product is not finite");
    RITZ_REFUSE_IF(info > 0, RITZ_ERR_CONVERGENCE,
                   "singular values of a product did not converge");
    for (int i = 0; i < r && stat[0] != stat[1] && stat[1] != 0.0; i++)
        s[i] *= stat[0] / stat[1];
    return RITZ_OK;
}

/* Y has no more columns than X. */
static ritz_status find_svd(const ritz_dense *X, const ritz_dense *Y,
                            bool vectors, ritz_product_svd *out)
{
    RITZ_OWN(pivoted) of_Y = {0}, of_F = {0};
    RITZ_OWN(ritz_dense) G = {0}, U = {0}, V = {0};
    RITZ_OWN_ARRAY double *length = NULL;

    if (Y->ncol == 0 || Y->nrow == 0) { /* there is nothing to factor */
        RITZ_CHECK(ritz_dense_new(X->ncol, 0, &out->U));
        return ritz_dense_new(Y->ncol, 0, &out->V);
    }
    RITZ_CHECK(row_lengths(X, &length));
    RITZ_CHECK(scale_rows(Y, length, &of_Y.A));
    RITZ_CHECK(factor_pivoted(&of_Y));
    out->count = of_Y.rank;
    RITZ_CHECK_NEW(out->s, out->count);
    RITZ_CHECK(multiply_scaled(X, length, &of_Y, &of_F.A));
    RITZ_CHECK(factor_pivoted(&of_F));
    RITZ_CHECK(compress_factor(&of_F, &G));
    out->rank = of_F.rank;
    RITZ_CHECK(rotate_columns(&G, vectors, out->s, &U, &V));
    if (vectors) {
        RITZ_CHECK(turn_columns(&of_F, &V, &out->U));
        RITZ_CHECK(turn_columns(&of_Y, &U, &out->V));
    }
    return RITZ_OK;
}

ritz_status ritz_product_svd_new(const ritz_dense *X, const ritz_dense *Y,
                                 bool vectors, ritz_product_svd *out)
{
    bool swap = X->ncol < Y->ncol;
    RITZ_OWN(ritz_product_svd) svd = {0};
    ritz_dense U = {0};

    RITZ_REFUSE_IF(X->nrow != Y->nrow, RITZ_ERR_ARGUMENT,
                   "the factors of a product do not fit each other");
    RITZ_CHECK(check_factor(X));
    RITZ_CHECK(check_factor(Y));
    RITZ_CHECK(find_svd(swap ? Y : X, swap ? X : Y, vectors, &svd));
    if (swap) {
        U = svd.U;
        svd.U = svd.V;
        svd.V = U;
    }
    RITZ_MOVE(*out, svd);
    return RITZ_OK;
}

void ritz_product_svd_free(ritz_product_svd *svd)
{
    free(svd->s);
    ritz_dense_free(&svd->U);
    ritz_dense_free(&svd->V);
    *svd = (ritz_product_svd){0};
}
