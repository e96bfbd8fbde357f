/* A component's candidates: made, measured, confirmed. */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <ritz/monitor.h>
#include <ritz/probe.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

ritz_status ritz_fit_install(const ritz_component *component,
                             ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_component copy = *component; /* all but what follows is borrowed */

    copy.K = copy.D = (ritz_sparse){0};
    copy.dampers = (ritz_dampers){0};
    RITZ_TRY(ritz_sparse_add(1.0, &component->K, 0.0, &component->K, &copy.K));
    if (component->D.colptr)
        RITZ_TRY(
            ritz_sparse_add(1.0, &component->D, 0.0, &component->D, &copy.D));
    RITZ_TRY(ritz_dampers_copy(&component->dampers, &copy.dampers));
    RITZ_TRY(ritz_component_install(&copy));
    *out = copy;
    copy = (ritz_component){0};
done:
    ritz_fit_uninstall(&copy);
    return status;
}

void ritz_fit_uninstall(ritz_component *copy)
{
    ritz_sparse_free(&copy->K);
    ritz_sparse_free(&copy->D);
    ritz_dampers_free(&copy->dampers);
    *copy = (ritz_component){0};
}

ritz_status ritz_fit_refuse(ritz_status status, ritz_fit_candidate *candidate)
{
    if (status == RITZ_OK || status == RITZ_ERR_MEMORY)
        return status;
    (void)snprintf(candidate->refusal, sizeof candidate->refusal, "%s",
                   ritz_error_message());
    candidate->feasible = false;
    candidate->excess = HUGE_VAL;
    return RITZ_OK;
}

/* What this method heeds of what all are told; its damping is everybody's. */
ritz_choice ritz_fit_choose(const ritz_fitter *fitter,
                            const ritz_method *method)
{
    const ritz_verify_request *limits = &fitter->request.tolerance;
    ritz_choice choice = fitter->request.choice;
    int absent = ~choice.given;

    if (absent & method->uses & RITZ_USES_DAMPING &&
        limits->damping.kind != RITZ_DAMPING_NONE) {
        choice.damping = limits->damping;
        choice.given |= RITZ_USES_DAMPING;
    }
    if (absent & method->uses & RITZ_USES_BAND) {
        memcpy(choice.band_hz, limits->band_hz, sizeof choice.band_hz);
        choice.given |= RITZ_USES_BAND;
    }
    if (absent & method->uses & RITZ_USES_SIDES) {
        choice.one_sided = true; /* symmetric, as all that are compared */
        choice.given |= RITZ_USES_SIDES;
    }
    choice.given &= method->uses;
    return choice;
}

ritz_status ritz_fit_make(const ritz_fitter *fitter,
                          const ritz_fit_candidate *candidate,
                          ritz_basis *basis, ritz_reduced *reduced)
{
    ritz_request request = RITZ_REQUEST_NONE;

    request.component = fitter->component;
    request.modes = candidate->modes[0];
    request.choice = ritz_fit_choose(fitter, candidate->method);
    request.attached = fitter->attached; /* borrowed */
    RITZ_CHECK(ritz_basis_make(candidate->method, &request, basis));
    return ritz_reduce(fitter->component, basis, reduced);
}

static double seconds(clockid_t clock)
{
    struct timespec now = {0};

    (void)clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

ritz_fit_watch ritz_fit_start(void)
{
    return (ritz_fit_watch){seconds(CLOCK_MONOTONIC),
                            seconds(CLOCK_PROCESS_CPUTIME_ID)};
}

ritz_fit_watch ritz_fit_since(ritz_fit_watch start)
{
    ritz_fit_watch now = ritz_fit_start();

    return (ritz_fit_watch){now.wall - start.wall, now.cpu - start.cpu};
}

/* A model that moves by itself is none, however near its frequencies are. */
ritz_status ritz_fit_probe(const ritz_second_order *model,
                           const ritz_damping *damping,
                           ritz_fit_candidate *candidate)
{
    ritz_probe found = {0};
    char why[2 * RITZ_NAME_SIZE];

    RITZ_CHECK(
        ritz_probe_second_order(model->K, model->M, model->D, damping, &found));
    if (found.verdict == RITZ_UNSTABLE) {
        ritz_probe_print(&found, why);
        (void)snprintf(candidate->refusal, sizeof candidate->refusal,
                       "unstable: %s", why);
        candidate->feasible = false;
        candidate->excess = HUGE_VAL;
    }
    return RITZ_OK;
}

ritz_status ritz_fit_price(const ritz_fitter *fitter,
                           const ritz_second_order *model,
                           ritz_fit_candidate *candidate)
{
    const ritz_verify_request *limits = &fitter->request.tolerance;
    const ritz_second_order damped = {model->K, model->M, model->D, NULL,
                                      model->io};
    ritz_status status = RITZ_OK;

    if (!fitter->request.costs)
        return RITZ_OK;
    status = ritz_simulate_cost(&damped, &limits->damping, limits->band_hz,
                                &candidate->cost);
    if (status != RITZ_OK && status != RITZ_ERR_MEMORY) {
        candidate->cost = (ritz_cost){0}; /* it has none, and is no worse */
        status = RITZ_OK;
    }
    return status;
}

int ritz_fit_places(const ritz_reference *reference,
                    const ritz_measures *errors)
{
    const bool extra = ritz_measures_value(errors, "extra-modes") > 0.0;

    return extra || !ritz_reference_factors(reference)
               ? RITZ_AT_OTHER_POLES | RITZ_AT_RANDOM
               : RITZ_AT_RANDOM;
}

/* On the grid first; what meets it there, or is known to, at random places. */
ritz_status ritz_fit_measure(ritz_fitter *fitter, ritz_reduced *reduced,
                             ritz_fit_candidate *candidate)
{
    const ritz_verify_request *limits = &fitter->request.tolerance;
    const ritz_reference *reference = fitter->place[0].reference;
    const ritz_second_order model = {&reduced->K, &reduced->M, &reduced->D,
                                     NULL, &reduced->io};
    int where = 0;

    RITZ_CHECK(ritz_reduced_install(reduced));
    if (!candidate->held) {
        RITZ_CHECK(ritz_reference_measure(reference, reduced, limits, 0,
                                          &candidate->errors));
        ritz_fit_judge(limits, candidate);
        if (!candidate->feasible)
            return RITZ_OK;
    }
    where = ritz_fit_places(reference, &candidate->errors);
    ritz_measures_free(&candidate->errors);
    RITZ_CHECK(ritz_reference_measure(reference, reduced, limits, where,
                                      &candidate->errors));
    ritz_fit_judge(limits, candidate);
    candidate->caught = !candidate->feasible;
    if (candidate->feasible)
        RITZ_CHECK(ritz_fit_probe(&model, &limits->damping, candidate));
    if (candidate->feasible)
        RITZ_CHECK(ritz_fit_price(fitter, &model, candidate));
    return RITZ_OK;
}

ritz_status ritz_fit_try_component(ritz_fitter *fitter,
                                   ritz_fit_candidate *candidate)
{
    ritz_status status = RITZ_OK;
    ritz_basis basis = {0};
    ritz_reduced reduced = {0};
    ritz_fit_watch watch = ritz_fit_start();
    ritz_fit_verdict verdict = RITZ_FIT_OPEN;

    RITZ_TRY(ritz_fit_make(fitter, candidate, &basis, &reduced));
    candidate->spent = ritz_fit_since(watch);
    candidate->order = candidate->columns = reduced.K.ncol;
    if (candidate->order > fitter->largest) {
        (void)snprintf(candidate->refusal, sizeof candidate->refusal,
                       "%lld columns are more than the %lld that are tried",
                       (long long)candidate->order, (long long)fitter->largest);
        candidate->excess = HUGE_VAL;
        goto done;
    }
    RITZ_TRY(ritz_fit_foresee(fitter, &fitter->place[0], &basis.T, &reduced,
                              candidate, &verdict));
    candidate->held = verdict == RITZ_FIT_HOLDS;
    if (verdict != RITZ_FIT_FAILS)
        RITZ_TRY(ritz_fit_measure(fitter, &reduced, candidate));
done:
    ritz_basis_free(&basis);
    ritz_reduced_free(&reduced);
    return ritz_fit_refuse(status, candidate);
}
