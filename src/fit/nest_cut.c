/* A scene's system with some of the columns of its bodies, and how far off it
   is. */
#include "fit/nest_parts.h"

#include "base/alloc.h"

#include <ritz/nested.h>
#include <ritz/synthesis.h>

#include <stdlib.h>

int64_t ritz_fit_own(const ritz_fit_nesting *n, int64_t k, int64_t count,
                     const int64_t *column)
{
    int64_t found = 0;

    for (int64_t j = 0; j < count; j++)
        if (column[j] >= n->first[k] && column[j] < n->first[k + 1])
            n->own[found++] = column[j] - n->first[k];
    return found;
}

/* Those columns of a body; T and invariants have nothing to say here. */
static ritz_status cut(const ritz_fit_nesting *n, int64_t k, int64_t count,
                       const int64_t *column, ritz_reduced *out)
{
    ritz_reduced bare = n->whole[k]; /* borrowed */

    bare.T = (ritz_dense){0};
    bare.invariants = (ritz_invariants){0};
    return ritz_reduced_nest(&bare, ritz_fit_own(n, k, count, column), n->own,
                             1, out);
}

static void part(const ritz_fit_nesting *n, ritz_reduced *body,
                 ritz_stage *stage)
{
    ritz_reduced *all = stage->body ? stage->body : body;

    ritz_fit_take_back(n->f, all);
    for (int64_t k = 0; all && k < n->f->num_bodies; k++)
        ritz_reduced_free(&all[n->f->body[k]]);
    ritz_stage_free(stage);
}

/* Those columns joined. Bodies that stay as they are, are lent. */
static ritz_status join(const ritz_fit_nesting *n, int64_t count,
                        const int64_t *column, ritz_stage *out)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = n->f->scene;
    ritz_reduced *body = NULL;
    ritz_stage stage = {0};

    RITZ_NEW(body, scene->num_components);
    for (int64_t k = 0; k < scene->num_components; k++)
        body[k] = n->f->still[k];
    for (int64_t k = 0; k < n->f->num_bodies; k++)
        RITZ_TRY(cut(n, k, count, column, &body[n->f->body[k]]));
    RITZ_TRY(ritz_stage_from(scene, body, &stage));
    *out = stage;
    stage = (ritz_stage){0};
done:
    if (!out->body)
        part(n, body, &stage);
    free(body);
    return status;
}

/* The system at one place, its errors among the worst so far. */
static ritz_status measure_at(const ritz_fit_nesting *n,
                              const ritz_stage *stage,
                              const ritz_fit_place *place, int where,
                              ritz_fit_candidate *judged)
{
    ritz_status status = RITZ_OK;
    const ritz_verify_request *limits = &n->f->request.tolerance;
    ritz_configuration at = {0};
    ritz_measures found = {0};

    RITZ_TRY(ritz_stage_assemble(stage, place->setting, &at));
    if (at.K.ncol > judged->order)
        judged->order = at.K.ncol;
    RITZ_TRY(ritz_reference_measure_at(place->reference, &at, limits, where,
                                       &found));
    RITZ_TRY(ritz_fit_worst(&found, place->at, &judged->errors));
    ritz_fit_judge(limits, judged);
    if (where && judged->feasible) {
        const ritz_second_order model = {&at.K, &at.M, &at.D, NULL, &at.io};

        RITZ_TRY(ritz_fit_probe(&model, &limits->damping, judged));
    }
done:
    ritz_measures_free(&found);
    ritz_configuration_free(&at);
    return status;
}

/*
 * How far the system of some columns is off at listed places, on the grid. It
 * begins where the one before was farthest off: what is as far off there as
 * `most` is not measured elsewhere.
 */
ritz_status ritz_fit_excess_of(void *context, int64_t count,
                               const int64_t *column, double most, double *out)
{
    ritz_status status = RITZ_OK;
    ritz_fit_nesting *n = context;
    const int64_t listed = n->f->scene->num_configurations;
    const int64_t places = (listed + n->every - 1) / n->every;
    const int64_t from = n->hardest;
    ritz_fit_candidate judged = {0};
    ritz_stage stage = {0};

    RITZ_TRY(join(n, count, column, &stage));
    for (int64_t t = 0; t < places && (t == 0 || judged.excess < most); t++) {
        const int64_t k = (from + t) % places;
        const double before = judged.excess;

        RITZ_TRY(measure_at(n, &stage, &n->f->place[k * n->every], 0, &judged));
        if (judged.excess > before)
            n->hardest = k;
    }
done:
    status = ritz_fit_refuse(status, &judged);
    *out = judged.excess;
    part(n, NULL, &stage);
    ritz_fit_candidate_free(&judged);
    return status;
}

/* The system of some columns at places, of which the listed ones are first. */
static ritz_status measure(const ritz_fit_nesting *n, int64_t count,
                           const int64_t *column, int where,
                           ritz_fit_candidate *out)
{
    ritz_status status = RITZ_OK;
    const int64_t places =
        where ? n->f->num_places : n->f->scene->num_configurations;
    ritz_stage stage = {0};

    RITZ_TRY(join(n, count, column, &stage));
    for (int64_t k = 0; k < places && out->refusal[0] == '\0'; k++)
        RITZ_TRY(measure_at(n, &stage, &n->f->place[k], where, out));
done:
    part(n, NULL, &stage);
    return ritz_fit_refuse(status, out);
}

ritz_status ritz_fit_judge_cut(const ritz_fit_nesting *n, int64_t count,
                               const int64_t *column, ritz_fit_candidate *out)
{
    const ritz_reference *reference = n->f->place[0].reference;
    int where = ritz_fit_places(reference, &out->errors);

    if (!(where & RITZ_AT_OTHER_POLES)) { /* unless there is need of them */
        RITZ_CHECK(measure(n, count, column, 0, out));
        where = ritz_fit_places(reference, &out->errors);
        ritz_measures_free(&out->errors);
    }
    if (out->refusal[0] == '\0')
        RITZ_CHECK(measure(n, count, column, where, out));
    if (out->refusal[0])
        ritz_measures_free(&out->errors);
    return RITZ_OK;
}
