/* Rankings as tools report them: tables, what they agree on, a chart. */
#ifndef RITZ_TOOLS_PRINT_RANKINGS_H
#define RITZ_TOOLS_PRINT_RANKINGS_H

#include "cli/sink.h"

#include <ritz/ranking.h>

/* Rankings of one kind over configurations, and the largest of each mode. */
typedef struct ranked {
    ritz_rankings all;
    ritz_ranking largest;   /* of several configurations; else empty */
    int64_t *where, *track; /* of the modes of the largest */
} ranked;

/** One ranking that stands for all: the largest, or the only one. */
const ritz_ranking *ranked_whole(const ranked *group);
const int64_t *ranked_track(const ranked *group);
void ranked_free(ranked *group);

/**
 * Best first: mode, frequency, damping, cluster, value, share, parts, exact
 * values and what a Hankel value differs by; at most @p most lines.
 *
 * @param[in] track  numbers of modes; NULL: their index
 */
void rankings_say(const cli_run *run, const ritz_ranking *ranking,
                  const int64_t *track, int64_t most);

/** Place from 1 of the mode with that number; 0: it is not there. */
int64_t rankings_place(const ritz_ranking *ranking, const int64_t *track,
                       int64_t number);

/** The largest over configurations, where it stands, and places at each. */
void rankings_say_largest(const cli_run *run, const ranked *group);

/** Exact values alone, with the bound of cutting there. */
void rankings_say_values(const cli_run *run, const ritz_ranking *ranking,
                         int64_t most);

/** by, at, damping, order, values and all else, in the object that is open. */
void rankings_set(cli_run *run, const ritz_ranking *ranking,
                  const int64_t *track);

/** Contents of a file of rankings. */
void rankings_describe(cli_run *run, const ritz_rankings *all);

/** Say and report that modes couple, of all of a group the worst. */
void rankings_warn(cli_run *run, const ranked *group);

/** Damping of a ranking: "modal 0.002", "of the matrices" or "none". */
const char *rankings_damping(const ritz_ranking *ranking);

/**
 * Largest relative difference between values and exact ones, of those above
 * 1e-6 of the largest; NaN if they are no Hankel values.
 */
double rankings_difference(const ritz_ranking *ranking);

void rankings_say_weights(cli_run *run, const ritz_rank_request *request,
                          const ritz_reweighing *found, int64_t keep);

/* Several rankings of one set of modes, with names of what they differ by. */
typedef struct contest {
    int64_t count;
    const ritz_ranking **ranking;
    const int64_t **track;
    char (*name)[2 * RITZ_NAME_SIZE];
    bool chain; /* each against the one before, not against the first */
} contest;

/** Compare them: places, correlations, overlaps, what comes and goes. */
ritz_status rankings_compare(cli_run *run, const contest *all, int64_t top);

/** All rankings as one table with tabs. */
ritz_status rankings_write_table(const char *path, const contest *all);

#endif
