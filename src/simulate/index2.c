/*
 * Generalised-alpha for constraints at the levels of position and velocity, the
 * multipliers eta and mu of Gear, Gupta and Leimkuhler
 * [GearLeimkuhlerGupta1985] in the scheme of [ArnoldBruls2007], with the
 * weights of [ChungHulbert1993]:
 *
 *     x_1 = x* + h^2 beta a_1 - (eta, 0),
 *     x* = x_0 + h v_0 + h^2 (1/2 - beta) a_0
 *     v_1 = v* + h gamma a_1,    v* = v_0 + h (1 - gamma) a_0
 *     (1 - alpha_m) a_1 + alpha_m a_0 = (1 - alpha_f) r_1 + alpha_f r_0
 *     r_1 = B u_1 - K x_1 - D v_1 - (mu, 0)
 *     c_1 = 0,    c_1' = 0
 *
 * r is x'' by the equation of motion, and a is an average of it over a step.
 * The constraints give eta and the first part of a_1 directly,
 *
 *     a_c = -c*' / (h gamma),    eta = c* + h^2 beta a_c,
 *
 * and with S = m I + h gamma D + h^2 beta K, m = (1 - alpha_m) / (1 - alpha_f),
 * the other part of a_1 follows from
 *
 *     (S a_1)_p = R_p,   R = B u_1 - K (x* - (eta, 0)) - D v*
 *                            - (alpha_m a_0 - alpha_f r_0) / (1 - alpha_f).
 *
 * S is factored with the rows of c replaced by those of the identity. mu is not
 * needed. If an input jumps between two steps, a_0 and r_0 are changed with it.
 *
 * The start satisfies the constraints, and so does its acceleration: from one
 * that does not, c is removed by forces of the first step alone, whose length
 * is then the order of the error.
 */
#include "simulate/constrained.h"

#include "base/alloc.h"

#include <string.h>

static ritz_status factor_step(ritz_index2 *s)
{
    const ritz_motion *m = &s->joined->motion;
    const double h = s->step;
    const double mass = (1.0 - s->w.alpha_m) / (1.0 - s->w.alpha_f);
    RITZ_OWN(ritz_dense) S = {0};

    RITZ_CHECK(ritz_dense_new(m->n, m->n, &S));
    ritz_dense_add(h * s->w.gamma, &m->D, &S);
    ritz_dense_add(h * h * s->w.beta, &m->K, &S);
    for (int64_t k = 0; k < m->n; k++) {
        for (int64_t i = 0; i < s->joined->rank; i++)
            ritz_dense_col(&S, k)[i] = 0.0;
        ritz_dense_col(&S, k)[k] =
            k < s->joined->rank ? 1.0 : ritz_dense_col(&S, k)[k] + mass;
    }
    return ritz_context(ritz_general_factor_new(&S, &s->S), "a step");
}

ritz_status ritz_index2_new(const ritz_linked *joined, double step, double rho,
                            ritz_index2 *out)
{
    const ritz_motion *m = &joined->motion;
    RITZ_OWN(ritz_index2) s = {.joined = joined, .step = step};

    RITZ_CHECK(ritz_generalised_alpha(rho, &s.w));
    s.num_memory = 2 * m->n + m->B.ncol;
    RITZ_CHECK_NEW(s.memory, s.num_memory);
    s.a = s.memory;
    s.rate = s.memory + m->n;
    s.last = s.rate + m->n;
    RITZ_CHECK_NEW(s.x, m->n);
    RITZ_CHECK_NEW(s.v, m->n);
    RITZ_CHECK_NEW(s.r, m->n);
    RITZ_CHECK(factor_step(&s));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

/* r = B u - K x - D v */
static void find_forces(const ritz_motion *m, const double *u, const double *x,
                        const double *v, double *r)
{
    memset(r, 0, (size_t)m->n * sizeof *r);
    ritz_motion_gemv(&m->B, 1.0, u, r);
    ritz_motion_gemv(&m->K, -1.0, x, r);
    ritz_motion_gemv(&m->D, -1.0, v, r);
}

void ritz_index2_settle(ritz_index2 *s, const double *x, const double *v,
                        const double *u)
{
    const ritz_motion *m = &s->joined->motion;

    find_forces(m, u, x, v, s->a);
    memset(s->a, 0, (size_t)s->joined->rank * sizeof *s->a);
    memcpy(s->rate, s->a, (size_t)m->n * sizeof *s->a);
    memcpy(s->last, u, (size_t)m->B.ncol * sizeof *u);
}

static void follow_jumps(ritz_index2 *s, const double *u)
{
    const ritz_motion *m = &s->joined->motion;

    for (int64_t j = 0; j < m->B.ncol; j++) {
        const double jump = u[j] - s->last[j];
        const double *push = ritz_dense_col(&m->push, j);

        for (int64_t k = 0; jump != 0.0 && k < m->n; k++) {
            s->a[k] += jump * push[k];
            s->rate[k] += jump * push[k];
        }
    }
}

/* x* and v* */
static void predict(ritz_index2 *s, const double *x, const double *v)
{
    const double h = s->step;

    for (int64_t k = 0; k < s->joined->motion.n; k++) {
        s->x[k] = x[k] + h * (v[k] + h * (0.5 - s->w.beta) * s->a[k]);
        s->v[k] = v[k] + h * (1.0 - s->w.gamma) * s->a[k];
    }
}

/* r becomes a_1. */
static void solve_step(ritz_index2 *s, const double *u1)
{
    const ritz_motion *m = &s->joined->motion;
    const double h = s->step;
    const double f1 = 1.0 - s->w.alpha_f;
    ritz_dense right = {m->n, 1, s->r}; /* borrowed */

    for (int64_t k = 0; k < s->joined->rank; k++) /* x* - (eta, 0) */
        s->x[k] = h * s->w.beta / s->w.gamma * s->v[k];
    find_forces(m, u1, s->x, s->v, s->r);
    for (int64_t k = 0; k < m->n; k++)
        s->r[k] -= (s->w.alpha_m * s->a[k] - s->w.alpha_f * s->rate[k]) / f1;
    for (int64_t k = 0; k < s->joined->rank; k++) /* a_c */
        s->r[k] = -s->v[k] / (h * s->w.gamma);
    ritz_general_factor_solve(&s->S, false, &right);
}

void ritz_index2_step(ritz_index2 *s, const double *u0, const double *u1,
                      double *x, double *v)
{
    const ritz_motion *m = &s->joined->motion;
    const double h = s->step;
    const double f1 = 1.0 - s->w.alpha_f;

    follow_jumps(s, u0);
    predict(s, x, v);
    solve_step(s, u1);
    for (int64_t k = 0; k < m->n; k++) {
        x[k] = s->x[k] + h * h * s->w.beta * s->r[k];
        v[k] = s->v[k] + h * s->w.gamma * s->r[k];
        s->rate[k] = ((1.0 - s->w.alpha_m) * s->r[k] + s->w.alpha_m * s->a[k] -
                      s->w.alpha_f * s->rate[k]) /
                     f1;
        s->a[k] = s->r[k];
    }
    memcpy(s->last, u1, (size_t)m->B.ncol * sizeof *u1);
}

void ritz_index2_free(ritz_index2 *s)
{
    ritz_general_factor_free(&s->S);
    RITZ_FREE(s->memory, s->x, s->v, s->r);
    *s = (ritz_index2){0};
}

static ritz_status find_terms(const double *gain, ritz_stabiliser *out)
{
    (void)gain;
    *out = (ritz_stabiliser){
        .multipliers = true, .projects = true, .implicit = true};
    return RITZ_OK;
}

const ritz_stabilisation ritz_stabilisation_index_2 = {
    .name = "index-2",
    .summary = "generalised-alpha that solves for positions and velocities in "
               "the constraints (--rho)",
    .accuracy = "second order",
    .needs = "nothing",
    .stability = "any step",
    .frequency = "stays",
    .fails = "dissipates energy of motions that the step does not resolve",
    .reference = "ArnoldBruls2007",
    .terms = find_terms,
};
