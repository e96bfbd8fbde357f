#include "compare/directions.h"

#include "base/alloc.h"

#include <cblas.h>
#include <lapacke.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Of mass scaled to unit diagonal: below this it counts as singular. */
static const double well_conditioned = 1e-12;

double ritz_typical_lambda(const ritz_reduced *body)
{
    double sum = 0.0;
    int64_t count = 0;

    for (int64_t j = 0; j < body->K.ncol; j++) {
        double k = ritz_dense_col(&body->K, j)[j];
        double m = ritz_dense_col(&body->M, j)[j];

        if (k > 0.0 && m > 0.0) {
            sum += log(k / m);
            count++;
        }
    }
    return count > 0 ? exp(sum / (double)count) : 1.0;
}

/* L = lower triangle of S (M + stiffness K) S. */
static void fill(const ritz_reduced *body, const double *scale,
                 double stiffness, ritz_dense *L)
{
    for (int64_t j = 0; j < L->ncol; j++)
        for (int64_t i = 0; i < L->nrow; i++)
            ritz_dense_col(L, j)[i] =
                i < j ? 0.0
                      : scale[i] * scale[j] *
                            (ritz_dense_col(&body->M, j)[i] +
                             stiffness * ritz_dense_col(&body->K, j)[i]);
}

/* Factor L in place; false if it is not definite, or conditioned worse. */
static bool factor(ritz_dense *L, double least)
{
    int r = (int)L->ncol;
    double norm = 0.0, rcond = 1.0;

    if (r == 0)
        return true;
    norm = LAPACKE_dlansy(LAPACK_COL_MAJOR, '1', 'L', r, L->val, r);
    if (LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', r, L->val, r) != 0)
        return false;
    return LAPACKE_dpocon(LAPACK_COL_MAJOR, 'L', r, L->val, r, norm, &rcond) ==
               0 &&
           rcond > least;
}

ritz_status ritz_mixed_factor(const ritz_reduced *body, const double *scale,
                              double lambda, ritz_dense *L)
{
    RITZ_CHECK(ritz_dense_new(body->M.ncol, body->M.ncol, L));
    fill(body, scale, 1.0 / lambda, L);
    RITZ_REFUSE_IF(
        !factor(L, DBL_EPSILON), RITZ_ERR_SINGULAR,
        "a motion has neither mass nor stiffness, or the reduced mass "
        "is not positive");
    return RITZ_OK;
}

ritz_status ritz_mass_factor(const ritz_reduced *body, const double *scale,
                             ritz_dense *L, bool *mixed)
{
    int64_t r = body->M.ncol;

    *mixed = false;
    RITZ_CHECK(ritz_dense_new(r, r, L));
    fill(body, scale, 0.0, L);
    if (factor(L, well_conditioned))
        return RITZ_OK;
    *mixed = true;
    ritz_dense_free(L);
    return ritz_mixed_factor(body, scale, ritz_typical_lambda(body), L);
    return RITZ_OK;
}

void ritz_mass_return(const ritz_dense *L, const double *scale, ritz_dense *U)
{
    int r = (int)U->nrow;

    if (U->ncol > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, r, (int)U->ncol, 1.0, L->val, r, U->val, r);
    for (int64_t j = 0; j < U->ncol; j++)
        for (int64_t i = 0; i < r; i++)
            ritz_dense_col(U, j)[i] *= scale[i];
}

ritz_status ritz_mass_transform(const ritz_dense *L, const double *scale,
                                const ritz_dense *W, ritz_dense *Y)
{
    RITZ_CHECK(ritz_dense_copy(W, Y));
    for (int64_t j = 0; j < Y->ncol; j++)
        for (int64_t i = 0; i < Y->nrow; i++)
            ritz_dense_col(Y, j)[i] /= scale[i];
    if (Y->nrow * Y->ncol > 0)
        cblas_dtrmm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, (int)Y->nrow, (int)Y->ncol, 1.0, L->val,
                    (int)Y->nrow, Y->val, (int)Y->nrow);
    return RITZ_OK;
}

ritz_status ritz_span_values(ritz_dense *Y, double tolerance, double *largest,
                             double *value, ritz_dense *out)
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
    for (int k = 0; value && k < rank; k++)
        value[k] = sigma[k];
    RITZ_TRY(ritz_dense_columns(&U, 0, rank, out));
done:
    free(sigma);
    free(work);
    ritz_dense_free(&U);
    return status;
}

ritz_status ritz_span_of(ritz_dense *Y, double tolerance, double *largest,
                         ritz_dense *out)
{
    return ritz_span_values(Y, tolerance, largest, NULL, out);
}
