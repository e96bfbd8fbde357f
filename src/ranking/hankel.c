/*
 * Rankings by Hankel values of a mode (or cluster) alone: exact, within a band,
 * and in the limit of light damping.
 */
#include "base/alloc.h"
#include "gramians/modes.h"
#include "linear/general.h"

#include <ritz/ranking.h>

#include <math.h>

/*
 * The largest exact Hankel value of a mode, or a cluster of modes, by itself.
 * For one mode with a displacement output it is
 *
 *     sigma = |b||c| / (4 zeta w^2) (sqrt(1 + zeta^2) + zeta)
 *
 * and for a cluster, of modes of one frequency or coupled by damping, that of
 * the model that consists of these modes and the damping between them.
 *
 * [Moore1981], [McDaniel2000] eq. 3.2.19 to 3.2.21
 */
static ritz_status hankel_value(const double *band_hz,
                                const ritz_modal *cluster, double *out)
{
    RITZ_OWN_ARRAY double *sigma = NULL;

    RITZ_CHECK_NEW(sigma, ritz_modal_order(cluster));
    RITZ_CHECK(ritz_modal_hankel(cluster, band_hz, sigma));
    *out = sigma[0];
    return RITZ_OK;
}

static double larger_value(const double pair[static 2])
{
    return pair[0];
}

const ritz_ranker ritz_ranker_hankel = {
    .name = "hankel",
    .summary = "largest exact Hankel value of each mode (or cluster) alone",
    .reference = "Moore1981",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING,
    .exact = larger_value,
    .joins = true,
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
const ritz_ranker ritz_ranker_hankel_band = {
    .name = "hankel-band",
    .summary = "largest Hankel value of each mode alone within a band",
    .reference = "GawronskiJuang1990",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING |
             RITZ_RANK_BAND,
    .joins = true,
    .value = hankel_value,
};

/*
 * Hankel values in the limit of light damping and separate frequencies
 *
 *     sigma = sqrt(b b' (w^-2 c_d' c_d + c_v' c_v)) / (4 zeta w)
 *
 * with b a row, c_d and c_v columns. A cluster of modes at one frequency is
 * ranked as a whole, so that the value does not depend on which vectors span
 * it:
 *
 *     sigma = | [C_d/w; C_v] B |_2 / (4 zeta w),
 *
 * which is the same for a single mode. In this limit, damping that couples
 * modes of different frequencies has an effect of second order, so zeta comes
 * from the diagonal of the damping matrix.
 *
 * [Gregory1984], [McDaniel2000] eq. 3.2.22
 */

/* B / sqrt(4 zeta w) and [C_d / w; C_v] / sqrt(4 zeta w) of some modes. */
static void scale_modes(const ritz_modal *modal, ritz_dense *B, ritz_dense *C)
{
    int64_t p = modal->C.nrow;

    for (int64_t k = 0; k < modal->count; k++) {
        double w = modal->omega[k];
        double s = 1.0 / sqrt(4.0 * modal->zeta[k] * w);
        const double *cd = ritz_dense_col(&modal->C, k);
        const double *cv = ritz_dense_col(&modal->Cv, k);
        double *c = ritz_dense_col(C, k);

        for (int64_t j = 0; j < B->ncol; j++)
            ritz_dense_col(B, j)[k] = s * ritz_dense_col(&modal->B, j)[k];
        for (int64_t i = 0; i < p; i++) {
            c[i] = s * cd[i] / w;
            c[p + i] = s * cv[i];
        }
    }
}

static ritz_status gregory_value(const double *band_hz,
                                 const ritz_modal *cluster, double *out)
{
    RITZ_OWN(ritz_dense) B = {0};
    RITZ_OWN(ritz_dense) C = {0};
    RITZ_OWN(ritz_dense) CB = {0};

    (void)band_hz;
    for (int64_t k = 0; k < cluster->count; k++)
        if (!(cluster->zeta[k] > 0.0))
            return ritz_refuse_undamped(cluster->omega[k], cluster->zeta[k]);
    RITZ_CHECK(ritz_dense_new(cluster->B.nrow, cluster->B.ncol, &B));
    RITZ_CHECK(ritz_dense_new(2 * cluster->C.nrow, cluster->C.ncol, &C));
    scale_modes(cluster, &B, &C);
    RITZ_CHECK(ritz_dense_mul(&C, &B, &CB));
    return ritz_general_norm(&CB, out);
}

/*
 * The two exact values of one mode, sigma (sqrt(1 + zeta^2) +- zeta), have the
 * product sigma^2.
 */
static double geometric_mean(const double pair[static 2])
{
    return sqrt(pair[0]) * sqrt(pair[1]);
}

const ritz_ranker ritz_ranker_gregory = {
    .name = "gregory",
    .summary = "Hankel values in the limit of light damping, mode by mode",
    .reference = "Gregory1984",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING,
    .exact = geometric_mean,
    .value = gregory_value,
};
