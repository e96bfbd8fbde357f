/* Answers of the modes that were left out: see residual.c for the series. */
#ifndef RITZ_POLES_REST_SOLVER_H
#define RITZ_POLES_REST_SOLVER_H

#include "poles/poles.h"

#include <ritz/factor.h>

/* Of the whole answer at the end of the range, what its series is good to. */
#define RITZ_SERIES_WITHIN 1e-12

typedef struct ritz_rest_solver {
    const ritz_sparse *M;  /* borrowed, as Phi is */
    const ritz_dense *Phi; /* the modes that are known */
    ritz_dense MPhi;
    ritz_factor *F;
    double sigma;
    double *whole; /* of each input, what all modes and R_0 answer at the end */
    bool begun;    /* R_0 is known */
} ritz_rest_solver;

/**
 * @param[in] to_hz   the end of the range
 * @param[in] out_hz  all modes up to here are in @p pairs
 */
ritz_status ritz_rest_solver_new(const ritz_component *component,
                                 const ritz_pairs *pairs, double to_hz,
                                 double out_hz, ritz_rest_solver *solver);

/**
 * K out = f in the space of what was left out, where @p f is made to lie: the
 * next term of the series, of all inputs, in units of what it adds at the end.
 *
 * @return RITZ_ERR_CONVERGENCE if steps do not settle
 */
ritz_status ritz_rest_solve(ritz_rest_solver *solver, ritz_dense *f,
                            ritz_dense *out);

void ritz_rest_solver_free(ritz_rest_solver *solver);

#endif
