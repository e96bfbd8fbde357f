/*
 * All pairs of a dense pencil, by LAPACK.
 *
 * Rows are first scaled so that the diagonal of M is one, as a pencil mixes kg
 * with kg m^2. If M = C C' then is well conditioned,
 *
 *     C^-1 K C^-T y = lambda y,   x = C^-T y.
 *
 * Otherwise M = Q diag(m) Q'; the null space N of M is condensed out, as its
 * eigenvalues are infinite, and what remains has a diagonal mass:
 *
 *     T = Q_r - N (N' K N)^-1 N' K Q_r,   T' K T y = lambda diag(m_r) y.
 *
 * Both err in lambda by about eps lambda_max. What is far below is found anew
 * within its own span X, where the largest eigenvalue is small:
 *
 *     X' K X y = lambda X' M X y,   x = X y.
 *
 * Held to: bars and membranes in closed form, masses of rank one, masses of
 * 1 and 1e8 side by side.
 */
#include "base/alloc.h"

#include <ritz/eigen.h>

#include <cblas.h>
#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of M scaled to unit diagonal: worse than this is condensed. */
static const double well_conditioned = 1e-8;

/* Of lambda_max: below this an eigenvalue has lost six digits and more. */
static const double far_below = 1e-6;

/* out = S A S, exactly symmetric. */
static ritz_status scale(const ritz_dense *A, const double *s, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int64_t n = A->nrow;

    RITZ_TRY(ritz_dense_new(n, n, out));
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++) {
            double mean = (A->val[i + j * n] + A->val[j + i * n]) / 2.0;

            RITZ_FAIL_IF(!isfinite(mean), RITZ_ERR_ARGUMENT,
                         "entry (%" PRId64 ", %" PRId64
                         ") of a matrix is not finite",
                         i, j);
            out->val[i + j * n] = s[i] * mean * s[j];
        }
done:
    return status;
}

/* s = M_jj^-1/2; where there is no mass, K_jj^-1/2 does as well. */
static ritz_status choose_scale(const ritz_dense *K, const ritz_dense *M,
                                double *s)
{
    ritz_status status = RITZ_OK;

    for (int64_t j = 0; j < M->nrow; j++) {
        double m = ritz_dense_col(M, j)[j];
        double k = ritz_dense_col(K, j)[j];

        RITZ_FAIL_IF(m < 0.0, RITZ_ERR_SINGULAR,
                     "mass is not positive definite: entry (%" PRId64
                     ", %" PRId64 ") is %g",
                     j, j, m);
        s[j] = m > 0.0 ? 1.0 / sqrt(m) : 1.0 / sqrt(k > 0.0 ? k : 1.0);
    }
done:
    return status;
}

static ritz_status lapack_status(int info)
{
    ritz_status status = RITZ_OK;

    RITZ_FAIL_IF(info == LAPACK_WORK_MEMORY_ERROR ||
                     info == LAPACK_TRANSPOSE_MEMORY_ERROR,
                 RITZ_ERR_MEMORY, "no memory for the eigenvectors");
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE,
                 "dense eigenvalues did not converge, LAPACK says %d", info);
done:
    return status;
}

/* Is M = C C' with a good condition number? C is written over M if so. */
static ritz_status is_definite(const ritz_dense *M, ritz_dense *C, bool *out)
{
    ritz_status status = RITZ_OK;
    int n = (int)M->nrow;
    double norm = 0.0;
    double rcond = 0.0;

    *out = false;
    RITZ_TRY(ritz_dense_copy(M, C));
    norm = LAPACKE_dlansy(LAPACK_COL_MAJOR, '1', 'L', n, M->val, n);
    if (LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, C->val, n) != 0)
        goto done;
    RITZ_TRY(lapack_status(
        LAPACKE_dpocon(LAPACK_COL_MAJOR, 'L', n, C->val, n, norm, &rcond)));
    *out = rcond > well_conditioned;
done:
    return status;
}

/* K := eigenvectors of K. */
static ritz_status standard(ritz_dense *K, double *lambda)
{
    int n = (int)K->nrow;

    return n == 0 ? RITZ_OK
                  : lapack_status(LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', n,
                                                 K->val, n, lambda));
}

/* K := vectors x, from K and C. */
static ritz_status by_cholesky(const ritz_dense *C, ritz_dense *K,
                               double *lambda)
{
    ritz_status status = RITZ_OK;
    int n = (int)K->nrow;

    RITZ_TRY(lapack_status(
        LAPACKE_dsygst(LAPACK_COL_MAJOR, 1, 'L', n, K->val, n, C->val, n)));
    RITZ_TRY(standard(K, lambda));
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit,
                n, n, 1.0, C->val, n, K->val, n);
done:
    return status;
}

/* T, n x rank, written over the last columns of Q; see the head. */
static ritz_status condense(const ritz_dense *K, ritz_dense *N, ritz_dense *Q_r)
{
    ritz_status status = RITZ_OK;
    ritz_dense KN = {0}, NKN = {0}, NKQ = {0}, fall = {0};
    int k = (int)N->ncol;
    int r = (int)Q_r->ncol;
    double rcond = 0.0;
    double norm = 0.0;

    RITZ_TRY(ritz_dense_mul(K, N, &KN));
    RITZ_TRY(ritz_dense_mul_tn(N, &KN, &NKN));
    norm = LAPACKE_dlansy(LAPACK_COL_MAJOR, '1', 'L', k, NKN.val, k);
    if (LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', k, NKN.val, k) == 0)
        RITZ_TRY(lapack_status(LAPACKE_dpocon(LAPACK_COL_MAJOR, 'L', k, NKN.val,
                                              k, norm, &rcond)));
    RITZ_FAIL_IF(!(rcond > k * DBL_EPSILON), RITZ_ERR_SINGULAR,
                 "mass is not positive definite, and neither is the stiffness "
                 "of the motions without mass");
    if (r == 0)
        goto done;
    RITZ_TRY(ritz_dense_mul_tn(&KN, Q_r, &NKQ));
    RITZ_TRY(lapack_status(
        LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', k, r, NKN.val, k, NKQ.val, k)));
    RITZ_TRY(ritz_dense_mul(N, &NKQ, &fall));
    for (int64_t i = 0; i < fall.nrow * fall.ncol; i++)
        Q_r->val[i] -= fall.val[i];
done:
    ritz_dense_free(&KN);
    ritz_dense_free(&NKN);
    ritz_dense_free(&NKQ);
    ritz_dense_free(&fall);
    return status;
}

/* X := T diag(m)^-1/2 y, with y the eigenvectors of what is condensed. */
static ritz_status solve_condensed(const ritz_dense *K, ritz_dense *T,
                                   const double *m, double *lambda,
                                   ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    ritz_dense KT = {0}, K_r = {0};

    for (int64_t j = 0; j < T->ncol; j++)
        for (int64_t i = 0; i < T->nrow; i++)
            ritz_dense_col(T, j)[i] /= sqrt(m[j]);
    RITZ_TRY(ritz_dense_mul(K, T, &KT));
    RITZ_TRY(ritz_dense_mul_tn(T, &KT, &K_r));
    RITZ_TRY(standard(&K_r, lambda));
    RITZ_TRY(ritz_dense_mul(T, &K_r, X));
done:
    ritz_dense_free(&KT);
    ritz_dense_free(&K_r);
    return status;
}

/* X from K and M, of which M is only semidefinite; M is lost. */
static ritz_status by_condensing(const ritz_dense *K, ritz_dense *M,
                                 double *lambda, ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    ritz_dense N = {0};
    ritz_dense Q_r = {0};
    int64_t n = M->nrow;
    int64_t null = 0;
    double *m = NULL;
    double limit = 0.0;

    RITZ_NEW(m, n);
    RITZ_TRY(standard(M, m));
    limit = 4.0 * (double)n * DBL_EPSILON * fmax(m[n - 1], 0.0);
    RITZ_FAIL_IF(m[0] < -limit, RITZ_ERR_SINGULAR,
                 "mass is not positive definite: it has the eigenvalue %.3e "
                 "of %.3e",
                 m[0], m[n - 1]);
    while (null < n && m[null] <= limit)
        null++;
    N = ritz_dense_part(M, 0, null);
    Q_r = ritz_dense_part(M, null, n - null);
    if (null > 0)
        RITZ_TRY(condense(K, &N, &Q_r));
    RITZ_TRY(solve_condensed(K, &Q_r, m + null, lambda, X));
done:
    free(m);
    return status;
}

/* |K x - lambda M x| / (||K||x| + |lambda||M||x||), || taken entry by entry. */
static double residual(const ritz_dense *K, const ritz_dense *M,
                       const double *x, double lambda)
{
    double gap = 0.0;
    double size = 0.0;

    for (int64_t j = 0; j < K->nrow; j++) {
        const double *k = ritz_dense_col(K, j);
        const double *m = ritz_dense_col(M, j);
        double g = 0.0;
        double b = 0.0;

        for (int64_t i = 0; i < K->nrow; i++) {
            g += (k[i] - lambda * m[i]) * x[i];
            b += (fabs(k[i]) + fabs(lambda * m[i])) * fabs(x[i]);
        }
        gap = hypot(gap, g);
        size = hypot(size, b);
    }
    return size > 0.0 ? gap / size : 0.0;
}

static ritz_status solve_once(const ritz_dense *K, const ritz_dense *M,
                              double *lambda, ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    ritz_dense K_s = {0}, M_s = {0}, C = {0};
    double *s = NULL;
    bool definite = false;

    RITZ_NEW(s, K->nrow);
    RITZ_TRY(choose_scale(K, M, s));
    RITZ_TRY(scale(K, s, &K_s));
    RITZ_TRY(scale(M, s, &M_s));
    RITZ_TRY(is_definite(&M_s, &C, &definite));
    if (definite) {
        RITZ_TRY(by_cholesky(&C, &K_s, lambda));
        *X = K_s;
        K_s = (ritz_dense){0};
    } else {
        RITZ_TRY(by_condensing(&K_s, &M_s, lambda, X));
    }
    for (int64_t j = 0; j < X->ncol; j++)
        for (int64_t i = 0; i < X->nrow; i++)
            ritz_dense_col(X, j)[i] *= s[i];
done:
    free(s);
    ritz_dense_free(&K_s);
    ritz_dense_free(&M_s);
    ritz_dense_free(&C);
    return status;
}

/* How many of the first @p count are far below the last of them. */
static int64_t count_low(int64_t count, const double *lambda)
{
    int64_t low = 0;

    while (low < count && fabs(lambda[low]) <= far_below * lambda[count - 1])
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
    RITZ_TRY(solve_once(&K_x, &M_x, lambda, &Y));
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
    ritz_status status = RITZ_OK;
    int64_t count = 0, low = 0;

    RITZ_TRY(solve_once(K, M, lambda, X));
    count = X->ncol;
    for (low = count_low(count, lambda); low > 0 && low < count;
         low = count_low(count, lambda)) {
        RITZ_TRY(settle(K, M, low, lambda, X));
        count = low;
    }
done:
    return status;
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
    for (int64_t j = 0; j < n; j++)
        pairs.residual[j] =
            residual(K, M, ritz_dense_col(&pairs.Phi, j), pairs.lambda[j]);
    pairs.num_rigid = ritz_eigen_rigid(
        n, pairs.lambda, n > 0 ? fmax(pairs.lambda[n - 1], 0.0) : 0.0);
    snprintf(pairs.engine, sizeof pairs.engine, "dense LAPACK");
    *out = pairs;
    pairs = (ritz_pairs){0};
done:
    ritz_pairs_free(&pairs);
    return status;
}
