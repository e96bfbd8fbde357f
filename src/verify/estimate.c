/*
 * How far a reduced model's frequencies can be off, without the full one's:
 * with x = T q of a reduced pair (theta, q), A = K - sigma M and sigma < 0,
 *
 *     r = K x - theta M x,   eps = |r|_(A^-1) / |x|_A
 *     |lambda - theta| <= eps (lambda - sigma)    for some lambda of (K, M)
 *
 * because M x - A x / (theta - sigma) = -r / (theta - sigma) is the residual of
 * the pencil (M, A), whose eigenvalues 1/(lambda - sigma) it bounds in the norm
 * of A^-1. The lower end, lambda >= (theta + eps sigma) / (1 + eps), is what a
 * projected theta, too high by nature, is held against:
 *
 *     bound = sqrt(theta / lambda_low) - 1
 *
 * Massless modes (lambda infinite) are within the statement: 1/lambda = 0.
 */
#include "base/alloc.h"

#include <ritz/eigen.h>
#include <ritz/factor.h>
#include <ritz/verify.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_LISTED = 100, MOST_SHIFTS = 16 };
/* Of the first flexible eigenvalue: the smaller, the tighter. */
static const double shift = 1e-2;
/* A bound that leaves no digit. */
static const double worthless = 1.0;

/* K - sigma M, factored; |sigma| grows where rounding wins over it. */
static ritz_status factor(const ritz_component *component, double *sigma,
                          ritz_sparse *A, ritz_factor **F)
{
    ritz_status status = RITZ_ERR_SINGULAR;

    for (int t = 0; t < MOST_SHIFTS && status == RITZ_ERR_SINGULAR; t++) {
        ritz_sparse_free(A);
        *sigma *= t > 0 ? 10.0 : 1.0;
        RITZ_TRY(
            ritz_sparse_add(1.0, &component->K, -*sigma, &component->M, A));
        status = ritz_factor_spd(A, F);
    }
done:
    return ritz_context(status, "estimate");
}

/* R = K X - M X diag(theta) */
static ritz_status residuals(const ritz_component *component,
                             const ritz_dense *X, const double *theta,
                             ritz_dense *R)
{
    ritz_status status = RITZ_OK;
    ritz_dense KX = {0};
    ritz_dense MX = {0};

    RITZ_TRY(ritz_sparse_mul(&component->K, X, &KX));
    RITZ_TRY(ritz_sparse_mul(&component->M, X, &MX));
    for (int64_t j = 0; j < X->ncol; j++)
        for (int64_t i = 0; i < X->nrow; i++)
            ritz_dense_col(&KX, j)[i] -= theta[j] * ritz_dense_col(&MX, j)[i];
    *R = KX;
    KX = (ritz_dense){0};
done:
    ritz_dense_free(&KX);
    ritz_dense_free(&MX);
    return status;
}

/* eps of each column of X. */
static ritz_status measure(const ritz_component *component, const ritz_dense *X,
                           const double *theta, double *sigma, double *eps)
{
    ritz_status status = RITZ_OK;
    ritz_sparse A = {0};
    ritz_factor *F = NULL;
    ritz_dense R = {0};
    ritz_dense S = {0};
    ritz_dense AX = {0};

    RITZ_TRY(residuals(component, X, theta, &R));
    RITZ_TRY(factor(component, sigma, &A, &F));
    RITZ_TRY(ritz_sparse_mul(&A, X, &AX));
    RITZ_TRY(ritz_dense_new(R.nrow, R.ncol, &S));
    for (int64_t k = 0; k < R.nrow * R.ncol; k++)
        S.val[k] = R.val[k];
    RITZ_TRY(ritz_factor_solve(F, &S));
    for (int64_t j = 0; j < X->ncol; j++)
        eps[j] = sqrt(fmax(ritz_dense_dot(&R, j, &S, j), 0.0) /
                      ritz_dense_dot(X, j, &AX, j));
done:
    ritz_sparse_free(&A);
    ritz_factor_free(&F);
    ritz_dense_free(&R);
    ritz_dense_free(&S);
    ritz_dense_free(&AX);
    return status;
}

static double bound_of(double theta, double sigma, double eps)
{
    double low = (theta + eps * sigma) / (1.0 + eps);

    return low > 0.0 ? fmin(sqrt(theta / low) - 1.0, worthless) : worthless;
}

/* Half of the highest frequency that the basis knows of. */
static double trusted_hertz(const ritz_basis *basis, const ritz_pairs *pairs)
{
    double highest = 0.0;

    for (int64_t k = 0; k < basis->columns.count; k++)
        if (isfinite(basis->columns.hertz[k]))
            highest = fmax(highest, basis->columns.hertz[k]);
    if (highest == 0.0 && pairs->Phi.ncol > 0)
        highest = ritz_eigen_hertz(pairs->lambda[pairs->Phi.ncol - 1]);
    return 0.5 * highest;
}

/* Modes first, first + 1, ... with their eps: the worst, and each. */
static ritz_status report(const ritz_pairs *pairs, int64_t count, double sigma,
                          const double *eps, ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    int64_t first = pairs->num_rigid;
    int64_t worst = 0;
    char name[RITZ_NAME_SIZE];
    char where[RITZ_NAME_SIZE];

    for (int64_t pass = -1; pass < count && pass < MOST_LISTED; pass++) {
        int64_t k = pass < 0 ? worst : pass;
        double theta = 0.0;

        for (int64_t j = 0; pass < 0 && j < count; j++)
            if (bound_of(pairs->lambda[first + j], sigma, eps[j]) >
                bound_of(pairs->lambda[first + k], sigma, eps[k]))
                k = j;
        theta = pairs->lambda[first + k];
        (void)snprintf(name, sizeof name, "mode-%" PRId64, first + k + 1);
        (void)snprintf(where, sizeof where, "mode %" PRId64 ", %.4g Hz",
                       first + k + 1, ritz_eigen_hertz(theta));
        RITZ_TRY(
            ritz_measures_add(out, pass < 0 ? "frequency-relative-bound" : name,
                              bound_of(theta, sigma, eps[k]), nan(""), where));
    }
done:
    return status;
}

/* Flexible modes up to a frequency, at least one if there is any. */
static int64_t count_trusted(const ritz_pairs *pairs, double hertz)
{
    int64_t first = pairs->num_rigid;
    int64_t count = pairs->Phi.ncol > first ? 1 : 0;

    while (first + count < pairs->Phi.ncol &&
           ritz_eigen_hertz(pairs->lambda[first + count]) <= hertz)
        count++;
    return count;
}

ritz_status ritz_estimate(const ritz_component *component,
                          const ritz_basis *basis, ritz_reduced *reduced)
{
    ritz_status status = RITZ_OK;
    ritz_pairs pairs = {0};
    ritz_dense part = {0}; /* borrowed columns of pairs.Phi */
    ritz_dense X = {0};
    ritz_measures found = {0};
    double *eps = NULL;
    double sigma = 0.0;

    RITZ_FAIL_IF(basis->T.nrow != component->num_dofs ||
                     basis->T.ncol != reduced->K.nrow,
                 RITZ_ERR_ARGUMENT, "the basis is not that of the reduction");
    RITZ_TRY(ritz_eigen_dense(&reduced->K, &reduced->M, &pairs));
    part.nrow = pairs.Phi.nrow;
    part.ncol = count_trusted(&pairs, trusted_hertz(basis, &pairs));
    if (part.ncol > 0) {
        part.val = ritz_dense_col(&pairs.Phi, pairs.num_rigid);
        /* a rigid motion that the basis holds badly may count as flexible */
        sigma = -shift * fmax(pairs.lambda[pairs.num_rigid],
                              DBL_EPSILON * pairs.lambda[pairs.Phi.ncol - 1]);
        RITZ_NEW(eps, part.ncol);
        RITZ_TRY(ritz_dense_mul(&basis->T, &part, &X));
        RITZ_TRY(measure(component, &X, pairs.lambda + pairs.num_rigid, &sigma,
                         eps));
        RITZ_TRY(report(&pairs, part.ncol, sigma, eps, &found));
    }
    ritz_measures_free(&reduced->estimates);
    reduced->estimates = found;
    found = (ritz_measures){0};
done:
    ritz_pairs_free(&pairs);
    ritz_dense_free(&X);
    ritz_measures_free(&found);
    free(eps);
    return status;
}
