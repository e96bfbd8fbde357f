/*
 * Where modes are counted. A count at rho serves all modes well below it, as
 * the bound of mode k exceeds its error by about
 *
 *     k_k / (k_k - kappa_rho) = (rho - sigma) / (rho - theta_k)
 *
 * So the first is taken in a wide gap some way above the band. Let o be the
 * full modes less the reduced ones below a count. A mode with the same o in the
 * next counts above and below is full mode k + o; where o jumps between them,
 * modes are missing there, and where is found by halving. Then counts move away
 * from the mode as far as its neighbours let them.
 */
#include "base/tolerances.h"
#include "estimate/estimator.h"

#include <inttypes.h>
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

/* A point of a gap, nearer to its lower end: reduced modes are too high. */
static double within(double low, double high)
{
    return low + 0.3 * (high - low);
}

/* A point in the widest gap theta_i, theta_i+1 without a count, of first <= i <
   last; NaN: none. */
static double widest(const ritz_estimator *estimator, const ritz_lehmann *trial,
                     int64_t first, int64_t last)
{
    double best = RITZ_GAP_NARROW;
    double rho = nan("");

    for (int64_t i = first < 0 ? 0 : first; i < last && i + 1 < trial->count;
         i++) {
        double low = trial->theta[i];
        double high = trial->theta[i + 1];
        double gap = (high - low) / (high - trial->sigma);

        if (gap > best && high > trial->rounding[i] && low >= 0.0 &&
            !ritz_counted_within(estimator, low, high)) {
            best = gap;
            rho = within(low, high);
        }
    }
    return rho;
}

/* A point in the widest gap between `from` and `to`, which are above the band;
   NaN if a count is there, or no gap. */
static double above_band(const ritz_estimator *estimator,
                         const ritz_lehmann *trial, double from, double to)
{
    int64_t first = 0;
    int64_t last = 0;

    if (ritz_counted_within(estimator, from, to))
        return nan("");
    while (first < trial->count && trial->theta[first] < from)
        first++;
    last = first;
    while (last < trial->count && trial->theta[last] < to)
        last++;
    return first > 0 ? widest(estimator, trial, first - 1, last) : nan("");
}

static bool satisfied(const ritz_claim *claim, double rounding)
{
    return claim->full_mode >= 0 &&
           claim->bound <=
               2.0 * rounding +
                   RITZ_GOOD_RATIO * fmin(claim->least, RITZ_COARSE_ERROR);
}

/* Reduced modes below rho. */
static int64_t trial_below(const ritz_lehmann *trial, double rho)
{
    int64_t below = 0;

    while (below < trial->count && trial->theta[below] < rho)
        below++;
    return below;
}

/* The counts next to a mode, and how many full modes each has more than the
   reduced model. */
typedef struct sides {
    double low, high;          /* rho; HUGE_VAL: none above */
    int64_t low_off, high_off; /* full less reduced modes */
    int64_t first, last;       /* reduced modes between, last included */
} sides;

static sides sides_of(const ritz_estimator *estimator,
                      const ritz_lehmann *trial, int64_t k)
{
    sides s = {.high = HUGE_VAL, .last = trial->count - 1};

    for (int64_t i = 0; i < estimator->num_counts; i++) {
        const ritz_counted *c = &estimator->count[i];
        int64_t below = trial_below(trial, c->rho);

        if (below <= k) {
            s.low = c->rho;
            s.low_off = c->below - below;
            s.first = below;
        } else {
            s.high = c->rho;
            s.high_off = c->below - below;
            s.last = below - 1;
            break;
        }
    }
    return s;
}

/* A point between two ends; NaN if they are close compared with their distance
   to theta. */
static double between(double low, double high, double theta)
{
    double off = fmin(fabs(low - theta), fabs(high - theta));

    if (!(high > low * (1.0 + RITZ_GAP_NARROW)) ||
        high - low <= RITZ_GAP_CLOSE * off)
        return nan("");
    return low > 0.0 ? sqrt(low * high) : 0.1 * high;
}

/* Where modes are missing between the counts around mode k: a count that tells
   on which side of it. */
static double locate(const ritz_estimator *estimator, const ritz_lehmann *trial,
                     const sides *s, int64_t k, double least)
{
    double theta = trial->theta[k];
    double about = fmax(4.0 * least * theta, RITZ_GAP_NARROW * theta);
    int64_t middle = (s->first + s->last) / 2;

    if (s->last > s->first)
        return widest(estimator, trial, middle, middle + 1);
    if (s->high - theta > about)
        return within(theta, fmin(s->high, 4.0 * theta));
    if (theta - s->low > about)
        return theta - within(0.0, theta - s->low);
    return nan("");
}

/* Where mode k is known to be full mode p: a count in the gap above or below
   it, further off than those there are. */
static double spread(const ritz_lehmann *trial, const ritz_enclosure *e,
                     const sides *s, int64_t k, int64_t p)
{
    double theta = trial->theta[k];
    double reach = theta - trial->sigma;
    double low = fmax(theta, e->low[p + 1]);
    double high = fmin(e->high[p + 1], 4.0 * theta);
    double rho = nan("");

    if (low - trial->sigma < RITZ_COUNT_ENOUGH * reach)
        rho = between(low, high, theta);
    if (isnan(rho) && p != k)
        rho = between(e->low[p - 1], fmin(e->high[p - 1], theta), theta);
    if (isnan(rho) && s->low < theta)
        rho = between(fmax(e->low[p], s->low), fmin(e->high[p], theta), 0.0);
    return rho;
}

static double around(const ritz_estimator *estimator, const ritz_lehmann *trial,
                     const ritz_enclosure *e, int64_t k, double least)
{
    sides s = sides_of(estimator, trial, k);
    int64_t p = k + s.low_off;
    double rho = nan("");

    if (isinf(s.high))
        rho = widest(estimator, trial, k, k + GAPS_AROUND);
    else if (s.low_off != s.high_off)
        rho = locate(estimator, trial, &s, k, least);
    if (isnan(rho) && p >= 0 && p + 1 < e->count)
        rho = spread(trial, e, &s, k, p);
    return rho;
}

double ritz_propose_above(const ritz_estimator *estimator,
                          const ritz_lehmann *trial, double band)
{
    return above_band(estimator, trial, RITZ_COUNT_FAR * band,
                      RITZ_COUNT_FARTHEST * band);
}

bool ritz_counted_more(const ritz_estimator *estimator, int64_t k, double rho)
{
    const ritz_counted *c = estimator->count;

    for (int64_t s = 0; s < estimator->num_counts; s++)
        if (c[s].below > k && c[s].rho <= rho)
            return true;
    return false;
}

bool ritz_counted_rigid(const ritz_estimator *estimator, int64_t k,
                        double theta, double band)
{
    return theta <= RITZ_MAY_BE_RIGID * band &&
           ritz_counted_more(estimator, k, 0.5 * theta);
}

/* Where to count for one mode; NaN if its claim is good enough. */
static double next_for(const ritz_estimator *estimator,
                       const ritz_lehmann *trial,
                       const ritz_enclosure *enclosure, int64_t k, double band)
{
    double theta = trial->theta[k];
    ritz_claim claim = ritz_claim_of(trial, enclosure, k, theta);

    if (ritz_counted_rigid(estimator, k, theta, band) ||
        satisfied(&claim, trial->reduced_rounding[k] / theta))
        return nan("");
    if (theta <= RITZ_MAY_BE_RIGID * band)
        return 0.1 * theta;
    return around(estimator, trial, enclosure, k, claim.least);
}

double ritz_propose_count(const ritz_estimator *estimator,
                          const ritz_lehmann *trial,
                          const ritz_enclosure *enclosure,
                          const ritz_pursuit *pursuit, int64_t *mode)
{
    int64_t first = pursuit->first;
    int64_t last = pursuit->last;
    double band = last > first ? trial->theta[last - 1] : 0.0;
    double rho = band > 0.0
                     ? above_band(estimator, trial, RITZ_COUNT_NEAR * band,
                                  RITZ_COUNT_FAR * band)
                     : nan("");
    int64_t fewest = MOST_FOR_ONE;

    *mode = -1;
    for (int64_t k = last - 1; k >= first && (isnan(rho) || *mode >= 0); k--) {
        double next = pursuit->tries[k - first] < fewest
                          ? next_for(estimator, trial, enclosure, k, band)
                          : nan("");

        if (next > trial->rounding[k]) {
            rho = next;
            *mode = k;
            fewest = pursuit->tries[k - first];
        }
    }
    return rho;
}

int64_t ritz_missing_modes(const ritz_estimator *estimator,
                           const ritz_measuring *m, double *at)
{
    double end = ritz_eigen_lambda(m->band_hz[1]);
    int64_t least = -1;

    for (int64_t s = 0; s < estimator->num_counts; s++) {
        const ritz_counted *c = &estimator->count[s];
        int64_t below = 0;

        while (below < m->pairs.Phi.ncol && m->pairs.lambda[below] < c->rho)
            below++;
        below = c->below > below ? c->below - below : 0;
        if (c->rho >= end && (least < 0 || below < least)) {
            least = below;
            *at = c->rho;
        }
    }
    return least;
}
