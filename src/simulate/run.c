/* A simulation: the request, the loop over time, and what it yields. */
#include "simulate/motion.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/base.h>
#include <ritz/simulate.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A file of more values than this is refused. */
static const int64_t most_values = INT64_C(1) << 31;

ritz_status ritz_request_steps(const ritz_simulation_request *request,
                               int64_t *out)
{
    double steps = request->seconds / request->step;

    RITZ_REFUSE_IF(!isfinite(request->seconds) || request->seconds <= 0.0,
                   RITZ_ERR_ARGUMENT, "there are no %g seconds to simulate",
                   request->seconds);
    RITZ_REFUSE_IF(!isfinite(request->step) || request->step <= 0.0,
                   RITZ_ERR_ARGUMENT, "%g s is no step", request->step);
    RITZ_REFUSE_IF(steps > RITZ_MOST_STEPS, RITZ_ERR_ARGUMENT,
                   "%g steps are too many", steps);
    *out = (int64_t)ceil(steps - RITZ_STEP_ROUNDING);
    if (*out < 1)
        *out = 1;
    return RITZ_OK;
}

static ritz_status make_room(const ritz_march *march,
                             const ritz_simulation_request *request,
                             int64_t steps, ritz_simulation *s)
{
    const ritz_motion *motion = march->motion;
    int64_t every = request->every > 0 ? request->every : 1;
    int64_t values = 0;

    s->num_inputs = motion->feed.ncol;
    s->num_outputs = motion->feed.nrow;
    s->count = steps / every + 1;
    s->step = request->step;
    s->order = motion->n;
    s->num_diagnostics = march->num_diagnostics;
    values = s->num_inputs + s->num_outputs + s->num_diagnostics + 8;
    RITZ_REFUSE_IF(s->count > most_values / values, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " times are too many to write: give --every",
                   s->count);
    RITZ_CHECK_NEW(s->seconds, s->count);
    RITZ_CHECK_NEW(s->u, s->count * s->num_inputs);
    RITZ_CHECK_NEW(s->y, s->count * s->num_outputs);
    RITZ_CHECK_NEW(s->diagnostic, s->num_diagnostics);
    RITZ_CHECK_NEW(s->diagnosis, s->count * s->num_diagnostics);
    for (int64_t j = 0; j < s->num_diagnostics; j++)
        (void)snprintf(s->diagnostic[j], RITZ_NAME_SIZE, "%s",
                       march->diagnostic[j]);
    if (motion->form != RITZ_FORM_STATES && motion->energies) {
        RITZ_CHECK_NEW(s->kinetic, s->count);
        RITZ_CHECK_NEW(s->potential, s->count);
        RITZ_CHECK_NEW(s->dissipated, s->count);
        RITZ_CHECK_NEW(s->work, s->count);
        RITZ_CHECK_NEW(s->balance, s->count);
    }
    (void)snprintf(s->integrator, sizeof s->integrator, "%s",
                   request->integrator->name);
    (void)snprintf(s->hold, sizeof s->hold, "%s",
                   request->hold == RITZ_HOLD_ZERO ? "zero" : "first");
    return RITZ_OK;
}

static void inputs_at(const ritz_simulation_request *request, int64_t step,
                      int64_t count, double *u)
{
    for (int64_t j = 0; j < count; j++)
        u[j] = request->signal ? ritz_signal_at(&request->signal[j],
                                                (double)step * request->step,
                                                request->seconds)
                               : 0.0;
}

/* out = to'from, or from. */
static void transform_start(const ritz_motion *motion, const double *from,
                            double *out)
{
    if (!from)
        return;
    if (!motion->to.val) {
        memcpy(out, from, (size_t)motion->n * sizeof *out);
        return;
    }
    for (int64_t k = 0; k < motion->n; k++)
        out[k] = ritz_motion_dot(motion->original,
                                 ritz_dense_col(&motion->to, k), from);
}

/*
 * Dofs without mass in equilibrium: K_nn dx_n = (B u - K x)_n, as K with all
 * other rows and columns those of the identity.
 */
static ritz_status balance_massless(const ritz_motion *motion, const double *u,
                                    double *x)
{
    int64_t count = 0;
    RITZ_OWN_ARRAY int64_t *row = NULL;
    RITZ_OWN_ARRAY double *r = NULL;
    RITZ_OWN(ritz_sparse) K = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_dense) part = {0};

    RITZ_CHECK_NEW(row, motion->n);
    RITZ_CHECK_NEW(r, motion->n);
    for (int64_t k = 0; motion->massless && k < motion->n; k++)
        if (motion->massless[k])
            row[count++] = k;
    if (count == 0)
        return RITZ_OK;
    ritz_motion_gemv(&motion->B, 1.0, u, r);
    ritz_motion_add(motion, RITZ_STIFFNESS, -1.0, x, r);
    RITZ_CHECK(ritz_sparse_extract(&motion->sK, count, row, count, row, &K));
    RITZ_CHECK_IN("dofs without mass", ritz_factor_spd(&K, &F));
    RITZ_CHECK(ritz_dense_new(count, 1, &part));
    for (int64_t k = 0; k < count; k++)
        part.val[k] = r[row[k]];
    RITZ_CHECK(ritz_factor_solve(F, &part));
    for (int64_t k = 0; k < count; k++)
        x[row[k]] += part.val[k];
    return RITZ_OK;
}

/* Impulses: a jump of x' (of x of states), and the work it takes. */
static void push_impulses(const ritz_motion *motion,
                          const ritz_simulation_request *request,
                          ritz_march *march)
{
    double *moved = march->v ? march->v : march->x;
    double before = 0.0, after = 0.0, potential = 0.0;

    ritz_march_energy(march, &before, &potential);
    for (int64_t j = 0; request->signal && j < motion->push.ncol; j++) {
        const double *jump = ritz_dense_col(&motion->push, j);
        const ritz_signal *signal = &request->signal[j];

        for (int64_t k = 0;
             signal->kind == RITZ_SIGNAL_IMPULSE && k < motion->n; k++)
            moved[k] += signal->amplitude * jump[k];
    }
    ritz_march_energy(march, &after, &potential);
    march->work += after - before;
}

static void note_energy(const ritz_march *march, double start, int64_t k,
                        const double *u, ritz_simulation *s)
{
    for (int64_t j = 0; j < s->num_inputs; j++)
        s->u[k * s->num_inputs + j] = u[j];
    ritz_march_outputs(march, u, s->y + k * s->num_outputs);
    if (march->diagnose)
        march->diagnose(march, s->diagnosis + k * s->num_diagnostics);
    if (!s->balance)
        return;
    ritz_march_energy(march, &s->kinetic[k], &s->potential[k]);
    s->energy_rounding =
        fmax(s->energy_rounding, ritz_march_energy_rounding(march));
    s->dissipated[k] = march->dissipated;
    s->work[k] = march->work;
    s->balance[k] = s->kinetic[k] + s->potential[k] + march->dissipated -
                    march->work - start;
}

static bool is_finite(const ritz_march *march)
{
    double sum = 0.0;

    for (int64_t k = 0; k < march->motion->n; k++)
        sum += march->v ? march->v[k] + march->x[k] : march->x[k];
    return isfinite(sum);
}

/* Before the first step; what energy there is before impulses act. */
static ritz_status begin_run(const ritz_simulation_request *request,
                             const double *u, ritz_march *march, double *energy)
{
    const ritz_motion *motion = march->motion;
    double kinetic = 0.0, potential = 0.0;

    transform_start(motion, request->x0, march->x);
    if (march->v)
        transform_start(motion, request->v0, march->v);
    RITZ_CHECK(balance_massless(motion, u, march->x));
    ritz_march_energy(march, &kinetic, &potential);
    *energy = kinetic + potential;
    push_impulses(motion, request, march);
    if (march->settle)
        RITZ_CHECK(march->settle(march, u));
    return RITZ_OK;
}

/* Runs that end early, and are continued. Their state: steps taken, the energy
   at the start, what was dissipated, work, x, v and the memory of the
   integrator. */
enum { SUMS = 4 };

static int64_t count_state(const ritz_march *march)
{
    const int64_t n = march->motion->n;

    return SUMS + n + (march->v ? n : 0) + march->num_memory;
}

/* Copy the state to @p state, or back from it. */
static void move_state(bool back, ritz_march *march, double *energy,
                       double *state)
{
    const int64_t n = march->motion->n;
    double steps = (double)march->steps;
    const struct {
        double *at;
        int64_t count;
    } parts[] = {{&steps, 1},
                 {energy, 1},
                 {&march->dissipated, 1},
                 {&march->work, 1},
                 {march->x, n},
                 {march->v, march->v ? n : 0},
                 {march->memory, march->num_memory}};

    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const size_t size = (size_t)parts[k].count * sizeof(double);

        if (size > 0 && back)
            memcpy(parts[k].at, state, size);
        else if (size > 0)
            memcpy(state, parts[k].at, size);
        state += parts[k].count;
    }
    march->steps = (int64_t)steps;
}

/* The run ends here: `count` times are filled. */
static ritz_status end_early(ritz_march *march, double energy, int64_t count,
                             ritz_simulation *s)
{
    s->count = count;
    s->num_state = count_state(march);
    RITZ_CHECK_NEW(s->state, s->num_state);
    move_state(false, march, &energy, s->state);
    return RITZ_OK;
}

/* memcpy that takes NULL for no values, as containers have it. */
static void copy_values(double *to, const double *from, int64_t count)
{
    if (count > 0)
        memcpy(to, from, (size_t)count * sizeof *to);
}

/* Copy outputs at time k, followed by coordinates and their rates. */
static void copy_outputs(const ritz_simulation *from, int64_t k,
                         ritz_simulation *s)
{
    const int64_t n = from->num_coordinates;
    const double *const parts[] = {from->q, from->v, from->a};
    double *y = s->y + k * s->num_outputs;

    copy_values(y, from->y + k * from->num_outputs, from->num_outputs);
    y += from->num_outputs;
    for (int j = 0; n > 0 && j < 3; j++, y += n)
        copy_values(y, parts[j] + k * n, n);
}

/* Copy all that an earlier run has stored. */
static void copy_times(const ritz_simulation *from, ritz_simulation *s)
{
    const double *const energies[] = {from->kinetic, from->potential,
                                      from->dissipated, from->work,
                                      from->balance};
    double *const into[] = {s->kinetic, s->potential, s->dissipated, s->work,
                            s->balance};

    s->energy_rounding = from->energy_rounding;
    copy_values(s->seconds, from->seconds, from->count);
    copy_values(s->u, from->u, from->count * s->num_inputs);
    copy_values(s->diagnosis, from->diagnosis,
                from->count * s->num_diagnostics);
    for (int64_t k = 0; k < from->count; k++)
        copy_outputs(from, k, s);
    for (int e = 0; s->balance && e < 5; e++)
        copy_values(into[e], energies[e], from->count);
}

/* Whether a run that ended early belongs to this march and request. */
static bool is_same_run(const ritz_march *march,
                        const ritz_simulation_request *request, int64_t steps,
                        const ritz_simulation *from, const ritz_simulation *s)
{
    const int64_t every = request->every > 0 ? request->every : 1;
    const double taken = from->num_state > 0 ? from->state[0] : -1.0;

    return from->num_state == count_state(march) && from->step == s->step &&
           from->num_inputs == s->num_inputs &&
           from->num_outputs + 3 * from->num_coordinates == s->num_outputs &&
           from->num_diagnostics == s->num_diagnostics &&
           (from->balance != NULL) == (s->balance != NULL) &&
           strcmp(from->integrator, s->integrator) == 0 &&
           strcmp(from->hold, s->hold) == 0 && taken >= 0.0 &&
           taken <= (double)steps && from->count == (int64_t)taken / every + 1;
}

static ritz_status resume_run(const ritz_simulation_request *request,
                              int64_t steps, ritz_march *march, double *energy,
                              ritz_simulation *s)
{
    const ritz_simulation *from = request->from;

    RITZ_REFUSE_IF(!is_same_run(march, request, steps, from, s),
                   RITZ_ERR_ARGUMENT,
                   "the run that is to be continued has another model, step, "
                   "integrator or outputs");
    copy_times(from, s);
    move_state(true, march, energy, from->state);
    return RITZ_OK;
}

/* Store values of the present time, and refuse a motion that diverges. */
static ritz_status store_time(const ritz_simulation_request *request,
                              const ritz_march *march, double energy,
                              const double *u, ritz_reach *reach,
                              ritz_simulation *s)
{
    const int64_t every = request->every > 0 ? request->every : 1;
    const int64_t k = march->steps / every;
    const double t = (double)march->steps * request->step;

    RITZ_REFUSE_IF(march->steps > 0 && !is_finite(march), RITZ_ERR_CONVERGENCE,
                   "the motion has left all bounds after %g s: is the model "
                   "stable?",
                   t);
    s->seconds[k] = t;
    note_energy(march, energy, k, u, s);
    if (reach)
        ritz_reach_note(reach, march, t);
    return RITZ_OK;
}

/* Run from the present time to the end. */
static ritz_status take_steps(ritz_march *march,
                              const ritz_simulation_request *request,
                              int64_t steps, double energy, ritz_reach *reach,
                              ritz_simulation *s)
{
    const int64_t every = request->every > 0 ? request->every : 1;
    RITZ_OWN_ARRAY double *u0 = NULL, *u1 = NULL;

    RITZ_CHECK_NEW(u0, s->num_inputs);
    RITZ_CHECK_NEW(u1, s->num_inputs);
    inputs_at(request, march->steps, s->num_inputs, u1);
    while (march->steps < steps) {
        if (request->stop && request->stop(request->context))
            return end_early(march, energy, march->steps / every + 1, s);
        memcpy(u0, u1, (size_t)s->num_inputs * sizeof *u0);
        inputs_at(request, march->steps + 1, s->num_inputs, u1);
        RITZ_CHECK(march->advance(march, u0,
                                  request->hold == RITZ_HOLD_ZERO ? u0 : u1));
        march->steps++;
        ritz_monitor_step("simulation", march->steps, steps);
        if (march->steps % every == 0)
            RITZ_CHECK(store_time(request, march, energy, u1, reach, s));
    }
    return RITZ_OK;
}

ritz_status ritz_march_run(ritz_march *march,
                           const ritz_simulation_request *request,
                           ritz_reach *reach, ritz_simulation *s)
{
    RITZ_OWN_ARRAY double *u = NULL;
    int64_t steps = 0;
    double energy = 0.0;

    RITZ_CHECK(ritz_request_steps(request, &steps));
    RITZ_CHECK(make_room(march, request, steps, s));
    if (request->from) {
        RITZ_CHECK(resume_run(request, steps, march, &energy, s));
    } else {
        RITZ_CHECK_NEW(u, s->num_inputs);
        inputs_at(request, 0, s->num_inputs, u);
        RITZ_CHECK(begin_run(request, u, march, &energy));
        RITZ_CHECK(store_time(request, march, energy, u, reach, s));
    }
    return take_steps(march, request, steps, energy, reach, s);
}

ritz_status ritz_simulation_label(ritz_model subject, ritz_simulation *s)
{
    const ritz_io io = ritz_model_io(subject);

    RITZ_CHECK_COPY(s->input, io.input, s->num_inputs);
    RITZ_CHECK_COPY(s->output, io.output, s->num_outputs);
    if (subject.damping)
        ritz_damping_print(subject.damping, s->damping);
    else if (subject.kind == RITZ_MODEL_STATES)
        memcpy(s->damping, subject.states->damping, sizeof s->damping);
    return RITZ_OK;
}

ritz_status ritz_simulate_noting(ritz_model subject,
                                 const ritz_simulation_request *request,
                                 bool energies, ritz_reach *reach,
                                 ritz_simulation *out)
{
    RITZ_OWN(ritz_motion) motion = {0};
    RITZ_OWN(ritz_march) march = {0};
    RITZ_OWN(ritz_reach) found = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    int64_t steps = 0;

    RITZ_REFUSE_IF(subject.kind == 0, RITZ_ERR_ARGUMENT,
                   "there is not one thing to simulate");
    RITZ_CHECK(ritz_request_steps(request, &steps));
    RITZ_REFUSE_IF(subject.kind == RITZ_MODEL_STATES && subject.damping &&
                       subject.damping->kind != RITZ_DAMPING_NONE,
                   RITZ_ERR_ARGUMENT, "a state space is damped as it was made");
    RITZ_CHECK(ritz_motion_new(subject, request, &motion));
    motion.energies = energies && motion.form != RITZ_FORM_STATES;
    if (reach)
        RITZ_CHECK(ritz_reach_new(subject, &motion, &found));
    RITZ_CHECK(ritz_march_new(&motion, request->integrator, request->step,
                              request->rho, &march));
    RITZ_CHECK(ritz_march_run(&march, request, reach ? &found : NULL, &s));
    RITZ_CHECK(ritz_simulation_label(subject, &s));
    RITZ_MOVE(*out, s);
    if (reach)
        RITZ_MOVE(*reach, found);
    return RITZ_OK;
}

void ritz_simulation_compare(const ritz_simulation *exact,
                             const ritz_simulation *other, int64_t output,
                             double *size, double *difference)
{
    *size = *difference = 0.0;
    for (int64_t k = 0; k < exact->count; k++) {
        int64_t at = k * exact->num_outputs + output;

        *size = fmax(*size, fabs(exact->y[at]));
        *difference = fmax(*difference, fabs(other->y[at] - exact->y[at]));
    }
}

ritz_status ritz_simulation_difference(const ritz_simulation *exact,
                                       const ritz_simulation *other,
                                       double *out)
{
    double worst = 0.0, size = 0.0, off = 0.0;

    RITZ_REFUSE_IF(exact->count != other->count ||
                       exact->num_outputs != other->num_outputs,
                   RITZ_ERR_ARGUMENT, "two simulations do not fit each other");
    for (int64_t k = 0; k < exact->count; k++)
        RITZ_REFUSE_IF(fabs(exact->seconds[k] - other->seconds[k]) >
                           RITZ_SAME * exact->seconds[exact->count - 1],
                       RITZ_ERR_ARGUMENT,
                       "two simulations have different times");
    for (int64_t i = 0; i < exact->num_outputs; i++) {
        ritz_simulation_compare(exact, other, i, &size, &off);
        if (size > 0.0)
            worst = fmax(worst, off / size);
    }
    *out = worst;
    return RITZ_OK;
}
