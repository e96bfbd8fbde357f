/* Modes followed from configuration to configuration by their shapes. */
#ifndef RITZ_TRACKING_H
#define RITZ_TRACKING_H

#include <ritz/synthesis.h>

#pragma GCC visibility push(default)

typedef enum ritz_track_kind {
    RITZ_TRACK_SWAP,    /* two tracks change places in frequency */
    RITZ_TRACK_TIE,     /* a second mode is nearly as like */
    RITZ_TRACK_AVOIDED, /* two modes turn into mixtures of each other */
    RITZ_TRACK_LOST,    /* none is like it: MAC below 0.5 */
} ritz_track_kind;

/* What happened on the way from one configuration to another. */
typedef struct ritz_track_event {
    ritz_track_kind kind;
    int64_t from, to; /* configurations */
    int64_t mode[2];  /* flexible modes of `from`; [1] -1: one is concerned */
    int64_t other[2]; /* what they become, or for a tie the two candidates; -1:
                         none */
    double mac[2];    /* of mode[0] with other[0], and of the second pair: swap
                         and avoided mode[1] with other[1], tie mode[0] with
                         other[1] */
    double shared;    /* avoided: of the two planes; else NaN */
    double hertz;     /* of mode[0] */
} ritz_track_event;

/*
 * Flexible modes only. Those of one cluster, relative gap below 1e-6, at any
 * configuration share one track: what is repeated is followed as one subspace.
 */
typedef struct ritz_tracking {
    int64_t num_configurations;
    int64_t *before;  /* the configuration that each is followed from; -1 */
    int64_t *first;   /* num_configurations + 1, where modes of each begin */
    int64_t *track;   /* from 0, ascending as they first appear */
    int64_t *cluster; /* of each mode, the first mode of its cluster */
    double *hertz;
    double *mac; /* with its like in `before`; NaN where it has none */
    int64_t num_tracks;
    int64_t num_events;
    ritz_track_event *event;
} ritz_tracking;

/**
 * Follow the flexible modes of a system over its configurations. Modes are
 * vectors of the coordinates of all bodies, each fixed in its own, so that
 *
 *     MAC_ij = (sum_c (P_c' M_c P'_c)_ij)^2 <= 1
 *
 * needs no turning back; between clusters it is the mean squared cosine of the
 * angles of their spaces. Each configuration is followed from the nearest of
 * the thousand listed before it: that which differs in the fewest sweeps, then
 * by least.
 *
 * @param[in] stage     whose coordinates the system's are
 * @param[in] up_to_hz  events above are passed over; 0: none is
 * @cost O(Q^2 e) a configuration
 */
ritz_status ritz_track(const ritz_stage *stage, const ritz_system *system,
                       double up_to_hz, ritz_tracking *out);

void ritz_tracking_free(ritz_tracking *tracking);

#pragma GCC visibility pop

#endif
