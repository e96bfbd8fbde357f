/*
 * Where counts and inverse iterations are spent: on the reduced modes in the
 * band, then on what verify pairs with the full modes in it.
 */
#include "estimate/estimate_parts.h"

#include "base/alloc.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

enum { GAPS = 3 };
/* Counts that one reduction may ask for: some, and some for each mode. */
enum { SOME_COUNTS = 8, COUNTS_A_MODE = 4 };
/* Inverse iterations that full modes without a partner may ask for. */
enum { ITERATIONS = 4, MOST_BESIDE = 16 };
/* Behind the end of the band, in lambda: further than verify counts to it. */
static const double behind = 8e-9;
/* Of the band, in lambda: what is below is a rigid motion. */
static const double slow = 0.5e-6;

/* Count there; what cannot be factored is not counted. */
static ritz_status count_at(ritz_estimator *estimator, double rho, bool *end)
{
    ritz_status status = ritz_estimator_count(estimator, rho);

    *end = status == RITZ_ERR_SINGULAR;
    return *end ? RITZ_OK : status;
}

/*
 * Count where it helps, until every mode is told or enough is spent; but an
 * inverse iteration helps first.
 */
static ritz_status refine(ritz_estimator *estimator, ritz_measuring *m)
{
    ritz_status status = RITZ_OK;
    int64_t budget = SOME_COUNTS + COUNTS_A_MODE * (m->reach - m->first);
    ritz_pursuit pursuit = {.first = m->first, .last = m->reach};
    bool end = false;

    RITZ_NEW(pursuit.tries, m->reach - m->first);
    while (!end) {
        double rho = nan("");
        int64_t mode = -1;

        ritz_enclosure_free(&m->enclosure);
        RITZ_TRY(ritz_enclosure_new(estimator, &m->trial, &m->polished,
                                    &m->enclosure));
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

/* One more far above the band: the further, the less the rest answers. */
static ritz_status count_above(ritz_estimator *estimator, ritz_measuring *m)
{
    double rho = ritz_propose_above(estimator, &m->trial,
                                    ritz_eigen_lambda(m->band_hz[1]));
    bool end = isnan(rho) || estimator->num_counts == RITZ_MOST_COUNTS;

    if (end)
        return RITZ_OK;
    RITZ_CHECK(count_at(estimator, rho, &end));
    ritz_enclosure_free(&m->enclosure);
    return ritz_enclosure_new(estimator, &m->trial, &m->polished,
                              &m->enclosure);
}

/* Where to count modes of the band: at its end, or in a gap behind. */
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

static ritz_status enclose(const ritz_estimator *estimator, ritz_measuring *m)
{
    ritz_enclosure_free(&m->enclosure);
    return ritz_enclosure_new(estimator, &m->trial, &m->polished,
                              &m->enclosure);
}

/* Which full modes are in the band is told by a count at its end. */
static ritz_status count_ends(ritz_estimator *estimator, ritz_measuring *m)
{
    double end = ritz_eigen_lambda(m->band_hz[1]);
    bool none = false;

    if ((!m->matched.known || m->matched.astride) &&
        estimator->num_counts < RITZ_MOST_COUNTS)
        RITZ_CHECK(count_at(estimator, end * (1.0 + behind), &none));
    if (m->matched.slow && estimator->num_counts < RITZ_MOST_COUNTS)
        RITZ_CHECK(count_at(estimator, slow * end, &none));
    RITZ_CHECK(enclose(estimator, m));
    RITZ_CHECK(ritz_measuring_judge(estimator, m, &m->matched));
    if (m->matched.full > m->reach)
        m->reach = m->matched.full;
    if (m->reach > m->trial.count)
        m->reach = m->trial.count;
    if (m->reach > m->last) {
        RITZ_CHECK(refine(estimator, m));
        RITZ_CHECK(ritz_measuring_judge(estimator, m, &m->matched));
    }
    return RITZ_OK;
}

/* One more inverse iteration, of what there is. */
static ritz_status iterate(ritz_estimator *estimator, ritz_measuring *m)
{
    ritz_lehmann next = {0};

    RITZ_CHECK(ritz_lehmann_polish(
        estimator, m->polished.X.val ? &m->polished : &m->trial, &next));
    ritz_lehmann_free(&m->polished);
    m->polished = next;
    return RITZ_OK;
}

ritz_status ritz_measuring_refine(ritz_estimator *estimator, bool response,
                                  ritz_measuring *m)
{
    int iterations = 0, counts = 0;

    m->reach = m->last;
    RITZ_CHECK(refine(estimator, m));
    if (response)
        RITZ_CHECK(count_above(estimator, m));
    RITZ_CHECK(count_band(estimator, m));
    RITZ_CHECK(enclose(estimator, m));
    RITZ_CHECK(ritz_measuring_judge(estimator, m, &m->matched));
    RITZ_CHECK(count_ends(estimator, m));
    while (m->matched.open || m->matched.unsettled) {
        bool none = false;

        if (!isnan(m->matched.rho) && counts++ < MOST_BESIDE &&
            estimator->num_counts < RITZ_MOST_COUNTS)
            RITZ_CHECK(count_at(estimator, m->matched.rho, &none));
        else if (iterations++ < ITERATIONS)
            RITZ_CHECK(iterate(estimator, m));
        else
            break;
        RITZ_CHECK(enclose(estimator, m));
        RITZ_CHECK(ritz_measuring_judge(estimator, m, &m->matched));
    }
    return RITZ_OK;
}
