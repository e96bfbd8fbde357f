/*
 * Full models of a scene of which synthesis sees only the dofs of their ports.
 */
#ifndef RITZ_ASSEMBLY_HELD_H
#define RITZ_ASSEMBLY_HELD_H

#include <ritz/synthesis.h>

/* The bodies, and the dofs at which they may meet. */
typedef struct ritz_held {
    const ritz_scene *scene;
    int64_t count;
    ritz_component *body;
    ritz_dofs *held;  /* dofs of all ports of each body */
    int64_t *first;   /* of each body's dofs among all N */
    int64_t num_dofs; /* N */
    ritz_stage stage; /* whose coordinates are the held dofs */
    int64_t *row;     /* of each such coordinate among all N */
} ritz_held;

/** Load the full models and find where they are held. */
ritz_status ritz_held_load(const ritz_scene *scene, ritz_held *out);

/**
 * What the bodies' eliminated dofs follow: diag(G_k) T.
 *
 * @param[in] add  by how much the grid numbers of each body grow
 * @param[in] T    all dofs of all bodies x those of the system
 */
ritz_status ritz_held_recovery(const ritz_held *p, const int64_t *add,
                               const ritz_sparse *T, ritz_recovery *out);

void ritz_held_free(ritz_held *p);

#endif
