/*
 * The family of Newmark and generalised-alpha integrators: with z_b =
 * (1 - b) z_1 + b z_0,
 *
 *     M a_(alpha_m) + D v_(alpha_f) + K x_(alpha_f) = B u_(alpha_f)
 *     x_1 = x_0 + h v_0 + h^2 ((1/2 - beta) a_0 + beta a_1)
 *     v_1 = v_0 + h ((1 - gamma) a_0 + gamma a_1)
 */
#ifndef RITZ_SIMULATE_NEWMARK_H
#define RITZ_SIMULATE_NEWMARK_H

#include "simulate/motion.h"

typedef struct ritz_newmark {
    double alpha_m, alpha_f, beta, gamma;
} ritz_newmark;

/** A march by these weights. @return RITZ_ERR_SINGULAR */
ritz_status ritz_newmark_start(const ritz_motion *motion, double step,
                               const ritz_newmark *weights, ritz_march *out);

#endif
