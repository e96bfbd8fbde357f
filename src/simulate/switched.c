/*
 * A switched model over time. Let the orthonormal columns of U be the present
 * set in coordinates of the library, and X the modes of U'K U. Then
 *
 *     q = q_0 + U X p,   w = w_0 + U X p',
 *
 *     p'' + X'U'D U X p' + Lambda p = X'U'(B u - K q_0 - D w_0)
 *
 * where q_0 and w_0, with U'q_0 = U'w_0 = 0, are held constant from one switch
 * to the next. They are a constant load, and `modal` propagates p exactly. In
 * the balance of power
 *
 *     d/dt (w'w + q'K q)/2 = p''X'U'B u - p''X'U'D U X p' - p''X'U'D w_0,
 *
 * the march of p accounts for the first two terms and for the work of the
 * constant load, which is the load times the change of p.
 */
#include "simulate/switched.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Values of diagnostics, in their order, and the largest size of R so far. All
   are memory of the march. */
enum {
    VECTORS,
    INDICATOR,
    LEADING,
    VECTOR_STEPS,
    SWITCHES,
    FALLBACKS,
    JUMP_X,
    JUMP_V,
    LOST,
    GAINED,
    NUM_DIAGNOSTICS,
    LARGEST = NUM_DIAGNOSTICS,
    LAST_SWITCH, /* step at which the set changed last */
    LEFT_OUT,    /* largest share of the kinetic energy that a set left out */
    LEFT_OUT_AT, /* step at which that set began */
    MOVING,      /* largest kinetic energy at a switch, doubled */
    NUM_NOTED,
};

static const char *const diagnostics[] = {
    "vectors",
    "indicator",
    "leading vector",
    "vector-steps",
    "switches",
    "fallbacks",
    "jump of displacement",
    "jump of velocity",
    "energy lost at switches",
    "energy gained at switches",
};

typedef struct switching {
    const ritz_library *library;
    const ritz_switched *switched;
    const ritz_simulation_request *request;
    int64_t steps_between, steps_kept; /* in interval and dwell */
    ritz_set_model set;
    ritz_choosing choosing;
    ritz_residue residue;
    double *statistic, *q_0, *w_0, *p, *v; /* parts of memory */
    double *memory;
    double *u0, *u1;      /* inputs and 1 */
    double *ahead;        /* inputs at the end of an interval */
    ritz_dense Ca;        /* outputs x n: outputs of acceleration */
    double *acceleration; /* n */
} switching;

static void release_switching(void *own)
{
    switching *s = own;

    ritz_set_model_free(&s->set);
    ritz_dense_free(&s->choosing.rest);
    ritz_dense_free(&s->Ca);
    RITZ_FREE(s->choosing.next, s->choosing.share, s->residue.x, s->residue.v,
              s->residue.whole, s->memory, s->u0, s->u1, s->ahead,
              s->residue.ahead, s->acceleration, s);
}

static ritz_status finish_set(ritz_march *march, switching *s)
{
    ritz_set_model *set = &s->set;

    RITZ_CHECK(ritz_set_model_load(s->library, s->q_0, s->w_0, set));
    set->motion.form = RITZ_FORM_MODAL;
    set->motion.energies = march->motion->energies;
    RITZ_CHECK(ritz_march_new(&set->motion, &ritz_integrator_modal, march->step,
                              0.0, &set->march));
    memcpy(set->march.x, s->p, (size_t)set->motion.n * sizeof *s->p);
    memcpy(set->march.v, s->v, (size_t)set->motion.n * sizeof *s->v);
    set->made = true;
    return RITZ_OK;
}

/* Set q_0 and w_0 to zero; note the jump, and the change of energy. */
static void project_state(ritz_march *march, switching *s)
{
    const int64_t n = s->library->n;
    const size_t size = (size_t)n * sizeof(double);
    double before[2] = {0.0}, after[2] = {0.0}, change = 0.0;

    s->statistic[JUMP_X] = sqrt(ritz_motion_dot(n, s->q_0, s->q_0));
    s->statistic[JUMP_V] = sqrt(ritz_motion_dot(n, s->w_0, s->w_0));
    ritz_march_energy(march, &before[0], &before[1]);
    for (int64_t k = 0; k < n; k++) {
        march->x[k] -= s->q_0[k];
        march->v[k] -= s->w_0[k];
    }
    memset(s->q_0, 0, size);
    memset(s->w_0, 0, size);
    ritz_march_energy(march, &after[0], &after[1]);
    change = after[0] + after[1] - before[0] - before[1];
    s->statistic[LOST] += fmax(-change, 0.0);
    s->statistic[GAINED] += fmax(change, 0.0);
    march->dissipated -= change;
}

/* Note the largest share of the kinetic energy that a new set leaves out. */
static void note_left_out(const ritz_march *march, switching *s)
{
    const int64_t n = s->library->n;
    const double all = ritz_motion_dot(n, march->v, march->v);
    const double share = ritz_motion_dot(n, s->w_0, s->w_0) / all; /* or nan */

    s->statistic[MOVING] = fmax(s->statistic[MOVING], all);
    if (all <= RITZ_SWITCH_MOVES * s->statistic[MOVING] ||
        share <= s->statistic[LEFT_OUT])
        return;
    s->statistic[LEFT_OUT] = share;
    s->statistic[LEFT_OUT_AT] = (double)march->steps;
}

static int64_t count_present(const switching *s)
{
    int64_t count = 0;

    for (int64_t k = 0; k < s->library->num_vectors; k++)
        count += s->choosing.present[k] != 0.0;
    return count;
}

/* Make the chosen set the present one. */
static ritz_status change_set(ritz_march *march, switching *s)
{
    const ritz_library *library = s->library;

    memcpy(s->choosing.present, s->choosing.next,
           (size_t)library->num_vectors * sizeof(double));
    ritz_set_model_free(&s->set);
    RITZ_CHECK(ritz_set_model_new(s->library, s->choosing.present, &s->set));
    ritz_set_model_hold(&s->set, library->n, march->x, s->q_0, s->p);
    ritz_set_model_hold(&s->set, library->n, march->v, s->w_0, s->v);
    note_left_out(march, s);
    if (s->switched->jump == RITZ_SWITCH_PROJECT)
        project_state(march, s);
    s->statistic[SWITCHES] += 1.0;
    s->statistic[LAST_SWITCH] = (double)march->steps;
    s->statistic[VECTORS] = (double)count_present(s);
    return finish_set(march, s);
}

/* Inputs some steps later. */
static void find_inputs(const ritz_march *march, const switching *s,
                        int64_t steps, double *u)
{
    const ritz_simulation_request *request = s->request;
    const double t = (double)(march->steps + steps) * request->step;

    for (int64_t j = 0; request->signal && j < s->library->B.ncol; j++)
        u[j] = ritz_signal_at(&request->signal[j], t, request->seconds);
}

/* Whether R at the start of a step is more than rounding; if it is not, R with
   the inputs a step later is used. Where inputs are held, these are not the
   inputs at the end of the step. */
static bool find_residue(const ritz_march *march, switching *s,
                         const double *u0)
{
    const double *const u[] = {u0, s->u1};
    const double *ahead = s->switched->look_ahead ? s->ahead : NULL;

    find_inputs(march, s, 1, s->u1);
    find_inputs(march, s, s->steps_between, s->ahead);
    for (int k = 0; k < 2; k++) {
        ritz_residue_find(s->library, march->x, march->v, u[k], ahead,
                          &s->residue);
        s->statistic[LARGEST] = fmax(s->statistic[LARGEST], s->residue.largest);
        if (sqrt(s->residue.square) > RITZ_SUM_ROUNDING * s->statistic[LARGEST])
            return true;
    }
    return false;
}

static ritz_status switch_set(ritz_march *march, switching *s, const double *u0)
{
    ritz_choosing *c = &s->choosing;
    const double since = (double)march->steps - s->statistic[LAST_SWITCH];
    const bool kept = s->set.made && since < (double)s->steps_kept;
    const size_t size = (size_t)s->library->num_vectors * sizeof(double);

    if (!find_residue(march, s, u0))
        return RITZ_OK;
    if (kept) {
        s->statistic[INDICATOR] =
            ritz_present_indicator(s->library, &s->residue, c);
        return RITZ_OK;
    }
    ritz_choose_vectors(s->library, s->switched, &s->residue, c);
    s->statistic[INDICATOR] = c->indicator;
    s->statistic[LEADING] = (double)(c->leading + 1);
    s->statistic[FALLBACKS] += c->fallback ? 1.0 : 0.0;
    if (s->set.made && memcmp(c->next, c->present, size) == 0)
        return RITZ_OK;
    return change_set(march, s);
}

/* Advance the present set by a step, and add its work and dissipation. */
static ritz_status advance_set(ritz_march *march, switching *s)
{
    ritz_set_model *set = &s->set;
    ritz_march *inner = &set->march;
    const int64_t r = set->motion.n, n = s->library->n;
    const double *load = ritz_dense_col(&set->motion.B, s->library->B.ncol);

    inner->work = inner->dissipated = 0.0;
    RITZ_CHECK(inner->advance(inner, s->u0, s->u1));
    inner->steps++;
    march->work += inner->work;
    march->dissipated += inner->dissipated;
    for (int64_t i = 0; i < r; i++) {
        const double moved = inner->x[i] - s->p[i];

        march->work -= load[i] * moved;
        march->dissipated += set->damped_hold[i] * moved;
    }
    memcpy(s->p, inner->x, (size_t)r * sizeof *s->p);
    memcpy(s->v, inner->v, (size_t)r * sizeof *s->v);
    ritz_set_model_expand(set, s->q_0, s->p, n, march->x);
    ritz_set_model_expand(set, s->w_0, s->v, n, march->v);
    s->statistic[VECTOR_STEPS] += (double)r;
    return RITZ_OK;
}

static ritz_status advance_switched(ritz_march *march, const double *u0,
                                    const double *u1)
{
    switching *s = march->own;
    const int64_t m = s->library->B.ncol;

    if (!s->set.made &&
        s->statistic[SWITCHES] > 0.0) { /* the run was continued */
        RITZ_CHECK(
            ritz_set_model_new(s->library, s->choosing.present, &s->set));
        RITZ_CHECK(finish_set(march, s));
    }
    if (march->steps % s->steps_between == 0)
        RITZ_CHECK(switch_set(march, s, u0));
    if (!s->set.made)
        return RITZ_OK; /* R was zero so far: nothing moves */
    for (int64_t j = 0; j < m; j++) {
        s->u0[j] = u0[j];
        s->u1[j] = u1[j];
    }
    return advance_set(march, s);
}

/* Kinetic energy is w'w / 2, as Phi'M Phi = I. */
static void find_energy(const ritz_march *march, double *kinetic,
                        double *potential)
{
    const ritz_motion *m = march->motion;

    *kinetic = 0.5 * ritz_motion_dot(m->n, march->v, march->v);
    *potential = 0.5 * ritz_motion_form(&m->K, march->x);
}

static void diagnose(const ritz_march *march, double *out)
{
    const switching *s = march->own;

    memcpy(out, s->statistic, NUM_DIAGNOSTICS * sizeof *out);
}

/* Accelerations of the present set; q_0 and w_0 are constant. */
static void find_acceleration(const switching *s, const double *u, double *a)
{
    const ritz_set_model *set = &s->set;
    const int64_t r = set->made ? set->motion.n : 0, m = s->library->B.ncol;

    memset(a, 0, (size_t)s->library->n * sizeof *a);
    for (int64_t i = 0; i < r; i++) {
        double sum = ritz_dense_col(&set->motion.B, m)[i] -
                     set->motion.lambda[i] * s->p[i];

        for (int64_t j = 0; j < m; j++)
            sum += ritz_dense_col(&set->motion.B, j)[i] * u[j];
        for (int64_t j = 0; j < r; j++)
            sum -= ritz_dense_col(&set->motion.D, j)[i] * s->v[j];
        if (set->at)
            a[set->at[i]] = sum;
        else
            for (int64_t k = 0; k < set->UX.nrow; k++)
                a[k] += ritz_dense_col(&set->UX, i)[k] * sum;
    }
}

static void find_outputs(const ritz_march *march, const double *u, double *y)
{
    const ritz_motion *m = march->motion;
    switching *s = march->own;

    memset(y, 0, (size_t)m->C.nrow * sizeof *y);
    ritz_motion_gemv(&m->C, 1.0, march->x, y);
    ritz_motion_gemv(&m->Cv, 1.0, march->v, y);
    find_acceleration(s, u, s->acceleration);
    ritz_motion_gemv(&s->Ca, 1.0, s->acceleration, y);
}

/* The library as a motion: its matrices, inputs and outputs. */
static ritz_status fill_motion(const ritz_library *library, const ritz_io *io,
                               ritz_motion *m)
{
    m->form = RITZ_FORM_DENSE;
    m->n = library->n;
    m->original = library->Phi.nrow;
    m->highest = nan("");
    m->energies = true;
    RITZ_CHECK(ritz_dense_copy(&library->K, &m->K));
    RITZ_CHECK(ritz_dense_copy(&library->B, &m->B));
    RITZ_CHECK(ritz_dense_copy(&library->B, &m->push));
    RITZ_CHECK(ritz_dense_copy(&library->MPhi, &m->to));
    RITZ_CHECK(ritz_dense_mul(&io->C, &library->Phi, &m->C));
    RITZ_CHECK(ritz_dense_mul(&io->Cv, &library->Phi, &m->Cv));
    return ritz_dense_new(io->num_outputs, io->num_inputs, &m->feed);
}

/* Allocate the memory of the march, and find its parts. */
static ritz_status make_memory(const ritz_library *library, switching *s,
                               ritz_march *march)
{
    const int64_t parts[] = {NUM_NOTED,  library->num_vectors, library->n,
                             library->n, library->span,        library->span};
    double **const places[] = {
        &s->statistic, &s->choosing.present, &s->q_0, &s->w_0, &s->p, &s->v};
    const size_t count = sizeof parts / sizeof *parts;
    int64_t at = 0;

    for (size_t k = 0; k < count; k++)
        march->num_memory += parts[k];
    RITZ_CHECK_NEW(s->memory, march->num_memory);
    for (size_t k = 0; k < count; at += parts[k++])
        *places[k] = s->memory + at;
    march->memory = s->memory;
    return RITZ_OK;
}

static ritz_status make_room(const ritz_library *library, switching *s)
{
    RITZ_CHECK_NEW(s->choosing.next, library->num_vectors);
    RITZ_CHECK_NEW(s->choosing.share, library->num_vectors);
    if (library->redundant)
        RITZ_CHECK(ritz_dense_copy(&library->vector, &s->choosing.rest));
    RITZ_CHECK_NEW(s->residue.x, library->span);
    RITZ_CHECK_NEW(s->residue.v, library->span);
    RITZ_CHECK_NEW(s->residue.ahead, library->span);
    RITZ_CHECK_NEW(s->ahead, library->B.ncol);
    RITZ_CHECK_NEW(s->residue.whole, library->S_x.nrow);
    RITZ_CHECK_NEW(s->acceleration, library->n);
    RITZ_CHECK_NEW(s->u0, library->B.ncol + 1);
    RITZ_CHECK_NEW(s->u1, library->B.ncol + 1);
    s->u0[library->B.ncol] = s->u1[library->B.ncol] = 1.0;
    return RITZ_OK;
}

/* The largest |value| that a signal has. */
static double largest_value(const ritz_signal *signal)
{
    double largest = 1.0;

    if (signal->kind == RITZ_SIGNAL_ZERO || signal->kind == RITZ_SIGNAL_IMPULSE)
        return 0.0;
    if (signal->kind == RITZ_SIGNAL_TABLE) {
        largest = 0.0;
        for (int64_t k = 0; k < signal->count; k++)
            largest = fmax(largest, fabs(signal->value[k]));
    }
    return largest * fabs(signal->amplitude);
}

/* Bound of the part of R that inputs cause: an R far below it is rounding. */
static double largest_force(const ritz_library *library,
                            const ritz_simulation_request *request)
{
    const int64_t rows = library->S_b.nrow;
    double sum = 0.0;

    for (int64_t j = 0; request->signal && j < library->S_b.ncol; j++) {
        const double *b = ritz_dense_col(&library->S_b, j);

        sum += largest_value(&request->signal[j]) *
               sqrt(ritz_motion_dot(rows, b, b));
    }
    return sum;
}

/* Number of steps in a time, rounded up; if @p exact, it must be whole. */
static ritz_status count_steps(double seconds, double step, bool exact,
                               int64_t *out)
{
    const double ratio = seconds / step;

    RITZ_REFUSE_IF(!(ratio >= 0.0) || ratio > RITZ_MOST_STEPS,
                   RITZ_ERR_ARGUMENT,
                   "%s of %g s is not within 0 and %.0e steps of %g s",
                   exact ? "a switch interval" : "a dwell", seconds,
                   RITZ_MOST_STEPS, step);
    *out = (int64_t)(exact ? round(ratio) : ceil(ratio - RITZ_STEP_ROUNDING));
    RITZ_REFUSE_IF(exact && (*out < 1 || fabs(ratio - (double)*out) >
                                             RITZ_SAME * (double)*out),
                   RITZ_ERR_ARGUMENT,
                   "the switch interval of %g s is not of whole steps of %g s",
                   seconds, step);
    return RITZ_OK;
}

static ritz_status start_march(const ritz_library *library,
                               const ritz_switched *switched,
                               const ritz_simulation_request *request,
                               const ritz_io *io, ritz_march *march)
{
    const ritz_motion *motion = march->motion;
    switching *s = NULL;

    RITZ_CHECK_NEW(march->x, motion->n);
    RITZ_CHECK_NEW(march->v, motion->n);
    RITZ_CHECK_NEW(s, 1);
    march->own = s;
    march->free = release_switching;
    march->step = request->step;
    s->library = library;
    s->switched = switched;
    s->request = request;
    RITZ_CHECK(count_steps(switched->interval, request->step, true,
                           &s->steps_between));
    RITZ_CHECK(
        count_steps(switched->dwell, request->step, false, &s->steps_kept));
    RITZ_CHECK(make_memory(library, s, march));
    RITZ_CHECK(make_room(library, s));
    RITZ_CHECK(ritz_dense_mul(&io->Ca, &library->Phi, &s->Ca));
    s->statistic[LARGEST] = largest_force(library, request);
    march->advance = advance_switched;
    march->outputs = find_outputs;
    march->energy = find_energy;
    march->diagnose = diagnose;
    march->diagnostic = diagnostics;
    march->num_diagnostics = NUM_DIAGNOSTICS;
    return RITZ_OK;
}

static ritz_status check_request(ritz_model subject,
                                 const ritz_switched *switched)
{
    RITZ_REFUSE_IF(subject.kind != RITZ_MODEL_COMPONENT &&
                       subject.kind != RITZ_MODEL_DENSE,
                   RITZ_ERR_ARGUMENT,
                   "a state space has no mass and stiffness to switch vectors "
                   "of");
    RITZ_REFUSE_IF(subject.kind == RITZ_MODEL_COMPONENT && subject.damping &&
                       subject.damping->kind != RITZ_DAMPING_NONE &&
                       !ritz_damping_is_rayleigh(subject.damping),
                   RITZ_ERR_ARGUMENT,
                   "damping ratios of a component need its modes, which are "
                   "not known: give rayleigh damping, or reduce it by 'full' "
                   "first");
    RITZ_REFUSE_IF(!(switched->indicator > 0.0) || !(switched->indicator < 1.0),
                   RITZ_ERR_ARGUMENT,
                   "an indicator is above 0 and below 1, not %g",
                   switched->indicator);
    RITZ_REFUSE_IF(
        !(switched->hysteresis >= 0.0) || !(switched->hysteresis < 1.0),
        RITZ_ERR_ARGUMENT, "a hysteresis is 0 or above, and below 1, not %g",
        switched->hysteresis);
    RITZ_REFUSE_IF(switched->inner == RITZ_SWITCH_EUCLIDEAN &&
                       switched->jump == RITZ_SWITCH_PROJECT,
                   RITZ_ERR_ARGUMENT,
                   "projection is in the inner product of the mass, not "
                   "Euclidean");
    return RITZ_OK;
}

static void fill_report(const ritz_march *march, const ritz_library *library,
                        ritz_switched_report *report)
{
    const switching *s = march->own;

    report->num_switches = (int64_t)s->statistic[SWITCHES];
    report->num_fallbacks = (int64_t)s->statistic[FALLBACKS];
    report->vector_steps = s->statistic[VECTOR_STEPS];
    report->outside = library->outside;
    report->left_out = s->statistic[LEFT_OUT];
    report->left_out_at = s->statistic[LEFT_OUT_AT] * march->step;
}

/* It has the name of the run only: `modal` propagates the sets. */
static const ritz_integrator switched_name = {.name = "switched"};

/* What a run of a switched model takes and yields. */
typedef struct switched_run {
    const ritz_switched *switched;
    ritz_switched_report *found;
} switched_run;

static ritz_status run_switched(ritz_model subject,
                                const ritz_simulation_request *request,
                                const void *context, ritz_simulation *out)
{
    const switched_run *run = context;
    const ritz_switched *switched = run->switched;
    ritz_switched_report *found = run->found;
    ritz_simulation_request asked = *request;
    RITZ_OWN(ritz_motion) full = {0}, motion = {0};
    RITZ_OWN(ritz_library) library = {0};
    RITZ_OWN(ritz_march) march = {.motion = &motion};
    RITZ_OWN(ritz_simulation) s = {0};
    const ritz_io io = ritz_model_io(subject);

    *found = (ritz_switched_report){0};
    for (int64_t k = 0; k < switched->num_libraries; k++)
        found->num_given += switched->library[k].ncol;
    RITZ_CHECK(check_request(subject, switched));
    asked.integrator = &ritz_integrator_trapezoidal; /* full matrices */
    RITZ_CHECK(ritz_motion_full(subject, &asked, &full));
    RITZ_CHECK(ritz_library_new(request, switched, &full, &library));
    found->num_vectors = library.num_vectors;
    RITZ_CHECK_IN("--switched", ritz_library_stable(&library, switched, found));
    RITZ_CHECK(fill_motion(&library, &io, &motion));
    RITZ_CHECK(start_march(&library, switched, request, &io, &march));
    asked.integrator = &switched_name;
    RITZ_CHECK(ritz_march_run(&march, &asked, NULL, &s));
    RITZ_CHECK(ritz_simulation_label(subject, &s));
    fill_report(&march, &library, found);
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

ritz_status ritz_simulate_switched(ritz_model subject,
                                   const ritz_simulation_request *request,
                                   const ritz_switched *switched,
                                   ritz_switched_report *report,
                                   ritz_simulation *out)
{
    ritz_switched_report unwanted = {0};
    const switched_run run = {switched, report ? report : &unwanted};

    return ritz_simulate_coordinates(subject, request, run_switched, &run, out);
}
