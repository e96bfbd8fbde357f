/*
 * Exact propagation by modes [Sirlin1992]: inputs that are held, or linear,
 * over a step leave no error but rounding, at any step. Modes that D does not
 * couple are propagated by the closed forms below; those it couples
 * together, each group by one exponential of
 *
 *     z = [q; q'; s u; s u'],   z' = [0 I 0 0; -L -D B/s 0; 0 0 0 I; 0 0 0 0] z
 *
 * s the largest entry of B, lest large units cost doublings.
 *
 * What damping takes in a step and what inputs give are z'W z with W of
 * exponential.c, exact as well.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "simulate/motion.h"

#include <ritz/matrix.h>

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/*
 * All are divided differences of exp(s h) over the roots s_1, s_2 of
 * s^2 + d s + lambda and over 0: S of [s_1, s_2], P of [0, s_1, s_2] and R of
 * [0, 0, s_1, s_2]. So
 *
 * - while the roots are small, |s| h <= 1, by their power series: with h_k the
 *   complete symmetric polynomials, h_k = -d h_(k-1) - lambda h_(k-2),
 *
 *       S = sum h_k h^(k+1) / (k+1)!
 *
 *   and P, R one and two powers further; there is no root in it, and nothing
 *   divides;
 * - of real roots by the recursion that divides by the larger of them,
 *   P = (E - S) / -s_big, E = (exp(s_small h) - 1) / s_small, as the small one
 *   may vanish, and with expm1, as they may meet;
 * - of complex roots by sine and cosine, P and R from the equation itself,
 *   S' - 1 + d S + lambda P = 0 and S - h + d P + lambda R = 0, which loses
 *   nothing as lambda h^2 >= 1 there.
 */

/* 1/22! is below the rounding of 1. */
enum { TERMS = 22 };

static ritz_oscillator by_series(double lambda, double d, double h)
{
    ritz_oscillator o = {0};
    double before = 0.0; /* h_(k-1), each times h^k */
    double term = 1.0;
    double factorial = 1.0; /* k! */

    for (int k = 0; k < TERMS; k++) {
        double next = -d * h * term - lambda * h * h * before;

        o.rate += term / factorial;
        o.S += h * term / (factorial * (k + 1));
        o.P += h * h * term / (factorial * (k + 1) * (k + 2));
        o.R += h * h * h * term / (factorial * (k + 1) * (k + 2) * (k + 3));
        factorial *= k + 1;
        before = term;
        term = next;
    }
    o.hold = 1.0 - lambda * o.P;
    return o;
}

/* (exp(s h) - 1 - s h) / s^2 */
static double second_difference(double s, double h)
{
    double z = s * h;
    double sum = 0.0;

    if (fabs(z) > 1.0)
        return (expm1(z) - z) / (s * s);
    for (int k = TERMS; k >= 2; k--)
        sum = sum * z / (k + 1) + 1.0;
    return 0.5 * h * h * sum;
}

static ritz_oscillator by_real_roots(double lambda, double d, double h)
{
    ritz_oscillator o = {0};
    double half = 0.5 * d;
    double root = sqrt(fmax(half * half - lambda, 0.0));
    double big = half >= 0.0 ? -(half + root) : root - half;
    double small = lambda / big;
    double gap = 2.0 * root;
    double top = big > small ? big : small;
    double first = small != 0.0 ? expm1(small * h) / small : h;

    o.S = exp(top * h) * (gap * h > 0.0 ? -expm1(-gap * h) / gap : h);
    o.rate = exp(big * h) + small * o.S;
    o.hold = exp(big * h) - big * o.S;
    o.P = (o.S - first) / big;
    o.R = (o.P - second_difference(small, h)) / big;
    return o;
}

static ritz_oscillator by_complex_roots(double lambda, double d, double h)
{
    ritz_oscillator o = {0};
    double w = sqrt(lambda);
    double half = 0.5 * d;
    double r = sqrt((w - half) * (w + half));
    double fade = exp(-half * h);

    o.S = fade * (r > 0.0 ? sin(r * h) / r : h);
    o.rate = fade * cos(r * h) - half * o.S;
    o.hold = fade * cos(r * h) + half * o.S;
    o.P = (1.0 - o.hold) / lambda;
    o.R = (h - o.S - d * o.P) / lambda;
    return o;
}

ritz_oscillator ritz_oscillator_over(double lambda, double d, double h)
{
    if (fabs(d) * h <= 1.0 && fabs(lambda) * h * h <= 1.0)
        return by_series(lambda, d, h);
    if (lambda <= 0.25 * d * d)
        return by_real_roots(lambda, d, h);
    return by_complex_roots(lambda, d, h);
}

/* Modes that D couples; one alone if `o` is to be used. */
typedef struct coupled_modes {
    int64_t count; /* g */
    const int64_t *mode;
    ritz_oscillator o;
    double scale;
    ritz_dense E;    /* N x N, N = 2 g + 2 p, or {0} */
    ritz_dense W[2]; /* N x N, of damping and of inputs; or {0} */
} coupled_modes;

typedef struct modal {
    int64_t num_groups;
    coupled_modes *group;
    ritz_groups parts;
    double *f, *g; /* n, modal forces and their rates */
    double *z, *z1;
} modal;

static void release_modal(void *own)
{
    modal *s = own;

    for (int64_t k = 0; s->group && k < s->num_groups; k++) {
        ritz_dense_free(&s->group[k].E);
        ritz_dense_free(&s->group[k].W[0]);
        ritz_dense_free(&s->group[k].W[1]);
    }
    free(s->group);
    ritz_groups_free(&s->parts);
    RITZ_FREE(s->f, s->g, s->z, s->z1, s);
}

/* The matrix of z'; `forces` of a lone mode, whose input is its own force. */
static ritz_status group_matrix(const ritz_motion *m, const coupled_modes *part,
                                ritz_dense *out)
{
    int64_t g = part->count;
    int64_t p = g == 1 ? 1 : m->B.ncol;
    RITZ_OWN(ritz_dense) A = {0};

    RITZ_CHECK(ritz_dense_new(2 * g + 2 * p, 2 * g + 2 * p, &A));
    for (int64_t j = 0; j < g; j++) {
        const double *d = ritz_dense_col(&m->D, part->mode[j]);

        ritz_dense_col(&A, g + j)[j] = 1.0;
        ritz_dense_col(&A, j)[g + j] = -m->lambda[part->mode[j]];
        for (int64_t i = 0; i < g; i++)
            ritz_dense_col(&A, g + j)[g + i] = -d[part->mode[i]];
    }
    for (int64_t j = 0; j < p; j++) {
        double *b = ritz_dense_col(&A, 2 * g + j) + g;

        for (int64_t i = 0; i < g; i++)
            b[i] = g == 1
                       ? 1.0
                       : ritz_dense_col(&m->B, j)[part->mode[i]] / part->scale;
        ritz_dense_col(&A, 2 * g + p + j)[2 * g + j] = 1.0;
    }
    RITZ_MOVE(*out, A);
    return RITZ_OK;
}

/* q'D q' and q'B u as forms of z. */
static ritz_status group_forms(const ritz_motion *m, const coupled_modes *part,
                               const ritz_dense *A, ritz_dense Q[2])
{
    int64_t g = part->count;

    RITZ_CHECK(ritz_dense_new(A->nrow, A->nrow, &Q[0]));
    RITZ_CHECK(ritz_dense_new(A->nrow, A->nrow, &Q[1]));
    for (int64_t j = 0; j < g; j++)
        for (int64_t i = 0; i < g; i++)
            ritz_dense_col(&Q[0], g + j)[g + i] =
                0.5 * (ritz_dense_col(&m->D, part->mode[j])[part->mode[i]] +
                       ritz_dense_col(&m->D, part->mode[i])[part->mode[j]]);
    for (int64_t j = 2 * g; j < A->nrow; j++)
        for (int64_t i = g; i < 2 * g; i++) {
            ritz_dense_col(&Q[1], j)[i] = 0.5 * ritz_dense_col(A, j)[i];
            ritz_dense_col(&Q[1], i)[j] = 0.5 * ritz_dense_col(A, j)[i];
        }
    return RITZ_OK;
}

static ritz_status prepare_group(const ritz_motion *m, double h,
                                 coupled_modes *part)
{
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN(ritz_dense_pair) Q = {0};
    int64_t j = part->mode[0];

    part->scale = fmax(ritz_dense_max(&m->B), RITZ_LEAST_SCALE);
    if (part->count == 1) {
        part->o =
            ritz_oscillator_over(m->lambda[j], ritz_dense_col(&m->D, j)[j], h);
        if (!m->energies)
            return RITZ_OK;
    }
    RITZ_CHECK(group_matrix(m, part, &A));
    if (m->energies)
        RITZ_CHECK(group_forms(m, part, &A, Q));
    return ritz_exponential(&A, h, m->energies ? 2 : 0, Q, &part->E, part->W);
}

static void account_energy(const coupled_modes *part, const double *z,
                           ritz_march *march)
{
    march->dissipated += ritz_motion_form(&part->W[0], z);
    march->work += ritz_motion_form(&part->W[1], z);
}

/* A mode alone. */
static void advance_one(const coupled_modes *part, double f, double g,
                        ritz_march *march)
{
    int64_t j = part->mode[0];
    const ritz_oscillator *o = &part->o;
    double q = march->x[j];
    double v = march->v[j];
    const double z[4] = {q, v, f, g};

    if (march->motion->energies)
        account_energy(part, z, march);
    march->x[j] = o->hold * q + o->S * v + o->P * f + o->R * g;
    march->v[j] = -march->motion->lambda[j] * o->S * q + o->rate * v +
                  o->S * f + o->P * g;
}

static void advance_group(const coupled_modes *part, const double *u0,
                          const double *u1, modal *s, ritz_march *march)
{
    const ritz_motion *m = march->motion;
    int64_t g = part->count;
    int64_t p = m->B.ncol;

    for (int64_t i = 0; i < g; i++) {
        s->z[i] = march->x[part->mode[i]];
        s->z[g + i] = march->v[part->mode[i]];
    }
    for (int64_t j = 0; j < p; j++) {
        s->z[2 * g + j] = part->scale * u0[j];
        s->z[2 * g + p + j] = part->scale * (u1[j] - u0[j]) / march->step;
    }
    if (m->energies)
        account_energy(part, s->z, march);
    memset(s->z1, 0, (size_t)(2 * g + 2 * p) * sizeof *s->z1);
    ritz_motion_gemv(&part->E, 1.0, s->z, s->z1);
    for (int64_t i = 0; i < g; i++) {
        march->x[part->mode[i]] = s->z1[i];
        march->v[part->mode[i]] = s->z1[g + i];
    }
}

static ritz_status advance_modal(ritz_march *march, const double *u0,
                                 const double *u1)
{
    const ritz_motion *m = march->motion;
    modal *s = march->own;

    memset(s->f, 0, (size_t)m->n * sizeof *s->f);
    memset(s->g, 0, (size_t)m->n * sizeof *s->g);
    for (int64_t j = 0; j < m->B.ncol; j++) {
        const double *b = ritz_dense_col(&m->B, j);
        double rate = (u1[j] - u0[j]) / march->step;

        for (int64_t k = 0; k < m->n; k++) {
            s->f[k] += b[k] * u0[j];
            s->g[k] += b[k] * rate;
        }
    }
    for (int64_t k = 0; k < s->num_groups; k++) {
        const coupled_modes *part = &s->group[k];

        if (part->count == 1)
            advance_one(part, s->f[part->mode[0]], s->g[part->mode[0]], march);
        else
            advance_group(part, u0, u1, s, march);
    }
    return RITZ_OK;
}

static ritz_status start_modal(const ritz_motion *motion, double step,
                               double rho, ritz_march *out)
{
    int64_t room = 2 * motion->n + 2 * motion->B.ncol;
    modal *s = NULL;

    (void)rho;
    if (motion->form == RITZ_FORM_STATES)
        return ritz_states_start(motion, step, true, out);
    RITZ_CHECK_NEW(s, 1);
    out->own = s;
    out->advance = advance_modal;
    out->free = release_modal;
    RITZ_CHECK(ritz_groups_new(
        &motion->D, RITZ_SUM_ROUNDING * ritz_dense_max(&motion->D), &s->parts));
    RITZ_CHECK_NEW(s->group, s->parts.count);
    s->num_groups = s->parts.count;
    RITZ_CHECK_NEW(s->f, motion->n);
    RITZ_CHECK_NEW(s->g, motion->n);
    RITZ_CHECK_NEW(s->z, room);
    RITZ_CHECK_NEW(s->z1, room);
    for (int64_t k = 0; k < s->num_groups; k++) {
        s->group[k].mode = s->parts.member + s->parts.first[k];
        s->group[k].count = s->parts.first[k + 1] - s->parts.first[k];
        RITZ_CHECK(prepare_group(motion, step, &s->group[k]));
    }
    return RITZ_OK;
}

const ritz_integrator ritz_integrator_modal = {
    .name = "modal",
    .summary = "exact for inputs held or linear over a step, mode by mode",
    .accuracy = "exact but for rounding, and for what inputs do in a step",
    .stability = "any step",
    .dissipation = "none of its own",
    .fails = "structural damping; of a component it needs --up-to-hz",
    .reference = "Sirlin1992",
    .takes_states = true,
    .start = start_modal,
};
