/* A scene prepared: the full system wherever candidates are compared. */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <ritz/eigen.h>
#include <ritz/monitor.h>
#include <ritz/synthesis.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * A first stage that stands for the full system: modes of bodies up to this
 * part of the band, and further where a tolerance is finer than ten times what
 * that leaves. Measured on beams by Craig-Bampton: frequencies in the band err
 * by 6.4e-5 at 8 times the band, and from 4 times fell faster than its square.
 */
static const double rich_to = 8.0, rich_leaves = 6.4e-5;
/* Bodies of a solid have modes as the third power of it. */
static const double rich_most = 32.0;

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
    for (int64_t k = 0; k < listed + between; k++) {
        ritz_fit_place *place = &f->place[f->num_places++];
        double at = (double)(listed - 1) * ritz_random_next(&seed);
        int64_t from = k < listed ? k : (int64_t)at;
        const double *a = scene->setting + from * h;

        place->listed = k < listed;
        RITZ_CHECK_NEW(place->setting, h);
        for (int64_t j = 0; j < h; j++)
            place->setting[j] =
                place->listed ? a[j]
                              : a[j] + (at - (double)from) * (a[h + j] - a[j]);
        (void)snprintf(place->at, sizeof place->at, "as joined");
    }
    return RITZ_OK;
}

/* "clock=60,cone=0" of each place. */
static ritz_status name_places(ritz_fitter *f)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = f->scene;
    char(*name)[RITZ_NAME_SIZE] = NULL;

    if (scene->num_sweeps == 0)
        return RITZ_OK;
    RITZ_NEW(name, scene->num_sweeps);
    for (int64_t j = 0; j < scene->num_sweeps; j++)
        memcpy(name[j], scene->sweep[j].name, sizeof name[j]);
    for (int64_t k = 0; k < f->num_places; k++)
        ritz_configuration_name(scene->num_sweeps,
                                (const char(*)[RITZ_NAME_SIZE])name,
                                f->place[k].setting, f->place[k].at);
done:
    free(name);
    return status;
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
    return fmin(rich_most,
                rich_to * fmax(1.0, sqrt(10.0 * rich_leaves / finest)));
}

/* Mass normalised modes of a rich first stage as a model to compare with. */
static ritz_status as_component(const ritz_configuration *from,
                                const ritz_scene *scene, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    enum { MATRICES = 4 };
    const ritz_dense *const matrix[MATRICES] = {&from->K, &from->M, &from->D,
                                                &from->K4};
    ritz_component made = {.num_dofs = from->K.ncol};
    ritz_sparse *const into[MATRICES] = {&made.K, &made.M, &made.D, &made.K4};
    ritz_dense eye = {0};

    RITZ_TRY(ritz_dense_new(made.num_dofs, made.num_dofs, &eye));
    for (int64_t j = 0; j < made.num_dofs; j++)
        ritz_dense_col(&eye, j)[j] = 1.0;
    for (int k = 0; k < MATRICES; k++)
        if (matrix[k]->val)
            RITZ_TRY(ritz_sparse_from_dense(matrix[k], into[k]));
    RITZ_TRY(ritz_io_project(&from->io, &eye, &made.io));
    RITZ_NEW(made.dof, made.num_dofs);
    for (int64_t j = 0; j < made.num_dofs; j++)
        made.dof[j] = (ritz_dof){.grid = j + 1};
    ritz_damping_print(&scene->damping, made.damping);
    RITZ_TRY(ritz_component_settle(&made, false));
    *out = made;
    made = (ritz_component){0};
done:
    ritz_dense_free(&eye);
    ritz_component_free(&made);
    return status;
}

ritz_status ritz_fit_rich(ritz_fitter *f, double up_to_hz, ritz_stage *out)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = f->scene;
    ritz_reduced *body = NULL;

    RITZ_NEW(body, scene->num_components);
    for (int64_t k = 0; k < scene->num_components; k++)
        body[k] = f->still[k]; /* lent */
    for (int64_t k = 0; k < f->num_bodies; k++) {
        ritz_scene_component item = scene->component[f->body[k]];

        item.modes = -1;
        item.up_to_hz = up_to_hz;
        RITZ_TRY_IN(item.name,
                    ritz_stage_reduce(scene, f->body[k], &item, &f->model[k],
                                      &body[f->body[k]]));
    }
    RITZ_TRY(ritz_stage_from(scene, body, out));
done:
    if (status != RITZ_OK)
        ritz_fit_take_back(f, body);
    for (int64_t k = 0; body && k < f->num_bodies; k++)
        ritz_reduced_free(&body[f->body[k]]);
    free(body);
    return status;
}

void ritz_fit_rich_free(ritz_fitter *f, ritz_stage *stage)
{
    ritz_fit_take_back(f, stage->body);
    ritz_stage_free(stage);
}

/* The same in the place of full systems. */
static ritz_status rich_systems(ritz_fitter *f)
{
    ritz_status status = RITZ_OK;
    ritz_stage stage = {0};
    ritz_configuration at = {0};

    RITZ_TRY(ritz_fit_rich(f, f->rich_hz, &stage));
    for (int64_t k = 0; k < f->num_places; k++) {
        ritz_monitor_step("first stage", k, f->num_places);
        RITZ_TRY(ritz_stage_assemble(&stage, f->place[k].setting, &at));
        RITZ_TRY(as_component(&at, f->scene, &f->place[k].full));
        ritz_configuration_free(&at);
    }
done:
    ritz_configuration_free(&at);
    ritz_fit_rich_free(f, &stage);
    return status;
}

static ritz_status full_systems(ritz_fitter *f)
{
    for (int64_t k = 0; k < f->num_places; k++) {
        ritz_fit_place *place = &f->place[k];

        ritz_monitor_step("full system", k, f->num_places);
        RITZ_CHECK_IN(place->at,
                      ritz_assemble_masters(f->scene, place->setting,
                                            &place->full, &place->master));
        RITZ_CHECK_IN(place->at, ritz_component_install(&place->full));
        if (place->listed)
            RITZ_CHECK(ritz_fit_estimator(f, &place->full, place));
    }
    return RITZ_OK;
}

static ritz_status refer(ritz_fitter *f)
{
    int64_t dofs = 0;

    for (int64_t k = 0; k < f->num_bodies; k++)
        dofs += f->model[k].num_dofs;
    f->rich = f->rich || dofs > f->request.most_full;
    RITZ_CHECK(f->rich ? rich_systems(f) : full_systems(f));
    for (int64_t k = 0; k < f->num_places; k++) {
        ritz_monitor_step("modes of the full system", k, f->num_places);
        RITZ_CHECK_IN(f->place[k].at,
                      ritz_fit_refer(&f->request, &f->place[k]));
    }
    return RITZ_OK;
}

ritz_status ritz_fitter_scene(const ritz_scene *scene,
                              const ritz_fit_request *request,
                              ritz_fitter **out)
{
    ritz_status status = RITZ_OK;
    ritz_fitter *f = NULL;
    ritz_verify_request *limits = NULL;

    RITZ_NEW(f, 1);
    f->request = *request;
    f->scene = scene;
    limits = &f->request.tolerance;
    if (!(limits->band_hz[1] > 0.0))
        memcpy(limits->band_hz, scene->band_hz, sizeof limits->band_hz);
    if (limits->damping.kind == RITZ_DAMPING_NONE)
        limits->damping = scene->damping;
    RITZ_FAIL_IF(!(limits->band_hz[1] > 0.0), RITZ_ERR_ARGUMENT,
                 "the scene has no band: where is the tolerance to hold");
    f->rich_hz = ritz_fit_rich_to(limits) * limits->band_hz[1];
    RITZ_TRY(ritz_fit_bodies(f));
    RITZ_TRY(make_places(f));
    RITZ_TRY(name_places(f));
    RITZ_TRY(refer(f));
    RITZ_TRY(ritz_fit_check(limits, &f->place[0].full));
    RITZ_FAIL_IF(!isnan(limits->limit[RITZ_MEASURE_MAC]) &&
                     f->place[0].full.io.num_inputs == 0 &&
                     f->place[0].full.io.num_outputs == 0,
                 RITZ_ERR_ARGUMENT,
                 "a tolerance of 'mac' needs inputs or outputs: of a scene it "
                 "is that of what they see");
    ritz_fit_settle(f->place[0].reference, limits);
    f->largest = request->largest > 0 ? request->largest : INT64_MAX;
    *out = f;
    f = NULL;
done:
    ritz_fitter_free(&f);
    return status;
}
