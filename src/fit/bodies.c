/*
 * Flexible bodies: which they are, in which order they get modes (the ladder),
 * and how they are joined to the bodies that stay as they are.
 */
#include "fit/fitter.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Where that is not enough it goes on, by twice the modes of a body and some,
   to so many of all bodies, or as many as columns are allowed. */
enum { AT_FIRST = 4 };
static const int64_t furthest = 1000;

static double seconds(clockid_t clock)
{
    struct timespec now = {0};

    (void)clock_gettime(clock, &now);
    return (double)now.tv_sec + (double)now.tv_nsec / 1e9;
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

const char *ritz_fitter_body(const ritz_fitter *fitter, int64_t k)
{
    return fitter->scene ? fitter->scene->component[fitter->body[k]].name : "";
}

/* Flexible is what the scene reduces by a number of modes. */
static ritz_status load_bodies(ritz_fitter *f)
{
    const ritz_scene *scene = f->scene;
    RITZ_OWN(ritz_component) full = {0};

    f->num_components = scene->num_components;
    RITZ_CHECK_NEW(f->still, scene->num_components);
    RITZ_CHECK_NEW(f->model, scene->num_components);
    RITZ_CHECK_NEW(f->body, scene->num_components);
    for (int64_t k = 0; k < scene->num_components; k++) {
        const ritz_scene_component *item = &scene->component[k];
        const ritz_method *method = NULL;

        ritz_monitor_step("component", k, scene->num_components);
        RITZ_CHECK(ritz_stage_load(scene, k, &full, &f->still[k]));
        if (full.num_dofs == 0) {
            f->rich = true; /* there is no full system */
            continue;
        }
        method = ritz_method_find(item->basis);
        if (!method || !(method->uses & RITZ_USES_MODES)) {
            RITZ_CHECK(ritz_scene_context(
                scene,
                method ? ritz_stage_reduce(scene, k, item, &full, &f->still[k])
                       : RITZ_ERR_ARGUMENT,
                item->line, item->column, "component", item->name));
            ritz_component_free(&full);
            continue;
        }
        f->body[f->num_bodies] = k;
        RITZ_MOVE(f->model[f->num_bodies++], full);
    }
    RITZ_REFUSE_IF(f->num_bodies == 0, RITZ_ERR_ARGUMENT,
                   "no component of the scene is reduced by a number of modes: "
                   "there is nothing to fit");
    return RITZ_OK;
}

/* A flexible mode of a body. */
typedef struct body_mode {
    double hertz;
    int64_t body;
} body_mode;

static int by_hertz(const void *left, const void *right)
{
    const body_mode *a = left;
    const body_mode *b = right;

    if (a->hertz != b->hertz)
        return (a->hertz > b->hertz) - (a->hertz < b->hertz);
    return (a->body > b->body) - (a->body < b->body);
}

/* Flexible modes of all bodies, while they are gathered. */
typedef struct body_modes {
    int64_t count;
    body_mode *all;
    double limit; /* Hz: up to it no body lacks any */
} body_modes;

/* Those of one body; so many as were asked for, or all up to a frequency. */
static ritz_status gather_modes(const ritz_fitter *f, int64_t k,
                                const ritz_span *span, body_modes *r)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    body_mode *more = NULL;
    int64_t found = 0;

    RITZ_CHECK_IN(
        ritz_fitter_body(f, k),
        ritz_eigen_sparse(&f->model[k].K, &f->model[k].M, span, &pairs));
    found = pairs.Phi.ncol - pairs.num_rigid;
    RITZ_CHECK_NEW(more, r->count + found);
    if (r->count > 0)
        memcpy(more, r->all, (size_t)r->count * sizeof *more);
    free(r->all);
    r->all = more;
    for (int64_t j = pairs.num_rigid; j < pairs.Phi.ncol; j++)
        r->all[r->count++] = (body_mode){ritz_eigen_hertz(pairs.lambda[j]), k};
    if (span->modes >= 0 && found >= span->modes && found > 0)
        r->limit = fmin(r->limit, r->all[r->count - 1].hertz);
    return RITZ_OK;
}

/* They become the ladder, as far as no body lacks any. */
static ritz_status set_ladder(body_modes *r, ritz_fitter *f)
{
    RITZ_OWN_ARRAY int64_t *step = NULL;
    RITZ_OWN_ARRAY double *hertz = NULL;
    const int64_t all = r->all ? r->count : 0;
    int64_t count = 0;

    if (all > 0)
        qsort(r->all, (size_t)all, sizeof *r->all, by_hertz);
    RITZ_CHECK_NEW(step, all);
    RITZ_CHECK_NEW(hertz, all);
    for (; count < all && r->all[count].hertz <= r->limit; count++) {
        step[count] = r->all[count].body;
        hertz[count] = r->all[count].hertz;
    }
    free(f->step);
    free(f->step_hz);
    RITZ_MOVE(f->step, step);
    RITZ_MOVE(f->step_hz, hertz);
    f->num_steps = count;
    return RITZ_OK;
}

/* The free modes of all bodies by frequency: who gets the next mode. */
static ritz_status make_ladder(ritz_fitter *f)
{
    ritz_status status = RITZ_OK;
    const ritz_span span = {.modes = -1,
                            .up_to_hz = RITZ_LADDER_TO * f->rich_hz};
    body_modes r = {.limit = HUGE_VAL};

    for (int64_t k = 0; k < f->num_bodies; k++)
        RITZ_TRY(gather_modes(f, k, &span, &r));
    RITZ_TRY(set_ladder(&r, f));
    f->num_first = f->num_steps;
done:
    free(r.all);
    return status;
}

/* Modes of a body that are on the ladder. */
static int64_t count_on_ladder(const ritz_fitter *f, int64_t body)
{
    int64_t count = 0;

    for (int64_t t = 0; t < f->num_steps; t++)
        count += f->step[t] == body;
    return count;
}

ritz_status ritz_fit_extend(ritz_fitter *f, ritz_fit_end *end)
{
    ritz_status status = RITZ_OK;
    body_modes r = {.limit = f->rich ? f->rich_hz : HUGE_VAL};
    const int64_t before = f->num_steps;
    int64_t room =
        f->request.largest > furthest ? f->request.largest : furthest;

    *end = RITZ_FIT_END_FAR;
    room -= before;
    if (room <= 0)
        return RITZ_OK;
    for (int64_t k = 0; k < f->num_bodies; k++) {
        int64_t has = count_on_ladder(f, k);
        int64_t more = has + AT_FIRST < room ? has + AT_FIRST : room;
        const ritz_span span = {.modes = has + more};

        ritz_monitor_step("modes of bodies", k, f->num_bodies);
        RITZ_TRY(gather_modes(f, k, &span, &r));
    }
    RITZ_TRY(set_ladder(&r, f));
    *end = f->num_steps > before ? RITZ_FIT_END_NONE
           : f->rich             ? RITZ_FIT_END_REFERENCE
                                 : RITZ_FIT_END_WHOLE;
done:
    free(r.all);
    if (status != RITZ_OK && status != RITZ_ERR_MEMORY) {
        *end = RITZ_FIT_END_REFUSED; /* the ladder is as it was */
        status = RITZ_OK;
    }
    return status;
}

ritz_status ritz_fit_bodies(ritz_fitter *f)
{
    RITZ_CHECK(load_bodies(f));
    return make_ladder(f);
}

/* Bodies that stay as they are, lent to a stage, come home. */
static void take_back(ritz_fitter *f, ritz_reduced *body)
{
    for (int64_t k = 0; body && k < f->num_components; k++) {
        bool flexible = false;

        for (int64_t j = 0; j < f->num_bodies; j++)
            flexible = flexible || f->body[j] == k;
        if (flexible)
            continue;
        f->still[k] = body[k]; /* its dampers may be installed by now */
        body[k] = (ritz_reduced){0};
    }
}

ritz_status ritz_fit_join(ritz_fitter *f, ritz_reduced *flexible,
                          ritz_stage *out)
{
    ritz_status status = RITZ_OK;
    ritz_reduced *body = NULL;

    RITZ_NEW(body, f->num_components);
    for (int64_t k = 0; k < f->num_components; k++)
        body[k] = f->still[k];
    for (int64_t k = 0; k < f->num_bodies; k++)
        body[f->body[k]] = flexible[k];
    status = f->scene ? ritz_stage_from(f->scene, body, out)
                      : ritz_reduced_install(&body[0]);
    if (status == RITZ_OK && !f->scene) {
        *out = (ritz_stage){.count = 1, .body = body};
        body = NULL;
    }
    for (int64_t k = 0; k < f->num_bodies; k++)
        flexible[k] = status == RITZ_OK ? (ritz_reduced){0} : body[f->body[k]];
    if (status != RITZ_OK)
        take_back(f, body);
done:
    free(body);
    return status;
}

void ritz_fit_part(ritz_fitter *f, ritz_stage *stage, ritz_reduced *flexible)
{
    take_back(f, stage->body);
    for (int64_t k = 0; stage->body && flexible && k < f->num_bodies; k++) {
        flexible[k] = stage->body[f->body[k]];
        stage->body[f->body[k]] = (ritz_reduced){0};
    }
    ritz_stage_free(stage);
}

ritz_status ritz_fit_rich(ritz_fitter *f, double up_to_hz, ritz_stage *out)
{
    ritz_status status = RITZ_OK;
    ritz_reduced *body = NULL;

    RITZ_NEW(body, f->num_bodies);
    for (int64_t k = 0; k < f->num_bodies; k++) {
        ritz_scene_component item = f->scene->component[f->body[k]];

        item.modes = -1;
        item.up_to_hz = up_to_hz;
        RITZ_TRY_IN(item.name, ritz_stage_reduce(f->scene, f->body[k], &item,
                                                 &f->model[k], &body[k]));
    }
    RITZ_TRY(ritz_fit_join(f, body, out));
done:
    for (int64_t k = 0; body && k < f->num_bodies; k++)
        ritz_reduced_free(&body[k]);
    free(body);
    return status;
}
