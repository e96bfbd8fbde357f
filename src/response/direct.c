/*
 * Response of a full component by one complex symmetric factorization for each
 * frequency:
 *
 *     Z_0 = K + i K4 + i w D - w^2 M,    Rayleigh: (1 + i w b) K, a M too
 *
 * Damping ratios act on modes Phi: Z = Z_0 + M Phi E Phi'M with E = i w diag(2
 * zeta w_k) and Phi the modes up to a frequency. The modes above are damped as
 * well: without D and K4 by the residual's changes by ratios; with D or K4, and
 * up to RITZ_RATIO_DOFS dofs, by adding M Phi diag(2 zeta w_k) Phi'M of all
 * modes to D as a full matrix.
 *
 * Without D and K4 the modes decouple from the rest exactly,
 *
 *     x = Phi (Lambda - w^2 I + E)^-1 Phi'f + P Z_0^-1 P'f,
 *     P = I - Phi Phi'M,
 *
 * and Z_0 may be nearly singular at a pole, as P'f has no part along that mode.
 * With D or K4, and U = M Phi,
 *
 *     x = (I - Y (I + E U'Y)^-1 E U') Z_0^-1 f,    Y = Z_0^-1 U
 */
#include "response/direct.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/modal.h"
#include "response/responder.h"

#include <complex.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NUDGES = 100 };

ritz_status ritz_matrix_of_ratios(const ritz_component *component,
                                  const ritz_damping *damping, double up_to_hz,
                                  ritz_dense *out)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_dense) MPhi = {0}, scaled = {0};

    RITZ_CHECK(ritz_modes_of_whole(component, up_to_hz, &pairs));
    RITZ_CHECK(ritz_sparse_mul(&component->M, &pairs.Phi, &MPhi));
    RITZ_CHECK(ritz_dense_copy(&MPhi, &scaled));
    for (int64_t k = 0; k < scaled.ncol; k++) {
        double rate =
            ritz_modal_rate(damping, k - pairs.num_rigid, pairs.lambda[k]);

        for (int64_t i = 0; i < scaled.nrow; i++)
            ritz_dense_col(&scaled, k)[i] *= rate;
    }
    RITZ_CHECK(ritz_dense_mul_nt(&scaled, &MPhi, out));
    ritz_dense_symmetrise(out);
    return RITZ_OK;
}

/* Replace the component by one whose D contains the damping by ratios;
   `damping` is then empty. */
static ritz_status install_ratios(double up_to_hz, ritz_direct *s)
{
    const ritz_component *component = s->component;
    RITZ_OWN(ritz_dense) given = {0};
    RITZ_OWN(ritz_sparse) sum = {0};

    RITZ_CHECK(ritz_matrix_of_ratios(component, &s->damping, up_to_hz, &given));
    RITZ_CHECK(ritz_sparse_from_dense(&given, &s->own_D));
    if (component->D.colptr) {
        RITZ_CHECK(ritz_sparse_add(1.0, &component->D, 1.0, &s->own_D, &sum));
        ritz_sparse_free(&s->own_D);
        RITZ_MOVE(s->own_D, sum);
    }
    RITZ_CHECK_NEW(s->damped, 1);
    *s->damped = *component;
    s->damped->D = s->own_D;
    s->component = s->damped;
    s->damping = (ritz_damping){0};
    return RITZ_OK;
}

ritz_status ritz_direct_new(const ritz_component *component,
                            const ritz_damping *damping, double up_to_hz,
                            ritz_direct *out)
{
    RITZ_OWN(ritz_direct)
    s = {.component = component,
         .n = component->num_dofs,
         .up_to_hz = up_to_hz,
         .inputs = component->io.num_inputs};
    bool rayleigh = false;

    if (damping)
        s.damping = *damping;
    rayleigh = ritz_damping_is_rayleigh(&s.damping);
    s.a = rayleigh ? s.damping.a : 0.0;
    s.b = rayleigh ? s.damping.b : 0.0;
    s.apart = !component->D.colptr && !component->K4.colptr && !rayleigh;
    if (!s.apart && ritz_ratios_act_on_all(component, damping))
        RITZ_CHECK(install_ratios(up_to_hz, &s));
    s.ratios = ritz_damping_has_ratios(&s.damping);
    RITZ_CHECK(ritz_poles_of_component(s.component, &s.damping, up_to_hz,
                                       &s.pairs, &s.poles));
    if (s.apart)
        RITZ_CHECK(ritz_residual_of_ratios(component, damping, &s.pairs,
                                           up_to_hz, &s.rest));
    s.m = s.pairs.Phi.ncol;
    RITZ_CHECK(ritz_sparse_mul(&component->M, &s.pairs.Phi, &s.MPhi));
    RITZ_CHECK(ritz_impedance_new(s.component, &s.Z));
    RITZ_CHECK_NEW(s.X, s.n * s.inputs);
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

void ritz_direct_free(ritz_direct *direct)
{
    ritz_zldl_free(&direct->Z);
    ritz_pairs_free(&direct->pairs);
    ritz_poles_free(&direct->poles);
    ritz_dense_free(&direct->MPhi);
    ritz_residual_free(&direct->rest);
    ritz_sparse_free(&direct->own_D);
    RITZ_FREE(direct->damped, direct->X);
    *direct = (ritz_direct){0};
}

static ritz_status factor_impedance(ritz_direct *s, double w, double w2)
{
    const double _Complex c[3] = {ritz_complex(1.0, w * s->b),
                                  ritz_complex(-w2, w * s->a),
                                  ritz_complex(0.0, w)};
    const ritz_status status = ritz_impedance_factor(s->component, c, s->Z);

    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, RITZ_ERR_SINGULAR,
                   "the response at %.9g Hz is infinite: an undamped mode, or "
                   "at 0 Hz a rigid-body motion",
                   w / (2.0 * RITZ_PI));
    return status;
}

/* y -= A (B'y), columns of y complex, A and B real n x m. */
static void remove_modes(const ritz_dense *A, const ritz_dense *B,
                         double _Complex *y)
{
    for (int64_t k = 0; k < A->ncol; k++) {
        const double *a = ritz_dense_col(A, k);
        const double *b = ritz_dense_col(B, k);
        double _Complex q = 0.0;

        for (int64_t i = 0; i < A->nrow; i++)
            q += b[i] * y[i];
        for (int64_t i = 0; i < A->nrow; i++)
            y[i] -= a[i] * q;
    }
}

/* w^2, moved away from the poles of the modes that are projected out. */
static double avoid_poles(const ritz_direct *s, double w2)
{
    int64_t r = s->poles.num_rigid;
    double first = r < s->m ? s->poles.lambda[r] : fabs(s->pairs.sigma);
    double gap =
        fmax(RITZ_NUDGE * w2, r > 0 ? RITZ_NUDGE_AT_REST * first : 0.0);
    bool clear = false;

    for (int t = 0; t < MOST_NUDGES && !clear; t++) {
        clear = true;
        for (int64_t k = 0; k < s->m; k++)
            if (fabs(s->poles.lambda[k] - w2) < gap) {
                w2 = s->poles.lambda[k] + 1.5 * gap;
                clear = false;
            }
    }
    return w2;
}

/*
 * Response of the decoupled rest: the modes' part is projected out of the load
 * before the solution, and out of the solution after it.
 */
static ritz_status solve_decoupled(ritz_direct *s, double w, int64_t k,
                                   double _Complex *X)
{
    if (s->m >= s->n) {
        memset(X, 0, (size_t)(s->n * k) * sizeof *X);
        return RITZ_OK;
    }
    for (int64_t j = 0; j < k; j++)
        remove_modes(&s->MPhi, &s->pairs.Phi, X + j * s->n);
    RITZ_CHECK(factor_impedance(s, w, avoid_poles(s, w * w)));
    RITZ_CHECK(ritz_zldl_solve(s->Z, false, k, X));
    for (int64_t j = 0; j < k; j++)
        remove_modes(&s->pairs.Phi, &s->MPhi, X + j * s->n);
    return RITZ_OK;
}

/* out = E U'X, m x columns. */
static void apply_ratios(const ritz_direct *s, double w, int64_t columns,
                         const double _Complex *X, double _Complex *out)
{
    for (int64_t j = 0; j < columns; j++)
        for (int64_t k = 0; k < s->m; k++) {
            const double *u = ritz_dense_col(&s->MPhi, k);
            double e = ritz_modal_rate(&s->damping, k - s->poles.num_rigid,
                                       s->poles.lambda[k]);
            double _Complex sum = 0.0;

            for (int64_t i = 0; i < s->n; i++)
                sum += u[i] * X[i + j * s->n];
            out[k + j * s->m] =
                ritz_complex(0.0, k < s->poles.num_rigid ? 0.0 : w * e) * sum;
        }
}

/* X := X - Y (I + E U'Y)^-1 E U'X, n x columns; Y n x m. */
static ritz_status correct_ratios(const ritz_direct *s, double w,
                                  int64_t columns, const double _Complex *Y,
                                  double _Complex *X)
{
    int64_t m = s->m;
    RITZ_OWN_ARRAY double _Complex *S = NULL, *q = NULL;
    RITZ_OWN_ARRAY lapack_int *pivot = NULL;
    int info = 0;

    RITZ_CHECK_NEW(S, m * m);
    RITZ_CHECK_NEW(q, m * columns);
    RITZ_CHECK_NEW(pivot, m);
    apply_ratios(s, w, m, Y, S);
    apply_ratios(s, w, columns, X, q);
    for (int64_t k = 0; k < m; k++)
        S[k + k * m] += 1.0;
    if (m > 0)
        info = LAPACKE_zgesv(LAPACK_COL_MAJOR, (int)m, (int)columns, S, (int)m,
                             pivot, q, (int)m);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_SINGULAR,
                   "the response at %.9g Hz is infinite", w / (2.0 * RITZ_PI));
    for (int64_t j = 0; j < columns; j++)
        for (int64_t k = 0; k < m; k++)
            for (int64_t i = 0; i < s->n; i++)
                X[i + j * s->n] -= Y[i + k * s->n] * q[k + j * m];
    return RITZ_OK;
}

/*
 * Responses to k load vectors, and to M Phi if damping ratios act in addition
 * to the matrices.
 */
static ritz_status solve_coupled(ritz_direct *s, double hertz, bool transposed,
                                 int64_t k, double _Complex *X)
{
    double w = 2.0 * RITZ_PI * hertz;
    RITZ_OWN_ARRAY double _Complex *Y = NULL;

    RITZ_REFUSE_IF(hertz == 0.0 && s->poles.num_rigid > 0, RITZ_ERR_SINGULAR,
                   "at 0 Hz the response is infinite: the body is free, begin "
                   "above 0 Hz");
    RITZ_CHECK(factor_impedance(s, w, w * w));
    RITZ_CHECK(ritz_zldl_solve(s->Z, transposed, k, X));
    if (!s->ratios)
        return RITZ_OK;
    RITZ_CHECK_NEW(Y, s->n * s->m);
    for (int64_t i = 0; i < s->n * s->m; i++)
        Y[i] = s->MPhi.val[i];
    RITZ_CHECK(ritz_zldl_solve(s->Z, transposed, s->m, Y));
    return correct_ratios(s, w, k, Y, X);
}

ritz_status ritz_direct_solve(ritz_direct *direct, double hertz,
                              bool transposed, int64_t k, double _Complex *X)
{
    if (direct->apart)
        return solve_decoupled(direct, 2.0 * RITZ_PI * hertz, k, X);
    return solve_coupled(direct, hertz, transposed, k, X);
}

ritz_status ritz_direct_at(ritz_direct *direct, double hertz,
                           double _Complex *H)
{
    const ritz_io *io = &direct->component->io;

    if (direct->inputs == 0)
        return RITZ_OK;
    for (int64_t i = 0; i < direct->n * direct->inputs; i++)
        direct->X[i] = io->B.val[i];
    if (direct->apart)
        RITZ_CHECK(ritz_poles_add(&direct->poles, hertz, H));
    RITZ_CHECK(
        ritz_direct_solve(direct, hertz, false, direct->inputs, direct->X));
    ritz_io_respond(io, hertz, direct->X, H);
    ritz_residual_add_ratios(&direct->rest, hertz, H);
    return RITZ_OK;
}

/*
 * The rounding error of the full response. The computed factors are exact for a
 * matrix that differs from Z by some eps |Z|, entry by entry, so that with x =
 * Z^-1 b and y = Z^-T c
 *
 *     |c'Z^-1 b - computed| <= some eps |y|'|Z||x|
 */

/* t += factor |A||x| */
static void add_magnitudes(const ritz_sparse *A, double factor,
                           const double _Complex *x, double *t)
{
    for (int64_t j = 0; A->colptr && j < A->ncol; j++) {
        double size = factor * cabs(x[j]);

        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            t[A->rowind[p]] += fabs(A->val[p]) * size;
    }
}

ritz_status ritz_direct_noise(const ritz_direct *direct, double hertz,
                              const double _Complex *X, int64_t outputs,
                              const double _Complex *Y, double *out)
{
    const ritz_component *c = direct->component;
    double w = 2.0 * RITZ_PI * hertz;
    int64_t n = direct->n;
    RITZ_OWN_ARRAY double *t = NULL;

    RITZ_CHECK_NEW(t, n);
    for (int64_t j = 0; j < direct->inputs; j++) {
        const double _Complex *x = X + j * n;

        for (int64_t k = 0; k < n; k++)
            t[k] = 0.0;
        add_magnitudes(&c->K, 1.0 + w * fabs(direct->b), x, t);
        add_magnitudes(&c->M, w * w + w * fabs(direct->a), x, t);
        add_magnitudes(&c->D, w, x, t);
        add_magnitudes(&c->K4, 1.0, x, t);
        for (int64_t i = 0; i < outputs; i++) {
            double sum = 0.0;

            for (int64_t k = 0; k < n; k++)
                sum += cabs(Y[k + i * n]) * t[k];
            out[i * direct->inputs + j] =
                RITZ_SUMMED_ROUNDING * DBL_EPSILON * sum;
        }
    }
    return RITZ_OK;
}

/* The direct engine: the full matrices are factored at each point. */

static ritz_status direct_at(void *state, double hertz, double _Complex *H)
{
    return ritz_direct_at(state, hertz, H);
}

static void free_direct(void *state)
{
    ritz_direct_free(state);
}

static ritz_status make_direct(const ritz_response_request *request,
                               ritz_responder *out)
{
    ritz_direct *s = NULL;

    RITZ_CHECK_NEW(s, 1);
    out->state = s;
    out->free = free_direct;
    out->poles = &s->poles;
    out->pairs = &s->pairs;
    out->at = direct_at;
    RITZ_CHECK(ritz_direct_new(request->model.component, request->model.damping,
                               ritz_response_highest(request), s));
    out->uncertain = s->rest.uncertain;
    return ritz_rounded_of(request->model.component, &s->pairs, !s->apart,
                           &out->rounded);
}

const ritz_response_engine ritz_response_engine_direct = {
    .name = "direct",
    .summary = "a sparse complex factor at each frequency",
    .when = "the reference; a handful of frequencies; anything that damps",
    .cost = "a factor for each point, and modes where ratios act on them",
    .holds =
        "D, K4 and Rayleigh damping exactly; ratios on all modes, beyond "
        "2000 dofs to an uncertainty that is stated, or beside D and K4 on "
        "the modes up to --up-to-hz",
    .fails = "many points of a large model take hours",
    .takes = RITZ_MODEL_COMPONENT,
    .make = make_direct,
};
