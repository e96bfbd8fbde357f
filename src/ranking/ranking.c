#include "base/alloc.h"
#include "gramians/cluster.h"

#include <ritz/ranking.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A mode this much weaker than the largest is rounding: its coupling is too. */
static const double negligible = 1e-20;

/* A new ranking is a new file that defines one descriptor, and a line here. */
const ritz_ranker *const ritz_rankers[] = {
    &ritz_ranker_gregory,
    &ritz_ranker_hankel,
    NULL,
};

enum { MOST_RANKERS = 32 };

const ritz_ranker *ritz_ranker_find(const char *name)
{
    char names[MOST_RANKERS][RITZ_NAME_SIZE];
    const char *near = NULL;
    int64_t count = 0;

    for (; count < MOST_RANKERS && ritz_rankers[count]; count++) {
        const char *known = ritz_rankers[count]->name;

        if (strcmp(known, name) == 0)
            return ritz_rankers[count];
        (void)snprintf(names[count], RITZ_NAME_SIZE, "%s", known);
    }
    near = ritz_text_nearest(name, count, names[0], RITZ_NAME_SIZE);
    ritz_record("there is no ranking '%s'%s%s%s", name,
                near ? ", did you mean '" : "", near ? near : "",
                near ? "'?" : "");
    return NULL;
}

/* Which of a pair of Gramians' entries are largest against their diagonals. */
static void couple(const ritz_dense *W, const int64_t *cluster,
                   ritz_ranking *ranking)
{
    double largest[2] = {0.0, 0.0};

    for (int64_t a = 0; a < W->nrow; a++)
        largest[a % 2] = fmax(largest[a % 2], ritz_dense_col(W, a)[a]);
    for (int64_t b = 0; b < W->nrow; b++)
        for (int64_t a = 0; a < b; a++) {
            double wa = ritz_dense_col(W, a)[a];
            double wb = ritz_dense_col(W, b)[b];
            double off = fabs(ritz_dense_col(W, b)[a]) / sqrt(wa * wb);

            if (cluster[a / 2] == cluster[b / 2] ||
                !(wa > negligible * largest[a % 2]) ||
                !(wb > negligible * largest[b % 2]) ||
                !(off > ranking->coupling))
                continue;
            ranking->coupling = off;
            ranking->coupled[0] = a / 2;
            ranking->coupled[1] = b / 2;
        }
}

/* Coupling of both Gramians, but within clusters, which are ranked whole. */
static ritz_status measure_coupling(const ritz_modal *modal,
                                    const int64_t *cluster,
                                    ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    ritz_dense Wc = {0};
    ritz_dense Wo = {0};

    RITZ_TRY(ritz_modal_gramians(modal, &Wc, &Wo));
    couple(&Wc, cluster, ranking);
    couple(&Wo, cluster, ranking);
done:
    ritz_dense_free(&Wc);
    ritz_dense_free(&Wo);
    return status;
}

/* The largest value of a cluster is that of each of its modes. */
static void join_clusters(const ritz_modal *modal, int64_t *cluster,
                          double *value)
{
    int64_t last = 0;

    for (int64_t first = 0; first < modal->count; first = last) {
        double largest = 0.0;

        last = ritz_modal_cluster(modal, first);
        for (int64_t k = first; k < last; k++)
            largest = fmax(largest, value[k]);
        for (int64_t k = first; k < last; k++) {
            value[k] = largest;
            cluster[k] = first;
        }
    }
}

/* A value and its mode, to be sorted. */
typedef struct place {
    double value;
    int64_t mode;
} place;

/* Larger values first, of equal ones the lower frequency. */
static int compare(const void *left, const void *right)
{
    const place *a = left;
    const place *b = right;

    if (a->value != b->value)
        return a->value > b->value ? -1 : 1;
    return (a->mode > b->mode) - (a->mode < b->mode);
}

static ritz_status sort(ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    place *all = NULL;

    RITZ_NEW(all, ranking->count);
    for (int64_t k = 0; k < ranking->count; k++)
        all[k] = (place){ranking->value[k], k};
    qsort(all, (size_t)ranking->count, sizeof *all, compare);
    for (int64_t k = 0; k < ranking->count; k++)
        ranking->order[k] = all[k].mode;
done:
    free(all);
    return status;
}

static ritz_status ranking_new(const ritz_ranker *ranker,
                               const ritz_modal *modal, ritz_ranking *out)
{
    static const double pi = 3.14159265358979323846;
    ritz_status status = RITZ_OK;
    int64_t m = modal->count;

    (void)snprintf(out->by, RITZ_NAME_SIZE, "%s", ranker->name);
    (void)snprintf(out->reference, RITZ_NAME_SIZE, "%s", ranker->reference);
    out->count = m;
    out->num_system = 2 * m;
    RITZ_NEW(out->hertz, m);
    RITZ_NEW(out->zeta, m);
    RITZ_NEW(out->value, m);
    RITZ_NEW(out->order, m);
    RITZ_NEW(out->system_value, 2 * m);
    for (int64_t k = 0; k < m; k++) {
        out->hertz[k] = modal->omega[k] / (2.0 * pi);
        out->zeta[k] = modal->zeta[k];
    }
done:
    return status;
}

ritz_status ritz_rank(const ritz_ranker *ranker, const ritz_modal *modal,
                      ritz_ranking *out)
{
    ritz_status status = RITZ_OK;
    ritz_ranking ranking = {0};
    int64_t *cluster = NULL;

    RITZ_FAIL_IF(modal->B.ncol == 0 || modal->C.nrow == 0, RITZ_ERR_ARGUMENT,
                 "a ranking needs at least one input and one output");
    RITZ_NEW(cluster, modal->count);
    RITZ_TRY(ranking_new(ranker, modal, &ranking));
    RITZ_TRY_IN(ranker->name, ranker->rank(modal, ranking.value));
    join_clusters(modal, cluster, ranking.value);
    RITZ_TRY(sort(&ranking));
    RITZ_TRY(ritz_modal_hankel(modal, ranking.system_value));
    RITZ_TRY(measure_coupling(modal, cluster, &ranking));
    *out = ranking;
    ranking = (ritz_ranking){0};
done:
    free(cluster);
    ritz_ranking_free(&ranking);
    return status;
}

void ritz_ranking_free(ritz_ranking *ranking)
{
    free(ranking->hertz);
    free(ranking->zeta);
    free(ranking->value);
    free(ranking->order);
    free(ranking->system_value);
    *ranking = (ritz_ranking){0};
}
