/* What was found of a reduced model's modes, as named numbers. */
#include "estimate/estimate_parts.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

enum { MOST_LISTED = 100 };

/* "mode 7, 3.41 Hz", and which of the full model if it is another. */
static void say_where(const ritz_claim *claim, int64_t k, double theta,
                      char where[RITZ_NAME_SIZE])
{
    int used = snprintf(where, RITZ_NAME_SIZE, "mode %" PRId64 ", %.4g Hz",
                        k + 1, ritz_eigen_hertz(theta));
    size_t left = (size_t)(RITZ_NAME_SIZE - used);

    if (claim->number < 0)
        (void)snprintf(where + used, left, ", near some full mode");
    else if (claim->number != k)
        (void)snprintf(where + used, left, ", full mode %" PRId64,
                       claim->number + 1);
}

/*
 * What mode k says of the worst error at least: however the first k full modes
 * are paired with reduced ones, one of them has a partner of number k or more,
 * which is above the highest that mode k of the full model can be.
 */
static double least_of(const ritz_measuring *m, int64_t k)
{
    double theta = m->pairs.lambda[k];
    double rounding = 0.5 * m->trial.reduced[k] / theta;
    double low = fmax(fmin(theta, m->trial.least[k]), 0.0);

    return sqrt(low / m->enclosure.high[k]) - 1.0 - rounding;
}

/*
 * Of full modes that are in the band for certain, wherever their partners lie.
 * Modes below a band need no partner, so nothing is sure of it.
 */
ritz_status ritz_report_least(const ritz_estimator *estimator,
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

/* The same claim of the mode of its own number, if anything is known of it, and
 * that it is another than the one that is claimed: of a cluster any will do. */
static ritz_claim own(const ritz_measuring *m, int64_t k, ritz_claim claim)
{
    const ritz_enclosure *e = &m->enclosure;
    const int64_t p = claim.number;
    double same = ritz_claim_same(&m->trial, e, k, m->pairs.lambda[k]);
    bool apart = e->high[k] < e->low[p] || e->high[p] < e->low[k];

    if (isfinite(same) && apart) {
        claim.bound = same;
        claim.number = k;
    }
    return claim;
}

/* "mode-7" and so on, of the band. */
static ritz_status list_modes(const ritz_estimator *estimator,
                              const ritz_measuring *m, ritz_measures *out)
{
    double band = m->last > 0 ? m->pairs.lambda[m->last - 1] : 0.0;
    double at = 0.0;
    /* where none is missing all are the full model's by their numbers */
    bool complete = ritz_missing_modes(estimator, m, &at) == 0;
    char name[RITZ_NAME_SIZE];
    char where[RITZ_NAME_SIZE];

    for (int64_t k = m->first; k < m->last && out->count < MOST_LISTED; k++) {
        double theta = m->pairs.lambda[k];
        ritz_claim claim = ritz_claim_of(&m->trial, &m->enclosure, k, theta);

        if (ritz_counted_rigid(estimator, k, theta, band))
            continue;
        if (complete && claim.number >= 0 && claim.number != k)
            claim = own(m, k, claim);
        (void)snprintf(name, sizeof name, "mode-%" PRId64, k + 1);
        say_where(&claim, k, theta, where);
        RITZ_CHECK(ritz_measures_add(out, name, claim.bound, nan(""), where));
    }
    return RITZ_OK;
}

/* Of a pair: "mode 7, 3.41 Hz, full mode 8". */
static ritz_status add_pair(const ritz_measuring *m, const char *name,
                            double value, int64_t k, int64_t number,
                            ritz_measures *out)
{
    const ritz_claim claim = {.number = number};
    char where[RITZ_NAME_SIZE];

    say_where(&claim, k, m->pairs.lambda[k], where);
    return ritz_measures_add(out, name, value, nan(""), where);
}

ritz_status ritz_report_modes(const ritz_estimator *estimator,
                              const ritz_measuring *m, ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    const ritz_matched *v = &m->matched;
    ritz_measures each = {0};

    RITZ_TRY(list_modes(estimator, m, &each));
    if (!v->known && (v->any || each.count > 0))
        RITZ_TRY(ritz_measures_add(out, "frequency-relative-bound", HUGE_VAL,
                                   nan(""), "modes are not counted"));
    else if (v->bound >= 0.0)
        RITZ_TRY(add_pair(m, "frequency-relative-bound", v->bound, v->mode,
                          v->number, out));
    if (v->least > 0.0)
        RITZ_TRY(add_pair(m, "frequency-relative-least", v->least,
                          v->least_mode, v->least_number, out));
    for (int64_t k = 0; k < each.count; k++)
        RITZ_TRY(ritz_measures_add(out, each.item[k].name, each.item[k].value,
                                   nan(""), each.item[k].where));
done:
    ritz_measures_free(&each);
    return status;
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

ritz_status ritz_report_missing(const ritz_measuring *m, ritz_measures *out)
{
    const ritz_matched *v = &m->matched;
    char where[RITZ_NAME_SIZE] = "";

    if (!v->known)
        return RITZ_OK;
    if (v->first >= 0)
        (void)snprintf(
            where, sizeof where, "first: full mode %" PRId64 ", below %.4g Hz",
            v->first + 1, ritz_eigen_hertz(m->enclosure.high[v->first]));
    return ritz_measures_add(out, "missing-modes-bound", (double)v->missing,
                             nan(""), where);
}
