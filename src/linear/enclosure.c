/*
 * B = A^-1 M, A = K - sigma M, has the eigenvalues theta = 1 / (lambda - sigma)
 * and is symmetric in the inner product of M. If it has exactly m of them above
 * t, those of (B - t)^-1 that are positive belong to them, the largest to the
 * one nearest to t. Rayleigh-Ritz for (B - t)^-1 in the span of (B - t) X needs
 * only F1 = X'M B X and F2 = X'M B^2 X, with X'M X = I:
 *
 *     (F1 - t) q = mu (F2 - 2 t F1 + t^2) q
 *
 * and its j-th largest mu is a lower bound of the j-th largest eigenvalue, so
 * that the j-th theta above t is at most t + 1 / mu_j [Lehmann1963].
 *
 * Tests compare with the eigenvalues of random pencils by LAPACK.
 */
#include "linear/enclosure.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Columns of an inverse iteration that are solved for at once: a multiple of the
   width of a solve. */
enum { STEP = 64 };

void ritz_moments_free(ritz_moments *moments)
{
    ritz_dense_free(&moments->first);
    ritz_dense_free(&moments->second);
}

/* A_r := (A_r + A_r') / 2, with unit diagonal of M_r: Y_j / |Y_j|_M. */
static void balance_projection(ritz_dense *A_r, ritz_dense *M_r, ritz_dense *Y)
{
    int64_t k = Y->ncol;

    for (int64_t j = 0; j < k; j++) {
        double size = sqrt(ritz_dense_col(M_r, j)[j]);

        if (!(size > 0.0))
            continue;
        for (int64_t i = 0; i < k; i++) {
            A_r->val[i + j * k] /= size;
            M_r->val[i + j * k] /= size;
            A_r->val[j + i * k] /= size;
            M_r->val[j + i * k] /= size;
        }
        for (int64_t i = 0; i < Y->nrow; i++)
            ritz_dense_col(Y, j)[i] /= size;
    }
    ritz_dense_symmetrise(A_r);
}

/* X := A^-1 X, a few columns at a time to show progress. */
static ritz_status solve_in_steps(ritz_factor *A, ritz_dense *X)
{
    for (int64_t j = 0; j < X->ncol; j += STEP) {
        ritz_dense part =
            ritz_dense_part(X, j, X->ncol - j < STEP ? X->ncol - j : STEP);

        ritz_monitor_step("inverse iteration", j, X->ncol);
        RITZ_CHECK(ritz_factor_solve(A, &part));
    }
    return RITZ_OK;
}

/*
 * One inverse iteration and Rayleigh-Ritz: X becomes M-orthonormal, lambda
 * ascends.
 *
 *     A Y = M X,   A_r = Y' (M X),   M_r = Y' M Y,   A_r q = theta M_r q
 *
 * A Y is known without a product by A: with one, x' A x would lose all digits
 * of a soft mode, x' |A| |x| being that much larger.
 */
ritz_status ritz_vectors_polish(const ritz_shifted *S, ritz_dense *X,
                                double *lambda, ritz_moments *moments)
{
    RITZ_OWN(ritz_dense) MX = {0}, MY = {0};
    RITZ_OWN(ritz_dense) A_r = {0}, M_r = {0};
    RITZ_OWN(ritz_pairs) small = {0};

    RITZ_CHECK(ritz_sparse_mul(S->M, X, &MX));
    memcpy(X->val, MX.val, (size_t)(X->nrow * X->ncol) * sizeof *X->val);
    RITZ_CHECK(solve_in_steps(S->A, X)); /* X is Y now */
    RITZ_CHECK(ritz_dense_mul_tn(X, &MX, &A_r));
    RITZ_CHECK(ritz_sparse_mul(S->M, X, &MY));
    RITZ_CHECK(ritz_dense_mul_tn(X, &MY, &M_r));
    if (moments) {
        ritz_moments_free(moments);
        RITZ_CHECK(ritz_dense_copy(&A_r, &moments->first));
        RITZ_CHECK(ritz_dense_copy(&M_r, &moments->second));
    }
    balance_projection(&A_r, &M_r, X);
    RITZ_CHECK(ritz_eigen_dense(&A_r, &M_r, &small));
    RITZ_REFUSE_IF(small.Phi.ncol < X->ncol, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " eigenvectors depend on each other",
                   X->ncol - small.Phi.ncol);
    RITZ_CHECK(ritz_dense_times(&small.Phi, X));
    RITZ_CHECK(ritz_eigen_quotients(&A_r, &small.Phi, lambda));
    for (int64_t j = 0; j < X->ncol; j++)
        lambda[j] += S->sigma;
    return RITZ_OK;
}

ritz_status ritz_moments_enclose(const ritz_moments *moments, double sigma,
                                 double tau, int64_t count, double *lower)
{
    const ritz_dense *F1 = &moments->first;
    const double t = 1.0 / (tau - sigma);
    RITZ_OWN(ritz_dense) H = {0}, G = {0};
    RITZ_OWN(ritz_pairs) P = {0};

    RITZ_CHECK(ritz_dense_copy(F1, &H));
    RITZ_CHECK(ritz_dense_copy(&moments->second, &G));
    ritz_dense_add(-2.0 * t, F1, &G);
    for (int64_t j = 0; j < F1->ncol; j++) {
        ritz_dense_col(&H, j)[j] -= t;
        ritz_dense_col(&G, j)[j] += t * t;
    }
    ritz_dense_symmetrise(&H);
    ritz_dense_symmetrise(&G);
    RITZ_CHECK(ritz_eigen_dense(&H, &G, &P));
    for (int64_t j = 0; j < count; j++) {
        const int64_t last = P.Phi.ncol - 1 - j;
        const double mu = last >= 0 ? P.lambda[last] : 0.0;

        lower[count - 1 - j] =
            mu > 0.0 ? sigma + 1.0 / (t + 1.0 / mu) : -HUGE_VAL;
    }
    return RITZ_OK;
}

ritz_status ritz_pairs_bound(ritz_pairs *P, const ritz_moments *moments,
                             double sigma, double tau, int64_t count)
{
    RITZ_OWN_ARRAY double *lower = NULL;

    RITZ_CHECK_NEW(lower, count);
    RITZ_CHECK(ritz_moments_enclose(moments, sigma, tau, count, lower));
    if (!P->error)
        RITZ_CHECK_NEW(P->error, P->Phi.ncol);
    for (int64_t j = 0; j < P->Phi.ncol; j++) {
        const int64_t unit = j < P->num_rigid ? P->num_rigid : j;
        const double scale = unit < P->Phi.ncol ? P->lambda[unit] : tau;

        P->error[j] = j < count
                          ? fmax(0.0, (P->lambda[j] - lower[j]) / fabs(scale))
                          : HUGE_VAL;
    }
    return RITZ_OK;
}
