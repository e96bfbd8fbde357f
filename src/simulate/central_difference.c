/*
 * Central differences, Newmark's with gamma = 1/2, beta = 0:
 *
 *     M (x_+ - 2 x + x_-) / h^2 + D (x_+ - x_-) / (2 h) + K x = B u
 *
 * Damping forces are solved for, with M + h/2 D, so that the scheme is of
 * second order, stands gyroscopic terms, and its limit stays 2 / omega_max:
 * the energy v'M v / 2 + x'K x_+ / 2, v = (x_+ - x) / h, which is positive for
 * h omega_max < 2, changes by -h v_c'D v_c alone, v_c = (x_+ - x_-) / (2 h)
 * [Belytschko2014]. See simulate.h for that of damping forces half a step old.
 */
#include "simulate/motion.h"

#include "base/tolerances.h"

#include <math.h>

static ritz_status start_central_difference(const ritz_motion *motion,
                                            double step, double rho,
                                            ritz_march *out)
{
    const ritz_newmark weights = {0.0, 0.0, 0.0, 0.5};
    double omega = sqrt(motion->highest);

    (void)rho;
    RITZ_REFUSE_IF(!motion->any_step && step * omega >= 2.0, RITZ_ERR_ARGUMENT,
                   "a step of %g s is not stable: the highest frequency, %.6g "
                   "Hz, limits it to %.6g s",
                   step, 0.5 * omega / RITZ_PI, 2.0 / omega);
    return ritz_newmark_start(motion, step, &weights, out);
}

const ritz_integrator ritz_integrator_central_difference = {
    .name = "central-difference",
    .summary = "explicit: one factor of M + h/2 D, no stiffness in it",
    .accuracy = "second order: periods shorter by (w h)^2 / 24",
    .stability = "steps below 2 / omega_max, refused above",
    .dissipation = "none",
    .fails = "one stiff mode makes every step short",
    .reference = "Belytschko2014",
    .is_explicit = true,
    .start = start_central_difference,
};
