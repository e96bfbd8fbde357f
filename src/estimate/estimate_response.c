/*
 * How far a reduced response can be off. In the trial's coordinates, with
 * z_j(w) = theta_j - w^2 + i w d_j and d the modal damping,
 *
 *     eta_j = x_j'b / z_j,   r_p = b - Z X eta = b_o - c X_R eta,
 *
 * b_o = b - M X X'b, X_R = R and c = 1; of D = a M + b K, c = 1 + i w b. The
 * same of an output's row, transposed, is r_d, and
 *
 *     H - H_r = defect + r_d' Z^-1 r_p.
 *
 * In exact modes, with mu = lambda - sigma and z = c mu - s,
 *
 *     1 / z = 1 / (c mu) + s / (c mu)^2 + rest(lambda) / mu
 *
 * the first two are forms in A^-1 and A^-1 M A^-1, known exactly, and the rest
 * is small for all modes far above w. Modes k that the reduced model holds take
 * part in r only by what it does not hold of them:
 *
 *     |phi_k'r| <= sqrt(mu_k) sin_k |r|_(A^-1),
 *     sum_(k<=N) (kappa_k - kappa_(N+1)) sin_k^2
 *                                <= sum_(k<=N) (kappa_k - 1 / t_k)
 *
 * from the trace of S in the span of the N lowest trial modes. The rest of mode
 * k is bounded over the interval that is known to hold lambda_k.
 *
 * Ratios zeta of exact modes are not those of reduced ones: D X is 2 zeta times
 * M X Theta^1/2 and, in exact modes, R times 2 zeta / (sqrt lambda_k + sqrt
 * theta_j) beside: bounded by |R_j|. The defect X'D X - D_r is a second
 * difference of sqrt lambda, of order |R_i||R_j|.
 */
#include "estimate/estimate_bounder.h"

#include "base/alloc.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double two_pi = 6.28318530717958647693;
/* A free body has no response at rest: as ritz-verify begins. */
static const double above_rest = 1e-3;
/* Residual of a rigid mode, relative: its square is far below rounding. */
static const double as_rigid = 1e-7;
/* Of the largest |H_r|: intervals are not split for less. */
static const double nothing = 1e-12;
/* Between points the bound may exceed what it is at points by so much. */
static const double slack = 1.05;
enum { EVEN_POINTS = 100, MOST_INTERVALS = 20000, DEEPEST = 200 };

/* Between a and b, split until the bound is near the best of the points. */
static double between(ritz_bounder *r, double a, double b, double *best,
                      int64_t *left)
{
    double low[DEEPEST];
    double high[DEEPEST];
    double top = 0.0;
    int depth = 1;

    low[0] = a;
    high[0] = b;
    while (depth > 0) {
        double from = low[depth - 1];
        double to = high[depth - 1];
        double w = 0.5 * (from + to);
        double U = ritz_bound_at(r, w, 0.5 * (to - from));

        depth--;
        if (U <= slack * *best || --*left < 0 || depth + 2 > DEEPEST) {
            top = fmax(top, U);
            continue;
        }
        *best = fmax(*best, ritz_bound_at(r, w, 0.0));
        low[depth] = from;
        high[depth++] = w;
        low[depth] = w;
        high[depth++] = to;
    }
    return top;
}

/* Points of the band, at and beside the reduced model's poles. */
static ritz_status points(const ritz_bounder *r, const double band_hz[2],
                          int64_t *count, double **hertz)
{
    ritz_status status = RITZ_OK;
    ritz_grid grid = {.from_hz = band_hz[0],
                      .to_hz = band_hz[1],
                      .count = EVEN_POINTS,
                      .refine = true};
    int64_t m = r->trial->count - r->num_rigid;
    double *omega = NULL;
    double *zeta = NULL;

    if (r->num_rigid > 0)
        grid.from_hz = fmax(grid.from_hz, above_rest * grid.to_hz);
    RITZ_NEW(omega, m);
    RITZ_NEW(zeta, m);
    for (int64_t k = 0; k < m; k++) {
        double theta = r->trial->theta[r->num_rigid + k];

        omega[k] = sqrt(fmax(theta, 0.0));
        zeta[k] =
            omega[k] > 0.0
                ? 0.5 * ritz_bounder_rate_of(r, r->num_rigid + k) / omega[k]
                : 1.0;
    }
    RITZ_TRY(ritz_grid_points(&grid, m, omega, zeta, count, hertz));
done:
    free(omega);
    free(zeta);
    return status;
}

static ritz_status sweep(ritz_bounder *r, const double band_hz[2], double *out,
                         double *at)
{
    ritz_status status = RITZ_OK;
    int64_t count = 0;
    int64_t left = MOST_INTERVALS;
    double *hertz = NULL;
    double best = 0.0;
    double top = 0.0;

    RITZ_TRY(points(r, band_hz, &count, &hertz));
    for (int64_t k = 0; k < count; k++) {
        double one = ritz_bound_at(r, two_pi * hertz[k], 0.0);

        if (one > best) {
            best = one;
            *at = hertz[k];
        }
    }
    best = fmax(best, nothing * r->largest);
    top = best;
    for (int64_t k = 0; k + 1 < count && !r->coupled; k++)
        top = fmax(top, between(r, two_pi * hertz[k], two_pi * hertz[k + 1],
                                &best, &left));
    *out = top;
done:
    free(hertz);
    return status;
}

/* Of D, relative; a gyroscopic part is no damping. */
static const double symmetric = 1e-9;

/* What can be said of a response. */
typedef enum promise { NOTHING, ESTIMATE, BOUND } promise;

static promise promise_of(const ritz_estimator *estimator,
                          const ritz_reduced *reduced, int64_t modes)
{
    const ritz_component *full = estimator->component;
    ritz_damping_kind kind = estimator->request.damping.kind;

    if (modes != reduced->K.nrow || full->io.num_inputs == 0 ||
        full->io.num_outputs == 0 ||
        (full->dampers.count > 0 && !full->D.colptr) || /* not installed */
        (full->D.colptr && ritz_sparse_asymmetry(&full->D) > symmetric))
        return NOTHING;
    if (full->D.colptr || full->K4.colptr || kind == RITZ_DAMPING_BANDS ||
        kind == RITZ_DAMPING_MODES)
        return ESTIMATE;
    return kind == RITZ_DAMPING_NONE ? NOTHING : BOUND;
}

bool ritz_response_boundable(const ritz_estimator *estimator,
                             const ritz_reduced *reduced, int64_t modes)
{
    return promise_of(estimator, reduced, modes) != NOTHING;
}

/*
 * Whether the modes that count as rigid are the full model's: then both have
 * them at 0, where rounding of matrices may leave them elsewhere.
 */
static bool rigid_in_full(const ritz_lehmann *trial, int64_t num_rigid)
{
    bool all = true;

    for (int64_t j = 0; j < num_rigid; j++) {
        double t = trial->theta[j] - trial->sigma;
        double eps = sqrt(fmax(ritz_dense_col(&trial->G, j)[j], 0.0) / t);

        all = all && eps <= as_rigid;
    }
    return all;
}

ritz_status ritz_bound_response(ritz_estimator *estimator,
                                const ritz_measuring *m,
                                const ritz_reduced *reduced, ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    const ritz_damping *damping = &estimator->request.damping;
    bool known = promise_of(estimator, reduced, m->pairs.Phi.ncol) == BOUND;
    bool sure = false;
    ritz_bounder r = {.trial = &m->trial,
                      .e = &m->enclosure,
                      .io = &estimator->component->io,
                      .num_rigid = m->pairs.num_rigid,
                      .rayleigh = ritz_damping_is_rayleigh(damping),
                      .zeta = damping->zeta,
                      .a = damping->a,
                      .b = damping->b};
    double *rates = NULL;
    double *matrices = NULL;
    double bound = 0.0;
    double at = 0.0;
    double counted = 0.0;
    char where[RITZ_NAME_SIZE];

    RITZ_NEW(rates, m->trial.count);
    RITZ_NEW(matrices, m->trial.count);
    if (!known && damping->kind == RITZ_DAMPING_NONE)
        RITZ_TRY(
            ritz_rayleigh_of(estimator->component, &r.a, &r.b, &r.rayleigh));
    sure =
        (known || r.rayleigh) && rigid_in_full(&m->trial, m->pairs.num_rigid);
    if (!known && !r.rayleigh)
        RITZ_TRY(ritz_bounder_rates(estimator, &r, rates, matrices));
    RITZ_TRY(ritz_bounder_open(estimator, &r));
    RITZ_TRY(sweep(&r, m->band_hz, &bound, &at));
    if ((r.coupled && ritz_missing_modes(estimator, m, &counted) != 0) ||
        ritz_bounder_at_odds(&r) || ritz_bounder_undamped(&r, m->band_hz))
        bound = HUGE_VAL; /* of their damping nothing is known */
    (void)snprintf(where, sizeof where, "%.6g Hz", at);
    if (bound > 0.0)
        RITZ_TRY(ritz_measures_add(
            out,
            sure ? "response-relative-bound" : "response-relative-estimate",
            r.least > 0.0 ? bound / r.least : HUGE_VAL, nan(""), where));
done:
    ritz_bounder_free(&r);
    free(rates);
    free(matrices);
    return status;
}
