/*
 * x_1 = E x_0 + G u_0 + H (u_1 - u_0), with
 *
 *     exp([A B/s 0; 0 0 I/h; 0 0 0] h) = [E G/s H/s; 0 I I; 0 0 I]
 *
 * exactly, s the largest entry of B; or by the trapezoidal rule
 *
 *     E = (I - h/2 A)^-1 (I + h/2 A),   G = (I - h/2 A)^-1 h B,   H = G / 2
 */
#include "simulate/motion.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct states {
    ritz_dense E, G, H;
    double *x;    /* n */
    double *rise; /* inputs */
} states;

static void release_states(void *own)
{
    states *s = own;

    ritz_dense_free(&s->E);
    ritz_dense_free(&s->G);
    ritz_dense_free(&s->H);
    RITZ_FREE(s->x, s->rise, s);
}

static ritz_status advance_states(ritz_march *march, const double *u0,
                                  const double *u1)
{
    states *s = march->own;
    int64_t n = march->motion->n;

    memset(s->x, 0, (size_t)n * sizeof *s->x);
    for (int64_t j = 0; j < s->G.ncol; j++)
        s->rise[j] = u1[j] - u0[j];
    ritz_motion_gemv(&s->E, 1.0, march->x, s->x);
    ritz_motion_gemv(&s->G, 1.0, u0, s->x);
    ritz_motion_gemv(&s->H, 1.0, s->rise, s->x);
    memcpy(march->x, s->x, (size_t)n * sizeof *s->x);
    return RITZ_OK;
}

/* Rows 0..n-1 of some columns, times a factor. */
static ritz_status take_block(const ritz_dense *A, int64_t n, int64_t first,
                              int64_t count, double factor, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_block(A, 0, n, first, count, out));
    for (int64_t k = 0; k < n * count; k++)
        out->val[k] *= factor;
    return RITZ_OK;
}

ritz_status ritz_states_exact(const ritz_motion *motion, double step,
                              ritz_dense *E, ritz_dense *G, ritz_dense *H)
{
    int64_t n = motion->n;
    int64_t p = motion->B.ncol;
    double scale = fmax(ritz_dense_max(&motion->B), RITZ_LEAST_SCALE);
    RITZ_OWN(ritz_dense) A = {0}, X = {0};

    RITZ_CHECK(ritz_dense_new(n + 2 * p, n + 2 * p, &A));
    ritz_dense_put(&motion->A, 0, 0, &A);
    for (int64_t j = 0; j < p; j++) {
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&A, n + j)[i] =
                ritz_dense_col(&motion->B, j)[i] / scale;
        ritz_dense_col(&A, n + p + j)[n + j] = 1.0 / step;
    }
    RITZ_CHECK(ritz_exponential(&A, step, 0, NULL, &X, NULL));
    RITZ_CHECK(take_block(&X, n, 0, n, 1.0, E));
    RITZ_CHECK(take_block(&X, n, n, p, scale, G));
    return H ? take_block(&X, n, n + p, p, scale, H) : RITZ_OK;
}

static ritz_status fill_trapezoidal(const ritz_motion *motion, double step,
                                    states *s)
{
    int64_t n = motion->n;
    RITZ_OWN(ritz_dense) left = {0};

    RITZ_CHECK(ritz_dense_copy(&motion->A, &left));
    RITZ_CHECK(ritz_dense_copy(&motion->A, &s->E));
    for (int64_t k = 0; k < n * n; k++) {
        double one = k % (n + 1) == 0 ? 1.0 : 0.0;

        left.val[k] = one - 0.5 * step * left.val[k];
        s->E.val[k] = one + 0.5 * step * s->E.val[k];
    }
    RITZ_CHECK(take_block(&motion->B, n, 0, motion->B.ncol, step, &s->G));
    RITZ_CHECK(ritz_general_solve(&left, false, &s->E));
    RITZ_CHECK(ritz_general_solve(&left, false, &s->G));
    return take_block(&s->G, n, 0, s->G.ncol, 0.5, &s->H);
}

ritz_status ritz_states_start(const ritz_motion *motion, double step,
                              bool exact, ritz_march *out)
{
    states *s = NULL;

    RITZ_CHECK_NEW(s, 1);
    out->own = s;
    out->advance = advance_states;
    out->free = release_states;
    RITZ_CHECK_NEW(s->x, motion->n);
    RITZ_CHECK_NEW(s->rise, motion->B.ncol);
    return exact ? ritz_states_exact(motion, step, &s->E, &s->G, &s->H)
                 : fill_trapezoidal(motion, step, s);
}
