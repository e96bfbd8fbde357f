/* A scene's candidates: bodies in a basis, each made once, lent to a stage. */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <ritz/synthesis.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Entries of T of all bodies that were made: half a gigabyte. */
static const int64_t most_entries = INT64_C(1) << 26;

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

    if (method == &ritz_fit_compare)
        return ritz_fit_second_body(f, k, modes, out);
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

void ritz_fit_forget(ritz_fitter *f, const ritz_method *method)
{
    int64_t kept = 0;

    for (int64_t k = 0; k < f->num_made; k++)
        if (f->made[k].method == method)
            free_made(&f->made[k]);
        else
            f->made[kept++] = f->made[k];
    f->num_made = kept;
}

/* Whether there is room for one more T; bounds need those of all bodies. */
static bool keep_basis(const ritz_fitter *f, const ritz_dense *T)
{
    int64_t held = T->nrow * T->ncol;

    for (int64_t k = 0; k < f->num_made; k++)
        held += f->made[k].reduced.T.nrow * f->made[k].reduced.T.ncol;
    return f->place[0].estimator && held <= most_entries;
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
    if (!keep_basis(f, &made.reduced.T))
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

/* The candidate's bodies, lent to a stage. */
static ritz_status lend(ritz_fitter *f, ritz_fit_candidate *candidate,
                        int64_t *at, ritz_reduced *body)
{
    ritz_status status = RITZ_OK;

    candidate->spent = (ritz_fit_watch){0};
    candidate->columns = 0;
    if (candidate->method == &ritz_fit_compare) {
        RITZ_TRY(ritz_fit_second_make(f));
        candidate->spent = f->second.spent;
    }
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
    for (int64_t k = 0; k < f->scene->num_components; k++)
        body[k] = f->still[k];
    for (int64_t k = 0; k < f->num_bodies; k++)
        body[f->body[k]] = f->made[at[k]].reduced;
done:
    return status;
}

/* What is done with the candidate once it is a stage. */
typedef ritz_status use(ritz_fitter *f, const ritz_stage *stage,
                        ritz_fit_candidate *candidate);

static ritz_status with_stage(ritz_fitter *f, use *what,
                              ritz_fit_candidate *candidate)
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
    RITZ_TRY(what(f, &stage, candidate));
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
    return status;
}

ritz_status ritz_fit_try_scene(ritz_fitter *f, ritz_fit_candidate *candidate)
{
    ritz_status status = with_stage(f, ritz_fit_measure_scene, candidate);

    return ritz_fit_refuse(status, candidate);
}

ritz_status ritz_fit_bound(ritz_fitter *f, ritz_fit_candidate *candidate)
{
    return f->scene && f->place[0].estimator && candidate->left_out == 0
               ? with_stage(f, ritz_fit_bound_scene, candidate)
               : RITZ_OK;
}
