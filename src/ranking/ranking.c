#include <ritz/ranking.h>

#include "base/alloc.h"
#include "gramians/modes.h"
#include "ranking/costs.h"

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

int64_t ritz_mode_number(const int64_t *track, int64_t mode)
{
    return track ? track[mode] : mode;
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
