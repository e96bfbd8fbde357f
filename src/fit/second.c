/*
 * COMPARE as a method of a scene [LeeTsuha1992]: of every flexible body the
 * composite set of all listed configurations, made once of a first stage that
 * is rich, its directions in order; a candidate takes so many of each body, and
 * the ladder is the order of all bodies' directions together.
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
#include <stdlib.h>
#include <string.h>

/* A component by itself has no configurations. */
static ritz_status refuse(const ritz_request *request, ritz_basis *out)
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
    .make = refuse,
};

const ritz_method *ritz_fit_method_find(const char *name)
{
    return strcmp(name, ritz_fit_compare.name) == 0 ? &ritz_fit_compare
                                                    : ritz_method_find(name);
}

/*
 * The scene as its modes are chosen: in the band of the tolerance, ranked if
 * nothing is asked of modes and there is damping to rank by. Static answers
 * come first where their gain is asked for.
 */
static ritz_scene choosing(const ritz_fitter *f)
{
    const ritz_verify_request *limits = &f->request.tolerance;
    bool seen = true;             /* no tolerance is of modes */
    ritz_scene scene = *f->scene; /* borrowed */

    for (int k = 0; k < RITZ_MEASURES; k++)
        seen = seen && (isnan(limits->limit[k]) ||
                        ritz_measure_table[k].needs & RITZ_NEEDS_CHANNELS);

    memcpy(scene.band_hz, limits->band_hz, sizeof scene.band_hz);
    scene.damping = limits->damping;
    scene.select = seen && scene.damping.kind != RITZ_DAMPING_NONE
                       ? RITZ_SELECT_RANKED
                       : RITZ_SELECT_BAND;
    scene.augment = isnan(limits->limit[RITZ_MEASURE_GAIN])
                        ? RITZ_AUGMENT_NONE
                        : RITZ_AUGMENT_SYSTEM;
    return scene;
}

/* D and K without its dampers, as bases leave them. */
static ritz_status make_bare(ritz_reduced *body)
{
    ritz_status status = RITZ_OK;
    ritz_dampers *d = &body->dampers;
    double *const c = d->c;
    double *const k = d->k;
    double *zero = NULL;

    RITZ_NEW(zero, d->count);
    d->c = d->k = zero;
    status = ritz_reduced_install(body);
    d->c = c;
    d->k = k;
done:
    free(zero);
    return status;
}

/* Rigid motions cost no energy: what K shows for them is rounding, and zero is
   taken for it, as in ritz_reduce. A damper's spring may be negative, and then
   a body by itself need not be free of energy where the system is. */
static void settle(int64_t rigid, ritz_reduced *body)
{
    ritz_dense *K = &body->K;

    for (int64_t j = 0; j < rigid; j++) {
        body->columns.kind[j] = RITZ_COLUMN_RIGID;
        for (int64_t i = 0; i < K->nrow && body->dampers.count == 0; i++)
            ritz_dense_col(K, j)[i] = ritz_dense_col(K, i)[j] = 0.0;
    }
}

/* A body in all its directions, nested. */
static ritz_status nest(ritz_reduced *first, const ritz_dense *V, int64_t rigid,
                        ritz_reduced *out)
{
    RITZ_OWN(ritz_reduced) whole = {0};
    RITZ_OWN_ARRAY int64_t *order = NULL;

    RITZ_CHECK(make_bare(first));
    RITZ_CHECK(ritz_reduced_project(first, V, &whole));
    RITZ_CHECK_NEW(order, V->ncol);
    for (int64_t j = 0; j < V->ncol; j++)
        order[j] = j;
    settle(rigid, &whole);
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
                second->step[second->num_steps++] = k;
            moves[k] = true;
        }
    return RITZ_OK;
}

static ritz_status make(ritz_fitter *f, double up_to_hz,
                        ritz_fit_second *second)
{
    ritz_status status = RITZ_OK;
    const ritz_scene scene = choosing(f);
    ritz_stage stage = {0};
    ritz_composite composite = {0};

    RITZ_TRY(ritz_fit_rich(f, up_to_hz, &stage));
    stage.scene = &scene;
    RITZ_TRY(ritz_composite_new(&stage, &composite));
    RITZ_NEW(second->body, f->num_bodies);
    RITZ_NEW(second->rigid, f->num_bodies);
    for (int64_t k = 0; k < f->num_bodies; k++) {
        const int64_t b = f->body[k];

        second->rigid[k] = composite.rigid[b];
        RITZ_TRY_IN(ritz_fitter_body(f, k),
                    nest(&stage.body[b], &composite.V[b], composite.rigid[b],
                         &second->body[k]));
    }
    RITZ_TRY(keep_steps(f, &composite, second));
done:
    ritz_fit_part(f, &stage, NULL);
    ritz_composite_free(&composite);
    return status;
}

ritz_status ritz_fit_second_make(ritz_fitter *f)
{
    ritz_status status = RITZ_OK;
    const ritz_fit_watch watch = ritz_fit_start();
    ritz_fit_second made = {.made = true, .rich_hz = f->rich_hz};

    if (f->second.made)
        return RITZ_OK;
    status = make(f, f->rich_hz, &made);
    if (status != RITZ_OK) { /* why, is said by every candidate */
        ritz_fit_second_free(f->num_bodies, &made);
        made.made = status != RITZ_ERR_MEMORY;
        made.status = status;
        (void)snprintf(made.refusal, sizeof made.refusal, "%s",
                       ritz_error_message());
    }
    made.making = ritz_fit_since(watch);
    f->second = made;
    return status == RITZ_ERR_MEMORY ? status : RITZ_OK;
}

ritz_status ritz_fit_second_remake(ritz_fitter *f, double up_to_hz, bool *made)
{
    ritz_status status = RITZ_OK;
    const ritz_fit_watch watch = ritz_fit_start();
    ritz_fit_second more = {.made = true, .rich_hz = up_to_hz};

    *made = false;
    status = make(f, up_to_hz, &more);
    if (status != RITZ_OK) {
        ritz_fit_second_free(f->num_bodies, &more);
        return status == RITZ_ERR_MEMORY ? status : RITZ_OK;
    }
    more.making = ritz_fit_since(watch);
    ritz_fit_second_free(f->num_bodies, &f->second);
    f->second = more;
    *made = true;
    return RITZ_OK;
}

ritz_status ritz_fit_second_body(ritz_fitter *f, int64_t k, int64_t count,
                                 ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    const ritz_fit_second *second = &f->second;
    int64_t most = 0;

    RITZ_TRY(ritz_fit_second_make(f));
    RITZ_FAIL_IF(second->status != RITZ_OK, second->status, "%s",
                 second->refusal);
    most = second->body[k].K.ncol - second->rigid[k];
    RITZ_FAIL_IF(count > most, RITZ_ERR_ARGUMENT,
                 "'%s' has %" PRId64 " composite vectors, and not %" PRId64,
                 ritz_fitter_body(f, k), most, count);
    RITZ_FAIL_IF(second->rigid[k] + count == 0, RITZ_ERR_ARGUMENT,
                 "'%s' would not move at all", ritz_fitter_body(f, k));
    RITZ_TRY(
        ritz_reduced_prefix(&second->body[k], second->rigid[k] + count, out));
    ritz_nested_free(&out->nested);
    (void)snprintf(out->origin.options, sizeof out->origin.options,
                   "modes %" PRId64, count);
done:
    return status;
}

void ritz_fit_second_free(int64_t num_bodies, ritz_fit_second *second)
{
    for (int64_t k = 0; second->body && k < num_bodies; k++)
        ritz_reduced_free(&second->body[k]);
    free(second->body);
    free(second->rigid);
    free(second->step);
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
    const int64_t *step = composite ? second->step : fitter->step;

    if (!fitter->scene) {
        modes[0] = rung;
        return;
    }
    for (int64_t k = 0; k < fitter->num_bodies; k++)
        modes[k] = composite && second->rigid && second->rigid[k] == 0;
    for (int64_t k = 0; k < rung && k < ritz_fit_rungs(fitter, method); k++)
        modes[step[k]]++;
}
