/*
 * A fitter: the full model prepared wherever candidates are compared with it, a
 * component as it is, a scene at its configurations and at random ones between.
 */
#include "fit/fitter.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/assembly.h>
#include <ritz/base.h>
#include <ritz/matrix.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Beyond what the band holds: how far orders are tried. */
enum { PER_MODE = 4, BESIDE = 40 };

/* Of a component: some columns for each mode of the band, or all dofs. */
static int64_t largest_order(const ritz_fitter *f)
{
    int64_t rigid = 0;
    int64_t modes = ritz_reference_modes(f->place[0].reference, &rigid);
    int64_t usual = PER_MODE * (modes + rigid) + f->attached.count + BESIDE;
    int64_t all = f->component->num_dofs;

    if (f->request.largest > 0)
        return f->request.largest;
    return usual < all ? usual : all;
}

static ritz_status refer_place(const ritz_fit_request *request,
                               ritz_fit_place *place)
{
    const ritz_reference_request asked = {
        .band_hz = {request->tolerance.band_hz[0],
                    request->tolerance.band_hz[1]},
        .damping = request->tolerance.damping,
        .tolerance = request->tolerance.limit[RITZ_MEASURE_FLEXIBLE],
        .num_random = request->num_random,
        .seed = request->seed,
    };

    return ritz_reference_new(&place->full, &asked, &place->reference);
}

static void free_copy(ritz_component *copy)
{
    ritz_sparse_free(&copy->K);
    ritz_sparse_free(&copy->D);
    ritz_dampers_free(&copy->dampers);
    *copy = (ritz_component){0};
}

/* A copy with K and D of its own, its dampers installed. */
static ritz_status install_copy(const ritz_component *component,
                                ritz_component *out)
{
    *out = *component; /* all but what follows is borrowed */
    out->K = out->D = (ritz_sparse){0};
    out->dampers = (ritz_dampers){0};
    RITZ_CHECK(ritz_sparse_copy(&component->K, &out->K));
    if (component->D.colptr)
        RITZ_CHECK(ritz_sparse_copy(&component->D, &out->D));
    RITZ_CHECK(ritz_dampers_copy(&component->dampers, &out->dampers));
    return ritz_component_install(out);
}

/* A tolerance needs something to be measured by. */
static ritz_status check_limit(const ritz_component *full,
                               const ritz_verify_request *limits,
                               const ritz_measure_kind *kind)
{
    const ritz_io *io = &full->io;
    const bool damped = limits->damping.kind != RITZ_DAMPING_NONE ||
                        full->damping[0] || full->D.colptr || full->K4.colptr;

    RITZ_REFUSE_IF(kind->needs & RITZ_NEEDS_CHANNELS &&
                       (io->num_inputs == 0 || io->num_outputs == 0),
                   RITZ_ERR_ARGUMENT,
                   "a tolerance of '%s' needs inputs and outputs, and there "
                   "are %" PRId64 " and %" PRId64 ": 'frequency=X' needs none",
                   kind->word, io->num_inputs, io->num_outputs);
    RITZ_REFUSE_IF(
        kind->needs & RITZ_NEEDS_DAMPING && !damped, RITZ_ERR_ARGUMENT,
        "a tolerance of '%s' needs a model that is damped: --damping",
        kind->word);
    return RITZ_OK;
}

static ritz_status check_limits(const ritz_verify_request *limits,
                                const ritz_component *full)
{
    bool any = false;

    for (int k = 0; k < RITZ_MEASURES; k++) {
        if (isnan(limits->limit[k]))
            continue;
        any = any || k != RITZ_MEASURE_MISSING || limits->limit[k] == 0.0;
        RITZ_CHECK(check_limit(full, limits, &ritz_measure_table[k]));
    }
    RITZ_REFUSE_IF(!any, RITZ_ERR_ARGUMENT,
                   "no tolerance is given: which measure, how far off");
    return RITZ_OK;
}

/* Where nothing moves rigidly the flexible response is the response. */
static void settle_limits(const ritz_reference *reference,
                          ritz_verify_request *limits)
{
    double *limit = limits->limit;
    int64_t rigid = 0;

    if (!isnan(limit[RITZ_MEASURE_DAMPING])) /* a missing mode has no damping */
        limit[RITZ_MEASURE_MISSING] = fmax(limit[RITZ_MEASURE_MISSING], 0.0);
    (void)ritz_reference_modes(reference, &rigid);
    if (rigid > 0)
        return;
    limit[RITZ_MEASURE_RESPONSE] =
        fmin(limit[RITZ_MEASURE_RESPONSE], limit[RITZ_MEASURE_FLEXIBLE]);
    limit[RITZ_MEASURE_FLEXIBLE] = nan("");
}

ritz_status ritz_fit_estimator(const ritz_fitter *fitter,
                               const ritz_component *full,
                               ritz_fit_place *place)
{
    const ritz_verify_request *limits = &fitter->request.tolerance;
    const ritz_estimate_request asked = {
        .band_hz = {limits->band_hz[0], limits->band_hz[1]},
        .damping = limits->damping,
        .modes = ritz_reference_pairs(place->reference)};

    if (!fitter->request.estimates)
        return RITZ_OK;
    return ritz_estimator_new(full, &asked, &place->estimator);
}

/* Listed settings, and random ones between a listed one and the next. */
static ritz_status make_places(ritz_fitter *f)
{
    const ritz_scene *scene = f->scene;
    const int64_t h = scene->num_sweeps;
    const int64_t listed = scene->num_configurations;
    int64_t between = listed > 1 ? f->request.num_between : 0;
    uint64_t seed = f->request.seed;

    RITZ_REFUSE_IF(listed < 1, RITZ_ERR_ARGUMENT,
                   "the scene has no configuration");
    RITZ_CHECK_NEW(f->place, listed + between);
    f->num_listed = listed;
    for (int64_t k = 0; k < listed + between; k++) {
        ritz_fit_place *place = &f->place[f->num_places++];
        double at = (double)(listed - 1) * ritz_random_next(&seed);
        int64_t from = k < listed ? k : (int64_t)at;
        const double *a = scene->setting + from * h;

        RITZ_CHECK_NEW(place->setting, h);
        for (int64_t j = 0; j < h; j++)
            place->setting[j] =
                k < listed ? a[j]
                           : a[j] + (at - (double)from) * (a[h + j] - a[j]);
        (void)snprintf(place->at, sizeof place->at, "as joined");
        if (h > 0)
            ritz_configuration_name(h, (const char *)scene->sweep,
                                    sizeof *scene->sweep, place->setting,
                                    place->at);
    }
    return RITZ_OK;
}

double ritz_fit_rich_to(const ritz_verify_request *limits)
{
    double finest = HUGE_VAL;

    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];
        double allowed = ritz_measure_error(kind->name, limits->limit[k]);

        if (kind->unit[0] == '\0' && allowed > 0.0) /* NaN: not given */
            finest = fmin(finest, allowed);
    }
    return fmin(RITZ_RICH_MOST,
                RITZ_RICH_TO *
                    fmax(1.0, sqrt(10.0 * RITZ_RICH_LEAVES / finest)));
}

/* Mass normalised modes of a rich first stage as a model to compare with, which
   takes over their inputs and outputs. */
static ritz_status make_component(const ritz_scene *scene,
                                  ritz_configuration *from, ritz_component *out)
{
    enum { MATRICES = 4 };
    const ritz_dense *const matrix[MATRICES] = {&from->K, &from->M, &from->D,
                                                &from->K4};
    RITZ_OWN(ritz_component) made = {.num_dofs = from->K.ncol};
    ritz_sparse *const into[MATRICES] = {&made.K, &made.M, &made.D, &made.K4};

    for (int k = 0; k < MATRICES; k++)
        if (matrix[k]->val)
            RITZ_CHECK(ritz_sparse_from_dense(matrix[k], into[k]));
    RITZ_MOVE(made.io, from->io);
    RITZ_CHECK_NEW(made.dof, made.num_dofs);
    for (int64_t j = 0; j < made.num_dofs; j++)
        made.dof[j] = (ritz_dof){.grid = j + 1};
    ritz_damping_print(&scene->damping, made.damping);
    RITZ_CHECK(ritz_component_settle(&made, false));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

/* The same in the place of full systems. */
static ritz_status rich_systems(ritz_fitter *f)
{
    RITZ_OWN(ritz_fit_joined) rich = {0};

    RITZ_CHECK(ritz_fit_rich(f, f->rich_hz, &rich));
    for (int64_t k = 0; k < f->num_places; k++) {
        RITZ_OWN(ritz_configuration) at = {0};

        ritz_monitor_step("first stage", k, f->num_places);
        RITZ_CHECK(ritz_stage_assemble(&rich.stage, f->place[k].setting, &at));
        RITZ_CHECK(make_component(f->scene, &at, &f->place[k].full));
    }
    return RITZ_OK;
}

static ritz_status full_systems(ritz_fitter *f)
{
    for (int64_t k = 0; k < f->num_places; k++) {
        ritz_fit_place *place = &f->place[k];

        ritz_monitor_step("full system", k, f->num_places);
        RITZ_CHECK_IN(place->at,
                      ritz_assemble_full(f->scene, place->setting, &place->full,
                                         &place->master));
        RITZ_CHECK_IN(place->at, ritz_component_install(&place->full));
    }
    return RITZ_OK;
}

static ritz_status refer_scene(ritz_fitter *f)
{
    int64_t dofs = 0;

    for (int64_t k = 0; k < f->num_bodies; k++)
        dofs += f->model[k].num_dofs;
    f->rich = f->rich || dofs > f->request.most_full;
    RITZ_CHECK(f->rich ? rich_systems(f) : full_systems(f));
    for (int64_t k = 0; k < f->num_places; k++) {
        ritz_monitor_step("modes of the full system", k, f->num_places);
        RITZ_CHECK_IN(f->place[k].at, refer_place(&f->request, &f->place[k]));
        if (!f->rich && k < f->num_listed)
            RITZ_CHECK(ritz_fit_estimator(f, &f->place[k].full, &f->place[k]));
    }
    return RITZ_OK;
}

static ritz_status open_scene(const ritz_scene *scene, ritz_fitter *f)
{
    [[maybe_unused]] RITZ_OWN(ritz_orders_lent) orders =
        ritz_orders_lend(f->orders);
    [[maybe_unused]] RITZ_OWN(ritz_spectra_lent) spectra =
        ritz_spectra_lend(f->spectra);
    ritz_verify_request *limits = &f->request.tolerance;
    const ritz_io *io = NULL;

    if (!(limits->band_hz[1] > 0.0))
        memcpy(limits->band_hz, scene->band_hz, sizeof limits->band_hz);
    if (limits->damping.kind == RITZ_DAMPING_NONE)
        limits->damping = scene->damping;
    RITZ_REFUSE_IF(!(limits->band_hz[1] > 0.0), RITZ_ERR_ARGUMENT,
                   "the scene has no band: where is the tolerance to hold");
    f->rich_hz = ritz_fit_rich_to(limits) * limits->band_hz[1];
    RITZ_CHECK(ritz_fit_bodies(f));
    RITZ_CHECK(make_places(f));
    RITZ_CHECK(refer_scene(f));
    RITZ_CHECK(check_limits(limits, &f->place[0].full));
    io = &f->place[0].full.io;
    RITZ_REFUSE_IF(!isnan(limits->limit[RITZ_MEASURE_MAC]) &&
                       io->num_inputs == 0 && io->num_outputs == 0,
                   RITZ_ERR_ARGUMENT,
                   "a tolerance of 'mac' needs inputs or outputs: modes of a "
                   "scene are compared by participations in these");
    f->largest = f->request.largest > 0 ? f->request.largest : INT64_MAX;
    settle_limits(f->place[0].reference, limits);
    return RITZ_OK;
}

/* One place, and one body that nothing is joined to. */
static ritz_status open_component(const ritz_component *component,
                                  ritz_fitter *f)
{
    [[maybe_unused]] RITZ_OWN(ritz_orders_lent) orders =
        ritz_orders_lend(f->orders);
    [[maybe_unused]] RITZ_OWN(ritz_spectra_lent) spectra =
        ritz_spectra_lend(f->spectra);
    ritz_verify_request *limits = &f->request.tolerance;
    RITZ_OWN(ritz_fit_ahead) ahead = {0};

    RITZ_REFUSE_IF(!(limits->band_hz[1] > 0.0), RITZ_ERR_ARGUMENT,
                   "there is no band: where is the tolerance to hold");
    if (limits->damping.kind == RITZ_DAMPING_NONE && component->damping[0])
        RITZ_CHECK_IN("damping",
                      ritz_damping_parse(component->damping, &limits->damping));
    RITZ_CHECK_NEW(f->body, 1);
    RITZ_CHECK_NEW(f->equal, 1);
    RITZ_CHECK_NEW(f->place, 1);
    RITZ_CHECK(ritz_bodies_new(1, &f->still));
    f->num_bodies = f->num_places = f->num_listed = 1;
    RITZ_CHECK(install_copy(component, &f->place[0].full));
    RITZ_CHECK(check_limits(limits, &f->place[0].full));
    RITZ_CHECK(
        ritz_component_attached(component, f->request.attach, &f->attached));
    ritz_monitor_step("full model", 0, 0);
    RITZ_CHECK(ritz_fit_ahead_begin(f, &ahead));
    RITZ_CHECK(refer_place(&f->request, &f->place[0]));
    RITZ_CHECK(ritz_fit_ahead_store(&ahead));
    if (component->dampers.count == 0) /* bases are made without dampers */
        RITZ_CHECK(ritz_fit_estimator(f, component, &f->place[0]));
    f->largest = largest_order(f);
    settle_limits(f->place[0].reference, limits);
    return RITZ_OK;
}

/* Most entries of T of all kept bases, of T of all bodies that were made, and of
   the modes of a scene's bodies: half a gigabyte each. */
static const int64_t most_entries = INT64_C(1) << 26;

ritz_status ritz_fitter_new(const ritz_component *component,
                            const ritz_fit_request *request, ritz_fitter **out)
{
    RITZ_OWN(ritz_fitter) *f = NULL;

    RITZ_CHECK_NEW(f, 1);
    f->request = *request;
    f->most_entries = most_entries;
    f->component = component;
    RITZ_CHECK(ritz_orders_new(&f->orders));
    RITZ_CHECK(ritz_spectra_new(&f->spectra));
    RITZ_CHECK(open_component(component, f));
    RITZ_MOVE(*out, f);
    return RITZ_OK;
}

ritz_status ritz_fitter_scene(const ritz_scene *scene,
                              const ritz_fit_request *request,
                              ritz_fitter **out)
{
    RITZ_OWN(ritz_fitter) *f = NULL;

    RITZ_CHECK_NEW(f, 1);
    f->request = *request;
    f->scene = scene;
    f->most_entries = most_entries;
    RITZ_CHECK(ritz_orders_new(&f->orders));
    RITZ_CHECK(ritz_spectra_new(&f->spectra));
    RITZ_CHECK(open_scene(scene, f));
    RITZ_MOVE(*out, f);
    return RITZ_OK;
}

ritz_status ritz_fit_go_on(ritz_fitter *f)
{
    if (f->request.stop && f->request.stop(f->request.context))
        f->stopped = true;
    RITZ_REFUSE_IF(f->stopped, RITZ_ERR_CONVERGENCE,
                   "the search was interrupted");
    return RITZ_OK;
}

const ritz_verify_request *ritz_fitter_tolerance(const ritz_fitter *fitter)
{
    return &fitter->request.tolerance;
}

int64_t ritz_fitter_bodies(const ritz_fitter *fitter)
{
    return fitter->num_bodies;
}

void ritz_fitter_describe(const ritz_fitter *fitter, int64_t size, char *out)
{
    const int64_t listed = fitter->num_listed;
    const ritz_component *full = &fitter->place[0].full;

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

static void free_place(const ritz_fitter *fitter, ritz_fit_place *place)
{
    ritz_reference_free(&place->reference);
    ritz_estimator_free(&place->estimator);
    free(place->master);
    if (fitter->scene)
        ritz_component_free(&place->full);
    else
        free_copy(&place->full);
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
    for (int64_t k = 0; f->known && k < f->num_bodies; k++)
        ritz_pairs_free(&f->known[k]);
    ritz_bodies_free(&f->still);
    ritz_orders_free(&f->orders);
    ritz_spectra_free(&f->spectra);
    for (int64_t k = 0; k < f->num_made; k++) {
        ritz_reduced_free(&f->made[k].reduced);
        ritz_dense_free(&f->made[k].parts);
    }
    for (int64_t k = 0; k < f->num_families; k++)
        ritz_fit_family_free(&f->family[k]);
    for (int64_t k = 0; k < f->num_ordered; k++)
        ritz_fit_ordered_free(&f->ordered[k]);
    ritz_fit_second_free(&f->second);
    ritz_dofs_free(&f->attached);
    RITZ_FREE(f->place, f->body, f->model, f->equal, f->known, f->step, f->made,
              f->family, f->ordered, f);
    *fitter = NULL;
}
