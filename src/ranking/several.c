/*
 * One ranking over several configurations, by the largest value at any of them.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "ranking/costs.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Number of a mode: its track, or its index without tracks. */
static int64_t mode_number(const int64_t *track, int64_t mode)
{
    return track ? track[mode] : mode;
}

static int64_t number_of(const ritz_rankings *all, int64_t item, int64_t mode)
{
    return mode_number(all->track ? all->track[item] : NULL, mode);
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

/*
 * With the ranks p and q of the m modes that both rankings have, equal values
 * sharing the mean of their ranks, Spearman's coefficient is the correlation of
 * p and q, and Kendall's
 *
 *     tau_b = (C - D) / sqrt((n - t_p) (n - t_q)),    n = m (m - 1) / 2
 *
 * with C pairs in the same order in both rankings, D in opposite order, and t
 * tied in one.
 *
 * [Kendall1948]
 */
/* A mode that both rankings have. */
typedef struct shared {
    int64_t number;
    double size[2];  /* |value|, 0 if it is rounding */
    double place[2]; /* from 1 */
} shared;

/* One ranking: the numbers of its modes and its largest value. */
typedef struct ranked_values {
    const ritz_ranking *ranking;
    const int64_t *track;
    double largest;
} ranked_values;

static ranked_values open_ranking(const ritz_ranking *ranking,
                                  const int64_t *track)
{
    ranked_values s = {ranking, track, 0.0};

    for (int64_t k = 0; k < ranking->count; k++)
        s.largest = fmax(s.largest, fabs(ranking->value[k]));
    return s;
}

static double mode_size(const ranked_values *s, int64_t mode)
{
    double size = fabs(s->ranking->value[mode]);

    return size > RITZ_NEGLIGIBLE * s->largest ? size : 0.0;
}

/* The mode with a number; -1 if there is none. */
static int64_t find_mode(const ranked_values *s, int64_t number)
{
    if (!s->track)
        return number < s->ranking->count ? number : -1;
    for (int64_t k = 0; k < s->ranking->count; k++)
        if (s->track[k] == number)
            return k;
    return -1;
}

/*
 * Mean rank of equal values: the number of larger ones and half of the equal
 * ones.
 */
static void set_places(int64_t count, shared *all, int which)
{
    for (int64_t i = 0; i < count; i++) {
        double larger = 0.0, like = 0.0;

        for (int64_t j = 0; j < count; j++) {
            larger += all[j].size[which] > all[i].size[which];
            like += all[j].size[which] == all[i].size[which];
        }
        all[i].place[which] = larger + 0.5 * (like + 1.0);
    }
}

/* xy / sqrt(xx yy); NaN where one is zero. */
static double correlation(double xy, double xx, double yy)
{
    return xx > 0.0 && yy > 0.0 ? xy / sqrt(xx * yy) : nan("");
}

static double correlate_ranks(int64_t count, const shared *all)
{
    double mean = 0.5 * ((double)count + 1.0);
    double xy = 0.0, xx = 0.0, yy = 0.0;

    for (int64_t i = 0; i < count; i++) {
        double x = all[i].place[0] - mean;
        double y = all[i].place[1] - mean;

        xy += x * y;
        xx += x * x;
        yy += y * y;
    }
    return correlation(xy, xx, yy);
}

static double count_pairs(int64_t count, const shared *all)
{
    double xy = 0.0, xx = 0.0, yy = 0.0;

    for (int64_t i = 0; i < count; i++)
        for (int64_t j = 0; j < i; j++) {
            double x = all[i].place[0] - all[j].place[0];
            double y = all[i].place[1] - all[j].place[1];

            xy += (x * y > 0.0) - (x * y < 0.0);
            xx += x != 0.0;
            yy += y != 0.0;
        }
    return correlation(xy, xx, yy);
}

static ritz_status correlate_rankings(const ranked_values s[static 2],
                                      ritz_agreement *out)
{
    const ritz_ranking *a = s[0].ranking;
    RITZ_OWN_ARRAY shared *all = NULL;
    int64_t n = 0;

    RITZ_CHECK_NEW(all, a->count);
    for (int64_t k = 0; k < a->count; k++) {
        int64_t number = mode_number(s[0].track, k);
        int64_t other = find_mode(&s[1], number);

        if (other < 0)
            continue;
        all[n++] = (shared){
            number, {mode_size(&s[0], k), mode_size(&s[1], other)}, {0.0, 0.0}};
    }
    set_places(n, all, 0);
    set_places(n, all, 1);
    out->common = n;
    out->alone[0] = a->count - n;
    out->alone[1] = s[1].ranking->count - n;
    out->spearman = correlate_ranks(n, all);
    out->kendall = count_pairs(n, all);
    return RITZ_OK;
}

/* The number of the first k modes with the rest of the last one's cluster. */
static int64_t extend_to_cluster(const ritz_ranking *r, int64_t k)
{
    int64_t n = k < r->count ? k : r->count;

    while (n > 0 && n < r->count &&
           r->cluster[r->order[n]] == r->cluster[r->order[n - 1]])
        n++;
    return n;
}

static bool is_among(const ranked_values *s, int64_t n, int64_t number)
{
    for (int64_t k = 0; k < n; k++)
        if (mode_number(s->track, s->ranking->order[k]) == number)
            return true;
    return false;
}

/*
 * List the numbers among the first k of `s` that are not among those of
 * `other`.
 */
static int64_t list_difference(const ranked_values *s,
                               const ranked_values *other, int64_t k,
                               int64_t *out)
{
    int64_t n = extend_to_cluster(s->ranking, k);
    int64_t m = extend_to_cluster(other->ranking, k);
    int64_t count = 0;

    for (int64_t i = 0; i < n; i++) {
        int64_t number = mode_number(s->track, s->ranking->order[i]);

        if (is_among(other, m, number))
            continue;
        if (out)
            out[count] = number;
        count++;
    }
    return count;
}

static double overlap_share(const ranked_values s[static 2], int64_t k)
{
    int64_t n = extend_to_cluster(s[0].ranking, k);
    int64_t m = extend_to_cluster(s[1].ranking, k);
    int64_t both = n - list_difference(&s[0], &s[1], k, NULL);

    return n > 0 || m > 0 ? (double)both / (double)(n > m ? n : m) : nan("");
}

/* The counts 1, 2, 5, 10, 20, ...; the last one is all modes. */
static ritz_status set_overlaps(const ranked_values s[static 2],
                                ritz_agreement *out)
{
    static const int64_t step[] = {1, 2, 5};
    enum { MOST = 3 * 18 };
    int64_t n = s[0].ranking->count, m = s[1].ranking->count;
    int64_t most = n > m ? n : m;
    int64_t ten = 1;

    RITZ_CHECK_NEW(out->overlap, MOST);
    for (int64_t i = 0; i < MOST && out->num_overlaps < MOST; i++) {
        int64_t k = step[i % 3] * ten;

        if (k > most)
            break;
        out->overlap[out->num_overlaps++] =
            (ritz_overlap){k, overlap_share(s, k)};
        ten *= i % 3 == 2 ? 10 : 1;
    }
    return RITZ_OK;
}

ritz_status ritz_rankings_agree(const ritz_ranking *a, const int64_t *track_a,
                                const ritz_ranking *b, const int64_t *track_b,
                                int64_t top, ritz_agreement *out)
{
    const ranked_values s[2] = {open_ranking(a, track_a),
                                open_ranking(b, track_b)};
    RITZ_OWN(ritz_agreement) agreement = {.top = top};

    RITZ_REFUSE_IF(top < 1, RITZ_ERR_ARGUMENT,
                   "at least the first mode is compared");
    RITZ_CHECK(correlate_rankings(s, &agreement));
    RITZ_REFUSE_IF(agreement.common == 0, RITZ_ERR_ARGUMENT,
                   "the rankings have no mode in common");
    RITZ_CHECK(set_overlaps(s, &agreement));
    RITZ_CHECK_NEW(agreement.left, a->count);
    RITZ_CHECK_NEW(agreement.entered, b->count);
    agreement.num_left = list_difference(&s[0], &s[1], top, agreement.left);
    agreement.num_entered =
        list_difference(&s[1], &s[0], top, agreement.entered);
    agreement.top_share = overlap_share(s, top);
    RITZ_MOVE(*out, agreement);
    return RITZ_OK;
}

void ritz_agreement_free(ritz_agreement *agreement)
{
    RITZ_FREE(agreement->overlap, agreement->left, agreement->entered);
    *agreement = (ritz_agreement){0};
}
