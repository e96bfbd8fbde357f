/*
 * Joined bodies in coordinates x of which the first are the violation c of the
 * constraints, as many as their rank. All x are orthonormal in the inner
 * product of the mass:
 *
 *     q = Phi V x,  Phi'M Phi = I,  V'V = I,    x = (c, p)
 *     x'' + D x' + K x = B u - (mu, 0),    c = 0
 *
 * Phi are the modes of the unjoined bodies. The first columns of V are an
 * orthonormal basis of the rows of C Phi. The terms of a stabilisation depend
 * on c and c' alone: they add to the diagonal of the first rows.
 */
#ifndef RITZ_SIMULATE_CONSTRAINED_H
#define RITZ_SIMULATE_CONSTRAINED_H

#include "simulate/motion.h"

#include <ritz/constrained.h>

#include <math.h>

typedef struct ritz_linked {
    ritz_motion motion; /* of the unjoined bodies in coordinates x, whose M = I
                           is not stored; an impulse acts on the joined ones */
    int64_t num_rows, rank;
    ritz_dense to;    /* coordinates of the bodies x n: x = to'q */
    ritz_dense G;     /* num_rows x n, C Phi V */
    ritz_dense L;     /* num_rows x rank: lambda = L mu has least length */
    ritz_dense reach; /* outputs x rank: what -mu adds to outputs that are
                          accelerations */
    ritz_dense peak;  /* rank x n, of V'Lambda^(1/2) V: forces along the
                         constraints that velocities can cause */
    double highest;   /* highest eigenvalue of the joined bodies */
    double unjoined;  /* highest eigenvalue of the unjoined bodies */
    int64_t num_redundant;
    int64_t *redundant;
} ritz_linked;

/** Set a parameter that is not given, which is NaN. */
static inline void ritz_gain_choose(double *gain, double value)
{
    if (isnan(*gain))
        *gain = value;
}

ritz_status ritz_linked_new(const ritz_unjoined *bodies, ritz_linked *out);
void ritz_linked_free(ritz_linked *joined);

/*
 * A stabilisation in the equation of c. With multipliers
 *
 *     c'' = - stiffness c - damping c' + g(c, c'),
 *
 * and without them, c_f'' being that of bodies on which it does not act,
 *
 *     (1 + inertia) c'' = c_f'' - stiffness c - damping c' + g(c, c').
 */
typedef struct ritz_stabiliser {
    bool multipliers; /* forces along the constraints are cancelled */
    bool projects;    /* c and c' are 0 at the start, and after each step */
    bool implicit;    /* index 2: an integrator of its own, without terms */
    double stiffness, damping, inertia;
    double stiffest; /* with multipliers: largest stiffness of c, with that of
                        the steepest part of g */
    double own[3];   /* parameters of the law */
    /** g of one constraint, and its derivatives by c and c'; NULL: 0. */
    void (*law)(const struct ritz_stabiliser *s, double c, double rate,
                double out[3]);
} ritz_stabiliser;

/**
 * The dense motion of bodies and stabilisation, to which any ritz_integrator
 * can be applied. If there is a law, the values g are further inputs after
 * those of the bodies.
 */
ritz_status ritz_stabilised_motion(const ritz_linked *joined,
                                   const ritz_stabiliser *s, ritz_motion *out);

/** Highest eigenvalue of the motion that ritz_stabilised_motion gives. */
ritz_status ritz_stabilised_highest(const ritz_linked *joined,
                                    const ritz_stabiliser *s, double *out);

/* Generalised-alpha of index 2, for a joined motion. */
typedef struct ritz_index2 {
    const ritz_linked *joined; /* borrowed */
    double step;
    ritz_newmark_weights w;
    ritz_general_factor S; /* n */
    int64_t num_memory;
    double *memory;          /* a, r and inputs at the end of the last step */
    double *a, *rate, *last; /* in memory */
    double *x, *v, *r;       /* n, work space */
} ritz_index2;

ritz_status ritz_index2_new(const ritz_linked *joined, double step, double rho,
                            ritz_index2 *out);
/** Compute the acceleration at the start. */
void ritz_index2_settle(ritz_index2 *s, const double *x, const double *v,
                        const double *u);
void ritz_index2_step(ritz_index2 *s, const double *u0, const double *u1,
                      double *x, double *v);
void ritz_index2_free(ritz_index2 *s);

/* g at the end of a step, as a further input that is linear over it. */
typedef struct ritz_law_step {
    int64_t rank;
    ritz_dense X, V;  /* rank x rank: what a unit g at the end adds to c, c' */
    ritz_dense J;     /* rank x rank, work space */
    double *c, *rate; /* rank: without g at the end */
    double *trial, *residual, *change; /* rank */
} ritz_law_step;

ritz_status ritz_law_step_new(int64_t rank, ritz_law_step *out);
/**
 * Solve g = law(c + X g, c' + V g) by Newton's method.
 *
 * @return RITZ_ERR_CONVERGENCE if it does not converge
 */
ritz_status ritz_law_step_solve(const ritz_stabiliser *s, ritz_law_step *l,
                                double *g);
void ritz_law_step_free(ritz_law_step *l);

/**
 * A march of joined bodies, during which @p joined and @p terms must exist. The
 * initial values of its request are coordinates x.
 */
ritz_status ritz_constrained_march(const ritz_linked *joined,
                                   const ritz_stabiliser *terms,
                                   const ritz_simulation_request *request,
                                   ritz_march *out);

#endif
