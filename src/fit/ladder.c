/*
 * The search of one method: rungs 0, 1, 2, 4, 8, ... of its ladder until one is
 * feasible, then bisection, and then the rungs below one by one, since an error
 * may rise where a mode is added and fall again with the next.
 */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <stdlib.h>

/* Rungs below the best that are tried although the one just below failed. */
enum { COMPONENT_BELOW = 8, SCENE_BELOW = 3 };
/* Twice the best of the others and some: beyond it a method is given up. */
enum { FAR = 2, BESIDE = 8 };
/* A method that was refused so often is. */
enum { MOST_REFUSED = 4 };

/* One method on its ladder. */
typedef struct ladder {
    ritz_fitter *fitter;
    ritz_fit *fit;
    int64_t method, top;
    int64_t *modes; /* to work in */
} ladder;

static ritz_status rung(const ladder *l, int64_t t, int64_t *at)
{
    ritz_fit_rung(l->fitter, l->fit->method[l->method], t, l->modes);
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
        } else if (ritz_fit_was_made(c)) {
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
        else if (ritz_fit_was_made(get(l, at)))
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

/*
 * How far a method is pursued: while others do with far less, not at all. Rungs
 * are modes, of which there are no more than columns.
 */
static int64_t top_of(const ritz_fitter *fitter, const ritz_fit *fit,
                      int64_t method)
{
    int64_t top = fitter->scene ? ritz_fit_rungs(fitter, fit->method[method])
                                : fitter->largest;
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

/*
 * Of a method that met nothing the largest model is measured, if bounds had
 * ruled it out: it says how near the method comes.
 */
static ritz_status measure_largest(const ladder *l)
{
    ritz_status status = RITZ_OK;
    ritz_fitter *fitter = l->fitter;
    const bool thorough = fitter->request.thorough;
    const int64_t at = ritz_fit_largest_of(l->fit, l->method, INT64_MAX);
    ritz_fit_candidate *c = at < 0 ? NULL : &l->fit->candidate[at];
    ritz_fit_candidate again = {0};

    if (!c || !c->screened)
        return RITZ_OK;
    fitter->request.thorough = true;
    status = ritz_fitter_try(fitter, c->method, c->modes, &again);
    fitter->request.thorough = thorough;
    RITZ_TRY(status);
    ritz_fit_candidate_free(c);
    *c = again;
done:
    return status;
}

ritz_status ritz_fit_search(ritz_fitter *fitter, ritz_fit *fit, int64_t method)
{
    ritz_status status = RITZ_OK;
    ladder l = {.fitter = fitter, .fit = fit, .method = method};
    int64_t low = -1, high = -1;

    RITZ_NEW(l.modes, fitter->num_bodies);
    l.top = top_of(fitter, fit, method);
    RITZ_TRY(climb(&l, &low, &high));
    if (high >= 0)
        RITZ_TRY(descend(&l, low, high));
    ritz_fit_conclude(fit, method);
    if (fit->best[method] < 0) {
        RITZ_TRY(measure_largest(&l));
        ritz_fit_conclude(fit, method);
    }
    if (fitter->scene && fit->best[method] >= 0) {
        RITZ_TRY(ritz_fit_thin(fitter, fit, method, &fit->best[method]));
        ritz_fit_conclude(fit, method);
    }
done:
    free(l.modes);
    return status;
}
