/*
 * The trapezoidal rule, which in second order is Newmark's with gamma = 1/2,
 * beta = 1/4, the average acceleration: unconditionally stable, and what it
 * takes from energy is what D takes. Periods come out longer by (w h)^2 / 12.
 */
#include "simulate/motion.h"

static ritz_status start_trapezoidal(const ritz_motion *motion, double step,
                                     double rho, ritz_march *out)
{
    const ritz_newmark weights = {0.0, 0.0, 0.25, 0.5};

    (void)rho;
    if (motion->form == RITZ_FORM_STATES)
        return ritz_states_trapezoidal(motion, step, out);
    return ritz_newmark_start(motion, step, &weights, out);
}

const ritz_integrator ritz_integrator_trapezoidal = {
    .name = "trapezoidal",
    .summary = "average acceleration, implicit: one factor, a solve a step",
    .accuracy = "second order: periods longer by (w h)^2 / 12",
    .stability = "any step",
    .dissipation = "none: the energy of an undamped model stays",
    .fails = "modes above 1/h are kept alive as ringing",
    .reference = "Newmark1959",
    .takes_sparse = true,
    .takes_states = true,
    .start = start_trapezoidal,
};
