/*
 * Generalised-alpha: with rho the spectral radius at infinite frequency
 *
 *     alpha_m = (2 rho - 1) / (rho + 1),   alpha_f = rho / (rho + 1)
 *     gamma = 1/2 - alpha_m + alpha_f
 *     beta  = (1 - alpha_m + alpha_f)^2 / 4
 *
 * which is of second order, stable at any step, and of all such weights takes
 * least from low frequencies [ChungHulbert1993]. rho = 1 takes nothing, rho = 0
 * ends what it cannot resolve in one step.
 */
#include "simulate/motion.h"

static ritz_status start_generalised_alpha(const ritz_motion *motion,
                                           double step, double rho,
                                           ritz_march *out)
{
    ritz_newmark w = {0};

    RITZ_REFUSE_IF(!(rho >= 0.0 && rho <= 1.0), RITZ_ERR_ARGUMENT,
                   "the spectral radius at infinite frequency is between 0 and "
                   "1, not %g",
                   rho);
    w.alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
    w.alpha_f = rho / (rho + 1.0);
    w.gamma = 0.5 - w.alpha_m + w.alpha_f;
    w.beta =
        0.25 * (1.0 - w.alpha_m + w.alpha_f) * (1.0 - w.alpha_m + w.alpha_f);
    return ritz_newmark_start(motion, step, &w, out);
}

const ritz_integrator ritz_integrator_generalised_alpha = {
    .name = "generalised-alpha",
    .summary = "implicit, damps what the step does not resolve (--rho)",
    .accuracy = "second order",
    .stability = "any step",
    .dissipation = "by design: rho a step at high frequency, little below 1/h",
    .fails = "takes energy from modes that matter if steps are coarse",
    .reference = "ChungHulbert1993",
    .takes_sparse = true,
    .start = start_generalised_alpha,
};
