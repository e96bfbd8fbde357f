/*
 * A ranking by any of the rankers, with coupling and the values of the whole
 * model.
 */
#include "ranking/clusters.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/modes.h"

#include <ritz/ranking.h>

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

int64_t ritz_cluster_end(int64_t count, const int64_t *cluster, int64_t first)
{
    int64_t last = first + 1;

    while (last < count && cluster[last] == first)
        last++;
    return last;
}

/*
 * A ranking of @p count modes, all zero; `total` and `coupling` are not known.
 * Entries for rigid modes follow those of flexible modes in `cluster`.
 */
static ritz_status create_zeros(int64_t count, int64_t rigid, ritz_ranking *out)
{
    RITZ_OWN(ritz_ranking)
    ranking = {.count = count, .total = nan(""), .coupling = nan("")};

    RITZ_CHECK_NEW(ranking.hertz, count);
    RITZ_CHECK_NEW(ranking.zeta, count);
    RITZ_CHECK_NEW(ranking.value, count);
    RITZ_CHECK_NEW(ranking.order, count);
    RITZ_CHECK_NEW(ranking.cluster, count + rigid);
    RITZ_CHECK_NEW(ranking.system_value, 2 * count + rigid);
    RITZ_MOVE(*out, ranking);
    return RITZ_OK;
}

void ritz_ranking_share(int64_t count, const int64_t *cluster, double *value)
{
    for (int64_t first = 0; first < count; first++) {
        int64_t members = 0;
        double sum = 0.0;

        for (int64_t k = first; k < count && cluster[first] == first; k++)
            if (cluster[k] == first) {
                sum += value[k];
                members++;
            }
        for (int64_t k = first; k < count && members > 1; k++)
            if (cluster[k] == first)
                value[k] = sum / (double)members;
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

    for (int64_t a = 0; a < 2 * ranking->count; a++)
        largest[a % 2] = fmax(largest[a % 2], ritz_dense_col(W, a)[a]);
    for (int64_t b = 0; b < 2 * ranking->count; b++)
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

    RITZ_CHECK(create_zeros(modal->count, modal->num_rigid, out));
    (void)snprintf(out->by, RITZ_NAME_SIZE, "%s", ranker->name);
    (void)snprintf(out->reference, RITZ_NAME_SIZE, "%s", ranker->reference);
    for (int64_t k = 0; k < out->count; k++) {
        out->hertz[k] = modal->omega[k] / (2.0 * RITZ_PI);
        out->zeta[k] = request->undamped ? 0.0 : modal->zeta[k];
    }
    if (ranker->joins && modal->Delta.val)
        return ritz_coupled_clusters(modal, out->cluster);
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
    int64_t all = ranking->count + request->modal.num_rigid;
    RITZ_OWN_ARRAY bool *taken = NULL;

    RITZ_CHECK_NEW(taken, all);
    for (int64_t first = 0; first < ranking->count; first++) {
        RITZ_OWN(ritz_modal) cluster = {0};

        if (ranking->cluster[first] != first)
            continue;
        for (int64_t k = 0; k < all; k++)
            taken[k] = ranking->cluster[k] == first;
        RITZ_CHECK(ritz_modal_part(&request->modal, taken,
                                   taken + ranking->count, &cluster));
        RITZ_CHECK(ranker->value(band_hz, &cluster, &ranking->value[first]));
        for (int64_t k = first + 1; k < ranking->count; k++)
            if (taken[k])
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
    ranking->num_system = 2 * modal->count;
    RITZ_CHECK(modal->Delta.val
                   ? ritz_coupled_hankel(modal, &ranking->num_system,
                                         ranking->system_value)
                   : ritz_modal_hankel(modal, NULL, ranking->system_value));
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

/*
 * One ranking over several configurations, by the largest value at any of them.
 */

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
    RITZ_CHECK(create_zeros(count, 0, &largest));
    memcpy(largest.by, first->by, sizeof largest.by);
    memcpy(largest.reference, first->reference, sizeof largest.reference);
    memcpy(largest.damping, first->damping, sizeof largest.damping);
    for (int64_t k = 0; k < count; k++) {
        const ritz_ranking *r = &rankings->item[item[k]];

        largest.hertz[k] = r->hertz[mode[k]];
        largest.zeta[k] = r->zeta[mode[k]];
        largest.value[k] = r->value[mode[k]];
        /* modes that are one cluster in the ranking of their largest value
           remain one */
        largest.cluster[k] = k;
        for (int64_t j = 0; j < k && largest.cluster[k] == k; j++)
            if (item[k] == item[j] &&
                r->cluster[mode[k]] == r->cluster[mode[j]])
                largest.cluster[k] = largest.cluster[j];
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
