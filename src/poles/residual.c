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
 * by |mu| / lambda. |mu| grows with w. Term j is kept as mu_1^j R_j, mu_1 the
 * |mu| at the end of the range: powers of rad^2/s^2 would overflow.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "poles/poles.h"
#include "poles/proportional.h"

#include <ritz/matrix.h>

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/*
 * K R = f, Phi'M R = 0, is consistent where f = (I - M Phi Phi') f, the rigid
 * modes being among Phi, and is solved with A = K - sigma M, sigma < 0, by
 *
 *     A R_new = f - sigma M R,
 *
 * whose error falls by |sigma| / (lambda + |sigma|) a step, lambda being of the
 * first mode that is left out.
 *
 * Where no mass is left in the rest, M R_0 = 0: it answers by R_0 alone, and
 * all other terms are rounding. So a term is held to what it adds at the end of
 * the range, of the whole answer there, and not to its own size.
 */

typedef struct ritz_rest_solver {
    const ritz_sparse *M;  /* borrowed, as Phi is */
    const ritz_dense *Phi; /* the modes that are known */
    ritz_dense MPhi;
    ritz_factor *F;
    double sigma;
    double *
        whole; /* of each input, the response of all modes and R_0 at the end */
    bool begun; /* R_0 is known */
} ritz_rest_solver;

/* Steps shrink by 100 or more, so that 8 reach rounding; a body of which no
   flexible mode is kept may need more. */
enum { MOST_STEPS = 200 };

static void rest_solver_free(ritz_rest_solver *s)
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
                                   double out_hz, ritz_rest_solver *s)
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
    RITZ_CHECK_IN("static answer", ritz_factor_spd(&A, &s->F));
    RITZ_CHECK_NEW(s->whole, B->ncol);
    return size_modes(pairs, B, to_hz, s->whole);
}

/*
 * Last change of a term, the worst of all inputs, relative to what is negligible
 * against its largest value or against the whole response at the end of the
 * range: @p change over what is wanted, @p apart over what is required.
 */
static void measure_change(const ritz_rest_solver *s, const ritz_dense *R,
                           const ritz_dense *last, double *change,
                           double *apart)
{
    *change = *apart = 0.0;
    for (int64_t j = 0; j < R->ncol; j++) {
        double moved = 0.0;
        double size = ritz_dense_col_max(R, j);
        double seen = s->whole[j];

        for (int64_t i = 0; i < R->nrow; i++)
            moved = fmax(moved, fabs(ritz_dense_col(R, j)[i] -
                                     ritz_dense_col(last, j)[i]));
        if (!(moved > 0.0))
            continue;
        *change = fmax(*change, moved / (RITZ_SERIES_SETTLED * size +
                                         RITZ_SERIES_NEGLIGIBLE * seen));
        *apart = fmax(*apart, moved / (RITZ_REFINED_NEARLY * size +
                                       RITZ_SERIES_WITHIN * seen));
    }
}

/* M-orthogonal to the modes up to rounding: two passes are enough. */
static ritz_status take_out_twice(const ritz_dense *left,
                                  const ritz_dense *right, ritz_dense *X)
{
    RITZ_CHECK(ritz_dense_take_out(left, right, X));
    return ritz_dense_take_out(left, right, X);
}

static ritz_status rest_solve(ritz_rest_solver *s, ritz_dense *f,
                              ritz_dense *out)
{
    RITZ_OWN(ritz_dense) R = {0};
    RITZ_OWN(ritz_dense) next = {0};
    double change = HUGE_VAL, apart = HUGE_VAL;

    RITZ_CHECK(take_out_twice(&s->MPhi, s->Phi, f));
    RITZ_CHECK(ritz_dense_new(f->nrow, f->ncol, &R));
    for (int step = 0; step < MOST_STEPS && change > 1.0; step++) {
        RITZ_CHECK(ritz_sparse_mul(s->M, &R, &next));
        for (int64_t k = 0; k < f->nrow * f->ncol; k++)
            next.val[k] = f->val[k] - s->sigma * next.val[k];
        RITZ_CHECK(ritz_factor_solve(s->F, &next));
        RITZ_CHECK(take_out_twice(s->Phi, &s->MPhi, &next));
        measure_change(s, &next, &R, &change, &apart);
        ritz_dense_free(&R);
        RITZ_MOVE(R, next);
    }
    RITZ_REFUSE_IF(
        !(apart <= 1.0), RITZ_ERR_CONVERGENCE,
        "what modes above the band answer did not settle in %d steps: "
        "the last one changed it by %.1e",
        (int)MOST_STEPS, apart * RITZ_REFINED_NEARLY);
    for (int64_t j = 0; !s->begun && j < R.ncol; j++)
        s->whole[j] = fmax(s->whole[j], ritz_dense_col_max(&R, j));
    s->begun = true;
    RITZ_MOVE(*out, R);
    return RITZ_OK;
}

enum { MOST_TERMS = 40 };

/* Term j as the outputs see it. */
static ritz_status put_term(const ritz_dense *C, const ritz_dense *R, int64_t j,
                            double *out)
{
    RITZ_OWN(ritz_dense) CR = {0};

    RITZ_CHECK(ritz_dense_mul(C, R, &CR));
    memcpy(out + j * CR.nrow * CR.ncol, CR.val,
           (size_t)(CR.nrow * CR.ncol) * sizeof *out);
    return RITZ_OK;
}

static ritz_status add_terms(const ritz_component *component,
                             ritz_rest_solver *s, ritz_residual *r)
{
    const ritz_io *io = &component->io;
    RITZ_OWN(ritz_dense) f = {0};
    RITZ_OWN(ritz_dense) R = {0};

    RITZ_CHECK(ritz_dense_new(io->B.nrow, io->B.ncol, &f));
    memcpy(f.val, io->B.val, (size_t)(f.nrow * f.ncol) * sizeof *f.val);
    for (int64_t j = 0; j < r->count; j++) {
        RITZ_CHECK(rest_solve(s, &f, &R));
        RITZ_CHECK(put_term(&io->C, &R, j, r->C));
        RITZ_CHECK(put_term(&io->Cv, &R, j, r->Cv));
        RITZ_CHECK(put_term(&io->Ca, &R, j, r->Ca));
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
    [[gnu::cleanup(rest_solver_free)]] ritz_rest_solver s = {0};

    if (pairs->Phi.ncol < component->num_dofs && pm > 0) {
        RITZ_CHECK(take_damping(component, damping, &r));
        r.count = count_terms(to_hz, out_hz, &r);
    }
    RITZ_CHECK_NEW(r.C, r.count * pm);
    RITZ_CHECK_NEW(r.Cv, r.count * pm);
    RITZ_CHECK_NEW(r.Ca, r.count * pm);
    if (r.count > 0) {
        RITZ_CHECK(rest_solver_new(component, pairs, to_hz, out_hz, &s));
        RITZ_CHECK(add_terms(component, &s, &r));
    }
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

void ritz_residual_add(const ritz_residual *residual, double hertz,
                       double _Complex *H)
{
    double w2 = ritz_eigen_lambda(hertz);
    double w = sqrt(w2);
    double _Complex stiff = ritz_complex(1.0, w * residual->b);
    double _Complex mu = ritz_complex(w2, -w * residual->a) / stiff;
    double _Complex power = 1.0 / stiff;
    int64_t p = residual->num_outputs;
    int64_t k = 0;

    for (int64_t term = 0; term < residual->count; term++) {
        for (int64_t j = 0; j < residual->num_inputs; j++)
            for (int64_t i = 0; i < p; i++, k++)
                H[i * residual->num_inputs + j] +=
                    power * ritz_complex(residual->C[k] - w2 * residual->Ca[k],
                                         w * residual->Cv[k]);
        if (term + 1 < residual->count)
            power *= mu / residual->unit;
    }
}

void ritz_residual_free(ritz_residual *residual)
{
    free(residual->C);
    free(residual->Cv);
    free(residual->Ca);
    *residual = (ritz_residual){0};
}
