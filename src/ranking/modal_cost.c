/*
 * Modal costs: the part of each mode in the variance of all outputs, in their
 * limits, for white inputs of unit intensity,
 *
 *     |H|_2^2 = trace(C W_c C') = sum_k V_k,
 *     V_k = sum_i sum_{a of mode k} c_ia (W_c c_i')_a
 *
 * with the exact W_c, so that the term of two coupled modes is divided equally
 * between them. A cost is negative if the mode reduces the variance of others;
 * modes are ordered by magnitude, since leaving such a mode out is as wrong. In
 * the limit of light damping, V_k = |b_k|^2 |c_k|^2 / (4 zeta w^3).
 *
 * [Skelton1982], [ZhuSkelton1992] eq. 1.1
 */
#include "ranking/clusters.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/modes.h"
#include "linear/general.h"

#include <ritz/ranking.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/*
 * Modal costs of each output, m + 1 x p: row k is that of mode k, the last row
 * that of rigid motion coupled to modes by damping.
 */
static ritz_status find_costs(const ritz_modal *modal, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) Wc = {0}, Wo = {0}, C = {0}, X = {0}, V = {0};

    RITZ_CHECK(ritz_modal_gramians(modal, NULL, &Wc, &Wo));
    RITZ_CHECK(ritz_modal_outputs(modal, &C));
    RITZ_CHECK(ritz_dense_mul(&Wc, &C, &X));
    RITZ_CHECK(ritz_dense_new(modal->count + 1, modal->C.nrow, &V));
    for (int64_t i = 0; i < V.ncol; i++)
        for (int64_t a = 0; a < X.nrow; a++)
            ritz_dense_col(&V,
                           i)[a < 2 * modal->count ? a / 2 : modal->count] +=
                ritz_dense_col(&C, i)[a] * ritz_dense_col(&X, i)[a];
    RITZ_MOVE(*out, V);
    return RITZ_OK;
}

static ritz_status rank_modal_cost(const ritz_rank_request *request,
                                   ritz_ranking *ranking)
{
    const ritz_modal *modal = &request->modal;
    RITZ_OWN(ritz_dense) V = {0};

    RITZ_CHECK(find_costs(modal, &V));
    RITZ_CHECK(ritz_ranking_parts(V.ncol, ranking));
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
        ranking->whole[i] += ritz_dense_col(&V, i)[modal->count];
        ranking->total += ranking->whole[i];
    }
    if (modal->num_rigid > 0) /* a part of the total belongs to no mode */
        ranking->total = nan("");
    return RITZ_OK;
}

const ritz_ranker ritz_ranker_modal_cost = {
    .name = "modal-cost",
    .summary = "share of each mode in the variance of outputs: H2 squared",
    .reference = "Skelton1982",
    .needs = RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS | RITZ_RANK_DAMPING,
    .sums = true,
    .rank = rank_modal_cost,
};

/* Iteration between output weights and the choice of modes: see
   ritz_reweigh. */

enum { MOST_ROUNDS = 400, LONGEST = 12 };

/* What all rounds have in common, and the rounds. */
typedef struct loop {
    const ritz_modal *modal;
    int64_t m, p, keep;
    ritz_dense V; /* m + 1 x p, costs */
    double *Y;    /* p */
    double *value;
    int64_t *order, *cluster;
    ritz_dense q,
        d;       /* p x rounds, weights and the costs that a choice misses */
    bool *taken; /* m x rounds, the choice */
} loop;

static ritz_status create_loop(const ritz_rank_request *request, int64_t keep,
                               loop *l)
{
    l->modal = &request->modal;
    l->m = l->modal->count;
    l->p = l->modal->C.nrow;
    l->keep = keep;
    RITZ_CHECK(find_costs(l->modal, &l->V));
    RITZ_CHECK_NEW(l->Y, l->p);
    RITZ_CHECK_NEW(l->value, l->m);
    RITZ_CHECK_NEW(l->order, l->m);
    RITZ_CHECK_NEW(l->cluster, l->m);
    RITZ_CHECK_NEW(l->taken, l->m * MOST_ROUNDS);
    RITZ_CHECK(ritz_dense_new(l->p, MOST_ROUNDS, &l->q));
    RITZ_CHECK(ritz_dense_new(l->p, MOST_ROUNDS, &l->d));
    for (int64_t i = 0; i < l->p; i++) {
        l->q.val[i] = 1.0;
        for (int64_t k = 0; k < l->V.nrow; k++)
            l->Y[i] += ritz_dense_col(&l->V, i)[k];
    }
    ritz_ranking_clusters(l->modal, l->cluster);
    return RITZ_OK;
}

static void loop_free(loop *l)
{
    ritz_dense_free(&l->V);
    RITZ_FREE(l->Y, l->value, l->order, l->cluster);
    ritz_dense_free(&l->q);
    ritz_dense_free(&l->d);
    free(l->taken);
}

/* Choose the modes of largest cost, clusters whole. */
static ritz_status choose_modes(loop *l, int64_t round)
{
    const double *q = ritz_dense_col(&l->q, round);

    for (int64_t k = 0; k < l->m; k++) {
        l->value[k] = 0.0;
        for (int64_t i = 0; i < l->p; i++)
            l->value[k] += q[i] * ritz_dense_col(&l->V, i)[k];
    }
    ritz_ranking_share(l->m, l->cluster, l->value);
    RITZ_CHECK(ritz_ranking_sort(l->m, l->value, l->order));
    for (int64_t n = 0; n < l->m; n++) {
        bool rest =
            n > 0 && l->cluster[l->order[n]] == l->cluster[l->order[n - 1]];

        if (n >= l->keep && !rest)
            break;
        l->taken[round * l->m + l->order[n]] = true;
    }
    return RITZ_OK;
}

/* d_i = |Y_i - Y_i(kept alone)|. */
static ritz_status measure_misses(loop *l, int64_t round)
{
    RITZ_OWN(ritz_modal) kept = {0};
    RITZ_OWN(ritz_dense) V = {0};

    RITZ_CHECK(ritz_modal_part(l->modal, l->taken + round * l->m, NULL, &kept));
    RITZ_CHECK(find_costs(&kept, &V));
    for (int64_t i = 0; i < l->p; i++) {
        double alone = 0.0;

        for (int64_t k = 0; k < V.nrow; k++)
            alone += ritz_dense_col(&V, i)[k];
        ritz_dense_col(&l->d, round)[i] = fabs(l->Y[i] - alone);
    }
    return RITZ_OK;
}

/* q := (1 - a) p d / sum d + a q; without misses the weights stay. */
static void update_weights(loop *l, int64_t round)
{
    const double *q = ritz_dense_col(&l->q, round);
    const double *d = ritz_dense_col(&l->d, round);
    double sum = 0.0;

    for (int64_t i = 0; i < l->p; i++)
        sum += d[i];
    for (int64_t i = 0; i < l->p; i++)
        ritz_dense_col(&l->q, round + 1)[i] =
            sum > 0.0 ? RITZ_OLD_WEIGHT * q[i] +
                            (1.0 - RITZ_OLD_WEIGHT) * (double)l->p * d[i] / sum
                      : q[i];
}

static bool is_same(const loop *l, int64_t a, int64_t b)
{
    for (int64_t i = 0; i < l->p; i++)
        if (!(fabs(ritz_dense_col(&l->q, a)[i] - ritz_dense_col(&l->q, b)[i]) <=
              RITZ_SAME))
            return false;
    return memcmp(l->taken + a * l->m, l->taken + b * l->m,
                  (size_t)l->m * sizeof *l->taken) == 0;
}

/* The number of rounds after which the last one recurs; 0 if it has not yet. */
static int64_t find_period(const loop *l, int64_t round)
{
    for (int64_t k = 1; k <= LONGEST && k <= round; k++)
        if (is_same(l, round, round - k))
            return k;
    return 0;
}

/* The round of a period, or of the last few, with the smallest miss. */
static int64_t find_best(const loop *l, int64_t round, int64_t period)
{
    int64_t count = period > 0 ? period : LONGEST;
    int64_t best = round;

    for (int64_t k = 1; k < count && k <= round; k++)
        if (ritz_dense_col_max(&l->d, round - k) <
            ritz_dense_col_max(&l->d, best))
            best = round - k;
    return best;
}

static ritz_status report_rounds(const loop *l, int64_t round, int64_t period,
                                 ritz_reweighing *out)
{
    int64_t best = find_best(l, round, period);

    out->num_outputs = l->p;
    out->rounds = round + 1;
    out->period = period;
    RITZ_CHECK_COPY(out->weight, ritz_dense_col(&l->q, best), l->p);
    RITZ_CHECK_COPY(out->cost, l->Y, l->p);
    RITZ_CHECK_COPY(out->missed, ritz_dense_col(&l->d, best), l->p);
    RITZ_CHECK_NEW(out->kept, l->m);
    RITZ_CHECK_NEW(out->other, l->m);
    for (int64_t k = 0; k < l->m; k++) {
        bool any = false;

        for (int64_t r = 0; r < period; r++)
            any = any || l->taken[(round - r) * l->m + k];
        if (l->taken[best * l->m + k])
            out->kept[out->num_kept++] = k;
        else if (any)
            out->other[out->num_other++] = k;
    }
    return RITZ_OK;
}

ritz_status ritz_reweigh(const ritz_rank_request *request, int64_t keep,
                         ritz_reweighing *out)
{
    RITZ_OWN(ritz_reweighing) found = {0};
    int64_t round = 0, period = 0;
    RITZ_OWN(loop) l = {0};

    RITZ_REFUSE_IF(request->modal.B.ncol == 0 || request->modal.C.nrow == 0,
                   RITZ_ERR_ARGUMENT,
                   "there are no inputs and outputs to weigh modes by");
    RITZ_REFUSE_IF(keep < 1 || keep >= request->modal.count, RITZ_ERR_ARGUMENT,
                   "weights choose at least one mode and leave one out, of %d",
                   (int)request->modal.count);
    RITZ_CHECK(create_loop(request, keep, &l));
    for (;; round++) {
        RITZ_CHECK(choose_modes(&l, round));
        RITZ_CHECK(measure_misses(&l, round));
        period = find_period(&l, round);
        if (period > 0 || round + 1 == MOST_ROUNDS)
            break;
        update_weights(&l, round);
    }
    RITZ_CHECK(report_rounds(&l, round, period, &found));
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

void ritz_reweighing_free(ritz_reweighing *reweighing)
{
    RITZ_FREE(reweighing->weight, reweighing->cost, reweighing->missed,
              reweighing->kept, reweighing->other);
    *reweighing = (ritz_reweighing){0};
}

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
static ritz_status h2_value(const double *band_hz, const ritz_modal *cluster,
                            double *out)
{
    RITZ_OWN(ritz_dense) V = {0};
    double sum = 0.0;

    (void)band_hz;
    RITZ_CHECK(find_costs(cluster, &V));
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
    .joins = true,
    .value = h2_value,
};
