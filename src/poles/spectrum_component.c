/* Lowest damped poles of a component, made exact on its full matrices. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "linear/orthonormal.h"
#include "poles/poles.h"

#include <ritz/base.h>
#include <ritz/matrix.h>
#include <ritz/poles.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Inverse iteration on the full matrices. */

enum { MOST_STEPS = 12, MOST_MATRICES = 4 };

ritz_status ritz_impedance_new(const ritz_component *component, ritz_zldl **out)
{
    const ritz_sparse *A[MOST_MATRICES] = {&component->K, &component->M};
    int64_t count = 2;

    if (component->D.colptr)
        A[count++] = &component->D;
    if (component->K4.colptr)
        A[count++] = &component->K4;
    return ritz_zldl_new(count, A, out);
}

ritz_status ritz_impedance_factor(const ritz_component *component,
                                  const double _Complex c[static 3],
                                  ritz_zldl *Z)
{
    double _Complex all[MOST_MATRICES] = {c[0], c[1]};
    int64_t count = 2;

    if (component->D.colptr)
        all[count++] = c[2];
    if (component->K4.colptr)
        all[count] = ritz_complex(0.0, 1.0);
    return ritz_zldl_factor(Z, all);
}

/* u += c A x. */
static ritz_status add_product(const ritz_sparse *A, double _Complex c,
                               const ritz_dense *x, double _Complex *u)
{
    RITZ_OWN(ritz_dense) Ax = {0};
    int64_t n = x->nrow;

    if (!A->colptr)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_mul(A, x, &Ax));
    for (int64_t i = 0; i < n; i++)
        u[i] += c * ritz_complex(Ax.val[i], Ax.val[n + i]);
    return RITZ_OK;
}

/* most += |c||A||x|, entry by entry. */
static void add_most(const ritz_sparse *A, double c, const ritz_dense *x,
                     double *most)
{
    int64_t n = x->nrow;

    for (int64_t j = 0; A->colptr && j < n; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            most[A->rowind[p]] +=
                c * fabs(A->val[p]) * hypot(x->val[j], x->val[n + j]);
}

static ritz_status factor_at(const ritz_component *component, double _Complex s,
                             ritz_zldl *Z)
{
    const double _Complex c[] = {1.0, s * s, s};

    return ritz_impedance_factor(component, c, Z);
}

/* One step; how far it moved s, 0 where s is the eigenvalue. */
static ritz_status take_step(const ritz_component *c, ritz_zldl *Z,
                             ritz_dense *x, double _Complex *s,
                             double _Complex *u, double *move)
{
    ritz_status status = RITZ_OK;
    double size = ritz_general_size(x);
    double _Complex xu = 0.0;
    int64_t n = x->nrow;
    bool last = false;

    for (int64_t i = 0; i < 2 * n; i++)
        x->val[i] /= size;
    for (int64_t i = 0; i < n; i++)
        u[i] = 0.0;
    RITZ_CHECK(add_product(&c->M, 2.0 * *s, x, u));
    RITZ_CHECK(add_product(&c->D, 1.0, x, u));
    status = factor_at(c, *s, Z);
    *move = 0.0;
    last = status == RITZ_ERR_SINGULAR; /* s is the eigenvalue: x is found with
                                           a factor at a point near it */
    if (last)
        status = factor_at(c, *s * (1.0 + RITZ_NUDGE), Z);
    if (last && status == RITZ_ERR_SINGULAR)
        return RITZ_OK;
    RITZ_CHECK(status);
    RITZ_CHECK(ritz_zldl_solve(Z, false, 1, u));
    for (int64_t i = 0; i < n; i++)
        xu += ritz_complex(x->val[i], -x->val[n + i]) * u[i];
    for (int64_t i = 0; i < n; i++) {
        x->val[i] = creal(u[i]);
        x->val[n + i] = cimag(u[i]);
    }
    if (!last) {
        *move = cabs(1.0 / xu);
        *s -= 1.0 / xu;
    }
    return RITZ_OK;
}

ritz_status ritz_refine(const ritz_component *component, ritz_zldl *Z,
                        ritz_dense *x, double _Complex *s)
{
    RITZ_OWN_ARRAY double _Complex *u = NULL;
    double before = HUGE_VAL;
    double move = HUGE_VAL;
    bool still = false;

    RITZ_CHECK_NEW(u, x->nrow);
    for (int t = 0; t < MOST_STEPS && !still; t++) {
        RITZ_CHECK(take_step(component, Z, x, s, u, &move));
        still =
            move <= RITZ_REFINED * cabs(*s) ||
            (move <= RITZ_REFINED_NEARLY * cabs(*s) && move >= 0.5 * before);
        before = move;
    }
    RITZ_REFUSE_IF(!still, RITZ_ERR_CONVERGENCE,
                   "the damped mode near %.6g Hz was not found",
                   ritz_eigen_hertz(cabs(*s) * cabs(*s)));
    return RITZ_OK;
}

/* |Z(s) x| over the norm of what its terms add up to, taken as magnitudes. */
static ritz_status measure_residual(const ritz_component *component,
                                    const ritz_dense *x, double _Complex s,
                                    double *out)
{
    const struct {
        const ritz_sparse *A;
        double _Complex c;
    } terms[] = {
        {&component->K, 1.0},
        {&component->M, s * s},
        {&component->D, s},
        {&component->K4, ritz_complex(0.0, 1.0)},
    };
    RITZ_OWN_ARRAY double _Complex *u = NULL;
    RITZ_OWN_ARRAY double *most = NULL;
    double size = 0.0, gap = 0.0;

    RITZ_CHECK_NEW(u, x->nrow);
    RITZ_CHECK_NEW(most, x->nrow);
    for (int k = 0; k < MOST_MATRICES; k++) {
        RITZ_CHECK(add_product(terms[k].A, terms[k].c, x, u));
        add_most(terms[k].A, cabs(terms[k].c), x, most);
    }
    for (int64_t i = 0; i < x->nrow; i++) {
        gap = hypot(gap, cabs(u[i]));
        size = hypot(size, most[i]);
    }
    *out = size > 0.0 ? gap / size : 0.0;
    return RITZ_OK;
}

/*
 * The space in which damped poles of a large component are sought. Undamped
 * modes alone mislead where dampers are discrete: the motion that a truncated
 * set leaves across a damper is far from the true one, and so is the ratio.
 * With the static responses X to a force along each influence vector the small
 * model is near enough for inverse iteration to converge to the poles that are
 * sought.
 *
 *     A = K - sigma M, sigma < 0,   A X = B,   T = [Phi X], T'AT = I
 */

/* T = [Phi X], its columns named. */
static ritz_status span_space(const ritz_component *component,
                              const ritz_pairs *pairs, ritz_basis *out)
{
    int64_t n = component->num_dofs;
    double sigma = pairs->sigma < 0.0 ? pairs->sigma : -1.0;
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_dense) X = {0};
    RITZ_OWN(ritz_orthonormal) set = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(ritz_sparse_add(1.0, &component->K, -sigma, &component->M, &A));
    RITZ_CHECK(ritz_orthonormal_new(n, &A, RITZ_STATIC_DEPENDENT, &set));
    RITZ_CHECK(ritz_dense_copy(&pairs->Phi, &X));
    RITZ_CHECK(ritz_orthonormal_append(&set, &X, n, NULL));
    if (component->dampers.count > 0) {
        ritz_dense_free(&X);
        RITZ_CHECK(ritz_dense_copy(&component->dampers.B, &X));
        RITZ_CHECK_IN("static solution", ritz_factor_spd(&A, &F));
        RITZ_CHECK(ritz_factor_solve(F, &X));
        RITZ_CHECK(ritz_orthonormal_append(&set, &X, n - set.count, NULL));
    }
    RITZ_CHECK(ritz_basis_new(n, set.count, &basis));
    set.V.ncol = set.count;
    ritz_dense_replace(&basis.T, &set.V);
    for (int64_t j = 0; j < pairs->num_rigid && j < set.count; j++)
        basis.columns.kind[j] = RITZ_COLUMN_RIGID;
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

ritz_status ritz_spectrum_space(const ritz_component *component,
                                const ritz_span *span, ritz_reduced *out)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(ritz_eigen_sparse(&component->K, &component->M, span, &pairs));
    RITZ_CHECK(span_space(component, &pairs, &basis));
    return ritz_reduce(component, &basis, out);
}

ritz_status ritz_whole_new(const ritz_component *component, ritz_reduced *out)
{
    RITZ_CHECK(ritz_sparse_dense(&component->K, &out->K));
    RITZ_CHECK(ritz_sparse_dense(&component->M, &out->M));
    if (component->D.colptr)
        RITZ_CHECK(ritz_sparse_dense(&component->D, &out->D));
    if (component->K4.colptr)
        RITZ_CHECK(ritz_sparse_dense(&component->K4, &out->K4));
    return RITZ_OK;
}

/* Beyond what is wanted, of modes and of frequencies. */
enum { MORE_MODES = 8 };

double _Complex ritz_pole_of(double size, double zeta)
{
    return zeta < 1.0
               ? ritz_complex(-zeta * size, size * sqrt(1.0 - zeta * zeta))
               : ritz_complex(nan(""), 0.0);
}

/* Add a given ratio to a pole: |s| stays. */
static double _Complex add_ratio(double _Complex s, double ratio)
{
    double size = cabs(s);
    double zeta = ritz_spectrum_ratio(s) + ratio;

    if (!(cimag(s) > 0.0) || ratio == 0.0)
        return s;
    return zeta < 1.0 ? ritz_pole_of(size, zeta) : -size;
}

/* |x^H y| / (|x||y|) of column j and y, real and imaginary part. */
static double correlation_of(const ritz_spectrum *spectrum, int64_t j,
                             const ritz_dense *y)
{
    const double *re = ritz_dense_col(&spectrum->re, j);
    const double *im = ritz_dense_col(&spectrum->im, j);
    int64_t n = y->nrow;
    double real = 0.0, imaginary = 0.0, xx = 0.0, yy = 0.0;

    for (int64_t i = 0; i < n; i++) {
        real += re[i] * y->val[i] + im[i] * y->val[n + i];
        imaginary += re[i] * y->val[n + i] - im[i] * y->val[i];
        xx += re[i] * re[i] + im[i] * im[i];
        yy += y->val[i] * y->val[i] + y->val[n + i] * y->val[n + i];
    }
    return hypot(real, imaginary) / sqrt(xx * yy);
}

/* Whether a pole is one of the `count` before it; double poles have
   different shapes. */
static bool is_listed(const ritz_spectrum *spectrum, int64_t count,
                      double _Complex s, const ritz_dense *x)
{
    for (int64_t j = 0; j < count; j++)
        if (cabs(spectrum->s[j] - s) <= RITZ_SAME * cabs(s) &&
            correlation_of(spectrum, j, x) > RITZ_SAME_SHAPE)
            return true;
    return false;
}

ritz_status ritz_spectrum_shape(const ritz_spectrum *spectrum, int64_t j,
                                ritz_dense *out)
{
    const ritz_dense re = ritz_dense_part(&spectrum->re, j, 1);
    const ritz_dense im = ritz_dense_part(&spectrum->im, j, 1);

    return ritz_dense_beside(&re, &im, out);
}

/* Pole j on the full matrices, where inverse iteration stays near. */
static ritz_status refine_pole(const ritz_component *component, ritz_zldl *Z,
                               int64_t j, ritz_spectrum *spectrum)
{
    double _Complex s = spectrum->s[j];
    size_t size = (size_t)spectrum->re.nrow * sizeof(double);
    RITZ_OWN(ritz_dense) x = {0}, start = {0};
    ritz_status status = RITZ_OK;

    RITZ_CHECK(ritz_spectrum_shape(spectrum, j, &x));
    RITZ_CHECK(ritz_dense_copy(&x, &start));
    status = ritz_refine(component, Z, &x, &s);
    if (status != RITZ_OK && status != RITZ_ERR_CONVERGENCE)
        return status;
    if (status == RITZ_OK &&
        cabs(s - spectrum->s[j]) <= RITZ_REFINED_ELSEWHERE * cabs(s) &&
        !is_listed(spectrum, j, s, &x)) {
        spectrum->s[j] = s;
        memcpy(ritz_dense_col(&spectrum->re, j), ritz_dense_col(&x, 0), size);
        memcpy(ritz_dense_col(&spectrum->im, j), ritz_dense_col(&x, 1), size);
        memcpy(start.val, x.val, 2 * size);
    }
    return measure_residual(component, &start, spectrum->s[j],
                            &spectrum->residual[j]);
}

/* The first that are wanted. */
static void keep_first(const ritz_span *span, ritz_spectrum *spectrum)
{
    double limit = sqrt(ritz_eigen_lambda(span->up_to_hz)) * (1.0 + RITZ_SAME);
    int64_t count = 0;

    while (count < spectrum->count &&
           (span->modes >= 0 ? count < span->modes
                             : cabs(spectrum->s[count]) <= limit))
        count++;
    spectrum->count = spectrum->re.ncol = spectrum->im.ncol = count;
}

/* Shapes of the small model become those of the component. */
static ritz_status expand_shapes(const ritz_dense *T, ritz_dense *shapes)
{
    ritz_dense x = {0};

    RITZ_CHECK(ritz_dense_mul(T, shapes, &x));
    ritz_dense_replace(shapes, &x);
    return RITZ_OK;
}

/* Without given ratios. */
static ritz_status solve_projected(const ritz_component *component,
                                   const ritz_span *span, ritz_spectrum *out)
{
    const ritz_span wide = {
        .modes = span->modes < 0
                     ? -1
                     : (int64_t)(RITZ_SPECTRUM_BEYOND * (double)span->modes) +
                           MORE_MODES,
        .up_to_hz = RITZ_SPECTRUM_BEYOND * span->up_to_hz,
    };
    RITZ_OWN(ritz_reduced) small = {0};
    const ritz_second_order model = ritz_model_of_reduced(&small, NULL).dense;
    RITZ_OWN(ritz_zldl) *Z = NULL;

    RITZ_CHECK(ritz_spectrum_space(component, &wide, &small));
    RITZ_CHECK(ritz_spectrum_dense(&model, NULL, out));
    keep_first(span, out);
    RITZ_CHECK(expand_shapes(&small.T, &out->re));
    RITZ_CHECK(expand_shapes(&small.T, &out->im));
    RITZ_CHECK(ritz_impedance_new(component, &Z));
    for (int64_t j = 0; j < out->count; j++) {
        RITZ_CHECK(refine_pole(component, Z, j, out));
        ritz_monitor_step("damped modes", j + 1, out->count);
    }
    (void)snprintf(out->engine, sizeof out->engine,
                   "CHOLMOD + ARPACK + inverse iteration");
    return RITZ_OK;
}

ritz_status ritz_damping_matrix(const ritz_component *component,
                                const ritz_damping *damping, ritz_sparse *out)
{
    RITZ_OWN(ritz_sparse) given = {0};

    RITZ_CHECK(ritz_sparse_add(damping->a, &component->M, damping->b,
                               &component->K, &given));
    if (component->D.colptr)
        return ritz_sparse_add(1.0, &component->D, 1.0, &given, out);
    RITZ_MOVE(*out, given);
    return RITZ_OK;
}

ritz_status ritz_spectrum_large(const ritz_component *component,
                                const ritz_damping *damping,
                                const ritz_span *span, ritz_spectrum *out)
{
    RITZ_OWN(ritz_sparse) D = {0};
    ritz_component damped = *component; /* borrowed */
    int64_t mode = 0;

    if (damping && ritz_damping_is_rayleigh(damping)) {
        RITZ_CHECK(ritz_damping_matrix(component, damping, &D));
        damped.D = D;
        return solve_projected(&damped, span, out);
    }
    RITZ_CHECK(solve_projected(component, span, out));
    for (int64_t j = 0; damping && j < out->count; j++)
        if (cimag(out->s[j]) > 0.0) {
            double w = cabs(out->s[j]);

            out->s[j] =
                add_ratio(out->s[j], ritz_damping_of_mode(damping, mode++, w));
        }
    return RITZ_OK;
}

static ritz_status spectrum_of_component(const ritz_component *component,
                                         const ritz_damping *damping,
                                         const ritz_span *span,
                                         ritz_spectrum *out)
{
    RITZ_OWN(ritz_reduced) whole = {0};
    ritz_second_order view;

    if (component->num_dofs > RITZ_WHOLE_DOFS)
        return ritz_spectrum_large(component, damping, span, out);
    RITZ_CHECK(ritz_whole_new(component, &whole));
    view = ritz_model_of_reduced(&whole, NULL).dense;
    RITZ_CHECK(ritz_spectrum_dense(&view, damping, out));
    keep_first(span, out);
    return RITZ_OK;
}

ritz_status ritz_spectrum_of(ritz_model model, const ritz_span *span,
                             ritz_spectrum *out)
{
    RITZ_OWN(ritz_spectrum) found = {0};

    switch (model.kind) {
    case RITZ_MODEL_COMPONENT:
        RITZ_CHECK(spectrum_of_component(model.component, model.damping, span,
                                         &found));
        break;
    case RITZ_MODEL_DENSE:
        RITZ_CHECK(ritz_spectrum_dense(&model.dense, model.damping, &found));
        break;
    case RITZ_MODEL_STATES:
        RITZ_CHECK(ritz_spectrum_of_space(model.states, span, &found));
        break;
    }
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}
