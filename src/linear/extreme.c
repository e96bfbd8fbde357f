/*
 * Lanczos iterations on B^-1 A, which is symmetric in the inner product of B:
 *
 *     w = B^-1 A v_j - V h,   h = V'A v_j,   b_j = |w|_B,   v_j+1 = w / b_j
 *
 * The h_j and b_j are the tridiagonal T = V'A V, whose eigenvalues tend to those
 * at the ends of the spectrum first. One with vector s has the residual
 * b_m |s_m| . If it is not small after STEPS vectors, the iteration
 * is restarted with V s.
 */
#include "linear/extreme.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 60, RESTARTS = 40, EACH = 5 };

typedef struct krylov {
    const ritz_sparse *A, *B;
    ritz_factor *F;
    ritz_dense V; /* n x STEPS */
    int64_t count;
    double diagonal[STEPS], beside[STEPS];
    double *work; /* n */
} krylov;

/* An eigenvalue of T, its residual and its vector. */
typedef struct approximation {
    double theta, residual, largest;
    double s[STEPS];
} approximation;

static void krylov_free(krylov *k)
{
    ritz_dense_free(&k->V);
    free(k->work);
}

/* y := A x */
static ritz_status multiply(const ritz_sparse *A, const double *x, double *y)
{
    RITZ_OWN(ritz_dense) X = {0}, Y = {0};

    RITZ_CHECK(ritz_dense_new(A->ncol, 1, &X));
    memcpy(X.val, x, (size_t)A->ncol * sizeof *x);
    RITZ_CHECK(ritz_sparse_mul(A, &X, &Y));
    memcpy(y, Y.val, (size_t)A->nrow * sizeof *y);
    return RITZ_OK;
}

/* w := B^-1 A v */
static ritz_status apply(const krylov *k, const double *v, double *w)
{
    ritz_dense W = {k->A->nrow, 1, w};

    RITZ_CHECK(multiply(k->A, v, w));
    return ritz_factor_solve(k->F, &W);
}

static ritz_status norm_of(const krylov *k, const double *w, double *out)
{
    const int n = (int)k->A->nrow;

    RITZ_CHECK(multiply(k->B, w, k->work));
    *out = sqrt(fmax(cblas_ddot(n, w, 1, k->work, 1), 0.0));
    return RITZ_OK;
}

/* w -= V V'B w, twice; h += the last entry of V'B w. */
static ritz_status orthogonalise(const krylov *k, double *w, double *h)
{
    const int n = (int)k->A->nrow, m = (int)k->count;
    double c[STEPS];

    for (int twice = 0; twice < 2; twice++) {
        RITZ_CHECK(multiply(k->B, w, k->work));
        cblas_dgemv(CblasColMajor, CblasTrans, n, m, 1.0, k->V.val, n, k->work,
                    1, 0.0, c, 1);
        cblas_dgemv(CblasColMajor, CblasNoTrans, n, m, -1.0, k->V.val, n, c, 1,
                    1.0, w, 1);
        *h += c[m - 1];
    }
    return RITZ_OK;
}

/* Begin with w of length @p size. */
static void begin(krylov *k, const double *w, double size)
{
    for (int64_t i = 0; i < k->A->nrow; i++)
        k->V.val[i] = w[i] / size;
    k->count = 1;
}

/* The next vector; its length is `beside` of the one before. */
static ritz_status step(krylov *k)
{
    const int64_t j = k->count - 1, n = k->A->nrow;
    RITZ_OWN_ARRAY double *w = NULL;

    RITZ_CHECK_NEW(w, n);
    RITZ_CHECK(apply(k, ritz_dense_col(&k->V, j), w));
    k->diagonal[j] = 0.0;
    RITZ_CHECK(orthogonalise(k, w, &k->diagonal[j]));
    RITZ_CHECK(norm_of(k, w, &k->beside[j]));
    if (k->count == STEPS || k->beside[j] == 0.0)
        return RITZ_OK;
    for (int64_t i = 0; i < n; i++)
        ritz_dense_col(&k->V, k->count)[i] = w[i] / k->beside[j];
    k->count++;
    return RITZ_OK;
}

/* @param[in] m  rows of T */
static ritz_status approximate(const krylov *k, int m, ritz_spectrum_end end,
                               approximation *out)
{
    double theta[STEPS], beside[STEPS], S[STEPS * STEPS];
    int at = 0;

    memcpy(theta, k->diagonal, sizeof theta);
    memcpy(beside, k->beside, sizeof beside);
    RITZ_REFUSE_IF(
        LAPACKE_dstev(LAPACK_COL_MAJOR, 'V', m, theta, beside, S, m) != 0,
        RITZ_ERR_CONVERGENCE,
        "eigenvalues of a tridiagonal matrix were not found");
    if (end == RITZ_END_HIGHEST ||
        (end == RITZ_END_LARGEST && theta[m - 1] > -theta[0]))
        at = m - 1;
    out->theta = theta[at];
    out->largest = fmax(fabs(theta[0]), fabs(theta[m - 1]));
    memcpy(out->s, S + (ptrdiff_t)at * m, (size_t)m * sizeof *S);
    out->residual = fabs(k->beside[m - 1] * out->s[m - 1]);
    return RITZ_OK;
}

static bool is_settled(const approximation *found)
{
    return found->residual <= RITZ_EXTREME_SETTLED * fabs(found->theta) ||
           found->residual <= RITZ_NEGLIGIBLE * found->largest;
}

/* Up to STEPS vectors. */
static ritz_status iterate(krylov *k, ritz_spectrum_end end,
                           approximation *found, bool *settled)
{
    int m = 0;

    for (*settled = false; !*settled && m < STEPS;) {
        const int64_t before = k->count;
        bool ended = false;

        RITZ_CHECK(step(k));
        m++;
        ended = k->count == before; /* full, or nothing is left */
        if (!ended && m % EACH != 0)
            continue;
        RITZ_CHECK(approximate(k, m, end, found));
        *settled = is_settled(found);
        if (ended)
            return RITZ_OK;
    }
    return RITZ_OK;
}

/* The start B^-1 A times noise: parts that A does not move are left out. */
static ritz_status start(krylov *k, double *size)
{
    uint64_t seed = 1998;
    RITZ_OWN_ARRAY double *v = NULL, *w = NULL;

    RITZ_CHECK_NEW(v, k->A->nrow);
    RITZ_CHECK_NEW(w, k->A->nrow);
    RITZ_CHECK_NEW(k->work, k->A->nrow);
    RITZ_CHECK(ritz_dense_new(k->A->nrow, STEPS, &k->V));
    for (int64_t i = 0; i < k->A->nrow; i++)
        v[i] = ritz_general_noise(&seed);
    RITZ_CHECK(apply(k, v, w));
    RITZ_CHECK(norm_of(k, w, size));
    if (*size > 0.0)
        begin(k, w, *size);
    return RITZ_OK;
}

/* Begin again with V s. */
static ritz_status restart(krylov *k, const approximation *found)
{
    const int n = (int)k->A->nrow;
    RITZ_OWN_ARRAY double *w = NULL;
    double size = 0.0;

    RITZ_CHECK_NEW(w, k->A->nrow);
    cblas_dgemv(CblasColMajor, CblasNoTrans, n, (int)k->count, 1.0, k->V.val, n,
                found->s, 1, 0.0, w, 1);
    RITZ_CHECK(norm_of(k, w, &size));
    begin(k, w, size);
    return RITZ_OK;
}

ritz_status ritz_extreme_value(const ritz_sparse *A, const ritz_sparse *B,
                               ritz_factor *F, ritz_spectrum_end end,
                               double *theta)
{
    RITZ_OWN(krylov) k = {.A = A, .B = B, .F = F};
    approximation found = {0};
    bool settled = false;
    double size = 0.0;

    RITZ_CHECK(start(&k, &size));
    for (int r = 0; size > 0.0 && !settled; r++) {
        RITZ_REFUSE_IF(r == RESTARTS, RITZ_ERR_CONVERGENCE,
                       "an end of the spectrum was not found: a residual of "
                       "%.1e stays",
                       found.residual);
        if (r > 0)
            RITZ_CHECK(restart(&k, &found));
        RITZ_CHECK(iterate(&k, end, &found, &settled));
    }
    *theta = found.theta;
    return RITZ_OK;
}
