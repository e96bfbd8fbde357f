/*
 * Norms of a sparse model G and of its difference from a small one,
 *
 *     |G - G_r|_inf = max_w sigma_1(G(i w) - G_r(i w))
 *
 * G is interpolated: with V of real and imaginary parts of (A - i w E)^-1 B and
 * (A - i w E)^-T C' at some w,
 *
 *     G_V = D + C V (s V'E V - V'A V)^-1 V'B
 *
 * equals G at these w, together with its derivative. The peak of G_V - G_r is
 * the next w, until it is no higher than a value of G - G_r itself. The value is
 * one that is reached; that none is higher is not proven.
 * [AliyevBennerMengiSchwerdtnerVoigt2017]
 *
 * Poles at 0 are left out of G. Norms in H2 are those of low-rank Gramians.
 */
#include "base/alloc.h"
#include "base/complex.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "linear/orthonormal.h"
#include "linear/resolvent.h"
#include "model/space.h"
#include "poles/peak.h"
#include "poles/poles.h"

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    STARTS = 6,  /* points before the first search */
    POINTS = 40, /* at most */
};

typedef struct axis_interpolant {
    const ritz_state_space *model; /* borrowed */
    const ritz_state_space *small; /* in Schur form; NULL: G alone */
    ritz_pencil pencil;
    ritz_zero_poles zero;
    ritz_dense B, Ct; /* without poles at 0 */
    ritz_orthonormal V;
    ritz_resolvent whole, reduced; /* of G_V and G_r */
    ritz_dense D;
    int64_t points;
    double best, at; /* largest singular value met, and its w */
    double rounding; /* there */
} axis_interpolant;

static void axis_interpolant_free(axis_interpolant *g)
{
    ritz_pencil_free(&g->pencil);
    ritz_zero_poles_free(&g->zero);
    ritz_dense_free(&g->B);
    ritz_dense_free(&g->Ct);
    ritz_orthonormal_free(&g->V);
    ritz_resolvent_free(&g->whole);
    ritz_resolvent_free(&g->reduced);
    ritz_dense_free(&g->D);
}

static ritz_status start_interpolant(const ritz_state_space *model,
                                     axis_interpolant *g)
{
    g->model = model;
    RITZ_CHECK(ritz_pencil_of_space(model, &g->pencil));
    RITZ_CHECK_IN("poles at 0", ritz_zero_poles_find(&g->pencil, &g->zero));
    RITZ_CHECK(ritz_dense_copy(&model->B, &g->B));
    RITZ_CHECK(ritz_general_transpose(&model->C, &g->Ct));
    RITZ_CHECK(ritz_zero_poles_of_loads(&g->zero, false, &g->B));
    RITZ_CHECK(ritz_zero_poles_of_loads(&g->zero, true, &g->Ct));
    return ritz_orthonormal_new(g->pencil.n, NULL, RITZ_DEPENDENT, &g->V);
}

/* X = (A - i w E)^-1 F, or by the transposed matrix. */
static ritz_status solve_loads(axis_interpolant *g, bool outputs,
                               double _Complex *X)
{
    const ritz_dense *F = outputs ? &g->Ct : &g->B;

    for (int64_t i = 0; i < F->nrow * F->ncol; i++)
        X[i] = F->val[i];
    RITZ_CHECK(ritz_pencil_solve(&g->pencil, outputs, F->ncol, X));
    return ritz_zero_poles_of_states(&g->zero, outputs, F->ncol, X);
}

/* Real and imaginary parts of X as further columns of V. */
static ritz_status append_parts(axis_interpolant *g, int64_t count,
                                const double _Complex *X)
{
    const int64_t size = g->pencil.n * count;
    RITZ_OWN(ritz_dense) parts = {0};

    RITZ_CHECK(ritz_dense_new(g->pencil.n, 2 * count, &parts));
    for (int64_t i = 0; i < size; i++) {
        parts.val[i] = creal(X[i]);
        parts.val[size + i] = cimag(X[i]);
    }
    return ritz_orthonormal_append(&g->V, &parts, parts.ncol, NULL);
}

/* eps |y|'(|A| + w |E|)|x| for the lengths x and y of rows of X and Y. */
static ritz_status size_rounding(const axis_interpolant *g, double w,
                                 const double _Complex *X,
                                 const double _Complex *Y, double *out)
{
    const int64_t n = g->pencil.n;
    RITZ_OWN_ARRAY double *x = NULL, *y = NULL;

    RITZ_CHECK_NEW(x, n);
    RITZ_CHECK_NEW(y, n);
    for (int64_t i = 0; i < n; i++) {
        for (int64_t k = 0; k < g->B.ncol; k++)
            x[i] = hypot(x[i], cabs(X[i + k * n]));
        for (int64_t k = 0; k < g->Ct.ncol; k++)
            y[i] = hypot(y[i], cabs(Y[i + k * n]));
    }
    *out = DBL_EPSILON * ritz_pencil_magnitude(&g->pencil, w, x, y);
    return RITZ_OK;
}

/* G(i w) - G_r(i w) from X = (A - i w E)^-1 B. */
static ritz_status measure_error(axis_interpolant *g, double w,
                                 const double _Complex *X, double *out)
{
    const int64_t n = g->pencil.n, m = g->B.ncol, p = g->Ct.ncol;
    const double _Complex z = ritz_complex(0.0, w);
    RITZ_OWN_ARRAY double _Complex *H = NULL, *H_r = NULL;

    RITZ_CHECK_NEW(H, m * p);
    RITZ_CHECK_NEW(H_r, m * p);
    if (g->small)
        RITZ_CHECK(ritz_resolvent_many(&g->reduced, 1, &z, H_r));
    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < p; i++) {
            double _Complex sum = g->D.val[i + j * p] - H_r[i + j * p];

            for (int64_t k = 0; k < n; k++)
                sum -= g->Ct.val[k + i * n] * X[k + j * n];
            H[i + j * p] = sum;
        }
    return ritz_largest_singular(p, m, H, out);
}

/* Interpolate at i w as well; next to 0 where that is a pole, which is left
   out. */
static ritz_status add_point(axis_interpolant *g, double w)
{
    const int64_t n = g->pencil.n;
    RITZ_OWN_ARRAY double _Complex *X = NULL, *Y = NULL;
    double value = 0.0;

    w = fmax(w, RITZ_ZERO_POLE_BESIDE * g->zero.radius);
    RITZ_CHECK_NEW(X, n * g->B.ncol);
    RITZ_CHECK_NEW(Y, n * g->Ct.ncol);
    RITZ_CHECK(ritz_pencil_factor(&g->pencil, ritz_complex(0.0, w)));
    RITZ_CHECK(solve_loads(g, false, X));
    RITZ_CHECK(solve_loads(g, true, Y));
    RITZ_CHECK(append_parts(g, g->B.ncol, X));
    RITZ_CHECK(append_parts(g, g->Ct.ncol, Y));
    RITZ_CHECK(measure_error(g, w, X, &value));
    if (value > g->best) {
        g->best = value;
        g->at = w;
        RITZ_CHECK(size_rounding(g, w, X, Y, &g->rounding));
    }
    ritz_monitor_step("points", ++g->points, 0);
    return RITZ_OK;
}

/* V'A V, V'E V, V'B and C V as a resolvent. */
static ritz_status project_whole(axis_interpolant *g)
{
    const ritz_dense V = ritz_dense_part(&g->V.V, 0, g->V.count);
    RITZ_OWN(ritz_dense) A = {0}, E = {0}, B = {0}, C = {0};

    ritz_resolvent_free(&g->whole);
    RITZ_CHECK(ritz_sparse_project(&g->pencil.A, &V, &A));
    RITZ_CHECK(ritz_sparse_project(&g->pencil.E, &V, &E));
    RITZ_CHECK(ritz_dense_mul_tn(&V, &g->B, &B));
    RITZ_CHECK(ritz_dense_mul_tn(&g->Ct, &V, &C));
    return ritz_resolvent_new(&A, &E, &B, &C, &g->whole);
}

/* G_V - G_r at points on the axis; those at infinity are last. */
static ritz_status respond_difference(void *state, int64_t count,
                                      const double *w, double _Complex *H)
{
    const axis_interpolant *g = state;
    const int64_t size = g->D.nrow * g->D.ncol;
    RITZ_OWN_ARRAY double _Complex *z = NULL, *H_r = NULL;
    int64_t finite = 0;

    RITZ_CHECK_NEW(z, count);
    RITZ_CHECK_NEW(H_r, count * size);
    while (finite < count && isfinite(w[finite])) {
        z[finite] = ritz_complex(0.0, w[finite]);
        finite++;
    }
    if (g->small)
        RITZ_CHECK(ritz_resolvent_many(&g->reduced, finite, z, H_r));
    for (int64_t k = 0; k < count * size; k++)
        H[k] = g->D.val[k % size] - H_r[k];
    return ritz_resolvent_many(&g->whole, finite, z, H);
}

/* Where poles of both respond most, ascending. */
static ritz_status list_peaks(const axis_interpolant *g, int64_t *count,
                              double **w)
{
    const ritz_resolvent *const r[] = {&g->whole, &g->reduced};
    int64_t at = 0;

    RITZ_CHECK_NEW(*w, g->whole.n + g->reduced.n + 1);
    at++; /* 0 */
    for (int k = 0; k < 2; k++)
        for (int64_t j = 0; j < r[k]->n; j++)
            (*w)[at++] = ritz_peak_of_pole(ritz_resolvent_pole(r[k], j));
    *count = ritz_sort_distinct(at, *w, RITZ_PEAK_PLACED);
    return RITZ_OK;
}

/* The highest peak of G_V - G_r. */
static ritz_status find_peak(axis_interpolant *g, ritz_peak *out)
{
    RITZ_OWN_ARRAY double *w = NULL;
    int64_t count = 0;

    RITZ_CHECK(project_whole(g));
    *out = (ritz_peak){.outputs = g->D.nrow,
                       .inputs = g->D.ncol,
                       .respond = respond_difference,
                       .state = g};
    RITZ_CHECK(list_peaks(g, &count, &w));
    return ritz_peak_find(out, count, w);
}

/* At 0, or beside it where poles were left out there, and at poles that are
   slow, in even ratios. */
static ritz_status add_starts(axis_interpolant *g)
{
    const double slow = g->zero.radius;
    const double size =
        ritz_sparse_max(&g->pencil.A) / ritz_sparse_max(&g->pencil.E);
    RITZ_OWN(ritz_pencil_pairs) near = {0};
    double low = HUGE_VAL;

    RITZ_CHECK(ritz_space_slowest(&g->pencil, STARTS, &near));
    for (int64_t k = 0; k < near.count; k++)
        if (cabs(near.s[k]) > slow)
            low = fmin(low, cabs(near.s[k]));
    low = isfinite(low) ? fmin(low, size) : size;
    RITZ_CHECK(add_point(g, 0.0));
    for (int k = 0; k < STARTS - 1; k++)
        RITZ_CHECK(
            add_point(g, low * pow(size / low, (double)k / (STARTS - 1))));
    return RITZ_OK;
}

/* Points until a peak is no higher than what was met. */
static ritz_status climb_peaks(axis_interpolant *g, double tolerance,
                               ritz_norm *out)
{
    ritz_peak p = {0};
    bool settled = false;

    *out = (ritz_norm){0};
    while (!settled && g->points < POINTS) {
        RITZ_CHECK(find_peak(g, &p));
        settled = !(p.value > (1.0 + tolerance) * g->best + g->rounding);
        if (!settled && !isfinite(p.w)) {
            g->best = p.value; /* D alone, which is exact */
            g->at = p.w;
            g->rounding = 0.0;
        } else if (!settled) {
            RITZ_CHECK(add_point(g, p.w));
        }
    }
    out->value = out->lower = g->best;
    out->hertz = g->at / (2.0 * RITZ_PI);
    out->rounding = g->rounding;
    (void)snprintf(out->engine, sizeof out->engine,
                   "interpolation at %" PRId64 " points, %s", g->points,
                   settled ? "a lower bound" : "which is not settled");
    return RITZ_OK;
}

/* G_r, and the value that is known of G - G_r: none. */
static ritz_status set_small(const ritz_state_space *small, axis_interpolant *g)
{
    g->small = small;
    g->best = g->at = g->rounding = 0.0;
    g->points = 0;
    ritz_dense_add(-1.0, &small->D, &g->D);
    return ritz_resolvent_new(&small->A, &small->E, &small->B, &small->C,
                              &g->reduced);
}

ritz_status ritz_norm_infinity_sparse(const ritz_state_space *model,
                                      const ritz_state_space *small,
                                      double tolerance, int64_t *decoupled,
                                      ritz_norm *whole, ritz_norm *error)
{
    RITZ_OWN(axis_interpolant) g = {0};

    RITZ_CHECK(start_interpolant(model, &g));
    *decoupled = g.zero.T.ncol;
    RITZ_CHECK(ritz_dense_copy(&model->D, &g.D));
    RITZ_CHECK(add_starts(&g));
    RITZ_CHECK(climb_peaks(&g, tolerance, whole));
    RITZ_CHECK(set_small(small, &g));
    return climb_peaks(&g, tolerance, error);
}
