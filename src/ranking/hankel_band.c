/*
 * The largest Hankel value of a mode (or cluster) alone over a band: of the
 * Gramians
 *
 *     W_c = 1/pi Re int_{w1}^{w2} (i w - A)^-1 B B' (i w - A)^-* dw
 *
 * and W_o likewise, which hold what happens between w1 and w2 alone. From 0 to
 * infinity it is `hankel`.
 *
 * [GawronskiJuang1990]
 */
#include "base/alloc.h"
#include "ranking/costs.h"

#include <stdlib.h>

static ritz_status value(const ritz_rank_request *request,
                         const ritz_modal *cluster, double *out)
{
    ritz_status status = RITZ_OK;
    double *sigma = NULL;

    RITZ_NEW(sigma, 2 * cluster->count);
    RITZ_TRY(ritz_modal_hankel_band(cluster, request->band_hz, sigma));
    *out = sigma[0];
done:
    free(sigma);
    return status;
}

static ritz_status rank(const ritz_rank_request *request, ritz_ranking *ranking)
{
    return ritz_ranking_by_cluster(request, value, ranking);
}

const ritz_ranker ritz_ranker_hankel_band = {
    .name = "hankel-band",
    .summary = "largest Hankel value of each mode alone within a band",
    .reference = "GawronskiJuang1990",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING |
             RITZ_RANK_BAND,
    .rank = rank,
};
