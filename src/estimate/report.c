/* The estimates of frequencies as named numbers, each with its place. */
#include "base/tolerances.h"
#include "estimate/estimator.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* Most modes that are reported one by one. */
enum { MOST_LISTED = 100 };

/* Add a value with its place, "mode 7, 3.41 Hz, full mode 8". */
static ritz_status add_mode(const ritz_measuring *m, const char *name,
                            ritz_pair_error found, ritz_measures *out)
{
    char other[RITZ_NAME_SIZE] = "", where[2 * RITZ_NAME_SIZE];

    if (found.full_mode < 0)
        (void)snprintf(other, sizeof other, ", near some full mode");
    else if (found.full_mode != found.mode)
        (void)snprintf(other, sizeof other, ", full mode %" PRId64,
                       found.full_mode + 1);
    (void)snprintf(where, sizeof where, "mode %" PRId64 ", %.4g Hz%s",
                   found.mode + 1,
                   ritz_eigen_hertz(m->pairs.lambda[found.mode]), other);
    return ritz_measures_add(out, name, found.value, nan(""), where);
}

/*
 * A lower bound of the worst error from mode k: however the first k full modes
 * are paired, one of them has a reduced partner of number k or more, whose
 * frequency is above the highest that full mode k can have.
 */
static double least_of(const ritz_measuring *m, int64_t k)
{
    double theta = m->pairs.lambda[k];
    double rounding = 0.5 * m->trial.reduced_rounding[k] / theta;
    double low = fmax(fmin(theta, m->trial.reduced_low[k]), 0.0);

    return sqrt(low / m->enclosure.high[k]) - 1.0 - rounding;
}

ritz_status ritz_measuring_report_least(const ritz_measuring *m,
                                        ritz_measures *out)
{
    double band = ritz_eigen_lambda(m->band_hz[1]);
    ritz_pair_error most = {0};

    for (int64_t k = m->first; k < m->trial.count && m->band_hz[0] == 0.0 &&
                               m->enclosure.high[k] <= band;
         k++) {
        double least = least_of(m, k);

        if (least > most.value &&
            !ritz_estimator_sees_rigid(m->estimator, k, m->pairs.lambda[k],
                                       band))
            most = (ritz_pair_error){least, k, k};
    }
    return most.value > 0.0 ? add_mode(m, "frequency-relative-least", most, out)
                            : RITZ_OK;
}

/* Where no mode is missing: the claim on the full mode of the same number, if
   its interval is known and disjoint from that of the mode that was claimed. */
static void prefer_same(const ritz_measuring *m, ritz_pair_error *claim)
{
    const ritz_enclosure *e = &m->enclosure;
    const int64_t p = claim->full_mode, k = claim->mode;
    double same = ritz_error_of(m, k, e->low[k], e->high[k]).most;

    if (isfinite(same) && (e->high[k] < e->low[p] || e->high[p] < e->low[k]))
        *claim = (ritz_pair_error){same, k, k};
}

/* "mode-7" and so on, of the band. */
static ritz_status list_modes(const ritz_measuring *m, ritz_measures *out)
{
    double band = m->last > 0 ? m->pairs.lambda[m->last - 1] : 0.0;
    bool complete = ritz_missing_modes(m) == 0;
    char name[RITZ_NAME_SIZE];

    for (int64_t k = m->first; k < m->last && out->count < MOST_LISTED; k++) {
        ritz_claim claim = ritz_claim_of(m, k);
        ritz_pair_error found = {claim.bound, k, claim.full_mode};

        if (ritz_estimator_sees_rigid(m->estimator, k, m->pairs.lambda[k],
                                      band))
            continue;
        if (complete && claim.full_mode >= 0 && claim.full_mode != k)
            prefer_same(m, &found);
        (void)snprintf(name, sizeof name, "mode-%" PRId64, k + 1);
        RITZ_CHECK(add_mode(m, name, found, out));
    }
    return RITZ_OK;
}

/* Why the bound of the worst frequency error is far above the known error; ""
   if it is not. */
static const char *cause_of(const ritz_measuring *m)
{
    const ritz_prediction *v = &m->prediction;
    const ritz_lehmann *trial = &m->trial;
    int64_t k = v->bound.mode;
    double rounding = 0.0;

    if (v->bound.value <= RITZ_BOUND_FAR * fmax(v->least.value, 0.0))
        return "";
    if (v->num_missing > 0)
        return "missing modes";
    if (k < trial->count)
        rounding = 0.5 * (trial->rounding[k] + trial->reduced_rounding[k]) /
                   m->pairs.lambda[k];
    return v->bound.value <= RITZ_BOUND_FAR * rounding ? "rounding"
                                                       : "close modes";
}

/* Report the worst mode of the band, then each. */
static ritz_status report_modes(const ritz_measuring *m, ritz_measures *out)
{
    const ritz_prediction *v = &m->prediction;
    RITZ_OWN(ritz_measures) each = {0};

    RITZ_CHECK(list_modes(m, &each));
    if (!v->counted && (v->any_in_band || each.count > 0)) {
        RITZ_CHECK(ritz_measures_add(out, "frequency-relative-bound", HUGE_VAL,
                                     nan(""), ""));
        ritz_measures_name_cause(out, "modes are not counted");
    } else if (v->bound.value >= 0.0) {
        RITZ_CHECK(add_mode(m, "frequency-relative-bound", v->bound, out));
        ritz_measures_name_cause(out, cause_of(m));
    }
    if (v->least.value > 0.0)
        RITZ_CHECK(add_mode(m, "frequency-relative-least", v->least, out));
    for (int64_t k = 0; k < each.count; k++)
        RITZ_CHECK(ritz_measures_add(out, each.item[k].name, each.item[k].value,
                                     nan(""), each.item[k].where));
    return RITZ_OK;
}

static ritz_status report_missing(const ritz_measuring *m, ritz_measures *out)
{
    const ritz_prediction *v = &m->prediction;
    char where[RITZ_NAME_SIZE] = "";

    if (!v->counted)
        return RITZ_OK;
    if (v->first_missing >= 0)
        (void)snprintf(where, sizeof where,
                       "first: full mode %" PRId64 ", below %.4g Hz",
                       v->first_missing + 1,
                       ritz_eigen_hertz(m->enclosure.high[v->first_missing]));
    return ritz_measures_add(out, "missing-modes-bound", (double)v->num_missing,
                             nan(""), where);
}

ritz_status ritz_measuring_report(const ritz_measuring *m, ritz_measures *out)
{
    RITZ_CHECK(report_modes(m, out));
    return report_missing(m, out);
}
