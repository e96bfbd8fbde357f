/*
 * Generalised-alpha for constraints at the levels of position and velocity, the
 * multipliers eta and mu of Gear, Gupta and Leimkuhler
 * [GearLeimkuhlerGupta1985] in the scheme of [ArnoldBruls2007], with the
 * weights of [ChungHulbert1993]:
 *
 *     x_1 = x* + h^2 beta a_1 - W'eta,    x* = x_0 + h v_0 + h^2 (1/2 - beta)
 *     a_0 v_1 = v* + h gamma a_1,             v* = v_0 + h (1 - gamma) a_0 (1 -
 *     alpha_m) a_1 + alpha_m a_0 = (1 - alpha_f) r_1 + alpha_f r_0 r_1 = B u_1
 *     - Lambda x_1 - D v_1 - W'mu W x_1 = 0,    W v_1 = 0
 *
 * r is z'' by the equation of motion, and a is an average of it over a step. As
 * W W' = I, the constraints give eta directly,
 *
 *     W a_1 = -W v* / (h gamma),    eta = W x* - (h beta / gamma) W v*,
 *
 * and with S = m I + h gamma D + h^2 beta Lambda, m = (1 - alpha_m) / (1 -
 * alpha_f), the equations for a_1 and mu are
 *
 *     S a_1 + W'mu = R = B u_1 - Lambda (x* - W'eta) - D v*
 *                        - (alpha_m a_0 - alpha_f r_0) / (1 - alpha_f)
 *     (W S^-1 W') mu = W S^-1 R + W v* / (h gamma).
 *
 * If an input jumps between two steps, a_0 and r_0 are changed with it.
 */
#include "simulate/constrained.h"

#include "base/alloc.h"

#include <string.h>

static ritz_status factor_step(ritz_index2 *s)
{
    const ritz_motion *m = &s->joined->motion;
    const double h = s->step;
    RITZ_OWN(ritz_dense) S = {0}, WSW = {0};

    RITZ_CHECK(ritz_dense_new(m->n, m->n, &S));
    if (m->D.val)
        ritz_dense_add(h * s->w.gamma, &m->D, &S);
    for (int64_t k = 0; k < m->n; k++)
        ritz_dense_col(&S, k)[k] +=
            (1.0 - s->w.alpha_m) / (1.0 - s->w.alpha_f) +
            h * h * s->w.beta * m->lambda[k];
    RITZ_CHECK_IN("a step", ritz_general_factor_new(&S, &s->S));
    RITZ_CHECK(ritz_general_transpose(&s->joined->W, &s->SW));
    if (s->joined->rank == 0)
        return RITZ_OK;
    ritz_general_factor_solve(&s->S, false, &s->SW);
    RITZ_CHECK(ritz_dense_mul(&s->joined->W, &s->SW, &WSW));
    return ritz_context(ritz_general_factor_new(&WSW, &s->WSW), "a step");
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
    RITZ_CHECK_NEW(s.eta, joined->rank);
    RITZ_CHECK_NEW(s.mu, joined->rank);
    RITZ_CHECK(factor_step(&s));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

/* r = B u - Lambda x - D v */
static void find_forces(const ritz_motion *m, const double *u, const double *x,
                        const double *v, double *r)
{
    for (int64_t k = 0; k < m->n; k++)
        r[k] = -m->lambda[k] * x[k];
    ritz_motion_gemv(&m->B, 1.0, u, r);
    ritz_motion_gemv(&m->D, -1.0, v, r);
}

void ritz_index2_settle(ritz_index2 *s, const double *x, const double *v,
                        const double *u)
{
    const ritz_motion *m = &s->joined->motion;

    find_forces(m, u, x, v, s->a);
    ritz_linked_gap(s->joined, s->a, s->mu);
    ritz_linked_push(s->joined, -1.0, s->mu, s->a);
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

/* x* - W'eta and v*; mu = W v* / (h gamma). */
static void predict(ritz_index2 *s, const double *x, const double *v)
{
    const int64_t n = s->joined->motion.n;
    const int64_t rank = s->joined->rank;
    const double h = s->step;

    for (int64_t k = 0; k < n; k++) {
        s->x[k] = x[k] + h * (v[k] + h * (0.5 - s->w.beta) * s->a[k]);
        s->v[k] = v[k] + h * (1.0 - s->w.gamma) * s->a[k];
    }
    ritz_linked_gap(s->joined, s->x, s->eta);
    ritz_linked_gap(s->joined, s->v, s->mu);
    for (int64_t k = 0; k < rank; k++) {
        s->eta[k] -= h * s->w.beta / s->w.gamma * s->mu[k];
        s->mu[k] /= h * s->w.gamma;
    }
    ritz_linked_push(s->joined, -1.0, s->eta, s->x);
}

/* r becomes a_1. */
static void solve_step(ritz_index2 *s, const double *u1)
{
    const ritz_motion *m = &s->joined->motion;
    const double f1 = 1.0 - s->w.alpha_f;
    ritz_dense right = {m->n, 1, s->r};             /* borrowed */
    ritz_dense force = {s->joined->rank, 1, s->mu}; /* borrowed */

    find_forces(m, u1, s->x, s->v, s->r);
    for (int64_t k = 0; k < m->n; k++)
        s->r[k] -= (s->w.alpha_m * s->a[k] - s->w.alpha_f * s->rate[k]) / f1;
    ritz_general_factor_solve(&s->S, false, &right);
    if (s->joined->rank == 0)
        return;
    ritz_motion_gemv(&s->joined->W, 1.0, s->r, s->mu);
    ritz_general_factor_solve(&s->WSW, false, &force);
    ritz_motion_gemv(&s->SW, -1.0, s->mu, s->r);
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
    ritz_general_factor_free(&s->WSW);
    ritz_dense_free(&s->SW);
    RITZ_FREE(s->memory, s->x, s->v, s->r, s->eta, s->mu);
    *s = (ritz_index2){0};
}

static ritz_status find_terms(const double *gain, ritz_stabiliser *out)
{
    (void)gain;
    *out = (ritz_stabiliser){.multipliers = true, .implicit = true};
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
