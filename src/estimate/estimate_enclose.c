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
#include "estimate/estimate_parts.h"

#include "base/alloc.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Of the rounding of eigenvalues beside: how far a count may be off. */
static const double margin = 2.0;
/* Of eigenvalues, in eps of the largest. */
static const double roundings = 4.0;

static double shifted(const ritz_lehmann *trial, int64_t j)
{
    return trial->theta[j] - trial->sigma;
}

/* 1 / (kappa_rho + 1 / tau) + sigma; infinite if that kappa is not positive. */
static double eigenvalue(double kappa, double sigma)
{
    return kappa > 0.0 ? 1.0 / kappa + sigma : HUGE_VAL;
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

/* Of eigenvalues of a dense matrix. */
static double rounding_of(const ritz_pairs *nu)
{
    int64_t count = nu->Phi.ncol;

    return count > 0 ? roundings * DBL_EPSILON *
                           fmax(fabs(nu->lambda[0]), nu->lambda[count - 1])
                     : 0.0;
}

/*
 * What one count says of full modes below it: least is carried down, as modes
 * that rounding may exchange share it.
 */
static void enclose_below(const ritz_lehmann *trial, const ritz_pairs *nu,
                          double kappa_rho, int64_t below, ritz_enclosure *e)
{
    int64_t count = nu->Phi.ncol;
    int64_t first = 0;
    double off = rounding_of(nu);
    double least = HUGE_VAL;

    while (first < count && nu->lambda[first] <= 0.0)
        first++;
    for (int64_t at = first; at < count; at++) {
        int64_t p = below - 1 - (at - first);
        double kappa = kappa_rho + nu->lambda[at] + off;

        least = fmin(least, eigenvalue(kappa, trial->sigma) -
                                trial->rounding[count - 1 - at]);
        if (p >= 0 && p < e->count)
            e->low[p] = fmax(e->low[p], least);
    }
}

/* The same of modes above it: most is carried up. */
static void enclose_above(const ritz_lehmann *trial, const ritz_pairs *nu,
                          double kappa_rho, int64_t below, ritz_enclosure *e)
{
    int64_t count = nu->Phi.ncol;
    int64_t last = count - 1;
    double off = rounding_of(nu);
    double most = 0.0;

    while (last >= 0 && nu->lambda[last] > 0.0)
        last--;
    for (int64_t at = last; at >= 0; at--) {
        int64_t p = below + (last - at);
        double kappa = kappa_rho + nu->lambda[at] - off;

        most = fmax(most, eigenvalue(kappa, trial->sigma) +
                              trial->rounding[count - 1 - at]);
        if (p < e->count)
            e->high[p] = fmin(e->high[p], most);
    }
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
    ritz_pairs nu = {0};

    if (!(kappa_rho > 0.0))
        return RITZ_OK;
    RITZ_TRY(ritz_lehmann_values(trial, rho, &nu));
    if (above)
        enclose_above(trial, &nu, kappa_rho, counted->below, e);
    else
        enclose_below(trial, &nu, kappa_rho, counted->below, e);
done:
    ritz_pairs_free(&nu);
    return status;
}

/* Upper bounds: of Ritz, and of one inverse iteration. */
static ritz_status improve(const ritz_lehmann *trial, ritz_enclosure *e)
{
    ritz_status status = RITZ_OK;
    int64_t m = trial->count;
    double off = 0.0;
    double most = 0.0;
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
    off = rounding_of(&kappa);
    for (int64_t k = 0; k < kappa.Phi.ncol; k++) {
        double better =
            fmin(trial->theta[k],
                 eigenvalue(kappa.lambda[kappa.Phi.ncol - 1 - k] - off,
                            trial->sigma));

        most = fmax(most, better + trial->rounding[k]);
        e->high[k] = fmin(e->high[k], most);
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
    const ritz_counted *counted = estimator->count;

    RITZ_CHECK(improve(trial, e));
    for (int64_t s = 0; s < estimator->num_counts; s++) {
        int64_t below = 0;

        while (below < trial->count && trial->theta[below] < counted[s].rho)
            below++;
        if (below > 0)
            RITZ_CHECK(enclose(trial, &counted[s], false, e));
        if (below < trial->count && counted[s].below > below)
            RITZ_CHECK(enclose(trial, &counted[s], true, e));
    }
    return RITZ_OK;
}

/* Some kappa is within eps / t of 1 / t, eps = |R|_(A^-1) / |x|_A. */
static void add_near(const ritz_lehmann *trial, ritz_enclosure *e)
{
    for (int64_t k = 0; k < trial->count; k++) {
        double t = shifted(trial, k);
        double eps = sqrt(fmax(ritz_dense_col(&trial->G, k)[k], 0.0) / t);
        int64_t at = e->num_near++;

        e->near_high[at] = HUGE_VAL;
        if (!(eps < 1.0)) /* it may be the kappa = 0 of no mass */
            continue;
        e->near_low[at] = t / (1.0 + eps) + trial->sigma - trial->rounding[k];
        e->near_high[at] = t / (1.0 - eps) + trial->sigma + trial->rounding[k];
    }
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
    RITZ_NEW(e.near_low, trial->count + polished->count);
    RITZ_NEW(e.near_high, trial->count + polished->count);
    for (int64_t p = 0; p < e.count; p++)
        e.high[p] = HUGE_VAL;
    add_near(trial, &e);
    add_near(polished, &e);
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
    free(enclosure->near_low);
    free(enclosure->near_high);
    *enclosure = (ritz_enclosure){0};
}
