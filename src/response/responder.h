/* The interface of response engines, and what all of them share. */
#ifndef RITZ_RESPONSE_RESPONDER_H
#define RITZ_RESPONSE_RESPONDER_H

#include "poles/poles.h"

/*
 * The level below which a response is rounding. In coordinates that make the
 * diagonal of K + tau M one, tau being that of the end of the range, which are
 * independent of units,
 *
 *     |H_ij| = |c_i'Z^-1 b_j| <= |c_i| |Z^-1| |b_j|,
 *
 * and a solution with Z that should be zero is eps of the right-hand side or
 * more. |Z^-1| is at least the largest |H_ij| / (|c_i| |b_j|) of all channels.
 */

typedef struct ritz_noise {
    int64_t num_outputs, num_inputs;
    double *output; /* 3 x num_outputs: C, Cv, Ca; NULL: not known */
    double *input;
} ritz_noise;

/**
 * Raise @p level, num_outputs x num_inputs, to |c_i| |Z^-1| |b_j| at a
 * frequency.
 */
void ritz_noise_heed(const ritz_noise *noise, double hertz,
                     const double _Complex *H, double *level);

/**
 * The scale to which errors within @p tolerance are relative: that of
 * ritz_channel_scales, raised where it is below rounding. A channel that
 * nowhere exceeds 1e-12 of its level is rounding, and may err by as much as
 * that.
 */
void ritz_noise_scales(int64_t num_outputs, int64_t num_inputs,
                       double tolerance, const double *peak,
                       const double *level, double *scale);

enum { RITZ_REMARK_SIZE = 320 };

struct ritz_responder {
    const ritz_response_engine *engine;
    /* names, and modes to refine a grid around; owned by the state */
    const ritz_poles *poles;
    /* the undamped modes of the component, if there is one */
    const ritz_component *component;
    const ritz_pairs *pairs;
    double from_hz, to_hz;
    ritz_damping given;              /* in addition to that of matrices */
    char damping[RITZ_DAMPING_SIZE]; /* the same in words, or the model's */
    char remark[RITZ_REMARK_SIZE];
    double uncertain;     /* error of the changes by ratios, relative to |H| */
    ritz_noise noise;     /* rounding level of the responses */
    ritz_rounded rounded; /* effect of rounding of K on the responses */
    void *state;
    /** Add H at a frequency to an array of zeros. */
    ritz_status (*at)(void *state, double hertz, double _Complex *H);
    void (*free)(void *state); /* all that it owns, but not itself */
};

extern const ritz_response_engine ritz_response_engine_krylov;
extern const ritz_response_engine ritz_response_engine_rational;
extern const ritz_response_engine ritz_response_engine_sparse;
extern const ritz_response_engine ritz_response_engine_states;

/** Note the engine and the damping in a response. */
void ritz_responder_sign(const ritz_responder *responder, ritz_response *r);

/** Refuse a range that ends above the modes of a request: RITZ_ERR_ARGUMENT. */
ritz_status ritz_response_reach(const ritz_response_request *request);

/**
 * Highest frequency up to which a request needs the modes of a component, in
 * Hz. If damping ratios act on all modes, it is at least what the series of the
 * modes above needs.
 */
double ritz_response_highest(const ritz_response_request *request);

/**
 * Names of inputs and outputs for poles that are known alone: each counts as
 * controllable and observable.
 */
ritz_status ritz_poles_name(const ritz_io *io, ritz_poles *poles);

/**
 * Damped poles. Decoupled modes give the roots of s^2 + rate s + lambda, if
 * observable in a channel. Coupled ones are poles of the full matrices, up to
 * 1.5 times the range, if there is a component with its modes, else of the
 * modal matrices. Of a conjugate pair the one above the axis is given; a free
 * rigid motion gives 0 twice.
 */
ritz_status ritz_responder_poles(const ritz_responder *responder,
                                 int64_t *count, double _Complex **out);

/** The poles of a spectrum, those at 0 behind. */
ritz_status ritz_spectrum_list(const ritz_spectrum *all, int64_t *count,
                               double _Complex **out);

#endif
