/* A scene's bodies: which are flexible, in which order they get modes. */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <ritz/eigen.h>
#include <ritz/monitor.h>

#include <stdlib.h>
#include <string.h>

/* Modes of bodies count so far, of what a reference would hold, as steps of the
   ladder: to six times the band, and further for the finest tolerances. */
static const double ladder_to = 0.75;

/* Flexible is what the scene reduces by a number of modes. */
static ritz_status load_bodies(ritz_fitter *f)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = f->scene;
    ritz_component full = {0};

    RITZ_NEW(f->still, scene->num_components);
    RITZ_NEW(f->model, scene->num_components);
    RITZ_NEW(f->body, scene->num_components);
    for (int64_t k = 0; k < scene->num_components; k++) {
        const ritz_scene_component *item = &scene->component[k];
        const ritz_method *method = NULL;

        ritz_monitor_step("component", k, scene->num_components);
        RITZ_TRY(ritz_stage_load(scene, k, &full, &f->still[k]));
        if (full.num_dofs == 0) {
            f->rich = true; /* there is no full system */
            continue;
        }
        method = ritz_method_find(item->basis);
        if (!method || !(method->uses & RITZ_USES_MODES)) {
            RITZ_TRY(ritz_scene_context(
                scene,
                method ? ritz_stage_reduce(scene, k, item, &full, &f->still[k])
                       : RITZ_ERR_ARGUMENT,
                item->line, item->column, "component", item->name));
            ritz_component_free(&full);
            continue;
        }
        f->body[f->num_bodies] = k;
        f->model[f->num_bodies++] = full;
        full = (ritz_component){0};
    }
    RITZ_FAIL_IF(f->num_bodies == 0, RITZ_ERR_ARGUMENT,
                 "no component of the scene is reduced by a number of modes: "
                 "there is nothing to fit");
done:
    ritz_component_free(&full);
    return status;
}

/* A flexible mode of a body. */
typedef struct rung {
    double hertz;
    int64_t body;
} rung;

static int by_hertz(const void *left, const void *right)
{
    const rung *a = left;
    const rung *b = right;

    if (a->hertz != b->hertz)
        return (a->hertz > b->hertz) - (a->hertz < b->hertz);
    return (a->body > b->body) - (a->body < b->body);
}

/* The free modes of all bodies by frequency: who gets the next mode. */
static ritz_status make_ladder(ritz_fitter *f)
{
    ritz_status status = RITZ_OK;
    const ritz_span span = {
        .modes = -1,
        .up_to_hz = ladder_to * ritz_fit_rich_to(&f->request.tolerance) *
                    f->request.tolerance.band_hz[1]};
    ritz_pairs pairs = {0};
    rung *all = NULL, *more = NULL;
    int64_t count = 0;

    for (int64_t k = 0; k < f->num_bodies; k++) {
        RITZ_TRY_IN(
            ritz_fitter_body(f, k),
            ritz_eigen_sparse(&f->model[k].K, &f->model[k].M, &span, &pairs));
        RITZ_NEW(more, count + pairs.Phi.ncol);
        if (count > 0)
            memcpy(more, all, (size_t)count * sizeof *more);
        free(all);
        all = more;
        more = NULL;
        for (int64_t j = pairs.num_rigid; j < pairs.Phi.ncol; j++)
            all[count++] = (rung){ritz_eigen_hertz(pairs.lambda[j]), k};
        ritz_pairs_free(&pairs);
    }
    if (all)
        qsort(all, (size_t)count, sizeof *all, by_hertz);
    RITZ_NEW(f->step, count);
    for (int64_t k = 0; k < count; k++)
        f->step[k] = all[k].body;
    f->num_steps = count;
done:
    ritz_pairs_free(&pairs);
    free(all);
    return status;
}

ritz_status ritz_fit_bodies(ritz_fitter *f)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(load_bodies(f));
    RITZ_TRY(make_ladder(f));
done:
    return status;
}
