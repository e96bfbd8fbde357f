#include "bases/gramian_range.h"

#include "linear/general.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* (A + A' + B B') in place (i, j) */
static double defect(const ritz_dense *A, const ritz_dense *B, int64_t i,
                     int64_t j)
{
    double sum = ritz_dense_col(A, j)[i] + ritz_dense_col(A, i)[j];

    for (int64_t k = 0; k < B->ncol; k++)
        sum += ritz_dense_col(B, k)[i] * ritz_dense_col(B, k)[j];
    return sum;
}

/* How many leading rows and columns keep the norm of it below the limit. */
static int64_t good(const ritz_dense *A, const ritz_dense *B, double limit,
                    double *norm)
{
    double sum = 0.0;

    *norm = 0.0;
    for (int64_t j = 0; j < A->nrow; j++) {
        for (int64_t i = 0; i <= j; i++)
            sum += (i < j ? 2.0 : 1.0) * pow(defect(A, B, i, j), 2.0);
        if (sqrt(sum) > limit)
            return j;
        *norm = sqrt(sum);
    }
    return A->nrow;
}

double ritz_gramian_defect(const ritz_dense *A, const ritz_dense *B)
{
    double norm = 0.0;

    (void)good(A, B, HUGE_VAL, &norm);
    return norm;
}

/* Columns k < r of Z times s^power. */
static ritz_status scaled(const ritz_dense *Z, const double *s, int64_t r,
                          double power, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_columns(Z, 0, r, out));
    for (int64_t j = 0; j < r; j++)
        for (int64_t i = 0; i < Z->nrow; i++)
            ritz_dense_col(out, j)[i] *= pow(s[j], power);
    return RITZ_OK;
}

/* Q, V, A and B of the first r values. */
static ritz_status transform(const ritz_dense *A, const ritz_dense *B,
                             const ritz_dense *Z, const double *s, int64_t r,
                             ritz_gramian_range *range)
{
    ritz_status status = RITZ_OK;
    ritz_gramian_range made = {.reached = range->reached,
                               .rounding = range->rounding};
    ritz_dense AQ = {0};

    RITZ_TRY(scaled(Z, s, r, 1.0, &made.Q));
    RITZ_TRY(scaled(Z, s, r, -1.0, &made.V));
    RITZ_TRY(ritz_dense_mul(A, &made.Q, &AQ));
    RITZ_TRY(ritz_dense_mul_tn(&made.V, &AQ, &made.A));
    RITZ_TRY(ritz_dense_mul_tn(&made.V, B, &made.B));
    ritz_gramian_range_free(range);
    *range = made;
    made = (ritz_gramian_range){0};
done:
    ritz_gramian_range_free(&made);
    ritz_dense_free(&AQ);
    return status;
}

ritz_status ritz_gramian_range_new(const ritz_dense *A, const ritz_dense *B,
                                   double tolerance, double limit,
                                   ritz_gramian_range *out)
{
    ritz_status status = RITZ_OK;
    ritz_gramian_range range = {0};
    ritz_dense U = {0}, Z = {0};
    double *s = NULL;
    int64_t n = A->nrow;
    int64_t r = 0;
    double least = fmax(tolerance, (double)n * DBL_EPSILON);

    RITZ_TRY(ritz_general_gramian(A, B, &U));
    RITZ_TRY(ritz_general_svd(&U, &Z, &s, NULL));
    while (r < n && s[r] > least * s[0])
        r++;
    RITZ_FAIL_IF(r == 0, RITZ_ERR_ARGUMENT,
                 "no flexible state is reached, the Gramian is zero: do the "
                 "inputs and outputs act on rigid motion alone?");
    range.reached = r;
    RITZ_TRY(transform(A, B, &Z, s, r, &range));
    r = good(&range.A, &range.B, limit, &range.rounding);
    RITZ_FAIL_IF(r == 0, RITZ_ERR_CONVERGENCE,
                 "rounding of the Gramian is as large as the least damping");
    if (r < range.reached)
        RITZ_TRY(transform(A, B, &Z, s, r, &range));
    *out = range;
    range = (ritz_gramian_range){0};
done:
    ritz_gramian_range_free(&range);
    ritz_dense_free(&U);
    ritz_dense_free(&Z);
    free(s);
    return status;
}

void ritz_gramian_range_free(ritz_gramian_range *range)
{
    ritz_dense_free(&range->Q);
    ritz_dense_free(&range->V);
    ritz_dense_free(&range->A);
    ritz_dense_free(&range->B);
    *range = (ritz_gramian_range){0};
}
