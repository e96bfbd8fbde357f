/*
 * Modal costs: the share of each mode in the variance of all outputs, in their
 * limits, for white inputs of unit intensity,
 *
 *     |H|_2^2 = trace(C W_c C') = sum_k V_k,
 *     V_k = sum_i sum_{a of mode k} c_ia (W_c c_i')_a
 *
 * with the exact W_c, so that what modes share is in it, half for either. It
 * can be negative, of a mode that takes from the variance of another; modes are
 * then ordered by magnitude, since leaving that one out is as wrong. In the
 * limit of light damping, V_k = |b_k|^2 |c_k|^2 / (4 zeta w^3).
 *
 * [Skelton1982], [ZhuSkelton1992] eq. 1.1
 */
#include "ranking/costs.h"

#include <math.h>
#include <stdlib.h>

/* c_ia of state a = 2 k or 2 k + 1 of mode k. */
static double seen(const ritz_modal *modal, int64_t i, int64_t a)
{
    const ritz_dense *C = a % 2 == 0 ? &modal->C : &modal->Cv;

    return ritz_dense_col(C, a / 2)[i];
}

/* [c_i1 c_i2 ...]' of all outputs: 2m x p. */
static ritz_status transposed(const ritz_modal *modal, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(2 * modal->count, modal->C.nrow, out));
    for (int64_t i = 0; i < out->ncol; i++)
        for (int64_t a = 0; a < out->nrow; a++)
            ritz_dense_col(out, i)[a] = seen(modal, i, a);
    return RITZ_OK;
}

ritz_status ritz_modal_costs(const ritz_modal *modal, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense Wc = {0}, Wo = {0}, C = {0}, X = {0};
    ritz_dense V = {0};

    RITZ_TRY(ritz_modal_gramians(modal, &Wc, &Wo));
    RITZ_TRY(transposed(modal, &C));
    RITZ_TRY(ritz_dense_mul(&Wc, &C, &X));
    RITZ_TRY(ritz_dense_new(modal->count, modal->C.nrow, &V));
    for (int64_t i = 0; i < V.ncol; i++)
        for (int64_t a = 0; a < X.nrow; a++)
            ritz_dense_col(&V, i)[a / 2] +=
                ritz_dense_col(&C, i)[a] * ritz_dense_col(&X, i)[a];
    *out = V;
    V = (ritz_dense){0};
done:
    ritz_dense_free(&Wc);
    ritz_dense_free(&Wo);
    ritz_dense_free(&C);
    ritz_dense_free(&X);
    ritz_dense_free(&V);
    return status;
}

static ritz_status rank(const ritz_rank_request *request, ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    const ritz_modal *modal = &request->modal;
    ritz_dense V = {0};

    RITZ_TRY(ritz_modal_costs(modal, &V));
    RITZ_TRY(ritz_ranking_parts(V.ncol, ranking));
    ranking->total = 0.0;
    for (int64_t i = 0; i < V.ncol; i++) {
        ritz_ranking_name_part(request->output, "y", i, ranking->part[i]);
        ranking->whole[i] = 0.0;
        for (int64_t k = 0; k < modal->count; k++) {
            double v = ritz_dense_col(&V, i)[k];

            ritz_dense_col(&ranking->parts, i)[k] = v;
            ranking->whole[i] += v;
            ranking->value[k] += v;
        }
        ranking->total += ranking->whole[i];
    }
done:
    ritz_dense_free(&V);
    return status;
}

const ritz_ranker ritz_ranker_modal_cost = {
    .name = "modal-cost",
    .summary = "share of each mode in the variance of outputs: H2 squared",
    .reference = "Skelton1982",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING,
    .sums = true,
    .rank = rank,
};
