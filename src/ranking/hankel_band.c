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
#include "gramians/cluster.h"

#include <ritz/ranking.h>

#include <stdlib.h>

static ritz_status rank(const ritz_rank_request *request, ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    const ritz_modal *modal = &request->modal;
    ritz_modal cluster = {0};
    double *sigma = NULL;
    int64_t last = 0;

    RITZ_NEW(sigma, 2 * modal->count);
    for (int64_t first = 0; first < modal->count; first = last) {
        last = ritz_modal_cluster(modal, first);
        RITZ_TRY(ritz_modal_part(modal, first, last, &cluster));
        RITZ_TRY(ritz_modal_hankel_band(&cluster, request->band_hz, sigma));
        for (int64_t k = first; k < last; k++)
            ranking->value[k] = sigma[0];
        ritz_modal_free(&cluster);
    }
done:
    ritz_modal_free(&cluster);
    free(sigma);
    return status;
}

const ritz_ranker ritz_ranker_hankel_band = {
    .name = "hankel-band",
    .summary = "largest Hankel value of each mode alone within a band",
    .reference = "GawronskiJuang1990",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING |
             RITZ_RANK_BAND,
    .rank = rank,
};
