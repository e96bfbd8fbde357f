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
#include "estimate/estimate_parts.h"

#include <math.h>

/* The mode of the same number is preferred to another one that is nearer. */
static const double favour = 4.0;
/* Of the band, in lambda: what rounding hides below is a rigid motion. */
static const double as_rigid = 1e-6;

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

double ritz_claim_apart(const ritz_measuring *m, int64_t k, double low,
                        double high)
{
    double least = bounded_by(m, m->trial.least, k, -1.0);
    double most = bounded_by(m, m->trial.most, k, 1.0);

    if (!(low > 0.0))
        return HUGE_VAL;
    return fmax(0.0, fmax(sqrt(most / low) - 1.0, 1.0 - sqrt(least / high)));
}

double ritz_claim_between(const ritz_measuring *m, int64_t k, double low,
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

ritz_status ritz_skip_rounded(ritz_estimator *estimator, ritz_measuring *m)
{
    ritz_status status = RITZ_OK;
    double slowest = as_rigid * ritz_eigen_lambda(m->band_hz[1]);

    while (m->first < m->last) {
        double rounding = m->trial.reduced[m->first];
        double rho = 2.0 * fmax(rounding, m->trial.rounding[m->first]);

        if (m->pairs.lambda[m->first] > rounding || rho > slowest)
            break;
        if (!ritz_counted_more(estimator, m->first, slowest)) {
            status = ritz_estimator_count(estimator, fmax(rho, 1e-3 * slowest));
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
