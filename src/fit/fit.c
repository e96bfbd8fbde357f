/* Over all methods: which are tried, and which candidate is chosen. */
#include "fit/fitter.h"

#include "base/alloc.h"

#include <ritz/base.h>

#include <stdlib.h>
#include <string.h>

/* Second-order models by a number of modes; others only if they are named. */
static bool is_usual(const ritz_fitter *fitter, const ritz_method *method)
{
    const int special =
        RITZ_USES_SPACE | RITZ_USES_GRAMIAN | RITZ_USES_OPERATOR;
    const int joined = RITZ_USES_MODES | RITZ_USES_ATTACHED;

    if (fitter->scene)
        return (method->uses & joined) == joined &&
               !(method->only_named & RITZ_NAMED_FOR_SCENES);
    return (method->uses & RITZ_USES_MODES) && !(method->uses & special) &&
           !(method->uses & RITZ_USES_NEIGHBOUR) &&
           !(method->only_named & RITZ_NAMED_FOR_COMPONENTS);
}

/* The methods of the request, or all usual ones and, of joined bodies,
   `compare`. */
static ritz_status list_methods(ritz_fitter *fitter, ritz_fit *fit)
{
    const ritz_fit_request *asked = &fitter->request;
    bool joined = fitter->scene && fitter->scene->num_components > 1;
    int64_t all = 0;

    while (ritz_methods[all])
        all++;
    if (asked->num_methods > 0)
        all = asked->num_methods;
    RITZ_CHECK_NEW(fit->method, all + 1); /* NOLINT: of pointers */
    RITZ_CHECK_NEW(fit->best, all + 1);
    RITZ_CHECK_NEW(fit->reached, all + 1);
    RITZ_CHECK_NEW(fit->end, all + 1);
    for (int64_t k = 0; k < all; k++)
        if (asked->num_methods > 0)
            fit->method[fit->num_methods++] = asked->methods[k];
        else if (is_usual(fitter, ritz_methods[k]))
            fit->method[fit->num_methods++] = ritz_methods[k];
    if (asked->num_methods == 0 && joined)
        fit->method[fit->num_methods++] = &ritz_fit_compare;
    for (int64_t m = 0; m < fit->num_methods; m++) {
        fit->best[m] = fit->reached[m] = -1;
        if (fitter->scene && fit->method[m] == &ritz_fit_compare)
            RITZ_CHECK(ritz_fit_second_make(fitter, fitter->rich_hz, NULL));
    }
    return RITZ_OK;
}

/* Best of all methods but one; -1: none meets the tolerance. */
static int64_t find_best(const ritz_fit *fit, int64_t but)
{
    int64_t found = -1;

    for (int64_t m = 0; m < fit->num_methods; m++) {
        const int64_t k = fit->best[m];

        if (k >= 0 && k != but &&
            (found < 0 ||
             ritz_fit_is_better(&fit->candidate[k], &fit->candidate[found])))
            found = k;
    }
    return found;
}

static void choose_best(ritz_fit *fit)
{
    fit->chosen = find_best(fit, -1);
    fit->runner_up = find_best(fit, fit->chosen);
}

/* Leave columns that matter to nothing out of one method's best candidate. */
static ritz_status trim_candidate(ritz_fitter *fitter, int64_t at,
                                  ritz_fit *fit)
{
    RITZ_OWN(ritz_fit_candidate) less = {0};

    ritz_monitor_step("columns to be left out", at, fit->count);
    RITZ_CHECK(ritz_fit_trim(fitter, &fit->candidate[at], &less));
    if (less.order == 0)
        return RITZ_OK;
    if (fitter->request.observe)
        fitter->request.observe(&less, fitter->request.context);
    return ritz_fit_append(fit, &less);
}

/* The same of every method that may still be the best then, and choose again. */
static ritz_status trim_best(ritz_fitter *fitter, ritz_fit *fit)
{
    double most = 0.0;

    if (fit->chosen >= 0)
        most = RITZ_FIT_REACH * (double)fit->candidate[fit->chosen].order;
    for (int64_t m = 0; m < fit->num_methods; m++) {
        int64_t at = fit->best[m];

        if (at >= 0 &&
            ((double)fit->candidate[at].order <= most || at == fit->runner_up))
            RITZ_CHECK(trim_candidate(fitter, at, fit));
    }
    for (int64_t m = 0; m < fit->num_methods; m++)
        ritz_fit_conclude(fit, m);
    choose_best(fit);
    return RITZ_OK;
}

ritz_status ritz_fitter_search(ritz_fitter *fitter, ritz_fit *out)
{
    RITZ_OWN(ritz_fit) fit = {.chosen = -1, .runner_up = -1};

    RITZ_CHECK(list_methods(fitter, &fit));
    for (int64_t m = 0; m < fit.num_methods; m++)
        RITZ_CHECK(ritz_fit_search(fitter, &fit, m, false));
    for (int64_t m = 0; m < fit.num_methods; m++)
        if (fitter->scene && fit.best[m] < 0 &&
            fit.method[m] != &ritz_fit_compare)
            RITZ_CHECK(ritz_fit_search(fitter, &fit, m, true));
    choose_best(&fit);
    RITZ_CHECK(trim_best(fitter, &fit));
    if (fit.chosen >= 0)
        RITZ_CHECK(ritz_fit_bound(fitter, &fit.candidate[fit.chosen]));
    if (fit.runner_up >= 0)
        RITZ_CHECK(ritz_fit_bound(fitter, &fit.candidate[fit.runner_up]));
    RITZ_CHECK(ritz_fit_explain(fitter, &fit));
    RITZ_MOVE(*out, fit);
    return RITZ_OK;
}

/* Largest candidate of a method with at most @p order columns, by bisection. */
static ritz_status approach_order(ritz_fitter *fitter, int64_t order,
                                  int64_t method, int64_t *modes, ritz_fit *fit)
{
    const ritz_method *asked = fit->method[method];
    bool met = false;
    int64_t low = -1, at = 0;
    int64_t high = 1 + (fitter->scene ? ritz_fit_rungs(fitter, asked) : order);

    if (!(asked->uses & RITZ_USES_MODES))
        high = 1;
    while (high - low > 1) {
        int64_t t = low + (high - low) / 2;
        const ritz_fit_candidate *c = NULL;

        ritz_fit_rung(fitter, asked, t, modes);
        RITZ_CHECK(ritz_fit_visit(fitter, fit, method, modes, &at));
        c = &fit->candidate[at];
        if (ritz_fit_was_made(c) && c->order <= order) {
            low = t;
            met = true;
        } else if (ritz_fit_was_made(c) || met || c->order > fitter->largest) {
            high = t;
        } else {
            low = t; /* refused for being too small, perhaps */
        }
    }
    return RITZ_OK;
}

ritz_status ritz_fitter_equal(ritz_fitter *fitter, int64_t order, ritz_fit *fit,
                              int64_t *at)
{
    RITZ_OWN_ARRAY int64_t *modes = NULL;

    RITZ_CHECK_NEW(modes, fitter->num_bodies);
    for (int64_t m = 0; m < fit->num_methods; m++) {
        RITZ_CHECK(approach_order(fitter, order, m, modes, fit));
        ritz_fit_conclude(fit, m);
        at[m] = ritz_fit_largest_of(fit, fit->method[m], order);
    }
    return RITZ_OK;
}

void ritz_fit_free(ritz_fit *fit)
{
    RITZ_FREE_EACH(ritz_fit_candidate, fit->count, fit->candidate);
    free(fit->method);
    free(fit->best);
    free(fit->reached);
    free(fit->end);
    *fit = (ritz_fit){0};
}
