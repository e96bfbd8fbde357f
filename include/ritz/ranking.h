/*
 * Rankings of the modes of a modal model: which matter from input to output.
 * Rigid modes are not ranked. Modes closer than 1e-6 in frequency are one
 * cluster, which gets one value and is kept or dropped whole.
 */
#ifndef RITZ_RANKING_H
#define RITZ_RANKING_H

#include <ritz/modal.h>
#include <ritz/system.h>

typedef struct ritz_ranking {
    char by[RITZ_NAME_SIZE];
    char reference[RITZ_NAME_SIZE];
    int64_t count;  /* m flexible modes */
    double *hertz;  /* m */
    double *zeta;   /* m, the damping used */
    double *value;  /* m, one for each mode; equal within a cluster */
    int64_t *order; /* m, best first; ties in order of frequency */
    int64_t num_system;
    double *system_value; /* exact Hankel values of the whole, descending */
    double coupling;      /* largest normalised off-diagonal of the exact modal
                        Gramian: where it is not small, Gregory's assumption
                        fails; NaN if not computed */
    int64_t coupled[2];   /* modes between which it stands */
} ritz_ranking;

typedef struct ritz_ranker {
    const char *name;
    const char *summary;
    const char *reference;
    /** Value of each mode; those of a cluster get that of the whole cluster. */
    ritz_status (*rank)(const ritz_modal *modal, double *value);
} ritz_ranker;

/** All rankings, ended by NULL. */
extern const ritz_ranker *const ritz_rankers[];
extern const ritz_ranker ritz_ranker_gregory;
extern const ritz_ranker ritz_ranker_hankel;

const ritz_ranker *ritz_ranker_find(const char *name);

/** Rank, with exact system values and the coupling flag beside. */
ritz_status ritz_rank(const ritz_ranker *ranker, const ritz_modal *modal,
                      ritz_ranking *out);

void ritz_ranking_free(ritz_ranking *ranking);

#endif
