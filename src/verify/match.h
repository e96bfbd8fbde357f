/* Which mode of the reduced model corresponds to which of the full one. */
#ifndef RITZ_VERIFY_MATCH_H
#define RITZ_VERIFY_MATCH_H

#include "verify/participation.h"

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
 * By frequency and participations: the alignment of the two ascending lists that
 * costs least, and then exchanges of modes whose order differs between them. MAC
 * is ritz_participation_mac, 0 without partner; NaN of modes that are not
 * observable, and of those closer than 1e-3, which may be any mixture.
 */
ritz_status ritz_match_outputs(const ritz_poles *full,
                               const ritz_poles *reduced,
                               const ritz_participation *part, ritz_match *out);

void ritz_match_free(ritz_match *match);

#endif
