/*
 * Columns of all flexible bodies of a scene in one order. From the whole system
 * one at a time is left out, that without which the system, at the listed
 * configurations, is nearest to its tolerance: so every body has an order of
 * its own, and all of them together a path of systems, each with one column
 * less than the one before.
 */
#include "fit/nest_parts.h"

#include "base/alloc.h"

#include <ritz/nested.h>

#include <stdlib.h>
#include <string.h>

/* In how many parts a count is at most so many each. */
static int64_t parts(int64_t count, int64_t most)
{
    return count > most && most > 0 ? (count + most - 1) / most : 1;
}

/* Where columns or places are many, some of them speak for all: of c columns
   that may go, c systems alone and some 2 c cuts are measured at places. */
static void spare(ritz_fit_nesting *n)
{
    const int64_t most = n->f->request.most_measured;
    const int64_t may_go = n->order.count - n->order.fixed;

    n->every = parts(may_go * n->f->scene->num_configurations, most);
    n->step = parts(2 * may_go * n->f->num_places, most);
}

static ritz_status begin(ritz_fitter *f, const ritz_reduced *whole,
                         ritz_fit_nesting *n)
{
    ritz_status status = RITZ_OK;
    ritz_column_kind *kind = NULL;
    int64_t all = 0;

    *n = (ritz_fit_nesting){.f = f, .whole = whole, .every = 1, .step = 1};
    RITZ_NEW(n->first, f->num_bodies + 1);
    for (int64_t k = 0; k < f->num_bodies; k++) {
        n->first[k] = all;
        all += whole[k].K.ncol;
    }
    n->first[f->num_bodies] = all;
    RITZ_NEW(n->own, all);
    RITZ_NEW(n->some, all);
    RITZ_NEW(kind, all);
    for (int64_t k = 0; k < f->num_bodies; k++)
        RITZ_TRY(ritz_fit_kinds(&whole[k], kind + n->first[k]));
    RITZ_TRY(ritz_fit_order_new(all, kind, ritz_fit_excess_of, n, &n->order));
    spare(n);
done:
    free(kind);
    return status;
}

static void finish(ritz_fit_nesting *n)
{
    ritz_fit_order_free(&n->order);
    free(n->first);
    free(n->own);
    free(n->some);
}

/* Of a body without columns that must stay the one that matters most alone
   does. */
static void keep_one_each(ritz_fit_nesting *n)
{
    ritz_fit_order *o = &n->order;

    for (int64_t k = 0; k < n->f->num_bodies; k++) {
        int64_t at = o->fixed;
        int64_t here = 0;

        if (ritz_fit_own(n, k, o->fixed, o->column) > 0)
            continue;
        while (o->column[at] < n->first[k] || o->column[at] >= n->first[k + 1])
            at++;
        here = o->column[at];
        memmove(o->column + o->fixed + 1, o->column + o->fixed,
                (size_t)(at - o->fixed) * sizeof *o->column);
        o->column[o->fixed++] = here;
    }
}

/* A body with its T and its own order of columns; of a path its errors too. */
static ritz_status nest(const ritz_fit_nesting *n, int64_t k,
                        const ritz_fit_path *path, ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    const ritz_fit_order *o = &n->order;
    const int64_t smallest = ritz_fit_own(n, k, o->fixed, o->column);
    const int64_t count = ritz_fit_own(n, k, o->count, o->column);
    ritz_reduced made = {0};

    RITZ_TRY(ritz_reduced_nest(&n->whole[k], count, n->own, smallest, &made));
    if (path)
        RITZ_TRY(ritz_fit_note(n, k, path, &made));
    *out = made;
    made = (ritz_reduced){0};
done:
    ritz_reduced_free(&made);
    return status;
}

ritz_status ritz_fit_nest_scene(ritz_fitter *f, const ritz_reduced *whole,
                                bool notes, ritz_reduced *body,
                                ritz_fit_path *path)
{
    ritz_status status = RITZ_OK;
    ritz_fit_nesting n = {0};
    ritz_fit_path found = {0};

    RITZ_TRY(begin(f, whole, &n));
    RITZ_TRY(ritz_fit_order_alone(&n.order));
    keep_one_each(&n);
    RITZ_TRY(ritz_fit_order_drop(&n.order));
    RITZ_TRY(ritz_fit_walk(&n, &found));
    for (int64_t k = 0; k < f->num_bodies; k++)
        RITZ_TRY(nest(&n, k, notes ? &found : NULL, &body[f->body[k]]));
    *path = found;
    found = (ritz_fit_path){0};
done:
    ritz_fit_path_free(&found);
    finish(&n);
    return status;
}
