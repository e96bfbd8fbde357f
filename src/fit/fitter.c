/* A full model prepared for candidates; of a scene in scene_places.c. */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <ritz/monitor.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Beyond what the band holds: how far orders are tried. */
enum { PER_MODE = 4, BESIDE = 40 };

int64_t ritz_fit_largest(const ritz_fitter *fitter, int64_t held, int64_t n)
{
    int64_t rigid = 0;
    int64_t modes = ritz_reference_modes(fitter->place[0].reference, &rigid);
    int64_t usual = PER_MODE * (modes + rigid) + held + BESIDE;

    if (fitter->request.largest > 0)
        return fitter->request.largest;
    return usual < n ? usual : n;
}

ritz_status ritz_fit_refer(const ritz_fit_request *request,
                           ritz_fit_place *place)
{
    const ritz_reference_request asked = {
        .band_hz = {request->tolerance.band_hz[0],
                    request->tolerance.band_hz[1]},
        .damping = request->tolerance.damping,
        .num_random = request->num_random,
        .seed = request->seed,
    };

    return ritz_reference_new(&place->full, &asked, &place->reference);
}

ritz_status ritz_fitter_new(const ritz_component *component,
                            const ritz_fit_request *request, ritz_fitter **out)
{
    ritz_status status = RITZ_OK;
    ritz_fitter *f = NULL;
    ritz_verify_request *limits = NULL;

    RITZ_NEW(f, 1);
    f->request = *request;
    f->component = component;
    f->num_bodies = 1;
    limits = &f->request.tolerance;
    RITZ_FAIL_IF(!(limits->band_hz[1] > 0.0), RITZ_ERR_ARGUMENT,
                 "there is no band: where is the tolerance to hold");
    if (limits->damping.kind == RITZ_DAMPING_NONE && component->damping[0])
        RITZ_TRY_IN("damping",
                    ritz_damping_parse(component->damping, &limits->damping));
    RITZ_NEW(f->place, 1);
    f->num_places = 1;
    f->place[0].listed = true;
    RITZ_TRY(ritz_fit_install(component, &f->place[0].full));
    RITZ_TRY(ritz_fit_check(limits, &f->place[0].full));
    RITZ_TRY(ritz_component_attached(component, request->attach, &f->attached));
    ritz_monitor_step("full model", 0, 0);
    RITZ_TRY(ritz_fit_refer(&f->request, &f->place[0]));
    ritz_fit_settle(f->place[0].reference, limits);
    if (component->dampers.count == 0) /* bases do not see them */
        RITZ_TRY(ritz_fit_estimator(f, component, &f->place[0]));
    f->largest = ritz_fit_largest(f, f->attached.count, component->num_dofs);
    *out = f;
    f = NULL;
done:
    ritz_fitter_free(&f);
    return status;
}

const ritz_verify_request *ritz_fitter_tolerance(const ritz_fitter *fitter)
{
    return &fitter->request.tolerance;
}

int64_t ritz_fitter_bodies(const ritz_fitter *fitter)
{
    return fitter->num_bodies;
}

const char *ritz_fitter_body(const ritz_fitter *fitter, int64_t k)
{
    return fitter->scene ? fitter->scene->component[fitter->body[k]].name : "";
}

void ritz_fitter_describe(const ritz_fitter *fitter, int64_t size, char *out)
{
    int64_t listed = 0;
    const ritz_component *full = &fitter->place[0].full;

    for (int64_t k = 0; k < fitter->num_places; k++)
        listed += fitter->place[k].listed;
    if (!fitter->scene)
        (void)snprintf(out, (size_t)size,
                       "the full component of %" PRId64 " dofs",
                       full->num_dofs);
    else
        (void)snprintf(out, (size_t)size,
                       "%s of %" PRId64 " dofs at %" PRId64
                       " configuration%s, and %" PRId64 " more at random",
                       fitter->rich ? "a rich first stage" : "the full system",
                       full->num_dofs, listed, listed == 1 ? "" : "s",
                       fitter->num_places - listed);
}

int64_t ritz_fit_rungs(const ritz_fitter *fitter, const ritz_method *method)
{
    return method == &ritz_fit_compare ? fitter->second.num_steps
                                       : fitter->num_steps;
}

void ritz_fit_rung(const ritz_fitter *fitter, const ritz_method *method,
                   int64_t rung, int64_t *modes)
{
    const ritz_fit_second *second = &fitter->second;
    const bool composite = method == &ritz_fit_compare;
    const int64_t *step = composite ? second->step : fitter->step;

    if (!fitter->scene) {
        modes[0] = rung;
        return;
    }
    for (int64_t k = 0; k < fitter->num_bodies; k++)
        modes[k] = composite && second->rigid && second->rigid[k] == 0;
    for (int64_t k = 0; k < rung && k < ritz_fit_rungs(fitter, method); k++)
        modes[step[k]]++;
}

ritz_status ritz_fitter_try(ritz_fitter *fitter, const ritz_method *method,
                            const int64_t *modes, ritz_fit_candidate *out)
{
    ritz_status status = RITZ_OK;
    ritz_fit_candidate candidate = {
        .method = method, .num_bodies = fitter->num_bodies, .binding = -1};

    RITZ_NEW(candidate.modes, fitter->num_bodies);
    for (int64_t k = 0; k < fitter->num_bodies; k++)
        candidate.modes[k] = method->uses & RITZ_USES_MODES ? modes[k] : -1;
    RITZ_TRY(fitter->scene ? ritz_fit_try_scene(fitter, &candidate)
                           : ritz_fit_try_component(fitter, &candidate));
    if (fitter->request.observe)
        fitter->request.observe(&candidate, fitter->request.context);
    *out = candidate;
    candidate = (ritz_fit_candidate){0};
done:
    ritz_fit_candidate_free(&candidate);
    return status;
}

static void free_place(const ritz_fitter *fitter, ritz_fit_place *place)
{
    ritz_reference_free(&place->reference);
    ritz_estimator_free(&place->estimator);
    free(place->master);
    if (fitter->scene)
        ritz_component_free(&place->full);
    else
        ritz_fit_uninstall(&place->full);
    free(place->setting);
}

void ritz_fitter_free(ritz_fitter **fitter)
{
    ritz_fitter *f = *fitter;

    if (!f)
        return;
    for (int64_t k = 0; k < f->num_places; k++)
        free_place(f, &f->place[k]);
    for (int64_t k = 0; f->model && k < f->num_bodies; k++)
        ritz_component_free(&f->model[k]);
    for (int64_t k = 0; f->still && k < f->scene->num_components; k++)
        ritz_reduced_free(&f->still[k]);
    for (int64_t k = 0; k < f->num_made; k++)
        ritz_reduced_free(&f->made[k].reduced);
    ritz_fit_second_free(f->num_bodies, &f->second);
    ritz_dofs_free(&f->attached);
    free(f->place);
    free(f->body);
    free(f->model);
    free(f->still);
    free(f->step);
    free(f->step_hz);
    free(f->made);
    free(f);
    *fitter = NULL;
}

void ritz_fit_candidate_free(ritz_fit_candidate *candidate)
{
    free(candidate->modes);
    ritz_measures_free(&candidate->errors);
    ritz_measures_free(&candidate->estimates);
    *candidate = (ritz_fit_candidate){0};
}

void ritz_fit_free(ritz_fit *fit)
{
    for (int64_t k = 0; k < fit->count; k++)
        ritz_fit_candidate_free(&fit->candidate[k]);
    free(fit->candidate);
    free(fit->method);
    free(fit->best);
    free(fit->reached);
    free(fit->end);
    *fit = (ritz_fit){0};
}
