/* The bound of a response at a frequency; its equations are in response.c. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "estimate/estimator.h"
#include "linear/general.h"
#include "linear/residuals.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

typedef double _Complex number;

static double square_of(double x)
{
    return x * x;
}

double ritz_bounder_stiffness(const ritz_bounder *r, int64_t j)
{
    return j < r->num_rigid ? 0.0 : r->trial->theta[j];
}

/* The rate of a full mode: 2 zeta omega, or a + b lambda. */
static double rate_at(const ritz_bounder *r, double lambda)
{
    return r->rayleigh ? r->a + r->b * lambda
                       : 2.0 * r->zeta * sqrt(fmax(lambda, 0.0));
}

number ritz_bounder_z(const ritz_bounder *r, int64_t j, double w)
{
    return ritz_complex(ritz_bounder_stiffness(r, j) - w * w, w * r->rates[j]);
}

double ritz_bounder_least_z(const ritz_bounder *r, int64_t j, double w,
                            double h)
{
    double d = r->rates[j];

    return fmax(cabs(ritz_bounder_z(r, j, w)) - h * (2.0 * w + h) - h * d,
                fmax(w - h, 0.0) * d);
}

/* The product of a real symmetric matrix and a complex vector. */
static void multiply_real(const ritz_dense *G, const number *x, number *y)
{
    memset(y, 0, (size_t)G->nrow * sizeof *y);
    for (int64_t j = 0; j < G->ncol; j++)
        for (int64_t i = 0; i < G->nrow && x[j] != 0.0; i++)
            y[i] += ritz_dense_col(G, j)[i] * x[j];
}

static double norm_of(const ritz_bounder *r, const number *x, number *work)
{
    double sum = 0.0;

    multiply_real(&r->G, x, work);
    for (int64_t i = 0; i < r->size; i++)
        sum += creal(conj(x[i]) * work[i]);
    return sqrt(fmax(sum, 0.0));
}

/* Put A X into V from column `at` on; zeros if there is no A. */
static ritz_status put_product(const ritz_sparse *A, const ritz_bounder *r,
                               int64_t at, ritz_dense *V)
{
    RITZ_OWN(ritz_dense) AX = {0};

    if (!A->colptr)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_mul(A, &r->trial->X, &AX));
    ritz_dense_put(&AX, 0, at, V);
    return RITZ_OK;
}

/* Put the residuals K X - M X Theta of the trial into V's first columns. */
static ritz_status put_residuals(const ritz_component *full,
                                 const ritz_lehmann *trial, ritz_dense *V)
{
    RITZ_OWN(ritz_dense) R = {0};
    RITZ_OWN_ARRAY double *terms = NULL; /* not needed */

    RITZ_CHECK_NEW(terms, 2 * trial->count);
    RITZ_CHECK(ritz_pairs_subtract(&full->K, &full->M, &trial->X, trial->theta,
                                   &R, terms, terms + trial->count));
    ritz_dense_put(&R, 0, 0, V);
    return RITZ_OK;
}

/* V = [R b_o c_o D_o K4_o]: all but R less their part M X X' in the trial. */
static ritz_status stack_vectors(const ritz_estimator *estimator,
                                 ritz_bounder *r, ritz_dense *V)
{
    const ritz_component *full = estimator->component;
    const ritz_io *io = &full->io;
    const ritz_dense *const C[KINDS] = {&io->C, &io->Cv, &io->Ca};
    int64_t m = r->trial->count;
    RITZ_OWN(ritz_dense) MX = {0};
    ritz_dense part = {0};

    RITZ_CHECK(ritz_dense_new(full->num_dofs, r->size, V));
    RITZ_CHECK(put_residuals(full, r->trial, V));
    ritz_dense_put(&io->B, 0, m, V);
    for (int64_t k = 0; k < KINDS; k++)
        ritz_general_place(1.0, C[k], true, 0,
                           m + io->num_inputs + k * io->num_outputs, V);
    if (r->coupled) {
        RITZ_CHECK(put_product(&full->D, r, r->size - 2 * m, V));
        RITZ_CHECK(put_product(&full->K4, r, r->size - m, V));
    }
    RITZ_CHECK(ritz_sparse_mul(&full->M, &r->trial->X, &MX));
    part = ritz_dense_part(V, m, r->size - m);
    for (int twice = 0; twice < 2; twice++)
        RITZ_CHECK(ritz_dense_take_out(&MX, &r->trial->X, &part));
    return RITZ_OK;
}

/* E = A^-1 V, of which the trial has the columns A^-1 R; G = V'E, Q = E'M E and
   the norms of V's columns. */
static ritz_status take_forms(ritz_estimator *estimator, ritz_bounder *r)
{
    const int64_t m = r->trial->count;
    ritz_dense others = {0};

    RITZ_CHECK(stack_vectors(estimator, r, &r->V));
    RITZ_CHECK(ritz_dense_copy(&r->V, &r->E));
    ritz_dense_put(&r->trial->E, 0, 0, &r->E);
    others = ritz_dense_part(&r->E, m, r->size - m);
    RITZ_CHECK(ritz_factor_solve(estimator->A, &others));
    RITZ_CHECK(ritz_dense_mul_tn(&r->V, &r->E, &r->G));
    ritz_dense_symmetrise(&r->G);
    RITZ_CHECK(ritz_sparse_condense(&estimator->component->M, &r->E, &r->Q));
    RITZ_CHECK_NEW(r->vector_norm, r->size);
    for (int64_t j = 0; j < r->size; j++)
        r->vector_norm[j] = sqrt(fmax(ritz_dense_col(&r->G, j)[j], 0.0));
    return RITZ_OK;
}

/*
 * sin^2 of each rigid mode: by the residuals of all together, as full and trial
 * ones may be turned among themselves, and the gap to flexible modes.
 */
static double rigid_sin2(const ritz_bounder *r)
{
    const ritz_lehmann *trial = r->trial;
    double next = r->num_rigid < r->e->count ? r->e->low[r->num_rigid] : 0.0;
    double sum = 0.0;

    if (!(next > 0.0))
        return 1.0;
    for (int64_t j = 0; j < r->num_rigid; j++) {
        double t = trial->theta[j] - trial->sigma;
        double eps2 = fmax(ritz_dense_col(&trial->G, j)[j], 0.0) / t;

        sum += square_of(trial->rounding[j] / trial->sigma) +
               eps2 * square_of(1.0 - trial->sigma / next);
    }
    return sum;
}

/* sin^2 of each full mode against the trial modes of numbers up to N. */
static ritz_status take_sines(ritz_bounder *r)
{
    const ritz_lehmann *trial = r->trial;
    const ritz_enclosure *e = r->e;
    double sum = 0.0;

    RITZ_CHECK_NEW(r->sin2, e->count);
    for (int64_t p = 0; p < e->count; p++)
        r->sin2[p] = 1.0;
    for (int64_t N = 1; N < e->count && N <= trial->count; N++) {
        double t = trial->theta[N - 1] - trial->sigma;
        double next = 1.0 / (e->low[N] - trial->sigma);
        double most = 1.0 / (e->low[N - 1] - trial->sigma);

        sum += fmax(most - 1.0 / t, 0.0);
        for (int64_t p = 0; p < N; p++) {
            double least = 1.0 / (e->high[p] - trial->sigma);

            if (least > next)
                r->sin2[p] = fmin(r->sin2[p], sum / (least - next));
        }
    }
    for (int64_t p = 0; p < r->num_rigid && p < e->count; p++)
        r->sin2[p] = fmin(r->sin2[p], rigid_sin2(r));
    return RITZ_OK;
}

/*
 * Rounding of each eigenvalue, in the full and in the reduced matrices
 * together. Modes whose eigenvalues rounding may exchange can be different
 * vectors in the two models, so they all get the largest value among them.
 */
static ritz_status take_roundings(ritz_bounder *r)
{
    const ritz_lehmann *trial = r->trial;
    const double *theta = trial->theta;
    bool grown = true;

    RITZ_CHECK_NEW(r->rounding, trial->count);
    for (int64_t j = 0; j < trial->count; j++)
        r->rounding[j] = trial->rounding[j] + trial->reduced_rounding[j];
    while (grown) {
        grown = false;
        for (int64_t j = 0; j + 1 < trial->count; j++) {
            double *at = &r->rounding[j];
            double most = fmax(at[0], at[1]);

            if (theta[j + 1] - theta[j] > at[0] + at[1] ||
                fmin(at[0], at[1]) == most)
                continue;
            at[0] = at[1] = most;
            grown = true;
        }
    }
    return RITZ_OK;
}

/* Whether rounding is too small to mix rigid and flexible motions. */
static bool rigid_is_apart(const ritz_bounder *r)
{
    const double *theta = r->trial->theta;
    int64_t n = r->num_rigid;

    return n == 0 || n >= r->trial->count ||
           theta[n] - theta[n - 1] > r->rounding[n] + r->rounding[n - 1];
}

/* Largest change of the damping term w d of a mode whose stiffness is wrong by
   @p off. With a ratio it is 2 zeta w (sqrt(theta) - sqrt(theta - off)), for a
   stiffness that is too small. */
static double damping_off(const ritz_bounder *r, double w, double theta,
                          double off)
{
    double top = fmax(theta, off);

    return r->rayleigh ? w * r->b * off
                       : 2.0 * r->zeta * w * (sqrt(top) - sqrt(top - off));
}

/*
 * Change of a reduced response at @p w rad/s by rounding. An error of K_ij of
 * up to sqrt(r_i r_j), where r_i is the rounding of eigenvalue i, changes it by
 * eta_i eta_j times that error, and so does the damping that depends on K;
 * rounding of M_ij changes it as well. Between rigid motions only M counts,
 * provided that both models have the same rigid motions, whose stiffness is
 * then set to 0.
 */
static double rounding_at(const ritz_bounder *r, double w, const ritz_side *in,
                          const ritz_side *out)
{
    bool apart = rigid_is_apart(r);
    double all[2] = {0.0, 0.0};
    double rigid[2] = {0.0, 0.0};
    double mass[2] = {0.0, 0.0};

    for (int64_t j = 0; j < r->trial->count; j++) {
        double off = r->rounding[j];
        double own = w * sqrt(r->trial->mass_terms[j]);
        double each = sqrt(off + damping_off(r, w, r->trial->theta[j], off));

        mass[0] += own * cabs(in->eta[j]);
        mass[1] += own * cabs(out->eta[j]);
        all[0] += cabs(in->eta[j]) * each;
        all[1] += cabs(out->eta[j]) * each;
        if (j + 1 == r->num_rigid && apart) {
            rigid[0] = all[0];
            rigid[1] = all[1];
        }
    }
    return all[0] * all[1] - rigid[0] * rigid[1] +
           RITZ_CANCELLED_ROUNDINGS * DBL_EPSILON * mass[0] * mass[1];
}

/*
 * Damping that couples modes: with D and K4 as matrices the reduced model's
 * response and residual are exact,
 *
 *     (Theta - w^2 + i w X'DX + i X'K4X) eta = X'b,
 *     r = b_o - R eta - i w D_o eta - i K4_o eta,
 *
 * D_o and K4_o being D X and K4 X without their parts M X X'D X and M X X'K4 X,
 * so that X'r = 0. The response of the full model to r is not exact: its modes
 * are taken as uncoupled, hence this is no bound.
 */

/* X'A X; nothing of no A. */
static ritz_status condense_on_modes(const ritz_sparse *A, const ritz_dense *X,
                                     ritz_dense *out)
{
    return A->colptr ? ritz_sparse_condense(A, X, out)
                     : ritz_dense_new(X->ncol, X->ncol, out);
}

/* Room for it, and D and K4 of trial modes. */
static ritz_status open_coupled(const ritz_component *full, ritz_bounder *r)
{
    int64_t m = r->trial->count;

    RITZ_CHECK(condense_on_modes(&full->D, &r->trial->X, &r->D));
    RITZ_CHECK(condense_on_modes(&full->K4, &r->trial->X, &r->K4));
    for (int64_t j = r->num_rigid; j < m; j++)
        ritz_dense_col(&r->D, j)[j] += r->rates[j] - r->matrix_rates[j];
    RITZ_CHECK_NEW(r->Z, m * m);
    RITZ_CHECK_NEW(r->responses, m * r->num_sides);
    RITZ_CHECK_NEW(r->pivot, m);
    return RITZ_OK;
}

/* eta of one side, and the residual that it leaves. */
static void fill_side(const ritz_bounder *r, double w,
                      const double _Complex *eta, ritz_side *s)
{
    int64_t m = r->trial->count;
    int64_t last = r->size - 2 * m;

    for (int64_t j = 0; j < m; j++) {
        s->eta[j] = eta[j];
        s->residual[j] = -eta[j];
        s->residual[last + j] = -ritz_complex(0.0, w) * eta[j];
        s->residual[last + m + j] = -ritz_complex(0.0, 1.0) * eta[j];
    }
    s->change = s->damping_part = s->defect_quarter = s->defect_three = 0.0;
    s->self = 0.0;
    for (int64_t j = 0; j < m; j++)
        s->self += square_of(cabs(s->participation[j])) /
                   cabs(ritz_bounder_z(r, j, w));
}

/* eta and residuals of all sides at @p w, whose participations are there. */
static void solve_coupled(ritz_bounder *r, double w)
{
    int m = (int)r->trial->count;
    int sides = (int)r->num_sides;
    double _Complex *at = r->responses;

    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < m; i++)
            r->Z[i + j * m] = ritz_complex(
                i == j ? ritz_bounder_stiffness(r, j) - w * w : 0.0,
                w * ritz_dense_col(&r->D, j)[i] + ritz_dense_col(&r->K4, j)[i]);
    for (int64_t k = 0; k < sides; k++)
        memcpy(at + k * m, r->side[k].participation, (size_t)m * sizeof *at);
    if (LAPACKE_zgesv(LAPACK_COL_MAJOR, m, sides, r->Z, m, r->pivot, at, m))
        for (int64_t k = 0; k < (int64_t)m * sides; k++)
            at[k] = nan("");
    for (int64_t k = 0; k < sides; k++) {
        fill_side(r, w, at + k * m, &r->side[k]);
        r->side[k].residual_norm = norm_of(r, r->side[k].residual, r->GV);
    }
}

static ritz_status open_side(const ritz_bounder *r, ritz_side *s)
{
    RITZ_CHECK_NEW(s->residual, r->size);
    RITZ_CHECK_NEW(s->participation, r->trial->count);
    RITZ_CHECK_NEW(s->eta, r->trial->count);
    RITZ_CHECK_NEW(s->residual_slope, r->size);
    RITZ_CHECK_NEW(s->participation_slope, r->trial->count);
    RITZ_CHECK_NEW(s->curvature, r->trial->count);
    for (int k = 0; k < 3; k++)
        RITZ_CHECK_NEW(s->most[k], r->trial->count);
    return RITZ_OK;
}

static void ritz_side_free(ritz_side *s)
{
    RITZ_FREE(s->residual, s->participation, s->eta, s->residual_slope,
              s->participation_slope, s->curvature);
    RITZ_FREE(s->most[0], s->most[1], s->most[2]);
}

void ritz_bounder_free(ritz_bounder *r)
{
    RITZ_FREE_EACH(ritz_side, r->num_sides, r->side);
    ritz_dense_free(&r->V);
    ritz_dense_free(&r->E);
    ritz_dense_free(&r->G);
    ritz_dense_free(&r->Q);
    for (int k = 0; k <= KINDS; k++)
        ritz_dense_free(&r->channel[k]);
    RITZ_FREE(r->rates, r->rounding, r->vector_norm, r->sin2, r->GV, r->QV);
    ritz_dense_free(&r->D);
    ritz_dense_free(&r->K4);
    RITZ_FREE(r->Z, r->responses, r->pivot, r->at);
}

ritz_status ritz_bounder_open(ritz_estimator *estimator, ritz_bounder *r)
{
    const ritz_io *io = r->io;
    const ritz_dense *X = &r->trial->X;
    RITZ_OWN(ritz_dense) XB = {0};

    r->num_sides = io->num_inputs + io->num_outputs;
    r->size = (r->coupled ? 3 : 1) * r->trial->count + io->num_inputs +
              KINDS * io->num_outputs;
    for (int64_t j = 0; j < r->trial->count && !r->matrix_rates; j++)
        r->rates[j] = rate_at(r, ritz_bounder_stiffness(r, j));
    RITZ_CHECK(take_forms(estimator, r));
    RITZ_CHECK(take_sines(r));
    RITZ_CHECK(take_roundings(r));
    RITZ_CHECK(ritz_dense_mul_tn(X, &io->B, &XB));
    RITZ_CHECK(ritz_general_transpose(&XB, &r->channel[0]));
    RITZ_CHECK(ritz_dense_mul(&io->C, X, &r->channel[1]));
    RITZ_CHECK(ritz_dense_mul(&io->Cv, X, &r->channel[2]));
    RITZ_CHECK(ritz_dense_mul(&io->Ca, X, &r->channel[3]));
    RITZ_CHECK_NEW(r->side, r->num_sides);
    for (int64_t k = 0; k < r->num_sides; k++)
        RITZ_CHECK(open_side(r, &r->side[k]));
    RITZ_CHECK_NEW(r->GV, r->size);
    RITZ_CHECK_NEW(r->QV, r->size);
    RITZ_CHECK_NEW(r->at, io->num_inputs * io->num_outputs);
    for (int64_t k = 0; k < io->num_inputs * io->num_outputs; k++)
        r->at[k].weight = 1.0;
    return r->coupled ? open_coupled(estimator->component, r) : RITZ_OK;
}

/* Upper bounds of |eta_j|, |eta_j'| and |(c eta_j)''| within h of w. */
static void fill_most(const ritz_bounder *r, int64_t j, double w, double h,
                      ritz_side *s)
{
    double z = ritz_bounder_least_z(r, j, w, h);
    double z1 = hypot(2.0 * (w + h), r->rates[j]);
    double second = s->curvature[j];
    double first = cabs(s->participation_slope[j]) + h * second;
    double share = cabs(s->participation[j]) + h * first;
    double b = r->rayleigh ? r->b : 0.0;
    double eta2 = (second + 2.0 * first * z1 / z +
                   share * (2.0 * z1 * z1 / z + 2.0) / z) /
                  z;

    s->most[0][j] = share / z;
    s->most[1][j] = (first + share * z1 / z) / z;
    s->most[2][j] = hypot(1.0, (w + h) * b) * eta2 + 2.0 * b * s->most[1][j];
}

/*
 * One side at w, whose participations, and the parts of its residual and slope
 * that are not modal, are there. Within h of w
 *
 *     |r(w + d) - r(w)| <= h |r'(w)| + h^2 / 2 max |r''|,
 *
 * where r' is known as a vector, in which large parts cancel; `bent` is the
 * part of |r''| that is not modal.
 */
static void solve_side(ritz_bounder *r, double w, double h, double bent,
                       ritz_side *s)
{
    double b = r->rayleigh ? r->b : 0.0;
    number c = ritz_complex(1.0, w * b);
    double curve = bent;

    s->damping_part = s->defect_quarter = s->defect_three = s->self = 0.0;
    for (int64_t j = 0; j < r->trial->count; j++) {
        double theta = ritz_bounder_stiffness(r, j);
        number z = ritz_bounder_z(r, j, w);
        number z1 = ritz_complex(-2.0 * w, r->rates[j]);
        double size = r->vector_norm[j];

        s->eta[j] = s->participation[j] / z;
        s->residual[j] = -c * s->eta[j];
        s->residual_slope[j] =
            -ritz_complex(0.0, b) * s->eta[j] -
            c * (s->participation_slope[j] - s->eta[j] * z1) / z;
        fill_most(r, j, w, h, s);
        s->self += square_of(cabs(s->participation[j])) / cabs(z);
        if (h > 0.0)
            curve += size * s->most[2][j];
        if (r->rayleigh || theta <= 0.0)
            continue;
        size *= s->most[0][j];
        s->damping_part += size * 2.0 * r->zeta * (w + h) / sqrt(theta);
        s->defect_quarter += size / sqrt(sqrt(theta));
        s->defect_three += size / (sqrt(theta) * sqrt(sqrt(theta)));
    }
    s->residual_norm = norm_of(r, s->residual, r->GV);
    s->change =
        h > 0.0 ? h * norm_of(r, s->residual_slope, r->GV) + 0.5 * h * h * curve
                : 0.0;
}

void ritz_bounder_solve(ritz_bounder *r, double w, double h)
{
    const ritz_dense *C = &r->channel[1];
    int64_t m = r->trial->count;
    int64_t inputs = r->io->num_inputs, p = r->io->num_outputs;

    for (int64_t k = 0; k < r->num_sides; k++) {
        ritz_side *s = &r->side[k];
        int64_t at = m + k, i = k - inputs;

        memset(s->residual, 0, (size_t)r->size * sizeof(number));
        s->residual[at] = 1.0;
        for (int64_t j = 0; k < inputs && j < m; j++)
            s->participation[j] = ritz_dense_col(&r->channel[0], j)[k];
        if (k >= inputs) {
            s->residual[at + p] = ritz_complex(0.0, w);
            s->residual[at + 2 * p] = -w * w;
            s->residual_slope[at + p] = ritz_complex(0.0, 1.0);
            s->residual_slope[at + 2 * p] = -2.0 * w;
        }
        for (int64_t j = 0; k >= inputs && j < m; j++) {
            double cv = ritz_dense_col(&C[1], j)[i];
            double ca = ritz_dense_col(&C[2], j)[i];

            s->participation[j] =
                ritz_complex(ritz_dense_col(&C[0], j)[i] - w * w * ca, w * cv);
            s->participation_slope[j] = ritz_complex(-2.0 * w * ca, cv);
            s->curvature[j] = 2.0 * fabs(ca);
        }
        if (!r->coupled)
            solve_side(r, w, h,
                       k < inputs ? 0.0 : 2.0 * r->vector_norm[at + 2 * p], s);
    }
    if (r->coupled)
        solve_coupled(r, w);
}

/* One interval of frequencies. */
typedef struct frequency_interval {
    double low, high; /* w, both ends */
    number c, s;
    double most_s;   /* |s| anywhere within */
    double least_c2; /* |c|^2 */
} frequency_interval;

/* Bound of |rest| of a mode whose lambda lies in [low, high]. */
static double rest_of(const ritz_bounder *r, const frequency_interval *at,
                      double low, double high)
{
    double apart =
        fmax(0.0, fmax(low - at->high * at->high, at->low * at->low - high));
    double z = hypot(apart, at->low * rate_at(r, low));
    double mu = low - r->trial->sigma;
    double own = 0.0;

    if (!(z > 0.0))
        return HUGE_VAL;
    if (!r->rayleigh) {
        double over = fmin(1.0, at->high * rate_at(r, high) / z);

        if (isinf(high))
            over = apart > 0.0 ? at->high * rate_at(r, low) / apart : 1.0;
        own = fmin(1.0, over) * (1.0 + at->most_s / mu);
    }
    return at->most_s * at->most_s / (at->least_c2 * mu * z) + own;
}

/*
 * The rest and the part of damping, summed over modes: of the N lowest only the
 * part outside the trial space counts, sin^2; all others count fully. N is
 * chosen so that the bound is least.
 *
 * @param[in] all, added  products of norms that either goes with
 */
static double bound_rest(const ritz_bounder *r, const frequency_interval *at,
                         double all, double added)
{
    const ritz_enclosure *e = r->e;
    double sigma = r->trial->sigma;
    double sum = 0.0;
    double most = 0.0;
    double best = HUGE_VAL;

    for (int64_t N = 0; N < e->count; N++) {
        bool rigid = N < r->num_rigid; /* then both models have the mode at 0 */
        double low = rigid ? 0.0 : fmax(e->low[N], 0.0);
        double high = rigid ? 0.0 : e->high[N];
        double first = 1.0 + at->most_s / (low - sigma);
        double far = all * rest_of(r, at, low, HUGE_VAL) + added * first;
        double own = all * rest_of(r, at, low, high) + added * first;

        best = fmin(best, fmin(sum, most) + far);
        sum += r->sin2[N] * own;
        most = fmax(most, own);
    }
    return best;
}

static frequency_interval interval_of(const ritz_bounder *r, double w, double h)
{
    double sigma = r->trial->sigma;
    frequency_interval at = {
        .low = fmax(w - h, 0.0), .high = w + h, .c = 1.0, .least_c2 = 1.0};

    at.s = w * w - sigma;
    at.most_s = at.high * at.high - sigma;
    if (r->rayleigh) {
        at.c = ritz_complex(1.0, w * r->b);
        at.least_c2 += at.low * r->b * at.low * r->b;
        at.s = ritz_complex(w * w - sigma, -w * (r->a + r->b * sigma));
        at.most_s = hypot(at.most_s, at.high * fabs(r->a + r->b * sigma));
        at.most_s = fmax(at.most_s, cabs(at.s));
    }
    return at;
}

/* r_d' (A^-1 / c + s A^-1 M A^-1 / c^2) r_p, for the input of the last
   ritz_bounder_take_input. */
static number lead_of(const ritz_bounder *r, const frequency_interval *at,
                      const ritz_side *out)
{
    number lead = 0.0;

    for (int64_t i = 0; i < r->size; i++)
        lead += out->residual[i] *
                (r->GV[i] / at->c + at->s * r->QV[i] / (at->c * at->c));
    return lead;
}

void ritz_bound_pair(const ritz_bounder *r, double w, double h, int64_t input,
                     int64_t output, ritz_channel_bound *result)
{
    double *part = result->part;
    const ritz_side *in = &r->side[input];
    const ritz_side *out = &r->side[r->io->num_inputs + output];
    const frequency_interval at = interval_of(r, w, h);
    double sigma = -r->trial->sigma;
    double c = cabs(at.c);
    double P = in->residual_norm + in->change;
    double D = out->residual_norm + out->change;
    double varied = in->residual_norm * out->change + in->change * D;
    double turned = r->rayleigh ? h * r->b : 0.0;
    double moved = h * (2.0 * at.high + fabs(r->a + r->b * -sigma));
    double all = (P + in->damping_part) * (D + out->damping_part);

    result->known = lead_of(r, &at, out);
    part[RITZ_PART_ERROR] = cabs(result->known);
    part[RITZ_PART_DAMPING] = 0.0;
    if (!r->rayleigh)
        part[RITZ_PART_DAMPING] =
            r->zeta * at.high *
            (in->defect_quarter * out->defect_quarter +
             sigma * in->defect_three * out->defect_three);
    part[RITZ_PART_BETWEEN] =
        varied * (1.0 / c + cabs(at.s) / (c * c * sigma)) +
        (turned + moved / sigma +
         2.0 * turned * at.most_s / sigma / sqrt(at.least_c2)) /
            at.least_c2 * P * D;
    part[RITZ_PART_REST] = bound_rest(r, &at, all, all - P * D);
    part[RITZ_PART_ROUNDING] = rounding_at(r, at.high, in, out);
}

double ritz_rounding_of_pair(const ritz_bounder *r, double w, int64_t input,
                             int64_t output)
{
    return rounding_at(r, w, &r->side[input],
                       &r->side[r->io->num_inputs + output]);
}

void ritz_bounder_take_input(ritz_bounder *r, int64_t input)
{
    multiply_real(&r->G, r->side[input].residual, r->GV);
    multiply_real(&r->Q, r->side[input].residual, r->QV);
}
