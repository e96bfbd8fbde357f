/*
 * The model of some columns of all flexible bodies, and how far it is off. A
 * component's are measured by several threads at once, where the reference can
 * be shared.
 */
#include "fit/nesting.h"

#include "base/alloc.h"
#include "base/team.h"

#include <math.h>

void ritz_nesting_free(ritz_nesting *n)
{
    ritz_bodies_free(&n->whole);
    ritz_dense_free(&n->parts);
    ritz_pairs_free(&n->modes);
    RITZ_FREE(n->first, n->column, n->alone, n->own, n->some);
}

int64_t ritz_nesting_own(const ritz_nesting *n, int64_t k, int64_t count,
                         const int64_t *column, int64_t *own)
{
    int64_t found = 0;

    for (int64_t j = 0; j < count; j++) {
        if (column[j] < n->first[k] || column[j] >= n->first[k + 1])
            continue;
        if (own)
            own[found] = column[j] - n->first[k];
        found++;
    }
    return found;
}

ritz_status ritz_nesting_join(const ritz_nesting *n, int64_t count,
                              const int64_t *column, ritz_fit_joined *out)
{
    RITZ_OWN_ARRAY int64_t *own = NULL;

    RITZ_CHECK_RAW(own, count);
    RITZ_CHECK(ritz_bodies_new(n->f->num_bodies, &out->own));
    for (int64_t k = 0; k < n->f->num_bodies; k++) {
        ritz_reduced bare = n->whole.item[k]; /* borrowed */

        bare.T = (ritz_dense){0};
        bare.invariants = (ritz_invariants){0};
        RITZ_CHECK(ritz_reduced_nest(&bare,
                                     ritz_nesting_own(n, k, count, column, own),
                                     own, 1, &out->own.item[k]));
    }
    if (!n->f->scene)
        RITZ_CHECK(ritz_dense_pick(&n->parts, count, column, &out->parts));
    return ritz_fit_join_own(n->f, out);
}

ritz_status ritz_nesting_ratio(ritz_nesting *n, int64_t count,
                               const int64_t *column, double most,
                               ritz_pairs *modes, double *out)
{
    const int64_t places = (n->f->num_listed + n->every - 1) / n->every;
    const int64_t from = n->hardest;
    RITZ_OWN(ritz_fit_candidate) judged = {0};
    RITZ_OWN(ritz_fit_joined) joined = {.modes = modes};
    ritz_status status = ritz_nesting_join(n, count, column, &joined);

    for (int64_t t = 0;
         status == RITZ_OK && t < places && (t == 0 || judged.ratio < most);
         t++) {
        const int64_t k = (from + t) % places;
        const double before = judged.ratio;

        status = ritz_fit_measure_at(n->f, &joined, &n->f->place[k * n->every],
                                     RITZ_ONLY_LIMITED, false, &judged);
        if (status == RITZ_OK && judged.ratio > before && places > 1)
            n->hardest = k; /* one place may be that of several threads */
    }
    RITZ_CHECK(ritz_fit_refuse(status, &judged));
    *out = judged.ratio;
    return RITZ_OK;
}

int ritz_nesting_threads(const ritz_nesting *n, int64_t models)
{
    return n->f->scene || ritz_reference_factors(n->f->place[0].reference)
               ? 1
               : ritz_team_ready(models);
}
