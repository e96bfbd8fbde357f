/*
 * A scene's candidate without columns that its tolerance can do without: the
 * last cut of its path that holds.
 */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <ritz/nested.h>
#include <ritz/synthesis.h>

#include <stdlib.h>
#include <string.h>

/* Room for flexible bodies, and for all of the scene. */
typedef struct bodies {
    ritz_reduced *whole; /* num_bodies */
    ritz_reduced *all;   /* of the scene, flexible ones nested; others empty */
    ritz_fit_path path;
} bodies;

static void free_bodies(const ritz_fitter *f, bodies *b)
{
    for (int64_t k = 0; b->whole && k < f->num_bodies; k++)
        ritz_reduced_free(&b->whole[k]);
    for (int64_t k = 0; b->all && k < f->scene->num_components; k++)
        ritz_reduced_free(&b->all[k]);
    free(b->whole);
    free(b->all);
    ritz_fit_path_free(&b->path);
    *b = (bodies){0};
}

/* All columns of the candidate's bodies, in order. */
static ritz_status lay_out(ritz_fitter *f, const ritz_fit_candidate *candidate,
                           bodies *b)
{
    RITZ_CHECK_NEW(b->whole, f->num_bodies);
    RITZ_CHECK_NEW(b->all, f->scene->num_components);
    for (int64_t k = 0; k < f->num_bodies; k++)
        RITZ_CHECK(ritz_fit_body(f, candidate->method, k, candidate->modes[k],
                                 &b->whole[k]));
    return ritz_fit_nest_scene(f, b->whole, false, b->all, &b->path);
}

/* Bodies as a row of the path cuts them, no longer nested. */
static ritz_status cut(const ritz_fitter *f, const ritz_fit_row *row,
                       const ritz_reduced *nested, ritz_reduced *out)
{
    for (int64_t k = 0; k < f->num_bodies; k++) {
        RITZ_CHECK(
            ritz_reduced_prefix(&nested[f->body[k]], row->first[k], &out[k]));
        ritz_nested_free(&out[k].nested);
    }
    return RITZ_OK;
}

ritz_status ritz_fit_make_bodies(ritz_fitter *f,
                                 const ritz_fit_candidate *candidate,
                                 ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    const ritz_fit_row *row = NULL;
    bodies b = {0};

    if (candidate->left_out == 0) {
        for (int64_t k = 0; k < f->num_bodies; k++)
            RITZ_TRY(ritz_fit_body(f, candidate->method, k, candidate->modes[k],
                                   &out[k]));
        return RITZ_OK;
    }
    RITZ_TRY(lay_out(f, candidate, &b));
    for (int64_t t = 0; t < b.path.count; t++)
        if (b.path.row[t].columns == candidate->columns)
            row = &b.path.row[t];
    RITZ_FAIL_IF(!row, RITZ_ERR_ARGUMENT,
                 "the candidate is none of this scene's: no cut of it has "
                 "%lld columns",
                 (long long)candidate->columns);
    RITZ_TRY(cut(f, row, b.all, out));
done:
    free_bodies(f, &b);
    return status;
}

/* Cut bodies joined, measured like any other candidate, and bounded. */
static ritz_status measure(ritz_fitter *f, ritz_reduced *part,
                           ritz_fit_candidate *out)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = f->scene;
    ritz_reduced *body = NULL, *home = NULL;
    ritz_stage stage = {0};

    RITZ_NEW(body, scene->num_components);
    for (int64_t k = 0; k < scene->num_components; k++)
        body[k] = f->still[k];
    for (int64_t k = 0; k < f->num_bodies; k++) {
        body[f->body[k]] = part[k];
        part[k] = (ritz_reduced){0};
    }
    home = body;
    RITZ_TRY(ritz_stage_from(scene, body, &stage));
    home = stage.body;
    RITZ_TRY(ritz_fit_measure_scene(f, &stage, out));
    if (out->feasible && f->place[0].estimator)
        RITZ_TRY(ritz_fit_bound_scene(f, &stage, out));
done:
    if (home)
        ritz_fit_take_back(f, home);
    for (int64_t k = 0; home == body && body && k < f->num_bodies; k++)
        ritz_reduced_free(&body[f->body[k]]);
    ritz_stage_free(&stage);
    free(body);
    return ritz_fit_refuse(status, out);
}

ritz_status ritz_fit_trim_scene(ritz_fitter *f, const ritz_fit_candidate *from,
                                ritz_fit_candidate *out)
{
    ritz_status status = RITZ_OK;
    ritz_fit_candidate less = {.method = from->method,
                               .num_bodies = from->num_bodies,
                               .binding = -1,
                               .spent = from->spent};
    const ritz_fit_row *row = NULL;
    ritz_reduced *part = NULL;
    bodies b = {0};

    RITZ_NEW(part, f->num_bodies);
    RITZ_NEW(less.modes, f->num_bodies);
    memcpy(less.modes, from->modes, (size_t)f->num_bodies * sizeof *less.modes);
    RITZ_TRY(lay_out(f, from, &b));
    for (int64_t t = 1; t < b.path.count; t++)
        if (b.path.row[t].feasible)
            row = &b.path.row[t];
    if (!row)
        goto done;
    RITZ_TRY(cut(f, row, b.all, part));
    less.columns = row->columns;
    less.left_out = from->columns - row->columns;
    RITZ_TRY(measure(f, part, &less));
    if (less.feasible) {
        *out = less;
        less = (ritz_fit_candidate){0};
    }
done:
    for (int64_t k = 0; part && k < f->num_bodies; k++)
        ritz_reduced_free(&part[k]);
    free(part);
    free_bodies(f, &b);
    ritz_fit_candidate_free(&less);
    return status;
}
