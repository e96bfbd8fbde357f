/*
 * Parts of engine projection, Gramians of large components by projection on a
 * Krylov space. projection.c has the equations.
 */
#ifndef RITZ_GRAMIANS_PROJECTION_H
#define RITZ_GRAMIANS_PROJECTION_H

#include "gramians/low_rank_parts.h"
#include "gramians/modes.h"

#include <ritz/matrix.h>

/* A component with D = a M + b K + P diag(c) P', and its loads. */
typedef struct ritz_projection_model {
    ritz_low_rank_model low; /* matrices, loads, rigid-body modes */
    double a, b;             /* [rad/s], [s] */
    ritz_dense P;            /* n x d, influence vectors of dampers */
    double *c;               /* d numbers, damping constants, positive */
    int64_t inputs, outputs; /* numbers of them */
    int64_t most;            /* largest number of vectors, limited by memory */
} ritz_projection_model;

/**
 * @return RITZ_ERR_ARGUMENT as ritz_low_rank_model_new(), or if D is not of
 *         that form or leaves a mode without damping
 */
ritz_status ritz_projection_model_new(const ritz_gramians_request *request,
                                      ritz_projection_model *out);

/**
 * Whether D of a request has that form, b >= 0, and a or b is above 0.
 *
 * @cost O(nnz)
 */
ritz_status ritz_projection_fits(const ritz_gramians_request *request,
                                 bool *fits);

void ritz_projection_model_free(ritz_projection_model *model);

/* Basis V of a block Krylov space of K_s^-1 M, V'K_s V = I, K_s = K + mu M. */
typedef struct ritz_projection_space {
    const ritz_projection_model *model; /* borrowed */
    double mu;                          /* [rad^2/s^2] */
    ritz_sparse Ks;
    ritz_factor *F;
    int64_t count, room; /* columns of V in use, and allocated */
    int64_t last;        /* columns before the last block: m of the projection,
                            as the last block serves for the residual alone */
    ritz_dense V;        /* n x room */
    ritz_dense T;        /* room x room, V'M V of the first `last` columns */
    ritz_dense coupling; /* v'M v_before, v the last block of V */
    ritz_dense loads;    /* room x (inputs + 2 outputs + d): V'F */
} ritz_projection_space;

ritz_status ritz_projection_space_new(const ritz_projection_model *model,
                                      ritz_projection_space *out);

/**
 * Add a block to V. If it has no columns (count == last) the space is
 * invariant, and the projection is exact.
 *
 * @return RITZ_ERR_CONVERGENCE if V would have more columns than model->most;
 *         RITZ_ERR_MEMORY
 */
ritz_status ritz_projection_space_extend(ritz_projection_space *space);

/**
 * Add the solutions of (K + m M) x = F for all loads F to the last block of V.
 * As K_s^-1 M x is a combination of x and K_s^-1 F, which V contains, they add
 * nothing to the residual. ritz_projection_space_extend() must follow.
 *
 * @param[in] m  above 0  [rad^2/s^2]
 * @return as ritz_projection_space_extend()
 * @cost   a factor of K + m M
 */
ritz_status ritz_projection_space_shift(double m, ritz_projection_space *space);

void ritz_projection_space_free(ritz_projection_space *space);

/*
 * The projected model in modal coordinates: T = U Theta U',
 * Phi = V U Theta^-1/2, Phi'M Phi = I, Phi'K Phi = Lambda, and its residuals in
 * the equations of the large model,
 *
 *     K Phi = M Phi Lambda - q L,    F = M Phi Phi'F - q L Theta Phi'F,
 *
 * with Theta = (Lambda + mu)^-1 and q = K_s v, v the last block of V, V'q = 0.
 */
typedef struct ritz_projected {
    int64_t count;       /* m */
    double a, b, mu;     /* of D = a M + b K and K_s = K + mu M */
    double lowest;       /* lowest flexible eigenvalue of the large model */
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

/** The same as a ritz_modal, for the closed forms of Gramians. */
ritz_status ritz_projected_modal(const ritz_projected *projected,
                                 ritz_modal *out);

/**
 * The largest bound of |G(i w) - G_V(i w)| over sampled frequencies, G the
 * transfer matrix of the large model and G_V that of the projected one. The
 * error of a Hankel value is at most the Hankel norm of G - G_V, which is at
 * most the largest |G - G_V| over all w.
 *
 * @cost O(m^2 p (inputs + outputs))
 */
ritz_status ritz_projected_bound(const ritz_projected *projected, double *out);

/**
 * Residuals of both Lyapunov equations of the large model, as
 * ritz_gramians_of_component() states them.
 *
 * @param[in]  factors  Zc and Zo of ritz_projected_modal()
 * @param[out] out      relative to B B' and to C'C
 * @cost   O(m^2 p)
 */
ritz_status ritz_projected_residuals(const ritz_projected *projected,
                                     const ritz_gramians *factors,
                                     double out[static RITZ_SIDES]);

/**
 * The real shift m at which the static solutions (K + m M)^-1 F of the
 * projected model are worst.
 *
 * @param[out] shift     [rad^2/s^2]
 * @param[out] residual  of that solution, relative to its load
 * @see    [DruskinSimoncini2011]
 */
ritz_status ritz_projected_shift(const ritz_projected *projected, double *shift,
                                 double *residual);

#endif
