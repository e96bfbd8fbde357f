/* Measures between the modes of two models. */
#include "verify/compare_sides.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The largest (or smallest) of something, and the full mode where it is. */
typedef struct extreme {
    double value;
    int64_t mode; /* -1: there was none */
} extreme;

static bool in_band(const ritz_sides *sides, double lambda)
{
    return ritz_in_band(sides->full->band_hz, lambda);
}

static double frequency_error(const ritz_sides *sides, int64_t k, int64_t r)
{
    double full = sqrt(sides->full->poles.lambda[k]);
    double reduced = sqrt(sides->reduced.lambda[r]);

    return fabs(reduced - full) / full;
}

/* Of the largest ratio of both models: smaller ones are what some thousand
   terms of a modal damping leave by rounding. */
static const double undamped_within = 1e-12;

/* The ratio up to which a mode is undamped. */
static double undamped(const ritz_sides *sides)
{
    const ritz_damped *both[] = {&sides->full->damped, &sides->damped_reduced};
    const int64_t count[] = {sides->full->poles.count, sides->reduced.count};
    double largest = 0.0;

    for (int t = 0; t < 2; t++)
        for (int64_t k = 0; k < count[t]; k++)
            if (isfinite(both[t]->zeta[k]))
                largest = fmax(largest, fabs(both[t]->zeta[k]));
    return undamped_within * largest;
}

/*
 * Where D couples modes, undamped partners need not be damped ones: the nearest
 * pole is. Of a mode that does not oscillate in the full model nothing is said
 * (NaN); one that does so in it alone is wholly wrong.
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

static void keep(extreme *of, double sign, double value, int64_t mode)
{
    if (isnan(value) || (of->mode >= 0 && sign * value <= sign * of->value))
        return;
    of->value = value;
    of->mode = mode;
}

static ritz_status add(const ritz_sides *sides, const char *name, double limit,
                       extreme found, ritz_measures *out)
{
    char where[RITZ_NAME_SIZE];

    if (found.mode < 0)
        return RITZ_OK;
    (void)snprintf(where, sizeof where, "mode %" PRId64 ", %.4g Hz",
                   found.mode + 1,
                   ritz_eigen_hertz(sides->full->poles.lambda[found.mode]));
    return ritz_measures_add(out, name, found.value, limit, where);
}

/* How many modes of the band no channel shows: their MAC is none. */
static int64_t count_unseen(const ritz_sides *sides)
{
    const ritz_poles *full = &sides->full->poles;
    int64_t count = 0;

    for (int64_t k = full->num_rigid; k < full->count; k++)
        count += in_band(sides, full->lambda[k]) && !sides->full->seen.mode[k];
    return count;
}

/* "mode 5, 0.1202 Hz, 1 not seen" */
static ritz_status add_mac(const ritz_sides *sides, double limit, extreme found,
                           ritz_measures *out)
{
    int64_t unseen = sides->outputs ? count_unseen(sides) : 0;
    char *where = NULL;
    size_t used = 0;

    if (found.mode < 0 || !(sides->shapes || sides->outputs))
        return RITZ_OK;
    RITZ_CHECK(add(sides, "mac", limit, found, out));
    where = out->item[out->count - 1].where;
    used = strlen(where);
    if (unseen > 0)
        (void)snprintf(where + used, RITZ_NAME_SIZE - used,
                       ", %" PRId64 " not seen", unseen);
    return RITZ_OK;
}

/* A count, and the first that was counted. */
static ritz_status add_count(const char *name, int64_t count, int64_t first,
                             const ritz_poles *poles, double limit,
                             ritz_measures *out)
{
    char where[RITZ_NAME_SIZE] = "";

    if (count > 0)
        (void)snprintf(where, sizeof where, "first: mode %" PRId64 ", %.4g Hz",
                       first + 1, ritz_eigen_hertz(poles->lambda[first]));
    return ritz_measures_add(out, name, (double)count, limit, where);
}

static ritz_status add_missing(const ritz_sides *sides, double limit,
                               ritz_measures *out)
{
    const ritz_match *match = &sides->match;
    int64_t count = 0;
    int64_t first = -1;

    for (int64_t k = sides->full->poles.num_rigid; k < match->count; k++)
        if (match->partner[k] < 0 &&
            in_band(sides, sides->full->poles.lambda[k])) {
            first = count == 0 ? k : first;
            count++;
        }
    return add_count("missing-modes", count, first, &sides->full->poles, limit,
                     out);
}

static ritz_status add_extra(const ritz_sides *sides, ritz_measures *out)
{
    const ritz_match *match = &sides->match;
    int64_t count = 0;
    int64_t first = -1;

    for (int64_t r = sides->reduced.num_rigid; r < match->num_reduced; r++)
        if (!match->taken[r] && in_band(sides, sides->reduced.lambda[r])) {
            first = count == 0 ? r : first;
            count++;
        }
    return add_count("extra-modes", count, first, &sides->reduced, nan(""),
                     out);
}

/*
 * As many modes as the full model has rigid ones: how far from 0 they are, and
 * how many are no rigid motion: neither 0 but for rounding, nor nearer to it
 * than the first flexible mode's frequency may be off.
 */
static ritz_status add_rigid(const ritz_sides *sides,
                             const ritz_verify_request *request, double limit,
                             ritz_measures *out)
{
    const ritz_poles *full = &sides->full->poles;
    const int64_t rigid = full->num_rigid;
    const int64_t there = sides->small.Phi.ncol;
    char where[RITZ_NAME_SIZE] = "";
    double allowed = 0.0;
    double largest = 0.0;
    int64_t lost = rigid > there ? rigid - there : 0;

    if (rigid == 0)
        return RITZ_OK;
    if (full->count > rigid && !isnan(request->limit_frequency))
        allowed =
            request->limit_frequency * ritz_eigen_hertz(full->lambda[rigid]);
    for (int64_t k = 0; k < rigid && k < there; k++) {
        double hertz = fabs(ritz_eigen_hertz(sides->small.lambda[k]));

        largest = fmax(largest, hertz);
        lost += k >= sides->reduced.num_rigid && hertz > allowed;
    }
    if (lost > 0)
        (void)snprintf(where, sizeof where, "of %" PRId64, rigid);
    RITZ_CHECK(ritz_measures_add(out, "rigid-hertz", largest, nan(""), ""));
    return ritz_measures_add(out, "missing-rigid-modes", (double)lost, limit,
                             where);
}

ritz_status ritz_sides_modes(const ritz_sides *sides,
                             const ritz_verify_request *request,
                             ritz_measures *out)
{
    const ritz_match *match = &sides->match;
    extreme frequency = {0.0, -1};
    extreme mac = {0.0, -1};
    extreme damping = {0.0, -1};
    double nothing = sides->full->assumed ? 0.0 : undamped(sides);
    /* what is asked to be near must be there */
    double none_missing =
        isnan(request->limit_frequency) && isnan(request->limit_damping)
            ? request->limit_missing
            : fmax(request->limit_missing, 0.0);
    double none_rigid =
        isnan(none_missing) || sides->full->band_hz[0] > 0.0 ? nan("") : 0.0;

    for (int64_t k = sides->full->poles.num_rigid; k < match->count; k++) {
        int64_t r = match->partner[k];

        if (!in_band(sides, sides->full->poles.lambda[k]))
            continue;
        keep(&mac, -1.0, match->mac[k], k);
        if (r < 0)
            continue;
        keep(&frequency, 1.0, frequency_error(sides, k, r), k);
        if (!sides->full->assumed)
            keep(&damping, 1.0, damping_error(sides, nothing, k, r), k);
    }
    RITZ_CHECK(add(sides, "frequency-relative", request->limit_frequency,
                   frequency, out));
    RITZ_CHECK(add_mac(sides, request->limit_mac, mac, out));
    RITZ_CHECK(
        add(sides, "damping-relative", request->limit_damping, damping, out));
    RITZ_CHECK(add_rigid(sides, request, none_rigid, out));
    RITZ_CHECK(add_missing(sides, none_missing, out));
    return add_extra(sides, out);
}
