/*
 * What configurations give to the composite set, in modal coordinates: modes as
 * long as they matter, static answers, and all that stage one has. See
 * composite_order.c for what becomes of it.
 */
#include "compare/composite_given.h"

#include "base/alloc.h"

#include <ritz/eigen.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Values of all modes, the largest of all is 1. */
static ritz_status weigh(ritz_givens *g)
{
    double largest = 0.0;

    for (int64_t k = 0; k < g->system.num_configurations; k++) {
        const ritz_configuration *at = &g->system.configuration[k];
        int64_t flexible = at->K.ncol - at->num_rigid;

        g->each[k].at = at;
        RITZ_CHECK_NEW(g->each[k].value, flexible);
        RITZ_CHECK(ritz_compare_values(g->stage->scene, at, g->each[k].value));
        for (int64_t j = 0; j < flexible; j++)
            largest = fmax(largest, g->each[k].value[j]);
    }
    for (int64_t k = 0; k < g->system.num_configurations; k++)
        for (int64_t j = g->each[k].at->num_rigid; j < g->each[k].at->K.ncol;
             j++)
            g->each[k].value[j - g->each[k].at->num_rigid] /=
                largest > 0.0 ? largest : 1.0;
    return RITZ_OK;
}

/* Columns of flexible modes up to some lambda, so long. */
static ritz_status choose_modes(const ritz_configuration *at, double highest,
                                const double *length, ritz_dense *out)
{
    int64_t count = 0;

    RITZ_CHECK(ritz_dense_new(at->K.ncol, at->K.ncol - at->num_rigid, out));
    for (int64_t k = at->num_rigid; k < at->K.ncol; k++)
        if (at->lambda[k] <= highest)
            ritz_dense_col(out, count++)[k] =
                length ? length[k - at->num_rigid] : 1.0;
    out->ncol = count;
    return RITZ_OK;
}

static ritz_status give(const ritz_givens *g, ritz_given *to)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = g->stage->scene;
    const ritz_plan plan = {.augment = RITZ_AUGMENT_SYSTEM,
                            .attached =
                                RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_OUTPUTS};
    ritz_dense band = {0}, answers = {0};

    RITZ_TRY(ritz_composite_choose(scene, to->at, NULL, RITZ_GIVEN_RIGID, &plan,
                                   &to->X[RITZ_GROUP_RIGID]));
    RITZ_TRY(ritz_composite_choose(scene, to->at, NULL, RITZ_GIVEN_STATIC,
                                   &plan, &answers));
    RITZ_TRY(choose_modes(to->at, g->lambda, to->value, &band));
    RITZ_TRY(choose_modes(to->at, HUGE_VAL, NULL, &to->X[RITZ_GROUP_REST]));
    if (scene->augment == RITZ_AUGMENT_NONE) {
        to->X[RITZ_GROUP_BAND] = band;
        to->X[RITZ_GROUP_STATIC] = answers;
        band = answers = (ritz_dense){0};
    } else {
        RITZ_TRY(ritz_dense_beside(&band, &answers, &to->X[RITZ_GROUP_BAND]));
        RITZ_TRY(ritz_dense_new(band.nrow, 0, &to->X[RITZ_GROUP_STATIC]));
    }
done:
    ritz_dense_free(&band);
    ritz_dense_free(&answers);
    return status;
}

ritz_status ritz_givens_gather(const ritz_givens *g, int64_t body, int group,
                               ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int64_t r = g->stage->body[body].K.ncol;
    int64_t used = 0;
    ritz_dense part = {0};

    for (int64_t k = 0; k < g->system.num_configurations; k++)
        used += g->each[k].X[group].ncol;
    RITZ_TRY(ritz_dense_new(r, used, out));
    used = 0;
    for (int64_t k = 0; k < g->system.num_configurations; k++) {
        RITZ_TRY(ritz_dense_mul(&g->each[k].at->P[body], &g->each[k].X[group],
                                &part));
        if (r * part.ncol > 0)
            memcpy(ritz_dense_col(out, used), part.val,
                   (size_t)(r * part.ncol) * sizeof *part.val);
        used += part.ncol;
        ritz_dense_free(&part);
    }
done:
    ritz_dense_free(&part);
    return status;
}

ritz_status ritz_givens_new(const ritz_stage *stage, ritz_givens *out)
{
    ritz_status status = RITZ_OK;
    ritz_givens g = {.stage = stage,
                     .lambda = ritz_eigen_lambda(stage->scene->band_hz[1])};

    RITZ_FAIL_IF(!(g.lambda > 0.0), RITZ_ERR_ARGUMENT,
                 "the scene has no band: which modes are to be kept");
    RITZ_TRY_IN("stage 1", ritz_assemble(stage, NULL, &g.system));
    RITZ_NEW(g.each, g.system.num_configurations);
    RITZ_NEW(g.scale, stage->num_coordinates);
    ritz_stage_scale(stage, g.scale);
    RITZ_TRY_IN("selection", weigh(&g));
    for (int64_t k = 0; k < g.system.num_configurations; k++)
        RITZ_TRY(give(&g, &g.each[k]));
    *out = g;
    g = (ritz_givens){0};
done:
    ritz_givens_free(&g);
    return status;
}

void ritz_givens_free(ritz_givens *g)
{
    for (int64_t k = 0; g->each && k < g->system.num_configurations; k++) {
        for (int group = 0; group < RITZ_GROUPS; group++)
            ritz_dense_free(&g->each[k].X[group]);
        free(g->each[k].value);
    }
    free(g->each);
    free(g->scale);
    ritz_system_free(&g->system);
    *g = (ritz_givens){0};
}
