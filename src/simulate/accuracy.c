/*
 * The step is halved until outputs have the accuracy that is requested.
 *
 * Halving does not improve an output that consists of rounding. Such an output
 * is recognised by its size, relative to the largest value that the motion
 * could give it; or by a difference that is small relative to that value and
 * does not decrease, although a method of second order divides it by four.
 */
#include <ritz/simulate.h>

#include "base/alloc.h"
#include "base/tolerances.h"
#include "simulate/motion.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* Largest numbers of steps, and of values at all of them: 2 GiB. */
static const int64_t most_steps = INT64_C(1) << 23;
static const int64_t most_values = INT64_C(1) << 28;

enum { STEPS = 50, PER_PERIOD = 10, IN_VAIN = 3 };

typedef struct halving_trial {
    int64_t num_outputs;
    double *before; /* difference at twice the step */
    int *in_vain;   /* halvings in a row that did not halve it */
    ritz_accuracy found;
} halving_trial;

static void halving_trial_free(halving_trial *t)
{
    RITZ_FREE(t->before, t->in_vain);
}

/* Whether the difference of two runs is rounding of what the output could
   be. */
static bool is_rounding(double size, double off, double shown, int in_vain)
{
    return size <= RITZ_SUM_ROUNDING * shown ||
           (in_vain >= IN_VAIN && off <= RITZ_ROUNDING_GROWN * shown);
}

static void judge_outputs(const ritz_simulation *exact,
                          const ritz_simulation *made, const ritz_reach *reach,
                          double tolerance, halving_trial *t)
{
    t->found = (ritz_accuracy){.left = -1};
    for (int64_t i = 0; i < t->num_outputs; i++) {
        double size = 0.0, off = 0.0;
        double shown = reach->size[i];

        ritz_simulation_compare(exact, made, i, &size, &off);
        t->in_vain[i] = off > 0.5 * t->before[i] ? t->in_vain[i] + 1 : 0;
        t->before[i] = off;
        if (!(size > 0.0))
            continue;
        if (off <= tolerance * size ||
            !is_rounding(size, off, shown, t->in_vain[i])) {
            t->found.error = fmax(t->found.error, off / size);
            continue;
        }
        if (t->found.num_left++ == 0 || off > t->found.rounding * shown) {
            t->found.left = i;
            t->found.rounding = off / shown;
        }
    }
}

/* Differences at a step, from `modal` (or itself) at half of it. */
static ritz_status measure_errors(ritz_model subject,
                                  const ritz_simulation_request *request,
                                  double tolerance, halving_trial *t)
{
    ritz_simulation_request coarse = *request, fine = *request;
    RITZ_OWN(ritz_simulation) made = {0}, exact = {0};
    RITZ_OWN(ritz_reach) reach = {0};

    coarse.every = 1;
    coarse.from = fine.from = NULL;
    fine.step = 0.5 * request->step;
    fine.every = 2;
    if (subject.kind != RITZ_MODEL_COMPONENT)
        fine.integrator = &ritz_integrator_modal;
    RITZ_CHECK(ritz_simulate_noting(subject, &coarse, false, NULL, &made));
    RITZ_CHECK(ritz_simulate_noting(subject, &fine, false, &reach, &exact));
    RITZ_REFUSE_IF(made.num_state > 0 || exact.num_state > 0,
                   RITZ_ERR_CONVERGENCE,
                   "interrupted while the step was chosen: with --step what a "
                   "run has done is kept");
    judge_outputs(&exact, &made, &reach, tolerance, t);
    return RITZ_OK;
}

/* Not at multiples of a period, where a sine is 0. */
static double first_step(const ritz_simulation_request *request,
                         int64_t num_inputs)
{
    double step = request->seconds / STEPS;

    for (int64_t j = 0; request->signal && j < num_inputs; j++) {
        const ritz_signal *s = &request->signal[j];
        double hertz = s->kind == RITZ_SIGNAL_SINE ? s->hertz[0]
                       : s->kind == RITZ_SIGNAL_CHIRP
                           ? fmax(s->hertz[0], s->hertz[1])
                           : 0.0;

        if (hertz * PER_PERIOD * step > 1.0)
            step = 1.0 / (hertz * PER_PERIOD);
    }
    return request->step > 0.0 ? request->step : step;
}

/* @p last is what kept the last step from being taken, if anything did. */
static ritz_status refuse_steps(const ritz_simulation_request *request,
                                int64_t most, const ritz_accuracy *found,
                                double tolerance, ritz_status last)
{
    char what[64];

    (void)snprintf(what, sizeof what,
                   "more than %" PRId64 " steps are not tried", most);
    if (last != RITZ_OK)
        return ritz_context(last, what);
    if (!isfinite(found->error))
        return ritz_fail(RITZ_ERR_CONVERGENCE, "%s, and inputs need %.2g", what,
                         request->seconds / request->step);
    return ritz_fail(RITZ_ERR_CONVERGENCE,
                     "'%s' errs by %.2g at a step of %.3g s, %g was asked, "
                     "and %s",
                     request->integrator->name, found->error,
                     2.0 * request->step, tolerance, what);
}

ritz_status ritz_simulate_accurate(ritz_model subject,
                                   const ritz_simulation_request *request,
                                   double tolerance, ritz_accuracy *reached,
                                   ritz_simulation *out)
{
    ritz_status status = RITZ_OK;
    ritz_simulation_request asked = *request;
    int64_t most = 0, steps = 0;
    ritz_io io = {0}; /* borrowed */
    RITZ_OWN(halving_trial) t = {.found.error = HUGE_VAL};

    RITZ_REFUSE_IF(!(tolerance > 0.0), RITZ_ERR_ARGUMENT, "%g is no accuracy",
                   tolerance);
    if (subject.kind != 0)
        io = ritz_model_io(subject);
    asked.step = first_step(request, io.num_inputs);
    most = most_values / (io.num_inputs + io.num_outputs + 1);
    most = most < most_steps ? most : most_steps;
    RITZ_CHECK(ritz_request_steps(&asked, &steps));
    t.num_outputs = io.num_outputs;
    RITZ_CHECK_NEW(t.before, t.num_outputs);
    RITZ_CHECK_NEW(t.in_vain, t.num_outputs);
    for (int64_t i = 0; i < t.num_outputs; i++)
        t.before[i] = HUGE_VAL;
    while (true) {
        if (asked.seconds / asked.step > (double)most)
            return refuse_steps(&asked, most, &t.found, tolerance, status);
        status = measure_errors(subject, &asked, tolerance, &t);
        if (status == RITZ_OK && t.found.error <= tolerance)
            break;
        /* an explicit integrator may refuse what is too coarse */
        if (status != RITZ_OK &&
            (status != RITZ_ERR_ARGUMENT || !asked.integrator->is_explicit))
            return status;
        asked.step *= 0.5;
    }
    RITZ_CHECK(ritz_simulate(subject, &asked, out));
    if (reached)
        *reached = t.found;
    return RITZ_OK;
}
