/*
 * How far a reduced model can be off, told by one factor of the full matrices,
 * by the residuals of its modes, and by counts of full modes below some
 * frequencies. Counts and inverse iterations are spent first on the reduced
 * modes in the band, then on what ritz-verify pairs with the full modes in it;
 * what is known then is reported as named numbers. Enclosures are in enclose.c,
 * the choice of counts in count.c, partners in judge.c, responses in response.c.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "estimate/estimator.h"
#include "verify/participation.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Gaps behind the band where a count may show that no mode is missing. */
enum { GAPS = 3 };
/* Most counts for one reduction: some, and some for each mode in the band. */
enum { SOME_COUNTS = 8, COUNTS_A_MODE = 4 };
/* Most inverse iterations, and most counts beside modes, while partners are
   unclear. */
enum { ITERATIONS = 4, MOST_BESIDE = 16 };
/* Most modes that are reported one by one. */
enum { MOST_LISTED = 100 };
enum { MORE = 10 };

/* Take a count; `end` if K - rho M cannot be factored there. */
static ritz_status count_at(ritz_estimator *estimator, double rho, bool *end)
{
    ritz_status status = ritz_estimator_count(estimator, rho);

    *end = status == RITZ_ERR_SINGULAR;
    return *end ? RITZ_OK : status;
}

static ritz_status enclose_modes(const ritz_estimator *estimator,
                                 ritz_measuring *m)
{
    ritz_enclosure_free(&m->enclosure);
    return ritz_enclosure_new(estimator, &m->trial, &m->polished,
                              &m->enclosure);
}

/*
 * Take counts where they help, until every mode's claim is good or enough is
 * spent. Before the first count for a single mode the trial gets an inverse
 * iteration.
 */
static ritz_status refine_modes(ritz_estimator *estimator, ritz_measuring *m)
{
    ritz_status status = RITZ_OK;
    int64_t budget = SOME_COUNTS + COUNTS_A_MODE * (m->reach - m->first);
    ritz_pursuit pursuit = {.first = m->first, .last = m->reach};
    bool end = false;

    RITZ_NEW(pursuit.tries, m->reach - m->first);
    while (!end) {
        double rho = nan("");
        int64_t mode = -1;

        RITZ_TRY(enclose_modes(estimator, m));
        if (budget-- > 0 && estimator->num_counts < RITZ_MOST_COUNTS)
            rho = ritz_propose_count(estimator, &m->trial, &m->enclosure,
                                     &pursuit, &mode);
        if (mode >= 0 && !m->polished.X.val) {
            RITZ_TRY(ritz_lehmann_polish(estimator, &m->trial, &m->polished));
            continue;
        }
        if (mode >= 0)
            pursuit.tries[mode - m->first]++;
        end = isnan(rho);
        if (!end)
            RITZ_TRY(count_at(estimator, rho, &end));
    }
done:
    free(pursuit.tries);
    return status;
}

/* One count far above the band, for responses: the further modes are, the less
   they respond. */
static ritz_status count_above(ritz_estimator *estimator, ritz_measuring *m)
{
    double rho = ritz_propose_above(estimator, &m->trial,
                                    ritz_eigen_lambda(m->band_hz[1]));
    bool end = isnan(rho) || estimator->num_counts == RITZ_MOST_COUNTS;

    if (end)
        return RITZ_OK;
    RITZ_CHECK(count_at(estimator, rho, &end));
    return enclose_modes(estimator, m);
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
static ritz_status count_band(ritz_estimator *estimator, ritz_measuring *m)
{
    double at = 0.0;
    bool end = false;

    for (int64_t gap = 0; gap < GAPS && m->last + gap <= m->pairs.Phi.ncol &&
                          ritz_missing_modes(estimator, m, &at) != 0 && !end &&
                          estimator->num_counts < RITZ_MOST_COUNTS;
         gap++)
        RITZ_CHECK(count_at(estimator, end_of_band(m, gap), &end));
    return RITZ_OK;
}

/* Where intervals do not tell which full modes are in the band, count at its
   ends. */
static ritz_status count_ends(ritz_estimator *estimator, ritz_measuring *m)
{
    double end = ritz_eigen_lambda(m->band_hz[1]);
    bool none = false;

    if ((!m->prediction.counted || m->prediction.edge_unclear) &&
        estimator->num_counts < RITZ_MOST_COUNTS)
        RITZ_CHECK(count_at(estimator, end * (1.0 + RITZ_COUNT_BEHIND), &none));
    if (m->prediction.rigid_unclear && estimator->num_counts < RITZ_MOST_COUNTS)
        RITZ_CHECK(count_at(estimator, RITZ_SURELY_RIGID * end, &none));
    RITZ_CHECK(enclose_modes(estimator, m));
    RITZ_CHECK(ritz_measuring_judge(estimator, m, &m->prediction));
    if (m->prediction.num_full > m->reach)
        m->reach = m->prediction.num_full;
    if (m->reach > m->trial.count)
        m->reach = m->trial.count;
    if (m->reach > m->last) {
        RITZ_CHECK(refine_modes(estimator, m));
        RITZ_CHECK(ritz_measuring_judge(estimator, m, &m->prediction));
    }
    return RITZ_OK;
}

/* One more inverse iteration, of what there is. */
static ritz_status iterate_trial(ritz_estimator *estimator, ritz_measuring *m)
{
    ritz_lehmann next = {0};

    RITZ_CHECK(ritz_lehmann_polish(
        estimator, m->polished.X.val ? &m->polished : &m->trial, &next));
    ritz_lehmann_free(&m->polished);
    m->polished = next;
    return RITZ_OK;
}

/* Count and iterate until the modes of the band are told. */
static ritz_status refine_all(ritz_estimator *estimator, bool response,
                              ritz_measuring *m)
{
    int iterations = 0, counts = 0;

    m->reach = m->last;
    RITZ_CHECK(refine_modes(estimator, m));
    if (response)
        RITZ_CHECK(count_above(estimator, m));
    RITZ_CHECK(count_band(estimator, m));
    RITZ_CHECK(enclose_modes(estimator, m));
    RITZ_CHECK(ritz_measuring_judge(estimator, m, &m->prediction));
    RITZ_CHECK(count_ends(estimator, m));
    while (m->prediction.loose || m->prediction.partner_unclear) {
        bool none = false;

        if (!isnan(m->prediction.count_at) && counts++ < MOST_BESIDE &&
            estimator->num_counts < RITZ_MOST_COUNTS)
            RITZ_CHECK(count_at(estimator, m->prediction.count_at, &none));
        else if (iterations++ < ITERATIONS)
            RITZ_CHECK(iterate_trial(estimator, m));
        else
            break;
        RITZ_CHECK(enclose_modes(estimator, m));
        RITZ_CHECK(ritz_measuring_judge(estimator, m, &m->prediction));
    }
    return RITZ_OK;
}

/* "mode 7, 3.41 Hz", and which of the full model if it is another. */
static void say_where(const ritz_claim *claim, int64_t k, double theta,
                      char where[RITZ_NAME_SIZE])
{
    int used = snprintf(where, RITZ_NAME_SIZE, "mode %" PRId64 ", %.4g Hz",
                        k + 1, ritz_eigen_hertz(theta));
    size_t left = (size_t)(RITZ_NAME_SIZE - used);

    if (claim->full_mode < 0)
        (void)snprintf(where + used, left, ", near some full mode");
    else if (claim->full_mode != k)
        (void)snprintf(where + used, left, ", full mode %" PRId64,
                       claim->full_mode + 1);
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
static ritz_status report_least(const ritz_estimator *estimator,
                                const ritz_measuring *m, ritz_measures *out)
{
    double band = ritz_eigen_lambda(m->band_hz[1]);
    double most = 0.0;
    char where[RITZ_NAME_SIZE] = "";

    for (int64_t k = m->first; k < m->trial.count && m->band_hz[0] == 0.0 &&
                               m->enclosure.high[k] <= band;
         k++) {
        double theta = m->pairs.lambda[k];
        double least = least_of(m, k);

        if (!(least > most) || ritz_counted_rigid(estimator, k, theta, band))
            continue;
        most = least;
        (void)snprintf(where, sizeof where, "mode %" PRId64 ", %.4g Hz", k + 1,
                       ritz_eigen_hertz(theta));
    }
    if (most > 0.0)
        RITZ_CHECK(ritz_measures_add(out, "frequency-relative-least", most,
                                     nan(""), where));
    return RITZ_OK;
}

/* Where no mode is missing: the claim on the full mode of the same number, if
   its interval is known and apart from that of the mode that was claimed. */
static ritz_claim own_claim(const ritz_measuring *m, int64_t k,
                            ritz_claim claim)
{
    const ritz_enclosure *e = &m->enclosure;
    const int64_t p = claim.full_mode;
    double same = ritz_claim_same(&m->trial, e, k, m->pairs.lambda[k]);
    bool apart = e->high[k] < e->low[p] || e->high[p] < e->low[k];

    if (isfinite(same) && apart) {
        claim.bound = same;
        claim.full_mode = k;
    }
    return claim;
}

/* "mode-7" and so on, of the band. */
static ritz_status list_modes(const ritz_estimator *estimator,
                              const ritz_measuring *m, ritz_measures *out)
{
    double band = m->last > 0 ? m->pairs.lambda[m->last - 1] : 0.0;
    double at = 0.0;
    bool complete = ritz_missing_modes(estimator, m, &at) == 0;
    char name[RITZ_NAME_SIZE];
    char where[RITZ_NAME_SIZE];

    for (int64_t k = m->first; k < m->last && out->count < MOST_LISTED; k++) {
        double theta = m->pairs.lambda[k];
        ritz_claim claim = ritz_claim_of(&m->trial, &m->enclosure, k, theta);

        if (ritz_counted_rigid(estimator, k, theta, band))
            continue;
        if (complete && claim.full_mode >= 0 && claim.full_mode != k)
            claim = own_claim(m, k, claim);
        (void)snprintf(name, sizeof name, "mode-%" PRId64, k + 1);
        say_where(&claim, k, theta, where);
        RITZ_CHECK(ritz_measures_add(out, name, claim.bound, nan(""), where));
    }
    return RITZ_OK;
}

/* A value with its place, "mode 7, 3.41 Hz, full mode 8". */
static ritz_status add_pair(const ritz_measuring *m, const char *name,
                            double value, int64_t k, int64_t full_mode,
                            ritz_measures *out)
{
    const ritz_claim claim = {.full_mode = full_mode};
    char where[RITZ_NAME_SIZE];

    say_where(&claim, k, m->pairs.lambda[k], where);
    return ritz_measures_add(out, name, value, nan(""), where);
}

/* Report the worst mode of the band, then each. */
static ritz_status report_modes(const ritz_estimator *estimator,
                                const ritz_measuring *m, ritz_measures *out)
{
    const ritz_prediction *v = &m->prediction;
    RITZ_OWN(ritz_measures) each = {0};

    RITZ_CHECK(list_modes(estimator, m, &each));
    if (!v->counted && (v->any_in_band || each.count > 0))
        RITZ_CHECK(ritz_measures_add(out, "frequency-relative-bound", HUGE_VAL,
                                     nan(""), "modes are not counted"));
    else if (v->bound >= 0.0)
        RITZ_CHECK(add_pair(m, "frequency-relative-bound", v->bound,
                            v->bound_mode, v->bound_full, out));
    if (v->least > 0.0)
        RITZ_CHECK(add_pair(m, "frequency-relative-least", v->least,
                            v->least_mode, v->least_full, out));
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

/* Half of the highest frequency of the basis's columns, or of its modes. */
static double trusted_hertz(const ritz_basis *basis, const ritz_pairs *pairs)
{
    double highest = 0.0;

    for (int64_t k = 0; k < basis->columns.count; k++)
        if (isfinite(basis->columns.hertz[k]))
            highest = fmax(highest, basis->columns.hertz[k]);
    if (highest == 0.0 && pairs->Phi.ncol > 0)
        highest = ritz_eigen_hertz(pairs->lambda[pairs->Phi.ncol - 1]);
    return 0.5 * highest;
}

/* The flexible modes in the band; where no band was asked for, one at least. */
static void choose_modes(const ritz_estimator *estimator,
                         const ritz_basis *basis, ritz_measuring *m)
{
    const ritz_pairs *pairs = &m->pairs;
    const double *asked = estimator->request.band_hz;

    m->band_hz[0] = asked[0];
    m->band_hz[1] = asked[1] > 0.0 ? asked[1] : trusted_hertz(basis, pairs);
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

static void measuring_free(ritz_measuring *m)
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
static ritz_status skip_rounded_rigid(ritz_estimator *estimator,
                                      ritz_measuring *m)
{
    ritz_status status = RITZ_OK;
    double slowest = RITZ_MAY_BE_RIGID * ritz_eigen_lambda(m->band_hz[1]);

    while (m->first < m->last) {
        double rounding = m->trial.reduced_rounding[m->first];
        double rho = 2.0 * fmax(rounding, m->trial.rounding[m->first]);

        if (m->pairs.lambda[m->first] > rounding || rho > slowest)
            break;
        if (!ritz_counted_more(estimator, m->first, slowest)) {
            status = ritz_estimator_count(
                estimator, fmax(rho, RITZ_COUNT_LEAST * slowest));
            if (status == RITZ_ERR_SINGULAR)
                return RITZ_OK; /* it cannot be counted: the mode stays */
            RITZ_TRY(status);
        }
        if (!ritz_counted_more(estimator, m->first, slowest))
            break;
        m->first++;
    }
done:
    return status;
}

/* The reduced modes in the band, and the trial that serves them. */
static ritz_status open_measuring(ritz_estimator *estimator,
                                  const ritz_basis *basis,
                                  const ritz_reduced *reduced, bool *response,
                                  ritz_measuring *m)
{
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
    return skip_rounded_rigid(estimator, m);
}

ritz_status ritz_estimator_measure(ritz_estimator *estimator,
                                   const ritz_basis *basis,
                                   const ritz_reduced *reduced,
                                   ritz_measures *out)
{
    [[gnu::cleanup(measuring_free)]] ritz_measuring m = {0};
    RITZ_OWN(ritz_measures) found = {0};
    bool response = true;

    RITZ_CHECK(open_measuring(estimator, basis, reduced, &response, &m));
    if (m.band_hz[1] > 0.0) {
        RITZ_CHECK(refine_all(estimator, response, &m));
        RITZ_CHECK(report_modes(estimator, &m, &found));
        RITZ_CHECK(report_missing(&m, &found));
        if (response)
            RITZ_CHECK(ritz_bound_response(estimator, &m, reduced, &found));
    }
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

ritz_status ritz_estimator_least(ritz_estimator *estimator,
                                 const ritz_basis *basis,
                                 const ritz_reduced *reduced,
                                 ritz_measures *out)
{
    [[gnu::cleanup(measuring_free)]] ritz_measuring m = {0};
    ritz_estimator bare = {0}; /* the same, nothing being counted */
    bool response = false;

    RITZ_CHECK(open_measuring(estimator, basis, reduced, &response, &m));
    if (m.band_hz[1] > 0.0) {
        bare = *estimator;
        bare.num_counts = 0;
        RITZ_CHECK(
            ritz_enclosure_new(&bare, &m.trial, &m.polished, &m.enclosure));
        RITZ_CHECK(report_least(&bare, &m, out));
    }
    return RITZ_OK;
}

ritz_status ritz_estimate(const ritz_component *full, const ritz_basis *basis,
                          const ritz_estimate_request *request,
                          ritz_reduced *reduced)
{
    RITZ_OWN(ritz_estimator) *estimator = NULL;
    RITZ_OWN(ritz_measures) found = {0};

    RITZ_CHECK(ritz_estimator_new(full, request, &estimator));
    RITZ_CHECK(ritz_estimator_measure(estimator, basis, reduced, &found));
    ritz_measures_free(&reduced->estimates);
    RITZ_MOVE(reduced->estimates, found);
    return RITZ_OK;
}
