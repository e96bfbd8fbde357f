/*
 * COMPARE as a method of a scene [LeeTsuha1992]: of every flexible body the
 * composite set of all listed configurations, made once of a first stage that
 * is rich, its directions in order; a candidate takes the first of each body,
 * and the ladder is the order of all bodies' directions together.
 *
 * Modes of the band weigh as the scene ranks them where the tolerance is of
 * what inputs and outputs see; where it is of modes, all the same. Nothing is
 * kept exactly by that: each candidate is measured like any other.
 */
#include "fit/fitter.h"

#include "base/alloc.h"

#include <ritz/assembly.h>
#include <ritz/model.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A component by itself has no configurations. */
static ritz_status refuse_component(const ritz_request *request,
                                    ritz_basis *out)
{
    (void)request;
    (void)out;
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "it is made of the modes of a scene, and this is a "
                     "component");
}

const ritz_method ritz_fit_compare = {
    .name = "compare",
    .summary = "composite modes of a scene's configurations, on each body",
    .reference = "LeeTsuha1992",
    .when = "bodies of a scene that stands at several configurations",
    .cost = "an eigenproblem of a rich first stage at each, once",
    .holds = "rigid motions; the rest is measured",
    .fails = "between configurations that are too far apart",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED,
    .make = refuse_component,
};

const ritz_method *ritz_fit_method_find(const char *name)
{
    return strcmp(name, ritz_fit_compare.name) == 0 ? &ritz_fit_compare
                                                    : ritz_method_find(name);
}

/*
 * The scene as its modes are chosen: in the band of the tolerance, ranked if
 * no tolerance is of modes and there is damping to rank by. Static solutions
 * come first where there is a tolerance of the static gain.
 */
static ritz_scene choose_modes(const ritz_fitter *f)
{
    const ritz_verify_request *limits = &f->request.tolerance;
    bool channels = true;         /* all tolerances are of inputs and outputs */
    ritz_scene scene = *f->scene; /* borrowed */

    for (int k = 0; k < RITZ_MEASURES; k++)
        channels =
            channels && (isnan(limits->limit[k]) ||
                         ritz_measure_table[k].needs & RITZ_NEEDS_CHANNELS);

    memcpy(scene.band_hz, limits->band_hz, sizeof scene.band_hz);
    scene.damping = limits->damping;
    scene.select = channels && scene.damping.kind != RITZ_DAMPING_NONE
                       ? RITZ_SELECT_RANKED
                       : RITZ_SELECT_BAND;
    scene.augment = isnan(limits->limit[RITZ_MEASURE_GAIN])
                        ? RITZ_AUGMENT_NONE
                        : RITZ_AUGMENT_SYSTEM;
    return scene;
}

/* D and K without its dampers, as bases leave them. */
static ritz_status remove_dampers(ritz_reduced *body)
{
    RITZ_OWN_ARRAY double *zero = NULL;
    ritz_dampers *d = &body->dampers;
    const ritz_dampers kept = *d;
    ritz_status status = RITZ_OK;

    RITZ_CHECK_NEW(zero, d->count);
    d->c = d->k = zero;
    status = ritz_reduced_install(body);
    d->c = kept.c;
    d->k = kept.k;
    return status;
}

/* Rigid motions cost no energy: what K shows for them is rounding, and zero is
   taken for it, as in ritz_reduce. A damper's spring may be negative, and then
   a body by itself need not be free of energy where the system is. */
static void settle_rigid(int64_t rigid, ritz_reduced *body)
{
    ritz_dense *K = &body->K;

    for (int64_t j = 0; j < rigid; j++) {
        body->columns.kind[j] = RITZ_COLUMN_RIGID;
        for (int64_t i = 0; i < K->nrow && body->dampers.count == 0; i++)
            ritz_dense_col(K, j)[i] = ritz_dense_col(K, i)[j] = 0.0;
    }
}

/* A body in all its directions, nested. */
static ritz_status nest_directions(ritz_reduced *first, const ritz_dense *V,
                                   int64_t rigid, ritz_reduced *out)
{
    RITZ_OWN(ritz_reduced) whole = {0};
    RITZ_OWN_ARRAY int64_t *order = NULL;

    RITZ_CHECK(remove_dampers(first));
    RITZ_CHECK(ritz_reduced_project(first, V, &whole));
    RITZ_CHECK_NEW(order, V->ncol);
    for (int64_t j = 0; j < V->ncol; j++)
        order[j] = j;
    settle_rigid(rigid, &whole);
    (void)snprintf(whole.origin.method, sizeof whole.origin.method, "%s",
                   ritz_fit_compare.name);
    (void)snprintf(whole.origin.reference, sizeof whole.origin.reference, "%s",
                   ritz_fit_compare.reference);
    return ritz_reduced_nest(&whole, V->ncol, order, rigid > 0 ? rigid : 1,
                             out);
}

/* Steps of those bodies that are flexible, without the first of one that would
   not move without it. */
static ritz_status keep_steps(const ritz_fitter *f,
                              const ritz_composite *composite,
                              ritz_fit_second *second)
{
    RITZ_OWN_ARRAY bool *moves = NULL;

    RITZ_CHECK_NEW(moves, f->num_bodies);
    RITZ_CHECK_NEW(second->step, composite->num_steps);
    for (int64_t k = 0; k < f->num_bodies; k++)
        moves[k] = second->rigid[k] > 0;
    for (int64_t t = 0; t < composite->num_steps; t++)
        for (int64_t k = 0; k < f->num_bodies; k++) {
            if (f->body[k] != composite->step[t])
                continue;
            if (moves[k])
                second->step[second->num_steps++].body = k;
            moves[k] = true;
        }
    return RITZ_OK;
}

static ritz_status make_second(const ritz_fitter *f, double up_to_hz,
                               ritz_fit_second *second)
{
    const ritz_scene scene = choose_modes(f);
    RITZ_OWN(ritz_fit_joined) rich = {0};
    RITZ_OWN(ritz_composite) composite = {0};

    RITZ_CHECK(ritz_fit_rich(f, up_to_hz, &rich));
    rich.stage.scene = &scene;
    RITZ_CHECK(ritz_composite_new(&rich.stage, &composite));
    RITZ_CHECK(ritz_bodies_new(f->num_bodies, &second->body));
    RITZ_CHECK_NEW(second->rigid, f->num_bodies);
    for (int64_t k = 0; k < f->num_bodies; k++) {
        const int64_t b = f->body[k];

        second->rigid[k] = composite.rigid[b];
        RITZ_CHECK_IN(ritz_fitter_body(f, k),
                      nest_directions(&rich.stage.body[b], &composite.V[b],
                                      composite.rigid[b],
                                      &second->body.item[k]));
    }
    return keep_steps(f, &composite, second);
}

ritz_status ritz_fit_second_make(ritz_fitter *f, double up_to_hz, bool *made)
{
    const ritz_fit_watch watch = ritz_fit_start();
    ritz_fit_second more = {.made = true, .rich_hz = up_to_hz};
    ritz_status status = RITZ_OK;

    if (f->second.made && up_to_hz <= f->second.rich_hz)
        return RITZ_OK;
    status = make_second(f, up_to_hz, &more);
    if (made)
        *made = status == RITZ_OK;
    if (status != RITZ_OK) {
        ritz_fit_second_free(&more);
        if (status == RITZ_ERR_MEMORY || f->second.made)
            return status == RITZ_ERR_MEMORY ? status : RITZ_OK;
        more = (ritz_fit_second){
            .made = true, .status = status, .rich_hz = up_to_hz};
        (void)snprintf(more.refusal, sizeof more.refusal, "%s",
                       ritz_error_message());
    }
    more.making = ritz_fit_since(watch);
    ritz_fit_second_free(&f->second);
    f->second = more;
    return RITZ_OK;
}

ritz_status ritz_fit_second_body(ritz_fitter *f, int64_t k, int64_t count,
                                 ritz_reduced *out)
{
    const ritz_fit_second *second = &f->second;
    int64_t rigid = 0, most = 0;

    RITZ_CHECK(ritz_fit_second_make(f, f->rich_hz, NULL));
    RITZ_REFUSE_IF(second->status != RITZ_OK, second->status, "%s",
                   second->refusal);
    rigid = second->rigid[k];
    most = second->body.item[k].K.ncol - rigid;
    RITZ_REFUSE_IF(count > most, RITZ_ERR_ARGUMENT,
                   "'%s' has %" PRId64 " composite vectors, and not %" PRId64,
                   ritz_fitter_body(f, k), most, count);
    RITZ_REFUSE_IF(rigid + count == 0, RITZ_ERR_ARGUMENT,
                   "'%s' would not move at all", ritz_fitter_body(f, k));
    RITZ_CHECK(ritz_reduced_prefix(&second->body.item[k], rigid + count, out));
    ritz_nested_free(&out->nested);
    (void)snprintf(out->origin.options, sizeof out->origin.options,
                   "modes %" PRId64, count);
    return RITZ_OK;
}

void ritz_fit_second_free(ritz_fit_second *second)
{
    ritz_bodies_free(&second->body);
    RITZ_FREE(second->rigid, second->step);
    *second = (ritz_fit_second){0};
}

int64_t ritz_fit_rungs(const ritz_fitter *fitter, const ritz_method *method)
{
    return method == &ritz_fit_compare ? fitter->second.num_steps
                                       : fitter->num_steps;
}

void ritz_fit_rung(const ritz_fitter *fitter, const ritz_method *method,
                   int64_t rung, int64_t *modes)
{
    const ritz_fit_second *second = &fitter->second;
    const bool composite = method == &ritz_fit_compare;
    const ritz_fit_step *step = composite ? second->step : fitter->step;

    if (!fitter->scene) {
        modes[0] = rung;
        return;
    }
    for (int64_t k = 0; k < fitter->num_bodies; k++)
        modes[k] = composite && second->rigid && second->rigid[k] == 0;
    for (int64_t k = 0; k < rung && k < ritz_fit_rungs(fitter, method); k++)
        modes[step[k].body]++;
}
