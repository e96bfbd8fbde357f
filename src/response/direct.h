/*
 * Full matrices of a component, factored at any frequency: what the direct
 * engine samples, krylov projects and rational interpolates.
 */
#ifndef RITZ_RESPONSE_DIRECT_H
#define RITZ_RESPONSE_DIRECT_H

#include "poles/poles.h"

#include <ritz/matrix.h>

typedef struct ritz_direct {
    const ritz_component *component; /* borrowed */
    ritz_damping damping;
    ritz_zldl *Z;
    ritz_pairs pairs;
    ritz_poles poles; /* of the modes; their response is complete if `apart` */
    ritz_dense MPhi;  /* n x m */
    int64_t n, m, inputs;
    bool apart; /* neither D nor K4 nor Rayleigh damping */
    bool ratios;
    double _Complex *X; /* n x room, to work in */
    int64_t room;
    int64_t factors; /* how many were made */
} ritz_direct;

/** @param[in] up_to_hz  of the modes on which ratios act */
ritz_status ritz_direct_new(const ritz_component *component,
                            const ritz_damping *damping, double up_to_hz,
                            ritz_direct *out);

/** H at one frequency, which is zero before. @cost a complex factor */
ritz_status ritz_direct_at(ritz_direct *direct, double hertz,
                           double _Complex *H);

/**
 * X := Z(i w)^-1 X, n x k, one factor; if @p transposed by Z'. Where modes come
 * apart, this is what the rest answers: without the modes' share.
 */
ritz_status ritz_direct_solve(ritz_direct *direct, double hertz,
                              bool transposed, int64_t k, double _Complex *X);

/**
 * What rounding may be of the full answers of all inputs, X, and of the outputs
 * in the transposed system, Y.
 *
 * @param[out] out  outputs x inputs, row by row, of H
 */
ritz_status ritz_direct_noise(const ritz_direct *direct, double hertz,
                              const double _Complex *X, int64_t outputs,
                              const double _Complex *Y, double *out);

void ritz_direct_free(ritz_direct *direct);

#endif
