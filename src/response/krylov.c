#include "response/krylov_space.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/io.h"
#include "poles/damped.h"
#include "response/responder.h"

#include <ritz/base.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * The krylov engine while its space grows: errors at some points, and what is
 * added where they are largest. See response_krylov.c for the equations.
 */

typedef struct krylov_responder {
    ritz_direct full;
    ritz_krylov_space space;
    ritz_krylov_small small;
    double lambda_h;  /* every mode beneath is in the space */
    double tolerance; /* of the largest |H| of a channel */
    double amplify;   /* of errors, where full answers showed larger ones */
    int64_t outputs, inputs, values;
    int64_t count, num_even; /* of points; the first measure H too */
    double *hertz;
    double *size;  /* inputs, then outputs: of residuals at one point */
    double *load;  /* the same of the loads */
    double *error; /* count x values */
    double *trial; /* values: errors at one point more */
    double *noise; /* values: rounding of the full answers met last */
    double *peak, *allowed; /* values */
    double _Complex *y, *H;
    double worst;                /* largest error / allowed */
    double unmet;                /* that, or what full answers showed */
    int64_t at;                  /* the point where it is */
    int64_t points, corrections; /* that were made */
} krylov_responder;

enum { EVEN = 12, MOST_MODES = 60 };

/* Whether D or K4 couples modes with the rest. */
static bool krylov_couples(const krylov_responder *k)
{
    const ritz_component *c = k->full.component;

    return c->D.colptr || c->K4.colptr;
}

/* f, or beside it where a mode is. */
static double clear(const krylov_responder *k, double f)
{
    for (int64_t j = 0; j < k->full.m; j++) {
        double mode = ritz_eigen_hertz(k->full.poles.lambda[j]);

        if (fabs(f - mode) < 0.1 * RITZ_BESIDE_MODE * f)
            return f * (1.0 + RITZ_BESIDE_MODE);
    }
    return f;
}

/* Even ones; where modes are coupled, each resonance and between them too. */
static ritz_status place(krylov_responder *k, double low, double high)
{
    double before = low;
    int64_t m = k->full.m;
    int64_t stride = 1 + m / MOST_MODES;

    RITZ_CHECK_NEW(k->hertz, EVEN + 2 * m);
    for (int j = 0; j < EVEN; j++)
        k->hertz[k->count++] = clear(k, low + (high - low) * j / (EVEN - 1));
    k->num_even = k->count;
    for (int64_t j = 0; j < m && krylov_couples(k); j += stride) {
        double mode = ritz_eigen_hertz(k->full.poles.lambda[j]);

        if (mode <= low || mode >= high)
            continue;
        k->hertz[k->count++] = mode * (1.0 + RITZ_BESIDE_MODE);
        k->hertz[k->count++] = clear(k, 0.5 * (before + mode));
        before = mode;
    }
    return RITZ_OK;
}

static ritz_status make_room(krylov_responder *k)
{
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

/* Points and arrays for a range. */
static ritz_status place_krylov(krylov_responder *k, double from_hz,
                                double to_hz)
{
    RITZ_CHECK(place(k, fmax(from_hz, RITZ_ABOVE_REST * to_hz), to_hz));
    return make_room(k);
}

/* Residual `index`, inputs before outputs, of what was solved last. */
static void take_krylov(krylov_responder *k, double hertz, int64_t index)
{
    bool dual = index >= k->inputs;

    ritz_krylov_residual(&k->full, &k->space, &k->small, hertz, dual,
                         dual ? index - k->inputs : index, k->y);
}

/* Sizes of all residuals at a point; of loads, of which they are the rest. */
static ritz_status judge_krylov(krylov_responder *k, double hertz,
                                double *error)
{
    double w2 = ritz_eigen_lambda(hertz);
    double gap = fmax(k->lambda_h - w2, RITZ_LEAST_GAP * k->lambda_h);
    double most = k->amplify * (k->lambda_h + k->space.tau) / gap;

    RITZ_CHECK(ritz_krylov_small_solve(&k->small, hertz));
    for (int64_t j = 0; j < k->inputs + k->outputs; j++) {
        take_krylov(k, hertz, j);
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

static ritz_status see_peaks(krylov_responder *k, double hertz)
{
    memset(k->H, 0, (size_t)k->values * sizeof *k->H);
    RITZ_CHECK(ritz_poles_add(&k->small.poles, hertz, k->H));
    for (int64_t v = 0; v < k->values; v++)
        k->peak[v] = fmax(k->peak[v], cabs(k->H[v]));
    return RITZ_OK;
}

/* What each channel may err. */
static void allow(krylov_responder *k)
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

static ritz_status at(void *state, double hertz, double _Complex *H)
{
    return ritz_poles_add(&((krylov_responder *)state)->small.poles, hertz, H);
}

/* Every point: the worst of them, against what is allowed. */
static ritz_status measure_krylov(krylov_responder *k)
{
    free(k->y);
    RITZ_CHECK_NEW(k->y, k->space.W.ncol);
    for (int64_t c = 0; c < k->count; c++) {
        RITZ_CHECK(judge_krylov(k, k->hertz[c], k->error + c * k->values));
        if (c < k->num_even)
            RITZ_CHECK(see_peaks(k, k->hertz[c]));
    }
    allow(k);
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

/* Whether residual `index` has a part in an error that is too large. */
static bool takes_part(const krylov_responder *k, int64_t index)
{
    const double *error = k->error + k->at * k->values;

    for (int64_t i = 0; i < k->outputs; i++)
        for (int64_t j = 0; j < k->inputs; j++)
            if ((index == j || index == k->inputs + i) &&
                error[i * k->inputs + j] > k->allowed[i * k->inputs + j])
                return true;
    return false;
}

/* Project anew and measure. */
static ritz_status renew(krylov_responder *k, ritz_dense *X, int64_t *added)
{
    RITZ_CHECK(ritz_krylov_space_add(&k->space, X, added));
    ritz_krylov_small_free(&k->small);
    RITZ_CHECK(ritz_krylov_small_new(&k->full, &k->space, &k->small));
    return measure_krylov(k);
}

/* X += real and imaginary part of S y, as columns. */
static void correction(const krylov_responder *k, ritz_dense *X)
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

/* The first: A^-1 of all loads. */
static ritz_status begin_krylov(krylov_responder *k)
{
    RITZ_OWN(ritz_dense) X = {0};
    int64_t added = 0;

    if (k->full.m < k->full.n)
        RITZ_CHECK(ritz_dense_copy(&k->space.S, &X));
    X.nrow = k->full.n;
    for (int64_t c = 0; c < k->space.W.ncol; c++)
        if (k->space.column[c].kind > RITZ_KRYLOV_CA && X.ncol > c)
            X.ncol = c; /* loads are in front */
    return renew(k, &X, &added);
}

/* A^-1 of the residuals at the worst point. */
static ritz_status krylov_correct(krylov_responder *k, int64_t *added)
{
    int64_t loads = k->inputs + k->outputs;
    double hertz = k->hertz[k->at];
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK(ritz_dense_new(k->full.n, 2 * loads, &X));
    X.ncol = 0;
    RITZ_CHECK(ritz_krylov_small_solve(&k->small, hertz));
    for (int64_t j = 0; j < loads; j++)
        if (takes_part(k, j)) {
            take_krylov(k, hertz, j);
            correction(k, &X);
        }
    RITZ_CHECK(renew(k, &X, added));
    k->corrections++;
    return RITZ_OK;
}

/* b of the inputs, then c of the outputs, n each. */
static void put_loads(const krylov_responder *k, double w, double _Complex *X)
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

/* Real and imaginary parts side by side. */
static ritz_status split(int64_t n, int64_t columns, const double _Complex *Z,
                         ritz_dense *X)
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
 * Largest error of the projection beside full answers, over what is allowed;
 * where it is more than was thought, all errors are from now on. Neither is
 * what rounding makes of those answers: Y are the outputs' own.
 */
static ritz_status compare(krylov_responder *k, double hertz,
                           const double _Complex *X, const double _Complex *Y,
                           double *out)
{
    ritz_status status = RITZ_OK;
    double more = 1.0;
    double _Complex *H = NULL;

    RITZ_NEW(H, k->values);
    RITZ_TRY(ritz_direct_noise(&k->full, hertz, X, k->outputs, Y, k->noise));
    ritz_io_respond(&k->full.component->io, hertz, X, H);
    if (k->full.apart)
        RITZ_TRY(ritz_poles_add(&k->full.poles, hertz, H));
    RITZ_TRY(judge_krylov(k, hertz, k->trial));
    memset(k->H, 0, (size_t)k->values * sizeof *k->H);
    RITZ_TRY(ritz_poles_add(&k->small.poles, hertz, k->H));
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
done:
    free(H);
    return status;
}

/* Answers to all inputs at a frequency, or beside it where there is none; and
   to all outputs, of the transposed system. */
static ritz_status answer(krylov_responder *k, double *hertz,
                          double _Complex *Z)
{
    ritz_status status = RITZ_OK;

    put_loads(k, sqrt(ritz_eigen_lambda(*hertz)), Z);
    status = ritz_direct_solve(&k->full, *hertz, false, k->inputs, Z);
    if (status == RITZ_ERR_SINGULAR) {
        *hertz *= 1.0 + RITZ_BESIDE_POLE;
        put_loads(k, sqrt(ritz_eigen_lambda(*hertz)), Z);
        status = ritz_direct_solve(&k->full, *hertz, false, k->inputs, Z);
    }
    if (status != RITZ_OK)
        goto done;
    RITZ_TRY(ritz_direct_solve(&k->full, *hertz, true, k->outputs,
                               Z + k->full.n * k->inputs));
done:
    return status;
}

/*
 * Full answers at one frequency, and into the space unless what the projection
 * errs there is within what is allowed of the largest |H|, this one included,
 * and within what rounding makes of the full answers themselves.
 *
 * @param[out] was  that error over what is allowed
 */
static ritz_status krylov_expand(krylov_responder *k, double hertz,
                                 int64_t *added, double *was)
{
    ritz_status status = RITZ_OK;
    int64_t n = k->full.n;
    int64_t loads = k->inputs + k->outputs;
    double _Complex *Z = NULL;
    ritz_dense X = {0};

    RITZ_NEW(Z, n * loads);
    RITZ_TRY(answer(k, &hertz, Z));
    RITZ_TRY(compare(k, hertz, Z, Z + n * k->inputs, was));
    k->points++;
    *added = 0;
    if (*was <= 1.0)
        goto done;
    RITZ_TRY(split(n, loads, Z, &X));
    RITZ_TRY(renew(k, &X, added));
    k->unmet = fmax(k->unmet, *was);
done:
    free(Z);
    ritz_dense_free(&X);
    return status;
}

/*
 * Response by projection: the full damped matrices in a space of modes and of
 * answers, one V on both sides, so that symmetric stays symmetric and what
 * dissipates still does. The error of Galerkin's H is
 *
 *     c'Z^-1 b - c'V q = r_c'Z^-1 r_b,    r_b = b - Z V q,  r_c = c - Z'V p,
 *
 * and both residuals are free of modes below lambda_h. So with |r| in A^-1,
 * A = K + tau M,
 *
 *     |error| <= (lambda_h + tau) / (lambda_h - w^2) |r_c| |r_b|,
 *
 * a bound if no D or K4 couples modes with the rest, an indicator if one does:
 * then the worst point is answered by the full matrices before it is believed.
 *
 * Where it is largest the space gets A^-1 of both residuals, which is another
 * moment at the expansion point s = sqrt(tau), with a factor that is there; if
 * that pays no more, Z(i w)^-1 B and Z(i w)^-T C', an expansion point of its
 * own [Grimme1997].
 */

enum { MOST_ROUNDS = 60, MOST_CONFIRMED = 12 };

static void krylov_free(krylov_responder *k)
{
    ritz_direct_free(&k->full);
    ritz_krylov_space_free(&k->space);
    ritz_krylov_small_free(&k->small);
    free(k->hertz);
    free(k->size);
    free(k->load);
    free(k->error);
    free(k->trial);
    free(k->noise);
    free(k->peak);
    free(k->allowed);
    free(k->y);
    free(k->H);
}

/*
 * Until the error is small everywhere. An expansion point at which it is,
 * beside the full answers, says that the bound is not sharp: *held.
 */
static ritz_status grow(krylov_responder *k, bool *held)
{
    bool pay = true;
    int64_t added = 1;

    *held = k->worst <= 1.0;
    for (int t = 0; t < MOST_ROUNDS && !*held && (added > 0 || pay); t++) {
        double before = k->worst;
        double was = HUGE_VAL;

        if (pay) {
            RITZ_CHECK(krylov_correct(k, &added));
            pay = added > 0 && k->worst <= RITZ_CORRECTION_PAYS * before;
            added = 1;
        } else {
            RITZ_CHECK(krylov_expand(k, k->hertz[k->at], &added, &was));
            pay = added > 0;
        }
        *held = k->worst <= 1.0 || was <= 1.0;
        ritz_monitor_step("space of the response", k->space.V.ncol, 0);
    }
    return RITZ_OK;
}

/* The frequency of the pole that is damped least, or beside it where that has
   no response; 0 if none is in the range. */
static ritz_status find_quietest(const krylov_responder *k,
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

/* Full answers at the worst point, and at the pole that is damped least. */
static ritz_status confirm(krylov_responder *k,
                           const ritz_response_request *request, bool *held)
{
    double hertz = k->hertz[k->at];
    double was = 0.0;
    int64_t added = 0;

    for (int t = 0; t < 2 && hertz > 0.0; t++) {
        RITZ_CHECK(krylov_expand(k, hertz, &added, &was));
        *held = was <= 1.0;
        if (!*held)
            break;
        RITZ_CHECK(find_quietest(k, request, &hertz));
    }
    return RITZ_OK;
}

static ritz_status converge(krylov_responder *k,
                            const ritz_response_request *request)
{
    bool held = false;

    RITZ_CHECK(begin_krylov(k));
    for (int t = 0; t < MOST_CONFIRMED && !held; t++) {
        RITZ_CHECK(grow(k, &held));
        if (!held)
            break;
        if (krylov_couples(k))
            RITZ_CHECK(confirm(k, request, &held));
    }
    RITZ_REFUSE_IF(!held, RITZ_ERR_CONVERGENCE,
                   "a space of %" PRId64
                   " vectors errs by %.1e of the largest response, not %.1e",
                   k->space.V.ncol, k->unmet * k->tolerance, k->tolerance);
    return RITZ_OK;
}

/* Ratios act on the modes that all engines give them; else fewer are found. */
static double highest_of(const ritz_response_request *request)
{
    const ritz_damping *damping = request->damping;

    if (request->up_to_hz > 0.0 ||
        (damping && damping->kind != RITZ_DAMPING_NONE &&
         !ritz_damping_is_rayleigh(damping)))
        return ritz_response_highest(request);
    return RITZ_POLES_BEYOND * request->to_hz;
}

static ritz_status start(const ritz_response_request *request,
                         krylov_responder *k)
{
    const ritz_io *io = &request->component->io;
    double highest = highest_of(request);

    RITZ_REFUSE_IF(highest < request->to_hz, RITZ_ERR_ARGUMENT,
                   "modes up to %g Hz cannot give a response up to %g Hz",
                   highest, request->to_hz);
    k->tolerance =
        request->tolerance > 0.0 ? request->tolerance : RITZ_ENGINE_TOLERANCE;
    k->tolerance = fmax(k->tolerance, RITZ_PROJECTION_FLOOR);
    k->amplify = 1.0;
    k->lambda_h = ritz_eigen_lambda(highest);
    k->outputs = io->num_outputs;
    k->inputs = io->num_inputs;
    k->values = k->outputs * k->inputs;
    RITZ_CHECK(ritz_direct_new(request->component, request->damping, highest,
                               &k->full));
    RITZ_CHECK(ritz_krylov_space_new(
        &k->full, ritz_eigen_lambda(request->to_hz), &k->space));
    RITZ_CHECK(place_krylov(k, request->from_hz, request->to_hz));
    return converge(k, request);
}

static void finish(void *state)
{
    krylov_free(state);
    free(state);
}

static ritz_status make(const ritz_response_request *request,
                        ritz_responder *out)
{
    ritz_status status = RITZ_OK;
    krylov_responder *k = NULL;

    RITZ_NEW(k, 1);
    RITZ_TRY(start(request, k));
    (void)snprintf(out->remark, sizeof out->remark,
                   "%" PRId64 " modes and %" PRId64 " vectors more, of %" PRId64
                   " corrections and %" PRId64
                   " full answers; error below %.1e",
                   k->full.m, k->space.V.ncol - k->full.m, k->corrections + 1,
                   k->points, k->worst * k->tolerance);
    ritz_krylov_space_free(&k->space); /* of length n, and needed no more */
    ritz_direct_free(&k->full);
    out->poles = &k->small.poles;
    out->at = at;
    out->free = finish;
    RITZ_MOVE(out->state, k);
done:
    if (k)
        finish(k);
    return status;
}

const ritz_response_engine ritz_response_engine_krylov = {
    .name = "krylov",
    .summary = "the full damped matrices projected on modes and answers",
    .reference = "Grimme1997",
    .when = "large components, many points; local dampers, D and K4",
    .cost = "modes, one real factor, and a complex one for each expansion "
            "point; then O(vectors) a point, O(vectors^3) with D or K4",
    .holds = "the tolerance: by a bound without D and K4, else by an indicator "
             "that full answers confirm",
    .fails = "hundreds of inputs or outputs: each adds vectors",
    .takes = RITZ_RESPONDS_COMPONENT,
    .make = make,
};
