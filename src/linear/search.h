/* The most of a function of frequency that is known at points. */
#ifndef RITZ_LINEAR_SEARCH_H
#define RITZ_LINEAR_SEARCH_H

#include <ritz/base.h>

#include <stdint.h>

/* A value at one frequency; RITZ_ERR_SINGULAR: it is infinite there. */
typedef struct ritz_curve {
    ritz_status (*at)(void *state, double hertz, double *value);
    void *state;
} ritz_curve;

/**
 * The most between two frequencies, as if there were one peak: golden sections
 * until the bracket is no longer than @p within of its upper end.
 *
 * @param[in,out] low,high  the bracket
 * @param[out]    most      of the last two values
 */
ritz_status ritz_curve_between(const ritz_curve *curve, double within,
                               double *low, double *high, double *most);

/* A function that returns values at several frequencies at once. */
typedef struct ritz_curves {
    ritz_status (*at)(void *state, int64_t count, const double *hertz,
                      double *value);
    void *state;
} ritz_curves;

/* Two frequencies between which a maximum is sought. */
typedef struct ritz_bracket {
    double low, high;
    double a, b, at_a, at_b; /* section points and their values, used by the
                                search */
} ritz_bracket;

/**
 * As ritz_curve_between, for many brackets at the same time: each step
 * evaluates one point of each bracket.
 *
 * @param[in,out] bracket  @p count brackets, with low and high
 */
ritz_status ritz_curves_between(const ritz_curves *curves, double within,
                                int64_t count, ritz_bracket *bracket);

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
