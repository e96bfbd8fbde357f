/*
 * A ranking by any of the rankers, with coupling and the values of the whole
 * model.
 */
#include "ranking/costs.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/modal.h"
#include "gramians/modes.h"

#include <ritz/ranking.h>

#include <math.h>
#include <stdio.h>

const ritz_ranker *ritz_ranker_find(const char *name)
{
    return ritz_row_find(ritz_rankers, "ranking", name);
}

/* Find the largest entry of a Gramian relative to the diagonal entries. */
static void find_coupling(const ritz_dense *W, ritz_ranking *ranking)
{
    const int64_t *cluster = ranking->cluster;
    double largest[2] = {0.0, 0.0};

    for (int64_t a = 0; a < W->nrow; a++)
        largest[a % 2] = fmax(largest[a % 2], ritz_dense_col(W, a)[a]);
    for (int64_t b = 0; b < W->nrow; b++)
        for (int64_t a = 0; a < b; a++) {
            double wa = ritz_dense_col(W, a)[a];
            double wb = ritz_dense_col(W, b)[b];
            double off = fabs(ritz_dense_col(W, b)[a]) / sqrt(wa * wb);

            if (cluster[a / 2] == cluster[b / 2] ||
                !(wa > RITZ_NEGLIGIBLE_GRAMIAN * largest[a % 2]) ||
                !(wb > RITZ_NEGLIGIBLE_GRAMIAN * largest[b % 2]) ||
                !(off > ranking->coupling))
                continue;
            ranking->coupling = off;
            ranking->coupled[0] = a / 2;
            ranking->coupled[1] = b / 2;
        }
}

static ritz_status create_ranking(const ritz_ranker *ranker,
                                  const ritz_rank_request *request,
                                  ritz_ranking *out)
{
    const ritz_modal *modal = &request->modal;

    RITZ_CHECK(ritz_ranking_new(modal->count, out));
    (void)snprintf(out->by, RITZ_NAME_SIZE, "%s", ranker->name);
    (void)snprintf(out->reference, RITZ_NAME_SIZE, "%s", ranker->reference);
    for (int64_t k = 0; k < out->count; k++) {
        out->hertz[k] = modal->omega[k] / (2.0 * RITZ_PI);
        out->zeta[k] = request->undamped ? 0.0 : modal->zeta[k];
    }
    ritz_ranking_clusters(modal, out->cluster);
    return RITZ_OK;
}

/* The value of each cluster of modes, as a model of its own, is that of all its
   modes. */
static ritz_status rank_clusters(const ritz_ranker *ranker,
                                 const ritz_rank_request *request,
                                 ritz_ranking *ranking)
{
    int64_t last = 0;

    for (int64_t first = 0; first < ranking->count; first = last) {
        RITZ_OWN(ritz_modal) cluster = {0};

        last = ritz_cluster_end(ranking->count, ranking->cluster, first);
        RITZ_CHECK(
            ritz_modal_part(&request->modal, first, last, NULL, &cluster));
        RITZ_CHECK(ranker->value(request, &cluster, &ranking->value[first]));
        for (int64_t k = first + 1; k < last; k++)
            ranking->value[k] = ranking->value[first];
    }
    return RITZ_OK;
}

/* Check that the request has what a ranker needs; each need has its message. */
static ritz_status check_needs(const ritz_ranker *ranker,
                               const ritz_rank_request *r)
{
    const struct {
        int need;
        bool there;
        const char *sentence;
    } wants[] = {
        {RITZ_RANK_INPUTS, r->modal.B.ncol > 0,
         "a ranking needs at least one input and one output, there is no "
         "input"},
        {RITZ_RANK_OUTPUTS, r->modal.C.nrow > 0,
         "a ranking needs at least one input and one output, there is no "
         "output"},
        {RITZ_RANK_DAMPING, !r->undamped,
         "the modes have no damping, which this ranking needs of every one"},
        {RITZ_RANK_BAND, r->band_hz[0] >= 0.0 && r->band_hz[1] > r->band_hz[0],
         "there is no band to rank modes within"},
        {RITZ_RANK_MOMENTUM, r->momentum.val,
         "the model does not know its mass in rigid motion: its grids have no "
         "positions, or it has too many columns"},
        {RITZ_RANK_INTERFACE, r->interface.ncol > 0,
         "these are not modes of an interface that is held"},
    };

    for (size_t k = 0; k < sizeof wants / sizeof *wants; k++)
        RITZ_REFUSE_IF((ranker->needs & wants[k].need) && !wants[k].there,
                       RITZ_ERR_ARGUMENT, "%s", wants[k].sentence);
    return RITZ_OK;
}

/*
 * The exact values of the whole model, if it has inputs and outputs, and the
 * largest normalised off-diagonal |W_ab| / sqrt(W_aa W_bb) of both exact
 * Gramians, except within clusters, which are ranked whole.
 */
static ritz_status add_whole_values(const ritz_rank_request *request,
                                    ritz_ranking *ranking)
{
    const ritz_modal *modal = &request->modal;
    RITZ_OWN(ritz_dense) Wc = {0}, Wo = {0};

    if (request->bare || request->undamped || modal->B.ncol == 0 ||
        modal->C.nrow == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_modal_hankel(modal, NULL, ranking->system_value));
    ranking->num_system = 2 * modal->count;
    RITZ_CHECK(ritz_modal_gramians(modal, NULL, &Wc, &Wo));
    ranking->coupling = 0.0;
    find_coupling(&Wc, ranking);
    find_coupling(&Wo, ranking);
    return RITZ_OK;
}

/* One value for each cluster; a sum is divided equally among its modes. */
static void share_clusters(const ritz_ranker *ranker, ritz_ranking *ranking)
{
    if (ranker->sums)
        ritz_ranking_share(ranking->count, ranking->cluster, ranking->value);
    for (int64_t j = 0; j < ranking->num_parts; j++)
        ritz_ranking_share(ranking->count, ranking->cluster,
                           ritz_dense_col(&ranking->parts, j));
}

ritz_status ritz_rank(const ritz_ranker *ranker,
                      const ritz_rank_request *request, ritz_ranking *out)
{
    RITZ_OWN(ritz_ranking) ranking = {0};

    RITZ_CHECK_IN(ranker->name, check_needs(ranker, request));
    RITZ_CHECK(create_ranking(ranker, request, &ranking));
    RITZ_CHECK_IN(ranker->name, ranker->value
                                    ? rank_clusters(ranker, request, &ranking)
                                    : ranker->rank(request, &ranking));
    share_clusters(ranker, &ranking);
    RITZ_CHECK(ritz_ranking_sort(ranking.count, ranking.value, ranking.order));
    RITZ_CHECK(add_whole_values(request, &ranking));
    RITZ_MOVE(*out, ranking);
    return RITZ_OK;
}
