/* What is asked of a simulation, and what comes of it. */
#include <ritz/simulate.h>

#include "base/alloc.h"
#include "simulate/run.h"

#include <ritz/text.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

const ritz_integrator *ritz_integrator_find(const char *name)
{
    return ritz_row_find(ritz_integrators, "integrator", name);
}

static ritz_status check(const ritz_simulated *subject,
                         const ritz_simulation_request *request)
{
    int64_t steps = 0;

    RITZ_REFUSE_IF((subject->model != NULL) + (subject->component != NULL) +
                           (subject->states != NULL) !=
                       1,
                   RITZ_ERR_ARGUMENT, "there is not one thing to simulate");
    RITZ_CHECK(ritz_request_steps(request, &steps));
    RITZ_REFUSE_IF(subject->states && subject->damping &&
                       subject->damping->kind != RITZ_DAMPING_NONE,
                   RITZ_ERR_ARGUMENT, "a state space is damped as it was made");
    return RITZ_OK;
}

static void take_names(const ritz_simulated *subject, ritz_simulation *s)
{
    const ritz_io *io = subject->model       ? subject->model->io
                        : subject->component ? &subject->component->io
                                             : NULL;
    const char(*input)[RITZ_NAME_SIZE] =
        io ? (const char(*)[RITZ_NAME_SIZE])io->input
           : (const char(*)[RITZ_NAME_SIZE])subject->states->input;
    const char(*output)[RITZ_NAME_SIZE] =
        io ? (const char(*)[RITZ_NAME_SIZE])io->output
           : (const char(*)[RITZ_NAME_SIZE])subject->states->output;

    if (s->num_inputs > 0)
        memcpy(s->input, input, (size_t)s->num_inputs * RITZ_NAME_SIZE);
    if (s->num_outputs > 0)
        memcpy(s->output, output, (size_t)s->num_outputs * RITZ_NAME_SIZE);
}

ritz_status ritz_simulate_noting(const ritz_simulated *subject,
                                 const ritz_simulation_request *request,
                                 bool energies, ritz_reach *reach,
                                 ritz_simulation *out)
{
    ritz_status status = RITZ_OK;
    ritz_motion motion = {0};
    ritz_reach found = {0};

    RITZ_TRY(check(subject, request));
    RITZ_TRY(ritz_motion_new(subject, request, &motion));
    motion.energies = energies && motion.form != RITZ_FORM_STATES;
    if (reach)
        RITZ_TRY(ritz_reach_new(subject, &motion, &found));
    RITZ_TRY(ritz_run(&motion, request, reach ? &found : NULL, out));
    take_names(subject, out);
    if (subject->damping)
        ritz_damping_print(subject->damping, out->damping);
    else if (subject->states)
        memcpy(out->damping, subject->states->damping, sizeof out->damping);
    if (reach)
        *reach = found;
    found = (ritz_reach){0};
done:
    ritz_motion_free(&motion);
    ritz_reach_free(&found);
    return status;
}

ritz_status ritz_simulate(const ritz_simulated *subject,
                          const ritz_simulation_request *request,
                          ritz_simulation *out)
{
    return ritz_simulate_noting(subject, request, true, NULL, out);
}

ritz_status ritz_simulation_difference(const ritz_simulation *exact,
                                       const ritz_simulation *other,
                                       double *out)
{
    int64_t p = exact->num_outputs;
    double worst = 0.0;

    RITZ_REFUSE_IF(exact->count != other->count || p != other->num_outputs,
                   RITZ_ERR_ARGUMENT, "two simulations do not fit each other");
    for (int64_t k = 0; k < exact->count; k++)
        RITZ_REFUSE_IF(fabs(exact->seconds[k] - other->seconds[k]) >
                           1e-9 * exact->seconds[exact->count - 1],
                       RITZ_ERR_ARGUMENT,
                       "two simulations have different times");
    for (int64_t i = 0; i < p; i++) {
        double size = 0.0, off = 0.0;

        for (int64_t k = 0; k < exact->count; k++) {
            double y = exact->y[k * p + i];

            size = fmax(size, fabs(y));
            off = fmax(off, fabs(other->y[k * p + i] - y));
        }
        if (size > 0.0)
            worst = fmax(worst, off / size);
    }
    *out = worst;
    return RITZ_OK;
}
