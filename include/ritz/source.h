/*
 * Where the models that a scene names come from. Assembly and reduction ask a
 * source and open no file; ritz_container_source answers from containers, and
 * a program may answer from memory.
 */
#ifndef RITZ_SOURCE_H
#define RITZ_SOURCE_H

#include <ritz/component.h>
#include <ritz/reduced.h>

#pragma GCC visibility push(default)

typedef struct ritz_source {
    void *state; /* given to each function */
    /** "component" or "reduced", what the model called @p name is. */
    ritz_status (*kind)(void *state, const char *name,
                        char kind[static RITZ_NAME_SIZE]);
    /** A full model, settled; the caller frees it. */
    ritz_status (*component)(void *state, const char *name,
                             ritz_component *out);
    /** A reduced model with all of its columns; the caller frees it. */
    ritz_status (*reduced)(void *state, const char *name, ritz_reduced *out);
} ritz_source;

#pragma GCC visibility pop

#endif
