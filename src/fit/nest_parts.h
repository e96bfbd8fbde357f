/* What the files share that put a scene's columns in order. */
#ifndef RITZ_FIT_NEST_PARTS_H
#define RITZ_FIT_NEST_PARTS_H

#include "fit/fit_parts.h"
#include "fit/order.h"

typedef struct ritz_fit_nesting {
    ritz_fitter *f;
    const ritz_reduced *whole; /* of each flexible body */
    int64_t *first;            /* num_bodies + 1: its first column of all */
    int64_t *own;              /* to work in: columns of one body */
    int64_t *some;             /* to work in: columns of all */
    int64_t every;             /* of listed places these decide the order */
    int64_t step;    /* columns from one cut that is told of to the next */
    int64_t hardest; /* of those places: where the last was farthest off */
    ritz_fit_order order;
} ritz_fit_nesting;

/** Of some columns those of body @p k, as it numbers them, into `own`. */
int64_t ritz_fit_own(const ritz_fit_nesting *nesting, int64_t k, int64_t count,
                     const int64_t *column);

/** How far the system of some columns is off, of an order whose context is a
 * nesting. */
ritz_status ritz_fit_excess_of(void *context, int64_t count,
                               const int64_t *column, double most, double *out);

/** The system of some columns at all places, where candidates are confirmed. */
ritz_status ritz_fit_judge_cut(const ritz_fit_nesting *nesting, int64_t count,
                               const int64_t *column, ritz_fit_candidate *out);

/** Every first columns of the order. */
ritz_status ritz_fit_walk(const ritz_fit_nesting *nesting, ritz_fit_path *out);

/** Errors of the system into a nested body: of its prefixes, and of all. */
ritz_status ritz_fit_note(const ritz_fit_nesting *nesting, int64_t k,
                          const ritz_fit_path *path, ritz_reduced *body);

#endif
