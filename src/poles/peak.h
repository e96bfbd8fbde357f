/*
 * Peak of a transfer function: search for the largest singular value over all
 * frequencies. The result is a lower bound.
 */
#ifndef RITZ_POLES_PEAK_H
#define RITZ_POLES_PEAK_H

#include <ritz/base.h>

#include <stdint.h>

typedef struct ritz_peak {
    int64_t outputs, inputs;
    /** H at some frequencies w [rad/s], the last of which may be infinite:
     * outputs x inputs, column-major, for each frequency. */
    ritz_status (*respond)(void *state, int64_t count, const double *w,
                           double _Complex *H);
    void *state;
    double w, value; /* largest value found, and its frequency [rad/s] */
} ritz_peak;

/**
 * Evaluate at all points and at infinity, and refine around the eight highest
 * points that are at least half as high as the highest: between each and its
 * neighbours, and within 1 % of it. Sets `w` and `value`.
 *
 * @param[in] w  count frequencies, ascending, distinct  [rad/s]
 */
ritz_status ritz_peak_find(ritz_peak *peak, int64_t count, const double *w);

/** Largest singular value of a p x m response, p and m at least 1.
 * @param[in,out] H  by columns; overwritten */
ritz_status ritz_largest_singular(int64_t p, int64_t m, double _Complex *H,
                                  double *out);

/** Largest singular value at some frequencies; raises `value`, and `w` with it,
 * if one is larger. */
ritz_status ritz_peak_at(ritz_peak *peak, int64_t count, const double *w,
                         double *value);

/**
 * Frequency of the peak of a single pole's response; the magnitude of the pole
 * if the response has no peak  [rad/s]
 */
double ritz_peak_of_pole(double _Complex pole);

#endif
