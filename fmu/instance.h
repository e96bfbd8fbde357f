/* SPDX-License-Identifier: 0BSD */
/*
 * An instance of a model, and the operations on it that both versions of FMI
 * have. Value reference 0 is the time; from 1 on the references count first the
 * inputs, then the outputs, the states and the derivatives of the states. A
 * status is the same number in both versions. A function that does not return
 * FMU_OK has logged a sentence that says why. Instances share no memory.
 */
#ifndef RITZ_FMU_INSTANCE_H
#define RITZ_FMU_INSTANCE_H

#include "propagate.h"

typedef enum fmu_status {
    FMU_OK = 0,
    FMU_ERROR = 3,
} fmu_status;

/* A model without events does the same in the event, continuous-time and step
   modes of the standard: they are one mode here, FMU_RUNNING. */
typedef enum fmu_mode {
    FMU_INSTANTIATED,
    FMU_INITIALISING,
    FMU_RUNNING,
    FMU_TERMINATED,
} fmu_mode;

/* A function of any type: the importer's logger, whose type depends on the
 * version. */
typedef void fmu_function(void);

/* Calls the importer's logger with the arguments that one version of FMI
   prescribes. */
typedef void fmu_logger(fmu_function *callback, void *environment,
                        const char *name, fmu_status status, const char *text);

typedef struct fmu_callback {
    fmu_logger *log;
    fmu_function *callback; /* NULL: none */
    void *environment;
} fmu_callback;

typedef struct fmu_instance {
    fmu_model model;
    fmu_steps steps;
    fmu_mode mode;
    bool steps_itself; /* co-simulation */
    double time;
    double *x, *u; /* states, inputs */
    double *work;  /* as long as x; the result of a step */
    char *name;
    fmu_callback to;
} fmu_instance;

/* Arguments with which an importer instantiates the model. */
typedef struct fmu_request {
    const char *name, *token;
    const char *resources; /* path or URI of the folder */
    bool is_uri, steps_itself;
    fmu_callback to;
} fmu_request;

/** A new instance; NULL, with a sentence for the logger, if the resources
 * cannot be read or belong to another instantiation token. */
fmu_instance *fmu_new(const fmu_request *request);
void fmu_free(fmu_instance *instance);

/** Log a sentence. @return FMU_ERROR */
fmu_status fmu_complain(const fmu_instance *instance, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/** FMU_ERROR unless the instance is in a mode; @p function is named in the
 * sentence. */
fmu_status fmu_expect(const fmu_instance *instance, fmu_mode mode,
                      const char *function);

/** FMU_ERROR unless the instance is running and for model exchange. */
fmu_status fmu_expect_exchange(const fmu_instance *instance,
                               const char *function);

/** Go from one mode to another; FMU_ERROR if the instance is NULL or not in
 * mode @p from. */
fmu_status fmu_change_mode(fmu_instance *instance, fmu_mode from, fmu_mode to,
                           const char *function);

/** Set inputs, states and time to 0 and the mode to FMU_INSTANTIATED. */
fmu_status fmu_reset(fmu_instance *instance);

fmu_status fmu_set_time(fmu_instance *instance, double time);
fmu_status fmu_get(const fmu_instance *instance, const unsigned *reference,
                   size_t count, double *value);
fmu_status fmu_set(fmu_instance *instance, const unsigned *reference,
                   size_t count, const double *value);

/* Of all states at once; FMU_ERROR unless the model has @p count states. */

fmu_status fmu_set_states(fmu_instance *instance, const double *x,
                          size_t count);
fmu_status fmu_get_states(const fmu_instance *instance, double *x,
                          size_t count);
fmu_status fmu_get_nominals(const fmu_instance *instance, double *x,
                            size_t count);
fmu_status fmu_get_derivatives(const fmu_instance *instance, double *dx,
                               size_t count);

/** Advance by a step h > 0 from time @p from, while the inputs stay constant.
 * If that fails, time and states are as before. */
fmu_status fmu_do_step(fmu_instance *instance, double from, double h);

/* Value references of the variables that a Jacobian relates: unknowns are
   outputs and derivatives, knowns are inputs and states. */
typedef struct fmu_partials {
    const unsigned *unknown, *known;
    size_t num_unknowns, num_knowns;
} fmu_partials;

/**
 * With J = d unknown / d known: out = J seed, one number for each unknown; if
 * @p adjoint, out = J' seed, one number for each known.
 */
fmu_status fmu_differentiate(const fmu_instance *instance,
                             const fmu_partials *partials, bool adjoint,
                             const double *seed, double *out);

/**
 * Inputs and states on which an output or a derivative depends with a
 * coefficient that is not zero.
 *
 * @param[out] known  their references; NULL: they are counted only
 */
fmu_status fmu_dependencies(const fmu_instance *instance, unsigned unknown,
                            unsigned *known, size_t *count);

/*
 * A state of an instance is kept as bytes, which the importer owns through a
 * pointer. Each function fails if the instance or the state is NULL.
 */

/** Keep what the instance is now, in new bytes if *state is NULL. */
fmu_status fmu_state_get(const fmu_instance *instance, void **state);

/** Return to a kept state. */
fmu_status fmu_state_set(fmu_instance *instance, const void *state);

/** Free a state and set *state to NULL. */
fmu_status fmu_state_free(const fmu_instance *instance, void **state);

/** How many bytes a state has. */
fmu_status fmu_state_size(const fmu_instance *instance, const void *state,
                          size_t *size);

/** Copy a state to the first of @p size bytes, which an importer may store. */
fmu_status fmu_state_serialize(const fmu_instance *instance, const void *state,
                               unsigned char *bytes, size_t size);

/** The state that such bytes hold; FMU_ERROR if they are no state of the
 * model. */
fmu_status fmu_state_deserialize(const fmu_instance *instance,
                                 const unsigned char *bytes, size_t size,
                                 void **state);

#endif
