/*
 * What bounds decide before anything is measured. A candidate fails for certain
 * if its worst frequency error is at least more than is allowed; a component's
 * holds on the grid if every measure that has a tolerance has a bound within.
 */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <math.h>
#include <string.h>

ritz_status ritz_fit_estimator(const ritz_fitter *fitter,
                               const ritz_component *full,
                               ritz_fit_place *place)
{
    const ritz_verify_request *limits = &fitter->request.tolerance;
    const ritz_estimate_request asked = {
        .band_hz = {limits->band_hz[0], limits->band_hz[1]},
        .damping = limits->damping};

    if (!fitter->request.estimates)
        return RITZ_OK;
    return ritz_estimator_new(full, &asked, &place->estimator);
}

/* Whether bounds say that every measure with a tolerance holds: one without a
   bound is not known to. Where frequencies are to be near, no mode may be
   missing. */
static bool within(const ritz_verify_request *limits,
                   const ritz_measures *found)
{
    for (int k = 0; k < RITZ_MEASURES; k++) {
        const char *bound = ritz_measure_table[k].bound;
        double limit = limits->limit[k];

        if (k == RITZ_MEASURE_MISSING &&
            !isnan(limits->limit[RITZ_MEASURE_FREQUENCY]))
            limit = fmax(limit, 0.0);
        if (!isnan(limit) &&
            !(bound && ritz_measures_value(found, bound) <= limit))
            return false;
    }
    return true;
}

/* Where modes may be missing, no error is certain. */
static bool beyond(const ritz_verify_request *limits,
                   const ritz_measures *found, double *excess)
{
    double least = ritz_measures_value(found, "frequency-relative-least");

    *excess = least / limits->limit[RITZ_MEASURE_FREQUENCY];
    return !(limits->limit[RITZ_MEASURE_MISSING] > 0.0) && *excess > 1.0;
}

ritz_status ritz_fit_bound_at(const ritz_fit_place *place, const ritz_dense *T,
                              const ritz_reduced *reduced, bool least,
                              ritz_measures *out)
{
    const ritz_basis basis = {.T = *T};
    ritz_status status =
        least ? ritz_estimator_least(place->estimator, &basis, reduced, out)
              : ritz_estimator_measure(place->estimator, &basis, reduced, out);

    /* where nothing can be known, nothing is, which is no failure */
    return status == RITZ_ERR_MEMORY ? status : RITZ_OK;
}

/* Where modes are missing the worst error of the others may be 0. */
void ritz_fit_forget_least(ritz_measures *found)
{
    ritz_measure *least = ritz_measures_find(found, "frequency-relative-least");

    if (!least || !(ritz_measures_value(found, "missing-modes-bound") > 0.0))
        return;
    found->count--;
    memmove(least, least + 1,
            (size_t)(found->item + found->count - least) * sizeof *least);
}

/*
 * A component's bounds stand beside the errors of every candidate. Of a scene
 * measuring costs less than they do, save that what is off at one configuration
 * need not be measured at all: so that is asked alone.
 */
ritz_status ritz_fit_foresee(const ritz_fitter *fitter,
                             const ritz_fit_place *place, const ritz_dense *T,
                             const ritz_reduced *reduced,
                             ritz_fit_candidate *candidate,
                             ritz_fit_verdict *verdict)
{
    ritz_status status = RITZ_OK;
    const ritz_verify_request *limits = &fitter->request.tolerance;
    ritz_measures found = {0};
    double excess = 0.0;

    *verdict = RITZ_FIT_OPEN;
    if (!place->estimator ||
        (fitter->scene && isnan(limits->limit[RITZ_MEASURE_FREQUENCY])))
        return RITZ_OK;
    RITZ_TRY(
        ritz_fit_bound_at(place, T, reduced, fitter->scene != NULL, &found));
    if (!fitter->request.thorough) {
        if (within(limits, &found))
            *verdict = RITZ_FIT_HOLDS;
        if (beyond(limits, &found, &excess)) {
            *verdict = RITZ_FIT_FAILS;
            candidate->screened = true;
            candidate->excess = excess;
        }
    }
    if (!candidate->screened) /* otherwise it is the reason */
        ritz_fit_forget_least(&found);
    RITZ_TRY(ritz_fit_worst(&found, place->at, &candidate->estimates));
done:
    ritz_measures_free(&found);
    return status;
}
