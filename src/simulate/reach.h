/*
 * The largest value that a motion could give an output; its rounding is
 * relative to that: with |x|^2 = x'M x, and M in M^-1 by its diagonal alone,
 *
 *     |c x + cv x' + ca x''| <= |c| |x| + |cv| |x'| + |ca| |x''|,
 *     |c|^2 = c M^-1 c',
 *
 * and of dofs without mass by the strain energy, with x'K x and K. Units of
 * dofs, of outputs and of time cancel. Of a state space sum |c_j| |x_j|.
 */
#ifndef RITZ_SIMULATE_REACH_H
#define RITZ_SIMULATE_REACH_H

#include "simulate/motion.h"

typedef struct ritz_reach {
    int64_t count;  /* outputs */
    double *weight; /* 4 x count: |c|, |cv|, |ca| and |c| by K; NULL: of
                          states */
    double *size;   /* count: what could be shown, at the most so far */
    double *last;   /* n: velocities when it was last noted */
    double *work;   /* n */
    double seconds; /* when that was */
} ritz_reach;

ritz_status ritz_reach_new(ritz_model subject, const ritz_motion *motion,
                           ritz_reach *out);

void ritz_reach_free(ritz_reach *reach);

#endif
