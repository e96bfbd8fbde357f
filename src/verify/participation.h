/*
 * How much each mode takes part in the inputs and outputs of a model: two models
 * without common coordinates are compared by these participations instead of by
 * mode shapes.
 */
#ifndef RITZ_VERIFY_PARTICIPATION_H
#define RITZ_VERIFY_PARTICIPATION_H

#include "poles/poles.h"

#include <ritz/model.h>

/** @return RITZ_ERR_ARGUMENT unless inputs and outputs have the same names */
ritz_status ritz_verify_signals(const ritz_io *full, const ritz_io *reduced);

/** @return RITZ_ERR_ARGUMENT unless 0 <= low < high, or high is 0 if it may */
ritz_status ritz_verify_band(const double band_hz[2], bool may_be_zero);

/** Whether a mode is in a band, whose ends belong to it but for rounding. */
bool ritz_in_band(const double band_hz[2], double lambda);

/* Mode k has the participations scale[c] phi'b_c, of outputs scale[c] c_c phi;
   c counts inputs, then rows of C, of Cv and of Ca. */
typedef struct ritz_participation {
    int64_t num_modes, num_inputs, num_outputs;
    double *scale;    /* one over the largest of the flexible modes in the band,
                         0 where that is rounding */
    bool *observable; /* num_modes, in any transfer function */
} ritz_participation;

/**
 * Scales that make units of inputs and outputs irrelevant, and which modes are
 * observable. Mode k is not observable from input j to output i if the product
 * p of its participations in both is rounding, or if for some mode m of the band
 *
 *     p_k max(1, (w_m / w_k)^2) max(1, zeta_m / zeta_k) <= 1e-6 p_m,
 *
 * so that its parts in the static response, in accelerations and at resonance
 * are at most a millionth of those of the other mode. Without inputs, or without
 * outputs, the participations in the others decide alone.
 *
 * @param[in] pairs  the modes of @p component that @p poles are of
 */
ritz_status ritz_participation_new(const ritz_component *component,
                                   const ritz_pairs *pairs,
                                   const ritz_poles *poles,
                                   const double band_hz[2],
                                   ritz_participation *out);

/**
 * Cosine squared of the angle between the participations of mode k of one model
 * and of mode r of another; NaN where mode k has none.
 */
double ritz_participation_mac(const ritz_participation *part,
                              const ritz_poles *full, int64_t k,
                              const ritz_poles *reduced, int64_t r);

void ritz_participation_free(ritz_participation *part);

#endif
