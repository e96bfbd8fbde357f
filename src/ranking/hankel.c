/*
 * The largest exact Hankel value of a mode (or cluster) alone, which for one
 * mode with a displacement output is
 *
 *     sigma = |b||c| / (4 zeta w^2) (sqrt(1 + zeta^2) + zeta)
 *
 * [Moore1981], [McDaniel2000] eq. 3.2.19 to 3.2.21
 */
#include "base/alloc.h"
#include "gramians/modal.h"
#include "ranking/costs.h"

#include <math.h>

static ritz_status find_largest(const ritz_modal *cluster,
                                const double *band_hz, double *out)
{
    RITZ_OWN_ARRAY double *sigma = NULL;

    RITZ_CHECK_NEW(sigma, 2 * cluster->count);
    RITZ_CHECK(ritz_modal_hankel(cluster, band_hz, sigma));
    *out = sigma[0];
    return RITZ_OK;
}

static ritz_status hankel_value(const ritz_rank_request *request,
                                const ritz_modal *cluster, double *out)
{
    (void)request;
    return find_largest(cluster, NULL, out);
}

static double approached_value(const double pair[static 2])
{
    return pair[0];
}

const ritz_ranker ritz_ranker_hankel = {
    .name = "hankel",
    .summary = "largest exact Hankel value of each mode (or cluster) alone",
    .reference = "Moore1981",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING,
    .exact = approached_value,
    .value = hankel_value,
};

/*
 * The largest Hankel value of a mode (or cluster) alone over a band: of the
 * Gramians
 *
 *     W_c = 1/pi Re int_{w1}^{w2} (i w - A)^-1 B B' (i w - A)^-* dw
 *
 * and W_o likewise, which contain only the response between w1 and w2. From 0
 * to infinity the value is that of `hankel`.
 *
 * [GawronskiJuang1990]
 */

static ritz_status band_value(const ritz_rank_request *request,
                              const ritz_modal *cluster, double *out)
{
    return find_largest(cluster, request->band_hz, out);
}

const ritz_ranker ritz_ranker_hankel_band = {
    .name = "hankel-band",
    .summary = "largest Hankel value of each mode alone within a band",
    .reference = "GawronskiJuang1990",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING |
             RITZ_RANK_BAND,
    .value = band_value,
};

/*
 * The H2 norm of a mode (or cluster) alone, sqrt(trace(C W_c C')), which for
 * one mode with a displacement output is
 *
 *     |b||c| / sqrt(4 zeta w^3)
 *
 * Squares of these add up to H2 squared of the whole only where modes do not
 * couple: modal-cost adds the terms that couple them.
 *
 * [Skelton1982]
 */

static ritz_status h2_value(const ritz_rank_request *request,
                            const ritz_modal *cluster, double *out)
{
    RITZ_OWN(ritz_dense) V = {0};
    double sum = 0.0;

    (void)request;
    RITZ_CHECK(ritz_modal_costs(cluster, &V));
    for (int64_t k = 0; k < V.nrow * V.ncol; k++)
        sum += V.val[k];
    *out = sqrt(fmax(sum, 0.0));
    return RITZ_OK;
}

const ritz_ranker ritz_ranker_h2 = {
    .name = "h2",
    .summary = "H2 norm of each mode (or cluster) alone",
    .reference = "Skelton1982",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING,
    .value = h2_value,
};
