/* A scene's answer: bodies, nested, and the system at every configuration. */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <ritz/nested.h>
#include <ritz/synthesis.h>

#include <stdlib.h>

/* A copy of a body, what is noted of its prefixes included. */
static ritz_status copy(const ritz_reduced *from, ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    int64_t *order = NULL;

    if (from->nested.smallest > 0)
        return ritz_reduced_prefix(from, from->K.ncol, out);
    RITZ_NEW(order, from->K.ncol);
    for (int64_t k = 0; k < from->K.ncol; k++)
        order[k] = k;
    RITZ_TRY(ritz_reduced_nest(from, from->K.ncol, order, from->K.ncol, out));
    ritz_nested_free(&out->nested);
done:
    free(order);
    return status;
}

/* Those that stay copied, flexible ones made and nested. */
static ritz_status make_bodies(ritz_fitter *f,
                               const ritz_fit_candidate *candidate,
                               ritz_reduced *body, ritz_fit_path *path)
{
    ritz_status status = RITZ_OK;
    ritz_reduced *whole = NULL;

    RITZ_NEW(whole, f->num_bodies);
    RITZ_TRY(ritz_fit_make_bodies(f, candidate, whole));
    for (int64_t k = 0, j = 0; k < f->scene->num_components; k++)
        if (j < f->num_bodies && f->body[j] == k)
            j++;
        else
            RITZ_TRY(copy(&f->still[k], &body[k]));
    RITZ_TRY(ritz_fit_nest_scene(f, whole, true, body, path));
done:
    for (int64_t j = 0; whole && j < f->num_bodies; j++)
        ritz_reduced_free(&whole[j]);
    free(whole);
    return status;
}

/* Each listed configuration with its errors; they are the first places. */
static ritz_status measure(ritz_fitter *f, ritz_system *system)
{
    for (int64_t k = 0; k < system->num_configurations; k++) {
        ritz_configuration *at = &system->configuration[k];

        ritz_measures_free(&at->errors);
        RITZ_CHECK(ritz_reference_measure_at(
            f->place[k].reference, at, &f->request.tolerance,
            RITZ_AT_OTHER_POLES | RITZ_AT_RANDOM, &at->errors));
    }
    return RITZ_OK;
}

ritz_status ritz_fitter_system(ritz_fitter *f,
                               const ritz_fit_candidate *candidate,
                               ritz_reduced **body, ritz_fit_path *path,
                               ritz_system *out)
{
    ritz_status status = RITZ_OK;
    const int64_t count = f->scene->num_components;
    ritz_reduced *made = NULL, *joined = NULL;
    ritz_stage stage = {0};
    ritz_system system = {0};
    ritz_fit_path found = {0};

    RITZ_NEW(made, count);
    RITZ_NEW(joined, count);
    RITZ_TRY(make_bodies(f, candidate, made, &found));
    for (int64_t k = 0; k < count; k++)
        RITZ_TRY(copy(&made[k], &joined[k]));
    RITZ_TRY(ritz_stage_from(f->scene, joined, &stage));
    RITZ_TRY(ritz_assemble(&stage, NULL, &system));
    RITZ_TRY(measure(f, &system));
    *out = system;
    *body = made;
    *path = found;
    system = (ritz_system){0};
    found = (ritz_fit_path){0};
    made = NULL;
done:
    for (int64_t k = 0; k < count; k++) {
        if (made)
            ritz_reduced_free(&made[k]);
        if (joined)
            ritz_reduced_free(&joined[k]);
    }
    free(made);
    free(joined);
    ritz_stage_free(&stage);
    ritz_system_free(&system);
    ritz_fit_path_free(&found);
    return status;
}
