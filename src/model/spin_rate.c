/* Rates of rotation over time, with their derivative and their integral. */
#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/base.h>
#include <ritz/spin.h>

#include <math.h>

/* Number of the last point of a profile at or before t; -1 if there is none. */
static int64_t find_point(const ritz_spin_rate *rate, double t)
{
    int64_t k = -1;

    while (k + 1 < rate->count && rate->time[k + 1] <= t)
        k++;
    return k;
}

static double slope_after(const ritz_spin_rate *rate, int64_t k)
{
    if (k < 0 || k + 1 >= rate->count)
        return 0.0;
    return (rate->value[k + 1] - rate->value[k]) /
           (rate->time[k + 1] - rate->time[k]);
}

static double profile_at(const ritz_spin_rate *rate, double t)
{
    const int64_t k = find_point(rate, t);

    if (k < 0)
        return rate->value[0];
    return rate->value[k] + slope_after(rate, k) * (t - rate->time[k]);
}

/* Integral of a profile from 0 to t, by trapezoids between its points. */
static double turned_by_profile(const ritz_spin_rate *rate, double t)
{
    double from = 0.0, sum = 0.0;

    for (int64_t k = 0; k <= rate->count && from < t; k++) {
        const double to = k < rate->count ? fmin(rate->time[k], t) : t;

        if (to <= from)
            continue;
        sum +=
            0.5 * (to - from) * (profile_at(rate, from) + profile_at(rate, to));
        from = to;
    }
    return sum;
}

double ritz_spin_rate_at(const ritz_spin_rate *rate, double t)
{
    double s = 0.0;

    switch (rate->course) {
    case RITZ_SPIN_CONSTANT:
        return rate->count > 0 ? rate->value[0] : 0.0;
    case RITZ_SPIN_PROFILE:
        return profile_at(rate, t);
    case RITZ_SPIN_RAMP:
        s = fmin(t / rate->time[0], 1.0);
        return rate->value[0] * (s - sin(2.0 * RITZ_PI * s) / (2.0 * RITZ_PI));
    }
    return 0.0;
}

double ritz_spin_acceleration_at(const ritz_spin_rate *rate, double t)
{
    double s = 0.0;

    switch (rate->course) {
    case RITZ_SPIN_CONSTANT:
        return 0.0;
    case RITZ_SPIN_PROFILE:
        return slope_after(rate, find_point(rate, t));
    case RITZ_SPIN_RAMP:
        s = fmin(t / rate->time[0], 1.0);
        return rate->value[0] / rate->time[0] * (1.0 - cos(2.0 * RITZ_PI * s));
    }
    return 0.0;
}

double ritz_spin_angle_at(const ritz_spin_rate *rate, double t)
{
    double s = 0.0, end = 0.0;

    switch (rate->course) {
    case RITZ_SPIN_CONSTANT:
        return ritz_spin_rate_at(rate, t) * t;
    case RITZ_SPIN_PROFILE:
        return turned_by_profile(rate, t);
    case RITZ_SPIN_RAMP:
        end = rate->time[0];
        s = fmin(t / end, 1.0);
        return rate->value[0] *
               (end * (0.5 * s * s + (cos(2.0 * RITZ_PI * s) - 1.0) /
                                         (4.0 * RITZ_PI * RITZ_PI)) +
                fmax(t - end, 0.0));
    }
    return 0.0;
}

void ritz_spin_rate_free(ritz_spin_rate *rate)
{
    RITZ_FREE(rate->time, rate->value);
    *rate = (ritz_spin_rate){0};
}
