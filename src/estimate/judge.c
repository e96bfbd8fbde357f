/* What ritz-verify would find, predicted from enclosures alone. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "estimate/estimator.h"

#include <math.h>

/*
 * Partners. ritz-verify pairs a full mode with the reduced mode that holds most
 * of it, half at least, at any frequency. Full modes that are too close to be
 * distinguished form a group, [low, high]. For a vector u, u'Mu = 1, u = sum
 * c_j phi_j, theta = u'Ku, the squared residual G = |Ku - theta Mu|^2 in A^-1
 * is
 *
 *     G = sum c_j^2 (lambda_j - theta)^2 / (lambda_j - sigma)
 *
 * so modes beyond some lambda have at most G (lambda - sigma) / (lambda -
 * theta)^2 of |c|^2. Hence trial vectors near a group make an angle of at most
 * Delta with it, sin^2 Delta the sum of these. A reduced mode at the angle
 * alpha to the vectors is at most alpha + Delta from the group, and at least
 * alpha - Delta if there are as many vectors as modes.
 */

/* Full modes first .. last - 1, not known to be separate. */
typedef struct ritz_mode_group {
    int64_t first, last;
    bool is_cluster; /* they are known to be one cluster */
    int vectors;     /* near it are vectors of the trial (0), or polished (1) */
    int64_t first_vector, end_vector; /* as many as modes or fewer */
    double sin2; /* of the angle between vectors and group, at most */
} ritz_mode_group;

/* What is being predicted. */
typedef struct ritz_judge {
    ritz_measuring *m;
    double low, high; /* the band, in lambda */
    int64_t count;
    ritz_mode_group *group;
    int64_t *found; /* reduced modes that can be partners of a group */
} ritz_judge;

static void ritz_judge_free(ritz_judge *j)
{
    RITZ_FREE(j->group, j->found);
}

static double square_of(double x)
{
    return x * x;
}

/* Bound of |c|^2 / G for modes beyond lambda of a vector at theta. */
static double weight_beyond(const ritz_lehmann *trial, double lambda,
                            double theta)
{
    return (lambda - trial->sigma) / square_of(lambda - theta);
}

/* G of vector s, and what rounding adds. */
static double residual_of(const ritz_lehmann *trial, int64_t s)
{
    double t = trial->theta[s] - trial->sigma;

    return fmax(ritz_dense_col(&trial->G, s)[s], 0.0) +
           square_of(trial->rounding[s]) / t;
}

/* Upper bound of the part of vector s outside the group; 1: not known. */
static double outside_group(const ritz_lehmann *trial, const ritz_enclosure *e,
                            const ritz_mode_group *g, int64_t s)
{
    double theta = trial->theta[s];
    double below = g->first > 0 ? e->high[g->first - 1] : -HUGE_VAL;
    double above = g->last < e->count ? e->low[g->last] : 0.0;
    double most = 0.0;

    if (!(below < theta) || !(theta < above))
        return 1.0;
    most = weight_beyond(trial, above, theta);
    if (below > trial->sigma)
        most = fmax(most, weight_beyond(trial, below, theta));
    return fmin(1.0, residual_of(trial, s) * most);
}

/* Take a trial's vectors near a group if they are more, or nearer, than those
   it has. */
static void choose_vectors(const ritz_lehmann *trial, const ritz_enclosure *e,
                           int which, ritz_mode_group *g)
{
    int64_t size = g->last - g->first;
    int64_t from = 0, to = 0;
    double sum = 0.0;

    while (from < trial->count &&
           outside_group(trial, e, g, from) > RITZ_VECTOR_NEAR)
        from++;
    for (to = from; to < trial->count && to < from + size; to++) {
        double sin2 = outside_group(trial, e, g, to);

        if (sin2 > RITZ_VECTOR_NEAR)
            break;
        sum += sin2;
    }
    if (to - from < g->end_vector - g->first_vector ||
        (to - from == g->end_vector - g->first_vector && sum >= g->sin2))
        return;
    g->sin2 = sum;
    g->first_vector = from;
    g->end_vector = to;
    g->vectors = which;
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
static ritz_mode_group group_of(const ritz_measuring *m, int64_t first)
{
    const ritz_enclosure *e = &m->enclosure;
    ritz_mode_group g = {
        .first = first, .last = first + 1, .is_cluster = true, .sin2 = 1.0};

    while (g.last < e->count && !certainly_apart(e, g.last - 1)) {
        g.is_cluster = g.is_cluster && certainly_close(e, g.last - 1);
        g.last++;
    }
    choose_vectors(&m->trial, e, 0, &g);
    if (m->polished.X.val)
        choose_vectors(&m->polished, e, 1, &g);
    return g;
}

/* Q = Phi' T' M X, mass products of reduced modes and a trial's vectors; kept in
   the trial, whose X never changes. */
static ritz_status take_overlap(const ritz_measuring *m, ritz_lehmann *trial)
{
    RITZ_OWN(ritz_dense) TMX = {0};

    if (!trial->X.val || trial->Q.val)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_between(m->T, &m->estimator->component->M, &trial->X,
                                   &TMX));
    return ritz_dense_mul_tn(&m->pairs.Phi, &TMX, &trial->Q);
}

/* Whether rounding of the reduced matrices may mix mode r with the next one. */
static bool is_mixed(const ritz_measuring *m, int64_t r)
{
    const ritz_lehmann *t = &m->trial;

    return (r > 0 && t->reduced_high[r - 1] >= t->reduced_low[r]) ||
           (r + 1 < t->count && t->reduced_low[r + 1] <= t->reduced_high[r]);
}

/* Upper bound of the part of reduced mode r in a group, by its residual. */
static double most_by_residual(const ritz_measuring *m,
                               const ritz_mode_group *g, int64_t r)
{
    const ritz_lehmann *trial = &m->trial;
    double low = fmax(m->enclosure.low[g->first], 0.0);
    double high = m->enclosure.high[g->last - 1];

    if (r >= trial->count || is_mixed(m, r))
        return 1.0;
    if (high < trial->theta[r])
        return residual_of(trial, r) *
               weight_beyond(trial, high, trial->theta[r]);
    if (low > trial->theta[r])
        return residual_of(trial, r) *
               weight_beyond(trial, low, trial->theta[r]);
    return 1.0;
}

/* Bounds of the part |c|^2 of reduced mode r in a group. */
static ritz_bounds share_of(const ritz_judge *j, const ritz_mode_group *g,
                            int64_t r)
{
    const ritz_dense *Q = g->vectors == 0 ? &j->m->trial.Q : &j->m->polished.Q;
    double sum = 0.0;
    double alpha = 0.0, delta = 0.0;
    ritz_bounds share = {0.0, 1.0};

    if (g->end_vector == g->first_vector || g->sin2 >= 1.0)
        return share;
    for (int64_t s = g->first_vector; s < g->end_vector; s++)
        sum += square_of(ritz_dense_col(Q, s)[r]);
    alpha = acos(fmin(1.0, sqrt(sum)));
    delta = asin(sqrt(g->sin2));
    if (alpha + delta < acos(0.0))
        share.least = square_of(cos(alpha + delta));
    if (g->end_vector - g->first_vector == g->last - g->first)
        share.most = square_of(cos(fmax(0.0, alpha - delta)));
    return share;
}

/* Whether reduced mode @p r may hold half of the group. */
static bool can_be_partner(const ritz_judge *j, const ritz_mode_group *g,
                           int64_t r)
{
    double elsewhere = 0.0;

    if (share_of(j, g, r).most < RITZ_SAME_MODE - RITZ_SHARE_ROUNDING ||
        most_by_residual(j->m, g, r) < RITZ_SAME_MODE)
        return false;
    for (int64_t k = 0; k < j->count; k++)
        if (&j->group[k] != g)
            elsewhere += share_of(j, &j->group[k], r).least;
    return 1.0 - elsewhere >= RITZ_SAME_MODE - RITZ_SHARE_ROUNDING;
}

static bool must_be_partner(const ritz_judge *j, const ritz_mode_group *g,
                            int64_t r)
{
    return share_of(j, g, r).least > RITZ_SAME_MODE + RITZ_SHARE_ROUNDING;
}

/*
 * The prediction: bounds of the worst frequency error and of the number of
 * modes without a partner, over all full modes that may be in the band and all
 * their possible partners. In a cluster ritz-verify takes partners in their
 * order.
 */

static bool may_be_in(const ritz_judge *j, int64_t p)
{
    const ritz_enclosure *e = &j->m->enclosure;

    return e->low[p] <= j->high * (1.0 + RITZ_BAND_EDGE_COUNTED) &&
           e->high[p] >= j->low * (1.0 - RITZ_BAND_EDGE_COUNTED);
}

static bool surely_in(const ritz_judge *j, int64_t p)
{
    const ritz_enclosure *e = &j->m->enclosure;

    return e->high[p] <= j->high && e->low[p] >= j->low;
}

/* Take the errors of full mode p, paired with reduced mode r, into the
   prediction; `sure` if they are a pair for certain. */
static void note_pair(ritz_judge *j, int64_t p, int64_t r, bool sure)
{
    const ritz_enclosure *e = &j->m->enclosure;
    double low = fmax(e->low[p], j->low * (1.0 - RITZ_BAND_EDGE_COUNTED));
    double high = fmin(e->high[p], j->high * (1.0 + RITZ_BAND_EDGE_COUNTED));
    ritz_bounds error = ritz_error_of(j->m, r, low, high);
    double most = error.most;
    double least = sure && surely_in(j, p) ? error.least : 0.0;
    ritz_prediction *v = &j->m->prediction;

    if (most > v->bound.value) {
        v->bound = (ritz_pair_error){most, r, p};
        v->loose = !(most <= RITZ_GOOD_RATIO * least + RITZ_NO_ERROR);
    }
    if (least > v->least.value)
        v->least = (ritz_pair_error){least, r, p};
}

/* List the `can` reduced modes that can be partners; returns how many of them
   certainly are. */
static int64_t find_partners(ritz_judge *j, const ritz_mode_group *g,
                             int64_t *can)
{
    int64_t must = 0;

    *can = 0;
    for (int64_t r = j->m->pairs.num_rigid; r < j->m->pairs.Phi.ncol; r++)
        if (must_be_partner(j, g, r)) {
            must++;
            j->found[(*can)++] = r;
        } else if (can_be_partner(j, g, r)) {
            j->found[(*can)++] = r;
        }
    return must;
}

/* A reduced mode that has more than half of a single mode is its only
   partner. */
static int64_t keep_partner(ritz_judge *j, const ritz_mode_group *g,
                            int64_t can)
{
    for (int64_t i = 0; i < can; i++)
        if (must_be_partner(j, g, j->found[i]))
            j->found[0] = j->found[i];
    return 1;
}

/*
 * Where partners are unclear, counts on both sides of a vector that is nearly a
 * mode show how many full modes are near it, and how many are not.
 */
static void propose_count(ritz_judge *j, const ritz_mode_group *g)
{
    const ritz_lehmann *trial =
        j->m->polished.X.val ? &j->m->polished : &j->m->trial;
    double low = j->m->enclosure.low[g->first];
    double high = j->m->enclosure.high[g->last - 1];
    double *at = &j->m->prediction.count_at;

    for (int64_t s = 0; s < trial->count && isnan(*at); s++) {
        double theta = trial->theta[s];
        double t = theta - trial->sigma;
        double eps = sqrt(fmax(ritz_dense_col(&trial->G, s)[s], 0.0) / t);
        double off =
            RITZ_COUNT_BESIDE + 4.0 * (eps * t + trial->rounding[s]) / theta;

        if (theta * (1.0 + off) < low || theta * (1.0 - off) > high ||
            !(off < RITZ_COUNT_TOO_FAR))
            continue;
        if (!ritz_counted_within(j->m->estimator, theta,
                                 theta * (1.0 + 2.0 * off)))
            *at = theta * (1.0 + off);
        else if (!ritz_counted_within(j->m->estimator,
                                      theta * (1.0 - 2.0 * off), theta))
            *at = theta * (1.0 - off);
    }
}

static void judge_group(ritz_judge *j, const ritz_mode_group *g)
{
    ritz_prediction *v = &j->m->prediction;
    int64_t size = g->last - g->first;
    int64_t can = 0, in = 0;
    int64_t must = find_partners(j, g, &can);
    bool sure = false;

    if (!g->is_cluster)
        must = 0; /* of which mode of the group is not known */
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
        if (v->first_missing < 0 && must < size)
            v->first_missing = p;
    }
    v->any_in_band = v->any_in_band || in > 0;
    if (in > 0 && can > 0 && !sure) {
        v->unmatched = true;
        propose_count(j, g);
    }
    v->num_missing += in < size - must ? in : size - must;
}

/* Number of the full model's first flexible mode. */
static int64_t first_flexible(const ritz_measuring *m, double band)
{
    int64_t first = m->pairs.num_rigid;

    while (first < m->enclosure.count &&
           m->enclosure.high[first] <= RITZ_MAY_BE_RIGID * band)
        first++;
    return first;
}

/* Groups of the full modes from the first flexible one on. */
static ritz_status group_modes(ritz_judge *j, int64_t first)
{
    ritz_measuring *m = j->m;
    int64_t last = m->enclosure.count;

    RITZ_CHECK_NEW(j->found, m->pairs.Phi.ncol);
    RITZ_CHECK_NEW(j->group, last - first);
    while (first < last) {
        j->group[j->count] = group_of(m, first);
        first = j->group[j->count++].last;
    }
    return take_overlap(m, &m->polished);
}

ritz_status ritz_measuring_predict(ritz_measuring *m)
{
    const ritz_enclosure *e = &m->enclosure;
    ritz_prediction *v = &m->prediction;
    RITZ_OWN(ritz_judge)
    j = {.m = m,
         .low = ritz_eigen_lambda(m->band_hz[0]),
         .high = ritz_eigen_lambda(m->band_hz[1])};
    int64_t first = first_flexible(m, j.high);

    *v = (ritz_prediction){
        .bound = {.value = -1.0}, .first_missing = -1, .count_at = nan("")};
    while (v->num_full < e->count &&
           e->low[v->num_full] <= j.high * (1.0 + RITZ_BAND_EDGE_COUNTED))
        v->num_full++;
    v->counted = v->num_full < e->count;
    for (int64_t p = first; p < v->num_full; p++)
        v->edge_unclear = v->edge_unclear || e->high[p] > j.high;
    v->rigid_unclear = first < v->num_full && !(e->low[first] > 0.0);
    RITZ_CHECK(group_modes(&j, first));
    for (int64_t k = 0; k < j.count; k++)
        if (j.group[k].first < v->num_full)
            judge_group(&j, &j.group[k]);
    return RITZ_OK;
}

bool ritz_estimator_has_counted(const ritz_estimator *estimator, int64_t k,
                                double rho)
{
    const ritz_counted *c = estimator->count;

    for (int64_t s = 0; s < estimator->num_counts; s++)
        if (c[s].below > k && c[s].rho <= rho)
            return true;
    return false;
}

bool ritz_estimator_sees_rigid(const ritz_estimator *estimator, int64_t k,
                               double theta, double band)
{
    return theta <= RITZ_MAY_BE_RIGID * band &&
           ritz_estimator_has_counted(estimator, k, 0.5 * theta);
}
