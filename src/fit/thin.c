/*
 * Fewer modes than one cut for all bodies gives: from each body in turn one is
 * taken, that whose loss hurts least is gone for good; where none can go, bodies
 * exchange modes, several of one for fewer of another.
 */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_GIVEN = 4 };

typedef struct thinning {
    ritz_fitter *fitter;
    ritz_fit *fit;
    int64_t method;
    int64_t *from, *modes; /* of the best so far, and to work in */
    int64_t best;          /* candidate */
} thinning;

/* Try `from` with @p less modes of one body and @p more of another. */
static ritz_status move(thinning *t, int64_t i, int64_t less, int64_t j,
                        int64_t more)
{
    const ritz_fit_candidate *all = NULL;
    int64_t at = 0;

    if (t->from[i] < less)
        return RITZ_OK;
    memcpy(t->modes, t->from, (size_t)t->fitter->num_bodies * sizeof *t->modes);
    t->modes[i] -= less;
    t->modes[j] += more;
    RITZ_CHECK(ritz_fit_visit(t->fitter, t->fit, t->method, t->modes, &at));
    all = t->fit->candidate;
    if (all[at].feasible && ritz_fit_is_better(&all[at], &all[t->best]))
        t->best = at;
    return RITZ_OK;
}

static ritz_status take(thinning *t)
{
    for (int64_t i = 0; i < t->fitter->num_bodies; i++)
        RITZ_CHECK(move(t, i, 1, i, 0));
    return RITZ_OK;
}

static ritz_status exchange(thinning *t)
{
    int64_t bodies = t->fitter->num_bodies;

    for (int64_t given = 1; given <= MOST_GIVEN; given++)
        for (int64_t i = 0; i < bodies; i++)
            for (int64_t j = 0; j < bodies; j++)
                if (i != j)
                    RITZ_CHECK(move(t, i, given + 1, j, given));
    return RITZ_OK;
}

ritz_status ritz_fit_thin(ritz_fitter *fitter, ritz_fit *fit, int64_t method,
                          int64_t *best)
{
    ritz_status status = RITZ_OK;
    size_t size = (size_t)fitter->num_bodies * sizeof(int64_t);
    thinning t = {
        .fitter = fitter, .fit = fit, .method = method, .best = *best};

    RITZ_NEW(t.from, fitter->num_bodies);
    RITZ_NEW(t.modes, fitter->num_bodies);
    for (int64_t before = -1; before != t.best;) {
        before = t.best;
        memcpy(t.from, fit->candidate[before].modes, size);
        RITZ_TRY(take(&t));
        if (t.best == before)
            RITZ_TRY(exchange(&t));
    }
    *best = t.best;
done:
    free(t.from);
    free(t.modes);
    return status;
}
