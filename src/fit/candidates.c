/* The list of what was tried, and which of it is best. */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <ritz/monitor.h>

#include <stdlib.h>
#include <string.h>

bool ritz_fit_was_made(const ritz_fit_candidate *c)
{
    return c->refusal[0] == '\0';
}

ritz_status ritz_fit_append(ritz_fit *fit, ritz_fit_candidate *candidate)
{
    ritz_fit_candidate *more = NULL;

    RITZ_CHECK_NEW(more, fit->count + 1);
    if (fit->count > 0)
        memcpy(more, fit->candidate, (size_t)fit->count * sizeof *more);
    free(fit->candidate);
    fit->candidate = more;
    more[fit->count++] = *candidate;
    *candidate = (ritz_fit_candidate){0};
    return RITZ_OK;
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
    RITZ_TRY(ritz_fit_append(fit, &candidate));
    *at = fit->count - 1;
done:
    ritz_fit_candidate_free(&candidate);
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

double ritz_fit_misses(const ritz_fit_candidate *c)
{
    const ritz_measure *m = ritz_measures_find(&c->errors, "missing-modes");

    return m && m->value > m->limit ? m->value : 0.0;
}

/* Of what was not measured nobody knows more than how far off it is at least;
 * errors of the modes that are there say little where others are missing. */
bool ritz_fit_is_nearer(const ritz_fit_candidate *a,
                        const ritz_fit_candidate *b)
{
    double more = ritz_fit_misses(a) - ritz_fit_misses(b);

    if (a->screened != b->screened)
        return b->screened;
    return more != 0.0 ? more < 0.0 : a->excess < b->excess;
}

int64_t ritz_fit_largest_of(const ritz_fit *fit, int64_t method, int64_t order)
{
    int64_t best = -1;

    for (int64_t k = 0; k < fit->count; k++) {
        const ritz_fit_candidate *c = &fit->candidate[k];
        const ritz_fit_candidate *b = best < 0 ? NULL : &fit->candidate[best];

        if (c->method != fit->method[method] || !ritz_fit_was_made(c) ||
            c->order > order)
            continue;
        if (!b || c->order > b->order ||
            (c->order == b->order && c->excess < b->excess))
            best = k;
    }
    return best;
}

/* The best and the nearest of a method. */
void ritz_fit_conclude(ritz_fit *fit, int64_t method)
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
        if (ritz_fit_was_made(c) &&
            (reached < 0 || ritz_fit_is_nearer(c, &fit->candidate[reached])))
            fit->reached[method] = k;
    }
}
