/* SPDX-License-Identifier: 0BSD */
/*
 * An instance of a model, and what both versions of FMI do with it. Value
 * references are: 0 the time, then inputs, outputs, states, derivatives of
 * states, from 1 on. Functions return a status that is the same number in both
 * versions, and log a sentence if it is not FMU_OK. Nothing is shared between
 * instances.
 */
#ifndef RITZ_FMU_INSTANCE_H
#define RITZ_FMU_INSTANCE_H

#include "propagate.h"

typedef enum fmu_status {
    FMU_OK = 0,
    FMU_ERROR = 3,
} fmu_status;

typedef enum fmu_mode {
    FMU_INSTANTIATED,
    FMU_INITIALISING,
    FMU_RUNNING,
    FMU_TERMINATED,
} fmu_mode;

/* A function of any type: the importer's logger, whose type depends on the
 * version. */
typedef void fmu_function(void);

/* How sentences reach the importer, by the callback of one version. */
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
    double *work;  /* states */
    char *name;
    fmu_callback to;
} fmu_instance;

/* How an importer requests a new instance. */
typedef struct fmu_request {
    const char *name, *token;
    const char *resources; /* path or URI of the folder */
    bool is_uri, steps_itself;
    fmu_callback to;
} fmu_request;

/** NULL, and a sentence to the logger, if the resources are not those of the
 * token. */
fmu_instance *fmu_new(const fmu_request *request);
void fmu_free(fmu_instance *instance);

/** Log a sentence. @return FMU_ERROR */
fmu_status fmu_complain(const fmu_instance *instance, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/** FMU_ERROR unless the instance is in a mode. */
fmu_status fmu_expect(const fmu_instance *instance, fmu_mode mode,
                      const char *function);

/** Inputs and states 0, time 0, instantiated. */
fmu_status fmu_reset(fmu_instance *instance);

fmu_status fmu_set_time(fmu_instance *instance, double time);
fmu_status fmu_get(const fmu_instance *instance, const unsigned *reference,
                   size_t count, double *value);
fmu_status fmu_set(fmu_instance *instance, const unsigned *reference,
                   size_t count, const double *value);

/** All states at once. @return FMU_ERROR unless there are @p count */
fmu_status fmu_set_states(fmu_instance *instance, const double *x,
                          size_t count);
fmu_status fmu_get_states(const fmu_instance *instance, double *x,
                          size_t count);
fmu_status fmu_get_nominals(const fmu_instance *instance, double *x,
                            size_t count);
fmu_status fmu_get_derivatives(const fmu_instance *instance, double *dx,
                               size_t count);

/** One step with inputs held; states stay what they were if it fails. */
fmu_status fmu_do_step(fmu_instance *instance, double from, double h);

/* Unknowns (outputs, derivatives) and knowns (inputs, states), by reference. */
typedef struct fmu_partials {
    const unsigned *unknown, *known;
    size_t num_unknowns, num_knowns;
} fmu_partials;

/** @p out of unknowns is the derivative times @p seed of knowns; of
 * @p adjoint, @p out of knowns its transpose times @p seed of unknowns. */
fmu_status fmu_differentiate(const fmu_instance *instance,
                             const fmu_partials *partials, bool adjoint,
                             const double *seed, double *out);

/** Non-zero dependencies of a reference, and which; @p known may be NULL. */
fmu_status fmu_dependencies(const fmu_instance *instance, unsigned unknown,
                            unsigned *known, size_t *count);

/* All that changes in an instance, as bytes. */
size_t fmu_state_size(const fmu_instance *instance);
void fmu_state_save(const fmu_instance *instance, unsigned char *bytes);
fmu_status fmu_state_check(const fmu_instance *instance,
                           const unsigned char *bytes, size_t size);
fmu_status fmu_state_load(fmu_instance *instance, const unsigned char *bytes);

#endif
