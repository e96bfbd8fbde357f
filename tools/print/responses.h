/* Frequency responses, their singular values and zeros: ritz-frf. */
#ifndef RITZ_TOOLS_PRINT_RESPONSES_H
#define RITZ_TOOLS_PRINT_RESPONSES_H

#include "print/loops.h"

typedef struct responses_wish {
    double from_hz, to_hz, up_to_hz; /* NaN: not said */
    double tolerance;                /* between points; NaN: a grid is enough */
    int64_t points;
    const char *method;    /* "auto", or a name of the table */
    const char *points_of; /* another response; NULL: none */
    bool log, no_refine, singular, over_limits, zeros;
    cli_list input_size;
    model_wish model;
    loops_wish loops;
} responses_wish;

/** Print the table of methods. */
void responses_list(void);

/** End the program if there is no such method. */
void responses_check(const cli_program *program, const responses_wish *asked);

/** Respond, and say what other options ask for. */
ritz_status responses_run(cli_run *run, const responses_wish *asked);

#endif
