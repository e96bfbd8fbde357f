/*
 * All pairs of a dense pencil, by LAPACK, once.
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
 */
#include "linear/eigen_dense.h"

#include "base/alloc.h"

#include <cblas.h>
#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* Of M scaled to unit diagonal: worse than this is condensed. */
static const double well_conditioned = 1e-8;

/* out = S A S, exactly symmetric. */
static ritz_status scale(const ritz_dense *A, const double *s, ritz_dense *out)
{
    int64_t n = A->nrow;

    RITZ_CHECK(ritz_dense_new(n, n, out));
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++) {
            double mean = (A->val[i + j * n] + A->val[j + i * n]) / 2.0;

            RITZ_REFUSE_IF(!isfinite(mean), RITZ_ERR_ARGUMENT,
                           "entry (%" PRId64 ", %" PRId64
                           ") of a matrix is not finite",
                           i, j);
            out->val[i + j * n] = s[i] * mean * s[j];
        }
    return RITZ_OK;
}

/* s = M_jj^-1/2; where there is no mass, K_jj^-1/2 does as well. */
static ritz_status choose_scale(const ritz_dense *K, const ritz_dense *M,
                                double *s)
{
    for (int64_t j = 0; j < M->nrow; j++) {
        double m = ritz_dense_col(M, j)[j];
        double k = ritz_dense_col(K, j)[j];

        RITZ_REFUSE_IF(m < 0.0, RITZ_ERR_SINGULAR,
                       "mass is not positive definite: entry (%" PRId64
                       ", %" PRId64 ") is %g",
                       j, j, m);
        s[j] = m > 0.0 ? 1.0 / sqrt(m) : 1.0 / sqrt(k > 0.0 ? k : 1.0);
    }
    return RITZ_OK;
}

static ritz_status lapack_status(int info)
{
    RITZ_REFUSE_IF(info == LAPACK_WORK_MEMORY_ERROR ||
                       info == LAPACK_TRANSPOSE_MEMORY_ERROR,
                   RITZ_ERR_MEMORY, "no memory for the eigenvectors");
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "dense eigenvalues did not converge, LAPACK says %d", info);
    return RITZ_OK;
}

/* Is M = C C' with a good condition number? C is written over M if so. */
static ritz_status is_definite(const ritz_dense *M, ritz_dense *C, bool *out)
{
    int n = (int)M->nrow;
    double norm = 0.0;
    double rcond = 0.0;

    *out = false;
    RITZ_CHECK(ritz_dense_copy(M, C));
    norm = LAPACKE_dlansy(LAPACK_COL_MAJOR, '1', 'L', n, M->val, n);
    if (LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, C->val, n) != 0)
        return RITZ_OK;
    RITZ_CHECK(lapack_status(
        LAPACKE_dpocon(LAPACK_COL_MAJOR, 'L', n, C->val, n, norm, &rcond)));
    *out = rcond > well_conditioned;
    return RITZ_OK;
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
    int n = (int)K->nrow;

    RITZ_CHECK(lapack_status(
        LAPACKE_dsygst(LAPACK_COL_MAJOR, 1, 'L', n, K->val, n, C->val, n)));
    RITZ_CHECK(standard(K, lambda));
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit,
                n, n, 1.0, C->val, n, K->val, n);
    return RITZ_OK;
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

ritz_status ritz_eigen_dense_once(const ritz_dense *K, const ritz_dense *M,
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
