/* Runs of closed loops, by the march of split or sampled loops or by that of
   exact ones. */
#include "simulate/controlled.h"

#include "base/alloc.h"

#include <stdio.h>
#include <string.h>

static ritz_status start_march(ritz_model subject, const ritz_motion *motion,
                               const ritz_simulation_request *request,
                               const ritz_controlled *controlled,
                               ritz_march *out)
{
    const ritz_io io = ritz_model_io(subject);
    RITZ_OWN(ritz_state_space) plant = {0};

    if (!controlled->exact)
        return ritz_split_start(motion, controlled, request->integrator,
                                request->step, request->rho, out);
    RITZ_CHECK(ritz_motion_states(motion, &io, &plant));
    return ritz_exact_start(motion, &plant, controlled, request->step, out);
}

/* An impulse that reaches a measured output by feedthrough is an impulse there,
   which has no value at a sample. */
static ritz_status check_impulses(ritz_model subject, const ritz_motion *motion,
                                  const ritz_simulation_request *request,
                                  const ritz_loop *loop)
{
    const ritz_io io = ritz_model_io(subject);

    for (int64_t j = 0; request->signal && j < motion->feed.ncol; j++)
        for (int64_t k = 0; request->signal[j].kind == RITZ_SIGNAL_IMPULSE &&
                            k < loop->num_measured;
             k++)
            RITZ_REFUSE_IF(
                ritz_dense_col(&motion->feed, j)[loop->measured[k]] != 0.0,
                RITZ_ERR_ARGUMENT,
                "an impulse of '%s' is one in '%s' too, which the controller "
                "measures",
                io.input[j], io.output[loop->measured[k]]);
    return RITZ_OK;
}

/* "modal, split" */
static void name_run(const ritz_controlled *controlled,
                     const ritz_integrator *integrator, size_t size, char *out)
{
    (void)snprintf(out, size, "%s, %s", integrator->name,
                   controlled->exact          ? "closed loop"
                   : controlled->sample > 0.0 ? "sampled controller"
                                              : "split");
}

static ritz_status run_controlled(ritz_model subject,
                                  const ritz_simulation_request *request,
                                  const void *context, ritz_simulation *out)
{
    const ritz_controlled *controlled = context;
    ritz_simulation_request asked = *request;
    ritz_integrator named = *request->integrator;
    char name[RITZ_NAME_SIZE];
    int64_t steps = 0;
    RITZ_OWN(ritz_motion) motion = {0};
    RITZ_OWN(ritz_march) march = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    RITZ_CHECK(ritz_request_steps(request, &steps));
    RITZ_CHECK(ritz_controlled_check(subject, request, controlled));
    RITZ_CHECK(ritz_motion_new(subject, request, &motion));
    RITZ_CHECK(check_impulses(subject, &motion, request, controlled->loop));
    motion.energies = motion.form != RITZ_FORM_STATES;
    motion.any_step = controlled->any_step;
    RITZ_CHECK(start_march(subject, &motion, request, controlled, &march));
    name_run(controlled, request->integrator, sizeof name, name);
    named.name = name;
    asked.integrator = &named;
    RITZ_CHECK(ritz_march_run(&march, &asked, NULL, &s));
    RITZ_CHECK(ritz_simulation_label(subject, &s));
    s.order += controlled->controller->A.nrow;
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

ritz_status ritz_controlled_step_cost(ritz_model subject,
                                      const ritz_simulation_request *request,
                                      const ritz_controlled *controlled,
                                      double *out)
{
    RITZ_OWN(ritz_motion) motion = {0};
    RITZ_OWN(ritz_march) march = {0};
    RITZ_OWN_ARRAY double *u = NULL;

    RITZ_CHECK(ritz_controlled_check(subject, request, controlled));
    RITZ_CHECK(ritz_motion_new(subject, request, &motion));
    motion.energies = motion.form != RITZ_FORM_STATES;
    motion.any_step = true;
    RITZ_CHECK_NEW(u, motion.B.ncol);
    RITZ_CHECK(start_march(subject, &motion, request, controlled, &march));
    return ritz_march_cost(&march, u, out);
}

ritz_status ritz_simulate_controlled(ritz_model subject,
                                     const ritz_simulation_request *request,
                                     const ritz_controlled *controlled,
                                     const ritz_loop_stability *stability,
                                     ritz_simulation *out)
{
    ritz_loop_stability own = {0};

    if (!stability) {
        RITZ_CHECK(ritz_controlled_examine(subject, request, controlled, &own));
        RITZ_CHECK(ritz_controlled_refuse(request, controlled, &own));
    }
    return ritz_simulate_coordinates(subject, request, run_controlled,
                                     controlled, out);
}
