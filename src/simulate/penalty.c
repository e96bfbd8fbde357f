/*
 * Stabilisations by energies [McDaniel2000, 4.4.1-2, 4.5.1-2]: constraints are
 * springs, dampers and masses between the bodies. The paper's symmetric
 * matrices alpha, mu and beta over epsilon are here multiples of the matrix
 * that gives a violation the weight of the mass which it moves,
 *
 *     C'(C M^-1 C')^+ C = M Phi W'W Phi'M,
 *
 * so that all constraints have the same frequency w whatever their units:
 *
 *     stiffness = (1 + inertia) w^2,  damping = 2 ratio w (1 + inertia).
 *
 * With stiff springs c is about f / stiffness, where f is c'' of free bodies:
 * ten times the stiffness gives a tenth of the violation. An inertia does not
 * change w, nor therefore the step, and divides the violation by 1 + inertia.
 *
 * hybrid has a damper whose coefficient is proportional to |S| of a sliding
 * mode:
 *
 *     stiffness = w^2,   g = -|S| / smax c',   S = c' + surface c
 */
#include "simulate/constrained.h"

#include "base/tolerances.h"

#include <math.h>

static void choose_penalty(const ritz_gain_scales *scales, double *gain)
{
    ritz_gain_choose(&gain[0], scales->base / (2.0 * RITZ_PI));
    ritz_gain_choose(&gain[1], 1.0);
    ritz_gain_choose(&gain[2], 0.0);
}

static ritz_status find_penalty(const double *gain, ritz_stabiliser *out)
{
    const double w = 2.0 * RITZ_PI * gain[0];
    const double mass = 1.0 + gain[2];

    RITZ_REFUSE_IF(!(w > 0.0), RITZ_ERR_ARGUMENT,
                   "a penalty has a frequency above 0: 'hz'");
    *out = (ritz_stabiliser){.stiffness = mass * w * w,
                             .damping = mass * 2.0 * gain[1] * w,
                             .inertia = gain[2]};
    return RITZ_OK;
}

const ritz_stabilisation ritz_stabilisation_penalty = {
    .name = "penalty",
    .summary = "constraints are stiff springs, with dampers and masses",
    .accuracy = "that of the integrator, about a motion that is off by "
                "violations of 1 / hz^2",
    .needs = "a frequency well above all that matter",
    .stability = "explicit: step below 2 / highest; implicit: any",
    .frequency = "raised to that of the springs, or above",
    .fails = "springs that the step does not resolve oscillate; violations "
             "stay under load",
    .reference = "McDaniel2000",
    .gain = {{"hz", "Hz", "frequency of the springs [1 / step in rad/s]"},
             {"ratio", "", "damping ratio of violations [1]"},
             {"inertia", "",
              "added mass, relative to what a violation moves "
              "[0]"}},
    .integrator = &ritz_integrator_trapezoidal,
    .choose = choose_penalty,
    .terms = find_penalty,
};

/* A spring w that a force f loads at once has rates of up to f / w. There the
   coefficient |S| / smax is the critical one, 2 w. */
static void choose_hybrid(const ritz_gain_scales *scales, double *gain)
{
    double w = 0.0;

    ritz_gain_choose(&gain[0], scales->base / (2.0 * RITZ_PI));
    ritz_gain_choose(&gain[1], 1.0);
    w = 2.0 * RITZ_PI * gain[0];
    ritz_gain_choose(&gain[2], w > 0.0 ? scales->force / (2.0 * w * w) : 0.0);
}

/* own: surface, smax */
static void damp_by_surface(const ritz_stabiliser *s, double c, double rate,
                            double out[3])
{
    const double S = rate + s->own[0] * c;
    const double sign = S < 0.0 ? -1.0 : 1.0;

    out[0] = -fabs(S) / s->own[1] * rate;
    out[1] = -sign * s->own[0] * rate / s->own[1];
    out[2] = -(sign * rate + fabs(S)) / s->own[1];
}

static ritz_status find_hybrid(const double *gain, ritz_stabiliser *out)
{
    const double w = 2.0 * RITZ_PI * gain[0];

    RITZ_REFUSE_IF(!(w > 0.0), RITZ_ERR_ARGUMENT,
                   "a penalty has a frequency above 0: 'hz'");
    RITZ_REFUSE_IF(!(gain[2] > 0.0), RITZ_ERR_ARGUMENT,
                   "'smax' is positive; nothing is known to choose it from");
    *out = (ritz_stabiliser){
        .stiffness = w * w, .law = damp_by_surface, .own = {gain[1], gain[2]}};
    return RITZ_OK;
}

const ritz_stabilisation ritz_stabilisation_hybrid = {
    .name = "hybrid",
    .summary = "penalty springs, with dampers of coefficient |c' + surface c| "
               "/ smax",
    .accuracy = "that of the integrator, about a motion that is off by "
                "violations of 1 / hz^2",
    .needs = "a frequency well above all that matter, and the size of rates of "
             "violation",
    .stability = "explicit: step below 2 / highest; implicit: any",
    .frequency = "raised to that of the springs, or above",
    .fails = "small violations are hardly damped; each step solves a nonlinear "
             "equation",
    .reference = "McDaniel2000",
    .gain = {{"hz", "Hz", "frequency of the springs [1 / step in rad/s]"},
             {"surface", "1/s",
              "weight of c in the coefficient [1, as in the paper]"},
             {"smax", "of c",
              "the coefficient is 1/s where |c' + surface c| is smax/s "
              "[critical at the largest force of inputs and start]"}},
    .integrator = &ritz_integrator_trapezoidal,
    .choose = choose_hybrid,
    .terms = find_hybrid,
};
