/* Shared by all eigensolvers: counts of modes, rigid modes, units. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <ritz/matrix.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>

ritz_status ritz_eigen_refuse(int64_t rows_K, int64_t cols_K, int64_t rows_M,
                              int64_t cols_M)
{
    RITZ_REFUSE_IF(rows_K != cols_K || rows_M != rows_K || cols_M != rows_K,
                   RITZ_ERR_ARGUMENT,
                   "stiffness is %" PRId64 " x %" PRId64 " but mass %" PRId64
                   " x %" PRId64,
                   rows_K, cols_K, rows_M, cols_M);
    return RITZ_OK;
}

ritz_status ritz_eigen_count(const ritz_sparse *K, const ritz_sparse *M,
                             double tau, int64_t *out)
{
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_ldl) *F = NULL;

    RITZ_CHECK(ritz_eigen_refuse(K->nrow, K->ncol, M->nrow, M->ncol));
    RITZ_REFUSE_IF(!isfinite(tau), RITZ_ERR_ARGUMENT,
                   "modes below %g cannot be counted", tau);
    RITZ_CHECK(ritz_sparse_add(1.0, K, -tau, M, &A));
    ritz_monitor_step("count of modes", 0, 0);
    return ritz_ldl_new(&A, out, &F);
}

/*
 * One criterion: up to `limit` rounding may have left an eigenvalue, and the
 * next one is at least `gap` times larger.
 */
typedef struct cut {
    double limit; /* of |lambda| */
    double floor; /* what is smaller is as good as zero */
    double gap;
} cut;

/* The most that the cut allows; all of them, if none stands above. */
static int64_t count_below_cut(const cut *c, int64_t count,
                               const double *lambda)
{
    double largest = c->floor;
    int64_t found = 0;

    for (int64_t k = 0; k < count && fabs(lambda[k]) <= c->limit; k++) {
        largest = fmax(largest, fabs(lambda[k]));
        if (k + 1 == count || lambda[k + 1] >= c->gap * largest)
            found = k + 1;
    }
    return found;
}

int64_t ritz_eigen_rigid(int64_t count, const double *lambda, double lambda_max)
{
    const double rounding = DBL_EPSILON * fabs(lambda_max);
    const double ten_digits = RITZ_RIGID_DIGITS * fabs(lambda_max);
    const double negative = count > 0 ? fmax(-lambda[0], 0.0) : 0.0;
    const cut body = {ten_digits, rounding, 1e4};
    const cut noisy = {fmin(100.0 * negative, ten_digits), rounding, 1e4};
    const cut clean = {64.0 * rounding, rounding, 100.0};
    int64_t found = 0;

    if (count > 6 && count_below_cut(&body, 7, lambda) == 6)
        return 6;
    if (negative > clean.limit) {
        found = count_below_cut(&noisy, count, lambda);
        return found < count ? found : 0;
    }
    found = count_below_cut(&clean, count, lambda);
    for (int64_t k = 0; found == 0 && 2 * (k + 1) <= count; k++)
        if (fabs(lambda[k]) <= RITZ_FREE_MOTION * lambda[k + 1])
            found = k + 1;
    return found;
}

double ritz_eigen_hertz(double lambda)
{
    return copysign(sqrt(fabs(lambda)), lambda) / (2.0 * RITZ_PI);
}

double ritz_eigen_lambda(double hertz)
{
    double omega = 2.0 * RITZ_PI * hertz;

    return copysign(omega * omega, hertz);
}

void ritz_pairs_free(ritz_pairs *pairs)
{
    ritz_dense_free(&pairs->Phi);
    RITZ_FREE(pairs->lambda, pairs->residual);
    *pairs = (ritz_pairs){0};
}
