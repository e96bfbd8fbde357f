/* Common parts of closed loops in time: checks of a controller with a model and
   a step, the plant in first-order form, and diagnostics of the controller. */
#include "simulate/controlled.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Whether a ratio is a whole number, except for rounding. */
static bool is_whole(double ratio, int64_t *out)
{
    const double whole = round(ratio);

    *out = (int64_t)whole;
    return whole < RITZ_MOST_STEPS &&
           fabs(ratio - whole) <= RITZ_STEP_ROUNDING * fmax(whole, 1.0);
}

ritz_status ritz_controlled_counts(const ritz_controlled *controlled,
                                   double step, int64_t *period, int64_t *delay)
{
    const double sample = controlled->sample > 0.0 ? controlled->sample : step;

    RITZ_REFUSE_IF(
        !is_whole(sample / step, period) || *period < 1, RITZ_ERR_ARGUMENT,
        "a sample every %g s is no multiple of a step of %g s", sample, step);
    RITZ_REFUSE_IF(!is_whole(controlled->delay / step, delay),
                   RITZ_ERR_ARGUMENT,
                   "a delay of %g s is no multiple of a step of %g s",
                   controlled->delay, step);
    return RITZ_OK;
}

ritz_status ritz_controlled_step(const ritz_controlled *controlled, double step,
                                 double *out)
{
    enum { FINEST = 1000, MOST_TRIED = 1000000 };
    const double whole =
        controlled->sample > 0.0 ? controlled->sample : controlled->delay;
    const double first = ceil(whole / step - RITZ_STEP_ROUNDING);
    int64_t late = 0, least = 0, most = 0;

    *out = step;
    if (!(whole > 0.0))
        return RITZ_OK;
    RITZ_REFUSE_IF(!(first < RITZ_MOST_STEPS), RITZ_ERR_ARGUMENT,
                   "%g steps in %g s are too many", first, whole);
    least = first > 1.0 ? (int64_t)first : 1;
    most = least > MOST_TRIED / FINEST ? least + MOST_TRIED : FINEST * least;
    for (int64_t n = least; n <= most; n++) {
        *out = whole / (double)n;
        if (is_whole(controlled->delay / *out, &late))
            return RITZ_OK;
    }
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "no step of at least %g s divides a sample of %g s and a "
                     "delay of %g s",
                     whole / (double)most, controlled->sample,
                     controlled->delay);
}

ritz_status ritz_controlled_check(ritz_model subject,
                                  const ritz_simulation_request *request,
                                  const ritz_controlled *controlled)
{
    const ritz_io plant = ritz_model_io(subject);
    const ritz_io io =
        ritz_model_io(ritz_model_of_states(controlled->controller));
    const bool sampled = controlled->sample > 0.0;

    RITZ_REFUSE_IF(ritz_state_space_is_sparse(controlled->controller),
                   RITZ_ERR_ARGUMENT,
                   "a sparse state space is no controller: reduce it");
    RITZ_REFUSE_IF(
        (controlled->exact || sampled) &&
            request->integrator != &ritz_integrator_modal,
        RITZ_ERR_ARGUMENT,
        "a loop that is propagated exactly needs an exact integrator, modal, "
        "not %s",
        request->integrator->name);
    RITZ_REFUSE_IF(controlled->exact && (sampled || controlled->delay > 0.0),
                   RITZ_ERR_ARGUMENT,
                   "one exponential needs a continuous controller without a "
                   "delay");
    RITZ_REFUSE_IF(controlled->discrete && !sampled, RITZ_ERR_ARGUMENT,
                   "a discrete controller needs the time between two samples");
    RITZ_REFUSE_IF(subject.kind == RITZ_MODEL_STATES && subject.damping &&
                       subject.damping->kind != RITZ_DAMPING_NONE,
                   RITZ_ERR_ARGUMENT, "a state space is damped as it was made");
    return ritz_loop_check(controlled->loop, &plant, &io);
}

/* The matrices -M^-1 K and -M^-1 D of accelerations. */
static ritz_status find_rates(const ritz_motion *m, ritz_dense *K,
                              ritz_dense *D)
{
    if (m->form == RITZ_FORM_MODAL) {
        RITZ_CHECK(ritz_dense_new(m->n, m->n, K));
        for (int64_t k = 0; k < m->n; k++)
            ritz_dense_col(K, k)[k] = m->lambda[k];
        return ritz_dense_copy(&m->D, D);
    }
    RITZ_CHECK(ritz_dense_copy(&m->K, K));
    RITZ_CHECK_IN("M", ritz_general_solve_scaled(&m->M, false, K));
    if (!m->D.val)
        return ritz_dense_new(m->n, m->n, D);
    RITZ_CHECK(ritz_dense_copy(&m->D, D));
    return ritz_context(ritz_general_solve_scaled(&m->M, false, D), "M");
}

/* A = [0 I; -M^-1 K, -M^-1 D], with B, C and D likewise. */
static ritz_status fill_states(const ritz_motion *m, ritz_state_space *out)
{
    const int64_t n = m->n;
    RITZ_OWN(ritz_dense) K = {0}, D = {0};

    if (m->form == RITZ_FORM_STATES) {
        ritz_dense_put(&m->A, 0, 0, &out->A);
        ritz_dense_put(&m->B, 0, 0, &out->B);
        ritz_dense_put(&m->C, 0, 0, &out->C);
        return RITZ_OK;
    }
    RITZ_CHECK(find_rates(m, &K, &D));
    ritz_general_place(-1.0, &K, false, n, 0, &out->A);
    ritz_general_place(-1.0, &D, false, n, n, &out->A);
    for (int64_t k = 0; k < n; k++)
        ritz_dense_col(&out->A, n + k)[k] = 1.0;
    ritz_dense_put(&m->push, n, 0, &out->B);
    ritz_dense_put(&m->C, 0, 0, &out->C);
    ritz_dense_put(&m->Cv, 0, n, &out->C);
    return RITZ_OK;
}

ritz_status ritz_motion_states(const ritz_motion *motion, const ritz_io *io,
                               ritz_state_space *out)
{
    const bool states = motion->form == RITZ_FORM_STATES;
    RITZ_OWN(ritz_state_space) made = {0};

    RITZ_CHECK(
        ritz_state_space_new(states ? motion->n : 2 * motion->n, io, &made));
    RITZ_CHECK(fill_states(motion, &made));
    ritz_dense_put(&motion->feed, 0, 0, &made.D);
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

ritz_status ritz_loop_notes_new(const ritz_state_space *controller, bool work,
                                ritz_loop_notes *out)
{
    const int64_t q = controller->num_outputs;

    out->num_states = controller->A.nrow;
    RITZ_CHECK_NEW(out->name, q + 2);
    RITZ_CHECK_NEW(out->list, q + 2);
    RITZ_CHECK_NEW(out->acting, q);
    for (int64_t j = 0; j < q; j++)
        (void)snprintf(out->name[j], RITZ_NAME_SIZE, "controller-%.50s",
                       controller->output[j]);
    (void)snprintf(out->name[q], RITZ_NAME_SIZE, "controller-states");
    (void)snprintf(out->name[q + 1], RITZ_NAME_SIZE, "controller-work");
    for (int64_t j = 0; j < q + 2; j++)
        out->list[j] = out->name[j];
    out->count = work ? q + 2 : q + 1;
    return RITZ_OK;
}

void ritz_loop_notes_fill(const ritz_loop_notes *notes, double *out)
{
    /* the norm of the states follows the outputs */
    const int64_t q = notes->work ? notes->count - 2 : notes->count - 1;

    memcpy(out, notes->acting, (size_t)q * sizeof *out);
    out[q] =
        sqrt(ritz_motion_dot(notes->num_states, notes->states, notes->states));
    if (notes->work)
        out[q + 1] = *notes->work;
}

void ritz_loop_notes_free(ritz_loop_notes *notes)
{
    free(notes->name);
    free(notes->list);
    RITZ_FREE(notes->acting);
    *notes = (ritz_loop_notes){0};
}
