/*
 * A candidate of a scene as it is joined: bounded and measured at every listed
 * configuration; what meets the tolerance there, at random ones too.
 */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

ritz_status ritz_fit_worst(const ritz_measures *more, const char *at,
                           ritz_measures *worst)
{
    char where[RITZ_NAME_SIZE];

    for (int64_t k = 0; k < more->count; k++) {
        const ritz_measure *m = &more->item[k];
        ritz_measure *old = ritz_measures_find(worst, m->name);

        (void)snprintf(where, sizeof where, "%.28s%s%.32s", at,
                       at[0] && m->where[0] ? ": " : "", m->where);
        if (!old) {
            RITZ_CHECK(
                ritz_measures_add(worst, m->name, m->value, m->limit, where));
        } else if (ritz_measure_is_worse(m->name, m->value, old->value)) {
            old->value = m->value;
            memcpy(old->where, where, sizeof where);
        }
    }
    return RITZ_OK;
}

/* Whether all bodies have their T. */
static bool has_bases(const ritz_stage *stage)
{
    bool all = true;

    for (int64_t k = 0; k < stage->count; k++)
        all = all && stage->body[k].T.val;
    return all;
}

/*
 * Bounds of the candidate at one place, as it is assembled there: what decides,
 * or, with no @p verdict, all.
 */
static ritz_status foresee(const ritz_fitter *f, const ritz_stage *stage,
                           const ritz_fit_place *place,
                           const ritz_configuration *at,
                           ritz_fit_candidate *candidate,
                           ritz_fit_verdict *verdict)
{
    ritz_status status = RITZ_OK;
    const ritz_reduced lent = {
        .K = at->K, .M = at->M, .D = at->D, .K4 = at->K4, .io = at->io};
    ritz_measures found = {0};
    ritz_dense T = {0};

    RITZ_TRY(
        ritz_stage_basis(stage, at, place->full.num_dofs, place->master, &T));
    if (verdict) {
        RITZ_TRY(ritz_fit_foresee(f, place, &T, &lent, candidate, verdict));
    } else {
        RITZ_TRY(ritz_fit_bound_at(place, &T, &lent, false, &found));
        ritz_fit_forget_least(&found);
        RITZ_TRY(ritz_fit_worst(&found, place->at, &candidate->estimates));
    }
done:
    ritz_measures_free(&found);
    ritz_dense_free(&T);
    return status;
}

/* Its errors there are among the worst so far. */
static ritz_status measure(ritz_fitter *f, const ritz_fit_place *place,
                           const ritz_configuration *at, int where,
                           ritz_fit_candidate *candidate)
{
    ritz_status status = RITZ_OK;
    const ritz_verify_request *limits = &f->request.tolerance;
    const ritz_second_order model = {&at->K, &at->M, &at->D, NULL, &at->io};
    ritz_measures found = {0};

    RITZ_TRY(
        ritz_reference_measure_at(place->reference, at, limits, where, &found));
    RITZ_TRY(ritz_fit_worst(&found, place->at, &candidate->errors));
    ritz_fit_judge(limits, candidate);
    if (candidate->feasible && where)
        RITZ_TRY(ritz_fit_probe(&model, &limits->damping, candidate));
    if (candidate->feasible && where && place == f->place)
        RITZ_TRY(ritz_fit_price(f, &model, candidate));
done:
    ritz_measures_free(&found);
    return status;
}

/* What bounds do not rule out is measured. */
static ritz_status look_at(ritz_fitter *f, const ritz_stage *stage,
                           const ritz_fit_place *place, int where, bool bounds,
                           ritz_fit_candidate *candidate)
{
    ritz_status status = RITZ_OK;
    ritz_fit_verdict verdict = RITZ_FIT_OPEN;
    ritz_configuration at = {0};

    RITZ_TRY(ritz_stage_assemble(stage, place->setting, &at));
    if (at.K.ncol > candidate->order)
        candidate->order = at.K.ncol;
    RITZ_FAIL_IF(candidate->order > f->largest, RITZ_ERR_ARGUMENT,
                 "an order of %" PRId64 " is more than the %" PRId64
                 " that are tried",
                 candidate->order, f->largest);
    if (bounds)
        RITZ_TRY(foresee(f, stage, place, &at, candidate, &verdict));
    if (verdict != RITZ_FIT_FAILS)
        RITZ_TRY(measure(f, place, &at, where, candidate));
done:
    ritz_configuration_free(&at);
    return status;
}

/*
 * Bounds are asked where the one before was worst, as that is where the next
 * one fails, if it does.
 */
ritz_status ritz_fit_measure_scene(ritz_fitter *f, const ritz_stage *stage,
                                   ritz_fit_candidate *candidate)
{
    bool bounds =
        !f->request.thorough && f->place[0].estimator && has_bases(stage);
    const int64_t first = f->hardest;
    double worst = 0.0;
    int where = 0;

    RITZ_CHECK(look_at(f, stage, &f->place[first], 0, bounds, candidate));
    worst = candidate->excess;
    for (int64_t k = 0; k < f->num_places && !candidate->screened; k++) {
        if (!f->place[k].listed || k == first)
            continue;
        RITZ_CHECK(look_at(f, stage, &f->place[k], 0, false, candidate));
        if (candidate->excess > worst)
            f->hardest = k;
        worst = candidate->excess;
    }
    if (!candidate->feasible || candidate->screened)
        return RITZ_OK;
    where = ritz_fit_places(f->place[0].reference, &candidate->errors);
    ritz_measures_free(&candidate->errors);
    for (int64_t k = 0; k < f->num_places && candidate->refusal[0] == '\0'; k++)
        RITZ_CHECK(look_at(f, stage, &f->place[k], where, false, candidate));
    candidate->caught = !candidate->feasible && candidate->refusal[0] == '\0';
    return RITZ_OK;
}

/* What was said of a candidate while it was sought was of one place. Its errors
 * are of random ones too, and so are its bounds. */
ritz_status ritz_fit_bound_scene(ritz_fitter *f, const ritz_stage *stage,
                                 ritz_fit_candidate *candidate)
{
    ritz_status status = RITZ_OK;
    ritz_configuration at = {0};

    ritz_measures_free(&candidate->estimates);
    for (int64_t k = 0; k < f->num_places && has_bases(stage); k++) {
        if (!f->place[0].estimator)
            continue;
        if (!f->place[k].estimator)
            RITZ_TRY(ritz_fit_estimator(f, &f->place[k].full, &f->place[k]));
        RITZ_TRY(ritz_stage_assemble(stage, f->place[k].setting, &at));
        RITZ_TRY(foresee(f, stage, &f->place[k], &at, candidate, NULL));
        ritz_configuration_free(&at);
    }
done:
    ritz_configuration_free(&at);
    return status;
}
