/*
 * Runs of joined bodies: a march whose state is that of all bodies, x and x'. A
 * ritz_integrator advances it with the terms of a stabilisation, or the
 * integrator of index 2 does.
 *
 * Energies are those of the bodies, and of the springs and masses of a penalty:
 *
 *     kinetic = |x'|^2 / 2 + inertia |c'|^2 / 2
 *     potential = x'K x / 2 + stiffness |c|^2 / 2
 *
 * The balance of energies differs from zero by what the integrator adds, and by
 * the work of forces along violated constraints: multipliers do no work where
 * c' = 0.
 */
#include "simulate/constrained.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { VIOLATION, RATE, MULTIPLIER, DIAGNOSTICS };

static const char *const diagnostics[DIAGNOSTICS] = {
    [VIOLATION] = "violation",
    [RATE] = "violation-rate",
    [MULTIPLIER] = "multiplier",
};

/* What a march of joined bodies owns; release_run frees it. */
typedef struct run_state {
    const ritz_linked *joined; /* borrowed */
    ritz_stabiliser terms;
    ritz_motion motion;     /* bodies with the terms of a stabilisation */
    ritz_march inner;       /* of this motion */
    ritz_index2 index2;     /* if terms.implicit */
    ritz_law_step law;      /* if terms.law */
    double *before, *force; /* n */
    double *mu, *g;         /* rank */
    double *u0, *u1;        /* inputs, followed by g */
    double *saved;          /* the inner state at the start of a step */
} run_state;

static void release_run(void *own)
{
    run_state *s = own;

    ritz_march_free(&s->inner);
    ritz_motion_free(&s->motion);
    ritz_index2_free(&s->index2);
    ritz_law_step_free(&s->law);
    RITZ_FREE(s->before, s->force, s->mu, s->g, s->u0, s->u1, s->saved, s);
}

/* Copy x and v into the inner march, or back from it. */
static void exchange_state(bool in, ritz_march *march)
{
    run_state *s = march->own;
    const size_t size = (size_t)march->motion->n * sizeof(double);

    memcpy(in ? s->inner.x : march->x, in ? march->x : s->inner.x, size);
    memcpy(in ? s->inner.v : march->v, in ? march->v : s->inner.v, size);
}

/* Copy the inner state to `saved`, or back from it. */
static void save_state(bool back, run_state *s)
{
    ritz_march *m = &s->inner;
    const int64_t n = m->motion->n;
    const struct {
        double *at;
        int64_t count;
    } part[] = {{m->x, n}, {m->v, n}, {m->memory, m->num_memory}};
    double *at = s->saved;

    for (int k = 0; k < 3; at += part[k].count, k++)
        if (part[k].count > 0)
            memcpy(back ? part[k].at : at, back ? at : part[k].at,
                   (size_t)part[k].count * sizeof *at);
}

/* g for c and c', the first of x and v. */
static void find_law(const run_state *s, const double *x, const double *v,
                     double *g)
{
    for (int64_t k = 0; k < s->joined->rank; k++) {
        double out[3] = {0.0};

        s->terms.law(&s->terms, x[k], v[k], out);
        g[k] = out[0];
    }
}

/* A step with g. It is first taken with g = 0 at its end, from which g there
   follows, and then repeated. */
static ritz_status advance_law(run_state *s)
{
    const int64_t rank = s->joined->rank;
    double *g0 = s->u0 + s->joined->motion.B.ncol;
    double *g1 = s->u1 + s->joined->motion.B.ncol;

    find_law(s, s->inner.x, s->inner.v, g0);
    memset(g1, 0, (size_t)rank * sizeof *g1);
    save_state(false, s);
    RITZ_CHECK(s->inner.advance(&s->inner, s->u0, s->u1));
    memcpy(s->law.c, s->inner.x, (size_t)rank * sizeof *g1);
    memcpy(s->law.rate, s->inner.v, (size_t)rank * sizeof *g1);
    memcpy(g1, g0, (size_t)rank * sizeof *g1);
    RITZ_CHECK(ritz_law_step_solve(&s->terms, &s->law, g1));
    save_state(true, s);
    return s->inner.advance(&s->inner, s->u0, s->u1);
}

/* c := 0, and c' likewise. */
static void project_state(ritz_march *march)
{
    const run_state *s = march->own;
    const size_t size = (size_t)s->joined->rank * sizeof(double);

    memset(march->x, 0, size);
    memset(march->v, 0, size);
}

/* Energy h v'A v that the damper A of a penalty dissipates, v = (c_1 - c_0) /
   h, and that a law dissipates. The changes of c are the first of those of
   x. */
static double dissipate_gaps(const run_state *s, double step)
{
    const double *g0 = s->u0 + s->joined->motion.B.ncol;
    const double *g1 = s->u1 + s->joined->motion.B.ncol;
    double sum = 0.0;

    for (int64_t k = 0; k < s->joined->rank; k++) {
        sum += s->terms.damping / step * s->before[k] * s->before[k];
        if (s->terms.law)
            sum -= 0.5 * (g0[k] + g1[k]) * s->before[k];
    }
    return sum;
}

/* Work is that of mean forces over the change of x, as in other integrators. */
static void account_energy(ritz_march *march, const double *u0,
                           const double *u1)
{
    const ritz_motion *m = march->motion;
    run_state *s = march->own;

    for (int64_t k = 0; k < m->n; k++)
        s->before[k] = march->x[k] - s->before[k];
    for (int64_t j = 0; j < m->B.ncol; j++)
        march->work +=
            0.5 * (u0[j] + u1[j]) *
            ritz_motion_dot(m->n, ritz_dense_col(&m->B, j), s->before);
    memset(s->force, 0, (size_t)m->n * sizeof *s->force);
    ritz_motion_gemv(&m->D, 1.0 / march->step, s->before, s->force);
    march->dissipated += ritz_motion_dot(m->n, s->before, s->force);
    if (!s->terms.multipliers)
        march->dissipated += dissipate_gaps(s, march->step);
}

static ritz_status advance_run(ritz_march *march, const double *u0,
                               const double *u1)
{
    const size_t inputs = (size_t)march->motion->B.ncol * sizeof(double);
    run_state *s = march->own;

    memcpy(s->before, march->x, (size_t)march->motion->n * sizeof(double));
    if (s->terms.implicit) {
        ritz_index2_step(&s->index2, u0, u1, march->x, march->v);
    } else {
        memcpy(s->u0, u0, inputs);
        memcpy(s->u1, u1, inputs);
        exchange_state(true, march);
        RITZ_CHECK(s->terms.law ? advance_law(s)
                                : s->inner.advance(&s->inner, s->u0, s->u1));
        exchange_state(false, march);
    }
    if (s->terms.projects)
        project_state(march);
    account_energy(march, u0, u1);
    return RITZ_OK;
}

static ritz_status settle_run(ritz_march *march, const double *u)
{
    run_state *s = march->own;

    if (s->terms.implicit) {
        ritz_index2_settle(&s->index2, march->x, march->v, u);
        return RITZ_OK;
    }
    exchange_state(true, march);
    memcpy(s->u0, u, (size_t)march->motion->B.ncol * sizeof *u);
    if (s->terms.law)
        find_law(s, march->x, march->v, s->u0 + march->motion->B.ncol);
    return s->inner.settle(&s->inner, s->u0);
}

/* mu = c_f'' - c'', c_f'' being that of free bodies. */
static void find_multipliers(const ritz_march *march, const double *u)
{
    const ritz_motion *m = march->motion;
    run_state *s = march->own;
    const ritz_stabiliser *t = &s->terms;

    memset(s->force, 0, (size_t)m->n * sizeof *s->force);
    ritz_motion_gemv(&m->B, 1.0, u, s->force);
    ritz_motion_gemv(&m->K, -1.0, march->x, s->force);
    ritz_motion_gemv(&m->D, -1.0, march->v, s->force);
    memset(s->g, 0, (size_t)s->joined->rank * sizeof *s->g);
    if (t->law)
        find_law(s, march->x, march->v, s->g);
    for (int64_t k = 0; k < s->joined->rank; k++) {
        const double held =
            t->stiffness * march->x[k] + t->damping * march->v[k] - s->g[k];

        s->mu[k] = t->multipliers ? s->force[k] + held
                                  : s->force[k] - (s->force[k] - held) /
                                                      (1.0 + t->inertia);
    }
}

/* Accelerations are those of free bodies and those that multipliers cause. */
static void find_outputs(const ritz_march *march, const double *u, double *y)
{
    const ritz_motion *m = march->motion;
    const run_state *s = march->own;

    for (int64_t i = 0; i < m->C.nrow; i++)
        y[i] = 0.0;
    ritz_motion_gemv(&m->C, 1.0, march->x, y);
    ritz_motion_gemv(&m->Cv, 1.0, march->v, y);
    ritz_motion_gemv(&m->feed, 1.0, u, y);
    find_multipliers(march, u);
    ritz_motion_gemv(&s->joined->reach, -1.0, s->mu, y);
}

static void find_energy(const ritz_march *march, double *kinetic,
                        double *potential)
{
    const ritz_motion *m = march->motion;
    const run_state *s = march->own;
    const double *x = march->x, *v = march->v;

    *kinetic = 0.5 * ritz_motion_dot(m->n, v, v);
    *potential = 0.5 * ritz_motion_form(&m->K, x);
    for (int64_t k = 0; !s->terms.multipliers && k < s->joined->rank; k++) {
        *kinetic += 0.5 * s->terms.inertia * v[k] * v[k];
        *potential += 0.5 * s->terms.stiffness * x[k] * x[k];
    }
}

/* Largest |A x| over the rows of A. */
static double find_largest(const ritz_dense *A, const double *x)
{
    double most = 0.0;

    for (int64_t i = 0; i < A->nrow; i++) {
        double sum = 0.0;

        for (int64_t j = 0; j < A->ncol; j++)
            sum += ritz_dense_col(A, j)[i] * x[j];
        most = fmax(most, fabs(sum));
    }
    return most;
}

/* It is called after find_outputs, which computes the multipliers. */
static void diagnose_run(const ritz_march *march, double *out)
{
    const run_state *s = march->own;

    out[VIOLATION] = find_largest(&s->joined->G, march->x);
    out[RATE] = find_largest(&s->joined->G, march->v);
    out[MULTIPLIER] = find_largest(&s->joined->L, s->mu);
}

/* Changes of c and c' at the end of a step by a unit g there. */
static ritz_status find_influence(run_state *s)
{
    const int64_t inputs = s->joined->motion.B.ncol;
    const int64_t rank = s->joined->rank;

    RITZ_CHECK(ritz_law_step_new(rank, &s->law));
    save_state(false, s); /* at rest */
    for (int64_t j = 0; j < rank; j++) {
        const size_t size = (size_t)rank * sizeof(double);

        s->u1[inputs + j] = 1.0;
        RITZ_CHECK(s->inner.advance(&s->inner, s->u0, s->u1));
        s->u1[inputs + j] = 0.0;
        memcpy(ritz_dense_col(&s->law.X, j), s->inner.x, size);
        memcpy(ritz_dense_col(&s->law.V, j), s->inner.v, size);
        save_state(true, s);
    }
    return RITZ_OK;
}

static ritz_status start_inner(const ritz_simulation_request *request,
                               run_state *s, ritz_march *out)
{
    RITZ_CHECK(ritz_stabilised_motion(s->joined, &s->terms, &s->motion));
    RITZ_CHECK(ritz_march_new(&s->motion, request->integrator, request->step,
                              request->rho, &s->inner));
    RITZ_CHECK_NEW(s->saved, 2 * s->motion.n + s->inner.num_memory);
    out->memory = s->inner.memory;
    out->num_memory = s->inner.num_memory;
    return s->terms.law ? find_influence(s) : RITZ_OK;
}

static ritz_status start_run(const ritz_linked *joined,
                             const ritz_stabiliser *terms,
                             const ritz_simulation_request *request,
                             ritz_march *out)
{
    const int64_t n = joined->motion.n;
    const int64_t rank = joined->rank;
    run_state *s = NULL;

    RITZ_CHECK_NEW(s, 1);
    out->own = s;
    out->free = release_run;
    s->joined = joined;
    s->terms = *terms;
    RITZ_CHECK_NEW(s->before, n);
    RITZ_CHECK_NEW(s->force, n);
    RITZ_CHECK_NEW(s->mu, rank);
    RITZ_CHECK_NEW(s->g, rank);
    RITZ_CHECK_NEW(s->u0, joined->motion.B.ncol + rank);
    RITZ_CHECK_NEW(s->u1, joined->motion.B.ncol + rank);
    if (!terms->implicit)
        return start_inner(request, s, out);
    RITZ_CHECK(
        ritz_index2_new(joined, request->step, request->rho, &s->index2));
    out->memory = s->index2.memory;
    out->num_memory = s->index2.num_memory;
    return RITZ_OK;
}

ritz_status ritz_constrained_march(const ritz_linked *joined,
                                   const ritz_stabiliser *terms,
                                   const ritz_simulation_request *request,
                                   ritz_march *out)
{
    RITZ_OWN(ritz_march)
    march = {
        .motion = &joined->motion,
        .step = request->step,
        .advance = advance_run,
        .settle = settle_run,
        .outputs = find_outputs,
        .energy = find_energy,
        .diagnose = diagnose_run,
        .num_diagnostics = DIAGNOSTICS,
        .diagnostic = diagnostics,
    };

    RITZ_CHECK_NEW(march.x, joined->motion.n);
    RITZ_CHECK_NEW(march.v, joined->motion.n);
    RITZ_CHECK(start_run(joined, terms, request, &march));
    RITZ_MOVE(*out, march);
    return RITZ_OK;
}
