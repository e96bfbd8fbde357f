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
    model controller;    /* of --controller */
    ritz_loop loop;      /* of it with the subject */
    bool told; /* what is said once of a loop was said: a run that is kept from
                  time to time is carried out in parts */
    ritz_accuracy reached; /* of a run whose step was chosen by it */
    int64_t num_libraries; /* of --switched */
    ritz_dense *library;
} simulation_task;

/** One run of a task: of one linear model, or of a kind. */
typedef ritz_status simulation_function(simulation_task *task,
                                        const ritz_simulation_request *request,
                                        ritz_simulation *out);

/* A run that is not that of one linear model. */
typedef struct simulation_kind {
    const char *option; /* that asks for it, "--switched" */
    bool (*asked)(const simulation_options *given);
    simulation_function *simulate;
    /** Read the files that options name, once before all runs; NULL: none. */
    ritz_status (*prepare)(simulation_task *task);
} simulation_kind;

/** All of them, ended by an empty one. */
extern const simulation_kind simulation_kinds[];

/** The bodies of a scene, joined over time as --constraints says. */
simulation_function simulation_constrained;
bool simulation_is_constrained(const simulation_options *given);

/* A controller that is joined to the model. */
bool simulation_is_controlled(const simulation_options *given);
simulation_function simulation_controlled;
ritz_status simulation_prepare_loop(simulation_task *task);

/** End the program if options of a loop are given without its controller, or
 * exclude each other. */
void simulation_check_loop(const cli_program *program,
                           const simulation_options *given);

/**
 * Carry out a run, keep what is done in the checkpoint, if there is one, from
 * time to time, and continue from a checkpoint that is there.
 *
 * @return RITZ_ERR_CONVERGENCE after a signal: what was done is then the output,
 *         as OUTPUT.interrupted; RITZ_ERR_ARGUMENT if the checkpoint is of
 *         another command or of other files
 */
ritz_status simulation_long_run(simulation_task *task,
                                ritz_simulation_request *request,
                                simulation_function *simulate,
                                ritz_simulation *out);

/* Switched reduced models. */
bool simulation_switched_asked(const simulation_options *given);
ritz_status simulation_switched_prepare(simulation_task *task);
simulation_function simulation_switched;
/** Whether the rate of spin of the scene changes, and a run of it. */
bool simulation_spins(const simulation_task *task);
simulation_function simulation_spin;

/* A joint that moves: simulation_swept.c. */
bool simulation_sweep_asked(const simulation_options *given);
simulation_function simulation_sweep;

/** Take the start of --sweep into --at, and its end for --seconds; refuse what
 * is no path. */
ritz_status simulation_sweep_prepare(cli_run *run, simulation_options *given);

/** Say what each integrator costs at the step that it needs. */
ritz_status simulation_say_costs(simulation_task *d, const double band_hz[2]);

/** The cost of a model, in the line of --record. */
ritz_status simulation_record_cost(cli_run *run, ritz_model subject,
                                   const double band_hz[2], ritz_cost *cost);

#endif
