/*
 * A channel as a complex triangle, T = Q^H A Q:
 *
 *     f(z)   = d + c x,            (z I - T) x = b,  w (z I - T) = c
 *     f'(z)  = -w x,               f''(z) = 2 w y,   (z I - T) y = x
 *
 * Where modes are apart it is diagonal, or of blocks of two that are brought to
 * it in closed form.
 */
#include "poles/channel.h"

#include "base/alloc.h"
#include "poles/poles.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

static void by_diagonal(const ritz_channel *channel, ritz_triangle *t)
{
    for (int64_t k = 0; k < t->n; k++) {
        t->T[k + k * t->n] = ritz_dense_col(&channel->A, k)[k];
        t->b[k] = channel->B.val[k];
        t->c[k] = channel->C.val[k];
    }
}

/*
 * [0 w; -l/w -d] has the eigenvector v = [w; s]; beside it, of length one,
 * stands [-conj s; w].
 */
static void by_block(const ritz_channel *channel, int64_t k, ritz_triangle *t)
{
    int64_t n = t->n, m = n / 2, at = 2 * k;
    double w = ritz_dense_col(&channel->A, m + k)[k];
    double low = ritz_dense_col(&channel->A, k)[m + k];
    double half = ritz_dense_col(&channel->A, m + k)[m + k] / 2.0;
    const double *b = channel->B.val, *c = channel->C.val;
    double _Complex gap = csqrt(ritz_complex(half * half + w * low, 0.0));
    /* of two real ones the larger first: the other without cancellation */
    double _Complex s = half < 0.0 ? half - gap : half + gap;
    double _Complex other = s == 0.0 ? 0.0 : -w * low / s;
    double _Complex bar = conj(s);
    double length = sqrt(w * w + creal(s * bar));

    t->T[at + at * n] = s;
    t->T[at + 1 + (at + 1) * n] = other;
    /* v^H A v_beside */
    t->T[at + (at + 1) * n] =
        (w * (w * w) + bar * (-low * bar + 2.0 * half * w)) / (length * length);
    t->b[at] = (w * b[k] + bar * b[m + k]) / length;
    t->b[at + 1] = (-s * b[k] + w * b[m + k]) / length;
    t->c[at] = (w * c[k] + s * c[m + k]) / length;
    t->c[at + 1] = (-bar * c[k] + w * c[m + k]) / length;
}

static ritz_status by_schur(const ritz_channel *channel, ritz_triangle *t)
{
    ritz_status status = RITZ_OK;
    const double _Complex one = 1.0, zero = 0.0;
    int n = (int)t->n, found = 0, info = 0;
    double _Complex *Q = NULL, *pole = NULL, *b = NULL, *c = NULL;

    RITZ_NEW(Q, t->n * t->n);
    RITZ_NEW(pole, t->n);
    RITZ_NEW(b, t->n);
    RITZ_NEW(c, t->n);
    for (int64_t k = 0; k < t->n * t->n; k++)
        t->T[k] = channel->A.val[k];
    for (int64_t k = 0; k < t->n; k++) {
        b[k] = channel->B.val[k];
        c[k] = channel->C.val[k];
    }
    if (n > 0)
        info = LAPACKE_zgees(LAPACK_COL_MAJOR, 'V', 'N', NULL, n, t->T, n,
                             &found, pole, Q, n);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE, "poles were not found");
    if (n > 0) {
        cblas_zgemv(CblasColMajor, CblasConjTrans, n, n, &one, Q, n, b, 1,
                    &zero, t->b, 1);
        cblas_zgemv(CblasColMajor, CblasTrans, n, n, &one, Q, n, c, 1, &zero,
                    t->c, 1);
    }
done:
    free(Q);
    free(pole);
    free(b);
    free(c);
    return status;
}

ritz_status ritz_triangle_new(const ritz_channel *channel, ritz_triangle *out)
{
    ritz_status status = RITZ_OK;
    int64_t n = channel->A.nrow;
    ritz_triangle t = {.n = n, .d = channel->D.val[0]};

    RITZ_NEW(t.T, n * n);
    RITZ_NEW(t.b, n);
    RITZ_NEW(t.c, n);
    RITZ_NEW(t.cancelled, n);
    RITZ_NEW(t.x, n);
    RITZ_NEW(t.w, n);
    RITZ_NEW(t.two, n);
    if (channel->squared) {
        by_diagonal(channel, &t);
    } else if (channel->blocks) {
        t.band = 1;
        for (int64_t k = 0; k < n / 2; k++)
            by_block(channel, k, &t);
    } else {
        t.band = n;
        RITZ_TRY(by_schur(channel, &t));
    }
    *out = t;
    t = (ritz_triangle){0};
done:
    ritz_triangle_free(&t);
    return status;
}

/* (z I - T) x = b, from the last row up. */
static void solve(const ritz_triangle *t, double _Complex z,
                  const double _Complex *b, double _Complex *x)
{
    int64_t n = t->n;

    for (int64_t i = n - 1; i >= 0; i--) {
        int64_t last = t->band < n - 1 - i ? i + t->band : n - 1;
        double _Complex sum = b[i];

        for (int64_t j = i + 1; j <= last; j++)
            sum += t->T[i + j * n] * x[j];
        x[i] = sum / (z - t->T[i + i * n]);
    }
}

/* w (z I - T) = c, from the first column on. */
static void solve_left(const ritz_triangle *t, double _Complex z)
{
    int64_t n = t->n;

    for (int64_t j = 0; j < n; j++) {
        double _Complex sum = t->c[j];

        for (int64_t i = t->band < j ? j - t->band : 0; i < j; i++)
            sum += t->w[i] * t->T[i + j * n];
        t->w[j] = sum / (z - t->T[j + j * n]);
    }
}

/* eps (|w| (|z I| + |T|) |x| + |c||x| + |w||b| + |d|) */
static double rounding_at(const ritz_triangle *t, double _Complex z)
{
    int64_t n = t->n;
    double sum = fabs(t->d);

    for (int64_t j = 0; j < n; j++) {
        double x = cabs(t->x[j]);

        sum +=
            cabs(t->c[j]) * x + cabs(t->w[j]) * (cabs(t->b[j]) + cabs(z) * x);
        for (int64_t i = t->band < j ? j - t->band : 0; i <= j; i++)
            sum += cabs(t->w[i] * t->T[i + j * n]) * x;
    }
    return DBL_EPSILON * sum;
}

void ritz_triangle_at(const ritz_triangle *t, double _Complex z,
                      ritz_sample *out)
{
    ritz_sample s = {.f = t->d};

    solve(t, z, t->b, t->x);
    solve_left(t, z);
    solve(t, z, t->x, t->two);
    for (int64_t k = 0; k < t->n; k++) {
        s.f += t->c[k] * t->x[k];
        s.first -= t->w[k] * t->x[k];
        s.second += 2.0 * t->w[k] * t->two[k];
    }
    s.error = rounding_at(t, z);
    *out = s;
}

void ritz_triangle_free(ritz_triangle *triangle)
{
    free(triangle->T);
    free(triangle->b);
    free(triangle->c);
    free(triangle->cancelled);
    free(triangle->x);
    free(triangle->w);
    free(triangle->two);
    *triangle = (ritz_triangle){0};
}
