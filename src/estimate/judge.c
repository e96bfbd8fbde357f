/*
 * What is said of one reduced mode, and of which: within what share of which
 * full mode it is. Any full mode may be named whose interval is known; and
 * without a number
 *
 *     |kappa - 1/t| <= eps / t,   eps = |R|_(A^-1) / |x|_A
 *
 * holds for some kappa of the full model, as it does of the same vector after
 * an inverse iteration, where eps is far smaller.
 */
#include "base/alloc.h"
#include "estimate/estimator.h"
#include "verify/match.h"

#include <math.h>
#include <stdlib.h>

/* The mode of the same number is preferred to another one that is nearer. */
static const double favour = 4.0;
/* What verify takes for a partner holds so much of a mode. */
static const double half = 0.5;
/* Vectors are a group's if they turn away by no more than this, sin^2. */
static const double near = 0.1;
/* Of a share: its own rounding, and that of the vectors of another program. */
static const double rounded = 1e-6;
/* A little more beyond the ends of the band, in lambda, than verify counts. */
static const double edge = 4e-9;
/* Of the band, in lambda: what is below may be a rigid motion. */
static const double slow = 1e-6;
/* Bound over error that is good enough, beside what is no matter. */
static const double wanted = 3.0, nothing = 1e-9;
/* Counts are taken so far beside a mode, relative, and no further. */
static const double beside = 1e-7, too_far = 0.03;

/*
 * Largest |f' - f| / f, f' of [least, most], as rounding of the reduced model
 * has it, and f of [low, high].
 */
static double apart(const ritz_lehmann *trial, int64_t k, double theta,
                    double low, double high)
{
    double least = fmax(fmin(theta, trial->least[k]), 0.0);
    double most = fmax(theta, trial->most[k]);

    if (!(low > 0.0))
        return HUGE_VAL;
    return fmax(0.0, fmax(sqrt(most / low) - 1.0, 1.0 - sqrt(least / high)));
}

/* Of modes beyond the trial nothing but the eigenvalue is known. */
static double bounded_by(const ritz_measuring *m, const double *ends, int64_t k,
                         double sign)
{
    double theta = m->pairs.lambda[k];

    if (k < m->trial.count)
        theta = sign * fmax(sign * theta, sign * ends[k]);
    return fmax(theta, 0.0);
}

/* The same of a full mode in [low, high]; how far it is off at least. */
static double error_at_most(const ritz_measuring *m, int64_t k, double low,
                            double high)
{
    double least = bounded_by(m, m->trial.least, k, -1.0);
    double most = bounded_by(m, m->trial.most, k, 1.0);

    if (!(low > 0.0))
        return HUGE_VAL;
    return fmax(0.0, fmax(sqrt(most / low) - 1.0, 1.0 - sqrt(least / high)));
}

static double error_at_least(const ritz_measuring *m, int64_t k, double low,
                             double high)
{
    double least = bounded_by(m, m->trial.least, k, -1.0);
    double most = bounded_by(m, m->trial.most, k, 1.0);

    if (!(low > 0.0))
        return 0.0;
    return fmax(0.0, fmax(sqrt(least / high) - 1.0, 1.0 - sqrt(most / low)));
}

ritz_claim ritz_claim_of(const ritz_lehmann *trial,
                         const ritz_enclosure *enclosure, int64_t k,
                         double theta)
{
    const ritz_enclosure *e = enclosure;
    ritz_claim claim = {.bound = HUGE_VAL, .number = k};
    double same = apart(trial, k, theta, e->low[k], e->high[k]);
    double some = HUGE_VAL;

    for (int64_t p = 0; p < e->count; p++) {
        double bound = apart(trial, k, theta, e->low[p], e->high[p]);

        if (bound < claim.bound) {
            claim.bound = bound;
            claim.number = p;
        }
    }
    if (same <= favour * claim.bound) {
        claim.bound = same;
        claim.number = k;
    }
    for (int64_t j = 0; j < e->num_near; j++)
        some =
            fmin(some, apart(trial, k, theta, e->near_low[j], e->near_high[j]));
    if (favour * some < claim.bound) {
        claim.bound = some;
        claim.number = -1;
    }
    claim.least = 0.5 * ritz_dense_col(&trial->G, k)[k] /
                  ((trial->theta[k] - trial->sigma) * fabs(trial->theta[k]));
    return claim;
}

double ritz_claim_same(const ritz_lehmann *trial, const ritz_enclosure *e,
                       int64_t k, double theta)
{
    return apart(trial, k, theta, e->low[k], e->high[k]);
}

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

/* Full modes first .. last - 1, which are not known to be apart. */
typedef struct ritz_group {
    int64_t first, last;
    bool one;  /* but known to be one cluster */
    int which; /* 0: vectors of the trial are near them; 1: polished ones */
    int64_t from, to; /* vectors from .. to - 1, as many as modes or fewer */
    double sin2;      /* of the angle between these and it, at most */
} ritz_group;

typedef struct ritz_partners {
    int64_t count;
    ritz_group *group;
    ritz_dense Q[2]; /* reduced modes against the trial, the polished one */
} ritz_partners;

/* |c|^2 that a mode holds of a group. */
typedef struct ritz_share {
    double least, most;
} ritz_share;

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
static void choose_vectors(const ritz_lehmann *trial, const ritz_enclosure *e,
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
    choose_vectors(&m->trial, e, 0, &g);
    if (m->polished.X.val)
        choose_vectors(&m->polished, e, 1, &g);
    return g;
}

/* Q = Phi' T' M X: what reduced modes hold of a trial's vectors. */
static ritz_status take_overlap(const ritz_estimator *estimator,
                                const ritz_measuring *m,
                                const ritz_lehmann *trial, ritz_dense *out)
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

static ritz_share share_of(const ritz_partners *p, const ritz_group *g,
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

/* Whether reduced mode @p r can hold half of the group; whether it does. */
static bool can_be_partner(const ritz_measuring *m, const ritz_partners *p,
                           const ritz_group *g, int64_t r)
{
    ritz_share share = share_of(p, g, r);
    double elsewhere = 0.0;

    if (share.most < half - rounded || most_by_residual(m, g, r) < half)
        return false;
    for (int64_t k = 0; k < p->count; k++)
        if (&p->group[k] != g)
            elsewhere += share_of(p, &p->group[k], r).least;
    return 1.0 - elsewhere >= half - rounded;
}

static bool must_be_partner(const ritz_partners *p, const ritz_group *g,
                            int64_t r)
{
    return share_of(p, g, r).least > half + rounded;
}

static void free_partners(ritz_partners *partners)
{
    free(partners->group);
    ritz_dense_free(&partners->Q[0]);
    ritz_dense_free(&partners->Q[1]);
    *partners = (ritz_partners){0};
}

/* Groups from full mode @p first on, of all up to @p last and beyond. */
static ritz_status group_modes(const ritz_estimator *estimator,
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
    RITZ_TRY(take_overlap(estimator, m, &m->trial, &p.Q[0]));
    RITZ_TRY(take_overlap(estimator, m, &m->polished, &p.Q[1]));
    *out = p;
    p = (ritz_partners){0};
done:
    free_partners(&p);
    return status;
}

/*
 * What ritz-verify would find of the full modes of the band, at most and at
 * least: each one's partner, wherever it lies, and how many have none. Of one
 * cluster it takes partners in their order.
 */

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
static void note_pair(judge *j, int64_t p, int64_t r, bool sure)
{
    const ritz_enclosure *e = &j->m->enclosure;
    double low = fmax(e->low[p], j->low * (1.0 - edge));
    double high = fmin(e->high[p], j->high * (1.0 + edge));
    double most = error_at_most(j->m, r, low, high);
    double least =
        sure && surely_in(j, p) ? error_at_least(j->m, r, low, high) : 0.0;

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
static int64_t find_partners(judge *j, const ritz_group *g, int64_t *can)
{
    int64_t must = 0;

    *can = 0;
    for (int64_t r = j->m->pairs.num_rigid; r < j->m->pairs.Phi.ncol; r++)
        if (must_be_partner(j->partners, g, r)) {
            must++;
            j->found[(*can)++] = r;
        } else if (can_be_partner(j->m, j->partners, g, r)) {
            j->found[(*can)++] = r;
        }
    return must;
}

/* Of one mode: what holds more than half leaves less to others. */
static int64_t keep_partner(judge *j, const ritz_group *g, int64_t can)
{
    for (int64_t i = 0; i < can; i++)
        if (must_be_partner(j->partners, g, j->found[i]))
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
static void propose_count(judge *j, const ritz_group *g)
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
    int64_t must = find_partners(j, g, &can);
    bool sure = false;

    if (!g->one)
        must = 0; /* of which of them? */
    if (size == 1 && must > 0)
        can = must = keep_partner(j, g, can);
    sure = must == size && can == size;
    for (int64_t p = g->first; p < g->last; p++) {
        if (!may_be_in(j, p))
            continue;
        in++;
        for (int64_t i = 0; i < can; i++)
            if (!sure || i == p - g->first)
                note_pair(j, p, j->found[i], sure);
        if (j->v.first < 0 && must < size)
            j->v.first = p;
    }
    j->v.any = j->v.any || in > 0;
    if (in > 0 && can > 0 && !sure) {
        j->v.unsettled = true;
        propose_count(j, g);
    }
    j->v.missing += in < size - must ? in : size - must;
}

/* The full model's first mode that is no rigid motion. */
static int64_t first_flexible(const ritz_measuring *m, double band)
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
    int64_t first = first_flexible(m, j.high);

    while (j.v.full < e->count && e->low[j.v.full] <= j.high * (1.0 + edge))
        j.v.full++;
    j.v.known = j.v.full < e->count;
    for (int64_t p = first; p < j.v.full; p++)
        j.v.astride = j.v.astride || e->high[p] > j.high;
    j.v.slow = first < j.v.full && !(e->low[first] > 0.0);
    RITZ_NEW(j.found, m->pairs.Phi.ncol);
    RITZ_TRY(group_modes(estimator, m, first, e->count, &partners));
    for (int64_t k = 0; k < partners.count; k++)
        if (partners.group[k].first < j.v.full)
            judge_group(&j, &partners.group[k]);
    *out = j.v;
done:
    free_partners(&partners);
    free(j.found);
    return status;
}
