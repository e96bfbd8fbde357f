/*
 * The largest exact Hankel value of a mode (or cluster) alone, which for one
 * mode with a displacement output is
 *
 *     sigma = |b||c| / (4 zeta w^2) (sqrt(1 + zeta^2) + zeta)
 *
 * [Moore1981], [McDaniel2000] eq. 3.2.19 to 3.2.21
 */
#include "base/alloc.h"
#include "gramians/cluster.h"

#include <ritz/ranking.h>

#include <stdlib.h>

static ritz_status rank(const ritz_rank_request *request, ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    const ritz_modal *modal = &request->modal;
    double *value = ranking->value;
    ritz_modal cluster = {0};
    double *sigma = NULL;
    int64_t last = 0;

    RITZ_NEW(sigma, 2 * modal->count);
    for (int64_t first = 0; first < modal->count; first = last) {
        last = ritz_modal_cluster(modal, first);
        RITZ_TRY(ritz_modal_part(modal, first, last, &cluster));
        RITZ_TRY(ritz_modal_hankel(&cluster, sigma));
        for (int64_t k = first; k < last; k++)
            value[k] = sigma[0];
        ritz_modal_free(&cluster);
    }
done:
    ritz_modal_free(&cluster);
    free(sigma);
    return status;
}

static double exact(const double pair[static 2])
{
    return pair[0];
}

const ritz_ranker ritz_ranker_hankel = {
    .name = "hankel",
    .summary = "largest exact Hankel value of each mode (or cluster) alone",
    .reference = "Moore1981",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING,
    .exact = exact,
    .rank = rank,
};
