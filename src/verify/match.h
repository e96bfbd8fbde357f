/* Which mode of the reduced model corresponds to which of the full one. */
#ifndef RITZ_VERIFY_MATCH_H
#define RITZ_VERIFY_MATCH_H

#include "poles/poles.h"

#include <ritz/model.h>

/*
 * Two models without common coordinates are compared by how much each mode
 * takes part in their inputs and outputs, instead of by mode shapes.
 */

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
 * p of its participations in both is rounding, or if for some mode m of the
 * band
 *
 *     p_k max(1, (w_m / w_k)^2) max(1, zeta_m / zeta_k) <= 1e-6 p_m,
 *
 * so that its parts in the static response, in accelerations and at resonance
 * are at most a millionth of those of the other mode. Without inputs, or
 * without outputs, the participations in the others decide alone.
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

typedef struct ritz_match {
    int64_t count;    /* modes of the full model */
    int64_t *partner; /* count, mode of the reduced one; -1: it has none */
    double *mac;      /* count, of the cluster it is in; NaN: not known */
    int64_t num_reduced;
    bool *taken; /* num_reduced, whether it is a partner */
} ritz_match;

/**
 * By shapes: Q = Phi_full' M T Phi_reduced, both sides normalised. Full modes
 * closer than 1e-3 are one cluster, whose MAC is that of subspaces: the least
 * singular value of its block of Q, squared. Rigid modes have no partner.
 */
ritz_status ritz_match_shapes(const ritz_poles *full, const ritz_poles *reduced,
                              const ritz_dense *Q, ritz_match *out);

/**
 * By frequency and participations: the alignment of the two ascending lists
 * that costs least, and then exchanges of modes whose order differs between
 * them. MAC is ritz_participation_mac, 0 without partner; NaN of modes that are
 * not observable, and of those closer than 1e-3, which may be any mixture.
 */
ritz_status ritz_match_outputs(const ritz_poles *full,
                               const ritz_poles *reduced,
                               const ritz_participation *part, ritz_match *out);

void ritz_match_free(ritz_match *match);

#endif
