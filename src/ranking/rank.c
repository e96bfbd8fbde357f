/*
 * A ranking by any of the rankers, with coupling and the values of the whole
 * model.
 */
#include "ranking/costs.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/modes.h"

#include <ritz/ranking.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Order of modes by magnitude of value, and the values of clusters. */

/* A value and its mode, to be sorted. */
typedef struct ranked_place {
    double size;
    int64_t mode;
} ranked_place;

/* Larger values first, of equal ones the lower frequency. */
static int compare_values(const void *left, const void *right)
{
    const ranked_place *a = left;
    const ranked_place *b = right;

    if (a->size != b->size)
        return a->size > b->size ? -1 : 1;
    return (a->mode > b->mode) - (a->mode < b->mode);
}

ritz_status ritz_ranking_sort(int64_t count, const double *value,
                              int64_t *order)
{
    RITZ_OWN_ARRAY ranked_place *all = NULL;

    RITZ_CHECK_NEW(all, count);
    for (int64_t k = 0; k < count; k++)
        all[k] = (ranked_place){fabs(value[k]), k};
    qsort(all, (size_t)count, sizeof *all, compare_values);
    for (int64_t k = 0; k < count; k++)
        order[k] = all[k].mode;
    return RITZ_OK;
}

void ritz_ranking_clusters(const ritz_modal *modal, int64_t *cluster)
{
    int64_t last = 0;

    for (int64_t first = 0; first < modal->count; first = last) {
        last = ritz_modal_cluster(modal, first);
        for (int64_t k = first; k < last; k++)
            cluster[k] = first;
    }
}

int64_t ritz_cluster_end(int64_t count, const int64_t *cluster, int64_t first)
{
    int64_t last = first + 1;

    while (last < count && cluster[last] == first)
        last++;
    return last;
}

ritz_status ritz_ranking_new(int64_t count, ritz_ranking *out)
{
    RITZ_OWN(ritz_ranking)
    ranking = {.count = count, .total = nan(""), .coupling = nan("")};

    RITZ_CHECK_NEW(ranking.hertz, count);
    RITZ_CHECK_NEW(ranking.zeta, count);
    RITZ_CHECK_NEW(ranking.value, count);
    RITZ_CHECK_NEW(ranking.order, count);
    RITZ_CHECK_NEW(ranking.cluster, count);
    RITZ_CHECK_NEW(ranking.system_value, 2 * count);
    RITZ_MOVE(*out, ranking);
    return RITZ_OK;
}

void ritz_ranking_share(int64_t count, const int64_t *cluster, double *value)
{
    int64_t last = 0;

    for (int64_t first = 0; first < count; first = last) {
        double sum = 0.0;

        last = ritz_cluster_end(count, cluster, first);
        for (int64_t k = first; k < last; k++)
            sum += value[k];
        for (int64_t k = first; last > first + 1 && k < last; k++)
            value[k] = sum / (double)(last - first);
    }
}

void ritz_ranking_name_part(const char (*names)[RITZ_NAME_SIZE],
                            const char *letter, int64_t k,
                            char out[RITZ_NAME_SIZE])
{
    if (names)
        (void)snprintf(out, RITZ_NAME_SIZE, "%s", names[k]);
    else
        (void)snprintf(out, RITZ_NAME_SIZE, "%s%" PRId64, letter, k + 1);
}

ritz_status ritz_ranking_parts(int64_t count, ritz_ranking *ranking)
{
    RITZ_CHECK_NEW(ranking->part, count);
    RITZ_CHECK_NEW(ranking->whole, count);
    RITZ_CHECK(ritz_dense_new(ranking->count, count, &ranking->parts));
    ranking->num_parts = count;
    return RITZ_OK;
}

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
    const double *band_hz =
        ranker->needs & RITZ_RANK_BAND ? request->band_hz : NULL;
    int64_t last = 0;

    for (int64_t first = 0; first < ranking->count; first = last) {
        RITZ_OWN(ritz_modal) cluster = {0};

        last = ritz_cluster_end(ranking->count, ranking->cluster, first);
        RITZ_CHECK(
            ritz_modal_part(&request->modal, first, last, NULL, &cluster));
        RITZ_CHECK(ranker->value(band_hz, &cluster, &ranking->value[first]));
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
