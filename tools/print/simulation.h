/*
 * The parts of ritz-simulate: what is simulated, by which kind of run, and what
 * a second of it costs.
 */
#ifndef RITZ_PRINT_SIMULATION_H
#define RITZ_PRINT_SIMULATION_H

#include "print/print.h"

#include <ritz/assembly.h>

/* What is simulated, and what drives it. */
typedef struct simulation_task {
    cli_run *run;
    const simulation_options *given;
    model m;          /* the model that was read; of a scene its system */
    ritz_scene scene; /* {0}: the file is a container */
    ritz_stage stage; /* of the scene: its bodies, reduced */
    double *setting;  /* of the scene's sweeps, as --at says */
    ritz_model subject;
    ritz_io io;          /* of the subject, borrowed */
    ritz_signal *signal; /* of each input */
    double *x0, *v0;     /* of the subject; NULL: at rest */
} simulation_task;

/* A run that is not that of one linear model. */
typedef struct simulation_kind {
    const char *option; /* that asks for it, "--switched" */
    bool (*asked)(const simulation_options *given);
    /** @param[in] request  its integrator, times, inputs and initial values */
    ritz_status (*simulate)(simulation_task *task,
                            const ritz_simulation_request *request,
                            ritz_simulation *out);
} simulation_kind;

/** All of them, ended by an empty one. */
extern const simulation_kind simulation_kinds[];

/** Say what each integrator costs at the step that it needs. */
ritz_status simulation_say_costs(simulation_task *task,
                                 const double band_hz[2]);

/** The cost of a model, in the line of --record. */
ritz_status simulation_record_cost(cli_run *run, ritz_model subject,
                                   const double band_hz[2], ritz_cost *cost);

#endif
