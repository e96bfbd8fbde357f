/*
 * Flexible bodies: which they are, in which order they get modes (the ladder),
 * and how they are joined to the bodies that stay as they are.
 */
#include "fit/fitter.h"

#include "assembly/assembly.h"
#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Where the ladder is too short, it is made again with twice the modes of each
   body and some, until all bodies have 1000 or as many as columns allow. */
enum { AT_FIRST = 4 };
static const int64_t furthest = 1000;

static double read_clock(clockid_t clock)
{
    struct timespec now = {0};

    (void)clock_gettime(clock, &now);
    return (double)now.tv_sec + (double)now.tv_nsec / 1e9;
}

ritz_fit_watch ritz_fit_start(void)
{
    return (ritz_fit_watch){read_clock(CLOCK_MONOTONIC),
                            read_clock(CLOCK_PROCESS_CPUTIME_ID)};
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

    RITZ_CHECK(ritz_bodies_new(scene->num_components, &f->still));
    RITZ_CHECK_NEW(f->model, scene->num_components);
    RITZ_CHECK_NEW(f->body, scene->num_components);
    for (int64_t k = 0; k < scene->num_components; k++) {
        const ritz_scene_component *item = &scene->component[k];
        ritz_reduced *still = &f->still.item[k];
        const ritz_method *method = NULL;

        ritz_monitor_step("component", k, scene->num_components);
        RITZ_CHECK(ritz_stage_load(scene, k, &full, still));
        method = full.num_dofs > 0 ? ritz_method_find(item->basis) : NULL;
        if (method && method->uses & RITZ_USES_MODES) {
            f->body[f->num_bodies] = k;
            RITZ_MOVE(f->model[f->num_bodies++], full);
            continue;
        }
        if (full.num_dofs == 0)
            f->rich = true; /* there is no full system */
        else
            RITZ_CHECK(ritz_scene_context(
                scene,
                method ? ritz_stage_reduce(scene, k, item, &full, still)
                       : RITZ_ERR_ARGUMENT,
                item->line, item->column, "component", item->name));
        RITZ_CHECK(ritz_reduced_install(still));
        ritz_component_free(&full);
    }
    RITZ_REFUSE_IF(f->num_bodies == 0, RITZ_ERR_ARGUMENT,
                   "no component of the scene is reduced by a number of modes: "
                   "there is nothing to fit");
    return RITZ_OK;
}

/* Whether two flexible bodies have the same model, attached ports and options of
   their bases. */
static ritz_status compare_bodies(const ritz_fitter *f, int64_t j, int64_t k,
                                  bool *same)
{
    enum { WORDS = 1024 };
    const ritz_scene_component *all = f->scene->component;
    const ritz_scene_component *a = &all[f->body[j]], *b = &all[f->body[k]];
    char words[2][WORDS] = {"", ""};

    ritz_choice_print(&a->choice, WORDS, words[0]);
    ritz_choice_print(&b->choice, WORDS, words[1]);
    *same = strcmp(a->model, b->model) == 0 &&
            (f->request.choice.given || strcmp(words[0], words[1]) == 0);
    return *same ? ritz_stage_same_ports(f->scene, f->body[j], f->body[k], same)
                 : RITZ_OK;
}

static ritz_status find_equal(ritz_fitter *f)
{
    RITZ_CHECK_NEW(f->equal, f->num_bodies);
    for (int64_t k = 0; k < f->num_bodies; k++) {
        bool same = false;

        f->equal[k] = k;
        for (int64_t j = 0; j < k && !same; j++) {
            RITZ_CHECK(compare_bodies(f, j, k, &same));
            f->equal[k] = same ? f->equal[j] : k;
        }
    }
    return RITZ_OK;
}

static int compare_steps(const void *left, const void *right)
{
    const ritz_fit_step *a = left;
    const ritz_fit_step *b = right;

    if (a->hertz != b->hertz)
        return (a->hertz > b->hertz) - (a->hertz < b->hertz);
    return (a->body > b->body) - (a->body < b->body);
}

/* A ladder while flexible modes of all bodies are gathered. */
typedef struct ladder_draft {
    int64_t count, room;
    ritz_fit_step *step;
    double limit; /* Hz: up to it no body lacks any mode */
} ladder_draft;

static void ladder_draft_free(ladder_draft *r)
{
    free(r->step);
}

static ritz_status append_steps(int64_t k, const ritz_pairs *pairs,
                                ladder_draft *r)
{
    for (int64_t j = pairs->num_rigid; j < pairs->Phi.ncol; j++) {
        RITZ_CHECK_ROOM(r->step, r->count, r->room);
        r->step[r->count++] =
            (ritz_fit_step){ritz_eigen_hertz(pairs->lambda[j]), k};
    }
    return RITZ_OK;
}

/* Keep the modes of a body for its bases, unless those of all bodies would take
   too much memory. */
static void keep_modes(ritz_fitter *f, int64_t k, ritz_pairs *pairs)
{
    int64_t held = pairs->Phi.nrow * pairs->Phi.ncol;

    for (int64_t j = 0; j < f->num_bodies; j++)
        if (j != k)
            held += f->known[j].Phi.nrow * f->known[j].Phi.ncol;
    ritz_pairs_free(&f->known[k]);
    if (held <= f->most_entries)
        RITZ_MOVE(f->known[k], *pairs);
}

/* Modes of body k and of those that equal it: a number of them, or all up to a
   frequency. */
static ritz_status gather_modes(ritz_fitter *f, int64_t k,
                                const ritz_span *span, ladder_draft *r)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    int64_t found = 0;

    if (f->equal[k] != k)
        return RITZ_OK;
    RITZ_CHECK_IN(
        ritz_fitter_body(f, k),
        ritz_eigen_sparse(&f->model[k].K, &f->model[k].M, span, &pairs));
    found = pairs.Phi.ncol - pairs.num_rigid;
    for (int64_t j = k; j < f->num_bodies; j++)
        if (f->equal[j] == k)
            RITZ_CHECK(append_steps(j, &pairs, r));
    if (span->modes >= 0 && found >= span->modes && found > 0)
        r->limit = fmin(r->limit, r->step[r->count - 1].hertz);
    keep_modes(f, k, &pairs);
    return RITZ_OK;
}

/* By frequency they become the ladder, as far as no body lacks any. */
static void set_ladder(ladder_draft *r, ritz_fitter *f)
{
    int64_t count = 0;

    if (r->count > 0)
        qsort(r->step, (size_t)r->count, sizeof *r->step, compare_steps);
    while (count < r->count && r->step[count].hertz <= r->limit)
        count++;
    free(f->step);
    RITZ_MOVE(f->step, r->step);
    f->num_steps = count;
}

int64_t ritz_fit_modes_to(const ritz_fitter *f, int64_t k, double hertz)
{
    int64_t count = 0;

    for (int64_t t = 0; t < f->num_steps && f->step[t].hertz <= hertz; t++)
        count += f->step[t].body == k;
    return count;
}

ritz_status ritz_fit_extend(ritz_fitter *f, ritz_fit_end *end)
{
    RITZ_OWN(ladder_draft)
    draft = {.limit = f->rich ? f->rich_hz : HUGE_VAL};
    const int64_t before = f->num_steps;
    const int64_t room =
        (f->request.largest > furthest ? f->request.largest : furthest) -
        before;

    *end = RITZ_FIT_END_FAR;
    for (int64_t k = 0; k < f->num_bodies && room > 0; k++) {
        int64_t has = ritz_fit_modes_to(f, k, HUGE_VAL);
        int64_t more = has + AT_FIRST < room ? has + AT_FIRST : room;
        const ritz_span span = {.modes = has + more};
        ritz_status status = RITZ_OK;

        ritz_monitor_step("modes of bodies", k, f->num_bodies);
        status = gather_modes(f, k, &span, &draft);
        if (status != RITZ_OK) {
            *end = RITZ_FIT_END_REFUSED; /* the ladder is as it was */
            return status == RITZ_ERR_MEMORY ? status : RITZ_OK;
        }
    }
    if (room <= 0)
        return RITZ_OK;
    set_ladder(&draft, f);
    *end = f->num_steps > before ? RITZ_FIT_END_NONE
           : f->rich             ? RITZ_FIT_END_REFERENCE
                                 : RITZ_FIT_END_WHOLE;
    return RITZ_OK;
}

ritz_status ritz_fit_bodies(ritz_fitter *f)
{
    const ritz_span span = {.modes = -1,
                            .up_to_hz = RITZ_LADDER_TO * f->rich_hz};
    RITZ_OWN(ladder_draft) draft = {.limit = HUGE_VAL};

    RITZ_CHECK(load_bodies(f));
    RITZ_CHECK(find_equal(f));
    RITZ_CHECK_NEW(f->known, f->num_bodies);
    for (int64_t k = 0; k < f->num_bodies; k++)
        RITZ_CHECK(gather_modes(f, k, &span, &draft));
    set_ladder(&draft, f);
    f->num_first = f->num_steps;
    return RITZ_OK;
}

ritz_status ritz_fit_join(const ritz_fitter *f, const ritz_reduced *flexible,
                          ritz_fit_joined *out)
{
    RITZ_OWN_ARRAY ritz_reduced *body = NULL; /* all borrowed */

    RITZ_CHECK_NEW(body, f->still.count);
    memcpy(body, f->still.item, (size_t)f->still.count * sizeof *body);
    for (int64_t k = 0; k < f->num_bodies; k++)
        body[f->body[k]] = flexible[k];
    if (f->scene)
        return ritz_stage_from(f->scene, body, &out->stage);
    out->stage.count = 1;
    RITZ_MOVE(out->stage.body, body);
    return RITZ_OK;
}

ritz_status ritz_fit_join_own(const ritz_fitter *f, ritz_fit_joined *joined)
{
    for (int64_t k = 0; k < joined->own.count; k++)
        RITZ_CHECK(ritz_reduced_install(&joined->own.item[k]));
    return ritz_fit_join(f, joined->own.item, joined);
}

void ritz_fit_joined_free(ritz_fit_joined *joined)
{
    ritz_stage *stage = &joined->stage;

    if (stage->body) /* they are borrowed */
        memset(stage->body, 0, (size_t)stage->count * sizeof *stage->body);
    ritz_stage_free(stage);
    ritz_bodies_free(&joined->own);
    ritz_dense_free(&joined->parts);
}

ritz_status ritz_fit_rich(const ritz_fitter *f, double up_to_hz,
                          ritz_fit_joined *out)
{
    RITZ_CHECK(ritz_bodies_new(f->num_bodies, &out->own));
    for (int64_t k = 0; k < f->num_bodies; k++) {
        ritz_scene_component item = f->scene->component[f->body[k]];

        item.modes = -1;
        item.up_to_hz = up_to_hz;
        RITZ_CHECK_IN(item.name,
                      ritz_stage_reduce(f->scene, f->body[k], &item,
                                        &f->model[k], &out->own.item[k]));
    }
    return ritz_fit_join_own(f, out);
}
