/* The largest singular value of a stable model's response, along the axis. */
#ifndef RITZ_POLES_PEAK_H
#define RITZ_POLES_PEAK_H

#include "linear/split.h"

#include <complex.h>
#include <stdbool.h>

/* C (i w P - S)^-1 B + D, S and P complex triangular. */
typedef struct ritz_peak {
    int n, m, p;
    double _Complex *S, *P, *B, *C, *D; /* P NULL: the identity */
    double _Complex *T, *X, *H;         /* to work in */
    bool begun;                         /* T has its triangle */
    double *sigma, *spare;
    double w, value; /* the largest that was met, and where */
} ritz_peak;

/** Of the stable part, B and C in its coordinates. */
ritz_status ritz_peak_new(const ritz_split *split, const ritz_dense *B,
                          const ritz_dense *C, const ritz_dense *D,
                          ritz_peak *out);

/** Largest singular value at @p w [rad/s], HUGE_VAL: of D; it is remembered if none is larger.
 * @cost O(n^2) an input */
ritz_status ritz_peak_at(ritz_peak *peak, double w, double *value);

/**
 * At 0, far out, at every pole, and between neighbours of the highest of these until
 * nothing is gained: the value is met, so the norm is at least that.
 */
ritz_status ritz_peak_search(ritz_peak *peak);

void ritz_peak_free(ritz_peak *peak);

#endif
