/*
 * All pairs of a dense pencil. LAPACK errs in lambda by about eps lambda_max.
 * What is far below is found anew within its own span X, where the largest
 * eigenvalue is small:
 *
 *     X' K X y = lambda X' M X y,   x = X y.
 *
 * Held to: bars and membranes in closed form, masses of rank one, masses of
 * 1 and 1e8 side by side.
 */
#include "linear/eigen_dense.h"

#include "base/alloc.h"

#include <ritz/eigen.h>

#include <cblas.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* |a + t b| of columns j. */
static double norm_of(double t, const ritz_dense *B, ritz_dense *A, int64_t j)
{
    int n = (int)A->nrow;
    double *a = ritz_dense_col(A, j);

    cblas_daxpy(n, t, ritz_dense_col(B, j), 1, a, 1);
    return cblas_dnrm2(n, a, 1);
}

/* |K x - lambda M x| / ||K||x| + |lambda||M||x||, || taken entry by entry. */
static ritz_status residuals(const ritz_dense *K, const ritz_dense *M,
                             ritz_pairs *pairs)
{
    ritz_status status = RITZ_OK;
    const ritz_dense *const matrix[] = {K, M};
    ritz_dense gap[2] = {0}, size[2] = {0};
    ritz_dense A = {0}, X = {0};

    RITZ_TRY(ritz_dense_abs(&pairs->Phi, &X));
    for (int k = 0; k < 2; k++) {
        RITZ_TRY(ritz_dense_abs(matrix[k], &A));
        RITZ_TRY(ritz_dense_mul(matrix[k], &pairs->Phi, &gap[k]));
        RITZ_TRY(ritz_dense_mul(&A, &X, &size[k]));
        ritz_dense_free(&A);
    }
    for (int64_t j = 0; j < X.ncol; j++) {
        double lambda = pairs->lambda[j];
        double most = norm_of(fabs(lambda), &size[1], &size[0], j);

        pairs->residual[j] =
            most > 0.0 ? norm_of(-lambda, &gap[1], &gap[0], j) / most : 0.0;
    }
done:
    for (int k = 0; k < 2; k++) {
        ritz_dense_free(&gap[k]);
        ritz_dense_free(&size[k]);
    }
    ritz_dense_free(&A);
    ritz_dense_free(&X);
    return status;
}

/* How many of the first @p count are far below the last of them. */
static int64_t count_low(int64_t count, const double *lambda)
{
    int64_t low = 0;

    while (low < count &&
           fabs(lambda[low]) <= RITZ_EIGEN_FAR_BELOW * lambda[count - 1])
        low++;
    return low;
}

/* The first columns of X, and their eigenvalues, from K and M in their span. */
static ritz_status settle(const ritz_dense *K, const ritz_dense *M,
                          int64_t count, double *lambda, ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    ritz_dense first = ritz_dense_part(X, 0, count);
    ritz_dense K_x = {0}, M_x = {0}, Y = {0}, XY = {0};

    RITZ_TRY(ritz_dense_congruence(K, &first, &K_x));
    RITZ_TRY(ritz_dense_congruence(M, &first, &M_x));
    RITZ_TRY(ritz_eigen_dense_once(&K_x, &M_x, lambda, &Y));
    RITZ_TRY(ritz_dense_mul(&first, &Y, &XY));
    memcpy(first.val, XY.val, (size_t)(XY.nrow * XY.ncol) * sizeof *first.val);
done:
    ritz_dense_free(&K_x);
    ritz_dense_free(&M_x);
    ritz_dense_free(&Y);
    ritz_dense_free(&XY);
    return status;
}

static ritz_status solve(const ritz_dense *K, const ritz_dense *M,
                         double *lambda, ritz_dense *X)
{
    int64_t count = 0, low = 0;

    RITZ_CHECK(ritz_eigen_dense_once(K, M, lambda, X));
    count = X->ncol;
    for (low = count_low(count, lambda); low > 0 && low < count;
         low = count_low(count, lambda)) {
        RITZ_CHECK(settle(K, M, low, lambda, X));
        count = low;
    }
    return RITZ_OK;
}

ritz_status ritz_eigen_dense(const ritz_dense *K, const ritz_dense *M,
                             ritz_pairs *out)
{
    ritz_status status = RITZ_OK;
    ritz_pairs pairs = {.proven_to = HUGE_VAL};
    int64_t n = K->nrow;

    RITZ_FAIL_IF(K->ncol != n || M->nrow != n || M->ncol != n,
                 RITZ_ERR_ARGUMENT,
                 "stiffness is %" PRId64 " x %" PRId64 " but mass %" PRId64
                 " x %" PRId64,
                 K->nrow, K->ncol, M->nrow, M->ncol);
    RITZ_NEW(pairs.lambda, n);
    RITZ_NEW(pairs.residual, n);
    if (n > 0)
        RITZ_TRY(solve(K, M, pairs.lambda, &pairs.Phi));
    else
        RITZ_TRY(ritz_dense_new(0, 0, &pairs.Phi));
    n = pairs.Phi.ncol;
    ritz_dense_orient(&pairs.Phi);
    RITZ_TRY(residuals(K, M, &pairs));
    pairs.num_rigid = ritz_eigen_rigid(
        n, pairs.lambda, n > 0 ? fmax(pairs.lambda[n - 1], 0.0) : 0.0);
    snprintf(pairs.engine, sizeof pairs.engine, "dense LAPACK");
    *out = pairs;
    pairs = (ritz_pairs){0};
done:
    ritz_pairs_free(&pairs);
    return status;
}
