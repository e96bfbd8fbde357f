/*
 * How far a reduced model can be off, found from one factor of the full
 * matrices, the residuals of its modes, and counts of full modes below some
 * frequencies. Counts and inverse iterations are spent first on the reduced
 * modes in the band, then on those that ritz-verify pairs with the full modes
 * in it; the bounds reached then are reported as named numbers. Enclosures are
 * in enclose.c, partners in judge.c, named numbers in report.c, responses in
 * response.c.
 *
 * A count at rho serves all modes well below it, as the bound of mode k exceeds
 * its error by about
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
#include "base/alloc.h"
#include "base/memory.h"
#include "base/tolerances.h"
#include "estimate/estimator.h"
#include "linear/factor.h"
#include "linear/inertia.h"
#include "verify/sides.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Gaps behind the band where a count may show that no mode is missing. */
enum { GAPS = 3 };
/* Most counts for one reduction: some, and some for each mode in the band. */
enum { SOME_COUNTS = 8, COUNTS_A_MODE = 4 };
/* Most inverse iterations, and most counts next to modes, while partners are
   unclear. The first iteration comes before counts: it costs as much as one
   of them, and improves the bounds of all modes. */
enum { ITERATIONS = 4, MOST_BESIDE = 16 };
/* Tries of a count that meets a mode; counts for one mode; gaps near it. */
enum { MOST_TRIES = 4, MOST_FOR_ONE = 16, GAPS_AROUND = 8 };
enum { MORE = 10 };

/*
 * Count known eigenvalues below rho; false where that is uncertain. It is
 * certain if rho is above the first flexible eigenvalue, below the value up to
 * which none is missing, and not close to an eigenvalue.
 */
static bool count_known(const ritz_pairs *known, double rho, int64_t *below)
{
    const int64_t rigid = known ? known->num_rigid : 0;
    const int64_t count = known ? known->Phi.ncol : 0;
    const double off = RITZ_GAP_NARROW * rho;

    if (count <= rigid || !(rho - off > known->lambda[rigid]) ||
        !(rho + off <= known->proven_to))
        return false;
    *below = ritz_count_below(count, known->lambda, rho - off);
    return *below == ritz_count_below(count, known->lambda, rho + off);
}

/*
 * Whether the number of full modes below rho is known without a factor.
 *
 * If the basis has as many columns as the component has dofs, its Ritz values
 * are all eigenvalues, and no factorisation is needed unless rounding may have
 * moved one of them across rho.
 */
static bool is_known(const ritz_measuring *m, double rho, int64_t *below)
{
    const ritz_pairs *pairs = &m->pairs;
    int64_t count = pairs->Phi.ncol;
    double off = 0.0;

    if (count == m->estimator->component->num_dofs) {
        off =
            RITZ_WHOLE_CLEAR * pairs->lambda[count - 1] + RITZ_GAP_NARROW * rho;
        *below = ritz_count_below(count, pairs->lambda, rho - off);
        if (*below == ritz_count_below(count, pairs->lambda, rho + off))
            return true;
    }
    return count_known(m->estimator->request.modes, rho, below);
}

/* The number of full modes below rho; RITZ_ERR_SINGULAR if the factor for the
   count has a pivot that is zero within rounding, as a mode lies at rho. */
static ritz_status count_below(const ritz_measuring *m, double rho,
                               int64_t *below)
{
    if (is_known(m, rho, below))
        return RITZ_OK;
    return ritz_estimator_below(m->estimator, rho, below);
}

/* Count the modes below rho, or below a slightly smaller value if a mode is at
   rho. `refused` is set if that fails, or the table of counts is full. */
static ritz_status count_at(ritz_measuring *m, double rho)
{
    ritz_estimator *estimator = m->estimator;
    ritz_status status = RITZ_ERR_SINGULAR;
    int64_t at = estimator->num_counts, below = 0;

    for (int t = 0;
         t < MOST_TRIES && at < RITZ_MOST_COUNTS && status == RITZ_ERR_SINGULAR;
         t++) {
        rho *= t > 0 ? 1.0 - RITZ_GAP_NARROW : 1.0;
        status = count_below(m, rho, &below);
    }
    m->refused = status == RITZ_ERR_SINGULAR;
    if (m->refused)
        return RITZ_OK;
    RITZ_CHECK_IN("estimate", status);
    while (at > 0 && estimator->count[at - 1].rho > rho) {
        estimator->count[at] = estimator->count[at - 1];
        at--;
    }
    estimator->count[at] = (ritz_counted){rho, below};
    estimator->num_counts++;
    return RITZ_OK;
}

static bool has_room(const ritz_measuring *m)
{
    return m->estimator->num_counts < RITZ_MOST_COUNTS;
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

/* Where to count for one mode; NaN if its claim is tight enough. */
static double propose_for(const ritz_measuring *m, int64_t k, double band)
{
    double theta = m->trial.theta[k];
    double rounding = m->trial.reduced_rounding[k] + m->trial.rounding[k];
    ritz_claim claim = ritz_claim_of(m, k);
    sides s = find_sides(m, k);
    int64_t p = k + s.low_off;
    double rho = nan("");

    if (ritz_estimator_sees_rigid(m->estimator, k, theta, band) ||
        is_tight(&claim, rounding / theta))
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

/* The highest eigenvalue of modes first .. end - 1; 0: there are none. */
static double highest_of(const ritz_measuring *m, int64_t end)
{
    return end > m->first ? m->trial.theta[end - 1] : 0.0;
}

/* Where a count would serve all of them, some way above the highest; NaN if
   there is one. */
static double propose_behind(const ritz_measuring *m, int64_t end)
{
    double band = highest_of(m, end);
    double rho = nan("");

    if (band > 0.0)
        rho = find_above(m, RITZ_COUNT_NEAR * band, RITZ_COUNT_OFF * band);
    if (band > 0.0 && isnan(rho))
        rho = find_above(m, RITZ_COUNT_NEAR * band, RITZ_COUNT_FAR * band);
    return rho;
}

/*
 * Where a count would tighten the enclosures of modes first .. reach - 1 most;
 * NaN if none helps.
 *
 * @param[in]  tries  counts that each of them has had
 * @param[out] mode   the mode that it is for; -1: all of them
 */
static double propose_count(const ritz_measuring *m, const int64_t *tries,
                            int64_t *mode)
{
    double band = highest_of(m, m->reach);
    double rho = propose_behind(m, m->reach);
    int64_t fewest = MOST_FOR_ONE;

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

static ritz_status predict_errors(ritz_measuring *m)
{
    RITZ_CHECK(ritz_measuring_enclose(m));
    return ritz_measuring_predict(m);
}

/* One more inverse iteration, of what there is. */
static ritz_status iterate_trial(ritz_measuring *m)
{
    RITZ_OWN(ritz_lehmann) next = {0};

    RITZ_CHECK(ritz_lehmann_polish(
        m->estimator, m->polished.X.val ? &m->polished : &m->trial, &next));
    ritz_lehmann_free(&m->polished);
    RITZ_MOVE(m->polished, next);
    return RITZ_OK;
}

/*
 * Take counts where they help, until every mode's claim is good or enough is
 * spent. Before the first count for a single mode the trial gets an inverse
 * iteration.
 */
static ritz_status refine_modes(ritz_measuring *m)
{
    int64_t budget = SOME_COUNTS + COUNTS_A_MODE * (m->reach - m->first);
    RITZ_OWN_ARRAY int64_t *tries = NULL;

    RITZ_CHECK_NEW(tries, m->reach - m->first);
    for (m->refused = false; !m->refused;) {
        double rho = nan("");
        int64_t mode = -1;

        RITZ_CHECK(ritz_measuring_enclose(m));
        if (budget-- > 0 && has_room(m))
            rho = propose_count(m, tries, &mode);
        if (isnan(rho))
            return RITZ_OK;
        if (mode >= 0 && !m->polished.X.val) {
            RITZ_CHECK(iterate_trial(m));
            continue;
        }
        if (mode >= 0)
            tries[mode - m->first]++;
        RITZ_CHECK(count_at(m, rho));
    }
    return RITZ_OK;
}

/* One count far above the band, for responses: the further modes are, the less
   they respond. */
static ritz_status count_above(ritz_measuring *m)
{
    double band = ritz_eigen_lambda(m->band_hz[1]);
    double rho =
        find_above(m, RITZ_COUNT_FAR * band, RITZ_COUNT_FARTHEST * band);

    return isnan(rho) ? RITZ_OK : count_at(m, rho);
}

/* Where to count for missing modes: at the band's end, or in a gap behind. */
static double end_of_band(const ritz_measuring *m, int64_t gap)
{
    double end = ritz_eigen_lambda(m->band_hz[1]) * (1.0 + DBL_EPSILON);
    int64_t above = m->last + gap;
    double low = above > 0 ? m->pairs.lambda[above - 1] : 0.0;
    double high = above < m->pairs.Phi.ncol ? m->pairs.lambda[above] : end;

    return gap == 0 ? end : fmax(end, split_gap(low, high));
}

/*
 * Unless it is known that none is missing, count at the end of the band, and in
 * the next gaps, where the partners of the last modes may be.
 */
static ritz_status count_band(ritz_measuring *m)
{
    m->refused = false;
    for (int64_t gap = 0; gap < GAPS && m->last + gap <= m->pairs.Phi.ncol &&
                          ritz_missing_modes(m) != 0 && !m->refused;
         gap++)
        RITZ_CHECK(count_at(m, end_of_band(m, gap)));
    return RITZ_OK;
}

/* Where intervals do not tell which full modes are in the band, count at its
   ends. */
static ritz_status count_ends(ritz_measuring *m)
{
    double end = ritz_eigen_lambda(m->band_hz[1]);

    if (!m->prediction.counted || m->prediction.edge_unclear)
        RITZ_CHECK(count_at(m, end * (1.0 + RITZ_COUNT_BEHIND)));
    if (m->prediction.rigid_unclear)
        RITZ_CHECK(count_at(m, RITZ_SURELY_RIGID * end));
    RITZ_CHECK(predict_errors(m));
    if (m->prediction.num_full > m->reach)
        m->reach = m->prediction.num_full;
    if (m->reach > m->trial.count)
        m->reach = m->trial.count;
    if (m->reach <= m->last)
        return RITZ_OK;
    RITZ_CHECK(refine_modes(m));
    return ritz_measuring_predict(m);
}

/* Count and iterate until the modes of the band are known. */
static ritz_status refine_all(bool response, ritz_measuring *m)
{
    int iterations = 0, counts = 0;

    m->reach = m->last;
    RITZ_CHECK(refine_modes(m));
    if (response)
        RITZ_CHECK(count_above(m));
    RITZ_CHECK(count_band(m));
    RITZ_CHECK(predict_errors(m));
    RITZ_CHECK(count_ends(m));
    while (m->prediction.loose || m->prediction.unmatched) {
        if (iterations > 0 && !isnan(m->prediction.count_at) &&
            counts++ < MOST_BESIDE && has_room(m))
            RITZ_CHECK(count_at(m, m->prediction.count_at));
        else if (iterations++ < ITERATIONS)
            RITZ_CHECK(iterate_trial(m));
        else
            break;
        RITZ_CHECK(predict_errors(m));
    }
    return RITZ_OK;
}

ritz_status ritz_estimator_new(const ritz_component *full,
                               const ritz_estimate_request *request,
                               ritz_estimator **out)
{
    ritz_estimator *made = NULL;

    RITZ_CHECK(ritz_verify_band(request->band_hz, true));
    RITZ_CHECK_NEW(made, 1);
    made->component = full;
    made->request = *request;
    *out = made;
    return RITZ_OK;
}

void ritz_estimator_free(ritz_estimator **estimator)
{
    if (!*estimator)
        return;
    ritz_factor_free(&(*estimator)->A);
    ritz_counter_free(&(*estimator)->counter);
    free(*estimator);
    *estimator = NULL;
}

/* The flexible modes in the band; where no band was asked for, one at least. */
static void choose_modes(const ritz_estimator *estimator,
                         const ritz_basis *basis, ritz_measuring *m)
{
    const ritz_pairs *pairs = &m->pairs;
    const double *asked = estimator->request.band_hz;

    m->band_hz[0] = asked[0];
    m->band_hz[1] = asked[1] > 0.0 ? asked[1]
                                   : 0.5 * ritz_highest_hertz(&basis->columns,
                                                              pairs->Phi.ncol,
                                                              pairs->lambda);
    m->first = pairs->num_rigid;
    while (m->first < pairs->Phi.ncol &&
           ritz_eigen_hertz(pairs->lambda[m->first]) < m->band_hz[0])
        m->first++;
    m->last = m->first;
    while (m->last < pairs->Phi.ncol &&
           ritz_eigen_hertz(pairs->lambda[m->last]) <= m->band_hz[1])
        m->last++;
    if (asked[1] == 0.0 && m->last == m->first && m->last < pairs->Phi.ncol) {
        m->last++;
        m->band_hz[1] = ritz_eigen_hertz(pairs->lambda[m->first]);
    }
}

/* Size of the trial space. */
static int64_t count_trial(const ritz_measuring *m, bool response)
{
    double reach = RITZ_TRIAL_REACH * ritz_eigen_lambda(m->band_hz[1]);
    int64_t most = m->pairs.Phi.ncol;
    int64_t count = m->last + MORE < most ? m->last + MORE : most;

    while (count < most && (response || m->pairs.lambda[count] < reach))
        count++;
    return count;
}

static void ritz_measuring_free(ritz_measuring *m)
{
    ritz_pairs_free(&m->pairs);
    ritz_lehmann_free(&m->trial);
    ritz_lehmann_free(&m->polished);
    ritz_lehmann_free(&m->rich);
    ritz_enclosure_free(&m->enclosure);
}

/*
 * Rounding of the reduced matrices may hide a rigid motion: what it leaves of
 * such a mode is no frequency, and left out of the band if a count finds the
 * full model's there.
 */
static ritz_status skip_rounded_rigid(ritz_measuring *m)
{
    double slowest = RITZ_MAY_BE_RIGID * ritz_eigen_lambda(m->band_hz[1]);

    while (m->first < m->last) {
        double rounding = m->trial.reduced_rounding[m->first];
        double rho = 2.0 * fmax(rounding, m->trial.rounding[m->first]);

        if (m->pairs.lambda[m->first] > rounding || rho > slowest)
            break;
        if (!ritz_estimator_has_counted(m->estimator, m->first, slowest))
            RITZ_CHECK(count_at(m, fmax(rho, RITZ_COUNT_LEAST * slowest)));
        if (m->refused ||
            !ritz_estimator_has_counted(m->estimator, m->first, slowest))
            break; /* the mode stays */
        m->first++;
    }
    return RITZ_OK;
}

/* What the factor is followed by: solutions for the trial of m vectors, and then
   an inverse iteration of it, or the bounder of responses with its V and E. */
static ritz_foresight foresee_estimates(const ritz_measuring *m, bool response)
{
    const ritz_io *io = &m->estimator->component->io;
    const int64_t count = m->trial.count;
    const int64_t bounder =
        3 * count + 2 * (io->num_inputs + 3 * io->num_outputs);
    const int64_t columns = 4 * count;

    return (ritz_foresight){
        .beside = (int64_t)sizeof(double) * m->estimator->component->num_dofs *
                  (response && bounder > columns ? bounder : columns)};
}

/* X and R of the trial, what they are made of, and K - sigma M. */
static ritz_status admit_trial(const ritz_measuring *m, int64_t count)
{
    enum { ENTRY = sizeof(int64_t) + sizeof(double) };
    const ritz_component *full = m->estimator->component;
    const int64_t column = full->num_dofs * (int64_t)sizeof(double);

    return ritz_memory_admit("the trial space of estimates",
                             3 * count * column +
                                 ENTRY * full->K.colptr[full->num_dofs]);
}

static ritz_status factor_trial(ritz_measuring *m, bool response, double rho)
{
    const ritz_foresight before =
        ritz_memory_foresee(foresee_estimates(m, response));
    const ritz_status status = ritz_estimator_factor(m->estimator, rho);

    (void)ritz_memory_foresee(before);
    return status;
}

/*
 * The trial, and the factor if it is not there yet. That is made after the
 * pairs: they tell where the first count is needed, which is then taken at the
 * same time. If sigma must grow, rounding and residuals are those of the new
 * one.
 */
static ritz_status open_trial(const ritz_basis *basis,
                              const ritz_reduced *reduced, bool response,
                              bool counts, ritz_measuring *m)
{
    ritz_estimator *estimator = m->estimator;
    int64_t count = count_trial(m, response), below = 0;

    if (!estimator->A)
        estimator->sigma =
            -RITZ_ESTIMATE_SHIFT * ritz_eigen_lambda(m->band_hz[1]);
    RITZ_CHECK(estimator->A ? RITZ_OK : admit_trial(m, count));
    for (;;) {
        double rho = nan(""); /* where modes are counted first */

        RITZ_CHECK(ritz_lehmann_new(estimator, &basis->T, reduced, &m->pairs,
                                    count, &m->trial));
        if (counts)
            rho = propose_behind(m, m->last);
        if (is_known(m, rho, &below))
            rho = nan("");
        RITZ_CHECK(factor_trial(m, response, rho));
        if (m->trial.sigma == estimator->sigma)
            return ritz_lehmann_solve(estimator->A, &m->trial);
        ritz_lehmann_free(&m->trial);
    }
}

/* The reduced modes in the band, and the trial that serves them. */
static ritz_status open_measuring(const ritz_basis *basis,
                                  const ritz_reduced *reduced, bool counts,
                                  bool *response, ritz_measuring *m)
{
    ritz_estimator *estimator = m->estimator;

    RITZ_REFUSE_IF(basis->T.nrow != estimator->component->num_dofs ||
                       basis->T.ncol != reduced->K.nrow,
                   RITZ_ERR_ARGUMENT, "the basis is not that of the reduction");
    RITZ_CHECK(ritz_eigen_dense(&reduced->K, &reduced->M, &m->pairs));
    m->T = &basis->T;
    choose_modes(estimator, basis, m);
    *response = *response &&
                ritz_response_boundable(estimator, reduced, m->pairs.Phi.ncol);
    if (!(m->band_hz[1] > 0.0))
        return RITZ_OK;
    RITZ_CHECK(open_trial(basis, reduced, *response, counts, m));
    return skip_rounded_rigid(m);
}

ritz_status ritz_estimator_measure(ritz_estimator *estimator,
                                   const ritz_basis *basis,
                                   const ritz_reduced *reduced, bool least,
                                   ritz_measures *out)
{
    RITZ_OWN(ritz_measuring) m = {.estimator = estimator};
    RITZ_OWN(ritz_measures) found = {0};
    ritz_estimator bare = {0}; /* the same, nothing being counted */
    bool response = !least && !estimator->request.frequencies;

    RITZ_CHECK(open_measuring(basis, reduced, !least, &response, &m));
    if (m.band_hz[1] > 0.0 && least) {
        bare = *estimator;
        bare.num_counts = 0;
        m.estimator = &bare;
        RITZ_CHECK(ritz_measuring_enclose(&m));
        RITZ_CHECK(ritz_measuring_report_least(&m, &found));
    } else if (m.band_hz[1] > 0.0) {
        RITZ_CHECK(refine_all(response, &m));
        RITZ_CHECK(ritz_measuring_report(&m, &found));
        if (response)
            RITZ_CHECK(ritz_bound_response(&m, reduced, &found));
    }
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

ritz_status ritz_estimate(const ritz_component *full, const ritz_basis *basis,
                          const ritz_estimate_request *request,
                          ritz_reduced *reduced)
{
    RITZ_OWN(ritz_estimator) *estimator = NULL;
    RITZ_OWN(ritz_measures) found = {0};

    ritz_monitor_step("estimates", 0, 0);
    RITZ_CHECK(ritz_estimator_new(full, request, &estimator));
    RITZ_CHECK(
        ritz_estimator_measure(estimator, basis, reduced, false, &found));
    ritz_measures_free(&reduced->estimates);
    RITZ_MOVE(reduced->estimates, found);
    return RITZ_OK;
}
