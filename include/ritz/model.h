/*
 * A model of any kind: a header for each object, and a reference to any of
 * them.
 */
#ifndef RITZ_MODEL_H
#define RITZ_MODEL_H

#include <ritz/component.h>
#include <ritz/reduced.h>
#include <ritz/state_space.h>
#include <ritz/subspace.h>
#include <ritz/system.h>

#include <stdint.h>

#pragma GCC visibility push(default)

/*
 * A modal model: each flexible mode by itself, with modal damping.
 *
 *     q_k'' + 2 zeta_k omega_k q_k' + omega_k^2 q_k = b_k u,
 *     y = sum_k c_k q_k + cv_k q_k' + ca_k q_k''
 */

/*
 * Flexible modes of a model and their participation in inputs and outputs.
 * Where damping couples rigid modes to flexible ones, the rigid modes follow
 * the flexible ones in the rows of B, the columns of C and Cv, and in Delta.
 */
typedef struct ritz_modal {
    int64_t count;     /* m */
    double *omega;     /* m, ascending, positive  [rad/s] */
    double *zeta;      /* m, from the diagonal of damping; positive unless
                          damping couples modes */
    ritz_dense B;      /* m + r x inputs, inputs scaled by their weights */
    ritz_dense C, Cv;  /* outputs x m + r, divided by limits. Acceleration
                          outputs are expressed by displacements and velocities,
                          without their feedthrough */
    int64_t num_rigid; /* r */
    ritz_dense Delta;  /* m + r x m + r, Phi'D Phi; {0}: damping couples no
                          modes and is diag(2 zeta omega) */
    ritz_dense Ca;     /* outputs x m + r: the accelerations that C and Cv
                          express; {0} if Delta is */
} ritz_modal;

/*
 * Small dense matrices and what drives and observes them, borrowed; D, K4 NULL
 * or {0}: there is none.
 */
typedef struct ritz_second_order {
    const ritz_dense *K, *M, *D, *K4;
    const ritz_io *io;
} ritz_second_order;

typedef enum ritz_model_kind {
    RITZ_MODEL_COMPONENT = 1, /* full and sparse */
    RITZ_MODEL_DENSE = 2,     /* a reduced component, or a configuration */
    RITZ_MODEL_STATES = 4,
} ritz_model_kind;

/*
 * A model of any kind whose poles, zeros, response or motion is wanted: a
 * reference that borrows all it names and is passed by value. Dampers act as
 * far as they are installed.
 */
typedef struct ritz_model {
    ritz_model_kind kind;
    union {
        const ritz_component *component;
        ritz_second_order dense;
        const ritz_state_space *states;
    };
    const ritz_reduced
        *reduced; /* whose matrices `dense` are; NULL: no one's */
    const ritz_dampers *dampers; /* of second order; NULL: none */
    const ritz_damping *damping; /* in addition to that of matrices; NULL: none.
                                    Of a state space it is in A */
} ritz_model;

ritz_model ritz_model_of_component(const ritz_component *component,
                                   const ritz_damping *damping);
ritz_model ritz_model_of_reduced(const ritz_reduced *reduced,
                                 const ritz_damping *damping);
ritz_model ritz_model_of_configuration(const ritz_configuration *configuration,
                                       const ritz_damping *damping);
ritz_model ritz_model_of_dense(const ritz_second_order *matrices,
                               const ritz_damping *damping);
ritz_model ritz_model_of_states(const ritz_state_space *states);

/** Number of dofs, reduced coordinates or states. */
int64_t ritz_model_order(ritz_model model);

/** Inputs and outputs, borrowed; names and limits alone of a state space. */
ritz_io ritz_model_io(ritz_model model);

/**
 * The model in dense first-order form: @p model itself if it is a dense state
 * space, else a new one written to @p made, which the caller frees.
 *
 * @return as ritz_state_space_of_component, or as ritz_state_space_dense
 */
ritz_status ritz_model_states(ritz_model model, ritz_state_space *made,
                              const ritz_state_space **out);

#pragma GCC visibility pop

#endif
