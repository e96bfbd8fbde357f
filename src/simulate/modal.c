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
 * ritz_exponential, exact as well. Matrices of coupled modes are those of
 * step_matrix.h: a few dampers between modes cost O(N k) a step.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "simulate/motion.h"
#include "simulate/step_matrix.h"

#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Modes that D couples; one alone if `o` is to be used. */
typedef struct coupled_modes {
    int64_t count; /* g */
    const int64_t *mode;
    ritz_oscillator o;
    double scale;
    ritz_step_matrix E;    /* 2 g x N, N = 2 g + 2 p; one alone: {0} */
    ritz_step_matrix W[2]; /* N x N, of damping and of inputs; or {0} */
    double alone[2][4][4]; /* the same forms of one mode */
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
        ritz_step_matrix_free(&s->group[k].E);
        ritz_step_matrix_free(&s->group[k].W[0]);
        ritz_step_matrix_free(&s->group[k].W[1]);
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

/* The forms of a mode alone. */
static ritz_status prepare_alone(const ritz_motion *m, double h,
                                 coupled_modes *part)
{
    RITZ_OWN(ritz_dense) A = {0}, E = {0};
    RITZ_OWN(ritz_dense_pair) Q = {0}, W = {0};

    RITZ_CHECK(group_matrix(m, part, &A));
    RITZ_CHECK(group_forms(m, part, &A, Q));
    RITZ_CHECK(ritz_exponential(&A, h, 2, Q, &E, W));
    for (int f = 0; f < 2; f++)
        memcpy(part->alone[f], W[f].val, sizeof part->alone[f]);
    return RITZ_OK;
}

static ritz_status prepare_group(const ritz_motion *m, double h,
                                 coupled_modes *part)
{
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN(ritz_dense_pair) Q = {0};
    RITZ_OWN(ritz_dense) D = {0};
    RITZ_OWN_ARRAY double *lambda = NULL;
    const int64_t g = part->count, j = part->mode[0];

    part->scale = fmax(ritz_dense_max(&m->B), RITZ_LEAST_SCALE);
    if (g == 1) {
        part->o =
            ritz_oscillator_over(m->lambda[j], ritz_dense_col(&m->D, j)[j], h);
        return m->energies ? prepare_alone(m, h, part) : RITZ_OK;
    }
    RITZ_CHECK_NEW(lambda, g);
    RITZ_CHECK(ritz_dense_principal(&m->D, g, part->mode, &D));
    for (int64_t i = 0; i < g; i++)
        lambda[i] = m->lambda[part->mode[i]];
    RITZ_CHECK(group_matrix(m, part, &A));
    if (m->energies)
        RITZ_CHECK(group_forms(m, part, &A, Q));
    return ritz_step_matrices(&(ritz_step_matrix_modes){g, lambda, &D, 2 * g},
                              &A, h, m->energies ? 2 : 0, Q, &part->E, part->W);
}

/* z'W z of a mode alone. */
static double value_alone(const double W[4][4], const double z[4])
{
    double sum = 0.0;

    for (int j = 0; j < 4; j++)
        sum += z[j] * (W[j][0] * z[0] + W[j][1] * z[1] + W[j][2] * z[2] +
                       W[j][3] * z[3]);
    return sum;
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

    if (march->motion->energies) {
        march->dissipated += value_alone(part->alone[0], z);
        march->work += value_alone(part->alone[1], z);
    }
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
    if (m->energies) {
        march->dissipated += ritz_step_matrix_value(&part->W[0], s->z);
        march->work += ritz_step_matrix_value(&part->W[1], s->z);
    }
    ritz_step_matrix_apply(&part->E, s->z, s->z1);
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
