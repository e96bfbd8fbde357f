/*
 * One ranking over several configurations, by the largest value at any of them.
 */
#include "base/alloc.h"
#include "ranking/costs.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int64_t mode_number(const ritz_rankings *all, int64_t item, int64_t mode)
{
    return all->track ? all->track[item][mode] : mode;
}

static ritz_status check_rankings(const ritz_rankings *all, int64_t *numbers)
{
    const ritz_ranking *first = all->item;

    RITZ_REFUSE_IF(all->count == 0, RITZ_ERR_ARGUMENT, "there is no ranking");
    *numbers = 0;
    for (int64_t k = 0; k < all->count; k++) {
        const ritz_ranking *r = &all->item[k];

        RITZ_REFUSE_IF(strcmp(r->by, first->by) != 0, RITZ_ERR_ARGUMENT,
                       "values by '%s' and by '%s' have no largest one",
                       first->by, r->by);
        RITZ_REFUSE_IF(!all->track && r->count != first->count,
                       RITZ_ERR_ARGUMENT,
                       "%" PRId64 " modes at '%s' and %" PRId64
                       " at '%s': only tracks say which is which",
                       first->count, first->at, r->count, r->at);
        for (int64_t i = 0; i < r->count; i++)
            if (mode_number(all, k, i) >= *numbers)
                *numbers = mode_number(all, k, i) + 1;
    }
    return RITZ_OK;
}

/*
 * The ranking and the mode in which each number has its largest value, -1 if
 * none has it.
 */
static void find_largest(const ritz_rankings *all, int64_t numbers,
                         int64_t *item, int64_t *mode)
{
    for (int64_t n = 0; n < numbers; n++)
        item[n] = -1;
    for (int64_t k = 0; k < all->count; k++)
        for (int64_t i = 0; i < all->item[k].count; i++) {
            int64_t n = mode_number(all, k, i);
            double size = fabs(all->item[k].value[i]);

            if (item[n] < 0 || size > fabs(all->item[item[n]].value[mode[n]])) {
                item[n] = k;
                mode[n] = i;
            }
        }
}

/*
 * Modes of one cluster where the first of them is largest remain one cluster.
 */
static void take_clusters(const ritz_rankings *all, const int64_t *item,
                          const int64_t *mode, ritz_ranking *out)
{
    for (int64_t k = 0; k < out->count; k++) {
        const ritz_ranking *r = &all->item[item[k]];

        out->cluster[k] = k;
        if (k > 0 && item[k] == item[k - 1] &&
            r->cluster[mode[k]] == r->cluster[mode[k - 1]])
            out->cluster[k] = out->cluster[k - 1];
    }
}

static ritz_status create_ranking(const ritz_ranking *like, int64_t count,
                                  ritz_ranking *out)
{
    memcpy(out->by, like->by, sizeof out->by);
    memcpy(out->reference, like->reference, sizeof out->reference);
    memcpy(out->damping, like->damping, sizeof out->damping);
    out->count = count;
    out->total = nan("");
    out->coupling = nan("");
    RITZ_CHECK_NEW(out->hertz, count);
    RITZ_CHECK_NEW(out->zeta, count);
    RITZ_CHECK_NEW(out->value, count);
    RITZ_CHECK_NEW(out->order, count);
    RITZ_CHECK_NEW(out->cluster, count);
    RITZ_CHECK_NEW(out->system_value, 1);
    return RITZ_OK;
}

/* Remove the numbers that no ranking has. */
static int64_t remove_gaps(int64_t numbers, int64_t *item, int64_t *mode,
                           int64_t *track)
{
    int64_t count = 0;

    for (int64_t n = 0; n < numbers; n++) {
        if (item[n] < 0)
            continue;
        item[count] = item[n];
        mode[count] = mode[n];
        track[count++] = n;
    }
    return count;
}

ritz_status ritz_rankings_largest(const ritz_rankings *rankings,
                                  ritz_ranking *out, int64_t **where,
                                  int64_t **track)
{
    RITZ_OWN(ritz_ranking) largest = {0};
    RITZ_OWN_ARRAY int64_t *item = NULL, *mode = NULL, *number = NULL;
    int64_t numbers = 0, count = 0;

    RITZ_CHECK(check_rankings(rankings, &numbers));
    RITZ_CHECK_NEW(item, numbers);
    RITZ_CHECK_NEW(mode, numbers);
    RITZ_CHECK_NEW(number, numbers);
    find_largest(rankings, numbers, item, mode);
    count = remove_gaps(numbers, item, mode, number);
    RITZ_CHECK(create_ranking(rankings->item, count, &largest));
    for (int64_t k = 0; k < count; k++) {
        const ritz_ranking *r = &rankings->item[item[k]];

        largest.hertz[k] = r->hertz[mode[k]];
        largest.zeta[k] = r->zeta[mode[k]];
        largest.value[k] = r->value[mode[k]];
    }
    take_clusters(rankings, item, mode, &largest);
    RITZ_CHECK(ritz_ranking_sort(count, largest.value, largest.order));
    RITZ_MOVE(*out, largest);
    RITZ_MOVE(*where, item);
    RITZ_MOVE(*track, number);
    return RITZ_OK;
}
