/* Shared by all eigensolvers: counts of modes, rigid modes, units. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "linear/inertia.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <cblas.h>
#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

ritz_status ritz_eigen_count(const ritz_sparse *K, const ritz_sparse *M,
                             double tau, int64_t *out)
{
    return ritz_inertia_below(K, M, tau, NULL, out);
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
    RITZ_FREE(pairs->lambda, pairs->residual, pairs->error);
    *pairs = (ritz_pairs){0};
}

ritz_status ritz_pairs_copy(const ritz_pairs *from, int64_t count,
                            ritz_pairs *out)
{
    const ritz_dense Phi = ritz_dense_part(&from->Phi, 0, count);
    RITZ_OWN(ritz_pairs)
    copy = {.num_rigid = from->num_rigid < count ? from->num_rigid : count,
            .sigma = from->sigma,
            .proven_to = from->proven_to,
            .reason = from->reason};

    if (count < from->Phi.ncol)
        copy.proven_to = fmin(copy.proven_to, from->lambda[count]);
    RITZ_CHECK(ritz_dense_copy(&Phi, &copy.Phi));
    RITZ_CHECK_COPY(copy.lambda, from->lambda, count);
    RITZ_CHECK_COPY(copy.residual, from->residual, count);
    if (from->error)
        RITZ_CHECK_COPY(copy.error, from->error, count);
    memcpy(copy.engine, from->engine, sizeof copy.engine);
    RITZ_MOVE(*out, copy);
    return RITZ_OK;
}

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

/* out = S A S, exactly symmetric. @param[in] s  NULL: S is the identity */
static ritz_status scale_pencil(const ritz_dense *A, const double *s,
                                ritz_dense *out)
{
    int64_t n = A->nrow;

    RITZ_CHECK(ritz_dense_copy(A, out));
    ritz_dense_symmetrise(out);
    for (int64_t j = 0; j < n; j++) {
        double *column = out->val + j * n;

        for (int64_t i = 0; i < n; i++) {
            RITZ_REFUSE_IF(!isfinite(column[i]), RITZ_ERR_ARGUMENT,
                           "entry (%" PRId64 ", %" PRId64
                           ") of a matrix is not finite",
                           i, j);
            if (s)
                column[i] = s[i] * column[i] * s[j];
        }
    }
    return RITZ_OK;
}

ritz_status ritz_eigen_check_mass(int64_t count, const double *m, int64_t first,
                                  double least)
{
    for (int64_t j = 0; j < count; j++)
        RITZ_REFUSE_IF(m[j] < least, RITZ_ERR_SINGULAR,
                       "mass is not positive definite: entry (%" PRId64
                       ", %" PRId64 ") is %g",
                       first + j, first + j, m[j]);
    return RITZ_OK;
}

/* s = M_jj^-1/2; where there is no mass, K_jj^-1/2 does as well. */
static ritz_status choose_scale(const ritz_dense *K, const ritz_dense *M,
                                double *s)
{
    for (int64_t j = 0; j < M->nrow; j++) {
        double m = ritz_dense_col(M, j)[j];
        double k = ritz_dense_col(K, j)[j];

        RITZ_CHECK(ritz_eigen_check_mass(1, &m, j, 0.0));
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

/* K := eigenvectors of K. */
static ritz_status solve_standard(ritz_dense *K, double *lambda)
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
    RITZ_CHECK(solve_standard(K, lambda));
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit,
                n, n, 1.0, C->val, n, K->val, n);
    return RITZ_OK;
}

/* T, n x rank, written over the last columns of Q; see the head. */
static ritz_status condense_massless(const ritz_dense *K, ritz_dense *N,
                                     ritz_dense *Q_r)
{
    RITZ_OWN(ritz_dense) KN = {0}, NKN = {0}, NKQ = {0}, fall = {0};
    int k = (int)N->ncol;
    int r = (int)Q_r->ncol;
    double rcond = 0.0;

    RITZ_CHECK(ritz_dense_mul(K, N, &KN));
    RITZ_CHECK(ritz_dense_mul_tn(N, &KN, &NKN));
    RITZ_CHECK(ritz_general_cholesky(&NKN, &rcond));
    RITZ_REFUSE_IF(
        !(rcond > k * DBL_EPSILON), RITZ_ERR_SINGULAR,
        "mass is not positive definite, and neither is the stiffness "
        "of the motions without mass");
    if (r == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul_tn(&KN, Q_r, &NKQ));
    RITZ_CHECK(lapack_status(
        LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', k, r, NKN.val, k, NKQ.val, k)));
    RITZ_CHECK(ritz_dense_mul(N, &NKQ, &fall));
    ritz_dense_add(-1.0, &fall, Q_r);
    return RITZ_OK;
}

/* X := T diag(m)^-1/2 y, with y the eigenvectors of what is condensed. */
static ritz_status solve_condensed(const ritz_dense *K, ritz_dense *T,
                                   const double *m, double *lambda,
                                   ritz_dense *X)
{
    RITZ_OWN(ritz_dense) KT = {0}, K_r = {0};

    for (int64_t j = 0; j < T->ncol; j++)
        for (int64_t i = 0; i < T->nrow; i++)
            ritz_dense_col(T, j)[i] /= sqrt(m[j]);
    RITZ_CHECK(ritz_dense_mul(K, T, &KT));
    RITZ_CHECK(ritz_dense_mul_tn(T, &KT, &K_r));
    RITZ_CHECK(solve_standard(&K_r, lambda));
    return ritz_dense_mul(T, &K_r, X);
}

/* X from K and M, of which M is only semidefinite; M is lost. */
static ritz_status by_condensing(const ritz_dense *K, ritz_dense *M,
                                 double *lambda, ritz_dense *X)
{
    ritz_dense N = {0};
    ritz_dense Q_r = {0};
    int64_t n = M->nrow;
    int64_t null = 0;
    RITZ_OWN_ARRAY double *m = NULL;
    double limit = 0.0;

    RITZ_CHECK_NEW(m, n);
    RITZ_CHECK(solve_standard(M, m));
    limit = 4.0 * (double)n * DBL_EPSILON * fmax(m[n - 1], 0.0);
    RITZ_REFUSE_IF(m[0] < -limit, RITZ_ERR_SINGULAR,
                   "mass is not positive definite: it has the eigenvalue %.3e "
                   "of %.3e",
                   m[0], m[n - 1]);
    while (null < n && m[null] <= limit)
        null++;
    N = ritz_dense_part(M, 0, null);
    Q_r = ritz_dense_part(M, null, n - null);
    if (null > 0)
        RITZ_CHECK(condense_massless(K, &N, &Q_r));
    return solve_condensed(K, &Q_r, m + null, lambda, X);
}

/* @param[in] M  NULL: the identity */
static ritz_status solve_scaled(const ritz_dense *K, const ritz_dense *M,
                                double *lambda, ritz_dense *X)
{
    RITZ_OWN(ritz_dense) K_s = {0}, M_s = {0}, C = {0};
    RITZ_OWN_ARRAY double *s = NULL;
    double rcond = 0.0;

    if (!M) {
        RITZ_CHECK(scale_pencil(K, NULL, &K_s));
        RITZ_CHECK(solve_standard(&K_s, lambda));
        RITZ_MOVE(*X, K_s);
        return RITZ_OK;
    }
    RITZ_CHECK_NEW(s, K->nrow);
    RITZ_CHECK(choose_scale(K, M, s));
    RITZ_CHECK(scale_pencil(K, s, &K_s));
    RITZ_CHECK(scale_pencil(M, s, &M_s));
    RITZ_CHECK(ritz_dense_copy(&M_s, &C));
    RITZ_CHECK(ritz_general_cholesky_above(&C, RITZ_WELL_CONDITIONED, &rcond));
    if (rcond > RITZ_WELL_CONDITIONED) {
        RITZ_CHECK(by_cholesky(&C, &K_s, lambda));
        RITZ_MOVE(*X, K_s);
    } else {
        RITZ_CHECK(by_condensing(&K_s, &M_s, lambda, X));
    }
    ritz_dense_scale_rows(s, X);
    return RITZ_OK;
}

/* |a + t b| of columns j. */
static double norm_of(double t, const ritz_dense *B, ritz_dense *A, int64_t j)
{
    int n = (int)A->nrow;
    double *a = ritz_dense_col(A, j);

    cblas_daxpy(n, t, ritz_dense_col(B, j), 1, a, 1);
    return cblas_dnrm2(n, a, 1);
}

ritz_status ritz_eigen_residuals(const ritz_dense *K, const ritz_dense *M,
                                 ritz_pairs *pairs)
{
    const ritz_dense *const matrix[] = {K, M};
    RITZ_OWN(ritz_dense_pair) gap = {0};
    RITZ_OWN(ritz_dense_pair) size = {0};
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN(ritz_dense) X = {0};

    if (pairs->Phi.ncol == 0 || !isnan(pairs->residual[0]))
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_abs(&pairs->Phi, &X));
    for (int k = 0; k < 2; k++) {
        RITZ_CHECK(ritz_dense_abs(matrix[k], &A));
        RITZ_CHECK(ritz_dense_mul(matrix[k], &pairs->Phi, &gap[k]));
        RITZ_CHECK(ritz_dense_mul(&A, &X, &size[k]));
        ritz_dense_free(&A);
    }
    for (int64_t j = 0; j < X.ncol; j++) {
        double lambda = pairs->lambda[j];
        double most = norm_of(fabs(lambda), &size[1], &size[0], j);

        pairs->residual[j] =
            most > 0.0 ? norm_of(-lambda, &gap[1], &gap[0], j) / most : 0.0;
    }
    return RITZ_OK;
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

/*
 * The first columns of X, and their eigenvalues, from K and M in their span. In
 * K x of a low mode nearly all cancels, so that it is summed with twice the
 * digits.
 */
static ritz_status project_pairs(const ritz_sparse *K, const ritz_dense *M,
                                 int64_t count, double *lambda, ritz_dense *X)
{
    ritz_dense first = ritz_dense_part(X, 0, count);
    RITZ_OWN(ritz_dense) KX = {0}, K_x = {0}, M_x = {0}, Y = {0}, XY = {0};

    RITZ_CHECK(ritz_sparse_mul_twofold(K, &first, &KX));
    RITZ_CHECK(ritz_dense_mul_tn(&first, &KX, &K_x));
    ritz_dense_symmetrise(&K_x);
    if (M)
        RITZ_CHECK(ritz_dense_congruence(M, &first, &M_x));
    else
        RITZ_CHECK(ritz_dense_mul_tn(&first, &first, &M_x));
    RITZ_CHECK(solve_scaled(&K_x, &M_x, lambda, &Y));
    RITZ_CHECK(ritz_dense_mul(&first, &Y, &XY));
    memcpy(first.val, XY.val, (size_t)(XY.nrow * XY.ncol) * sizeof *first.val);
    return RITZ_OK;
}

static bool is_identity(const ritz_dense *M)
{
    for (int64_t j = 0; j < M->ncol; j++) {
        const double *m = ritz_dense_col(M, j);

        for (int64_t i = 0; i < M->nrow; i++)
            if (m[i] != (i == j ? 1.0 : 0.0))
                return false;
    }
    return true;
}

static bool is_finite_diagonal(const ritz_dense *K)
{
    for (int64_t j = 0; j < K->ncol; j++) {
        const double *k = ritz_dense_col(K, j);

        if (!isfinite(k[j]))
            return false;
        for (int64_t i = 0; i < K->nrow; i++)
            if (i != j && k[i] != 0.0)
                return false;
    }
    return true;
}

/*
 * Modal coordinates: lambda = K_jj, x = e_j. They are in ascending order as a
 * rule, so that one insertion each sorts them.
 */
static ritz_status take_modal(const ritz_dense *K, double *lambda,
                              ritz_dense *X)
{
    RITZ_OWN_ARRAY int64_t *dof = NULL;
    int64_t n = K->ncol;

    RITZ_CHECK_NEW(dof, n);
    RITZ_CHECK(ritz_dense_new(n, n, X));
    for (int64_t j = 0; j < n; j++) {
        double value = ritz_dense_col(K, j)[j];
        int64_t k = j;

        for (; k > 0 && lambda[k - 1] > value; k--) {
            lambda[k] = lambda[k - 1];
            dof[k] = dof[k - 1];
        }
        lambda[k] = value;
        dof[k] = j;
    }
    for (int64_t k = 0; k < n; k++)
        ritz_dense_col(X, k)[dof[k]] = 1.0;
    return RITZ_OK;
}

static ritz_status solve_pencil(const ritz_dense *K, const ritz_dense *M,
                                double *lambda, ritz_dense *X)
{
    RITZ_OWN(ritz_sparse) stored = {0};
    int64_t count = 0, low = 0;

    RITZ_CHECK(solve_scaled(K, M, lambda, X));
    count = X->ncol;
    for (low = count_low(count, lambda); low > 0 && low < count;
         low = count_low(count, lambda)) {
        if (!stored.colptr)
            RITZ_CHECK(ritz_sparse_from_dense(K, &stored));
        RITZ_CHECK(project_pairs(&stored, M, low, lambda, X));
        count = low;
    }
    return RITZ_OK;
}

/* @param[in] M  NULL: the identity */
static ritz_status solve_pairs(const ritz_dense *K, const ritz_dense *M,
                               ritz_pairs *out)
{
    RITZ_OWN(ritz_pairs) pairs = {.proven_to = HUGE_VAL};
    int64_t n = K->nrow;

    RITZ_CHECK_NEW(pairs.lambda, n);
    RITZ_CHECK_NEW(pairs.residual, n);
    if (!M && is_finite_diagonal(K)) {
        RITZ_CHECK(take_modal(K, pairs.lambda, &pairs.Phi));
    } else {
        RITZ_CHECK(solve_pencil(K, M, pairs.lambda, &pairs.Phi));
        ritz_dense_orient(&pairs.Phi);
        for (int64_t k = 0; k < n; k++)
            pairs.residual[k] = nan("");
    }
    n = pairs.Phi.ncol;
    pairs.num_rigid = ritz_eigen_rigid(
        n, pairs.lambda, n > 0 ? fmax(pairs.lambda[n - 1], 0.0) : 0.0);
    snprintf(pairs.engine, sizeof pairs.engine, "dense LAPACK");
    RITZ_MOVE(*out, pairs);
    return RITZ_OK;
}

ritz_status ritz_eigen_unchecked(const ritz_dense *K, const ritz_dense *M,
                                 ritz_pairs *out)
{
    RITZ_CHECK(ritz_eigen_refuse(K->nrow, K->ncol, M->nrow, M->ncol));
    return solve_pairs(K, is_identity(M) ? NULL : M, out);
}

ritz_status ritz_eigen_dense(const ritz_dense *K, const ritz_dense *M,
                             ritz_pairs *out)
{
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_eigen_unchecked(K, M, &pairs));
    RITZ_CHECK(ritz_eigen_residuals(K, M, &pairs));
    RITZ_MOVE(*out, pairs);
    return RITZ_OK;
}

ritz_status ritz_general_symmetric(const ritz_dense *A, ritz_pairs *out)
{
    RITZ_CHECK(ritz_eigen_refuse(A->nrow, A->ncol, A->nrow, A->ncol));
    return solve_pairs(A, NULL, out);
}

ritz_status ritz_general_symmetric_values(const ritz_dense *A, double *lambda)
{
    RITZ_OWN(ritz_dense) copy = {0};
    int n = (int)A->nrow;

    RITZ_CHECK(ritz_eigen_refuse(A->nrow, A->ncol, A->nrow, A->ncol));
    RITZ_CHECK(scale_pencil(A, NULL, &copy));
    return n == 0 ? RITZ_OK
                  : lapack_status(LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'N', 'L', n,
                                                 copy.val, n, lambda));
}
