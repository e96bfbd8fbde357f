/*
 * What of a response is rounding. In coordinates that make the diagonal of
 * K + tau M one, tau of the end of the range, which knows no units,
 *
 *     |H_ij| = |c_i'Z^-1 b_j| <= |c_i| |Z^-1| |b_j|,
 *
 * and what solves with Z leave of zero is eps of the right-hand side or more.
 * |Z^-1| is at least the largest |H_ij| / (|c_i| |b_j|) of all channels.
 */
#ifndef RITZ_RESPONSE_NOISE_H
#define RITZ_RESPONSE_NOISE_H

#include "poles/poles.h"

typedef struct ritz_noise {
    int64_t num_outputs, num_inputs;
    double *output; /* 3 x num_outputs: of C, Cv and Ca; NULL: not known */
    double *input;
} ritz_noise;

/** Of a component or a small dense model; else {0}, of which all is heard. */
ritz_status ritz_noise_new(const ritz_response_request *request,
                           ritz_noise *out);

/**
 * Raise @p level, num_outputs x num_inputs, to |c_i| |Z^-1| |b_j| at a
 * frequency.
 */
void ritz_noise_heed(const ritz_noise *noise, double hertz,
                     const double _Complex *H, double *level);

/**
 * What errors within @p tolerance are measured by: ritz_channel_scales, and
 * more where that is beneath rounding. A channel that is nowhere more than
 * 1e-12 of its level is rounding, and may err by as much as that.
 */
void ritz_noise_scales(int64_t num_outputs, int64_t num_inputs,
                       double tolerance, const double *peak,
                       const double *level, double *scale);

void ritz_noise_free(ritz_noise *noise);

#endif
