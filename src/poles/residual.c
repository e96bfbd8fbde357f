/*
 * Response of all modes above those of `pairs`, free bodies included:
 *
 *     K R_0 = B - M Phi Phi'B,   K R_j = M R_(j-1),   Phi'M R_j = 0
 *
 * Damping a M + b K acts on those modes too:
 *
 *     lambda (1 + i w b) + i w a - w^2 = (1 + i w b) (lambda - mu),
 *     mu = (w^2 - i w a) / (1 + i w b)
 *
 * so that X = (R_0 + mu R_1 + mu^2 R_2 + ...) / (1 + i w b), whose terms fall
 * by |mu| / lambda. |mu| grows with w. Term j is stored as mu_1^j R_j, where
 * mu_1 is |mu| at the end of the range: powers of rad^2/s^2 would overflow.
 *
 * The change by damping ratios is a sum over these modes or, if there are too
 * many to compute, over Ritz vectors in their place.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "model/modal.h"
#include "poles/poles.h"

#include <ritz/matrix.h>
#include <ritz/verify.h>

#include <cblas.h>
#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/*
 * The a and b for which |D - a M - b K| is least in the Frobenius norm, M and K
 * taken as vectors m and k of their entries,
 *
 *     e = k - (m.k / m.m) m,    b = e.d / e.e,    a = (m.d - b m.k) / m.m
 */

/* Sum of the products of entries of A and B at the same places. */
static ritz_status inner_product(const ritz_sparse *A, const ritz_sparse *B,
                                 double *out)
{
    RITZ_OWN(ritz_sparse) a = {0}, b = {0}; /* on the union of both patterns */

    RITZ_CHECK(ritz_sparse_add(1.0, A, 0.0, B, &a));
    RITZ_CHECK(ritz_sparse_add(0.0, A, 1.0, B, &b));
    *out = 0.0;
    for (int64_t p = 0; p < a.colptr[a.ncol]; p++)
        *out += a.val[p] * b.val[p];
    return RITZ_OK;
}

/* |D - a M - b K| / |D| */
static ritz_status residual_of(const ritz_component *c, double a, double b,
                               double *out)
{
    RITZ_OWN(ritz_sparse) sum = {0}, rest = {0};
    double size = 0.0;

    RITZ_CHECK(ritz_sparse_add(a, &c->M, b, &c->K, &sum));
    RITZ_CHECK(ritz_sparse_add(1.0, &c->D, -1.0, &sum, &rest));
    *out = 0.0;
    for (int64_t p = 0; p < rest.colptr[rest.ncol]; p++)
        *out = hypot(*out, rest.val[p]);
    for (int64_t p = 0; p < c->D.colptr[c->D.ncol]; p++)
        size = hypot(size, c->D.val[p]);
    *out = size > 0.0 ? *out / size : 0.0;
    return RITZ_OK;
}

/* a and b; b = 0 without stiffness, or where K is a multiple of M. */
static ritz_status fit_coefficients(const ritz_component *c, double *a,
                                    double *b)
{
    double mm = 0.0, mk = 0.0, kk = 0.0, md = 0.0, kd = 0.0;
    double ee = 0.0;

    RITZ_CHECK(inner_product(&c->M, &c->M, &mm));
    RITZ_CHECK(inner_product(&c->M, &c->K, &mk));
    RITZ_CHECK(inner_product(&c->K, &c->K, &kk));
    RITZ_CHECK(inner_product(&c->M, &c->D, &md));
    RITZ_CHECK(inner_product(&c->K, &c->D, &kd));
    ee = mm > 0.0 ? kk - mk * (mk / mm) : kk;
    *b = ee > RITZ_PROPORTIONAL_RANK * kk
             ? (kd - (mm > 0.0 ? md * (mk / mm) : 0.0)) / ee
             : 0.0;
    *a = mm > 0.0 ? (md - *b * mk) / mm : 0.0;
    return RITZ_OK;
}

ritz_status ritz_proportional(const ritz_component *component, double *a,
                              double *b, double *left)
{
    RITZ_CHECK(fit_coefficients(component, a, b));
    return residual_of(component, *a, *b, left);
}

/*
 * K R = f, Phi'M R = 0, is consistent where f = (I - M Phi Phi') f, the rigid
 * modes being among Phi, and is solved with A = K - sigma M, sigma < 0, by
 *
 *     A R_new = f - sigma M R,
 *
 * whose error falls by |sigma| / (lambda + |sigma|) a step, lambda being of the
 * first mode that is left out.
 *
 * Where no mass is left in the rest, M R_0 = 0: R_0 is all its response, and
 * all other terms are rounding. So a term is held to what it adds at the end of
 * the range, relative to the whole response there, and not to its own size.
 */

typedef struct rest_solver {
    const ritz_sparse *M;  /* borrowed, as Phi is */
    const ritz_dense *Phi; /* the modes that are known */
    ritz_dense MPhi;
    ritz_factor *F;
    double sigma;
    double *
        whole; /* of each input, the response of all modes and R_0 at the end */
    bool begun; /* R_0 is known */
} rest_solver;

/* Steps shrink by 100 or more, so that 8 reach rounding; a body of which no
   flexible mode is kept may need more. */
enum { MOST_STEPS = 200 };

static void rest_solver_free(rest_solver *s)
{
    ritz_dense_free(&s->MPhi);
    ritz_factor_free(&s->F);
    free(s->whole);
}

/*
 * Shift for a body of which only rigid modes are kept: a hundredth of the
 * eigenvalue that all others exceed, but large enough that K - sigma M stays
 * definite in spite of rounding.
 */
static double rigid_shift(const ritz_component *component,
                          const ritz_pairs *pairs, double out_hz)
{
    double usual = pairs->sigma < 0.0 ? -pairs->sigma : 1.0;
    double least = 0.0;

    for (int64_t j = 0; j < component->num_dofs; j++) {
        double m = ritz_sparse_diagonal(&component->M, j);

        if (m > 0.0)
            least = fmax(least, RITZ_SHIFT_LOST *
                                    ritz_sparse_diagonal(&component->K, j) / m);
    }
    return -fmin(usual,
                 fmax(least, RITZ_SERIES_SHIFT * ritz_eigen_lambda(out_hz)));
}

/*
 * The largest value of sum_k |phi_k| |phi_k'b| / max(lambda_k, w^2), of each
 * input: the size of the modal response between resonances.
 */
static ritz_status size_modes(const ritz_pairs *pairs, const ritz_dense *B,
                              double to_hz, double *out)
{
    double w2 = ritz_eigen_lambda(to_hz);
    RITZ_OWN(ritz_dense) share = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&pairs->Phi, B, &share));
    for (int64_t j = 0; j < B->ncol; j++)
        for (int64_t i = 0; i < B->nrow; i++) {
            double sum = 0.0;

            for (int64_t k = 0; k < pairs->Phi.ncol; k++) {
                double lambda = fmax(pairs->lambda[k], w2);

                if (lambda > 0.0)
                    sum += fabs(ritz_dense_col(&pairs->Phi, k)[i] *
                                ritz_dense_col(&share, j)[k]) /
                           lambda;
            }
            out[j] = fmax(out[j], sum);
        }
    return RITZ_OK;
}

static ritz_status rest_solver_new(const ritz_component *component,
                                   const ritz_pairs *pairs, double to_hz,
                                   double out_hz, rest_solver *s)
{
    const ritz_dense *B = &component->io.B;
    int64_t m = pairs->Phi.ncol;
    RITZ_OWN(ritz_sparse) A = {0};

    s->M = &component->M;
    s->Phi = &pairs->Phi;
    s->sigma = rigid_shift(component, pairs, out_hz);
    if (m > pairs->num_rigid)
        s->sigma = -RITZ_SERIES_SHIFT * pairs->lambda[m - 1];
    else if (m == 0) /* nothing moves freely: K is definite */
        s->sigma = 0.0;
    RITZ_CHECK(ritz_sparse_mul(s->M, s->Phi, &s->MPhi));
    RITZ_CHECK(
        ritz_sparse_add(1.0, &component->K, -s->sigma, &component->M, &A));
    RITZ_CHECK_IN("static solution", ritz_factor_spd(&A, &s->F));
    RITZ_CHECK_NEW(s->whole, B->ncol);
    return size_modes(pairs, B, to_hz, s->whole);
}

/*
 * How much the last iteration changed a term, the worst of all inputs, relative
 * to a tolerance: that at which the iteration ends (@p change), and the larger
 * one that must be met (@p required). Both are parts of the largest value of the
 * term plus parts of the whole response at the end of the range.
 */
static void measure_change(const rest_solver *s, const ritz_dense *R,
                           const ritz_dense *last, double *change,
                           double *required)
{
    *change = *required = 0.0;
    for (int64_t j = 0; j < R->ncol; j++) {
        double moved = 0.0;
        double size = ritz_dense_col_max(R, j);
        double whole = s->whole[j];

        for (int64_t i = 0; i < R->nrow; i++)
            moved = fmax(moved, fabs(ritz_dense_col(R, j)[i] -
                                     ritz_dense_col(last, j)[i]));
        if (!(moved > 0.0))
            continue;
        *change = fmax(*change, moved / (RITZ_SERIES_SETTLED * size +
                                         RITZ_SERIES_NEGLIGIBLE * whole));
        *required = fmax(*required, moved / (RITZ_REFINED_NEARLY * size +
                                             RITZ_SERIES_WITHIN * whole));
    }
}

/* M-orthogonal to the modes up to rounding: two passes are enough. */
static ritz_status take_out_twice(const ritz_dense *left,
                                  const ritz_dense *right, ritz_dense *X)
{
    RITZ_CHECK(ritz_dense_take_out(left, right, X));
    return ritz_dense_take_out(left, right, X);
}

static ritz_status rest_solve(rest_solver *s, ritz_dense *f, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) R = {0};
    RITZ_OWN(ritz_dense) next = {0};
    double change = HUGE_VAL, required = HUGE_VAL;

    RITZ_CHECK(take_out_twice(&s->MPhi, s->Phi, f));
    RITZ_CHECK(ritz_dense_new(f->nrow, f->ncol, &R));
    for (int step = 0; step < MOST_STEPS && change > 1.0; step++) {
        RITZ_CHECK(ritz_sparse_mul(s->M, &R, &next));
        for (int64_t k = 0; k < f->nrow * f->ncol; k++)
            next.val[k] = f->val[k] - s->sigma * next.val[k];
        RITZ_CHECK(ritz_factor_solve(s->F, &next));
        RITZ_CHECK(take_out_twice(s->Phi, &s->MPhi, &next));
        measure_change(s, &next, &R, &change, &required);
        ritz_dense_free(&R);
        RITZ_MOVE(R, next);
    }
    RITZ_REFUSE_IF(
        !(required <= 1.0), RITZ_ERR_CONVERGENCE,
        "the response of modes above the band did not settle in %d steps: "
        "the last one changed it by %.1e",
        (int)MOST_STEPS, required * RITZ_REFINED_NEARLY);
    for (int64_t j = 0; !s->begun && j < R.ncol; j++)
        s->whole[j] = fmax(s->whole[j], ritz_dense_col_max(&R, j));
    s->begun = true;
    RITZ_MOVE(*out, R);
    return RITZ_OK;
}

enum { MOST_TERMS = 40 };

/* Term j at the outputs. */
static ritz_status put_term(const ritz_dense *C, const ritz_dense *R, int64_t j,
                            double *out)
{
    RITZ_OWN(ritz_dense) CR = {0};

    RITZ_CHECK(ritz_dense_mul(C, R, &CR));
    memcpy(out + j * CR.nrow * CR.ncol, CR.val,
           (size_t)(CR.nrow * CR.ncol) * sizeof *out);
    return RITZ_OK;
}

static ritz_status add_terms(const ritz_component *component, rest_solver *s,
                             ritz_residual *r)
{
    const ritz_io *io = &component->io;
    const ritz_dense *const rows[] = {&io->C, &io->Cv, &io->Ca};
    RITZ_OWN(ritz_dense) f = {0};
    RITZ_OWN(ritz_dense) R = {0};

    RITZ_CHECK(ritz_dense_copy(&io->B, &f));
    for (int64_t j = 0; j < r->count; j++) {
        RITZ_CHECK(rest_solve(s, &f, &R));
        for (int k = 0; k < 3; k++)
            RITZ_CHECK(put_term(rows[k], &R, j, r->part[k]));
        ritz_dense_free(&f);
        RITZ_CHECK(ritz_sparse_mul(&component->M, &R, &f));
        for (int64_t k = 0; k < f.nrow * f.ncol; k++)
            f.val[k] *= r->unit;
        ritz_dense_free(&R);
    }
    return RITZ_OK;
}

/* a and b of given damping, and of D if it has any; what else D and K4 do to
 * the rest is not known. */
static ritz_status take_damping(const ritz_component *component,
                                const ritz_damping *damping, ritz_residual *r)
{
    double left = 0.0;

    r->known = !component->K4.colptr;
    if (component->D.colptr && component->D.colptr[component->D.ncol] > 0)
        RITZ_CHECK(ritz_proportional(component, &r->a, &r->b, &left));
    if (left > RITZ_PROPORTIONAL_WITHIN) {
        r->a = r->b = 0.0;
        r->known = false;
    }
    if (damping && ritz_damping_is_rayleigh(damping)) {
        r->a += damping->a;
        r->b += damping->b;
    }
    return RITZ_OK;
}

/*
 * Terms until (|mu| / lambda)^j is small at the end. Where damping keeps the
 * series from that, it is left out.
 */
static int64_t count_terms(double to_hz, double out_hz, ritz_residual *r)
{
    double w = sqrt(ritz_eigen_lambda(to_hz));
    double lambda = ritz_eigen_lambda(out_hz);
    double mu = w * hypot(w, r->a) / hypot(1.0, w * r->b);

    if (mu > w * w && mu > RITZ_SERIES_FALLS * lambda) {
        mu = w * w;
        r->a = r->b = 0.0;
        r->known = false;
    }
    r->unit = mu;
    if (!(mu < lambda))
        return MOST_TERMS;
    return (int64_t)fmin(
        MOST_TERMS, 1.0 + ceil(log(RITZ_SERIES_WITHIN) / log(mu / lambda)));
}

/* Add the modes above `pairs` and their rates from given ratios. */
static ritz_status take_ratios(const ritz_component *component,
                               const ritz_damping *damping,
                               const ritz_pairs *pairs, double out_hz,
                               ritz_residual *r)
{
    const int64_t first = pairs->Phi.ncol - pairs->num_rigid;
    RITZ_OWN(ritz_dense) Phi = {0};

    if (component->num_dofs > RITZ_RATIO_DOFS)
        return ritz_ratio_space(component, damping, pairs, out_hz, r);
    RITZ_CHECK_IN("modes above the band",
                  ritz_modes_above(component, pairs, &Phi, &r->lambda));
    r->num_damped = Phi.ncol;
    RITZ_CHECK_NEW(r->rate, r->num_damped);
    for (int64_t k = 0; k < r->num_damped; k++)
        r->rate[k] = ritz_modal_rate(damping, first + k, r->lambda[k]);
    return ritz_io_project(&component->io, &Phi, &r->modes);
}

ritz_status ritz_residual_new(const ritz_component *component,
                              const ritz_damping *damping,
                              const ritz_pairs *pairs, double to_hz,
                              double out_hz, ritz_residual *out)
{
    const ritz_io *io = &component->io;
    int64_t pm = io->num_outputs * io->num_inputs;
    RITZ_OWN(ritz_residual)
    r = {.num_outputs = io->num_outputs,
         .num_inputs = io->num_inputs,
         .known = true,
         .unit = 1.0};
    RITZ_OWN(rest_solver) s = {0};

    if (pairs->Phi.ncol < component->num_dofs && pm > 0) {
        RITZ_CHECK(take_damping(component, damping, &r));
        r.count = count_terms(to_hz, out_hz, &r);
    }
    for (int k = 0; k < 3; k++)
        RITZ_CHECK_NEW(r.part[k], r.count * pm);
    if (r.count > 0) {
        RITZ_CHECK(rest_solver_new(component, pairs, to_hz, out_hz, &s));
        RITZ_CHECK(add_terms(component, &s, &r));
    }
    if (r.count > 0 && ritz_ratios_act_on_all(component, damping))
        RITZ_CHECK(take_ratios(component, damping, pairs, out_hz, &r));
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

ritz_status ritz_residual_of_ratios(const ritz_component *component,
                                    const ritz_damping *damping,
                                    const ritz_pairs *pairs, double out_hz,
                                    ritz_residual *out)
{
    RITZ_OWN(ritz_residual) r = {.known = true, .unit = 1.0};

    if (ritz_ratios_act_on_all(component, damping) &&
        pairs->Phi.ncol < component->num_dofs)
        RITZ_CHECK(take_ratios(component, damping, pairs, out_hz, &r));
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

/*
 * Motions without mass. With A = K + alpha M = C C', definite, the columns of
 * C'Phi are orthogonal; N is C'^-1 of what completes them:
 *
 *     N'AN = I,   Phi'AN = (Lambda + alpha) Phi'MN = 0,   so M N = 0
 */

/* C, lower triangle, of K + alpha M; alpha beyond all |lambda|. */
static ritz_status factor_shifted(const ritz_second_order *model, int64_t m,
                                  const double *lambda, ritz_dense *C)
{
    int n = (int)model->K->nrow;
    double alpha = 0.0;
    int info = 0;

    for (int64_t k = 0; k < m; k++)
        alpha = fmax(alpha, 2.0 * fabs(lambda[k]));
    if (alpha == 0.0)
        alpha = 1.0;
    RITZ_CHECK(ritz_dense_copy(model->K, C));
    for (int64_t i = 0; i < C->nrow * C->ncol; i++)
        C->val[i] += alpha * model->M->val[i];
    info = LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, C->val, n);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_SINGULAR,
                   "neither mass nor stiffness holds a motion");
    return RITZ_OK;
}

/* The last n - m columns of an orthonormal basis whose first span B's. */
static ritz_status complete_basis(ritz_dense *B, ritz_dense *out)
{
    int n = (int)B->nrow;
    int m = (int)B->ncol;
    RITZ_OWN_ARRAY double *tau = NULL;
    int info = 0;

    RITZ_CHECK_NEW(tau, m);
    RITZ_CHECK(ritz_dense_new(n, n - m, out));
    for (int64_t j = 0; j < n - m; j++)
        ritz_dense_col(out, j)[m + j] = 1.0;
    if (m > 0)
        info = LAPACKE_dgeqrf(LAPACK_COL_MAJOR, n, m, B->val, n, tau);
    if (m > 0 && info == 0)
        info = LAPACKE_dormqr(LAPACK_COL_MAJOR, 'L', 'N', n, n - m, m, B->val,
                              n, tau, out->val, n);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "the motions without mass were not found");
    return RITZ_OK;
}

ritz_status ritz_massless(const ritz_second_order *model, const ritz_dense *Phi,
                          const double *lambda, ritz_dense *out)
{
    int n = (int)Phi->nrow;
    int m = (int)Phi->ncol;
    RITZ_OWN(ritz_dense) C = {0}, B = {0}, N = {0};

    RITZ_CHECK(factor_shifted(model, m, lambda, &C));
    RITZ_CHECK(ritz_dense_copy(Phi, &B));
    if (m > 0)
        cblas_dtrmm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, n, m, 1.0, C.val, n, B.val, n);
    RITZ_CHECK(complete_basis(&B, &N));
    if (n > m)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, n, n - m, 1.0, C.val, n, N.val, n);
    RITZ_MOVE(*out, N);
    return RITZ_OK;
}

ritz_status ritz_static_rest(const ritz_second_order *model,
                             const ritz_pairs *pairs, ritz_residual *out)
{
    const ritz_dense *const rows[] = {&model->io->C, &model->io->Cv,
                                      &model->io->Ca};
    const ritz_io *io = model->io;
    int64_t size = io->num_outputs * io->num_inputs;
    RITZ_OWN(ritz_residual)
    found = {.num_outputs = io->num_outputs,
             .num_inputs = io->num_inputs,
             .known = true};
    RITZ_OWN(ritz_dense) N = {0}, NB = {0};

    if (pairs->Phi.ncol == model->K->ncol || size == 0)
        return RITZ_OK;
    found.count = 1;
    RITZ_CHECK(ritz_massless(model, &pairs->Phi, pairs->lambda, &N));
    RITZ_CHECK(ritz_dense_mul_tn(&N, &io->B, &NB));
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_dense) CN = {0};

        RITZ_CHECK_NEW(found.part[k], size);
        RITZ_CHECK(ritz_dense_mul(rows[k], &N, &CN));
        RITZ_CHECK(put_term(&CN, &NB, 0, found.part[k]));
    }
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

/*
 * Static gain of the flexible part, which rigid motion does not make infinite:
 *
 *     G = C Phi_f Lambda_f^-1 Phi_f' B
 *
 * and what motions without mass add to it.
 */

ritz_status ritz_static_gain_of_modes(const ritz_second_order *model,
                                      const ritz_pairs *pairs,
                                      int64_t num_rigid, ritz_dense *out)
{
    RITZ_OWN(ritz_io) modes = {0};
    RITZ_OWN(ritz_residual) rest = {0};

    if (num_rigid < pairs->num_rigid)
        num_rigid = pairs->num_rigid;
    RITZ_CHECK(ritz_io_project(model->io, &pairs->Phi, &modes));
    for (int64_t j = 0; j < modes.num_inputs; j++)
        for (int64_t k = 0; k < pairs->Phi.ncol; k++)
            ritz_dense_col(&modes.B, j)[k] *=
                k < num_rigid ? 0.0 : 1.0 / pairs->lambda[k];
    RITZ_CHECK(ritz_static_rest(model, pairs, &rest));
    RITZ_CHECK(ritz_dense_mul(&modes.C, &modes.B, out));
    for (int64_t k = 0; rest.count > 0 && k < out->nrow * out->ncol; k++)
        out->val[k] += rest.part[0][k];
    return RITZ_OK;
}

ritz_status ritz_static_gain(const ritz_dense *K, const ritz_dense *M,
                             const ritz_io *io, int64_t num_rigid,
                             ritz_dense *out)
{
    const ritz_second_order model = {.K = K, .M = M, .io = io};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_eigen_dense(K, M, &pairs));
    return ritz_static_gain_of_modes(&model, &pairs, num_rigid, out);
}

ritz_status ritz_gain_error(const ritz_dense *full, const ritz_dense *reduced,
                            double *out)
{
    RITZ_OWN(ritz_dense) G = {0}, difference = {0};
    double size = 0.0;
    double error = 0.0;

    RITZ_CHECK(ritz_dense_copy(full, &G));
    RITZ_CHECK(ritz_dense_copy(reduced, &difference));
    for (int64_t k = 0; k < G.nrow * G.ncol; k++)
        difference.val[k] -= G.val[k];
    RITZ_CHECK_IN("static gain", ritz_general_norm(&G, &size));
    RITZ_CHECK_IN("static gain", ritz_general_norm(&difference, &error));
    *out = error == 0.0                  ? 0.0
           : size > RITZ_NO_GAIN * error ? error / size
                                         : nan("");
    return RITZ_OK;
}
