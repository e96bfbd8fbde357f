/*
 * Bodies in a frame that turns about a fixed axis, at rate W(t) about n.
 *
 * With v_k the motion of column k and x the position from the axis, small
 * motions q in the turning frame follow
 *
 *     M q'' + (D + W G) q' + (K + W^2 (S + KG) + W' G / 2) q
 *         = B u + W^2 centrifugal + W' euler
 *
 *     G_jk           = 2 int v_j . (n x v_k) dm                  skew
 *     S_jk           = -int (n x v_j) . (n x v_k) dm             softening
 *     centrifugal_j  = -int v_j . (n x (n x x)) dm
 *     euler_j        = -int v_j . (n x x) dm
 *
 * KG is the geometric stiffness of the centrifugal load at W = 1.
 */
#ifndef RITZ_SPIN_H
#define RITZ_SPIN_H

#include <ritz/matrix.h>

#include <stdbool.h>
#include <stdint.h>

#pragma GCC visibility push(default)

/* Which terms are kept [PadillaVonFlotow1992, Sharf1992]. */
typedef enum ritz_spin_model {
    RITZ_SPIN_CONSISTENT,   /* all of them */
    RITZ_SPIN_INCONSISTENT, /* all but KG: linearised too early */
    RITZ_SPIN_RUTHLESS,     /* loads alone: neither G, S nor KG */
} ritz_spin_model;

/* A rate of rotation over time, rad/s. */
typedef enum ritz_spin_course {
    RITZ_SPIN_CONSTANT, /* value[0] */
    RITZ_SPIN_PROFILE,  /* linear between points, constant outside */
    RITZ_SPIN_RAMP,     /* value[0] (s - sin(2 pi s) / (2 pi)), s = t / time[0],
                           then value[0] */
} ritz_spin_course;

typedef struct ritz_spin_rate {
    ritz_spin_course course;
    int64_t count;
    double *time, *value; /* count, times ascending */
} ritz_spin_rate;

/** Rate at time @p t >= 0. */
double ritz_spin_rate_at(const ritz_spin_rate *rate, double t);

/** Derivative of the rate; at a corner of a profile, the slope after it. */
double ritz_spin_acceleration_at(const ritz_spin_rate *rate, double t);

/** Angle turned since t = 0, rad. */
double ritz_spin_angle_at(const ritz_spin_rate *rate, double t);

void ritz_spin_rate_free(ritz_spin_rate *rate);

/* Spin terms in r coordinates, at W = 1 and W' = 1. */
typedef struct ritz_spin_terms {
    ritz_dense G, S, KG; /* r x r; KG {0}: none */
    ritz_dense load;     /* r x 2: centrifugal, euler */
    double inertia;      /* about the axis, undeformed */
} ritz_spin_terms;

/** Keep the terms of a spin model; the others become {0}. */
void ritz_spin_terms_keep(ritz_spin_model model, ritz_spin_terms *terms);

/** Add the terms of a body whose coordinates are P x to @p sum. */
ritz_status ritz_spin_terms_add(const ritz_spin_terms *body,
                                const ritz_dense *P, ritz_spin_terms *sum);

/* Rates that limit a model, rad/s; HUGE_VAL: none does. */
typedef struct ritz_spin_limits {
    double stable;     /* from this rate on K + W^2 (S + KG) is not positive
                          definite; 0: it is not positive definite at rest */
    double negligible; /* up to this rate, leaving out KG changes no frequency
                          by more than the relative error */
} ritz_spin_limits;

/**
 * Rates that limit a model whose stiffness is definite. With d = (1 + e)^2 - 1,
 *
 *     d K + W^2 (d S - KG) >= 0
 *
 * implies, by the theorem of Courant and Fischer, that each frequency of K +
 * W^2 (S + KG) is at most 1 + e times the frequency of the same number of K +
 * W^2 S. A similar condition bounds frequencies from below. Both need K + W^2 S
 * to be definite, so that `negligible` is at most the rate at which it is not.
 *
 * @param[in] modes  n x k: modes of the band, in whose space rates are found;
 *                   NULL: in that of all coordinates
 * @param[in] error  e
 * @cost  O(n^3)
 */
ritz_status ritz_spin_limits_of(const ritz_spin_terms *terms,
                                const ritz_dense *K, const ritz_dense *modes,
                                double error, ritz_spin_limits *out);

void ritz_spin_terms_free(ritz_spin_terms *terms);

#pragma GCC visibility pop

#endif
