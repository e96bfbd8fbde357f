/* One step of tracking: modes of a configuration and of the one before it. */
#ifndef RITZ_COMPARE_TRACKING_PARTS_H
#define RITZ_COMPARE_TRACKING_PARTS_H

#include <ritz/tracking.h>

typedef struct ritz_track_step {
    int64_t from, to;          /* configurations */
    int64_t num_from, num_to;  /* flexible modes */
    const double *hertz[2];    /* of both */
    const int64_t *cluster[2]; /* first mode of each one's cluster */
    ritz_dense mac;            /* num_from x num_to, the same in a cluster */
    int64_t *partner;          /* num_from, in `to`; -1: lost */
} ritz_track_step;

/** Likenesses and partners of one step; cluster and hertz are set. */
ritz_status ritz_track_match(const ritz_stage *stage,
                             const ritz_configuration *from,
                             const ritz_configuration *to,
                             ritz_track_step *step);

/** Append what happened in one step, up to a frequency, 0 for all. */
ritz_status ritz_track_events(const ritz_track_step *step, double up_to_hz,
                              ritz_tracking *tracking);

#endif
