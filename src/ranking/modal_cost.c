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
#include "ranking/costs.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/cluster.h"

#include <ritz/ranking.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* c_ia of state a = 2 k or 2 k + 1 of mode k. */
static double output_entry(const ritz_modal *modal, int64_t i, int64_t a)
{
    const ritz_dense *C = a % 2 == 0 ? &modal->C : &modal->Cv;

    return ritz_dense_col(C, a / 2)[i];
}

/* [c_i1 c_i2 ...]' of all outputs: 2m x p. */
static ritz_status transpose_outputs(const ritz_modal *modal, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(2 * modal->count, modal->C.nrow, out));
    for (int64_t i = 0; i < out->ncol; i++)
        for (int64_t a = 0; a < out->nrow; a++)
            ritz_dense_col(out, i)[a] = output_entry(modal, i, a);
    return RITZ_OK;
}

ritz_status ritz_modal_costs(const ritz_modal *modal, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) Wc = {0}, Wo = {0}, C = {0}, X = {0};
    RITZ_OWN(ritz_dense) V = {0};

    RITZ_CHECK(ritz_modal_gramians(modal, &Wc, &Wo));
    RITZ_CHECK(transpose_outputs(modal, &C));
    RITZ_CHECK(ritz_dense_mul(&Wc, &C, &X));
    RITZ_CHECK(ritz_dense_new(modal->count, modal->C.nrow, &V));
    for (int64_t i = 0; i < V.ncol; i++)
        for (int64_t a = 0; a < X.nrow; a++)
            ritz_dense_col(&V, i)[a / 2] +=
                ritz_dense_col(&C, i)[a] * ritz_dense_col(&X, i)[a];
    RITZ_MOVE(*out, V);
    return RITZ_OK;
}

static ritz_status rank_modal_cost(const ritz_rank_request *request,
                                   ritz_ranking *ranking)
{
    const ritz_modal *modal = &request->modal;
    RITZ_OWN(ritz_dense) V = {0};

    RITZ_CHECK(ritz_modal_costs(modal, &V));
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
        ranking->total += ranking->whole[i];
    }
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

/*
 * Iteration between output weights and the choice of modes:
 * include/ritz/reweigh.h.
 */

enum { MOST_ROUNDS = 400, LONGEST = 12 };

/* The choice of one round. */
typedef struct weighting_trial {
    bool *taken; /* m */
    double *q;   /* p, weights of this round */
    double *d;   /* p, cost that its choice misses */
} weighting_trial;

/* What all rounds have in common, and the last few rounds. */
typedef struct loop {
    const ritz_modal *modal;
    int64_t m, p, keep;
    ritz_dense V; /* m x p, costs */
    double *Y;    /* p */
    double *value;
    int64_t *order, *cluster;
    weighting_trial past[LONGEST + 1]; /* round r is past[r % (LONGEST + 1)] */
} loop;

static weighting_trial *find_round(loop *l, int64_t r)
{
    return &l->past[r % (LONGEST + 1)];
}

static ritz_status create_loop(const ritz_rank_request *request, int64_t keep,
                               loop *l)
{
    l->modal = &request->modal;
    l->m = l->modal->count;
    l->p = l->modal->C.nrow;
    l->keep = keep;
    RITZ_CHECK(ritz_modal_costs(l->modal, &l->V));
    RITZ_CHECK_NEW(l->Y, l->p);
    RITZ_CHECK_NEW(l->value, l->m);
    RITZ_CHECK_NEW(l->order, l->m);
    RITZ_CHECK_NEW(l->cluster, l->m);
    for (int k = 0; k <= LONGEST; k++) {
        RITZ_CHECK_NEW(l->past[k].taken, l->m);
        RITZ_CHECK_NEW(l->past[k].q, l->p);
        RITZ_CHECK_NEW(l->past[k].d, l->p);
    }
    for (int64_t i = 0; i < l->p; i++)
        for (int64_t k = 0; k < l->m; k++)
            l->Y[i] += ritz_dense_col(&l->V, i)[k];
    ritz_ranking_clusters(l->modal, l->cluster);
    return RITZ_OK;
}

static void loop_free(loop *l)
{
    ritz_dense_free(&l->V);
    free(l->Y);
    free(l->value);
    free(l->order);
    free(l->cluster);
    for (int k = 0; k <= LONGEST; k++) {
        free(l->past[k].taken);
        free(l->past[k].q);
        free(l->past[k].d);
    }
}

/* Choose the modes of largest cost, clusters whole. */
static ritz_status choose_modes(loop *l, weighting_trial *t)
{
    int64_t n = 0;

    for (int64_t k = 0; k < l->m; k++) {
        l->value[k] = 0.0;
        t->taken[k] = false;
        for (int64_t i = 0; i < l->p; i++)
            l->value[k] += t->q[i] * ritz_dense_col(&l->V, i)[k];
    }
    ritz_ranking_share(l->modal, l->value);
    RITZ_CHECK(ritz_ranking_sort(l->m, l->value, l->order));
    for (; n < l->m; n++) {
        bool rest =
            n > 0 && l->cluster[l->order[n]] == l->cluster[l->order[n - 1]];

        if (n >= l->keep && !rest)
            break;
        t->taken[l->order[n]] = true;
    }
    return RITZ_OK;
}

/* The chosen modes as a model of their own. */
static ritz_status extract_modes(const ritz_modal *modal, const bool *taken,
                                 ritz_modal *out)
{
    RITZ_OWN(ritz_modal) part = {0};
    RITZ_OWN_ARRAY int64_t *mode = NULL;
    int64_t n = 0;

    RITZ_CHECK_NEW(mode, modal->count);
    for (int64_t k = 0; k < modal->count; k++)
        if (taken[k])
            mode[n++] = k;
    part.count = n;
    RITZ_CHECK_NEW(part.omega, n);
    RITZ_CHECK_NEW(part.zeta, n);
    RITZ_CHECK(ritz_dense_rows(&modal->B, n, mode, &part.B));
    RITZ_CHECK(ritz_dense_new(modal->C.nrow, n, &part.C));
    RITZ_CHECK(ritz_dense_new(modal->C.nrow, n, &part.Cv));
    for (int64_t k = 0; k < n; k++) {
        size_t size = (size_t)modal->C.nrow * sizeof(double);

        part.omega[k] = modal->omega[mode[k]];
        part.zeta[k] = modal->zeta[mode[k]];
        memcpy(ritz_dense_col(&part.C, k), ritz_dense_col(&modal->C, mode[k]),
               size);
        memcpy(ritz_dense_col(&part.Cv, k), ritz_dense_col(&modal->Cv, mode[k]),
               size);
    }
    RITZ_MOVE(*out, part);
    return RITZ_OK;
}

/* d_i = |Y_i - Y_i(kept alone)|. */
static ritz_status measure_misses(const loop *l, weighting_trial *t)
{
    RITZ_OWN(ritz_modal) kept = {0};
    RITZ_OWN(ritz_dense) V = {0};

    RITZ_CHECK(extract_modes(l->modal, t->taken, &kept));
    RITZ_CHECK(ritz_modal_costs(&kept, &V));
    for (int64_t i = 0; i < l->p; i++) {
        double alone = 0.0;

        for (int64_t k = 0; k < V.nrow; k++)
            alone += ritz_dense_col(&V, i)[k];
        t->d[i] = fabs(l->Y[i] - alone);
    }
    return RITZ_OK;
}

/* q := (1 - a) p d / sum d + a q; without misses the weights stay. */
static void update_weights(const loop *l, const weighting_trial *t, double *q)
{
    double sum = 0.0;

    for (int64_t i = 0; i < l->p; i++)
        sum += t->d[i];
    for (int64_t i = 0; i < l->p; i++)
        q[i] = sum > 0.0
                   ? RITZ_OLD_WEIGHT * t->q[i] +
                         (1.0 - RITZ_OLD_WEIGHT) * (double)l->p * t->d[i] / sum
                   : t->q[i];
}

static bool is_same(const loop *l, const weighting_trial *a,
                    const weighting_trial *b)
{
    for (int64_t i = 0; i < l->p; i++)
        if (!(fabs(a->q[i] - b->q[i]) <= RITZ_SAME))
            return false;
    return memcmp(a->taken, b->taken, (size_t)l->m * sizeof *a->taken) == 0;
}

/* The number of rounds after which the last one recurs; 0 if it has not yet. */
static int64_t find_period(loop *l, int64_t round)
{
    for (int64_t k = 1; k <= LONGEST && k <= round; k++)
        if (is_same(l, find_round(l, round), find_round(l, round - k)))
            return k;
    return 0;
}

static double worst_miss(const loop *l, const weighting_trial *t)
{
    double largest = 0.0;

    for (int64_t i = 0; i < l->p; i++)
        largest = fmax(largest, t->d[i]);
    return largest;
}

/* The round of a period, or of those remembered, with the smallest miss. */
static const weighting_trial *find_best(loop *l, int64_t round, int64_t period)
{
    int64_t count = period > 0 ? period : LONGEST;
    const weighting_trial *best = find_round(l, round);

    for (int64_t k = 1; k < count && k <= round; k++) {
        const weighting_trial *t = find_round(l, round - k);

        if (worst_miss(l, t) < worst_miss(l, best))
            best = t;
    }
    return best;
}

/* List the modes that some round of the period keeps and the best does not. */
static void list_others(loop *l, int64_t round, const weighting_trial *best,
                        ritz_reweighing *out)
{
    for (int64_t k = 0; k < l->m; k++)
        for (int64_t r = 0; r < out->period; r++)
            if (find_round(l, round - r)->taken[k] && !best->taken[k]) {
                out->other[out->num_other++] = k;
                break;
            }
}

static ritz_status report_rounds(loop *l, int64_t round, int64_t period,
                                 ritz_reweighing *out)
{
    const weighting_trial *best = find_best(l, round, period);
    size_t size = (size_t)l->p * sizeof(double);

    out->num_outputs = l->p;
    out->rounds = round + 1;
    out->period = period;
    RITZ_CHECK_NEW(out->weight, l->p);
    RITZ_CHECK_NEW(out->cost, l->p);
    RITZ_CHECK_NEW(out->missed, l->p);
    RITZ_CHECK_NEW(out->kept, l->m);
    RITZ_CHECK_NEW(out->other, l->m);
    memcpy(out->weight, best->q, size);
    memcpy(out->cost, l->Y, size);
    memcpy(out->missed, best->d, size);
    for (int64_t k = 0; k < l->m; k++)
        if (best->taken[k])
            out->kept[out->num_kept++] = k;
    list_others(l, round, best, out);
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
    for (int64_t i = 0; i < l.p; i++)
        find_round(&l, 0)->q[i] = 1.0;
    while (true) {
        weighting_trial *t = find_round(&l, round);

        RITZ_CHECK(choose_modes(&l, t));
        RITZ_CHECK(measure_misses(&l, t));
        period = find_period(&l, round);
        if (period > 0 || round + 1 == MOST_ROUNDS)
            break;
        round++;
        update_weights(&l, t, find_round(&l, round)->q);
    }
    RITZ_CHECK(report_rounds(&l, round, period, &found));
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

void ritz_reweighing_free(ritz_reweighing *reweighing)
{
    free(reweighing->weight);
    free(reweighing->cost);
    free(reweighing->missed);
    free(reweighing->kept);
    free(reweighing->other);
    *reweighing = (ritz_reweighing){0};
}
