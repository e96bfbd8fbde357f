#include <ritz/ranking.h>

#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/cluster.h"
#include "ranking/costs.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

void ritz_ranking_share(const ritz_modal *modal, double *value)
{
    int64_t last = 0;

    for (int64_t first = 0; first < modal->count; first = last) {
        double sum = 0.0;

        last = ritz_modal_cluster(modal, first);
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

ritz_status ritz_ranking_by_cluster(const ritz_rank_request *request,
                                    ritz_cluster_value *value,
                                    ritz_ranking *ranking)
{
    const ritz_modal *modal = &request->modal;
    RITZ_OWN(ritz_modal) cluster = {0};
    int64_t last = 0;

    for (int64_t first = 0; first < modal->count; first = last) {
        last = ritz_modal_cluster(modal, first);
        RITZ_CHECK(ritz_modal_part(modal, first, last, &cluster));
        RITZ_CHECK(value(request, &cluster, &ranking->value[first]));
        for (int64_t k = first + 1; k < last; k++)
            ranking->value[k] = ranking->value[first];
        ritz_modal_free(&cluster);
    }
    return RITZ_OK;
}

ritz_status ritz_ranking_parts(int64_t count, ritz_ranking *ranking)
{
    RITZ_CHECK_NEW(ranking->part, count);
    RITZ_CHECK_NEW(ranking->whole, count);
    RITZ_CHECK(ritz_dense_new(ranking->count, count, &ranking->parts));
    ranking->num_parts = count;
    return RITZ_OK;
}
