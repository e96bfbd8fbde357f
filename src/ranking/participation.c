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

/* Rows first .. last - 1 of B, and their largest singular value. */
static ritz_status largest_singular(const ritz_dense *B, int64_t first,
                                    int64_t last, double *out)
{
    int64_t n = last - first;
    RITZ_OWN(ritz_dense) A = {0};

    RITZ_CHECK(ritz_dense_new(n, B->ncol, &A));
    for (int64_t j = 0; j < B->ncol; j++)
        for (int64_t k = 0; k < n; k++)
            ritz_dense_col(&A, j)[k] = ritz_dense_col(B, j)[first + k];
    return ritz_general_norm(&A, out);
}

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
    int64_t m = request->modal.count;
    int64_t last = 0;

    RITZ_CHECK(ritz_ranking_parts(B->ncol, ranking));
    ritz_ranking_clusters(&request->modal, ranking->cluster);
    for (int64_t j = 0; j < B->ncol; j++) {
        ritz_ranking_name_part(request->input, "u", j, ranking->part[j]);
        ranking->whole[j] = nan("");
    }
    for (int64_t first = 0; first < m; first = last) {
        for (last = first + 1; last < m && ranking->cluster[last] == first;)
            last++;
        RITZ_CHECK(largest_singular(B, first, last, &ranking->value[first]));
        for (int64_t k = first + 1; k < last; k++)
            ranking->value[k] = ranking->value[first];
        fill_parts(B, first, last, &ranking->parts);
    }
    return RITZ_OK;
}

const ritz_ranker ritz_ranker_participation = {
    .name = "participation",
    .summary = "how hard inputs drive each mode (or cluster)",
    .reference = "Girard2008",
    .needs = RITZ_RANK_INPUTS,
    .rank = rank_participation,
};
