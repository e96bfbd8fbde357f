/*
 * Difference between the response H_r of a trial X and H_2 of a richer one,
 * X_2, whose span contains X: X = X_2 W. In the modes of X_2, with Z_2 =
 * Theta_2 - w^2 + i w D_2 diagonal and eta = Z^-1 X'b,
 *
 *     r_p = X_2'b - Z_2 W eta_p = X_2'b_o - (X_2'R + i w U_d) eta_p,
 *     U_d = D_2 W - W D,
 *     H_2 - H_r = r_d' Z_2^-1 r_p - i w eta_d' (W'D_2 W - D) eta_p
 *
 * Nothing cancels in these sums, since X_2'R = Theta_2 W - W Theta is of the
 * size of the trial's errors. With D = a M + b K, U_d = b X_2'R, and the last
 * term is 0; with a ratio zeta and v_k the square root of theta_k,
 *
 *     (U_d)_kj = 2 zeta (X_2'R)_kj / (v_k + v_j),
 *     (W'D_2 W - D)_ij = -(U_d'U_d)_ij / (2 zeta (v_i + v_j))
 *
 * The richer trial adds A^-1 V to the trial, where residuals are linear
 * combinations of V. The remaining error H - H_2 is bounded as in response.c;
 * it is smaller by the square of the gain of an inverse iteration.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "estimate/estimator.h"
#include "linear/general.h"

#include <math.h>
#include <string.h>

/* |v|_(A^-1) of column k of V, together with its part in the trial. */
static double whole_norm(const ritz_bounder *r, int64_t k)
{
    const ritz_lehmann *trial = r->trial;
    int64_t m = trial->count, load = k - m;
    int64_t inputs = r->io->num_inputs;
    double sum = r->vector_norm[k] * r->vector_norm[k];

    if (k < m)
        return sqrt(trial->theta[k] - trial->sigma);
    for (int64_t j = 0; j < m; j++) {
        int64_t row = load - inputs;
        double share =
            load < inputs
                ? ritz_dense_col(&r->channel[0], j)[load]
                : ritz_dense_col(&r->channel[1 + row / r->io->num_outputs],
                                 j)[row % r->io->num_outputs];

        sum += share * share / (trial->theta[j] - trial->sigma);
    }
    return sqrt(sum);
}

/* Columns of E = A^-1 V, scaled to unit length in A; those that are rounding
   are left out. */
static ritz_status take_long(const ritz_bounder *r, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(r->E.nrow, r->size, out));
    out->ncol = 0;
    for (int64_t k = 0; k < r->size; k++) {
        const double *from = ritz_dense_col(&r->E, k);
        double *to = NULL;

        if (!(r->vector_norm[k] > RITZ_ENRICH_LEAST * whole_norm(r, k)))
            continue;
        to = ritz_dense_col(out, out->ncol++);
        for (int64_t i = 0; i < out->nrow; i++)
            to[i] = from[i] / r->vector_norm[k];
    }
    return RITZ_OK;
}

/* An A-orthonormal basis of the span of Y, from the eigenvectors of Y'(K -
   sigma M) Y. */
static ritz_status take_independent(const ritz_component *full, double sigma,
                                    const ritz_dense *Y, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    int64_t n = Y->ncol, first = 0;
    ritz_dense kept = {0};

    RITZ_CHECK(ritz_sparse_condense(&full->K, Y, &K));
    RITZ_CHECK(ritz_sparse_condense(&full->M, Y, &M));
    ritz_dense_add(-sigma, &M, &K);
    RITZ_CHECK(ritz_general_symmetric(&K, &pairs));
    while (first < n && !(pairs.lambda[first] > RITZ_ENRICH_INDEPENDENT))
        first++;
    for (int64_t j = first; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&pairs.Phi, j)[i] /= sqrt(pairs.lambda[j]);
    kept = ritz_dense_part(&pairs.Phi, first, n - first);
    return ritz_dense_mul(Y, &kept, out);
}

/*
 * Remove, in A, the part of Y in the trial. A column whose residual is little
 * more than rounding contains as much of the trial as of anything new.
 */
static ritz_status take_trial_out(const ritz_component *full,
                                  const ritz_lehmann *trial, ritz_dense *Y)
{
    RITZ_OWN(ritz_dense) X = {0}, AX = {0}, MX = {0};

    RITZ_CHECK(ritz_dense_copy(&trial->X, &X));
    RITZ_CHECK(ritz_sparse_mul(&full->K, &X, &AX));
    RITZ_CHECK(ritz_sparse_mul(&full->M, &X, &MX));
    ritz_dense_add(-trial->sigma, &MX, &AX);
    for (int64_t j = 0; j < X.ncol; j++)
        for (int64_t i = 0; i < X.nrow; i++)
            ritz_dense_col(&X, j)[i] /= trial->theta[j] - trial->sigma;
    for (int pass = 0; pass < 2; pass++)
        RITZ_CHECK(ritz_dense_take_out(&X, &AX, Y));
    return RITZ_OK;
}

ritz_status ritz_enrich(ritz_estimator *estimator, const ritz_bounder *coarse,
                        ritz_lehmann *rich)
{
    const ritz_lehmann *trial = coarse->trial;
    RITZ_OWN(ritz_dense) more = {0}, apart = {0}, Y = {0};

    RITZ_CHECK(take_long(coarse, &more));
    if (more.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(take_trial_out(estimator->component, trial, &more));
    RITZ_CHECK(
        take_independent(estimator->component, trial->sigma, &more, &apart));
    if (apart.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_beside(&trial->X, &apart, &Y));
    for (int64_t j = 0; j < trial->count; j++)
        for (int64_t i = 0; i < Y.nrow; i++)
            ritz_dense_col(&Y, j)[i] /= sqrt(trial->theta[j] - trial->sigma);
    return ritz_lehmann_of_span(estimator, &Y, rich);
}

/* sqrt(theta_k) + sqrt(theta_j) of modes of either trial. */
static double sum_roots(const ritz_bounder *a, int64_t k, const ritz_bounder *b,
                        int64_t j)
{
    return sqrt(fmax(ritz_bounder_stiffness(a, k), 0.0)) +
           sqrt(fmax(ritz_bounder_stiffness(b, j), 0.0));
}

/* U_d and the defect W'D_2 W - D, with ratios. */
static ritz_status take_ratios(const ritz_bounder *coarse, ritz_refinement *f)
{
    const double twice = 2.0 * coarse->zeta;
    int64_t m = coarse->trial->count, n = f->fine.trial->count;

    RITZ_CHECK(ritz_dense_new(n, m, &f->U_d));
    for (int64_t j = 0; j < m; j++)
        for (int64_t k = 0; k < n; k++) {
            double roots = sum_roots(&f->fine, k, coarse, j);

            if (roots > 0.0)
                ritz_dense_col(&f->U_d, j)[k] =
                    twice * ritz_dense_col(&f->U, j)[k] / roots;
        }
    RITZ_CHECK(ritz_dense_mul_tn(&f->U_d, &f->U_d, &f->defect));
    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < m; i++) {
            double roots = sum_roots(coarse, i, coarse, j);
            double *at = &ritz_dense_col(&f->defect, j)[i];

            *at = roots > 0.0 && twice > 0.0 ? -*at / (twice * roots) : 0.0;
        }
    return RITZ_OK;
}

static ritz_status open_side(int64_t rich, ritz_finer_side *s)
{
    RITZ_CHECK_NEW(s->r, rich);
    RITZ_CHECK_NEW(s->slope, rich);
    RITZ_CHECK_NEW(s->curvature, rich);
    return RITZ_OK;
}

ritz_status ritz_refinement_new(ritz_estimator *estimator,
                                const ritz_bounder *coarse,
                                const ritz_lehmann *rich,
                                const ritz_enclosure *enclosure,
                                ritz_refinement *out)
{
    RITZ_OWN(ritz_refinement)
    f = {.fine = {.trial = rich,
                  .e = enclosure,
                  .io = coarse->io,
                  .num_rigid = coarse->num_rigid,
                  .rayleigh = coarse->rayleigh,
                  .zeta = coarse->zeta,
                  .a = coarse->a,
                  .b = coarse->b},
         .num_sides = coarse->num_sides};

    RITZ_CHECK_NEW(f.fine.rates, rich->count);
    RITZ_CHECK(ritz_bounder_open(estimator, &f.fine));
    ritz_dense_free(&f.fine.V);
    ritz_dense_free(&f.fine.E);
    RITZ_CHECK(ritz_dense_mul_tn(&rich->X, &coarse->V, &f.U));
    if (!coarse->rayleigh)
        RITZ_CHECK(take_ratios(coarse, &f));
    RITZ_CHECK_NEW(f.side, f.num_sides);
    for (int64_t k = 0; k < f.num_sides; k++)
        RITZ_CHECK(open_side(rich->count, &f.side[k]));
    RITZ_MOVE(*out, f);
    return RITZ_OK;
}

static void ritz_finer_side_free(ritz_finer_side *s)
{
    RITZ_FREE(s->r, s->slope, s->curvature);
}

void ritz_refinement_free(ritz_refinement *f)
{
    ritz_bounder_free(&f->fine);
    ritz_dense_free(&f->U);
    ritz_dense_free(&f->U_d);
    ritz_dense_free(&f->defect);
    RITZ_FREE_EACH(ritz_finer_side, f->num_sides, f->side);
}

/* y += x A_j, column j of A. */
static void add_column(const ritz_dense *A, int64_t j, double _Complex x,
                       double _Complex *y)
{
    const double *a = ritz_dense_col(A, j);

    for (int64_t i = 0; i < A->nrow && x != 0.0; i++)
        y[i] += a[i] * x;
}

/* y += x |A_j|, magnitudes of column j of A. */
static void add_magnitudes(const ritz_dense *A, int64_t j, double x, double *y)
{
    const double *a = ritz_dense_col(A, j);

    for (int64_t i = 0; i < A->nrow && x != 0.0; i++)
        y[i] += fabs(a[i]) * x;
}

/* r, r' and an upper bound of |r''| of one side. */
static void fill_side(const ritz_bounder *coarse, const ritz_refinement *f,
                      const ritz_side *s, double w, double h,
                      ritz_finer_side *out)
{
    int64_t m = coarse->trial->count, n = f->U.nrow;
    int64_t accelerations = coarse->size - coarse->io->num_outputs;

    memset(out->r, 0, (size_t)n * sizeof *out->r);
    memset(out->slope, 0, (size_t)n * sizeof *out->slope);
    memset(out->curvature, 0, (size_t)n * sizeof *out->curvature);
    for (int64_t j = 0; j < coarse->size; j++) {
        add_column(&f->U, j, s->residual[j], out->r);
        if (h > 0.0)
            add_column(&f->U, j, s->residual_slope[j], out->slope);
        if (h > 0.0 && j < m)
            add_magnitudes(&f->U, j, s->most[2][j], out->curvature);
        else if (h > 0.0 && j >= accelerations && s->residual[j] != 0.0)
            add_magnitudes(&f->U, j, 2.0, out->curvature); /* second derivative
                                                              of w^2 */
    }
    for (int64_t j = 0; j < m && f->U_d.val; j++) {
        double _Complex slope = -s->residual_slope[j]; /* eta': residual_slope
                                                          is -c eta', and c = 1
                                                          with ratios */

        add_column(&f->U_d, j, -ritz_complex(0.0, w) * s->eta[j], out->r);
        if (!(h > 0.0))
            continue;
        add_column(&f->U_d, j,
                   -ritz_complex(0.0, 1.0) * (s->eta[j] + w * slope),
                   out->slope);
        add_magnitudes(&f->U_d, j,
                       (w + h) * s->most[2][j] + 2.0 * s->most[1][j],
                       out->curvature);
    }
}

void ritz_refinement_solve(const ritz_bounder *coarse, ritz_refinement *f,
                           double w, double h)
{
    ritz_bounder_solve(&f->fine, w, h);
    for (int64_t k = 0; k < f->num_sides; k++)
        fill_side(coarse, f, &coarse->side[k], w, h, &f->side[k]);
}

/* r_d' Z_2^-1 r_p, and its derivative by w. */
static void multiply_sides(const ritz_refinement *f, double w,
                           const ritz_finer_side *in,
                           const ritz_finer_side *out,
                           double _Complex product[2])
{
    product[0] = product[1] = 0.0;
    for (int64_t k = 0; k < f->U.nrow; k++) {
        double _Complex z = ritz_bounder_z(&f->fine, k, w);
        double _Complex z1 = ritz_complex(-2.0 * w, f->fine.rates[k]);

        product[0] += out->r[k] * in->r[k] / z;
        product[1] += (out->slope[k] * in->r[k] + out->r[k] * in->slope[k] -
                       out->r[k] * in->r[k] * z1 / z) /
                      z;
    }
}

/* Upper bounds of |x|, |x'| and |x''| within h, of entry k of a residual. */
static void bound_entry(const ritz_finer_side *s, int64_t k, double h,
                        double most[3])
{
    most[2] = s->curvature[k];
    most[1] = cabs(s->slope[k]) + h * most[2];
    most[0] = cabs(s->r[k]) + h * most[1];
}

/* Upper bound of the second derivative of r_d' Z_2^-1 r_p within h of w. */
static double bound_curvature(const ritz_refinement *f, double w, double h,
                              const ritz_finer_side *in,
                              const ritz_finer_side *out)
{
    double sum = 0.0;

    for (int64_t k = 0; k < f->U.nrow; k++) {
        double z = ritz_bounder_least_z(&f->fine, k, w, h);
        double z1 = hypot(2.0 * (w + h), f->fine.rates[k]);
        double p[3], d[3], both = 0.0;

        bound_entry(in, k, h, p);
        bound_entry(out, k, h, d);
        both = d[0] * p[0];
        if (both == 0.0 && d[2] * p[0] + d[0] * p[2] + d[1] * p[1] == 0.0)
            continue;
        if (!(z > 0.0))
            return HUGE_VAL;
        sum += (d[2] * p[0] + 2.0 * d[1] * p[1] + d[0] * p[2]) / z +
               2.0 * (d[1] * p[0] + d[0] * p[1]) * z1 / (z * z) +
               both * (2.0 * z1 * z1 / z + 2.0) / (z * z);
    }
    return sum;
}

/* i w eta_d' (W'D_2 W - D) eta_p, without conjugation of eta_d. */
static double _Complex multiply_defect(const ritz_refinement *f, double w,
                                       const ritz_side *in,
                                       const ritz_side *out)
{
    int64_t m = f->defect.ncol;
    double _Complex sum = 0.0;

    for (int64_t j = 0; j < m; j++) {
        double _Complex part = 0.0;

        for (int64_t i = 0; i < m; i++)
            part += out->eta[i] * ritz_dense_col(&f->defect, j)[i];
        sum += part * in->eta[j];
    }
    return ritz_complex(0.0, w) * sum;
}

/* Upper bound of the change of multiply_defect within h of w: h times its
   largest derivative. */
static double vary_defect(const ritz_refinement *f, double w, double h,
                          const ritz_side *in, const ritz_side *out)
{
    double sum = 0.0;

    for (int64_t j = 0; j < f->defect.ncol; j++)
        for (int64_t i = 0; i < f->defect.nrow; i++)
            sum += fabs(ritz_dense_col(&f->defect, j)[i]) *
                   (out->most[0][i] * in->most[0][j] +
                    (w + h) * (out->most[1][i] * in->most[0][j] +
                               out->most[0][i] * in->most[1][j]));
    return h * sum;
}

void ritz_refinement_bound(const ritz_bounder *coarse, const ritz_refinement *f,
                           double w, double h, int64_t input, int64_t output,
                           ritz_channel_bound *result)
{
    int64_t row = coarse->io->num_inputs + output;
    const ritz_side *from = &coarse->side[input], *to = &coarse->side[row];
    const ritz_finer_side *in = &f->side[input], *out = &f->side[row];
    double _Complex product[2];
    ritz_channel_bound rest = {0};
    const double *left = rest.part;
    double *part = result->part;

    multiply_sides(f, w, in, out, product);
    ritz_bound_pair(&f->fine, w, h, input, output, &rest);
    result->known = product[0] - multiply_defect(f, w, from, to);
    part[RITZ_PART_ERROR] = cabs(result->known);
    part[RITZ_PART_DAMPING] = left[RITZ_PART_DAMPING];
    part[RITZ_PART_REST] = left[RITZ_PART_ERROR] + left[RITZ_PART_REST];
    part[RITZ_PART_BETWEEN] = left[RITZ_PART_BETWEEN];
    if (h > 0.0)
        part[RITZ_PART_BETWEEN] +=
            h * cabs(product[1]) +
            0.5 * h * h * bound_curvature(f, w, h, in, out) +
            vary_defect(f, w, h, from, to);
    part[RITZ_PART_ROUNDING] =
        left[RITZ_PART_ROUNDING] +
        ritz_rounding_of_pair(coarse, w + h, input, output);
}
