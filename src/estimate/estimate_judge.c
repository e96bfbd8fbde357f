/*
 * What ritz-verify would find of the full modes of the band, at most and at
 * least: each one's partner, wherever it lies, and how many have none. Of one
 * cluster it takes partners in their order.
 */
#include "estimate/estimate_partner.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>

/* A little more beyond the ends of the band, in lambda, than verify counts. */
static const double edge = 4e-9;
/* Of the band, in lambda: what is below may be a rigid motion. */
static const double slow = 1e-6;
/* Bound over error that is good enough, beside what is no matter. */
static const double wanted = 3.0, nothing = 1e-9;

/* Counts are taken so far beside a mode, relative, and no further. */
static const double beside = 1e-7, too_far = 0.03;

typedef struct judge {
    const ritz_estimator *estimator;
    const ritz_measuring *m;
    const ritz_partners *partners;
    double low, high; /* the band, in lambda */
    int64_t *found;   /* reduced modes that can be partners of a group */
    ritz_matched v;
} judge;

static bool may_be_in(const judge *j, int64_t p)
{
    const ritz_enclosure *e = &j->m->enclosure;

    return e->low[p] <= j->high * (1.0 + edge) &&
           e->high[p] >= j->low * (1.0 - edge);
}

static bool surely_in(const judge *j, int64_t p)
{
    const ritz_enclosure *e = &j->m->enclosure;

    return e->high[p] <= j->high && e->low[p] >= j->low;
}

/* Reduced mode r is the partner of full mode p, or can be. */
static void pair(judge *j, int64_t p, int64_t r, bool sure)
{
    const ritz_enclosure *e = &j->m->enclosure;
    double low = fmax(e->low[p], j->low * (1.0 - edge));
    double high = fmin(e->high[p], j->high * (1.0 + edge));
    double most = ritz_claim_apart(j->m, r, low, high);
    double least =
        sure && surely_in(j, p) ? ritz_claim_between(j->m, r, low, high) : 0.0;

    if (most > j->v.bound) {
        j->v.bound = most;
        j->v.mode = r;
        j->v.number = p;
        j->v.open = !(most <= wanted * least + nothing);
    }
    if (least > j->v.least) {
        j->v.least = least;
        j->v.least_mode = r;
        j->v.least_number = p;
    }
}

/* Reduced modes that can be partners; how many of them are. */
static int64_t seek(judge *j, const ritz_group *g, int64_t *can)
{
    int64_t must = 0;

    *can = 0;
    for (int64_t r = j->m->pairs.num_rigid; r < j->m->pairs.Phi.ncol; r++)
        if (ritz_partners_must(j->partners, g, r)) {
            must++;
            j->found[(*can)++] = r;
        } else if (ritz_partners_can(j->m, j->partners, g, r)) {
            j->found[(*can)++] = r;
        }
    return must;
}

/* Of one mode: what holds more than half leaves less to others. */
static int64_t only(judge *j, const ritz_group *g, int64_t can)
{
    for (int64_t i = 0; i < can; i++)
        if (ritz_partners_must(j->partners, g, j->found[i]))
            j->found[0] = j->found[i];
    return 1;
}

static bool counted_within(const ritz_estimator *estimator, double low,
                           double high)
{
    const ritz_counted *c = estimator->count;

    for (int64_t s = 0; s < estimator->num_counts; s++)
        if (c[s].rho > low && c[s].rho < high)
            return true;
    return false;
}

/*
 * Counts on both sides of vectors that are nearly modes tell how many others
 * are where they are, and apart from them.
 */
static void propose(judge *j, const ritz_group *g)
{
    const ritz_lehmann *trial =
        j->m->polished.X.val ? &j->m->polished : &j->m->trial;
    double low = j->m->enclosure.low[g->first];
    double high = j->m->enclosure.high[g->last - 1];

    for (int64_t s = 0; s < trial->count && isnan(j->v.rho); s++) {
        double theta = trial->theta[s];
        double t = theta - trial->sigma;
        double eps = sqrt(fmax(ritz_dense_col(&trial->G, s)[s], 0.0) / t);
        double off = beside + 4.0 * (eps * t + trial->rounding[s]) / theta;

        if (theta * (1.0 + off) < low || theta * (1.0 - off) > high ||
            !(off < too_far))
            continue;
        if (!counted_within(j->estimator, theta, theta * (1.0 + 2.0 * off)))
            j->v.rho = theta * (1.0 + off);
        else if (!counted_within(j->estimator, theta * (1.0 - 2.0 * off),
                                 theta))
            j->v.rho = theta * (1.0 - off);
    }
}

static void judge_group(judge *j, const ritz_group *g)
{
    int64_t size = g->last - g->first;
    int64_t can = 0, in = 0;
    int64_t must = seek(j, g, &can);
    bool sure = false;

    if (!g->one)
        must = 0; /* of which of them? */
    if (size == 1 && must > 0)
        can = must = only(j, g, can);
    sure = must == size && can == size;
    for (int64_t p = g->first; p < g->last; p++) {
        if (!may_be_in(j, p))
            continue;
        in++;
        for (int64_t i = 0; i < can; i++)
            if (!sure || i == p - g->first)
                pair(j, p, j->found[i], sure);
        if (j->v.first < 0 && must < size)
            j->v.first = p;
    }
    j->v.any = j->v.any || in > 0;
    if (in > 0 && can > 0 && !sure) {
        j->v.unsettled = true;
        propose(j, g);
    }
    j->v.missing += in < size - must ? in : size - must;
}

/* The full model's first mode that is no rigid motion. */
static int64_t flexible(const ritz_measuring *m, double band)
{
    int64_t first = m->pairs.num_rigid;

    while (first < m->enclosure.count &&
           m->enclosure.high[first] <= slow * band)
        first++;
    return first;
}

ritz_status ritz_measuring_judge(const ritz_estimator *estimator,
                                 const ritz_measuring *m, ritz_matched *out)
{
    ritz_status status = RITZ_OK;
    const ritz_enclosure *e = &m->enclosure;
    ritz_partners partners = {0};
    judge j = {.estimator = estimator,
               .m = m,
               .partners = &partners,
               .low = ritz_eigen_lambda(m->band_hz[0]),
               .high = ritz_eigen_lambda(m->band_hz[1]),
               .v = {.bound = -1.0, .first = -1, .rho = nan("")}};
    int64_t first = flexible(m, j.high);

    while (j.v.full < e->count && e->low[j.v.full] <= j.high * (1.0 + edge))
        j.v.full++;
    j.v.known = j.v.full < e->count;
    for (int64_t p = first; p < j.v.full; p++)
        j.v.astride = j.v.astride || e->high[p] > j.high;
    j.v.slow = first < j.v.full && !(e->low[first] > 0.0);
    RITZ_NEW(j.found, m->pairs.Phi.ncol);
    RITZ_TRY(ritz_partners_new(estimator, m, first, e->count, &partners));
    for (int64_t k = 0; k < partners.count; k++)
        if (partners.group[k].first < j.v.full)
            judge_group(&j, &partners.group[k]);
    *out = j.v;
done:
    ritz_partners_free(&partners);
    free(j.found);
    return status;
}
