/*
 * Enclosures of eigenvalues by Lehmann's method with Goerisch's choice of norm.
 * Y = A^1/2 X Theta_t^-1/2, theta_t = theta - sigma, is orthonormal and
 *
 *     Y'SY = diag(k_j) = Theta_t^-1,   Y'S^2 Y = diag(k_j)^2 + G^,
 *     G^_ij = G_ij / (t_i t_j)^3/2,    G = R'A^-1 R
 *
 * so that nothing cancels where residuals are small. Let N eigenvalues kappa of
 * S be above kappa_rho, as an inertia count says. (S - kappa_rho)^-1 has N
 * positive eigenvalues, and in the range of (S - kappa_rho) Y the Ritz values
 * tau of
 *
 *     D z = tau (D^2 + G^) z,   D = diag(k_j - kappa_rho)
 *
 * which are below them: the i-th least of n positive ones gives
 *
 *     kappa_(N - n + i) <= kappa_rho + 1 / tau_i
 *
 * and the i-th most negative of the others kappa_(N + i) >= the same. To first
 * order kappa_k is overestimated by G^_kk / (k_k - kappa_rho), and because
 *
 *     kappa_k >= eigenvalue k of X'M A^-1 M X = Theta_t^-1 + G / (t_i t_j)
 *
 * it is in error by G^_kk / k_k at least: bound over error is no more than
 * k_k / (k_k - kappa_rho), nearly, which is what makes a good rho.
 *
 * [Lehmann1963], [BeattieGoerisch1995]
 */
#include "verify/estimate_parts.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>

/* Of the rounding of eigenvalues beside: how far a count may be off. */
static const double margin = 2.0;
/* A bound that says nothing: 100 %. */
static const double worthless = 1.0;
/* The mode of the same number is preferred to another one that is nearer. */
static const double favour = 4.0;

static double shifted(const ritz_lehmann *trial, int64_t j)
{
    return trial->theta[j] - trial->sigma;
}

/* 1 / (kappa_rho + 1 / tau) + sigma; infinite if that kappa is not positive. */
static double eigenvalue(double kappa, double sigma)
{
    return kappa > 0.0 ? 1.0 / kappa + sigma : HUGE_VAL;
}

/* tau of all Ritz values, ascending. */
static ritz_status ritz_values(const ritz_lehmann *trial, double kappa_rho,
                               ritz_pairs *out)
{
    ritz_status status = RITZ_OK;
    int64_t m = trial->count;
    ritz_dense D = {0};
    ritz_dense D2 = {0};

    RITZ_TRY(ritz_dense_new(m, m, &D));
    RITZ_TRY(ritz_dense_new(m, m, &D2));
    for (int64_t j = 0; j < m; j++) {
        double t_j = shifted(trial, j);
        double d = 1.0 / t_j - kappa_rho;
        double rounded = trial->rounding[j] / (t_j * t_j);

        for (int64_t i = 0; i < m; i++) {
            double t = shifted(trial, i) * t_j;

            ritz_dense_col(&D2, j)[i] =
                ritz_dense_col(&trial->G, j)[i] / (t * sqrt(t));
        }
        ritz_dense_col(&D, j)[j] = d;
        ritz_dense_col(&D2, j)[j] += d * d + rounded * rounded;
    }
    RITZ_TRY(ritz_eigen_dense(&D, &D2, out));
done:
    ritz_dense_free(&D);
    ritz_dense_free(&D2);
    return status;
}

/* Rounding of the trial's modes up to about rho. */
static double rounding_at(const ritz_lehmann *trial, double rho)
{
    double most = 0.0;

    for (int64_t j = 0; j < trial->count; j++)
        if (j == 0 || trial->theta[j] <= 2.0 * rho)
            most = fmax(most, trial->rounding[j]);
    return most;
}

/* What one count says of eigenvalues above it, or below it. */
static ritz_status enclose(const ritz_lehmann *trial,
                           const ritz_counted *counted, bool above,
                           ritz_enclosure *e)
{
    ritz_status status = RITZ_OK;
    double off = margin * rounding_at(trial, counted->rho);
    double rho = counted->rho + (above ? off : -off);
    double kappa_rho = 1.0 / (rho - trial->sigma);
    int64_t positive = 0;
    ritz_pairs tau = {0};

    RITZ_TRY(ritz_values(trial, kappa_rho, &tau));
    while (positive < tau.Phi.ncol &&
           !(tau.lambda[tau.Phi.ncol - 1 - positive] <= 0.0))
        positive++;
    for (int64_t i = 0; !above && i < positive; i++) {
        int64_t p = counted->below - positive + i;
        double inverse = 1.0 / tau.lambda[tau.Phi.ncol - positive + i];
        double low = eigenvalue(kappa_rho + inverse, trial->sigma);

        if (p >= 0 && p < e->count)
            e->low[p] = fmax(e->low[p], low - trial->rounding[i]);
    }
    for (int64_t i = 0; above && i < tau.Phi.ncol - positive; i++) {
        int64_t p = counted->below + i;
        int64_t j =
            (int64_t)fmin((double)(positive + i), (double)(trial->count - 1));
        double high = eigenvalue(kappa_rho + 1.0 / tau.lambda[i], trial->sigma);

        if (p < e->count)
            e->high[p] = fmin(e->high[p], high + trial->rounding[j]);
    }
done:
    ritz_pairs_free(&tau);
    return status;
}

/* Upper bounds: of Ritz, and of one inverse iteration. */
static ritz_status improve(const ritz_lehmann *trial, ritz_enclosure *e)
{
    ritz_status status = RITZ_OK;
    int64_t m = trial->count;
    ritz_dense S = {0};
    ritz_dense one = {0};
    ritz_pairs kappa = {0};

    RITZ_TRY(ritz_dense_new(m, m, &S));
    RITZ_TRY(ritz_dense_new(m, m, &one));
    for (int64_t j = 0; j < m; j++) {
        for (int64_t i = 0; i < m; i++)
            ritz_dense_col(&S, j)[i] = ritz_dense_col(&trial->G, j)[i] /
                                       (shifted(trial, i) * shifted(trial, j));
        ritz_dense_col(&S, j)[j] += 1.0 / shifted(trial, j);
        ritz_dense_col(&one, j)[j] = 1.0;
    }
    RITZ_TRY(ritz_eigen_dense(&S, &one, &kappa));
    for (int64_t k = 0; k < m; k++) {
        double better = fmin(trial->theta[k],
                             eigenvalue(kappa.lambda[m - 1 - k], trial->sigma));

        e->high[k] = fmin(e->high[k], better + trial->rounding[k]);
    }
done:
    ritz_dense_free(&S);
    ritz_dense_free(&one);
    ritz_pairs_free(&kappa);
    return status;
}

/* What counts alone say, and that both ends ascend. */
static void settle(const ritz_estimator *estimator, const ritz_lehmann *trial,
                   ritz_enclosure *e)
{
    for (int64_t s = 0; s < estimator->num_counts; s++) {
        double rho = estimator->count[s].rho;
        double off = margin * rounding_at(trial, rho);

        for (int64_t p = 0; p < e->count; p++) {
            if (p >= estimator->count[s].below)
                e->low[p] = fmax(e->low[p], rho - off);
            else
                e->high[p] = fmin(e->high[p], rho + off);
        }
    }
    for (int64_t p = 1; p < e->count; p++)
        e->low[p] = fmax(e->low[p], e->low[p - 1]);
    for (int64_t p = e->count - 2; p >= 0; p--)
        e->high[p] = fmin(e->high[p], e->high[p + 1]);
}

/* What a trial says with each count. */
static ritz_status add_trial(const ritz_estimator *estimator,
                             const ritz_lehmann *trial, ritz_enclosure *e)
{
    ritz_status status = RITZ_OK;
    const ritz_counted *counted = estimator->count;

    RITZ_TRY(improve(trial, e));
    for (int64_t s = 0; s < estimator->num_counts; s++) {
        int64_t below = 0;

        while (below < trial->count && trial->theta[below] < counted[s].rho)
            below++;
        if (below > 0)
            RITZ_TRY(enclose(trial, &counted[s], false, e));
        if (below < trial->count && counted[s].below > below)
            RITZ_TRY(enclose(trial, &counted[s], true, e));
    }
done:
    return status;
}

ritz_status ritz_enclosure_new(const ritz_estimator *estimator,
                               const ritz_lehmann *trial,
                               const ritz_lehmann *polished,
                               ritz_enclosure *out)
{
    ritz_status status = RITZ_OK;
    ritz_enclosure e = {.count = trial->count};
    const ritz_counted *counted = estimator->count;

    for (int64_t s = 0; s < estimator->num_counts; s++)
        if (counted[s].below > e.count)
            e.count = counted[s].below;
    e.count++; /* the next one, of which counts may say something */
    RITZ_NEW(e.low, e.count);
    RITZ_NEW(e.high, e.count);
    for (int64_t p = 0; p < e.count; p++)
        e.high[p] = HUGE_VAL;
    RITZ_TRY(add_trial(estimator, trial, &e));
    RITZ_TRY(add_trial(estimator, polished, &e));
    settle(estimator, trial, &e);
    *out = e;
    e = (ritz_enclosure){0};
done:
    ritz_enclosure_free(&e);
    return status;
}

void ritz_enclosure_free(ritz_enclosure *enclosure)
{
    free(enclosure->low);
    free(enclosure->high);
    *enclosure = (ritz_enclosure){0};
}

/* Largest |f' - f| / f, f' of theta and f of [low, high]. */
static double apart(double theta, double low, double high)
{
    if (!(low > 0.0))
        return HUGE_VAL;
    return fmax(sqrt(theta / low) - 1.0, 1.0 - sqrt(theta / high));
}

/* Some kappa is within eps of that of theta, eps = |R|_(A^-1) / |x|_A. */
static double by_residual(const ritz_lehmann *trial, int64_t k, double theta)
{
    double t = shifted(trial, k);
    double eps = sqrt(fmax(ritz_dense_col(&trial->G, k)[k], 0.0) / t);
    double low = t / (1.0 + eps) + trial->sigma - trial->rounding[k];
    double high = t / (1.0 - eps) + trial->sigma + trial->rounding[k];

    return apart(theta, low, eps < 1.0 ? high : HUGE_VAL);
}

ritz_claim ritz_claim_of(const ritz_lehmann *trial,
                         const ritz_enclosure *enclosure, int64_t k,
                         double theta)
{
    ritz_claim claim = {.bound = HUGE_VAL, .number = k};
    double rounding = 0.5 * trial->reduced[k] / theta;
    double residual = by_residual(trial, k, theta);
    double same = apart(theta, enclosure->low[k], enclosure->high[k]);

    for (int64_t p = 0; p < enclosure->count; p++) {
        double bound = apart(theta, enclosure->low[p], enclosure->high[p]);

        if (bound < claim.bound) {
            claim.bound = bound;
            claim.number = p;
        }
    }
    if (same <= favour * claim.bound) {
        claim.bound = same;
        claim.number = k;
    }
    if (claim.bound > worthless && residual < claim.bound) {
        claim.bound = residual;
        claim.number = -1;
    }
    claim.bound = fmax(claim.bound, 0.0) + rounding;
    claim.least = 0.5 * ritz_dense_col(&trial->G, k)[k] /
                  (shifted(trial, k) * fabs(trial->theta[k]));
    return claim;
}
