/*
 * The parts of ritz-simulate: the model and its inputs, the kinds of runs, and
 * what a simulated second costs.
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
    ritz_loop loop;      /* how it is joined to the subject */
    bool told; /* what a run says first was printed: one with checkpoints has
                  several parts, and it is printed once */
    ritz_accuracy reached; /* of a run whose step --accuracy chose */
    int64_t num_libraries; /* of --switched */
    ritz_dense *library;
} simulation_task;

/** A run of a task, of one linear model or of another kind. */
typedef ritz_status simulation_function(simulation_task *task,
                                        const ritz_simulation_request *request,
                                        ritz_simulation *out);

/* Kinds of runs, as bits; --cost is that without an output. */
enum {
    SIMULATION_LINEAR = 1,
    SIMULATION_CONSTRAINTS = 2,
    SIMULATION_SWITCHED = 4,
    SIMULATION_CONTROLLER = 8,
    SIMULATION_SWEEP = 16,
    SIMULATION_SPIN = 32,
    SIMULATION_RUN = 63, /* all so far */
    SIMULATION_COST = 64,
};

/* A kind of run that is not that of one linear model. */
typedef struct simulation_kind {
    const char *option; /* the option that requests it, "--switched" */
    unsigned use;       /* its bit */
    bool (*asked)(const simulation_options *given);
    simulation_function *simulate;
    /** Read the files that options name, once before all runs; NULL: none. */
    ritz_status (*prepare)(simulation_task *task);
} simulation_kind;

/** All of them, ended by an empty one. */
extern const simulation_kind simulation_kinds[];

/** The kind of run that the options request; NULL: a run of one linear model.
 * @return RITZ_ERR_ARGUMENT if they request two */
ritz_status simulation_find_kind(const simulation_options *given,
                                 const simulation_kind **out);

/** End the program if an option is given that the run does not use. */
void simulation_check_options(const cli_run *run,
                              const simulation_options *given);

/** Whether an option is given that a kind of run does not use, and the sentence
 * that says so. */
bool simulation_misuses(const cli_run *run, unsigned use, size_t size,
                        char *out);

/** The bodies of a scene, joined over time as --constraints says. */
simulation_function simulation_constrained;
bool simulation_is_constrained(const simulation_options *given);

/* A controller that is joined to the model. */
bool simulation_is_controlled(const simulation_options *given);
simulation_function simulation_controlled;
ritz_status simulation_prepare_loop(simulation_task *task);

/**
 * Carry out a run. With --checkpoint, continue from the checkpoint if it
 * exists, and write it from time to time. If it cannot be written, the run goes
 * on with a warning.
 *
 * @return RITZ_ERR_CONVERGENCE after a signal, with the run until then in
 *         OUTPUT.interrupted; RITZ_ERR_ARGUMENT if the checkpoint is of another
 *         command or of other files
 */
ritz_status simulation_long_run(simulation_task *task,
                                ritz_simulation_request *request,
                                simulation_function *simulate,
                                ritz_simulation *out);

/** Add to the sentence of a failure that the same command continues the run
 * from its checkpoint, if there is one. */
ritz_status simulation_name_checkpoint(const simulation_task *task,
                                       ritz_status status);

/* Switched reduced models. */
bool simulation_switched_asked(const simulation_options *given);
/* Refuse what makes no sense, and fill what was not given. */
void simulation_check_switched(const cli_program *program,
                               simulation_options *given);
ritz_status simulation_switched_prepare(simulation_task *task);
simulation_function simulation_switched;
/** Whether the rate of spin of the scene changes, and a run of it. */
bool simulation_spins(const simulation_task *task);
simulation_function simulation_spin;

/**
 * Name the bodies of the scene in a run that has stored their coordinates.
 *
 * @param[in] turns  of each body, whether a joint turns it; NULL: none does
 */
ritz_status simulation_name_bodies(const simulation_task *task,
                                   const bool *turns, ritz_simulation *s);
/** Store the spin of the frame in which the motion is. */
void simulation_name_spin(const simulation_task *task, ritz_simulation *s);

/* A joint that moves: simulation_swept.c. */
bool simulation_sweep_asked(const simulation_options *given);
simulation_function simulation_sweep;

/** Set --at to the start of the path of --sweep, and --seconds to its end;
 * refuse a text that is no path. */
ritz_status simulation_sweep_prepare(cli_run *run, simulation_options *given);

/** Refuse a joint of --sweep that the scene has not, or that does not move. */
ritz_status simulation_sweep_check(const simulation_task *d);

/** Print what each integrator costs at the step that it needs. */
ritz_status simulation_say_costs(simulation_task *d, const double band_hz[2]);

/** Print what a second of the closed loop costs, split and by one exponential,
 * or sampled. @p step is used if no step is given. */
ritz_status simulation_say_loop_costs(simulation_task *d, double step);

/** The cost of a model, in the line of --record. */
ritz_status simulation_record_cost(cli_run *run, ritz_model subject,
                                   const double band_hz[2], ritz_cost *cost);

#endif
