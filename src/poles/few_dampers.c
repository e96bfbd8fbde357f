/*
 * Responses of modes that few dampers couple. The modal damping matrix of p
 * dampers is D = G + L L', G diagonal and L of p columns, so that
 *
 *     Z = Z_0 + i w L L',          Z_0 = Lambda - w^2 I + i w G,
 *     Z^-1 b = Z_0^-1 (b - i w L y),
 *     (I + i w L'Z_0^-1 L) y = L'Z_0^-1 b
 *
 * and a frequency costs O(m p^2) for m modes, not O(m^3). L is the Cholesky
 * factor of D with pivots, which ends after p columns.
 *
 * Held to: solutions with all of Z, in tests/unit/poles/test_few_dampers.c.
 */
#include "poles/poles.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <complex.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>

/* Of m modes: the most dampers for which this costs less than a factor of Z. */
enum { MODES_A_DAMPER = 3 };

/* --- the factor ----------------------------------------------------------- */

/* What of D may be left after its factor: rounding of D itself. */
static double find_rounding(const ritz_dense *D, double largest, int64_t i,
                            int64_t j)
{
    const double own = sqrt(fabs(ritz_dense_col(D, i)[i])) *
                       sqrt(fabs(ritz_dense_col(D, j)[j]));

    return (double)D->ncol * DBL_EPSILON * own +
           RITZ_DIAGONAL_ROUNDING * largest;
}

/* The row of the largest diagonal entry that is more than rounding; -1: there
   is none. */
static int64_t find_pivot(const ritz_dense *D, const ritz_dense *rest,
                          double largest)
{
    int64_t pivot = -1;

    for (int64_t k = 0; k < D->ncol; k++) {
        const double value = ritz_dense_col(rest, k)[k];

        if (value > find_rounding(D, largest, k, k) &&
            (pivot < 0 || value > ritz_dense_col(rest, pivot)[pivot]))
            pivot = k;
    }
    return pivot;
}

/* The next column l of L, rest := rest - l l'. */
static void take_column(int64_t pivot, ritz_dense *rest, double *l)
{
    const double root = sqrt(ritz_dense_col(rest, pivot)[pivot]);

    for (int64_t k = 0; k < rest->nrow; k++)
        l[k] = ritz_dense_col(rest, pivot)[k] / root;
    for (int64_t j = 0; j < rest->ncol; j++)
        for (int64_t i = 0; i < rest->nrow; i++)
            ritz_dense_col(rest, j)[i] -= l[i] * l[j];
}

static bool is_rounding(const ritz_dense *D, const ritz_dense *rest,
                        double largest)
{
    for (int64_t j = 0; j < D->ncol; j++)
        for (int64_t i = 0; i < D->nrow; i++)
            if (!(fabs(ritz_dense_col(rest, j)[i]) <=
                  find_rounding(D, largest, i, j)))
                return false;
    return true;
}

ritz_status ritz_few_dampers(const ritz_dense *D, ritz_dense *out)
{
    const int64_t m = D->ncol, most = m / MODES_A_DAMPER;
    RITZ_OWN(ritz_dense) rest = {0}, L = {0};
    const double largest = ritz_dense_max(D);
    int64_t count = 0, pivot = 0;

    RITZ_CHECK(ritz_dense_copy(D, &rest));
    RITZ_CHECK(ritz_dense_new(m, most, &L));
    for (pivot = find_pivot(D, &rest, largest); pivot >= 0 && count < most;
         pivot = find_pivot(D, &rest, largest))
        take_column(pivot, &rest, ritz_dense_col(&L, count++));
    if (count == 0 || pivot >= 0 || !is_rounding(D, &rest, largest))
        return RITZ_OK;
    return ritz_dense_block(&L, 0, m, 0, count, out);
}

/* --- responses ------------------------------------------------------------ */

/* g = 1 / Z_0. @return whether no mode is so near to a pole of Z_0 that digits
   would cancel, and none is on it */
static bool invert_decoupled(const ritz_poles *poles, double w,
                             double _Complex *g)
{
    const ritz_dense *L = &poles->L;

    for (int64_t j = 0; j < L->nrow; j++) {
        const double square = j < poles->count ? w * w : 0.0;
        const double re = poles->lambda[j] - square;
        double coupled = 0.0, im = 0.0, size = 0.0, below = 0.0;

        for (int64_t k = 0; k < L->ncol; k++) {
            const double l = ritz_dense_col(L, k)[j];

            coupled += l * l;
        }
        im = w * (ritz_dense_col(&poles->D, j)[j] - coupled);
        size = fmax(fabs(re), fabs(im));
        below = re * re + im * im;
        if (!(size > RITZ_POLE_HIT * (fabs(poles->lambda[j]) + square)) ||
            !(w * coupled <= RITZ_DAMPER_CANCELS * size) || !isnormal(below))
            return false;
        g[j] = ritz_complex(re / below, -im / below);
    }
    return true;
}

/* S = I + i w L'Z_0^-1 L, p x p. */
static void assemble_small(const ritz_dense *L, double w,
                           const double _Complex *g, double _Complex *S)
{
    const int64_t p = L->ncol;

    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i <= j; i++) {
            const double *a = ritz_dense_col(L, i), *b = ritz_dense_col(L, j);
            double re = 0.0, im = 0.0;

            for (int64_t k = 0; k < L->nrow; k++) {
                const double ab = a[k] * b[k];

                re += ab * creal(g[k]);
                im += ab * cimag(g[k]);
            }
            S[i + j * p] = S[j + i * p] =
                ritz_complex((i == j ? 1.0 : 0.0) - w * im, w * re);
        }
}

/* y = L'Z_0^-1 b */
static void project_load(const ritz_dense *L, const double _Complex *g,
                         const double *b, double _Complex *y)
{
    for (int64_t k = 0; k < L->ncol; k++) {
        const double *l = ritz_dense_col(L, k);
        double re = 0.0, im = 0.0;

        for (int64_t j = 0; j < L->nrow; j++) {
            re += l[j] * b[j] * creal(g[j]);
            im += l[j] * b[j] * cimag(g[j]);
        }
        y[k] = ritz_complex(re, im);
    }
}

/* q = Z_0^-1 (b - i w L y) */
static void add_dampers(const ritz_dense *L, double w, const double _Complex *g,
                        const double *b, const double _Complex *y,
                        double _Complex *q)
{
    for (int64_t j = 0; j < L->nrow; j++) {
        double re = 0.0, im = 0.0;

        for (int64_t k = 0; k < L->ncol; k++) {
            const double l = ritz_dense_col(L, k)[j];

            re += l * creal(y[k]);
            im += l * cimag(y[k]);
        }
        q[j] = g[j] * ritz_complex(b[j] + w * im, -w * re);
    }
}

ritz_status ritz_few_dampers_solve(const ritz_poles *poles,
                                   const ritz_dense *loads, double hertz,
                                   bool *solved, double _Complex *q)
{
    const ritz_dense *L = &poles->L;
    const double w = 2.0 * RITZ_PI * hertz;
    const int64_t m = L->nrow, p = L->ncol, inputs = loads->ncol;
    RITZ_OWN_ARRAY double _Complex *work = NULL;
    RITZ_OWN_ARRAY lapack_int *pivot = NULL;
    double _Complex *g = NULL, *S = NULL, *y = NULL;

    *solved = false;
    RITZ_CHECK_NEW(work, m + p * (p + inputs));
    RITZ_CHECK_NEW(pivot, p);
    g = work;
    S = g + m;
    y = S + p * p;
    if (!invert_decoupled(poles, w, g))
        return RITZ_OK;
    assemble_small(L, w, g, S);
    for (int64_t j = 0; j < inputs; j++)
        project_load(L, g, ritz_dense_col(loads, j), y + j * p);
    if (LAPACKE_zgesv_work(LAPACK_COL_MAJOR, (int)p, (int)inputs, S, (int)p,
                           pivot, y, (int)p) != 0)
        return RITZ_OK;
    for (int64_t j = 0; j < inputs; j++)
        add_dampers(L, w, g, ritz_dense_col(loads, j), y + j * p, q + j * m);
    *solved = true;
    return RITZ_OK;
}
