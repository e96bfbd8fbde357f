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
#include "gramians/cluster.h"
#include "ranking/costs.h"

#include <math.h>

static ritz_status cluster_value(const ritz_modal *cluster, double *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense V = {0};
    double sum = 0.0;

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
    ritz_status status = RITZ_OK;
    const ritz_modal *modal = &request->modal;
    ritz_modal cluster = {0};
    int64_t last = 0;

    for (int64_t first = 0; first < modal->count; first = last) {
        last = ritz_modal_cluster(modal, first);
        RITZ_TRY(ritz_modal_part(modal, first, last, &cluster));
        RITZ_TRY(cluster_value(&cluster, &ranking->value[first]));
        for (int64_t k = first + 1; k < last; k++)
            ranking->value[k] = ranking->value[first];
        ritz_modal_free(&cluster);
    }
done:
    ritz_modal_free(&cluster);
    return status;
}

const ritz_ranker ritz_ranker_h2 = {
    .name = "h2",
    .summary = "H2 norm of each mode (or cluster) alone",
    .reference = "Skelton1982",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING,
    .rank = rank,
};
