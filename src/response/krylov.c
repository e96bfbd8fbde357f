#include "response/krylov_space.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "poles/poles.h"
#include "response/krylov_states.h"
#include "response/responder.h"

#include <ritz/base.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * The krylov engine while its space grows: errors at some points, and the
 * vectors that are added where errors are largest. The equations follow below.
 */

typedef struct krylov_responder {
    ritz_direct full;
    ritz_krylov_space space;
    ritz_krylov_small small;
    ritz_residual rest; /* changes by ratios of the modes above */
    double lambda_h;    /* all modes with smaller eigenvalues are in the
                           space */
    double tolerance;   /* relative to the largest |H| of a channel */
    double amplify;     /* factor for error estimates, from errors that full
                           responses showed */
    int64_t outputs, inputs, values;
    int64_t count, num_even; /* of points; at the even ones H too */
    double *hertz;
    double *size;  /* inputs, then outputs: of residuals at one point */
    double *load;  /* norms of the load vectors */
    double *error; /* count x values */
    double *trial; /* values: errors at one more point */
    double *noise; /* values: rounding of the last full H */
    double *peak, *allowed; /* values */
    double _Complex *y, *H;
    double worst;                /* largest error / allowed */
    double unmet;                /* that, or what full responses showed */
    int64_t at;                  /* the point where it is */
    int64_t points, corrections; /* counts */
} krylov_responder;

enum { EVEN = 12, MOST_MODES = 60 };

/* Whether D or K4 couples modes with the rest. */
static bool has_coupling(const krylov_responder *k)
{
    const ritz_component *c = k->full.component;

    return c->D.colptr || c->K4.colptr;
}

/* f, or a frequency next to it if f is that of a mode. */
static double avoid_modes(const krylov_responder *k, double f)
{
    for (int64_t j = 0; j < k->full.m; j++) {
        double mode = ritz_eigen_hertz(k->full.poles.lambda[j]);

        if (fabs(f - mode) < 0.1 * RITZ_BESIDE_MODE * f)
            return f * (1.0 + RITZ_BESIDE_MODE);
    }
    return f;
}

/*
 * Place points evenly; where modes are coupled, also at each resonance and
 * between neighbouring ones. Allocate the arrays.
 */
static ritz_status place_points(krylov_responder *k,
                                const ritz_response_request *request)
{
    double high = request->to_hz;
    double low = fmax(request->from_hz, RITZ_ABOVE_REST * high);
    double before = low;
    int64_t m = k->full.m;
    int64_t stride = 1 + m / MOST_MODES;

    RITZ_CHECK_NEW(k->hertz, EVEN + 2 * m);
    for (int j = 0; j < EVEN; j++)
        k->hertz[k->count++] =
            avoid_modes(k, low + (high - low) * j / (EVEN - 1));
    k->num_even = k->count;
    for (int64_t j = 0; j < m && has_coupling(k); j += stride) {
        double mode = ritz_eigen_hertz(k->full.poles.lambda[j]);

        if (mode <= low || mode >= high)
            continue;
        k->hertz[k->count++] = mode * (1.0 + RITZ_BESIDE_MODE);
        k->hertz[k->count++] = avoid_modes(k, 0.5 * (before + mode));
        before = mode;
    }
    RITZ_CHECK_NEW(k->size, k->inputs + k->outputs);
    RITZ_CHECK_NEW(k->load, k->inputs + k->outputs);
    RITZ_CHECK_NEW(k->error, k->count * k->values);
    RITZ_CHECK_NEW(k->trial, k->values);
    RITZ_CHECK_NEW(k->noise, k->values);
    RITZ_CHECK_NEW(k->peak, k->values);
    RITZ_CHECK_NEW(k->allowed, k->values);
    RITZ_CHECK_NEW(k->H, k->values);
    return RITZ_OK;
}

/* Norms of all residuals at a point, and of the load vectors they belong to. */
static ritz_status measure_residuals(krylov_responder *k, double hertz,
                                     double *error)
{
    double w2 = ritz_eigen_lambda(hertz);
    double gap = fmax(k->lambda_h - w2, RITZ_LEAST_GAP * k->lambda_h);
    double most = k->amplify * (k->lambda_h + k->space.tau) / gap;

    RITZ_CHECK(ritz_krylov_small_solve(&k->small, hertz));
    for (int64_t j = 0; j < k->inputs + k->outputs; j++) {
        ritz_krylov_residual(&k->full, &k->space, &k->small, hertz, j, k->y);
        k->size[j] = ritz_krylov_space_norm(&k->space, k->y);
        for (int64_t c = 0; c < k->space.W.ncol; c++)
            if (k->space.column[c].kind > RITZ_KRYLOV_CA)
                k->y[c] = 0.0;
        k->load[j] = fmax(k->load[j], ritz_krylov_space_norm(&k->space, k->y));
    }
    for (int64_t i = 0; i < k->outputs; i++)
        for (int64_t j = 0; j < k->inputs; j++)
            error[i * k->inputs + j] =
                most * k->size[k->inputs + i] * k->size[j];
    return RITZ_OK;
}

static ritz_status raise_peaks(krylov_responder *k, double hertz)
{
    memset(k->H, 0, (size_t)k->values * sizeof *k->H);
    RITZ_CHECK(ritz_poles_add(&k->small.poles, hertz, k->H));
    for (int64_t v = 0; v < k->values; v++)
        k->peak[v] = fmax(k->peak[v], cabs(k->H[v]));
    return RITZ_OK;
}

/* Set the error that each channel may have. */
static void set_allowed(krylov_responder *k)
{
    ritz_channel_scales(k->outputs, k->inputs, k->peak, k->allowed);
    for (int64_t i = 0; i < k->outputs; i++)
        for (int64_t j = 0; j < k->inputs; j++) {
            int64_t v = i * k->inputs + j;

            k->allowed[v] =
                k->tolerance * k->allowed[v] +
                RITZ_PROJECTION_FLOOR *
                    (k->peak[v] + k->load[j] * k->load[k->inputs + i]);
        }
}

static ritz_status krylov_at(void *state, double hertz, double _Complex *H)
{
    const krylov_responder *k = state;

    RITZ_CHECK(ritz_poles_add(&k->small.poles, hertz, H));
    ritz_residual_add_ratios(&k->rest, hertz, H);
    return RITZ_OK;
}

/* Measure all points and find the largest ratio of error to allowed error. */
static ritz_status measure_points(krylov_responder *k)
{
    free(k->y);
    RITZ_CHECK_NEW(k->y, k->space.W.ncol);
    for (int64_t c = 0; c < k->count; c++) {
        RITZ_CHECK(measure_residuals(k, k->hertz[c], k->error + c * k->values));
        if (c < k->num_even)
            RITZ_CHECK(raise_peaks(k, k->hertz[c]));
    }
    set_allowed(k);
    k->worst = 0.0;
    for (int64_t c = 0; c < k->count; c++)
        for (int64_t v = 0; v < k->values; v++) {
            double part = k->error[c * k->values + v];

            if (part > 0.0 && !(part <= k->worst * k->allowed[v])) {
                k->worst = part / k->allowed[v];
                k->at = c;
            }
        }
    k->unmet = k->worst;
    return RITZ_OK;
}

/* Whether residual `index` contributes to an error that is too large. */
static bool is_responsible(const krylov_responder *k, int64_t index)
{
    const double *error = k->error + k->at * k->values;

    for (int64_t i = 0; i < k->outputs; i++)
        for (int64_t j = 0; j < k->inputs; j++)
            if ((index == j || index == k->inputs + i) &&
                error[i * k->inputs + j] > k->allowed[i * k->inputs + j])
                return true;
    return false;
}

/* Extend the space by X, project again and measure. */
static ritz_status renew_projection(krylov_responder *k, ritz_dense *X,
                                    int64_t *added)
{
    RITZ_CHECK(ritz_krylov_space_add(&k->space, X, added));
    ritz_krylov_small_free(&k->small);
    RITZ_CHECK(ritz_krylov_small_new(&k->full, &k->space, &k->small));
    return measure_points(k);
}

/* Append the real and the imaginary part of S y to X, as columns. */
static void append_correction(const krylov_responder *k, ritz_dense *X)
{
    int64_t n = k->space.S.nrow;
    double *re = X->val + n * X->ncol;
    double *im = re + n;

    for (int64_t c = 0; c < k->space.S.ncol; c++) {
        const double *s = ritz_dense_col(&k->space.S, c);
        double a = creal(k->y[c]);
        double b = cimag(k->y[c]);

        for (int64_t i = 0; i < n && (a != 0.0 || b != 0.0); i++) {
            re[i] += a * s[i];
            im[i] += b * s[i];
        }
    }
    X->ncol += 2;
}

/* The first vectors: A^-1 of all load vectors. */
static ritz_status begin_space(krylov_responder *k)
{
    RITZ_OWN(ritz_dense) X = {0};
    int64_t added = 0;

    if (k->full.m < k->full.n)
        RITZ_CHECK(ritz_dense_copy(&k->space.S, &X));
    X.nrow = k->full.n;
    for (int64_t c = 0; c < k->space.W.ncol; c++)
        if (k->space.column[c].kind > RITZ_KRYLOV_CA && X.ncol > c)
            X.ncol = c; /* loads come first */
    return renew_projection(k, &X, &added);
}

/* Extend the space by A^-1 of the residuals at the worst point. */
static ritz_status correct_worst(krylov_responder *k, int64_t *added)
{
    int64_t loads = k->inputs + k->outputs;
    double hertz = k->hertz[k->at];
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK(ritz_dense_new(k->full.n, 2 * loads, &X));
    X.ncol = 0;
    RITZ_CHECK(ritz_krylov_small_solve(&k->small, hertz));
    for (int64_t j = 0; j < loads; j++)
        if (is_responsible(k, j)) {
            ritz_krylov_residual(&k->full, &k->space, &k->small, hertz, j,
                                 k->y);
            append_correction(k, &X);
        }
    RITZ_CHECK(renew_projection(k, &X, added));
    k->corrections++;
    return RITZ_OK;
}

/* Fill in b of the inputs, then c of the outputs, n entries each. */
static void fill_loads(const krylov_responder *k, double w, double _Complex *X)
{
    const ritz_io *io = &k->full.component->io;
    int64_t n = k->full.n;

    for (int64_t i = 0; i < n * k->inputs; i++)
        X[i] = io->B.val[i];
    for (int64_t i = 0; i < n; i++)
        for (int64_t o = 0; o < k->outputs; o++)
            X[i + (k->inputs + o) * n] =
                ritz_complex(ritz_dense_col(&io->C, i)[o] -
                                 w * w * ritz_dense_col(&io->Ca, i)[o],
                             w * ritz_dense_col(&io->Cv, i)[o]);
}

/* Real and imaginary parts as columns next to each other. */
static ritz_status split_complex(int64_t n, int64_t columns,
                                 const double _Complex *Z, ritz_dense *X)
{
    RITZ_CHECK(ritz_dense_new(n, 2 * columns, X));
    for (int64_t j = 0; j < columns; j++)
        for (int64_t i = 0; i < n; i++) {
            ritz_dense_col(X, 2 * j)[i] = creal(Z[i + j * n]);
            ritz_dense_col(X, 2 * j + 1)[i] = cimag(Z[i + j * n]);
        }
    return RITZ_OK;
}

/*
 * Largest error of the projection relative to the allowed one, from the full
 * response. If it is larger than estimated, all estimates are amplified from
 * now on. Rounding of the full response is not counted as error; Y holds the
 * responses of the transposed system to the outputs.
 */
static ritz_status compare_full(krylov_responder *k, double hertz,
                                const double _Complex *X,
                                const double _Complex *Y, double *out)
{
    double more = 1.0;
    RITZ_OWN_ARRAY double _Complex *H = NULL;

    RITZ_CHECK_NEW(H, k->values);
    RITZ_CHECK(ritz_direct_noise(&k->full, hertz, X, k->outputs, Y, k->noise));
    ritz_io_respond(&k->full.component->io, hertz, X, H);
    if (k->full.apart)
        RITZ_CHECK(ritz_poles_add(&k->full.poles, hertz, H));
    RITZ_CHECK(measure_residuals(k, hertz, k->trial));
    memset(k->H, 0, (size_t)k->values * sizeof *k->H);
    RITZ_CHECK(ritz_poles_add(&k->small.poles, hertz, k->H));
    *out = 0.0;
    for (int64_t v = 0; v < k->values; v++) {
        double error = fmax(cabs(H[v] - k->H[v]) - k->noise[v], 0.0);
        double allowed = fmax(k->allowed[v], k->tolerance * cabs(H[v]));

        if (!(allowed > 0.0))
            continue;
        *out = fmax(*out, error / allowed);
        if (error > 0.1 * allowed && error > k->trial[v])
            more = fmax(more, error / k->trial[v]);
    }
    k->amplify = fmin(k->amplify * more, RITZ_MOST_AMPLIFIED);
    return RITZ_OK;
}

/*
 * Full responses to all inputs at a frequency, or next to it if the matrix is
 * singular there; and those of the transposed system to all outputs.
 */
static ritz_status solve_full(krylov_responder *k, double *hertz,
                              double _Complex *Z)
{
    ritz_status status = RITZ_OK;

    fill_loads(k, sqrt(ritz_eigen_lambda(*hertz)), Z);
    status = ritz_direct_solve(&k->full, *hertz, false, k->inputs, Z);
    if (status == RITZ_ERR_SINGULAR) {
        *hertz *= 1.0 + RITZ_BESIDE_POLE;
        fill_loads(k, sqrt(ritz_eigen_lambda(*hertz)), Z);
        status = ritz_direct_solve(&k->full, *hertz, false, k->inputs, Z);
    }
    RITZ_CHECK(status);
    return ritz_direct_solve(&k->full, *hertz, true, k->outputs,
                             Z + k->full.n * k->inputs);
}

/*
 * Compute the full responses at one frequency. They join the space unless the
 * error of the projection there is within the allowed fraction of the largest
 * |H|, this one included, or within the rounding of the full responses.
 *
 * @param[out] was  that error over what is allowed
 */
static ritz_status expand_at(krylov_responder *k, double hertz, int64_t *added,
                             double *was)
{
    int64_t n = k->full.n;
    int64_t loads = k->inputs + k->outputs;
    RITZ_OWN_ARRAY double _Complex *Z = NULL;
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK_NEW(Z, n * loads);
    RITZ_CHECK(solve_full(k, &hertz, Z));
    RITZ_CHECK(compare_full(k, hertz, Z, Z + n * k->inputs, was));
    k->points++;
    *added = 0;
    if (*was <= 1.0)
        return RITZ_OK;
    RITZ_CHECK(split_complex(n, loads, Z, &X));
    RITZ_CHECK(renew_projection(k, &X, added));
    k->unmet = fmax(k->unmet, *was);
    return RITZ_OK;
}

/*
 * Response by projection: the full damped matrices are projected on a space of
 * modes and static solutions, with the same V on both sides, which keeps
 * symmetry and dissipation. The error of Galerkin's H is
 *
 *     c'Z^-1 b - c'V q = r_c'Z^-1 r_b,    r_b = b - Z V q,  r_c = c - Z'V p,
 *
 * and both residuals have no part along modes below lambda_h. So with |r| in
 * the norm of A^-1, A = K + tau M,
 *
 *     |error| <= (lambda_h + tau) / (lambda_h - w^2) |r_c| |r_b|,
 *
 * which is a bound if no D or K4 couples modes with the rest. Otherwise it is
 * an indicator, and the full response at the worst point has to confirm it.
 *
 * Where the error is largest, A^-1 of both residuals joins the space: another
 * moment at the expansion point s = sqrt(tau), from a factor that exists
 * already. When such corrections no longer reduce the error, Z(i w)^-1 B and
 * Z(i w)^-T C' join it, which is a new expansion point [Grimme1997].
 */

enum { MOST_ROUNDS = 60, MOST_CONFIRMED = 12 };

static void free_krylov(void *state)
{
    krylov_responder *k = state;

    ritz_direct_free(&k->full);
    ritz_krylov_space_free(&k->space);
    ritz_krylov_small_free(&k->small);
    ritz_residual_free(&k->rest);
    RITZ_FREE(k->hertz, k->size, k->load, k->error, k->trial, k->noise, k->peak,
              k->allowed, k->y, k->H);
}

/*
 * Grow the space until the error is small everywhere. *held says that the full
 * response at an expansion point found the error within the limit although the
 * estimate did not: the bound is not sharp there.
 */
static ritz_status grow_space(krylov_responder *k, bool *held)
{
    bool pay = true;
    int64_t added = 1;

    *held = k->worst <= 1.0;
    for (int t = 0; t < MOST_ROUNDS && !*held && (added > 0 || pay); t++) {
        double before = k->worst;
        double was = HUGE_VAL;

        if (pay) {
            RITZ_CHECK(correct_worst(k, &added));
            pay = added > 0 && k->worst <= RITZ_CORRECTION_PAYS * before;
            added = 1;
        } else {
            RITZ_CHECK(expand_at(k, k->hertz[k->at], &added, &was));
            pay = added > 0;
        }
        *held = k->worst <= 1.0 || was <= 1.0;
        ritz_monitor_step("space of the response", k->space.V.ncol, 0);
    }
    return RITZ_OK;
}

/*
 * The frequency of the least damped pole, or one next to it where the undamped
 * system has no response; 0 if no pole is in the range.
 */
static ritz_status find_least_damped(const krylov_responder *k,
                                     const ritz_response_request *request,
                                     double *out)
{
    const double band_hz[2] = {request->from_hz, request->to_hz};
    RITZ_OWN(ritz_damped) damped = {0};
    double least = HUGE_VAL;

    *out = 0.0;
    RITZ_CHECK(ritz_damped_new(&k->small.poles, NULL, NULL, band_hz, &damped));
    for (int64_t j = 0; j < damped.listing.count; j++) {
        double _Complex s = damped.listing.s[j];
        double hertz = cimag(s) / (2.0 * RITZ_PI);
        double zeta = ritz_spectrum_ratio(s);

        if (hertz > band_hz[0] && hertz < band_hz[1] && zeta < least) {
            least = zeta;
            *out = hertz;
        }
    }
    if (least < RITZ_BESIDE_MODE)
        *out *= 1.0 + RITZ_BESIDE_MODE;
    return RITZ_OK;
}

/*
 * Compare with full responses at the worst point and at the least damped pole.
 */
static ritz_status confirm_errors(krylov_responder *k,
                                  const ritz_response_request *request,
                                  bool *held)
{
    double hertz = k->hertz[k->at];
    double was = 0.0;
    int64_t added = 0;

    for (int t = 0; t < 2 && hertz > 0.0; t++) {
        RITZ_CHECK(expand_at(k, hertz, &added, &was));
        *held = was <= 1.0;
        if (!*held)
            break;
        RITZ_CHECK(find_least_damped(k, request, &hertz));
    }
    return RITZ_OK;
}

static ritz_status converge_errors(krylov_responder *k,
                                   const ritz_response_request *request)
{
    bool held = false;

    RITZ_CHECK(begin_space(k));
    for (int t = 0; t < MOST_CONFIRMED && !held; t++) {
        RITZ_CHECK(grow_space(k, &held));
        if (!held)
            break;
        if (has_coupling(k))
            RITZ_CHECK(confirm_errors(k, request, &held));
    }
    RITZ_REFUSE_IF(!held, RITZ_ERR_CONVERGENCE,
                   "a space of %" PRId64
                   " vectors errs by %.1e of the largest response, not %.1e",
                   k->space.V.ncol, k->unmet * k->tolerance, k->tolerance);
    return RITZ_OK;
}

/*
 * Damping ratios act on the modes that every engine is given; without ratios
 * fewer modes are computed.
 */
static double highest_mode(const ritz_response_request *request)
{
    const ritz_damping *damping = request->model.damping;

    if (request->up_to_hz > 0.0 || ritz_damping_has_ratios(damping))
        return ritz_response_highest(request);
    return RITZ_POLES_BEYOND * request->to_hz;
}

static ritz_status start_krylov(const ritz_response_request *request,
                                krylov_responder *k)
{
    const ritz_io *io = &request->model.component->io;
    double highest = highest_mode(request);

    RITZ_CHECK(ritz_response_reach(request));
    k->tolerance =
        request->tolerance > 0.0 ? request->tolerance : RITZ_ENGINE_TOLERANCE;
    k->tolerance = fmax(k->tolerance, RITZ_PROJECTION_FLOOR);
    k->amplify = 1.0;
    k->lambda_h = ritz_eigen_lambda(highest);
    k->outputs = io->num_outputs;
    k->inputs = io->num_inputs;
    k->values = k->outputs * k->inputs;
    RITZ_CHECK(ritz_direct_new(request->model.component, request->model.damping,
                               highest, &k->full));
    RITZ_CHECK(ritz_krylov_space_new(
        &k->full, ritz_eigen_lambda(request->to_hz), &k->space));
    RITZ_CHECK(place_points(k, request));
    return converge_errors(k, request);
}

static ritz_status make_krylov(const ritz_response_request *request,
                               ritz_responder *out)
{
    krylov_responder *k = NULL;

    if (request->model.kind == RITZ_MODEL_STATES)
        return ritz_krylov_states(request, out);
    RITZ_CHECK_NEW(k, 1);
    out->state = k;
    out->free = free_krylov;
    out->poles = &k->small.poles;
    out->at = krylov_at;
    RITZ_CHECK(start_krylov(request, k));
    RITZ_CHECK(ritz_rounded_of(request->model.component, &k->full.pairs, false,
                               &out->rounded));
    (void)snprintf(out->remark, sizeof out->remark,
                   "%" PRId64 " modes and %" PRId64 " vectors more, of %" PRId64
                   " corrections and %" PRId64
                   " full responses; error below %.1e",
                   k->full.m, k->space.V.ncol - k->full.m, k->corrections + 1,
                   k->points, k->worst * k->tolerance);
    ritz_krylov_space_free(&k->space); /* frees arrays of length n */
    out->uncertain = k->full.rest.uncertain;
    RITZ_MOVE(k->rest, k->full.rest);
    ritz_direct_free(&k->full);
    return RITZ_OK;
}

const ritz_response_engine ritz_response_engine_krylov = {
    .name = "krylov",
    .summary = "the full matrices projected on modes and responses",
    .reference = "Grimme1997",
    .when = "large components, many points; local dampers, D and K4; large "
            "state spaces",
    .cost = "modes, one real factor, and a complex one for each expansion "
            "point; then O(vectors) a point, O(vectors^3) with D or K4",
    .holds = "the tolerance: by a bound without D and K4, else by an indicator "
             "that full responses confirm",
    .fails = "hundreds of inputs or outputs: each adds vectors",
    .takes = RITZ_MODEL_COMPONENT | RITZ_MODEL_STATES,
    .make = make_krylov,
};
