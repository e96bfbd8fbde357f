/*
 * Full matrices of a component, factored at any frequency: the direct engine
 * samples them, krylov projects them and rational interpolates them.
 */
#ifndef RITZ_RESPONSE_DIRECT_H
#define RITZ_RESPONSE_DIRECT_H

#include "poles/poles.h"

#include <ritz/matrix.h>

typedef struct ritz_direct {
    const ritz_component *component; /* borrowed */
    ritz_damping damping;
    double a, b; /* of Rayleigh damping, else 0 */
    ritz_zldl *Z;
    ritz_pairs pairs;
    ritz_poles poles; /* of modes; with their response if `apart` */
    ritz_dense MPhi;  /* n x m */
    int64_t n, m, inputs;
    bool apart; /* neither D nor K4 nor Rayleigh damping */
    bool ratios;
    double _Complex *X; /* n x inputs, to work in */
} ritz_direct;

/** @param[in] up_to_hz  bound of the modes on which damping ratios act */
ritz_status ritz_direct_new(const ritz_component *component,
                            const ritz_damping *damping, double up_to_hz,
                            ritz_direct *out);

/**
 * Add H at one frequency to an array of zeros. @cost a complex factorization
 */
ritz_status ritz_direct_at(ritz_direct *direct, double hertz,
                           double _Complex *H);

/**
 * X := Z(i w)^-1 X, n x k, by one factorization; with Z' if @p transposed.
 * Where the modes are decoupled this is the response of the rest alone, without
 * the modes' part.
 */
ritz_status ritz_direct_solve(ritz_direct *direct, double hertz,
                              bool transposed, int64_t k, double _Complex *X);

/**
 * Estimate of the rounding error of H, from the full responses X to all inputs
 * and Y of the transposed system to all outputs.
 *
 * @param[out] out  outputs x inputs, row by row, of H
 */
ritz_status ritz_direct_noise(const ritz_direct *direct, double hertz,
                              const double _Complex *X, int64_t outputs,
                              const double _Complex *Y, double *out);

void ritz_direct_free(ritz_direct *direct);

#endif
