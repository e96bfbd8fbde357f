/* Rankings as tools report them: tables, what they agree on, a chart. */
#ifndef RITZ_TOOLS_PRINT_RANKINGS_H
#define RITZ_TOOLS_PRINT_RANKINGS_H

#include "print/print.h"

#include <ritz/ranking.h>

/* Rankings of one kind over configurations, and the largest of each mode. */
typedef struct ranked {
    ritz_rankings all;
    ritz_ranking largest;   /* of several configurations; else empty */
    int64_t *where, *track; /* of the modes of the largest */
} ranked;

/** One ranking that stands for all: the largest, or the only one. */
const ritz_ranking *ranked_whole(const ranked *group);
int64_t *ranked_track(const ranked *group);

/** Numbers of the modes of the k-th ranking; NULL: their index. */
int64_t *ranked_numbers(const ritz_rankings *all, int64_t k);

void ranked_free(ranked *group);

/**
 * Best first: mode, frequency, damping, cluster, value, share, parts, exact
 * values and what a Hankel value differs by; at most @p most lines.
 *
 * @param[in] track  numbers of modes; NULL: their index
 */
void rankings_say(const cli_run *run, const ritz_ranking *ranking,
                  const int64_t *track, int64_t most);

/** " 3", the place of the mode with that number, as part of a line, or " -" if
 * it is not there, in @p width letters. */
void rankings_say_place(const cli_run *run, const ritz_ranking *ranking,
                        const int64_t *track, int64_t number, int width);

/** "1 2 5" of indices of modes, or "none". */
void rankings_list_modes(int64_t count, const int64_t *mode, size_t size,
                         char *out);

/** The largest over configurations, where it stands, and places at each. */
void rankings_say_largest(const cli_run *run, const ranked *group);

/** Exact values alone, with the bound of cutting there. */
void rankings_say_values(const cli_run *run, const ritz_ranking *ranking,
                         int64_t most);

/** by, at, damping, order, values and all else, in the object that is open, or
 * as an item of the list that is. */
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
    int64_t **track;
    char (*name)[2 * RITZ_NAME_SIZE];
    bool chain; /* each against the one before, not against the first */
} contest;

/* A group for each ranking and each damping, or for each file. */
typedef struct rank_result {
    int64_t count;
    ranked *group;
    char (*file)[RITZ_NAME_SIZE]; /* of groups that were read; else NULL */
} rank_result;

void rank_result_free(rank_result *result);

/**
 * Rankings to be compared: of several groups the whole of each, of a single one
 * its configurations in a row; with @p all every ranking there is.
 */
ritz_status contest_new(const rank_result *result, bool all, contest *out);
void contest_free(contest *all);

/** Compare them: places, correlations, overlaps, what comes and goes. */
ritz_status rankings_compare(cli_run *run, const contest *all, int64_t top);

/** All rankings as one table with tabs. */
ritz_status rankings_write_table(const char *path, const contest *all);

enum { RANK_MOST = 16 };

/* Options of ritz-rank; NULL: not given. */
typedef struct rank_options {
    int64_t num_rankers;
    const ritz_ranker *ranker[RANK_MOST];
    cli_list damping;
    const char *by, *engine, *among; /* words that rank_take reads */
    const char *at, *input_weights, *output_weights, *tracks, *table, *chart;
    double band_hz[2]; /* [0, 0]: the model's */
    int64_t keep, top; /* keep 0: weights stay */
    int64_t order;     /* columns of a nested component; 0: all */
    bool compare;
    ritz_status (*draw)(const char *path, const char *title, const contest *all,
                        int64_t most); /* for `chart` */
    ritz_choice choice;                /* of a component's Gramians */
} rank_options;

/** Take words of the command line, or end the program. */
void rank_take(const cli_run *run, rank_options *given);

/** Rank what the operand holds, or read rankings of --compare, and report. */
ritz_status rank_run(cli_run *run, const rank_options *given);

#endif
