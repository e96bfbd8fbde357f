/* Time responses as a tool asks for them, and what they cost. */
#ifndef RITZ_TOOLS_PRINT_SIMULATION_H
#define RITZ_TOOLS_PRINT_SIMULATION_H

#include "cli/model.h"

#include <ritz/simulate.h>

/* Inputs and initial values of a model; free with simulation_free. */
typedef struct simulation_drive {
    int64_t count; /* inputs of the model */
    ritz_signal *signal;
    double *x0, *v0; /* NULL: at rest */
} simulation_drive;

/** What ritz_simulate takes of a model that was read; @p view holds matrices. */
ritz_simulated simulation_subject(const model *m, const ritz_second_order *view,
                                  const ritz_damping *damping);

/**
 * Signals of --input NAME=SIGNAL.
 *
 * @return RITZ_ERR_ARGUMENT with the nearest name if there is no such input,
 *         or if one is given twice
 */
ritz_status simulation_inputs(cli_run *run, const ritz_simulated *subject,
                              const cli_list *texts, simulation_drive *drive);

/** --initial: "mode:K", "mode:K*A", or a file of values and rates. */
ritz_status simulation_initial(cli_run *run, const ritz_simulated *subject,
                               const char *text, simulation_drive *drive);

void simulation_free(simulation_drive *drive);

/**
 * Table of all integrators at the step that each needs: cost of a second,
 * error against modal over @p seconds (0: a thousand steps).
 *
 * @param[in] driven  as @p drive says; else every input sweeps the band
 */
ritz_status simulation_costs(cli_run *run, const ritz_simulated *subject,
                             simulation_drive *drive, bool driven,
                             const double band_hz[2], double seconds);

/** The cost of a model, into the line of --record. */
ritz_status simulation_record_cost(cli_run *run, const ritz_simulated *subject,
                                   const double band_hz[2]);

#endif
