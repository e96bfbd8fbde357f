/*
 * The search of one method: rungs 0, 1, 2, 4, 8, ... of its ladder until one is
 * feasible, then bisection, and then the rungs below one by one, since an error
 * may rise where a mode is added and fall again with the next.
 */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <ritz/monitor.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rungs below the best that are tried although the one just below failed. */
enum { COMPONENT_BELOW = 8, SCENE_BELOW = 3 };
/* Twice the best of the others and some: beyond it a method is given up. */
enum { FAR = 2, BESIDE = 8 };
/* A method that was refused so often is. */
enum { MOST_REFUSED = 4 };

static bool was_made(const ritz_fit_candidate *c)
{
    return c->refusal[0] == '\0';
}

static ritz_status append(ritz_fit *fit, ritz_fit_candidate *candidate)
{
    ritz_status status = RITZ_OK;
    ritz_fit_candidate *more = NULL;

    RITZ_NEW(more, fit->count + 1);
    if (fit->count > 0)
        memcpy(more, fit->candidate, (size_t)fit->count * sizeof *more);
    free(fit->candidate);
    fit->candidate = more;
    more[fit->count++] = *candidate;
    *candidate = (ritz_fit_candidate){0};
done:
    return status;
}

static bool is_same(const ritz_fit_candidate *c, const ritz_method *method,
                    const int64_t *modes)
{
    if (c->method != method || c->left_out > 0)
        return false;
    for (int64_t k = 0; k < c->num_bodies; k++)
        if (c->modes[k] != (method->uses & RITZ_USES_MODES ? modes[k] : -1))
            return false;
    return true;
}

ritz_status ritz_fit_visit(ritz_fitter *fitter, ritz_fit *fit, int64_t method,
                           const int64_t *modes, int64_t *at)
{
    ritz_status status = RITZ_OK;
    ritz_fit_candidate candidate = {0};

    for (int64_t k = 0; k < fit->count; k++)
        if (is_same(&fit->candidate[k], fit->method[method], modes)) {
            *at = k;
            return RITZ_OK;
        }
    ritz_monitor_step(fit->method[method]->name, fit->count, 0);
    RITZ_TRY(ritz_fitter_try(fitter, fit->method[method], modes, &candidate));
    RITZ_TRY(append(fit, &candidate));
    *at = fit->count - 1;
done:
    ritz_fit_candidate_free(&candidate);
    return status;
}

/* One method on its ladder. */
typedef struct ladder {
    ritz_fitter *fitter;
    ritz_fit *fit;
    int64_t method, top;
    int64_t *modes; /* to work in */
} ladder;

static ritz_status rung(const ladder *l, int64_t t, int64_t *at)
{
    ritz_fit_rung(l->fitter, t, l->modes);
    return ritz_fit_visit(l->fitter, l->fit, l->method, l->modes, at);
}

static const ritz_fit_candidate *get(const ladder *l, int64_t at)
{
    return &l->fit->candidate[at];
}

/*
 * Up: [low, high] with high the first feasible rung that was met, or -1; low
 * the last below that was made and is not feasible, -1 if none. Where a rung is
 * refused for its size, the highest that is not is sought between.
 */
static ritz_status climb(const ladder *l, int64_t *low, int64_t *high)
{
    ritz_status status = RITZ_OK;
    int64_t refused = 0, at = 0, wall = l->top + 1, before = -1;

    *low = *high = -1;
    for (int64_t t = 0; t < wall && *high < 0;) {
        const ritz_fit_candidate *c = NULL;

        RITZ_TRY(rung(l, t, &at));
        c = get(l, at);
        if (c->feasible) {
            *high = t;
        } else if (was_made(c)) {
            if (t > 4 && c->order == before) /* it has no more to give */
                break;
            before = c->order;
            *low = t;
        } else if (*low >= 0) {
            wall = t;
        } else if (++refused == MOST_REFUSED) {
            break;
        }
        t = wall <= l->top || t == l->top ? wall
            : t == 0                      ? 1
            : 2 * t < l->top              ? 2 * t
                                          : l->top;
    }
    for (int64_t t = 0; *high < 0 && *low >= 0 && wall - *low > 1;) {
        t = *low + (wall - *low) / 2;
        if (wall > l->top) /* all that was tried was made */
            break;
        RITZ_TRY(rung(l, t, &at));
        if (get(l, at)->feasible)
            *high = t;
        else if (was_made(get(l, at)))
            *low = t;
        else
            wall = t;
    }
done:
    return status;
}

/* Between, and then below. */
static ritz_status descend(const ladder *l, int64_t low, int64_t high)
{
    ritz_status status = RITZ_OK;
    int64_t below = l->fitter->scene ? SCENE_BELOW : COMPONENT_BELOW;
    int64_t at = 0;

    while (high - low > 1) {
        int64_t t = low + (high - low) / 2;

        RITZ_TRY(rung(l, t, &at));
        *(get(l, at)->feasible ? &high : &low) = t;
    }
    for (int64_t t = high - 1; t >= 0 && t >= high - below; t--) {
        RITZ_TRY(rung(l, t, &at));
        if (get(l, at)->feasible)
            high = t;
    }
done:
    return status;
}

/* Of two that are as small and as near the one that came first. */
bool ritz_fit_is_better(const ritz_fit_candidate *a,
                        const ritz_fit_candidate *b)
{
    if (a->order != b->order)
        return a->order < b->order;
    return a->excess < b->excess * (1.0 - 1e-6);
}

/* The best and the nearest of a method. */
static void conclude(ritz_fit *fit, int64_t method)
{
    fit->best[method] = fit->reached[method] = -1;
    for (int64_t k = 0; k < fit->count; k++) {
        const ritz_fit_candidate *c = &fit->candidate[k];
        int64_t best = fit->best[method];
        int64_t reached = fit->reached[method];

        if (c->method != fit->method[method])
            continue;
        if (c->feasible &&
            (best < 0 || ritz_fit_is_better(c, &fit->candidate[best])))
            fit->best[method] = k;
        if (was_made(c) &&
            (reached < 0 || c->excess < fit->candidate[reached].excess))
            fit->reached[method] = k;
    }
}

/*
 * How far a method is pursued: while others do with far less, not at all. Rungs
 * are modes, of which there are no more than columns.
 */
static int64_t top_of(const ritz_fitter *fitter, const ritz_fit *fit,
                      int64_t method)
{
    int64_t top = fitter->scene ? fitter->num_steps : fitter->largest;
    int64_t least = INT64_MAX;

    if (!(fit->method[method]->uses & RITZ_USES_MODES))
        return 0;
    for (int64_t m = 0; m < method; m++)
        if (fit->best[m] >= 0 && fit->candidate[fit->best[m]].order < least)
            least = fit->candidate[fit->best[m]].order;
    if (!fitter->request.thorough && least < INT64_MAX &&
        FAR * least + BESIDE < top)
        top = FAR * least + BESIDE;
    return top;
}

static ritz_status search(ritz_fitter *fitter, ritz_fit *fit, int64_t method)
{
    ritz_status status = RITZ_OK;
    ladder l = {.fitter = fitter, .fit = fit, .method = method};
    int64_t low = -1, high = -1;

    RITZ_NEW(l.modes, fitter->num_bodies);
    l.top = top_of(fitter, fit, method);
    RITZ_TRY(climb(&l, &low, &high));
    if (high >= 0)
        RITZ_TRY(descend(&l, low, high));
    conclude(fit, method);
    if (fitter->scene && fit->best[method] >= 0) {
        RITZ_TRY(ritz_fit_thin(fitter, fit, method, &fit->best[method]));
        conclude(fit, method);
    }
done:
    free(l.modes);
    return status;
}

/* Second-order models by a number of modes; others only if they are named. */
static bool is_usual(const ritz_fitter *fitter, const ritz_method *method)
{
    const int special =
        RITZ_USES_SPACE | RITZ_USES_GRAMIAN | RITZ_USES_OPERATOR;
    const int joined = RITZ_USES_MODES | RITZ_USES_ATTACHED;

    if (fitter->scene)
        return (method->uses & joined) == joined &&
               method != &ritz_method_dual_craig_bampton &&
               method != &ritz_method_serep;
    return (method->uses & RITZ_USES_MODES) && !(method->uses & special) &&
           !(method->uses & RITZ_USES_NEIGHBOUR) &&
           method != &ritz_method_dual_craig_bampton &&
           method != &ritz_method_balanced_band; /* its models are of states */
}

static ritz_status list_methods(const ritz_fitter *fitter, ritz_fit *fit)
{
    ritz_status status = RITZ_OK;
    const ritz_fit_request *asked = &fitter->request;
    int64_t all = 0;

    while (ritz_methods[all])
        all++;
    if (asked->num_methods > 0)
        all = asked->num_methods;
    RITZ_NEW(fit->method, all); /* NOLINT: an array of pointers is meant */
    RITZ_NEW(fit->best, all);
    RITZ_NEW(fit->reached, all);
    for (int64_t k = 0; k < all; k++) {
        const ritz_method *method =
            asked->num_methods > 0 ? asked->methods[k] : ritz_methods[k];

        if (asked->num_methods == 0 && !is_usual(fitter, method))
            continue;
        fit->best[fit->num_methods] = fit->reached[fit->num_methods] = -1;
        fit->method[fit->num_methods++] = method;
    }
done:
    return status;
}

/* The best of all methods, and the best of the others. */
static void choose(ritz_fit *fit)
{
    int64_t *const into[] = {&fit->chosen, &fit->runner_up};

    for (int t = 0; t < 2; t++) {
        *into[t] = -1;
        for (int64_t m = 0; m < fit->num_methods; m++) {
            int64_t k = fit->best[m];

            if (k < 0 || (t == 1 && k == fit->chosen))
                continue;
            if (*into[t] < 0 || ritz_fit_is_better(&fit->candidate[k],
                                                   &fit->candidate[*into[t]]))
                *into[t] = k;
        }
    }
}

/* Of the two best, columns that matter to nothing are left out. */
static ritz_status trim(ritz_fitter *fitter, ritz_fit *fit)
{
    ritz_status status = RITZ_OK;
    const int64_t both[] = {fit->chosen, fit->runner_up};
    ritz_fit_candidate less = {0};

    for (int t = 0; t < 2 && !fitter->scene; t++) {
        if (both[t] < 0)
            continue;
        RITZ_TRY(ritz_fit_trim(fitter, &fit->candidate[both[t]], &less));
        if (less.order > 0) {
            if (fitter->request.observe)
                fitter->request.observe(&less, fitter->request.context);
            RITZ_TRY(append(fit, &less));
        }
    }
    for (int64_t m = 0; m < fit->num_methods; m++)
        conclude(fit, m);
    choose(fit);
done:
    ritz_fit_candidate_free(&less);
    return status;
}

ritz_status ritz_fitter_search(ritz_fitter *fitter, ritz_fit *out)
{
    ritz_status status = RITZ_OK;
    ritz_fit fit = {.chosen = -1, .runner_up = -1};

    RITZ_TRY(list_methods(fitter, &fit));
    for (int64_t m = 0; m < fit.num_methods; m++)
        RITZ_TRY(search(fitter, &fit, m));
    choose(&fit);
    RITZ_TRY(trim(fitter, &fit));
    RITZ_TRY(ritz_fit_explain(fitter, &fit));
    *out = fit;
    fit = (ritz_fit){0};
done:
    ritz_fit_free(&fit);
    return status;
}

/* Of a method's candidates of no higher order the largest, the nearest of
 * those; -1: it has none. */
static int64_t largest_of(const ritz_fit *fit, int64_t method, int64_t order)
{
    int64_t best = -1;

    for (int64_t k = 0; k < fit->count; k++) {
        const ritz_fit_candidate *c = &fit->candidate[k];
        const ritz_fit_candidate *b = best < 0 ? NULL : &fit->candidate[best];

        if (c->method != fit->method[method] || !was_made(c) ||
            c->order > order)
            continue;
        if (!b || c->order > b->order ||
            (c->order == b->order && c->excess < b->excess))
            best = k;
    }
    return best;
}

ritz_status ritz_fitter_equal(ritz_fitter *fitter, int64_t order, ritz_fit *fit,
                              int64_t *at)
{
    ritz_status status = RITZ_OK;
    ladder l = {.fitter = fitter, .fit = fit};

    RITZ_NEW(l.modes, fitter->num_bodies);
    for (int64_t m = 0; m < fit->num_methods; m++) {
        bool asks = fit->method[m]->uses & RITZ_USES_MODES;
        int64_t low = -1, here = -1;
        int64_t high = !asks           ? 1
                       : fitter->scene ? fitter->num_steps + 1
                                       : order + 1;

        at[m] = -1;
        l.method = m;
        while (high - low > 1) {
            int64_t t = low + (high - low) / 2;

            RITZ_TRY(rung(&l, t, &here));
            if (was_made(get(&l, here)) && get(&l, here)->order <= order) {
                low = t;
                at[m] = here;
            } else if (was_made(get(&l, here)) || at[m] >= 0) {
                high = t;
            } else {
                low = t; /* refused for being too small, perhaps */
            }
        }
        conclude(fit, m);
        at[m] = largest_of(fit, m, order);
    }
done:
    free(l.modes);
    return status;
}
