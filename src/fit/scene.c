/*
 * A scene's candidates: bodies in a basis, joined and compared at every listed
 * configuration; what meets the tolerance there, at random ones too.
 */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <ritz/synthesis.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bodies that stay as they are, lent to a stage, come home. */
void ritz_fit_take_back(ritz_fitter *f, ritz_reduced *body)
{
    for (int64_t k = 0; body && k < f->scene->num_components; k++) {
        bool flexible = false;

        for (int64_t j = 0; j < f->num_bodies; j++)
            flexible = flexible || f->body[j] == k;
        if (flexible)
            continue;
        f->still[k] = body[k]; /* its dampers may be installed by now */
        body[k] = (ritz_reduced){0};
    }
}

ritz_status ritz_fit_body(ritz_fitter *f, const ritz_method *method, int64_t k,
                          int64_t modes, ritz_reduced *out)
{
    ritz_scene_component item = f->scene->component[f->body[k]];

    (void)snprintf(item.basis, sizeof item.basis, "%s", method->name);
    item.modes = modes;
    item.up_to_hz = 0.0;
    if (f->request.choice.given)
        item.choice = f->request.choice;
    item.choice.given &= method->uses;
    return ritz_context(
        ritz_stage_reduce(f->scene, f->body[k], &item, &f->model[k], out),
        item.name);
}

static void free_made(ritz_fit_made *made)
{
    ritz_reduced_free(&made->reduced);
    *made = (ritz_fit_made){0};
}

/* That body in that basis, made once; of what cannot be, why. */
static ritz_status made_body(ritz_fitter *f, const ritz_method *method,
                             int64_t body, int64_t modes, int64_t *at)
{
    ritz_status status = RITZ_OK;
    ritz_fit_made made = {.method = method, .body = body, .modes = modes};
    ritz_fit_made *more = NULL;
    ritz_fit_watch watch = {0};

    for (*at = 0; *at < f->num_made; (*at)++) {
        const ritz_fit_made *m = &f->made[*at];

        if (m->method == method && m->body == body && m->modes == modes)
            return RITZ_OK;
    }
    watch = ritz_fit_start();
    status = ritz_fit_body(f, method, body, modes, &made.reduced);
    if (status == RITZ_ERR_MEMORY)
        goto done;
    if (status != RITZ_OK)
        (void)snprintf(made.refusal, sizeof made.refusal, "%s",
                       ritz_error_message());
    made.status = status;
    made.spent = ritz_fit_since(watch);
    ritz_dense_free(&made.reduced.T);
    RITZ_NEW(more, f->num_made + 1);
    if (f->num_made > 0)
        memcpy(more, f->made, (size_t)f->num_made * sizeof *more);
    free(f->made);
    f->made = more;
    f->made[f->num_made++] = made;
    made = (ritz_fit_made){0};
    status = RITZ_OK;
done:
    free_made(&made);
    return status;
}

/* A measure of that name; NULL: none. */
static ritz_measure *find(const ritz_measures *measures, const char *name)
{
    for (int64_t k = 0; k < measures->count; k++)
        if (strcmp(measures->item[k].name, name) == 0)
            return &measures->item[k];
    return NULL;
}

ritz_status ritz_fit_worst(const ritz_measures *more, const char *at,
                           ritz_measures *worst)
{
    ritz_status status = RITZ_OK;
    char where[RITZ_NAME_SIZE];

    for (int64_t k = 0; k < more->count; k++) {
        const ritz_measure *m = &more->item[k];
        ritz_measure *old = find(worst, m->name);
        bool least = strcmp(m->name, "mac") == 0;

        (void)snprintf(where, sizeof where, "%.28s%s%.32s", at,
                       m->where[0] ? ": " : "", m->where);
        if (!old) {
            RITZ_TRY(
                ritz_measures_add(worst, m->name, m->value, m->limit, where));
        } else if (least ? m->value < old->value : m->value > old->value) {
            old->value = m->value;
            memcpy(old->where, where, sizeof where);
        }
    }
done:
    return status;
}

/* The candidate at one place, its errors among the worst so far. */
static ritz_status measure_at(ritz_fitter *f, const ritz_stage *stage,
                              const ritz_fit_place *place, int where,
                              ritz_fit_candidate *candidate)
{
    ritz_status status = RITZ_OK;
    const ritz_verify_request *limits = &f->request.tolerance;
    ritz_configuration at = {0};
    ritz_measures found = {0};
    ritz_second_order model = {0};

    RITZ_TRY(ritz_stage_assemble(stage, place->setting, &at));
    if (at.K.ncol > candidate->order)
        candidate->order = at.K.ncol;
    model = (ritz_second_order){&at.K, &at.M, &at.D, NULL, &at.io};
    RITZ_TRY(ritz_reference_measure_at(place->reference, &at, limits, where,
                                       &found));
    RITZ_TRY(ritz_fit_worst(&found, place->at, &candidate->errors));
    ritz_fit_judge(limits, candidate);
    if (candidate->feasible && where)
        RITZ_TRY(ritz_fit_probe(&model, &limits->damping, candidate));
    if (candidate->feasible && where && place == f->place)
        RITZ_TRY(ritz_fit_price(f, &model, candidate));
done:
    ritz_measures_free(&found);
    ritz_configuration_free(&at);
    return status;
}

static ritz_status measure(ritz_fitter *f, const ritz_stage *stage,
                           ritz_fit_candidate *candidate)
{
    ritz_status status = RITZ_OK;
    int where = 0;

    for (int64_t k = 0; k < f->num_places; k++)
        if (f->place[k].listed)
            RITZ_TRY(measure_at(f, stage, &f->place[k], 0, candidate));
    if (!candidate->feasible)
        return RITZ_OK;
    where = ritz_fit_places(f->place[0].reference, &candidate->errors);
    ritz_measures_free(&candidate->errors);
    for (int64_t k = 0; k < f->num_places && candidate->refusal[0] == '\0'; k++)
        RITZ_TRY(measure_at(f, stage, &f->place[k], where, candidate));
    candidate->caught = !candidate->feasible;
done:
    return status;
}

/* The candidate's bodies, lent to a stage. */
static ritz_status lend(ritz_fitter *f, ritz_fit_candidate *candidate,
                        int64_t *at, ritz_reduced *body)
{
    ritz_status status = RITZ_OK;

    for (int64_t k = 0; k < f->num_bodies; k++) {
        RITZ_TRY(
            made_body(f, candidate->method, k, candidate->modes[k], &at[k]));
        if (f->made[at[k]].status != RITZ_OK) {
            (void)snprintf(candidate->refusal, sizeof candidate->refusal, "%s",
                           f->made[at[k]].refusal);
            candidate->excess = HUGE_VAL;
            goto done;
        }
        candidate->spent.wall += f->made[at[k]].spent.wall;
        candidate->spent.cpu += f->made[at[k]].spent.cpu;
        candidate->columns += f->made[at[k]].reduced.K.ncol;
    }
    if (candidate->columns > f->largest) {
        (void)snprintf(candidate->refusal, sizeof candidate->refusal,
                       "%lld columns are more than the %lld that are tried",
                       (long long)candidate->columns, (long long)f->largest);
        candidate->excess = HUGE_VAL;
        goto done;
    }
    for (int64_t k = 0; k < f->scene->num_components; k++)
        body[k] = f->still[k];
    for (int64_t k = 0; k < f->num_bodies; k++)
        body[f->body[k]] = f->made[at[k]].reduced;
done:
    return status;
}

ritz_status ritz_fit_try_scene(ritz_fitter *f, ritz_fit_candidate *candidate)
{
    ritz_status status = RITZ_OK;
    ritz_reduced *body = NULL;
    int64_t *at = NULL;
    ritz_stage stage = {0};
    const ritz_reduced *lent = NULL;

    RITZ_NEW(body, f->scene->num_components);
    RITZ_NEW(at, f->num_bodies);
    RITZ_TRY(lend(f, candidate, at, body));
    if (candidate->refusal[0])
        goto done;
    lent = body;
    RITZ_TRY(ritz_stage_from(f->scene, body, &stage));
    lent = stage.body;
    RITZ_TRY(measure(f, &stage, candidate));
done:
    if (lent) { /* all bodies go home, their dampers installed or not */
        ritz_reduced *home = stage.body ? stage.body : body;

        for (int64_t k = 0; k < f->num_bodies; k++) {
            f->made[at[k]].reduced = home[f->body[k]];
            home[f->body[k]] = (ritz_reduced){0};
        }
        ritz_fit_take_back(f, home);
    }
    ritz_stage_free(&stage);
    free(body);
    free(at);
    return ritz_fit_refuse(status, candidate);
}
