/*
 * Where modes are counted. A count at rho serves all modes well below it, as
 * the bound of mode k exceeds its error by about
 *
 *     k_k / (k_k - kappa_rho) = (rho - sigma) / (rho - theta_k)
 *
 * So the first is taken in a wide gap some way above the band. Let o be the
 * number of full modes less that of reduced ones below a count. If o is the
 * same in the next counts above and below reduced mode k, it is full mode k +
 * o; if not, modes are missing between these counts, and are located by
 * halving. Then counts move away from the mode as far as the next modes let
 * them.
 */
#include "base/tolerances.h"
#include "estimate/estimator.h"

#include <math.h>

enum { MOST_TRIES = 4, GAPS_AROUND = 8, MOST_FOR_ONE = 16 };

ritz_status ritz_estimator_count(ritz_estimator *estimator, double rho)
{
    ritz_status status = RITZ_ERR_SINGULAR;
    const ritz_component *full = estimator->component;
    int64_t at = estimator->num_counts;
    int64_t below = 0;

    RITZ_FAIL_IF(at == RITZ_MOST_COUNTS, RITZ_ERR_ARGUMENT,
                 "more than %d counts of modes", RITZ_MOST_COUNTS);
    for (int t = 0; t < MOST_TRIES && status == RITZ_ERR_SINGULAR; t++) {
        rho *= t > 0 ? 1.0 - RITZ_GAP_NARROW : 1.0;
        status = ritz_eigen_count(&full->K, &full->M, rho, &below);
    }
    RITZ_TRY(status);
    while (at > 0 && estimator->count[at - 1].rho > rho) {
        estimator->count[at] = estimator->count[at - 1];
        at--;
    }
    estimator->count[at] = (ritz_counted){rho, below};
    estimator->num_counts++;
done:
    return ritz_context(status, "estimate");
}

static int64_t count_trial_below(const ritz_measuring *m, double rho)
{
    return ritz_count_below(m->trial.count, m->trial.theta, rho);
}

/* A point of a gap, nearer to its lower end: reduced modes are too high. */
static double split_gap(double low, double high)
{
    return low + 0.3 * (high - low);
}

/* A point in the widest gap theta_i, theta_i+1 without a count, of first <= i <
   last; NaN: none. */
static double find_widest(const ritz_measuring *m, int64_t first, int64_t last)
{
    const ritz_lehmann *trial = &m->trial;
    double best = RITZ_GAP_NARROW;
    double rho = nan("");

    for (int64_t i = first < 0 ? 0 : first; i < last && i + 1 < trial->count;
         i++) {
        double low = trial->theta[i];
        double high = trial->theta[i + 1];
        double gap = (high - low) / (high - trial->sigma);

        if (gap > best && high > trial->rounding[i] && low >= 0.0 &&
            !ritz_counted_within(m->estimator, low, high)) {
            best = gap;
            rho = split_gap(low, high);
        }
    }
    return rho;
}

/* A point in the widest gap between `from` and `to`, which are above the band;
   NaN if a count is there, or no gap. */
static double find_above(const ritz_measuring *m, double from, double to)
{
    int64_t first = count_trial_below(m, from);

    if (first == 0 || ritz_counted_within(m->estimator, from, to))
        return nan("");
    return find_widest(m, first - 1, count_trial_below(m, to));
}

static bool is_tight(const ritz_claim *claim, double rounding)
{
    return claim->full_mode >= 0 &&
           claim->bound <=
               2.0 * rounding +
                   RITZ_GOOD_RATIO * fmin(claim->least, RITZ_COARSE_ERROR);
}

/* The counts next to a mode, and how many full modes each has more than the
   reduced model. */
typedef struct sides {
    double low, high;          /* rho; HUGE_VAL: none above */
    int64_t low_off, high_off; /* full less reduced modes */
    int64_t first, last;       /* reduced modes between, last included */
} sides;

static sides find_sides(const ritz_measuring *m, int64_t k)
{
    const ritz_counted *c = m->estimator->count;
    sides s = {.high = HUGE_VAL, .last = m->trial.count - 1};

    for (int64_t i = 0; i < m->estimator->num_counts; i++) {
        int64_t below = count_trial_below(m, c[i].rho);

        if (below > k) {
            s.high = c[i].rho;
            s.high_off = c[i].below - below;
            s.last = below - 1;
            break;
        }
        s.low = c[i].rho;
        s.low_off = c[i].below - below;
        s.first = below;
    }
    return s;
}

/* A point between two ends; NaN if they are close compared with their distance
   to theta. */
static double split_ends(double low, double high, double theta)
{
    double off = fmin(fabs(low - theta), fabs(high - theta));

    if (!(high > low * (1.0 + RITZ_GAP_NARROW)) ||
        high - low <= RITZ_GAP_CLOSE * off)
        return nan("");
    return low > 0.0 ? sqrt(low * high) : 0.1 * high;
}

/* Where modes are missing between the counts around mode k: a count that tells
   on which side of it. */
static double locate_missing(const ritz_measuring *m, const sides *s, int64_t k,
                             double least)
{
    double theta = m->trial.theta[k];
    double about = fmax(4.0 * least * theta, RITZ_GAP_NARROW * theta);
    int64_t middle = (s->first + s->last) / 2;

    if (s->last > s->first)
        return find_widest(m, middle, middle + 1);
    if (s->high - theta > about)
        return split_gap(theta, fmin(s->high, 4.0 * theta));
    if (theta - s->low > about)
        return theta - split_gap(0.0, theta - s->low);
    return nan("");
}

/* Where mode k is known to be full mode p: a count in the gap above or below
   it, further off than those there are. */
static double move_away(const ritz_measuring *m, const sides *s, int64_t k,
                        int64_t p)
{
    const ritz_enclosure *e = &m->enclosure;
    double theta = m->trial.theta[k];
    double reach = theta - m->trial.sigma;
    double low = fmax(theta, e->low[p + 1]);
    double high = fmin(e->high[p + 1], 4.0 * theta);
    double rho = nan("");

    if (low - m->trial.sigma < RITZ_COUNT_ENOUGH * reach)
        rho = split_ends(low, high, theta);
    if (isnan(rho) && p != k)
        rho = split_ends(e->low[p - 1], fmin(e->high[p - 1], theta), theta);
    if (isnan(rho) && s->low < theta)
        rho = split_ends(fmax(e->low[p], s->low), fmin(e->high[p], theta), 0.0);
    return rho;
}

double ritz_propose_above(const ritz_measuring *m)
{
    double band = ritz_eigen_lambda(m->band_hz[1]);

    return find_above(m, RITZ_COUNT_FAR * band, RITZ_COUNT_FARTHEST * band);
}

bool ritz_counted_more(const ritz_estimator *estimator, int64_t k, double rho)
{
    const ritz_counted *c = estimator->count;

    for (int64_t s = 0; s < estimator->num_counts; s++)
        if (c[s].below > k && c[s].rho <= rho)
            return true;
    return false;
}

bool ritz_counted_within(const ritz_estimator *estimator, double low,
                         double high)
{
    const ritz_counted *c = estimator->count;

    for (int64_t s = 0; s < estimator->num_counts; s++)
        if (c[s].rho > low && c[s].rho < high)
            return true;
    return false;
}

bool ritz_counted_rigid(const ritz_estimator *estimator, int64_t k,
                        double theta, double band)
{
    return theta <= RITZ_MAY_BE_RIGID * band &&
           ritz_counted_more(estimator, k, 0.5 * theta);
}

/* Where to count for one mode; NaN if its claim is tight enough. */
static double propose_for(const ritz_measuring *m, int64_t k, double band)
{
    double theta = m->trial.theta[k];
    ritz_claim claim = ritz_claim_of(m, k);
    sides s = find_sides(m, k);
    int64_t p = k + s.low_off;
    double rho = nan("");

    if (ritz_counted_rigid(m->estimator, k, theta, band) ||
        is_tight(&claim, m->trial.reduced_rounding[k] / theta))
        return nan("");
    if (theta <= RITZ_MAY_BE_RIGID * band)
        return 0.1 * theta;
    if (isinf(s.high))
        rho = find_widest(m, k, k + GAPS_AROUND);
    else if (s.low_off != s.high_off)
        rho = locate_missing(m, &s, k, claim.least);
    if (isnan(rho) && p >= 0 && p + 1 < m->enclosure.count)
        rho = move_away(m, &s, k, p);
    return rho;
}

double ritz_propose_count(const ritz_measuring *m, const int64_t *tries,
                          int64_t *mode)
{
    double band = m->reach > m->first ? m->trial.theta[m->reach - 1] : 0.0;
    double rho = nan("");
    int64_t fewest = MOST_FOR_ONE;

    if (band > 0.0)
        rho = find_above(m, RITZ_COUNT_NEAR * band, RITZ_COUNT_FAR * band);
    *mode = -1;
    for (int64_t k = m->reach - 1; k >= m->first && (isnan(rho) || *mode >= 0);
         k--) {
        int64_t tried = tries[k - m->first];
        double next = tried < fewest ? propose_for(m, k, band) : nan("");

        if (next > m->trial.rounding[k]) {
            rho = next;
            *mode = k;
            fewest = tried;
        }
    }
    return rho;
}

int64_t ritz_missing_modes(const ritz_measuring *m)
{
    double end = ritz_eigen_lambda(m->band_hz[1]);
    int64_t least = -1;

    for (int64_t s = 0; s < m->estimator->num_counts; s++) {
        const ritz_counted *c = &m->estimator->count[s];
        int64_t below =
            ritz_count_below(m->pairs.Phi.ncol, m->pairs.lambda, c->rho);
        int64_t more = c->below > below ? c->below - below : 0;

        if (c->rho >= end && (least < 0 || more < least))
            least = more;
    }
    return least;
}
