/*
 * Motions without mass. With A = K + alpha M = C C', definite, the columns of
 * C'Phi are orthogonal; N is C'^-1 of what completes them:
 *
 *     N'AN = I,   Phi'AN = (Lambda + alpha) Phi'MN = 0,   so M N = 0
 */
#include "poles/state.h"

#include "base/alloc.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* C, lower triangle, of K + alpha M; alpha beyond all |lambda|. */
static ritz_status factor(const ritz_second_order *model, int64_t m,
                          const double *lambda, ritz_dense *C)
{
    int n = (int)model->K->nrow;
    double alpha = 0.0;
    int info = 0;

    for (int64_t k = 0; k < m; k++)
        alpha = fmax(alpha, 2.0 * fabs(lambda[k]));
    if (alpha == 0.0)
        alpha = 1.0;
    RITZ_CHECK(ritz_dense_copy(model->K, C));
    for (int64_t i = 0; i < C->nrow * C->ncol; i++)
        C->val[i] += alpha * model->M->val[i];
    info = LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, C->val, n);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_SINGULAR,
                   "neither mass nor stiffness holds a motion");
    return RITZ_OK;
}

/* The last n - m columns of an orthonormal basis whose first span B's. */
static ritz_status complete(ritz_dense *B, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int n = (int)B->nrow;
    int m = (int)B->ncol;
    double *tau = NULL;
    int info = 0;

    RITZ_NEW(tau, m);
    RITZ_TRY(ritz_dense_new(n, n - m, out));
    for (int64_t j = 0; j < n - m; j++)
        ritz_dense_col(out, j)[m + j] = 1.0;
    if (m > 0)
        info = LAPACKE_dgeqrf(LAPACK_COL_MAJOR, n, m, B->val, n, tau);
    if (m > 0 && info == 0)
        info = LAPACKE_dormqr(LAPACK_COL_MAJOR, 'L', 'N', n, n - m, m, B->val,
                              n, tau, out->val, n);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE,
                 "the motions without mass were not found");
done:
    free(tau);
    return status;
}

ritz_status ritz_massless(const ritz_second_order *model, const ritz_dense *Phi,
                          const double *lambda, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int n = (int)Phi->nrow;
    int m = (int)Phi->ncol;
    ritz_dense C = {0}, B = {0}, N = {0};

    RITZ_TRY(factor(model, m, lambda, &C));
    RITZ_TRY(ritz_dense_copy(Phi, &B));
    if (m > 0)
        cblas_dtrmm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, n, m, 1.0, C.val, n, B.val, n);
    RITZ_TRY(complete(&B, &N));
    if (n > m)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, n, n - m, 1.0, C.val, n, N.val, n);
    *out = N;
    N = (ritz_dense){0};
done:
    ritz_dense_free(&C);
    ritz_dense_free(&B);
    ritz_dense_free(&N);
    return status;
}
