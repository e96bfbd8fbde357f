/* Lowest damped poles of a component, made exact on its full matrices. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/orthonormal.h"
#include "poles/refine.h"
#include "poles/spectrum_parts.h"

#include <ritz/base.h>
#include <ritz/matrix.h>
#include <ritz/poles.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One mode followed while dampers change. */
static const int64_t most_points = 100000;

static ritz_status check_range(const ritz_scan_request *request, int64_t *count)
{
    double steps = (request->to - request->from) / request->step;

    RITZ_REFUSE_IF(!(request->from >= 0.0) || !(request->to > request->from) ||
                       !(request->step > 0.0) || !isfinite(request->to),
                   RITZ_ERR_ARGUMENT,
                   "a scan from %g to %g in steps of %g has no range",
                   request->from, request->to, request->step);
    RITZ_REFUSE_IF(!(steps < (double)most_points), RITZ_ERR_ARGUMENT,
                   "%.0f steps of a scan are too many", steps);
    /* an end that rounding puts a hair beyond the last step belongs to it */
    *count =
        (int64_t)floor(steps * (1.0 + RITZ_RANGE_ROUNDING) + RITZ_RANGE_STEPS) +
        1;
    return RITZ_OK;
}

/* The mode-th oscillating pole. */
static ritz_status begin_scan(const ritz_spectrum *spectrum, int64_t mode,
                              double _Complex *out)
{
    int64_t seen = 0;
    bool found = false;

    for (int64_t j = 0; j < spectrum->count && !found; j++) {
        if (!(cimag(spectrum->s[j]) > 0.0))
            continue;
        found = seen == mode;
        *out = spectrum->s[j];
        seen++;
    }
    RITZ_REFUSE_IF(!found, RITZ_ERR_ARGUMENT,
                   "there is no mode %" PRId64 ", %" PRId64
                   " poles oscillate where the scan begins",
                   mode + 1, seen);
    return RITZ_OK;
}

static double _Complex nearest_pole(const ritz_spectrum *spectrum,
                                    double _Complex s)
{
    double _Complex best = nan("");
    double least = HUGE_VAL;

    for (int64_t j = 0; j < spectrum->count; j++)
        if (cabs(spectrum->s[j] - s) < least) {
            least = cabs(spectrum->s[j] - s);
            best = spectrum->s[j];
        }
    return best;
}

/* The model that is scanned: copies of K, D and the dampers. */
typedef struct bench {
    ritz_dense K, D;
    ritz_dampers dampers;
    ritz_second_order model;
} bench;

static void bench_free(bench *b)
{
    ritz_dense_free(&b->K);
    ritz_dense_free(&b->D);
    ritz_dampers_free(&b->dampers);
}

static ritz_status bench_new(const ritz_second_order *model,
                             const ritz_dampers *dampers, bench *b)
{
    RITZ_CHECK(ritz_dense_copy(model->K, &b->K));
    if (model->D && model->D->val)
        RITZ_CHECK(ritz_dense_copy(model->D, &b->D));
    RITZ_CHECK(ritz_dampers_copy(dampers, &b->dampers));
    b->model = *model;
    b->model.K = &b->K;
    b->model.D = &b->D;
    return RITZ_OK;
}

static ritz_status poles_at(bench *b, const ritz_scan_request *request,
                            const ritz_damping *damping, double c,
                            ritz_spectrum *out)
{
    for (int64_t j = 0; j < request->count; j++)
        b->dampers.c[request->damper[j]] = c;
    RITZ_CHECK(ritz_dampers_install(&b->dampers, &b->K, &b->D));
    return ritz_spectrum_dense(&b->model, damping, out);
}

static ritz_status scan_dense(const ritz_second_order *model,
                              const ritz_dampers *dampers,
                              const ritz_damping *damping,
                              const ritz_scan_request *request, ritz_scan *out)
{
    RITZ_OWN(ritz_scan) scan = {0};
    RITZ_OWN(ritz_spectrum) spectrum = {0};
    RITZ_OWN(bench) b = {0};

    RITZ_CHECK(check_range(request, &scan.count));
    RITZ_CHECK(bench_new(model, dampers, &b));
    RITZ_CHECK_NEW(scan.c, scan.count);
    RITZ_CHECK_NEW(scan.s, scan.count);
    for (int64_t k = 0; k < scan.count; k++) {
        scan.c[k] = request->from + (double)k * request->step;
        RITZ_CHECK(poles_at(&b, request, damping, scan.c[k], &spectrum));
        if (k == 0)
            RITZ_CHECK(begin_scan(&spectrum, request->mode, &scan.s[0]));
        else
            scan.s[k] = nearest_pole(&spectrum, k == 1 ? scan.s[0]
                                                       : 2.0 * scan.s[k - 1] -
                                                             scan.s[k - 2]);
        if (ritz_spectrum_ratio(scan.s[k]) >
            ritz_spectrum_ratio(scan.s[scan.best]))
            scan.best = k;
        ritz_spectrum_free(&spectrum);
    }
    RITZ_MOVE(*out, scan);
    return RITZ_OK;
}

void ritz_scan_free(ritz_scan *scan)
{
    free(scan->c);
    free(scan->s);
    *scan = (ritz_scan){0};
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

/* Undamped modes to scan with, at least; and for each mode before the one. */
enum { LEAST_MODES = 20, EACH_MODE = 2 };

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
        RITZ_CHECK_IN("static answer", ritz_factor_spd(&A, &F));
        RITZ_CHECK(ritz_factor_solve(F, &X));
        RITZ_CHECK(ritz_orthonormal_append(&set, &X, n - set.count, NULL));
    }
    RITZ_CHECK(ritz_basis_new(n, set.count, &basis));
    ritz_dense_free(&basis.T);
    basis.T = set.V;
    basis.T.ncol = set.count;
    set.V = (ritz_dense){0};
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

ritz_status ritz_whole_new(const ritz_component *component, ritz_whole *out)
{
    RITZ_CHECK(ritz_sparse_dense(&component->K, &out->K));
    RITZ_CHECK(ritz_sparse_dense(&component->M, &out->M));
    if (component->D.colptr)
        RITZ_CHECK(ritz_sparse_dense(&component->D, &out->D));
    if (component->K4.colptr)
        RITZ_CHECK(ritz_sparse_dense(&component->K4, &out->K4));
    out->model = (ritz_second_order){&out->K, &out->M, &out->D, &out->K4, NULL};
    return RITZ_OK;
}

void ritz_whole_free(ritz_whole *whole)
{
    ritz_dense_free(&whole->K);
    ritz_dense_free(&whole->M);
    ritz_dense_free(&whole->D);
    ritz_dense_free(&whole->K4);
}

/*
 * A large component is scanned in the space of some modes and static responses.
 */
static ritz_status scan_component(const ritz_component *component,
                                  const ritz_damping *damping,
                                  const ritz_scan_request *request,
                                  ritz_scan *out)
{
    ritz_span span = {.modes = EACH_MODE * (request->mode + 1) + LEAST_MODES};
    RITZ_OWN(ritz_whole) w = {0};
    RITZ_OWN(ritz_reduced) small = {0};
    const ritz_second_order model = {&small.K, &small.M, &small.D, &small.K4,
                                     NULL};

    if (component->num_dofs <= RITZ_WHOLE_DOFS) {
        RITZ_CHECK(ritz_whole_new(component, &w));
        return scan_dense(&w.model, &component->dampers, damping, request, out);
    }
    RITZ_CHECK(ritz_spectrum_space(component, &span, &small));
    return scan_dense(&model, &small.dampers, damping, request, out);
}

ritz_status ritz_scan_of(ritz_model model, const ritz_scan_request *request,
                         ritz_scan *out)
{
    RITZ_REFUSE_IF(model.kind == RITZ_MODEL_STATES || !model.dampers,
                   RITZ_ERR_ARGUMENT, "the model has no dampers to scan");
    if (model.kind == RITZ_MODEL_COMPONENT)
        return scan_component(model.component, model.damping, request, out);
    return scan_dense(&model.dense, model.dampers, model.damping, request, out);
}

/* Beyond what is wanted, of modes and of frequencies. */
enum { MORE_MODES = 8 };

/* Add a given ratio to a pole: |s| stays. */
static double _Complex add_ratio(double _Complex s, double ratio)
{
    double size = cabs(s);
    double zeta = ritz_spectrum_ratio(s) + ratio;
    double _Complex i = (double _Complex)_Complex_I;

    if (!(cimag(s) > 0.0) || ratio == 0.0)
        return s;
    return zeta < 1.0 ? -zeta * size + i * (size * sqrt(1.0 - zeta * zeta))
                      : -size;
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

/* Pole j on the full matrices, where inverse iteration stays near. */
static ritz_status refine_pole(ritz_refiner *refiner, int64_t j,
                               ritz_spectrum *spectrum)
{
    ritz_status status = RITZ_OK;
    double _Complex s = spectrum->s[j];
    int64_t n = spectrum->re.nrow;
    double *re = ritz_dense_col(&spectrum->re, j);
    double *im = ritz_dense_col(&spectrum->im, j);
    ritz_dense x = {0}, start = {0};

    RITZ_TRY(ritz_dense_new(n, 2, &x));
    memcpy(x.val, re, (size_t)n * sizeof *re);
    memcpy(x.val + n, im, (size_t)n * sizeof *im);
    RITZ_TRY(ritz_dense_copy(&x, &start));
    status = ritz_refine(refiner, &x, &s);
    if (status != RITZ_OK && status != RITZ_ERR_CONVERGENCE)
        goto done;
    if (status == RITZ_OK &&
        cabs(s - spectrum->s[j]) <= RITZ_REFINED_ELSEWHERE * cabs(s) &&
        !is_listed(spectrum, j, s, &x)) {
        spectrum->s[j] = s;
        memcpy(re, x.val, (size_t)n * sizeof *re);
        memcpy(im, x.val + n, (size_t)n * sizeof *im);
        memcpy(start.val, x.val, (size_t)(2 * n) * sizeof *re);
    }
    status = ritz_refiner_residual(refiner, &start, spectrum->s[j],
                                   &spectrum->residual[j]);
done:
    ritz_dense_free(&x);
    ritz_dense_free(&start);
    return status;
}

/* The first that are asked for. */
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

static ritz_status solve_whole(const ritz_component *component,
                               const ritz_damping *damping, ritz_spectrum *out)
{
    RITZ_OWN(ritz_whole) w = {0};

    RITZ_CHECK(ritz_whole_new(component, &w));
    return ritz_spectrum_dense(&w.model, damping, out);
}

/* Shapes of the small model become those of the component. */
static ritz_status expand_shapes(const ritz_dense *T, ritz_dense *shapes)
{
    ritz_dense x = {0};

    RITZ_CHECK(ritz_dense_mul(T, shapes, &x));
    ritz_dense_free(shapes);
    *shapes = x;
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
    const ritz_second_order model = {&small.K, &small.M, &small.D, &small.K4,
                                     NULL};
    RITZ_OWN(ritz_refiner) refiner = {0};

    RITZ_CHECK(ritz_spectrum_space(component, &wide, &small));
    RITZ_CHECK(ritz_spectrum_dense(&model, NULL, out));
    keep_first(span, out);
    RITZ_CHECK(expand_shapes(&small.T, &out->re));
    RITZ_CHECK(expand_shapes(&small.T, &out->im));
    RITZ_CHECK(ritz_refiner_new(component, true, &refiner));
    for (int64_t j = 0; j < out->count; j++) {
        RITZ_CHECK(refine_pole(&refiner, j, out));
        ritz_monitor_step("damped modes", j + 1, out->count);
    }
    (void)snprintf(out->engine, sizeof out->engine,
                   "CHOLMOD + ARPACK + inverse iteration");
    return RITZ_OK;
}

/* D := D + a M + b K: `seen` borrows all of the component but D, which it
   owns. */
static ritz_status add_rayleigh(const ritz_component *component,
                                const ritz_damping *damping,
                                ritz_component *seen)
{
    RITZ_OWN(ritz_sparse) given = {0};

    *seen = *component;
    seen->D = (ritz_sparse){0};
    RITZ_CHECK(ritz_sparse_add(damping->a, &component->M, damping->b,
                               &component->K, &given));
    if (component->D.colptr) {
        RITZ_CHECK(ritz_sparse_add(1.0, &component->D, 1.0, &given, &seen->D));
    } else {
        RITZ_MOVE(seen->D, given);
    }
    return RITZ_OK;
}

ritz_status ritz_spectrum_large(const ritz_component *component,
                                const ritz_damping *damping,
                                const ritz_span *span, ritz_spectrum *out)
{
    ritz_status status = RITZ_OK;
    ritz_component seen = {0};
    int64_t mode = 0;

    if (damping && ritz_damping_is_rayleigh(damping)) {
        RITZ_TRY(add_rayleigh(component, damping, &seen));
        RITZ_TRY(solve_projected(&seen, span, out));
        goto done;
    }
    RITZ_TRY(solve_projected(component, span, out));
    for (int64_t j = 0; damping && j < out->count; j++)
        if (cimag(out->s[j]) > 0.0) {
            double w = cabs(out->s[j]);

            out->s[j] =
                add_ratio(out->s[j], ritz_damping_of_mode(damping, mode++, w));
        }
done:
    ritz_sparse_free(&seen.D);
    return status;
}

static ritz_status spectrum_of_component(const ritz_component *component,
                                         const ritz_damping *damping,
                                         const ritz_span *span,
                                         ritz_spectrum *out)
{
    if (component->num_dofs > RITZ_WHOLE_DOFS)
        return ritz_spectrum_large(component, damping, span, out);
    RITZ_CHECK(solve_whole(component, damping, out));
    keep_first(span, out);
    return RITZ_OK;
}

/* One pole of each pair; a state space has no shapes and so no residuals. */
static ritz_status spectrum_of_states(const ritz_state_space *model,
                                      ritz_spectrum *out)
{
    int64_t count = 0;

    RITZ_CHECK(ritz_state_space_poles(model, &count, &out->s));
    RITZ_CHECK_NEW(out->residual, count);
    for (int64_t k = 0; k < count; k++) {
        if (cimag(out->s[k]) < 0.0)
            continue;
        out->residual[out->count] = nan("");
        out->s[out->count++] = out->s[k];
    }
    (void)snprintf(out->engine, sizeof out->engine, "dense LAPACK");
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
        RITZ_CHECK(spectrum_of_states(model.states, &found));
        break;
    }
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}
