/*
 * A closed loop whose parts are propagated separately [Sirlin1992]: over a step
 * h the plant with the output of the controller held constant, and the
 * controller with its measurement held constant, each exactly,
 *
 *     x_1 = exp(A h) x_0 + integral exp(A s) ds B (r + s v_0)
 *     w_1 = exp(A_c h) w_0 + integral exp(A_c s) ds B_c e_0
 *     e_0 = Q (C_y x_0 + s D_yu C_c w_0 + D_y r_0),   v_0 = C_c w_0 + D_c e_0
 *
 * which differs from the exponential of the closed loop by O(h^2) a step, so
 * that the error is of first order. Any other integrator may propagate the
 * plant.
 *
 * A sampled controller is propagated in the same way, with several steps from
 * one sample to the next. This has no error, because its output really is held.
 * With a delay, outputs wait in a queue (`line`), and what is measured at a
 * sample depends on the output that then acts, not on the one computed from it.
 */
#include "simulate/controlled.h"

#include "base/alloc.h"
#include "response/loop.h"

#include <stdlib.h>
#include <string.h>

typedef struct split {
    ritz_march plant; /* x and v are shared with the march of the loop */
    const ritz_loop *loop;
    double sign;
    int64_t states, measured, driven; /* of the controller */
    int64_t period, delay;            /* steps */
    int64_t kept;                     /* samples whose outputs are in `line`,
                                         the last one first */
    ritz_dense A, B, C, D;            /* of the controller, sample to sample */
    ritz_dense e;    /* measurement, over [x; v; w; r]; with a delay, without
                        the part of the controller's output */
    ritz_dense D_yu; /* measured x driven */
    double *memory;  /* of the plant, and then w, line and work */
    double *w, *line, *work;
    double *z;       /* [x; v; w; r] */
    double *seen;    /* e */
    double *next;    /* next w */
    double *u0, *u1; /* of the plant */
    ritz_loop_notes notes;
} split;

static void release_split(void *own)
{
    split *s = own;
    enum { MATRICES = 6 };
    ritz_dense *const matrices[MATRICES] = {&s->A, &s->B, &s->C,
                                            &s->D, &s->e, &s->D_yu};

    if (s->plant.own)
        s->plant.free(s->plant.own);
    for (int k = 0; k < MATRICES; k++)
        ritz_dense_free(matrices[k]);
    ritz_loop_notes_free(&s->notes);
    RITZ_FREE(s->memory, s->z, s->seen, s->next, s->u0, s->u1, s);
}

/* y = A x */
static void multiply(const ritz_dense *A, const double *x, double *y)
{
    for (int64_t i = 0; i < A->nrow; i++)
        y[i] = 0.0;
    ritz_motion_gemv(A, 1.0, x, y);
}

/* Age, in samples, of the output that acts in a step, if the last sample was
   taken `phase` steps before. */
static int64_t age_of(const split *s, int64_t phase)
{
    return phase >= s->delay ? 0
                             : (s->delay - phase + s->period - 1) / s->period;
}

/* Measurement and output of the controller at a sample, with inputs r. */
static void find_output(const split *s, const ritz_march *march,
                        const double *r, double *v)
{
    const int64_t n = march->motion->n;
    double *z = s->z;

    memcpy(z, march->x, (size_t)n * sizeof *z);
    z += n;
    if (march->v) {
        memcpy(z, march->v, (size_t)n * sizeof *z);
        z += n;
    }
    memcpy(z, s->w, (size_t)s->states * sizeof *z);
    memcpy(z + s->states, r, (size_t)march->motion->B.ncol * sizeof *z);
    multiply(&s->e, s->z, s->seen);
    if (s->delay > 0) /* `line` is still that of the last sample */
        ritz_motion_gemv(&s->D_yu, s->sign,
                         s->line + (age_of(s, 0) - 1) * s->driven, s->seen);
    multiply(&s->C, s->w, v);
    ritz_motion_gemv(&s->D, 1.0, s->seen, v);
}

/* Take a sample: keep the output, and advance the states of the controller. */
static void take_sample(split *s, const ritz_march *march, const double *r)
{
    const size_t row = (size_t)s->driven * sizeof *s->line;

    find_output(s, march, r, s->notes.acting);
    memmove(s->line + s->driven, s->line, (size_t)(s->kept - 1) * row);
    memcpy(s->line, s->notes.acting, row);
    multiply(&s->A, s->w, s->next);
    ritz_motion_gemv(&s->B, 1.0, s->seen, s->next);
    memcpy(s->w, s->next, (size_t)s->states * sizeof *s->w);
}

/* u = r + s v on the inputs that are driven. */
static void add_output(const split *s, const double *v, double *u)
{
    for (int64_t j = 0; j < s->driven; j++)
        u[s->loop->driven[j]] += s->sign * v[j];
}

/* (s v)'B'x, whose change over a step is the work of forces that are held. */
static double moment_of(const split *s, const ritz_march *march,
                        const double *v)
{
    const ritz_motion *m = march->motion;
    double sum = 0.0;

    for (int64_t j = 0; j < s->driven; j++)
        sum += s->sign * v[j] *
               ritz_motion_dot(m->n, ritz_dense_col(&m->B, s->loop->driven[j]),
                               march->x);
    return sum;
}

static ritz_status advance_split(ritz_march *march, const double *u0,
                                 const double *u1)
{
    split *s = march->own;
    ritz_march *plant = &s->plant;
    const size_t inputs = (size_t)march->motion->B.ncol * sizeof *u0;
    const int64_t phase = march->steps % s->period;
    const double *v = s->line + age_of(s, phase) * s->driven;
    double before = 0.0;

    if (phase == 0)
        take_sample(s, march, u0);
    memcpy(s->u0, u0, inputs);
    memcpy(s->u1, u1, inputs);
    add_output(s, v, s->u0);
    add_output(s, v, s->u1);
    if (s->notes.work)
        before = moment_of(s, march, v);
    plant->work = march->work;
    plant->dissipated = march->dissipated;
    for (int64_t k = 0; k < plant->num_memory; k++)
        plant->memory[k] = s->memory[k];
    RITZ_CHECK(plant->advance(plant, s->u0, s->u1));
    for (int64_t k = 0; k < plant->num_memory; k++)
        s->memory[k] = plant->memory[k];
    march->work = plant->work;
    march->dissipated = plant->dissipated;
    if (s->notes.work)
        *s->work += moment_of(s, march, v) - before;
    return RITZ_OK;
}

/* The output that acts from the present time on, before a sample is taken. */
static void find_acting(const ritz_march *march, const double *r)
{
    split *s = march->own;
    const int64_t phase = march->steps % s->period;
    const int64_t age = age_of(s, phase);

    if (phase == 0 && s->delay == 0)
        find_output(s, march, r, s->notes.acting);
    else
        memcpy(s->notes.acting,
               s->line + (phase == 0 ? age - 1 : age) * s->driven,
               (size_t)s->driven * sizeof *s->line);
    memcpy(s->u0, r, (size_t)march->motion->B.ncol * sizeof *r);
    add_output(s, s->notes.acting, s->u0);
}

static void output_split(const ritz_march *march, const double *u, double *y)
{
    const split *s = march->own;

    find_acting(march, u);
    ritz_march_outputs(&s->plant, s->u0, y);
}

static ritz_status settle_split(ritz_march *march, const double *u)
{
    split *s = march->own;
    ritz_march *plant = &s->plant;

    if (!plant->settle)
        return RITZ_OK;
    find_acting(march, u);
    RITZ_CHECK(plant->settle(plant, s->u0));
    for (int64_t k = 0; k < plant->num_memory; k++)
        s->memory[k] = plant->memory[k];
    return RITZ_OK;
}

static void diagnose_split(const ritz_march *march, double *out)
{
    const split *s = march->own;

    ritz_loop_notes_fill(&s->notes, out);
}

/* A, B, C and D of the controller as a discrete system from sample to
   sample. */
static ritz_status sample_controller(const ritz_controlled *controlled,
                                     double period, split *s)
{
    const ritz_state_space *c = controlled->controller;
    const ritz_simulation_request request = RITZ_SIMULATION_NONE;
    RITZ_OWN(ritz_motion) motion = {0};

    RITZ_CHECK_IN("controller",
                  ritz_motion_new(ritz_model_of_states(c), &request, &motion));
    RITZ_MOVE(s->C, motion.C);
    RITZ_MOVE(s->D, motion.feed);
    if (!controlled->discrete)
        return ritz_states_exact(&motion, period, &s->A, &s->B, NULL);
    RITZ_MOVE(s->A, motion.A);
    RITZ_MOVE(s->B, motion.B);
    return RITZ_OK;
}

/* The rows of the measurement. */
static ritz_status find_measured(const ritz_motion *motion,
                                 const ritz_controlled *controlled, split *s)
{
    const ritz_loop *loop = controlled->loop;
    const ritz_state_space *c = controlled->controller;
    RITZ_OWN(ritz_dense) C = {0}, D_y = {0};
    /* with a delay, the output that acts is added by D_yu at each sample */
    RITZ_OWN(ritz_state_space) still = {0};

    if (motion->form == RITZ_FORM_STATES)
        RITZ_CHECK(ritz_dense_copy(&motion->C, &C));
    else
        RITZ_CHECK(ritz_dense_beside(&motion->C, &motion->Cv, &C));
    RITZ_CHECK(ritz_dense_rows(&motion->feed, loop->num_measured,
                               loop->measured, &D_y));
    RITZ_CHECK(ritz_dense_pick(&D_y, loop->num_driven, loop->driven, &s->D_yu));
    if (s->delay == 0)
        return ritz_loop_measured(&C, &motion->feed, c, loop, &s->e);
    RITZ_CHECK(ritz_dense_new(c->A.nrow, c->A.nrow, &still.A));
    RITZ_CHECK(ritz_dense_new(c->C.nrow, c->C.ncol, &still.C));
    RITZ_CHECK(ritz_dense_new(c->D.nrow, c->D.ncol, &still.D));
    return ritz_loop_measured(&C, &motion->feed, &still, loop, &s->e);
}

static ritz_status make_split_room(const ritz_motion *motion,
                                   const ritz_march *plant, split *s)
{
    const int64_t p = motion->B.ncol;

    s->kept = age_of(s, 0) + 1;
    RITZ_CHECK_NEW(s->memory,
                   plant->num_memory + s->states + s->kept * s->driven + 1);
    s->w = s->memory + plant->num_memory;
    s->line = s->w + s->states;
    s->work = s->line + s->kept * s->driven;
    RITZ_CHECK_NEW(s->z, 2 * motion->n + s->states + p);
    RITZ_CHECK_NEW(s->seen, s->measured);
    RITZ_CHECK_NEW(s->next, s->states);
    RITZ_CHECK_NEW(s->u0, p);
    RITZ_CHECK_NEW(s->u1, p);
    return RITZ_OK;
}

static ritz_status fill_split(const ritz_motion *motion,
                              const ritz_controlled *controlled, double step,
                              split *s)
{
    const ritz_loop *loop = controlled->loop;

    s->loop = loop;
    s->sign = loop->positive ? 1.0 : -1.0;
    s->states = controlled->controller->A.nrow;
    s->measured = loop->num_measured;
    s->driven = loop->num_driven;
    RITZ_CHECK(ritz_controlled_counts(controlled, step, &s->period, &s->delay));
    RITZ_CHECK(sample_controller(controlled, step * (double)s->period, s));
    RITZ_CHECK(find_measured(motion, controlled, s));
    return make_split_room(motion, &s->plant, s);
}

ritz_status ritz_split_start(const ritz_motion *motion,
                             const ritz_controlled *controlled,
                             const ritz_integrator *integrator, double step,
                             double rho, ritz_march *out)
{
    RITZ_OWN(ritz_march) march = {.motion = motion, .step = step};
    ritz_march plant = {0};
    split *s = NULL;

    RITZ_CHECK_NEW(s, 1);
    march.own = s;
    march.free = release_split;
    RITZ_CHECK(ritz_march_new(motion, integrator, step, rho, &plant));
    march.x = plant.x;
    march.v = plant.v;
    s->plant = plant;
    RITZ_CHECK(fill_split(motion, controlled, step, s));
    RITZ_CHECK(ritz_loop_notes_new(controlled->controller, motion->energies,
                                   &s->notes));
    s->notes.states = s->w;
    s->notes.work = motion->energies ? s->work : NULL;
    march.memory = s->memory;
    march.num_memory =
        s->plant.num_memory + s->states + s->kept * s->driven + 1;
    march.advance = advance_split;
    march.settle = settle_split;
    march.outputs = output_split;
    march.diagnose = diagnose_split;
    march.num_diagnostics = s->notes.count;
    march.diagnostic = s->notes.list;
    RITZ_MOVE(*out, march);
    return RITZ_OK;
}

int64_t ritz_split_order(const ritz_march *march)
{
    return (march->v ? 2 : 1) * march->motion->n + march->num_memory - 1;
}

/* Copy z into the march, or the march into z. */
static void move_numbers(bool into, ritz_march *march, double *z)
{
    const int64_t n = march->motion->n;
    const struct {
        double *at;
        int64_t count;
    } parts[] = {{march->x, n},
                 {march->v, march->v ? n : 0},
                 {march->memory, march->num_memory - 1}};

    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const size_t size = (size_t)parts[k].count * sizeof *z;

        if (size > 0)
            memcpy(into ? parts[k].at : z, into ? z : parts[k].at, size);
        z += parts[k].count;
    }
}

ritz_status ritz_split_map(ritz_march *march, double *z)
{
    const split *s = march->own;
    RITZ_OWN_ARRAY double *none = NULL;

    RITZ_CHECK_NEW(none, march->motion->B.ncol);
    move_numbers(true, march, z);
    for (march->steps = 0; march->steps < s->period; march->steps++)
        RITZ_CHECK(march->advance(march, none, none));
    move_numbers(false, march, z);
    return RITZ_OK;
}
