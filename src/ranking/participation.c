/*
 * Modal participation: how strongly inputs excite a mode. With mass-normalised
 * modes
 *
 *     q_k'' + 2 zeta w q_k' + w^2 q_k = b_k u
 *
 * b_kj is the factor of mode k from input j, and the value |b_k|_2. For a
 * cluster, whose modes are an arbitrary basis of one space, it is the largest
 * singular value of its rows, and the part of an input is their norm.
 *
 * [Girard2008]
 */
#include "linear/general.h"
#include "ranking/costs.h"

#include <math.h>

static void fill_parts(const ritz_dense *B, int64_t first, int64_t last,
                       ritz_dense *parts)
{
    for (int64_t j = 0; j < B->ncol; j++) {
        const double *b = ritz_dense_col(B, j);
        double norm = 0.0;

        for (int64_t k = first; k < last; k++)
            norm = hypot(norm, b[k]);
        for (int64_t k = first; k < last; k++)
            ritz_dense_col(parts, j)[k] = norm;
    }
}

static ritz_status rank_participation(const ritz_rank_request *request,
                                      ritz_ranking *ranking)
{
    const ritz_dense *B = &request->modal.B;
    int64_t last = 0;

    RITZ_CHECK(ritz_ranking_parts(B->ncol, ranking));
    for (int64_t j = 0; j < B->ncol; j++) {
        ritz_ranking_name_part(request->input, "u", j, ranking->part[j]);
        ranking->whole[j] = nan("");
    }
    for (int64_t first = 0; first < ranking->count; first = last) {
        RITZ_OWN(ritz_dense) rows = {0};

        last = ritz_cluster_end(ranking->count, ranking->cluster, first);
        RITZ_CHECK(ritz_dense_block(B, first, last - first, 0, B->ncol, &rows));
        RITZ_CHECK(ritz_general_norm(&rows, &ranking->value[first]));
        for (int64_t k = first + 1; k < last; k++)
            ranking->value[k] = ranking->value[first];
        fill_parts(B, first, last, &ranking->parts);
    }
    return RITZ_OK;
}

const ritz_ranker ritz_ranker_participation = {
    .name = "participation",
    .summary = "how strongly inputs excite each mode (or cluster)",
    .reference = "Girard2008",
    .needs = RITZ_RANK_INPUTS,
    .rank = rank_participation,
};
