/*
 * One damped mode, q'' + d q' + lambda q = f, propagated exactly over h while f
 * changes linearly, at rate g:
 *
 *     q_1  = (S' + d S) q_0 +      S  v_0 + P f + R g
 *     v_1  =   -lambda S q_0 +     S' v_0 + S f + P g
 *
 * S is the response of q to a unit velocity, S' its rate, P and R its first and
 * second integral.
 */
#ifndef RITZ_SIMULATE_OSCILLATOR_H
#define RITZ_SIMULATE_OSCILLATOR_H

typedef struct ritz_oscillator {
    double hold; /* S' + d S */
    double S, rate, P, R;
} ritz_oscillator;

/* * For any real lambda and d, without loss of digits where roots meet or
   vanish. */
ritz_oscillator ritz_oscillator_over(double lambda, double d, double h);

#endif
