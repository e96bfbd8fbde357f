/*
 * What of a model's modes its inputs drive and its outputs see: the part of
 * shapes that two models without common coordinates can be compared by.
 */
#ifndef RITZ_VERIFY_SEEN_H
#define RITZ_VERIFY_SEEN_H

#include "poles/poles.h"

#include <ritz/model.h>

/** The edge of a band belongs to it, and rounding of the edge too. */
bool ritz_in_band(const double band_hz[2], double lambda);

/* A mode as [phi'b_j / largest of any mode, c_i phi / largest of any mode]. */
typedef struct ritz_seen {
    int64_t num_modes, num_inputs, num_outputs;
    double *input;  /* num_inputs, one over the largest |phi'b| of the flexible
                       modes in the band; 0: it drives none of them */
    double *output; /* 3 num_outputs, the same of C, of Cv and of Ca */
    bool *mode;     /* num_modes, whether any channel shows it */
} ritz_seen;

/**
 * Scales of inputs and outputs, so that their units do not matter, and which
 * modes are seen. Mode k is not seen in a channel (input j, output i) if
 * p = |phi'b_j| |c_i phi| is rounding, or if for some mode m of the band
 *
 *     p_k max(1, (w_m / w_k)^2) max(1, zeta_m / zeta_k) <= 1e-6 p_m,
 *
 * which says that its static share, its share in accelerations and its
 * resonance are a millionth of the other's at most. Without inputs, or without
 * outputs, those that there are count alone.
 *
 * @param[in] pairs  the modes of @p component that @p poles are of
 */
ritz_status ritz_seen_new(const ritz_component *component,
                          const ritz_pairs *pairs, const ritz_poles *poles,
                          const double band_hz[2], ritz_seen *out);

/**
 * Cosine squared of the angle between mode k of one model and mode r of
 * another, as they are seen; NaN where mode k is not at all.
 */
double ritz_seen_mac(const ritz_seen *seen, const ritz_poles *full, int64_t k,
                     const ritz_poles *reduced, int64_t r);

void ritz_seen_free(ritz_seen *seen);

#endif
