/*
 * The largest exact Hankel value of a mode (or cluster) alone, which for one
 * mode with a displacement output is
 *
 *     sigma = |b||c| / (4 zeta w^2) (sqrt(1 + zeta^2) + zeta)
 *
 * [Moore1981], [McDaniel2000] eq. 3.2.19 to 3.2.21
 */
#include "base/alloc.h"
#include "ranking/costs.h"

#include <stdlib.h>

static ritz_status value(const ritz_rank_request *request,
                         const ritz_modal *cluster, double *out)
{
    ritz_status status = RITZ_OK;
    double *sigma = NULL;

    (void)request;
    RITZ_NEW(sigma, 2 * cluster->count);
    RITZ_TRY(ritz_modal_hankel(cluster, sigma));
    *out = sigma[0];
done:
    free(sigma);
    return status;
}

static ritz_status rank(const ritz_rank_request *request, ritz_ranking *ranking)
{
    return ritz_ranking_by_cluster(request, value, ranking);
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
