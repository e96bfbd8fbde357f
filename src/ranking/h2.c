/*
 * The H2 norm of a mode (or cluster) alone, sqrt(trace(C W_c C')), which for
 * one mode with a displacement output is
 *
 *     |b||c| / sqrt(4 zeta w^3)
 *
 * Squares of these add up to H2 squared of the whole only where modes do not
 * couple: modal-cost is that with all that they share.
 *
 * [Skelton1982]
 */
#include "ranking/costs.h"

#include <math.h>

static ritz_status value(const ritz_rank_request *request,
                         const ritz_modal *cluster, double *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense V = {0};
    double sum = 0.0;

    (void)request;
    RITZ_TRY(ritz_modal_costs(cluster, &V));
    for (int64_t k = 0; k < V.nrow * V.ncol; k++)
        sum += V.val[k];
    *out = sqrt(fmax(sum, 0.0));
done:
    ritz_dense_free(&V);
    return status;
}

static ritz_status rank(const ritz_rank_request *request, ritz_ranking *ranking)
{
    return ritz_ranking_by_cluster(request, value, ranking);
}

const ritz_ranker ritz_ranker_h2 = {
    .name = "h2",
    .summary = "H2 norm of each mode (or cluster) alone",
    .reference = "Skelton1982",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING,
    .rank = rank,
};
