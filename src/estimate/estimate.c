/*
 * How far a reduced model can be off, found from one factor of the full
 * matrices, the residuals of its modes, and counts of full modes below some
 * frequencies. Counts and inverse iterations are spent first on the reduced
 * modes in the band, then on those that ritz-verify pairs with the full modes
 * in it; the bounds reached then are reported as named numbers. Enclosures are
 * in enclose.c, the choice of counts in count.c, partners in judge.c, responses
 * in response.c.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "estimate/estimator.h"
#include "verify/sides.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Gaps behind the band where a count may show that no mode is missing. */
enum { GAPS = 3 };
/* Most counts for one reduction: some, and some for each mode in the band. */
enum { SOME_COUNTS = 8, COUNTS_A_MODE = 4 };
/* Most inverse iterations, and most counts next to modes, while partners are
   unclear. */
enum { ITERATIONS = 4, MOST_BESIDE = 16 };
/* Most modes that are reported one by one. */
enum { MOST_LISTED = 100 };
enum { MORE = 10 };

/* Take a count; `end` if K - rho M cannot be factored there. */
static ritz_status count_at(const ritz_measuring *m, double rho, bool *end)
{
    ritz_status status = ritz_estimator_count(m->estimator, rho);

    *end = status == RITZ_ERR_SINGULAR;
    return *end ? RITZ_OK : status;
}

static bool has_room(const ritz_measuring *m)
{
    return m->estimator->num_counts < RITZ_MOST_COUNTS;
}

static ritz_status enclose_modes(ritz_measuring *m)
{
    ritz_enclosure_free(&m->enclosure);
    return ritz_enclosure_new(m, &m->enclosure);
}

static ritz_status predict_errors(ritz_measuring *m)
{
    RITZ_CHECK(enclose_modes(m));
    return ritz_measuring_predict(m, &m->prediction);
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
    bool end = false;

    RITZ_CHECK_NEW(tries, m->reach - m->first);
    while (!end) {
        double rho = nan("");
        int64_t mode = -1;

        RITZ_CHECK(enclose_modes(m));
        if (budget-- > 0 && has_room(m))
            rho = ritz_propose_count(m, tries, &mode);
        if (mode >= 0 && !m->polished.X.val) {
            RITZ_CHECK(
                ritz_lehmann_polish(m->estimator, &m->trial, &m->polished));
            continue;
        }
        if (mode >= 0)
            tries[mode - m->first]++;
        end = isnan(rho);
        if (!end)
            RITZ_CHECK(count_at(m, rho, &end));
    }
    return RITZ_OK;
}

/* One count far above the band, for responses: the further modes are, the less
   they respond. */
static ritz_status count_above(ritz_measuring *m)
{
    double rho = ritz_propose_above(m);
    bool end = false;

    return isnan(rho) || !has_room(m) ? RITZ_OK : count_at(m, rho, &end);
}

/* Where to count for missing modes: at the band's end, or in a gap behind. */
static double end_of_band(const ritz_measuring *m, int64_t gap)
{
    double end = ritz_eigen_lambda(m->band_hz[1]) * (1.0 + DBL_EPSILON);
    int64_t above = m->last + gap;
    double low = above > 0 ? m->pairs.lambda[above - 1] : 0.0;
    double high = above < m->pairs.Phi.ncol ? m->pairs.lambda[above] : end;

    return gap == 0 ? end : fmax(end, low + 0.3 * (high - low));
}

/*
 * Unless it is known that none is missing, count at the end of the band, and in
 * the next gaps, where the partners of the last modes may be.
 */
static ritz_status count_band(ritz_measuring *m)
{
    bool end = false;

    for (int64_t gap = 0; gap < GAPS && m->last + gap <= m->pairs.Phi.ncol &&
                          ritz_missing_modes(m) != 0 && !end && has_room(m);
         gap++)
        RITZ_CHECK(count_at(m, end_of_band(m, gap), &end));
    return RITZ_OK;
}

/* Where intervals do not tell which full modes are in the band, count at its
   ends. */
static ritz_status count_ends(ritz_measuring *m)
{
    double end = ritz_eigen_lambda(m->band_hz[1]);
    bool none = false;

    if ((!m->prediction.counted || m->prediction.edge_unclear) && has_room(m))
        RITZ_CHECK(count_at(m, end * (1.0 + RITZ_COUNT_BEHIND), &none));
    if (m->prediction.rigid_unclear && has_room(m))
        RITZ_CHECK(count_at(m, RITZ_SURELY_RIGID * end, &none));
    RITZ_CHECK(predict_errors(m));
    if (m->prediction.num_full > m->reach)
        m->reach = m->prediction.num_full;
    if (m->reach > m->trial.count)
        m->reach = m->trial.count;
    if (m->reach <= m->last)
        return RITZ_OK;
    RITZ_CHECK(refine_modes(m));
    return ritz_measuring_predict(m, &m->prediction);
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
        bool none = false;

        if (!isnan(m->prediction.count_at) && counts++ < MOST_BESIDE &&
            has_room(m))
            RITZ_CHECK(count_at(m, m->prediction.count_at, &none));
        else if (iterations++ < ITERATIONS)
            RITZ_CHECK(iterate_trial(m));
        else
            break;
        RITZ_CHECK(predict_errors(m));
    }
    return RITZ_OK;
}

/* Add a value with its place, "mode 7, 3.41 Hz, full mode 8". */
static ritz_status add_mode(const ritz_measuring *m, const char *name,
                            ritz_pair_error found, ritz_measures *out)
{
    char other[RITZ_NAME_SIZE] = "", where[2 * RITZ_NAME_SIZE];

    if (found.full_mode < 0)
        (void)snprintf(other, sizeof other, ", near some full mode");
    else if (found.full_mode != found.mode)
        (void)snprintf(other, sizeof other, ", full mode %" PRId64,
                       found.full_mode + 1);
    (void)snprintf(where, sizeof where, "mode %" PRId64 ", %.4g Hz%s",
                   found.mode + 1,
                   ritz_eigen_hertz(m->pairs.lambda[found.mode]), other);
    return ritz_measures_add(out, name, found.value, nan(""), where);
}

/*
 * A lower bound of the worst error from mode k: however the first k full modes
 * are paired, one of them has a reduced partner of number k or more, whose
 * frequency is above the highest that full mode k can have.
 */
static double least_of(const ritz_measuring *m, int64_t k)
{
    double theta = m->pairs.lambda[k];
    double rounding = 0.5 * m->trial.reduced_rounding[k] / theta;
    double low = fmax(fmin(theta, m->trial.reduced_low[k]), 0.0);

    return sqrt(low / m->enclosure.high[k]) - 1.0 - rounding;
}

/*
 * The largest of these over full modes that are certainly in the band. Nothing
 * can be said of a band that does not begin at 0, as modes below it need no
 * partner.
 */
static ritz_status report_least(const ritz_measuring *m, ritz_measures *out)
{
    double band = ritz_eigen_lambda(m->band_hz[1]);
    ritz_pair_error most = {0};

    for (int64_t k = m->first; k < m->trial.count && m->band_hz[0] == 0.0 &&
                               m->enclosure.high[k] <= band;
         k++) {
        double least = least_of(m, k);

        if (least > most.value &&
            !ritz_counted_rigid(m->estimator, k, m->pairs.lambda[k], band))
            most = (ritz_pair_error){least, k, k};
    }
    return most.value > 0.0 ? add_mode(m, "frequency-relative-least", most, out)
                            : RITZ_OK;
}

/* Where no mode is missing: the claim on the full mode of the same number, if
   its interval is known and disjoint from that of the mode that was claimed. */
static void prefer_same(const ritz_measuring *m, ritz_pair_error *claim)
{
    const ritz_enclosure *e = &m->enclosure;
    const int64_t p = claim->full_mode, k = claim->mode;
    double same = ritz_claim_same(m, k);

    if (isfinite(same) && (e->high[k] < e->low[p] || e->high[p] < e->low[k]))
        *claim = (ritz_pair_error){same, k, k};
}

/* "mode-7" and so on, of the band. */
static ritz_status list_modes(const ritz_measuring *m, ritz_measures *out)
{
    double band = m->last > 0 ? m->pairs.lambda[m->last - 1] : 0.0;
    bool complete = ritz_missing_modes(m) == 0;
    char name[RITZ_NAME_SIZE];

    for (int64_t k = m->first; k < m->last && out->count < MOST_LISTED; k++) {
        ritz_claim claim = ritz_claim_of(m, k);
        ritz_pair_error found = {claim.bound, k, claim.full_mode};

        if (ritz_counted_rigid(m->estimator, k, m->pairs.lambda[k], band))
            continue;
        if (complete && claim.full_mode >= 0 && claim.full_mode != k)
            prefer_same(m, &found);
        (void)snprintf(name, sizeof name, "mode-%" PRId64, k + 1);
        RITZ_CHECK(add_mode(m, name, found, out));
    }
    return RITZ_OK;
}

/* Report the worst mode of the band, then each. */
static ritz_status report_modes(const ritz_measuring *m, ritz_measures *out)
{
    const ritz_prediction *v = &m->prediction;
    RITZ_OWN(ritz_measures) each = {0};

    RITZ_CHECK(list_modes(m, &each));
    if (!v->counted && (v->any_in_band || each.count > 0))
        RITZ_CHECK(ritz_measures_add(out, "frequency-relative-bound", HUGE_VAL,
                                     nan(""), "modes are not counted"));
    else if (v->bound.value >= 0.0)
        RITZ_CHECK(add_mode(m, "frequency-relative-bound", v->bound, out));
    if (v->least.value > 0.0)
        RITZ_CHECK(add_mode(m, "frequency-relative-least", v->least, out));
    for (int64_t k = 0; k < each.count; k++)
        RITZ_CHECK(ritz_measures_add(out, each.item[k].name, each.item[k].value,
                                     nan(""), each.item[k].where));
    return RITZ_OK;
}

static ritz_status report_missing(const ritz_measuring *m, ritz_measures *out)
{
    const ritz_prediction *v = &m->prediction;
    char where[RITZ_NAME_SIZE] = "";

    if (!v->counted)
        return RITZ_OK;
    if (v->first_missing >= 0)
        (void)snprintf(where, sizeof where,
                       "first: full mode %" PRId64 ", below %.4g Hz",
                       v->first_missing + 1,
                       ritz_eigen_hertz(m->enclosure.high[v->first_missing]));
    return ritz_measures_add(out, "missing-modes-bound", (double)v->num_missing,
                             nan(""), where);
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
    bool end = false;

    while (m->first < m->last) {
        double rounding = m->trial.reduced_rounding[m->first];
        double rho = 2.0 * fmax(rounding, m->trial.rounding[m->first]);

        if (m->pairs.lambda[m->first] > rounding || rho > slowest)
            break;
        if (!ritz_counted_more(m->estimator, m->first, slowest))
            RITZ_CHECK(
                count_at(m, fmax(rho, RITZ_COUNT_LEAST * slowest), &end));
        if (end || !ritz_counted_more(m->estimator, m->first, slowest))
            break; /* the mode stays */
        m->first++;
    }
    return RITZ_OK;
}

/* The reduced modes in the band, and the trial that serves them. */
static ritz_status open_measuring(const ritz_basis *basis,
                                  const ritz_reduced *reduced, bool *response,
                                  ritz_measuring *m)
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
    RITZ_CHECK(ritz_estimator_open(
        estimator, -RITZ_ESTIMATE_SHIFT * ritz_eigen_lambda(m->band_hz[1])));
    RITZ_CHECK(ritz_lehmann_new(estimator, &basis->T, reduced, &m->pairs,
                                count_trial(m, *response), &m->trial));
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
    bool response = !least;

    RITZ_CHECK(open_measuring(basis, reduced, &response, &m));
    if (m.band_hz[1] > 0.0 && least) {
        bare = *estimator;
        bare.num_counts = 0;
        m.estimator = &bare;
        RITZ_CHECK(enclose_modes(&m));
        RITZ_CHECK(report_least(&m, &found));
    } else if (m.band_hz[1] > 0.0) {
        RITZ_CHECK(refine_all(response, &m));
        RITZ_CHECK(report_modes(&m, &found));
        RITZ_CHECK(report_missing(&m, &found));
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

    RITZ_CHECK(ritz_estimator_new(full, request, &estimator));
    RITZ_CHECK(
        ritz_estimator_measure(estimator, basis, reduced, false, &found));
    ritz_measures_free(&reduced->estimates);
    RITZ_MOVE(reduced->estimates, found);
    return RITZ_OK;
}
