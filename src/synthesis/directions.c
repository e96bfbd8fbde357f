#include "synthesis/directions.h"

#include "base/alloc.h"

#include <cblas.h>
#include <lapacke.h>

#include <math.h>
#include <stdlib.h>

ritz_status ritz_mass_factor(const ritz_reduced *body, const double *scale,
                             ritz_dense *L)
{
    ritz_status status = RITZ_OK;
    int64_t r = body->M.ncol;
    double stiffness = 0.0;
    double heaviest = ritz_dense_max(&body->M);
    double stiffest = ritz_dense_max(&body->K);

    RITZ_TRY(ritz_dense_new(r, r, L));
    for (int attempt = 0; attempt < 2; attempt++) {
        for (int64_t j = 0; j < r; j++)
            for (int64_t i = 0; i < r; i++)
                ritz_dense_col(L, j)[i] =
                    i < j ? 0.0
                          : scale[i] * scale[j] *
                                (ritz_dense_col(&body->M, j)[i] +
                                 stiffness * ritz_dense_col(&body->K, j)[i]);
        if (r == 0 ||
            LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', (int)r, L->val, (int)r) == 0)
            return RITZ_OK;
        stiffness = stiffest > 0.0 ? heaviest / stiffest : 0.0;
    }
    status = ritz_fail(RITZ_ERR_SINGULAR,
                       "the reduced mass is not positive definite");
done:
    return status;
}

ritz_status ritz_mass_transform(const ritz_dense *L, const double *scale,
                                const ritz_dense *W, ritz_dense *Y)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_dense_copy(W, Y));
    for (int64_t j = 0; j < Y->ncol; j++)
        for (int64_t i = 0; i < Y->nrow; i++)
            ritz_dense_col(Y, j)[i] /= scale[i];
    if (Y->nrow * Y->ncol > 0)
        cblas_dtrmm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, (int)Y->nrow, (int)Y->ncol, 1.0, L->val,
                    (int)Y->nrow, Y->val, (int)Y->nrow);
done:
    return status;
}

ritz_status ritz_span(ritz_dense *Y, double tolerance, double *largest,
                      ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int r = (int)Y->nrow;
    int m = (int)Y->ncol;
    int least = r < m ? r : m;
    int rank = 0;
    ritz_dense U = {0};
    double *sigma = NULL, *work = NULL;

    RITZ_NEW(sigma, least);
    RITZ_NEW(work, least);
    RITZ_TRY(ritz_dense_new(r, least, &U));
    if (least > 0) {
        RITZ_FAIL_IF(LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'S', 'N', r, m, Y->val, r,
                                    sigma, U.val, r, NULL, 1, work) != 0,
                     RITZ_ERR_CONVERGENCE,
                     "singular values of the composite set do not converge");
        *largest = fmax(*largest, sigma[0]);
    }
    while (rank < least && sigma[rank] > tolerance * *largest)
        rank++;
    RITZ_TRY(ritz_dense_columns(&U, 0, rank, out));
done:
    free(sigma);
    free(work);
    ritz_dense_free(&U);
    return status;
}

ritz_status ritz_take_out(const ritz_dense *U, ritz_dense *Y)
{
    ritz_status status = RITZ_OK;
    ritz_dense share = {0}, gone = {0};

    for (int pass = 0; pass < 2; pass++) {
        RITZ_TRY(ritz_dense_mul_tn(U, Y, &share));
        RITZ_TRY(ritz_dense_mul(U, &share, &gone));
        for (int64_t k = 0; k < Y->nrow * Y->ncol; k++)
            Y->val[k] -= gone.val[k];
        ritz_dense_free(&share);
        ritz_dense_free(&gone);
    }
done:
    ritz_dense_free(&share);
    ritz_dense_free(&gone);
    return status;
}
