/* Time responses, and what a simulated second costs: ritz-simulate. */
#ifndef RITZ_TOOLS_PRINT_SIMULATION_H
#define RITZ_TOOLS_PRINT_SIMULATION_H

#include "cli/model.h"

typedef struct simulation_wish {
    const char *method, *hold, *band; /* words that simulation_take reads */
    const ritz_integrator *integrator;
    const char *initial; /* "mode:K*A" or a file; NULL: at rest */
    double seconds, step, accuracy, rho, up_to_hz; /* NaN: not said */
    double band_hz[2];                             /* 0, 0: not said */
    int64_t every;
    cli_list input; /* "NAME=SIGNAL" */
    bool hold_zero, cost;
    model_wish model;
} simulation_wish;

/** Take words of the command line, and refuse what makes no sense whatever the
 * model is. */
void simulation_take(const cli_run *run, simulation_wish *asked);

/** Compute the response, if there is an output, and costs, if asked for. */
ritz_status simulation_run(cli_run *run, const simulation_wish *asked);

#endif
