/* Measures between the modes of two models. */
#include "base/tolerances.h"
#include "verify/sides.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The largest of some values, and the full mode that has it. */
typedef struct extreme {
    double value;
    int64_t mode; /* -1: there was none */
} extreme;

static bool in_band(const ritz_sides *sides, double lambda)
{
    return ritz_in_band(sides->full->band_hz, lambda);
}

static double frequency_error(const ritz_sides *sides, double nothing,
                              int64_t k, int64_t r)
{
    double full = sqrt(sides->full->poles.lambda[k]);
    double reduced = sqrt(sides->reduced.lambda[r]);

    (void)nothing;
    return fabs(reduced - full) / full;
}

/* The damping ratio up to which a mode is undamped. */
static double find_negligible(const ritz_sides *sides)
{
    const ritz_damped *both[] = {&sides->full->damped, &sides->damped_reduced};
    const int64_t count[] = {sides->full->poles.count, sides->reduced.count};
    double largest = 0.0;

    for (int t = 0; t < 2; t++)
        for (int64_t k = 0; k < count[t]; k++)
            if (isfinite(both[t]->zeta[k]))
                largest = fmax(largest, fabs(both[t]->zeta[k]));
    return RITZ_NEGLIGIBLE * largest;
}

/*
 * Where D couples modes, the damped mode of the undamped partner need not be
 * the partner: the nearest pole is. The error is unknown (NaN) where the mode
 * of the full model does not oscillate, and 1 where that of the reduced one
 * alone does not.
 */
static double damping_error(const ritz_sides *sides, double nothing, int64_t k,
                            int64_t r)
{
    bool coupled = sides->full->poles.coupled || sides->reduced.coupled;
    double full = sides->full->damped.zeta[k];
    double reduced = sides->damped_reduced.zeta[r];

    if (coupled && !isnan(full))
        reduced = ritz_spectrum_ratio(
            ritz_damped_nearest(&sides->damped_reduced, sides->reduced.count,
                                sides->full->damped.s[k]));
    if (full == reduced || (fabs(full) <= nothing && fabs(reduced) <= nothing))
        return 0.0;
    if (!isnan(full) && isnan(reduced))
        return 1.0;
    return fabs(reduced - full) / fmax(fabs(full), fabs(reduced));
}

static void keep_larger(double value, int64_t mode, extreme *of)
{
    if (isnan(value) || (of->mode >= 0 && value <= of->value))
        return;
    of->value = value;
    of->mode = mode;
}

/* Whether a mode is a rigid motion whose frequency is rounding of K. */
static bool is_hidden(const ritz_sides *sides, int64_t k)
{
    const ritz_rounded *rounded = &sides->full->rounded;

    return rounded->hidden && k < rounded->motions;
}

/* The value and "mode 5, 0.1202 Hz". */
static void tell_mode(const ritz_sides *sides, extreme found, ritz_measure *out)
{
    if (found.mode < 0)
        return;
    out->value = found.value;
    (void)snprintf(out->where, sizeof out->where, "mode %" PRId64 ", %.4g Hz%s",
                   found.mode + 1,
                   ritz_eigen_hertz(sides->full->poles.lambda[found.mode]),
                   is_hidden(sides, found.mode) ? ", rigid of rounded K" : "");
}

/* The largest error of the paired modes in the band. */
static void tell_worst(const ritz_sides *sides,
                       double (*error)(const ritz_sides *sides, double nothing,
                                       int64_t k, int64_t r),
                       double nothing, ritz_measure *out)
{
    const ritz_poles *full = &sides->full->poles;
    extreme found = {0.0, -1};

    for (int64_t k = full->num_rigid; k < full->count; k++)
        if (in_band(sides, full->lambda[k]) && sides->match.partner[k] >= 0 &&
            full->lambda[k] > 0.0)
            keep_larger(error(sides, nothing, k, sides->match.partner[k]), k,
                        &found);
    tell_mode(sides, found, out);
}

ritz_status ritz_modes_frequency(const ritz_sides *sides, ritz_measure *out)
{
    tell_worst(sides, frequency_error, 0.0, out);
    return RITZ_OK;
}

/* Without stated damping there is nothing to compare. */
ritz_status ritz_modes_damping(const ritz_sides *sides, ritz_measure *out)
{
    if (!sides->full->assumed)
        tell_worst(sides, damping_error, find_negligible(sides), out);
    return RITZ_OK;
}

/* How many modes of the band are not observable: they have no MAC. */
static int64_t count_unobservable(const ritz_sides *sides)
{
    const ritz_poles *full = &sides->full->poles;
    int64_t count = 0;

    for (int64_t k = full->num_rigid; k < full->count; k++)
        count +=
            in_band(sides, full->lambda[k]) && !sides->full->part.observable[k];
    return count;
}

/* "mode 5, 0.1202 Hz, 1 not observable" */
ritz_status ritz_modes_mac(const ritz_sides *sides, ritz_measure *out)
{
    const ritz_poles *full = &sides->full->poles;
    int64_t unobservable = !sides->component ? count_unobservable(sides) : 0;
    extreme found = {0.0, -1};
    size_t used = 0;

    if (!sides->shapes && sides->component)
        return RITZ_OK;
    for (int64_t k = full->num_rigid; k < full->count; k++)
        if (in_band(sides, full->lambda[k]))
            keep_larger(-sides->match.mac[k], k, &found);
    found.value = -found.value;
    tell_mode(sides, found, out);
    used = strlen(out->where);
    if (found.mode >= 0 && unobservable > 0)
        (void)snprintf(out->where + used, sizeof out->where - used,
                       ", %" PRId64 " not observable", unobservable);
    return RITZ_OK;
}

/* The number of modes of a model in the band that are not paired, and the
   first. */
static void tell_unpaired(const ritz_sides *sides, const ritz_poles *poles,
                          ritz_measure *out)
{
    const ritz_match *match = &sides->match;
    int64_t count = 0;

    for (int64_t k = poles->num_rigid; k < poles->count; k++) {
        bool paired =
            poles == &sides->reduced ? match->taken[k] : match->partner[k] >= 0;

        if (paired || !in_band(sides, poles->lambda[k]))
            continue;
        if (count++ == 0)
            (void)snprintf(out->where, sizeof out->where,
                           "first: mode %" PRId64 ", %.4g Hz", k + 1,
                           ritz_eigen_hertz(poles->lambda[k]));
    }
    out->value = (double)count;
}

/* A frequency or damping that is held to a limit must be there. */
static double missing_limit(const ritz_sides *sides)
{
    const double *limit = sides->limit;
    double missing = limit[RITZ_MEASURE_MISSING];

    return isnan(limit[RITZ_MEASURE_FREQUENCY]) &&
                   isnan(limit[RITZ_MEASURE_DAMPING])
               ? missing
               : fmax(missing, 0.0);
}

ritz_status ritz_modes_missing(const ritz_sides *sides, ritz_measure *out)
{
    tell_unpaired(sides, &sides->full->poles, out);
    out->limit = missing_limit(sides);
    return RITZ_OK;
}

ritz_status ritz_modes_extra(const ritz_sides *sides, ritz_measure *out)
{
    tell_unpaired(sides, &sides->reduced, out);
    return RITZ_OK;
}

/* Of the first modes of the reduced model, as many as the full model has rigid
   ones, the largest frequency. */
ritz_status ritz_modes_rigid_hertz(const ritz_sides *sides, ritz_measure *out)
{
    const int64_t rigid = sides->full->poles.num_rigid;

    if (rigid == 0)
        return RITZ_OK;
    out->value = 0.0;
    for (int64_t k = 0; k < rigid && k < sides->small.Phi.ncol; k++)
        out->value =
            fmax(out->value, fabs(ritz_eigen_hertz(sides->small.lambda[k])));
    return RITZ_OK;
}

/*
 * How many of those are no rigid motion: neither 0 but for rounding, nor nearer
 * to it than the first flexible mode's frequency may be off.
 */
ritz_status ritz_modes_missing_rigid(const ritz_sides *sides, ritz_measure *out)
{
    const ritz_poles *full = &sides->full->poles;
    const double relative = sides->limit[RITZ_MEASURE_FREQUENCY];
    const int64_t rigid = full->num_rigid;
    const int64_t there = sides->small.Phi.ncol;
    int64_t lost = rigid > there ? rigid - there : 0;
    double allowed = 0.0;

    if (rigid == 0)
        return RITZ_OK;
    if (full->count > rigid && !isnan(relative))
        allowed = relative * ritz_eigen_hertz(full->lambda[rigid]);
    for (int64_t k = sides->reduced.num_rigid; k < rigid && k < there; k++)
        lost += fabs(ritz_eigen_hertz(sides->small.lambda[k])) > allowed;
    out->value = (double)lost;
    if (lost > 0)
        (void)snprintf(out->where, sizeof out->where, "of %" PRId64, rigid);
    if (!isnan(missing_limit(sides)) && !(sides->full->band_hz[0] > 0.0))
        out->limit = 0.0;
    return RITZ_OK;
}
