/*
 * The answer of all modes above those of `pairs`, free bodies included:
 *
 *     K R_0 = B - M Phi Phi'B,   K R_j = M R_(j-1),   Phi'M R_j = 0
 *
 * Damping a M + b K acts on those modes too:
 *
 *     lambda (1 + i w b) + i w a - w^2 = (1 + i w b) (lambda - mu),
 *     mu = (w^2 - i w a) / (1 + i w b)
 *
 * so that X = (R_0 + mu R_1 + mu^2 R_2 + ...) / (1 + i w b), whose terms fall by
 * |mu| / lambda. |mu| grows with w. Term j is kept as mu_1^j R_j, mu_1 the |mu|
 * at the end of the range: powers of rad^2/s^2 leave all bounds.
 */
#include "poles/poles.h"

#include "base/alloc.h"
#include "poles/proportional.h"
#include "poles/rest_solver.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TERMS = 40 };
/* falls_enough^MOST_TERMS = RITZ_SERIES_WITHIN */
static const double falls_enough = 0.5;

/* Term j as the outputs see it. */
static ritz_status see(const ritz_dense *C, const ritz_dense *R, int64_t j,
                       double *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense CR = {0};

    RITZ_TRY(ritz_dense_mul(C, R, &CR));
    memcpy(out + j * CR.nrow * CR.ncol, CR.val,
           (size_t)(CR.nrow * CR.ncol) * sizeof *out);
done:
    ritz_dense_free(&CR);
    return status;
}

static ritz_status add_terms(const ritz_component *component,
                             ritz_rest_solver *s, ritz_residual *r)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = &component->io;
    ritz_dense f = {0};
    ritz_dense R = {0};

    RITZ_TRY(ritz_dense_new(io->B.nrow, io->B.ncol, &f));
    memcpy(f.val, io->B.val, (size_t)(f.nrow * f.ncol) * sizeof *f.val);
    for (int64_t j = 0; j < r->count; j++) {
        RITZ_TRY(ritz_rest_solve(s, &f, &R));
        RITZ_TRY(see(&io->C, &R, j, r->C));
        RITZ_TRY(see(&io->Cv, &R, j, r->Cv));
        RITZ_TRY(see(&io->Ca, &R, j, r->Ca));
        ritz_dense_free(&f);
        RITZ_TRY(ritz_sparse_mul(&component->M, &R, &f));
        for (int64_t k = 0; k < f.nrow * f.ncol; k++)
            f.val[k] *= r->unit;
        ritz_dense_free(&R);
    }
done:
    ritz_dense_free(&f);
    ritz_dense_free(&R);
    return status;
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

    if (mu > w * w && mu > falls_enough * lambda) {
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
    ritz_status status = RITZ_OK;
    const ritz_io *io = &component->io;
    int64_t pm = io->num_outputs * io->num_inputs;
    ritz_residual r = {.num_outputs = io->num_outputs,
                       .num_inputs = io->num_inputs,
                       .known = true,
                       .unit = 1.0};
    ritz_rest_solver s = {0};

    if (pairs->Phi.ncol < component->num_dofs && pm > 0) {
        RITZ_TRY(take_damping(component, damping, &r));
        r.count = count_terms(to_hz, out_hz, &r);
    }
    RITZ_NEW(r.C, r.count * pm);
    RITZ_NEW(r.Cv, r.count * pm);
    RITZ_NEW(r.Ca, r.count * pm);
    if (r.count > 0) {
        RITZ_TRY(ritz_rest_solver_new(component, pairs, to_hz, out_hz, &s));
        RITZ_TRY(add_terms(component, &s, &r));
    }
    *out = r;
    r = (ritz_residual){0};
done:
    ritz_rest_solver_free(&s);
    ritz_residual_free(&r);
    return status;
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
