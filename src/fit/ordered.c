/* Orders of columns that were found are kept: to leave columns of a candidate
   out, to bound the rest and to write it, the same order is needed. */
#include "fit/fitter.h"

#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

const ritz_fit_ordered *ritz_fit_ordered_find(const ritz_fitter *f,
                                              const ritz_fit_candidate *of,
                                              int64_t count)
{
    for (int64_t k = 0; k < f->num_ordered; k++) {
        const ritz_fit_ordered *o = &f->ordered[k];

        if (o->method == of->method && o->count == count &&
            memcmp(o->modes, of->modes,
                   (size_t)f->num_bodies * sizeof *o->modes) == 0)
            return o;
    }
    return NULL;
}

ritz_status ritz_fit_ordered_keep(ritz_fitter *f, const ritz_fit_candidate *of,
                                  const ritz_fit_ordered *found)
{
    RITZ_OWN(ritz_fit_ordered)
    kept = {.method = of->method,
            .count = found->count,
            .fixed = found->fixed,
            .step = found->step};

    RITZ_CHECK_COPY(kept.modes, of->modes, f->num_bodies);
    RITZ_CHECK_COPY(kept.column, found->column, found->count);
    RITZ_CHECK_ROOM(f->ordered, f->num_ordered, f->room_ordered);
    RITZ_MOVE(f->ordered[f->num_ordered++], kept);
    return RITZ_OK;
}

void ritz_fit_ordered_free(ritz_fit_ordered *ordered)
{
    RITZ_FREE(ordered->modes, ordered->column);
    *ordered = (ritz_fit_ordered){0};
}
