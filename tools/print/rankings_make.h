/* Rankings of a model, or of files: ritz-rank. */
#ifndef RITZ_TOOLS_PRINT_RANKINGS_MAKE_H
#define RITZ_TOOLS_PRINT_RANKINGS_MAKE_H

#include "cli/model.h"
#include "print/rankings.h"

#include <ritz/model.h>

enum { RANK_MOST = 16 };

typedef struct rank_wish {
    int64_t num_rankers;
    const ritz_ranker *ranker[RANK_MOST];
    cli_list damping;
    const char *by, *band, *engine, *among; /* words that rank_take reads */
    const char *at, *input_weights, *output_weights, *tracks, *table, *chart;
    double band_hz[2]; /* [0, 0]: the model's */
    int64_t keep, top; /* keep 0: weights stay */
    int64_t order;     /* columns of a nested component; 0: all */
    bool compare;
    ritz_status (*draw)(const char *path, const char *title, const contest *all,
                        int64_t most); /* for `chart` */
    ritz_choice choice;                /* of a component's Gramians */
} rank_wish;

/* A group for each ranking and each damping, or for each file. */
typedef struct rank_result {
    int64_t count;
    ranked *group;
    char (*file)[RITZ_NAME_SIZE]; /* of groups that were read; else NULL */
} rank_result;

/** Take words of the command line, or end the program. */
void rank_take(const cli_run *run, rank_wish *asked);

/** Rank what the operand holds, or read rankings of --compare, and report. */
ritz_status rank_run(cli_run *run, const rank_wish *asked);

/**
 * Rankings to be compared: of several groups the whole of each, of a single one
 * its configurations in a row; with @p all every ranking there is.
 */
ritz_status rank_contest(const rank_result *result, bool all, contest *out);
void rank_contest_free(contest *all);

/** All rankings in one container. */
ritz_status rank_write(const char *path, const rank_result *result,
                       const ritz_stamp *stamp);

void rank_result_free(rank_result *result);

#endif
