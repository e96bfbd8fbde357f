/*
 * A real Schur form is brought to a complex triangle once, after which a point
 * costs one triangular solve. Peaks lie near poles: they are where the search
 * begins, and a golden section between neighbours ends it.
 */
#include "poles/peak.h"

#include "base/alloc.h"
#include "poles/curve.h"
#include "poles/poles.h"
#include "poles/widen.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Points that stand out: so many, and no lower than so much of the highest. */
enum { MOST_PEAKS = 8 };
static const double worth_climbing = 0.5;
/* Of a bracket's length when it is done, relative to its frequency. */
static const double close_enough = 1e-9;

/* Blocks of two, which stand for a pair, become triangles. */
static ritz_status triangularise(ritz_peak *s)
{
    ritz_status status = RITZ_OK;
    int64_t n = s->n;
    double _Complex *Q = NULL, *Z = NULL, *alpha = NULL, *beta = NULL;
    int info = 0;

    RITZ_NEW(Q, n * n);
    RITZ_NEW(Z, n * n);
    RITZ_NEW(alpha, n);
    RITZ_NEW(beta, n);
    if (s->P)
        info =
            LAPACKE_zhgeqz(LAPACK_COL_MAJOR, 'S', 'I', 'I', s->n, 1, s->n, s->S,
                           s->n, s->P, s->n, alpha, beta, Q, s->n, Z, s->n);
    else
        info = LAPACKE_zhseqr(LAPACK_COL_MAJOR, 'S', 'I', s->n, 1, s->n, s->S,
                              s->n, alpha, Q, s->n);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE, "poles were not found");
    RITZ_TRY(ritz_turn(s->n, s->m, s->p, Q, s->P ? Z : Q, &s->B, &s->C));
done:
    free(Q);
    free(Z);
    free(alpha);
    free(beta);
    return status;
}

ritz_status ritz_peak_new(const ritz_split *split, const ritz_dense *B,
                          const ritz_dense *C, const ritz_dense *D,
                          ritz_peak *out)
{
    ritz_status status = RITZ_OK;
    ritz_peak s = {.n = (int)B->nrow, .m = (int)B->ncol, .p = (int)C->nrow};
    int64_t least = s.m < s.p ? s.m : s.p;

    RITZ_TRY(ritz_widen(&split->S, &s.S));
    if (split->P.val)
        RITZ_TRY(ritz_widen(&split->P, &s.P));
    RITZ_TRY(ritz_widen(B, &s.B));
    RITZ_TRY(ritz_widen(C, &s.C));
    RITZ_TRY(ritz_widen(D, &s.D));
    RITZ_NEW(s.T, (int64_t)s.n * s.n);
    RITZ_NEW(s.X, (int64_t)s.n * s.m);
    RITZ_NEW(s.H, (int64_t)s.p * s.m);
    RITZ_NEW(s.sigma, least);
    RITZ_NEW(s.spare, least);
    if (s.n > 0 && least > 0)
        RITZ_TRY(triangularise(&s));
    *out = s;
    s = (ritz_peak){0};
done:
    ritz_peak_free(&s);
    return status;
}

/* T = i w P - S; without P its diagonal is all that changes. */
static void shift(ritz_peak *s, double w)
{
    const double _Complex at = ritz_complex(0.0, w);
    int64_t n = s->n;

    for (int64_t j = 0; j < n; j++) {
        int64_t diagonal = j + j * n;

        for (int64_t i = s->P || !s->begun ? 0 : j; i <= j; i++)
            s->T[i + j * n] =
                (s->P ? at * s->P[i + j * n] : 0.0) - s->S[i + j * n];
        if (!s->P)
            s->T[diagonal] += at;
    }
    s->begun = true;
}

/* H = D + C (i w P - S)^-1 B */
static void respond(ritz_peak *s, double w)
{
    const double _Complex one = 1.0;
    size_t item = sizeof *s->X;
    int64_t n = s->n;

    memcpy(s->H, s->D, (size_t)((int64_t)s->p * s->m) * item);
    if (n == 0 || isinf(w))
        return;
    shift(s, w);
    memcpy(s->X, s->B, (size_t)(n * s->m) * item);
    cblas_ztrsm(CblasColMajor, CblasLeft, CblasUpper, CblasNoTrans,
                CblasNonUnit, s->n, s->m, &one, s->T, s->n, s->X, s->n);
    cblas_zgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, s->p, s->m, s->n,
                &one, s->C, s->p, s->X, s->n, &one, s->H, s->p);
}

ritz_status ritz_peak_at(ritz_peak *peak, double w, double *value)
{
    int info = 0;

    *value = 0.0;
    if (peak->m == 0 || peak->p == 0)
        return RITZ_OK;
    respond(peak, w);
    info = LAPACKE_zgesvd(LAPACK_COL_MAJOR, 'N', 'N', peak->p, peak->m, peak->H,
                          peak->p, peak->sigma, NULL, 1, NULL, 1, peak->spare);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "singular values of a response were not found");
    *value = peak->sigma[0];
    if (*value > peak->value) {
        peak->value = *value;
        peak->w = w;
    }
    return RITZ_OK;
}

static int ascending(const void *left, const void *right)
{
    const double *a = left;
    const double *b = right;

    return (*a > *b) - (*a < *b);
}

/* 0 and, of every pole, where it alone answers most, else its magnitude. */
static ritz_status choose_points(const ritz_peak *s, int64_t *count,
                                 double **out)
{
    ritz_status status = RITZ_OK;
    double *w = NULL;
    int64_t kept = 0;

    RITZ_NEW(w, s->n + 2);
    for (int64_t k = 0; k < s->n; k++) {
        int64_t at = k + k * s->n;
        double _Complex pole = s->P ? s->S[at] / s->P[at] : s->S[at];
        double gap = cimag(pole) * cimag(pole) - creal(pole) * creal(pole);

        w[k + 1] = gap > 0.0 ? sqrt(gap) : cabs(pole);
    }
    qsort(w, (size_t)s->n + 1, sizeof *w, ascending);
    for (int64_t k = 0; k <= s->n; k++)
        if (kept == 0 || w[k] - w[kept - 1] > close_enough * w[k])
            w[kept++] = w[k];
    w[kept] = 2.0 * w[kept - 1] + 1.0; /* the last bracket ends there */
    *count = kept;
    *out = w;
    w = NULL;
done:
    free(w);
    return status;
}

static ritz_status at(void *state, double w, double *value)
{
    return ritz_peak_at(state, w, value);
}

/* What is met is remembered by the peak. */
static ritz_status climb(ritz_peak *s, double low, double high)
{
    const ritz_curve curve = {at, s};
    double most = 0.0;

    return ritz_curve_between(&curve, close_enough, &low, &high, &most);
}

/* Index of the largest that was not yet taken, -1 if there is none. */
static int64_t next_highest(int64_t count, const double *value)
{
    int64_t best = -1;

    for (int64_t k = 0; k < count; k++)
        if (value[k] >= 0.0 && (best < 0 || value[k] > value[best]))
            best = k;
    return best;
}

/*
 * Between a point and a neighbour on either side; a narrow peak is in the half
 * width around the point, whatever is between it and the next.
 */
static ritz_status climb_around(ritz_peak *s, const double *w, int64_t k)
{
    double low = k > 0 ? w[k - 1] : w[k];
    double high = w[k + 1];

    RITZ_CHECK(climb(s, low, w[k]));
    RITZ_CHECK(climb(s, w[k], high));
    low = fmax(low, w[k] * 0.99);
    high = fmin(high, w[k] * 1.01);
    return climb(s, low, high);
}

ritz_status ritz_peak_search(ritz_peak *peak)
{
    ritz_status status = RITZ_OK;
    double *w = NULL, *value = NULL;
    double at_infinity = 0.0;
    int64_t count = 0;

    RITZ_TRY(choose_points(peak, &count, &w));
    RITZ_NEW(value, count);
    for (int64_t k = 0; k < count; k++)
        RITZ_TRY(ritz_peak_at(peak, w[k], &value[k]));
    RITZ_TRY(ritz_peak_at(peak, HUGE_VAL, &at_infinity));
    for (int t = 0; t < MOST_PEAKS; t++) {
        int64_t k = next_highest(count, value);

        if (k < 0 || value[k] < worth_climbing * peak->value)
            break;
        value[k] = -1.0;
        RITZ_TRY(climb_around(peak, w, k));
    }
done:
    free(w);
    free(value);
    return status;
}

void ritz_peak_free(ritz_peak *peak)
{
    free(peak->S);
    free(peak->P);
    free(peak->B);
    free(peak->C);
    free(peak->D);
    free(peak->T);
    free(peak->X);
    free(peak->H);
    free(peak->sigma);
    free(peak->spare);
    *peak = (ritz_peak){0};
}
