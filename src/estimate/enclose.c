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
#include "base/alloc.h"
#include "base/tolerances.h"
#include "estimate/estimator.h"
#include "linear/factor.h"
#include "linear/general.h"
#include "linear/residuals.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

/* Trials that give intervals: the trial, its inverse iterate, and the richer
   one. */
enum { TRIALS = 3 };
/* Inverse iterations between two trials. The solves of one take a fifth of the
   time of a trial, and after two of them a trial with residuals of 1e-3 mostly
   tells close modes apart. */
enum { INVERSE_STEPS = 2 };

/*
 * Ritz pairs are computed anew from the full matrices in the range of T: those
 * of the reduced model equal them to rounding, unless columns have lost their
 * mass.
 *
 * Rounding. K x is a sum of the terms |K||x|: so x'Kx may be off by some eps
 * times |x|'|K||x|, in any program, and M x likewise. Pairs of a dense pencil
 * are off by eps times its largest eigenvalue in addition. Rounding may
 * exchange modes that are nearer to each other than that: they share one
 * interval.
 */

/* Ritz pairs in the range of Y, which may be far from orthonormal; Y becomes
   their vectors, X = Y C. @param[out] C  NULL: not wanted */
static ritz_status take_ritz_pairs(const ritz_component *full, ritz_dense *Y,
                                   ritz_lehmann *trial, ritz_dense *C)
{
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_sparse_condense(&full->K, Y, &K));
    RITZ_CHECK(ritz_sparse_condense(&full->M, Y, &M));
    RITZ_CHECK(ritz_eigen_dense(&K, &M, &pairs));
    RITZ_CHECK(ritz_dense_times(&pairs.Phi, Y));
    RITZ_MOVE(trial->X, *Y);
    trial->count = pairs.Phi.ncol;
    trial->theta = pairs.lambda;
    pairs.lambda = NULL;
    if (C)
        RITZ_MOVE(*C, pairs.Phi);
    return RITZ_OK;
}

/*
 * G = R'A^-1 R and R := A^-1 R. The last columns come first: G_ij with i <= j
 * needs R_i and A^-1 R_j, so that R_i must still be there.
 */
static ritz_status solve_residuals(ritz_factor *A, ritz_dense *R, ritz_dense *G)
{
    enum { SOME = 32 }; /* columns at a time */

    RITZ_CHECK(ritz_dense_new(R->ncol, R->ncol, G));
    for (int64_t end = R->ncol; end > 0;) {
        const int64_t first = (end - 1) / SOME * SOME;
        const ritz_dense before = ritz_dense_part(R, 0, end);
        const ritz_dense some = ritz_dense_part(R, first, end - first);
        RITZ_OWN(ritz_dense) E = {0}, RE = {0};

        RITZ_CHECK(ritz_dense_copy(&some, &E));
        RITZ_CHECK(ritz_factor_solve(A, &E));
        RITZ_CHECK(ritz_dense_mul_tn(&before, &E, &RE));
        ritz_dense_put(&RE, 0, first, G);
        ritz_dense_put(&E, 0, first, R);
        end = first;
    }
    for (int64_t j = 0; j < G->ncol; j++)
        for (int64_t i = 0; i < j; i++)
            ritz_dense_col(G, i)[j] = ritz_dense_col(G, j)[i];
    return RITZ_OK;
}

/* E = R = K X - M X Theta, and the rounding of theta. */
static ritz_status take_residuals(const ritz_component *full,
                                  ritz_lehmann *trial)
{
    double largest = 0.0;

    if (trial->count > 0)
        largest = trial->theta[trial->count - 1];
    RITZ_CHECK_NEW(trial->rounding, trial->count);
    RITZ_CHECK_NEW(trial->mass_terms, trial->count);
    RITZ_CHECK(ritz_pairs_subtract(&full->K, &full->M, &trial->X, trial->theta,
                                   &trial->E, trial->rounding,
                                   trial->mass_terms));
    for (int64_t j = 0; j < trial->count; j++)
        trial->rounding[j] =
            RITZ_CANCELLED_ROUNDINGS * DBL_EPSILON *
            (trial->rounding[j] +
             (fabs(trial->theta[j]) - trial->sigma) * trial->mass_terms[j] +
             largest);
    return RITZ_OK;
}

ritz_status ritz_lehmann_solve(ritz_factor *A, ritz_lehmann *trial)
{
    return solve_residuals(A, &trial->E, &trial->G);
}

/* The interval of each eigenvalue of the reduced pencil. */
static void bound_reduced(const ritz_pairs *pairs, ritz_lehmann *trial)
{
    double least = HUGE_VAL;
    double most = -HUGE_VAL;

    for (int64_t j = 0; j < trial->count; j++) {
        most = fmax(most, pairs->lambda[j] + trial->reduced_rounding[j]);
        trial->reduced_high[j] = most;
    }
    for (int64_t j = trial->count - 1; j >= 0; j--) {
        least = fmin(least, pairs->lambda[j] - trial->reduced_rounding[j]);
        trial->reduced_low[j] = least;
    }
}

/*
 * Rounding of the eigenvalues of the reduced pencil as it is: that of its
 * entries, which may cancel in q'K q, and that of the largest eigenvalue.
 */
static ritz_status round_reduced(const ritz_reduced *reduced,
                                 const ritz_pairs *pairs, ritz_lehmann *trial)
{
    const ritz_dense Q = ritz_dense_part(&pairs->Phi, 0, trial->count);
    RITZ_OWN(ritz_dense) K = {0}, M = {0};

    RITZ_CHECK_NEW(trial->reduced_rounding, trial->count);
    RITZ_CHECK_NEW(trial->reduced_low, trial->count);
    RITZ_CHECK_NEW(trial->reduced_high, trial->count);
    RITZ_CHECK(ritz_dense_terms(&reduced->K, &Q, &K));
    RITZ_CHECK(ritz_dense_terms(&reduced->M, &Q, &M));
    for (int64_t j = 0; j < trial->count; j++) {
        trial->mass_terms[j] += ritz_dense_col(&M, j)[j];
        trial->reduced_rounding[j] =
            RITZ_CANCELLED_ROUNDINGS * DBL_EPSILON *
            (ritz_dense_col(&K, j)[j] +
             fabs(pairs->lambda[j]) * ritz_dense_col(&M, j)[j] +
             pairs->lambda[pairs->Phi.ncol - 1]);
    }
    bound_reduced(pairs, trial);
    return RITZ_OK;
}

ritz_status ritz_lehmann_new(const ritz_estimator *estimator,
                             const ritz_dense *T, const ritz_reduced *reduced,
                             const ritz_pairs *pairs, int64_t count,
                             ritz_lehmann *out)
{
    const ritz_dense part = ritz_dense_part(&pairs->Phi, 0, count);
    RITZ_OWN(ritz_lehmann) trial = {.sigma = estimator->sigma};
    RITZ_OWN(ritz_dense) Y = {0}, C = {0};

    RITZ_CHECK(ritz_dense_mul(T, &part, &Y));
    RITZ_CHECK(take_ritz_pairs(estimator->component, &Y, &trial, &C));
    RITZ_REFUSE_IF(trial.count != count, RITZ_ERR_SINGULAR,
                   "estimate: columns of the basis depend on each other");
    /* X = T Phi_part C, and Phi'(T'M T)Phi = I */
    RITZ_CHECK(ritz_dense_new(pairs->Phi.ncol, count, &trial.Q));
    ritz_dense_put(&C, 0, 0, &trial.Q);
    RITZ_CHECK(take_residuals(estimator->component, &trial));
    RITZ_CHECK(round_reduced(reduced, pairs, &trial));
    RITZ_MOVE(*out, trial);
    return RITZ_OK;
}

ritz_status ritz_lehmann_of_span(ritz_estimator *estimator, ritz_dense *Y,
                                 ritz_lehmann *out)
{
    RITZ_OWN(ritz_lehmann) trial = {.sigma = estimator->sigma};

    RITZ_CHECK(take_ritz_pairs(estimator->component, Y, &trial, NULL));
    RITZ_CHECK(take_residuals(estimator->component, &trial));
    RITZ_CHECK(ritz_lehmann_solve(estimator->A, &trial));
    RITZ_CHECK_NEW(trial.reduced_rounding, trial.count);
    RITZ_MOVE(*out, trial);
    return RITZ_OK;
}

/* Y := A^-1 M Y (Theta - sigma). The size of columns hardly changes, as A^-1 M
   divides a mode by lambda - sigma. */
static ritz_status iterate_inversely(const ritz_estimator *estimator,
                                     const ritz_lehmann *trial, ritz_dense *Y)
{
    RITZ_OWN(ritz_dense) MY = {0};

    RITZ_CHECK(ritz_sparse_mul(&estimator->component->M, Y, &MY));
    RITZ_CHECK(ritz_factor_solve(estimator->A, &MY));
    for (int64_t j = 0; j < MY.ncol; j++)
        for (int64_t i = 0; i < MY.nrow; i++)
            ritz_dense_col(&MY, j)[i] *= trial->theta[j] - trial->sigma;
    ritz_dense_free(Y);
    RITZ_MOVE(*Y, MY);
    return RITZ_OK;
}

/*
 * The first iteration is known without a solve: A^-1 M X = (X - E) Theta_t^-1,
 * as R = A X - M X Theta_t. The others are solves, each of which costs far less
 * than the Ritz pairs and residuals that follow.
 */
ritz_status ritz_lehmann_polish(ritz_estimator *estimator,
                                const ritz_lehmann *trial, ritz_lehmann *out)
{
    RITZ_OWN(ritz_dense) Y = {0};

    RITZ_CHECK(ritz_dense_copy(&trial->X, &Y));
    for (int64_t k = 0; k < Y.nrow * Y.ncol; k++)
        Y.val[k] -= trial->E.val[k];
    for (int t = 1; t < INVERSE_STEPS && trial->count > 0; t++)
        RITZ_CHECK(iterate_inversely(estimator, trial, &Y));
    return ritz_lehmann_of_span(estimator, &Y, out);
}

static void ritz_lehmann_values_free(ritz_lehmann_values *values)
{
    free(values->nu);
    *values = (ritz_lehmann_values){0};
}

void ritz_lehmann_free(ritz_lehmann *trial)
{
    RITZ_FREE_EACH(ritz_lehmann_values, trial->num_values, trial->values);
    ritz_dense_free(&trial->X);
    ritz_dense_free(&trial->E);
    ritz_dense_free(&trial->G);
    ritz_dense_free(&trial->Q);
    RITZ_FREE(trial->kappa, trial->theta, trial->rounding, trial->mass_terms,
              trial->reduced_rounding, trial->reduced_low, trial->reduced_high);
    *trial = (ritz_lehmann){0};
}

/*
 * The Ritz values tau of Lehmann's method below, as their inverses. Rounding of
 * a dense problem is eps times its largest value, and tau is large where rho is
 * close to a mode: so nu = 1 / tau is sought, whose largest belong to the modes
 * furthest from rho. With J = sign D and z = |D|^-1/2 u
 *
 *     D z = tau (D^2 + G^) z   is   H u = nu J u,
 *     H = |D| + |D|^-1/2 G^ |D|^-1/2 = LL',
 *
 * and nu are the eigenvalues of L'JL.
 */

static double shift_of(const ritz_lehmann *trial, int64_t j)
{
    return trial->theta[j] - trial->sigma;
}

/* Diagonal of D; false if rounding may have turned a sign of it. */
static bool take_offsets(const ritz_lehmann *trial, double rho, double *d)
{
    bool clear = true;

    for (int64_t j = 0; j < trial->count; j++) {
        double off = rho - trial->theta[j];
        double t = shift_of(trial, j);

        clear = clear && fabs(off) > trial->rounding[j];
        d[j] = off / (t * (rho - trial->sigma));
    }
    return clear;
}

/* H; the rounding of a residual is added as one more residual. */
static void fill_form(const ritz_lehmann *trial, const double *d, ritz_dense *H)
{
    for (int64_t j = 0; j < trial->count; j++) {
        double t_j = shift_of(trial, j);
        double rounded = trial->rounding[j] / (t_j * t_j);

        for (int64_t i = 0; i < trial->count; i++) {
            double t = shift_of(trial, i) * t_j;

            ritz_dense_col(H, j)[i] = ritz_dense_col(&trial->G, j)[i] /
                                      (t * sqrt(t * fabs(d[i] * d[j])));
        }
        ritz_dense_col(H, j)[j] += fabs(d[j]) + rounded * rounded / fabs(d[j]);
    }
}

/* L over H; false if rounding has left it indefinite. */
static bool factor_form(ritz_dense *H)
{
    int m = (int)H->nrow;

    for (int64_t j = 0; j < H->ncol; j++)
        memset(ritz_dense_col(H, j), 0, (size_t)j * sizeof *H->val);
    return LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', m, H->val, m) == 0;
}

/* L'JL. */
static ritz_status join_signs(const ritz_dense *L, const double *d,
                              ritz_dense *out)
{
    RITZ_OWN(ritz_dense) JL = {0};

    RITZ_CHECK(ritz_dense_copy(L, &JL));
    for (int64_t j = 0; j < L->ncol; j++)
        for (int64_t i = j; i < L->nrow; i++)
            ritz_dense_col(&JL, j)[i] *= d[i] > 0.0 ? 1.0 : -1.0;
    RITZ_CHECK(ritz_dense_mul_tn(L, &JL, out));
    ritz_dense_symmetrise(out);
    return RITZ_OK;
}

/* nu for rho, ascending; none where rho is too close to a mode of the trial. */
static ritz_status solve_lehmann(const ritz_lehmann *trial, double rho,
                                 ritz_lehmann_values *out)
{
    int64_t m = trial->count;
    RITZ_OWN_ARRAY double *d = NULL;
    RITZ_OWN(ritz_dense) L = {0}, LJL = {0};

    out->rho = rho;
    RITZ_CHECK_NEW(d, m);
    if (!take_offsets(trial, rho, d))
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(m, m, &L));
    fill_form(trial, d, &L);
    if (!factor_form(&L))
        return RITZ_OK;
    RITZ_CHECK(join_signs(&L, d, &LJL));
    RITZ_CHECK_NEW(out->nu, m);
    RITZ_CHECK(ritz_general_symmetric_values(&LJL, out->nu));
    out->count = m;
    return RITZ_OK;
}

/* nu for rho, computed once for each trial. Valid until the next call. */
static ritz_status find_values(ritz_lehmann *trial, double rho,
                               const ritz_lehmann_values **out)
{
    RITZ_OWN(ritz_lehmann_values) found = {0};

    for (int64_t k = 0; k < trial->num_values; k++)
        if (trial->values[k].rho == rho) {
            *out = &trial->values[k];
            return RITZ_OK;
        }
    RITZ_CHECK(solve_lehmann(trial, rho, &found));
    RITZ_CHECK_ROOM(trial->values, trial->num_values, trial->room_values);
    *out = &trial->values[trial->num_values];
    RITZ_MOVE(trial->values[trial->num_values++], found);
    return RITZ_OK;
}

/* The eigenvalue of kappa = 1 / (lambda - sigma); infinite unless kappa > 0. */
static double lambda_of(double kappa, double sigma)
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

/* Rounding of eigenvalues of a dense matrix. */
static double rounding_of(int64_t count, const double *value)
{
    return count > 0 ? RITZ_CANCELLED_ROUNDINGS * DBL_EPSILON *
                           fmax(fabs(value[0]), value[count - 1])
                     : 0.0;
}

/*
 * Bounds by one count: of the full modes below it, from the least positive nu
 * on, or of those above it, from the largest other nu on. Each bound also holds
 * for the modes further away, as rounding may exchange them.
 */
static void enclose_side(const ritz_lehmann *trial,
                         const ritz_lehmann_values *values, double kappa_rho,
                         int64_t below, bool above, ritz_enclosure *e)
{
    const int64_t count = values->count;
    const double *nu = values->nu;
    const double rounded = rounding_of(count, nu);
    int64_t positive = 0; /* the first of these */
    double off = above ? -rounded : rounded;
    double end = above ? 0.0 : HUGE_VAL;

    while (positive < count && nu[positive] <= 0.0)
        positive++;
    for (int64_t k = 0; k < (above ? positive : count - positive); k++) {
        int64_t at = above ? positive - 1 - k : positive + k;
        int64_t p = above ? below + k : below - 1 - k;
        double lambda = lambda_of(kappa_rho + nu[at] + off, trial->sigma);
        double rounding = trial->rounding[count - 1 - at];

        end =
            above ? fmax(end, lambda + rounding) : fmin(end, lambda - rounding);
        if (above && p < e->count)
            e->high[p] = fmin(e->high[p], end);
        else if (!above && p >= 0 && p < e->count)
            e->low[p] = fmax(e->low[p], end);
    }
}

/* Bounds by one count, of the eigenvalues above it or of those below it. */
static ritz_status use_count(ritz_lehmann *trial, const ritz_counted *counted,
                             bool above, ritz_enclosure *e)
{
    double off = RITZ_COUNT_MARGIN * rounding_at(trial, counted->rho);
    double rho = counted->rho + (above ? off : -off);
    double kappa_rho = 1.0 / (rho - trial->sigma);
    const ritz_lehmann_values *values = NULL;

    if (!(kappa_rho > 0.0))
        return RITZ_OK;
    RITZ_CHECK(find_values(trial, rho, &values));
    enclose_side(trial, values, kappa_rho, counted->below, above, e);
    return RITZ_OK;
}

/* The eigenvalues of X'M A^-1 M X, computed once for each trial. */
static ritz_status find_kappa(ritz_lehmann *trial)
{
    int64_t m = trial->count;
    RITZ_OWN(ritz_dense) S = {0};
    RITZ_OWN_ARRAY double *kappa = NULL;

    if (trial->kappa)
        return RITZ_OK;
    RITZ_CHECK_NEW(kappa, m);
    RITZ_CHECK(ritz_dense_new(m, m, &S));
    for (int64_t j = 0; j < m; j++) {
        for (int64_t i = 0; i < m; i++)
            ritz_dense_col(&S, j)[i] =
                ritz_dense_col(&trial->G, j)[i] /
                (shift_of(trial, i) * shift_of(trial, j));
        ritz_dense_col(&S, j)[j] += 1.0 / shift_of(trial, j);
    }
    RITZ_CHECK(ritz_general_symmetric_values(&S, kappa));
    RITZ_MOVE(trial->kappa, kappa);
    return RITZ_OK;
}

/* Upper bounds by Ritz values, and by those of one inverse iteration. */
static ritz_status improve_from_above(ritz_lehmann *trial, ritz_enclosure *e)
{
    int64_t m = trial->count;
    double off = 0.0;
    double most = 0.0;

    RITZ_CHECK(find_kappa(trial));
    off = rounding_of(m, trial->kappa);
    for (int64_t k = 0; k < m; k++) {
        double better =
            fmin(trial->theta[k],
                 lambda_of(trial->kappa[m - 1 - k] - off, trial->sigma));

        most = fmax(most, better + trial->rounding[k]);
        e->high[k] = fmin(e->high[k], most);
    }
    return RITZ_OK;
}

/* Bounds by counts alone; then both ends are made to ascend. */
static void settle_ends(const ritz_estimator *estimator,
                        const ritz_lehmann *trial, ritz_enclosure *e)
{
    for (int64_t s = 0; s < estimator->num_counts; s++) {
        double rho = estimator->count[s].rho;
        double off = RITZ_COUNT_MARGIN * rounding_at(trial, rho);

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

int64_t ritz_count_below(int64_t count, const double *lambda, double rho)
{
    int64_t below = 0;

    while (below < count && lambda[below] < rho)
        below++;
    return below;
}

bool ritz_counted_within(const ritz_estimator *estimator, double low,
                         double high)
{
    const ritz_counted *c = estimator->count;

    for (int64_t s = 0; s < estimator->num_counts; s++)
        if (c[s].rho > low && c[s].rho < high)
            return true;
    return false;
}

int64_t ritz_missing_modes(const ritz_measuring *m)
{
    double end = ritz_eigen_lambda(m->band_hz[1]);
    int64_t least = -1;

    for (int64_t s = 0; s < m->estimator->num_counts; s++) {
        const ritz_counted *c = &m->estimator->count[s];
        int64_t below =
            ritz_count_below(m->pairs.Phi.ncol, m->pairs.lambda, c->rho);
        int64_t more = c->below > below ? c->below - below : 0;

        if (c->rho >= end && (least < 0 || more < least))
            least = more;
    }
    return least;
}

/* Bounds by a trial space and each count. */
static ritz_status add_trial(const ritz_estimator *estimator,
                             ritz_lehmann *trial, ritz_enclosure *e)
{
    const ritz_counted *counted = estimator->count;

    RITZ_CHECK(improve_from_above(trial, e));
    for (int64_t s = 0; s < estimator->num_counts; s++) {
        int64_t below =
            ritz_count_below(trial->count, trial->theta, counted[s].rho);

        if (below > 0)
            RITZ_CHECK(use_count(trial, &counted[s], false, e));
        if (below < trial->count && counted[s].below > below)
            RITZ_CHECK(use_count(trial, &counted[s], true, e));
    }
    return RITZ_OK;
}

/* Some kappa is within eps / t of 1 / t, eps = |R|_(A^-1) / |x|_A. */
static void add_near(const ritz_lehmann *trial, ritz_enclosure *e)
{
    for (int64_t k = 0; k < trial->count; k++) {
        double t = shift_of(trial, k);
        double eps = sqrt(fmax(ritz_dense_col(&trial->G, k)[k], 0.0) / t);
        int64_t at = e->num_near++;

        e->near_high[at] = HUGE_VAL;
        if (!(eps < 1.0)) /* it may be the kappa = 0 of no mass */
            continue;
        e->near_low[at] = t / (1.0 + eps) + trial->sigma - trial->rounding[k];
        e->near_high[at] = t / (1.0 - eps) + trial->sigma + trial->rounding[k];
    }
}

void ritz_enclosure_free(ritz_enclosure *enclosure)
{
    RITZ_FREE(enclosure->low, enclosure->high, enclosure->near_low,
              enclosure->near_high);
    *enclosure = (ritz_enclosure){0};
}

ritz_status ritz_measuring_enclose(ritz_measuring *m)
{
    const ritz_estimator *estimator = m->estimator;
    const ritz_lehmann *trial = &m->trial;
    ritz_lehmann *const all[TRIALS] = {&m->trial, &m->polished, &m->rich};
    RITZ_OWN(ritz_enclosure) e = {.count = trial->count};
    const ritz_counted *counted = estimator->count;
    int64_t num_near = 0;

    for (int64_t s = 0; s < estimator->num_counts; s++)
        if (counted[s].below > e.count)
            e.count = counted[s].below;
    e.count++; /* the next one, of which counts may say something */
    for (int k = 0; k < TRIALS; k++) {
        num_near += all[k]->count;
        e.count = all[k]->count >= e.count ? all[k]->count + 1 : e.count;
    }
    RITZ_CHECK_NEW(e.low, e.count);
    RITZ_CHECK_NEW(e.high, e.count);
    RITZ_CHECK_NEW(e.near_low, num_near);
    RITZ_CHECK_NEW(e.near_high, num_near);
    for (int64_t p = 0; p < e.count; p++)
        e.high[p] = HUGE_VAL;
    for (int k = 0; k < TRIALS; k++)
        add_near(all[k], &e);
    for (int k = 0; k < TRIALS; k++)
        if (all[k]->count > 0)
            RITZ_CHECK(add_trial(estimator, all[k], &e));
    settle_ends(estimator, trial, &e);
    ritz_enclosure_free(&m->enclosure);
    RITZ_MOVE(m->enclosure, e);
    return RITZ_OK;
}

/*
 * A claim says how far one reduced mode can be from a full mode: from any whose
 * interval is known or, without a number, from one that is near by
 *
 *     |kappa - 1/t| <= eps / t,   eps = |R|_(A^-1) / |x|_A
 *
 * which holds for some kappa of the full model, also of the same vector after
 * an inverse iteration, where eps is far smaller.
 */

ritz_bounds ritz_error_of(const ritz_measuring *m, int64_t k, double low,
                          double high)
{
    double theta = m->pairs.lambda[k];
    double least = theta, most = theta; /* rounding beyond the trial: unknown */

    if (k < m->trial.count) {
        least = fmin(theta, m->trial.reduced_low[k]);
        most = fmax(theta, m->trial.reduced_high[k]);
    }
    least = fmax(least, 0.0);
    most = fmax(most, 0.0);
    if (!(low > 0.0))
        return (ritz_bounds){0.0, HUGE_VAL};
    return (ritz_bounds){
        fmax(0.0, fmax(sqrt(least / high) - 1.0, 1.0 - sqrt(most / low))),
        fmax(0.0, fmax(sqrt(most / low) - 1.0, 1.0 - sqrt(least / high)))};
}

ritz_claim ritz_claim_of(const ritz_measuring *m, int64_t k)
{
    const ritz_lehmann *trial = &m->trial;
    const ritz_enclosure *e = &m->enclosure;
    ritz_claim claim = {.bound = HUGE_VAL, .full_mode = k};
    double same = ritz_error_of(m, k, e->low[k], e->high[k]).most;
    double some = HUGE_VAL;

    for (int64_t p = 0; p < e->count; p++) {
        double bound = ritz_error_of(m, k, e->low[p], e->high[p]).most;

        if (bound < claim.bound) {
            claim.bound = bound;
            claim.full_mode = p;
        }
    }
    if (same <= RITZ_CLAIM_FAVOUR * claim.bound) {
        claim.bound = same;
        claim.full_mode = k;
    }
    for (int64_t j = 0; j < e->num_near; j++)
        some = fmin(some,
                    ritz_error_of(m, k, e->near_low[j], e->near_high[j]).most);
    if (RITZ_CLAIM_FAVOUR * some < claim.bound) {
        claim.bound = some;
        claim.full_mode = -1;
    }
    claim.least = 0.5 * ritz_dense_col(&trial->G, k)[k] /
                  ((trial->theta[k] - trial->sigma) * fabs(trial->theta[k]));
    return claim;
}
