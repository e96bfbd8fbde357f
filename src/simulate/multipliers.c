/*
 * Stabilisations with multipliers. The multipliers cancel the forces of the
 * bodies along the constraints, so that c'' = -nu [McDaniel2000, 4.3.17]:
 *
 *     none            nu = 0
 *     baumgarte       nu = 2 alpha c' + beta^2 c                  (4.3.18)
 *     sliding-mode    nu = surface c' + surface S + switch sat(S / layer),
 *                     S = c' + surface c                          (4.3.19)
 *     projection      nu = 0, then z := (I - W'W) z and z' likewise
 *
 * so that S' = -surface S - switch sat(S / layer): the surface S = 0 is reached
 * from S_0 within |S_0| / switch, and on it c falls as exp(-surface t). The
 * scan of (4.3.19) cannot be read with certainty. Its first terms are a linear
 * approach to the surface, for which we take one rate, and its last term is the
 * switching of a sliding mode, made continuous within a layer [Slotine1984].
 *
 * The layer should be at least switch times step: in a thinner one S changes
 * sign at each step, with a size of at most switch times step.
 */
#include "simulate/constrained.h"

#include <math.h>

static ritz_status find_none(const double *gain, ritz_stabiliser *out)
{
    (void)gain;
    *out = (ritz_stabiliser){.multipliers = true};
    return RITZ_OK;
}

const ritz_stabilisation ritz_stabilisation_none = {
    .name = "none",
    .summary = "multipliers alone, to compare with",
    .accuracy = "that of the integrator; c'' = 0 to rounding",
    .needs = "a start that satisfies the constraints to all digits",
    .stability = "that of the integrator",
    .frequency = "stays",
    .fails = "a violation at the start stays, and one of its velocity grows "
             "with time; rounding adds to both",
    .reference = "McDaniel2000",
    .integrator = &ritz_integrator_trapezoidal,
    .terms = find_none,
};

/* Violations are damped critically if both are the same. */
static void choose_baumgarte(const ritz_gain_scales *scales, double *gain)
{
    ritz_gain_choose(&gain[0], isnan(gain[1]) ? scales->base : gain[1]);
    ritz_gain_choose(&gain[1], gain[0]);
}

static ritz_status find_baumgarte(const double *gain, ritz_stabiliser *out)
{
    *out = (ritz_stabiliser){.multipliers = true,
                             .damping = 2.0 * gain[0],
                             .stiffness = gain[1] * gain[1],
                             .stiffest = gain[1] * gain[1]};
    return RITZ_OK;
}

const ritz_stabilisation ritz_stabilisation_baumgarte = {
    .name = "baumgarte",
    .summary = "c'' + 2 alpha c' + beta^2 c = 0",
    .accuracy = "that of the integrator",
    .needs = "two parameters that fit the step",
    .stability = "explicit: step below 2 / beta; implicit: any",
    .frequency = "raised to beta if that is higher",
    .fails = "a violation at the start takes about 1 / beta to decay, and the "
             "forces that remove it do work",
    .reference = "Baumgarte1972",
    .gain = {{"alpha", "1/s", "damping of violations [beta]"},
             {"beta", "1/s", "frequency of violations [alpha; 1 / step]"}},
    .integrator = &ritz_integrator_trapezoidal,
    .choose = choose_baumgarte,
    .terms = find_baumgarte,
};

static void choose_sliding(const ritz_gain_scales *scales, double *gain)
{
    ritz_gain_choose(&gain[0], 0.5 * scales->base);
    ritz_gain_choose(&gain[1], (scales->rate + gain[0] * scales->violation) /
                                   (10.0 * scales->step));
    ritz_gain_choose(&gain[2], gain[1] * scales->step);
}

/* own: surface, switch, layer */
static void switch_over(const ritz_stabiliser *s, double c, double rate,
                        double out[3])
{
    const double S = rate + s->own[0] * c;
    const bool within = fabs(S) < s->own[2];
    const double slope = within ? -s->own[1] / s->own[2] : 0.0;

    out[0] = within ? slope * S : -copysign(s->own[1], S);
    out[1] = slope * s->own[0];
    out[2] = slope;
}

static ritz_status find_sliding(const double *gain, ritz_stabiliser *out)
{
    const double surface = gain[0], change = gain[1], layer = gain[2];
    ritz_stabiliser s = {.multipliers = true,
                         .damping = 2.0 * surface,
                         .stiffness = surface * surface};

    s.stiffest = s.stiffness;
    if (change > 0.0) {
        RITZ_REFUSE_IF(!(layer > 0.0), RITZ_ERR_ARGUMENT,
                       "'layer' is positive where 'switch' is");
        s.law = switch_over;
        s.own[0] = surface;
        s.own[1] = change;
        s.own[2] = layer;
        s.stiffest += surface * change / layer;
    }
    *out = s;
    return RITZ_OK;
}

const ritz_stabilisation ritz_stabilisation_sliding_mode = {
    .name = "sliding-mode",
    .summary = "S = c' + surface c falls to 0 by surface S + switch sat(S / "
               "layer)",
    .accuracy = "that of the integrator where S is within the layer",
    .needs = "three parameters",
    .stability = "explicit: step below 2 / sqrt(surface^2 + surface switch / "
                 "layer); implicit: any",
    .frequency = "raised to that root if it is higher",
    .fails = "in a layer thinner than switch times step forces alternate "
             "between their bounds",
    .reference = "McDaniel2000",
    .gain = {{"surface", "1/s", "rate at which c falls [half of 1 / step]"},
             {"switch", "of c''",
              "bound of the switching part, c with W M^-1 "
              "W' = I [ends S of the start in ten steps]"},
             {"layer", "of c'",
              "S where that bound is reached [switch times "
              "step]"}},
    .integrator = &ritz_integrator_trapezoidal,
    .choose = choose_sliding,
    .terms = find_sliding,
};

static ritz_status find_projection(const double *gain, ritz_stabiliser *out)
{
    (void)gain;
    *out = (ritz_stabiliser){.multipliers = true, .projects = true};
    return RITZ_OK;
}

const ritz_stabilisation ritz_stabilisation_projection = {
    .name = "projection",
    .summary = "multipliers, and positions and velocities projected in M after "
               "each step",
    .accuracy = "that of the integrator: what is taken away is along the "
                "constraints alone",
    .needs = "nothing",
    .stability = "that of the integrator",
    .frequency = "stays",
    .fails = "a projection takes energy: all of a violation that the start has",
    .reference = "Eich1993",
    .integrator = &ritz_integrator_trapezoidal,
    .terms = find_projection,
};
