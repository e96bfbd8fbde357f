/*
 * The largest singular value of a transfer function over all frequencies, as a
 * search at points and between them finds it: a lower bound.
 */
#ifndef RITZ_POLES_PEAK_H
#define RITZ_POLES_PEAK_H

#include <ritz/base.h>

#include <stdint.h>

typedef struct ritz_peak {
    int64_t outputs, inputs;
    /** H at some frequencies w [rad/s], of which one may be infinite: outputs x
        inputs by columns, one frequency after another. */
    ritz_status (*respond)(void *state, int64_t count, const double *w,
                           double _Complex *H);
    void *state;
    double w, value; /* the largest that was met, and where [rad/s] */
} ritz_peak;

/**
 * Evaluate at all points and at infinity, and climb around those that are at
 * least half as high as the highest, eight at most: between each and its
 * neighbours, and in the half width next to it. `w` and `value` become the
 * largest of all.
 *
 * @param[in] w  count frequencies, ascending, distinct  [rad/s]
 */
ritz_status ritz_peak_find(ritz_peak *peak, int64_t count, const double *w);

/** The largest at some frequencies; `w` and `value` rise to it. */
ritz_status ritz_peak_at(ritz_peak *peak, int64_t count, const double *w,
                         double *value);

/**
 * The frequency at which the response of a pole alone peaks, or the magnitude
 * of a pole whose response has no peak  [rad/s]
 */
double ritz_peak_of_pole(double _Complex pole);

#endif
