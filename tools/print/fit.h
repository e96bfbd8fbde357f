/* The search for the smallest model that meets a tolerance: ritz-fit. */
#ifndef RITZ_TOOLS_PRINT_FIT_H
#define RITZ_TOOLS_PRINT_FIT_H

#include "cli/model.h"

#include <ritz/fit.h>

enum { FIT_MOST_METHODS = 64 };

/* Options; NULL: not given. */
typedef struct fit_wish {
    ritz_fit_request request;
    const char *tolerance, *band, *methods, *damping, *prefix, *report;
    const ritz_method *method[FIT_MOST_METHODS]; /* of `methods` */
    int64_t seed;
    cli_list damper;
    bool all;
    int64_t order; /* of --all; 0: the answer's */
} fit_wish;

/** Take words of the command line into the request, or end the program. */
void fit_take(const cli_program *program, fit_wish *asked);

/** Search, report, record every candidate, and write the answer. */
ritz_status fit_search(cli_run *run, fit_wish *asked);

#endif
