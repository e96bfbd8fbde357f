/*
 * One ranking over several configurations, by the largest value at any of them.
 */
#include "base/alloc.h"
#include "ranking/costs.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Number of a mode of one of the rankings. */
static int64_t number_of(const ritz_rankings *all, int64_t item, int64_t mode)
{
    return ritz_mode_number(all->track ? all->track[item] : NULL, mode);
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
            if (number_of(all, k, i) >= *numbers)
                *numbers = number_of(all, k, i) + 1;
    }
    return RITZ_OK;
}

/*
 * For each number that a ranking has, the ranking and the mode with its largest
 * value; returns how many there are.
 *
 * @param[out] item,mode,number  of each, in order of numbers
 */
static int64_t find_largest(const ritz_rankings *all, int64_t numbers,
                            int64_t *item, int64_t *mode, int64_t *number)
{
    int64_t count = 0;

    for (int64_t n = 0; n < numbers; n++)
        item[n] = -1;
    for (int64_t k = 0; k < all->count; k++)
        for (int64_t i = 0; i < all->item[k].count; i++) {
            int64_t n = number_of(all, k, i);
            double size = fabs(all->item[k].value[i]);

            if (item[n] < 0 || size > fabs(all->item[item[n]].value[mode[n]])) {
                item[n] = k;
                mode[n] = i;
            }
        }
    for (int64_t n = 0; n < numbers; n++)
        if (item[n] >= 0) {
            item[count] = item[n];
            mode[count] = mode[n];
            number[count++] = n;
        }
    return count;
}

ritz_status ritz_rankings_largest(const ritz_rankings *rankings,
                                  ritz_ranking *out, int64_t **where,
                                  int64_t **track)
{
    const ritz_ranking *first = rankings->item;
    RITZ_OWN(ritz_ranking) largest = {0};
    RITZ_OWN_ARRAY int64_t *item = NULL, *mode = NULL, *number = NULL;
    int64_t numbers = 0, count = 0;

    RITZ_CHECK(check_rankings(rankings, &numbers));
    RITZ_CHECK_NEW(item, numbers);
    RITZ_CHECK_NEW(mode, numbers);
    RITZ_CHECK_NEW(number, numbers);
    count = find_largest(rankings, numbers, item, mode, number);
    RITZ_CHECK(ritz_ranking_new(count, &largest));
    memcpy(largest.by, first->by, sizeof largest.by);
    memcpy(largest.reference, first->reference, sizeof largest.reference);
    memcpy(largest.damping, first->damping, sizeof largest.damping);
    for (int64_t k = 0; k < count; k++) {
        const ritz_ranking *r = &rankings->item[item[k]];

        largest.hertz[k] = r->hertz[mode[k]];
        largest.zeta[k] = r->zeta[mode[k]];
        largest.value[k] = r->value[mode[k]];
        largest.cluster[k] = k;
        /* neighbours that were one cluster where they are largest remain one */
        if (k > 0 && item[k] == item[k - 1] &&
            r->cluster[mode[k]] == r->cluster[mode[k - 1]])
            largest.cluster[k] = largest.cluster[k - 1];
    }
    RITZ_CHECK(ritz_ranking_sort(count, largest.value, largest.order));
    RITZ_MOVE(*out, largest);
    RITZ_MOVE(*where, item);
    RITZ_MOVE(*track, number);
    return RITZ_OK;
}
