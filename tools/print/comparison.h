/* Two-stage reduction of a scene and its report: ritz-compare. */
#ifndef RITZ_TOOLS_PRINT_COMPARISON_H
#define RITZ_TOOLS_PRINT_COMPARISON_H

#include "cli/model.h"

#include <ritz/assembly.h>

enum { COMPARISON_MOST_TOLERANCES = 64 };

/* Options; NULL: not given. */
typedef struct comparison_wish {
    const char *prefix, *report, *tracks, *extraneous, *tolerance_table;
    int64_t num_tolerances;
    double tolerance[COMPARISON_MOST_TOLERANCES];
} comparison_wish;

/** Reduce, write, and report orders, errors and frequencies. */
ritz_status comparison_run(cli_run *run, const comparison_wish *asked);

#endif
