/*
 * Parts of the engine that projects: see projection.c for the equations.
 */
#ifndef RITZ_GRAMIANS_PROJECTION_H
#define RITZ_GRAMIANS_PROJECTION_H

#include "gramians/low_rank_parts.h"
#include "gramians/modes.h"

#include <ritz/matrix.h>

/* D = a M + b K + P diag(c) P', and the loads whose responses are wanted. */
typedef struct ritz_projection_model {
    ritz_low_rank_model low; /* matrices, loads, rigid motion */
    double a, b;             /* [rad/s], [s] */
    ritz_dense P;            /* n x d, influence vectors of dampers */
    double *c;               /* d, positive */
    int64_t inputs, outputs;
    int64_t most; /* vectors of a space, for memory */
} ritz_projection_model;

/**
 * @return RITZ_ERR_ARGUMENT as ritz_low_rank_model_new, and if D is not of
 *         that form or leaves a mode without damping
 */
ritz_status ritz_projection_model_new(const ritz_gramians_request *request,
                                      ritz_projection_model *out);

/** Whether the damping of a request has that form. @cost O(nnz) */
ritz_status ritz_projection_fits(const ritz_gramians_request *request,
                                 bool *fits);

void ritz_projection_model_free(ritz_projection_model *model);

/* Block Krylov space V of K_s^-1 M, orthonormal in K_s = K + mu M. */
typedef struct ritz_projection_space {
    const ritz_projection_model *model; /* borrowed */
    double mu;                          /* [rad^2/s^2] */
    ritz_sparse Ks;
    ritz_factor *F;
    int64_t count, room; /* columns of V, and those that there is memory for */
    int64_t last;        /* columns before the last block: the projection */
    ritz_dense V;        /* n x room */
    ritz_dense T;        /* room x room, V'MV without its last block */
    ritz_dense coupling; /* last block'M(block before it) */
    ritz_dense loads;    /* room x (inputs + 2 outputs + d): V'F */
} ritz_projection_space;

ritz_status ritz_projection_space_new(const ritz_projection_model *model,
                                      ritz_projection_space *out);

/** One more block. A last block without columns: the space is invariant. */
ritz_status ritz_projection_space_extend(ritz_projection_space *space);

void ritz_projection_space_free(ritz_projection_space *space);

/*
 * The model in the space: Phi = V T^-1/2 in principal axes, Phi'M Phi = I,
 * Phi'K Phi = Lambda, and what it leaves in the large equations,
 *
 *     K Phi = M Phi Lambda - q L,    F = M Phi Phi'F - q L Theta Phi'F,
 *
 * with Theta = (Lambda + mu)^-1 and q = K_s v of the last block, V'q = 0.
 */
typedef struct ritz_projected {
    int64_t count;       /* m */
    double a, b, mu;     /* of D and K_s */
    double lowest;       /* eigenvalue of the large model */
    double *lambda;      /* m */
    double *theta;       /* m */
    ritz_dense Y;        /* m x m, Phi = V Y */
    ritz_dense L;        /* p x m */
    ritz_dense B, C, Cv; /* m x inputs, m x outputs: Phi'F */
    ritz_dense P;        /* m x d */
    const double *c;     /* d, borrowed */
} ritz_projected;

ritz_status ritz_projected_new(const ritz_projection_space *space,
                               ritz_projected *out);
void ritz_projected_free(ritz_projected *projected);

/** The same as a model in modal coordinates. */
ritz_status ritz_projected_modal(const ritz_projected *projected,
                                 ritz_modal *out);

/* How far the projected model is from the large one. */
typedef struct ritz_projected_error {
    double bound;       /* of any Hankel value */
    double residual[2]; /* of the responses to B and to C' + i w Cv' where the
                           bound is reached, over the load, both in the norm of
                           K_s^-1 */
} ritz_projected_error;

/**
 * Bound of |G(i w) - G_V(i w)|, G the transfer functions of the large model
 * and G_V those of the projected one, over sampled frequencies. No Hankel value
 * errs by more, as their errors are below the Hankel norm of G - G_V.
 *
 * @cost O(m^2 p (inputs + outputs))
 */
ritz_status ritz_projected_bound(const ritz_projected *projected,
                                 ritz_projected_error *out);

#endif
