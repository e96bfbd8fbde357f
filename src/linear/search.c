#include "linear/search.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <math.h>
#include <stdbool.h>

/* Peaks that are followed between points, at most. */
enum { MOST_PEAKS = 12 };

typedef struct climb {
    const ritz_curve *curve;
    double where, best;
} climb;

static ritz_status look_at(void *state, double hertz, double *value)
{
    climb *c = state;
    ritz_status status = c->curve->at(c->curve->state, hertz, value);

    if (status == RITZ_ERR_SINGULAR) {
        *value = HUGE_VAL;
        status = RITZ_OK;
    }
    if (status == RITZ_OK && *value > c->best) {
        c->best = *value;
        c->where = hertz;
    }
    return status;
}

ritz_status ritz_curve_between(const ritz_curve *curve, double within,
                               double *low, double *high, double *most)
{
    double a = *high - RITZ_GOLDEN * (*high - *low);
    double b = *low + RITZ_GOLDEN * (*high - *low);
    double at_a = 0.0, at_b = 0.0;

    RITZ_CHECK(curve->at(curve->state, a, &at_a));
    RITZ_CHECK(curve->at(curve->state, b, &at_b));
    while (*high - *low > within * *high) {
        if (at_a > at_b) {
            *high = b;
            b = a;
            at_b = at_a;
            a = *high - RITZ_GOLDEN * (*high - *low);
            RITZ_CHECK(curve->at(curve->state, a, &at_a));
        } else {
            *low = a;
            a = b;
            at_a = at_b;
            b = *low + RITZ_GOLDEN * (*high - *low);
            RITZ_CHECK(curve->at(curve->state, b, &at_b));
        }
    }
    *most = fmax(at_a, at_b);
    return RITZ_OK;
}

/* Golden section points of a bracket. */
static double lower_section(const ritz_bracket *s)
{
    return s->high - RITZ_GOLDEN * (s->high - s->low);
}

static double upper_section(const ritz_bracket *s)
{
    return s->low + RITZ_GOLDEN * (s->high - s->low);
}

/* Shorten a bracket, and return where its next value is needed; false if the
   bracket is short enough. */
static bool advance_bracket(ritz_bracket *s, double within, double **at,
                            double **value)
{
    const bool left = s->at_a > s->at_b;

    if (!(s->high - s->low > within * s->high))
        return false;
    if (left) {
        s->high = s->b;
        s->b = s->a;
        s->at_b = s->at_a;
        s->a = lower_section(s);
    } else {
        s->low = s->a;
        s->a = s->b;
        s->at_a = s->at_b;
        s->b = upper_section(s);
    }
    *at = left ? &s->a : &s->b;
    *value = left ? &s->at_a : &s->at_b;
    return true;
}

/* Values at both section points of each bracket. */
static ritz_status begin_brackets(const ritz_curves *curves, int64_t count,
                                  ritz_bracket *bracket, double *at,
                                  double *value)
{
    for (int64_t k = 0; k < count; k++) {
        at[2 * k] = bracket[k].a = lower_section(&bracket[k]);
        at[2 * k + 1] = bracket[k].b = upper_section(&bracket[k]);
    }
    RITZ_CHECK(curves->at(curves->state, 2 * count, at, value));
    for (int64_t k = 0; k < count; k++) {
        bracket[k].at_a = value[2 * k];
        bracket[k].at_b = value[2 * k + 1];
    }
    return RITZ_OK;
}

ritz_status ritz_curves_between(const ritz_curves *curves, double within,
                                int64_t count, ritz_bracket *bracket)
{
    RITZ_OWN_ARRAY double *at = NULL, *value = NULL;
    RITZ_OWN_ARRAY double **to = NULL;
    int64_t due = 0;

    RITZ_CHECK_NEW(at, 2 * count);
    RITZ_CHECK_NEW(value, 2 * count);
    RITZ_CHECK_NEW(to, count);
    RITZ_CHECK(begin_brackets(curves, count, bracket, at, value));
    do {
        due = 0;
        for (int64_t k = 0; k < count; k++) {
            double *next = NULL;

            if (!advance_bracket(&bracket[k], within, &next, &to[due]))
                continue;
            at[due++] = *next;
        }
        RITZ_CHECK(curves->at(curves->state, due, at, value));
        for (int64_t k = 0; k < due; k++)
            *to[k] = value[k];
    } while (due > 0);
    return RITZ_OK;
}

/* The most between two frequencies, or that it grows without end. */
static ritz_status climb_between(climb *c, double low, double high)
{
    const ritz_curve seen = {look_at, c};
    double before = 0.0, most = 0.0;

    RITZ_CHECK(ritz_curve_between(&seen, RITZ_PEAK_LATE, &low, &high, &before));
    RITZ_CHECK(ritz_curve_between(&seen, RITZ_PEAK_SHARP, &low, &high, &most));
    if (most > RITZ_PEAK_GROWTH * before) {
        c->best = HUGE_VAL;
        c->where = (low + high) / 2.0;
    }
    return RITZ_OK;
}

static bool stands_out(int64_t count, const double *value, int64_t k)
{
    return (k == 0 || value[k] >= value[k - 1]) &&
           (k == count - 1 || value[k] >= value[k + 1]);
}

/* Index of the next lower local maximum, -1 if there is none. */
static int64_t next_highest(int64_t count, const double *value, double below,
                            int64_t after)
{
    int64_t best = -1;

    for (int64_t k = 0; k < count; k++)
        if (stands_out(count, value, k) &&
            (value[k] < below || (value[k] == below && k > after)) &&
            (best < 0 || value[k] > value[best]))
            best = k;
    return best;
}

ritz_status ritz_curve_peak(int64_t count, const double *hertz,
                            const double *value, const ritz_curve *curve,
                            double *where, double *best)
{
    climb c = {.curve = curve, .best = -1.0};
    int64_t k = next_highest(count, value, HUGE_VAL, count);

    if (k >= 0) {
        c.best = value[k];
        c.where = hertz[k];
    }
    for (int t = 0; curve && k >= 0 && t < MOST_PEAKS; t++) {
        if (value[k] < RITZ_PEAK_WORTH * c.best)
            break;
        if (k > 0)
            RITZ_CHECK(climb_between(&c, hertz[k - 1], hertz[k]));
        if (k < count - 1)
            RITZ_CHECK(climb_between(&c, hertz[k], hertz[k + 1]));
        k = next_highest(count, value, value[k], k);
    }
    *where = c.where;
    *best = c.best;
    return RITZ_OK;
}
