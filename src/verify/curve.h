/* The most of a function of frequency that is known at points. */
#ifndef RITZ_VERIFY_CURVE_H
#define RITZ_VERIFY_CURVE_H

#include <ritz/status.h>

#include <stdint.h>

/* A value at one frequency; RITZ_ERR_SINGULAR: it is infinite there. */
typedef struct ritz_curve {
    ritz_status (*at)(void *state, double hertz, double *value);
    void *state;
} ritz_curve;

/**
 * Among points and, by golden sections between neighbours, around those that
 * are higher than theirs and no lower than half the highest.
 *
 * @param[in] curve  NULL: points alone
 * @param[out] best  HUGE_VAL if it still grows where points can no longer be
 *                   told apart
 */
ritz_status ritz_curve_peak(int64_t count, const double *hertz,
                            const double *value, const ritz_curve *curve,
                            double *where, double *best);

#endif
