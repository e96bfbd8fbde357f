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
 * which is the same for a single mode.
 *
 * [Gregory1984], [McDaniel2000] eq. 3.2.22
 */
#include "linear/general.h"
#include "ranking/costs.h"

#include <math.h>

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

static ritz_status gregory_value(const ritz_rank_request *request,
                                 const ritz_modal *cluster, double *out)
{
    RITZ_OWN(ritz_dense) B = {0};
    RITZ_OWN(ritz_dense) C = {0};
    RITZ_OWN(ritz_dense) CB = {0};

    (void)request;
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
static double approached_value(const double pair[static 2])
{
    return sqrt(pair[0]) * sqrt(pair[1]);
}

const ritz_ranker ritz_ranker_gregory = {
    .name = "gregory",
    .summary = "Hankel values in the limit of light damping, mode by mode",
    .reference = "Gregory1984",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING,
    .exact = approached_value,
    .value = gregory_value,
};
