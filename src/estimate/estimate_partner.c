/*
 * Which reduced modes can be what ritz-verify takes for a full mode of the
 * band, wherever they lie: those that hold half of it. Full modes nearer to
 * each other than it tells apart are one group, [low, high]. Of u with M-norm 1,
 * u = sum c_j phi_j, theta = u'Ku and G = |Ku - theta Mu|^2 in A^-1,
 *
 *     G = sum c_j^2 (lambda_j - theta)^2 / (lambda_j - sigma)
 *
 * so what it holds of modes beyond some lambda is no more than G (lambda -
 * sigma) / (lambda - theta)^2. Vectors of a trial turn away from the group
 * by Delta at most, sin^2 Delta the sum of these; and a reduced mode at the
 * angle alpha to them is at alpha + Delta to the group at most, and at alpha -
 * Delta at least if they are as many as its modes.
 */
#include "estimate/estimate_partner.h"

#include "base/alloc.h"
#include "verify/match.h"

#include <math.h>
#include <stdlib.h>

/* What verify takes for a partner holds so much of a mode. */
static const double half = 0.5;
/* Vectors are a group's if they turn away by no more than this, sin^2. */
static const double near = 0.1;
/* Of a share: its own rounding, and that of the vectors of another program. */
static const double rounded = 1e-6;

static double square(double x)
{
    return x * x;
}

/* Most of |c|^2 / G that one mode at lambda has of a vector at theta. */
static double weight(const ritz_lehmann *trial, double lambda, double theta)
{
    return (lambda - trial->sigma) / square(lambda - theta);
}

static double residual(const ritz_lehmann *trial, int64_t s)
{
    double t = trial->theta[s] - trial->sigma;

    return fmax(ritz_dense_col(&trial->G, s)[s], 0.0) +
           square(trial->rounding[s]) / t;
}

/* |c|^2 of all modes but the group's, of vector s; 1 if nothing is known. */
static double outside(const ritz_lehmann *trial, const ritz_enclosure *e,
                      const ritz_group *g, int64_t s)
{
    double theta = trial->theta[s];
    double below = g->first > 0 ? e->high[g->first - 1] : -HUGE_VAL;
    double above = g->last < e->count ? e->low[g->last] : 0.0;
    double most = 0.0;

    if (!(below < theta) || !(theta < above))
        return 1.0;
    most = weight(trial, above, theta);
    if (below > trial->sigma)
        most = fmax(most, weight(trial, below, theta));
    return fmin(1.0, residual(trial, s) * most);
}

/* The vectors of a trial that are near a group, if better than those known. */
static void nearest(const ritz_lehmann *trial, const ritz_enclosure *e,
                    int which, ritz_group *g)
{
    int64_t size = g->last - g->first;
    int64_t from = 0, to = 0;
    double sum = 0.0;

    while (from < trial->count && outside(trial, e, g, from) > near)
        from++;
    for (to = from; to < trial->count && to < from + size; to++) {
        double sin2 = outside(trial, e, g, to);

        if (sin2 > near)
            break;
        sum += sin2;
    }
    if (to - from < g->to - g->from ||
        (to - from == g->to - g->from && sum >= g->sin2))
        return;
    g->sin2 = sum;
    g->from = from;
    g->to = to;
    g->which = which;
}

static bool certainly_apart(const ritz_enclosure *e, int64_t p)
{
    return sqrt(fmax(e->low[p + 1], 0.0)) * (1.0 - RITZ_CLOSE) >
           sqrt(fmax(e->high[p], 0.0));
}

static bool certainly_close(const ritz_enclosure *e, int64_t p)
{
    return sqrt(e->high[p + 1]) * (1.0 - RITZ_CLOSE) <=
           sqrt(fmax(e->low[p], 0.0));
}

/* The group that begins with mode `first`. */
static ritz_group group_of(const ritz_measuring *m, int64_t first)
{
    const ritz_enclosure *e = &m->enclosure;
    ritz_group g = {
        .first = first, .last = first + 1, .one = true, .sin2 = 1.0};

    while (g.last < e->count && !certainly_apart(e, g.last - 1)) {
        g.one = g.one && certainly_close(e, g.last - 1);
        g.last++;
    }
    nearest(&m->trial, e, 0, &g);
    if (m->polished.X.val)
        nearest(&m->polished, e, 1, &g);
    return g;
}

/* Q = Phi' T' M X: what reduced modes hold of a trial's vectors. */
static ritz_status overlap(const ritz_estimator *estimator,
                           const ritz_measuring *m, const ritz_lehmann *trial,
                           ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense MX = {0}, TMX = {0};

    if (!trial->X.val)
        return RITZ_OK;
    RITZ_TRY(ritz_sparse_mul(&estimator->component->M, &trial->X, &MX));
    RITZ_TRY(ritz_dense_mul_tn(m->T, &MX, &TMX));
    RITZ_TRY(ritz_dense_mul_tn(&m->pairs.Phi, &TMX, out));
done:
    ritz_dense_free(&MX);
    ritz_dense_free(&TMX);
    return status;
}

/* Whether rounding of the reduced model may turn mode r among others. */
static bool turned(const ritz_measuring *m, int64_t r)
{
    const ritz_lehmann *t = &m->trial;

    return (r > 0 && t->most[r - 1] >= t->least[r]) ||
           (r + 1 < t->count && t->least[r + 1] <= t->most[r]);
}

/* By its residual alone, what reduced mode r holds of a group at most. */
static double most_by_residual(const ritz_measuring *m, const ritz_group *g,
                               int64_t r)
{
    const ritz_lehmann *trial = &m->trial;
    double low = fmax(m->enclosure.low[g->first], 0.0);
    double high = m->enclosure.high[g->last - 1];

    if (r >= trial->count || turned(m, r))
        return 1.0;
    if (high < trial->theta[r])
        return residual(trial, r) * weight(trial, high, trial->theta[r]);
    if (low > trial->theta[r])
        return residual(trial, r) * weight(trial, low, trial->theta[r]);
    return 1.0;
}

ritz_share ritz_partners_share(const ritz_partners *p, const ritz_group *g,
                               int64_t r)
{
    const ritz_dense *Q = &p->Q[g->which];
    double sum = 0.0;
    double alpha = 0.0, delta = 0.0;
    ritz_share share = {0.0, 1.0};

    if (g->to == g->from || g->sin2 >= 1.0)
        return share;
    for (int64_t s = g->from; s < g->to; s++)
        sum += square(ritz_dense_col(Q, s)[r]);
    alpha = acos(fmin(1.0, sqrt(sum)));
    delta = asin(sqrt(g->sin2));
    if (alpha + delta < acos(0.0))
        share.least = square(cos(alpha + delta));
    if (g->to - g->from == g->last - g->first)
        share.most = square(cos(fmax(0.0, alpha - delta)));
    return share;
}

bool ritz_partners_can(const ritz_measuring *m, const ritz_partners *p,
                       const ritz_group *g, int64_t r)
{
    ritz_share share = ritz_partners_share(p, g, r);
    double elsewhere = 0.0;

    if (share.most < half - rounded || most_by_residual(m, g, r) < half)
        return false;
    for (int64_t k = 0; k < p->count; k++)
        if (&p->group[k] != g)
            elsewhere += ritz_partners_share(p, &p->group[k], r).least;
    return 1.0 - elsewhere >= half - rounded;
}

bool ritz_partners_must(const ritz_partners *p, const ritz_group *g, int64_t r)
{
    return ritz_partners_share(p, g, r).least > half + rounded;
}

ritz_status ritz_partners_new(const ritz_estimator *estimator,
                              const ritz_measuring *m, int64_t first,
                              int64_t last, ritz_partners *out)
{
    ritz_status status = RITZ_OK;
    ritz_partners p = {0};

    RITZ_NEW(p.group, last - first);
    while (first < last) {
        p.group[p.count] = group_of(m, first);
        first = p.group[p.count++].last;
    }
    RITZ_TRY(overlap(estimator, m, &m->trial, &p.Q[0]));
    RITZ_TRY(overlap(estimator, m, &m->polished, &p.Q[1]));
    *out = p;
    p = (ritz_partners){0};
done:
    ritz_partners_free(&p);
    return status;
}

void ritz_partners_free(ritz_partners *partners)
{
    free(partners->group);
    ritz_dense_free(&partners->Q[0]);
    ritz_dense_free(&partners->Q[1]);
    *partners = (ritz_partners){0};
}
