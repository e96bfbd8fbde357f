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
#include "response/krylov.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "poles/damped.h"
#include "response/responder.h"

#include <ritz/monitor.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_ROUNDS = 60, MOST_CONFIRMED = 12 };

/* Of ratios' modes as all engines have it; without them fewer will do. */
static const double modes_beyond = 1.5;
static const double usual_tolerance = 1e-9;
/* Rounding of what is projected; less is not to be had. */
static const double least_tolerance = 1e-13;
/* A correction that leaves more than this of the error was the last. */
static const double pays = 0.3;
/* Of its frequency: so far beside an undamped pole full answers keep digits. */
static const double beside = 1e-5;

static void krylov_free(ritz_krylov *k)
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
static ritz_status grow(ritz_krylov *k, bool *held)
{
    bool pay = true;
    int64_t added = 1;

    *held = k->worst <= 1.0;
    for (int t = 0; t < MOST_ROUNDS && !*held && (added > 0 || pay); t++) {
        double before = k->worst;
        double was = HUGE_VAL;

        if (pay) {
            RITZ_CHECK(ritz_krylov_correct(k, &added));
            pay = added > 0 && k->worst <= pays * before;
            added = 1;
        } else {
            RITZ_CHECK(ritz_krylov_expand(k, k->hertz[k->at], &added, &was));
            pay = added > 0;
        }
        *held = k->worst <= 1.0 || was <= 1.0;
        ritz_monitor_step("space of the response", k->space.V.ncol, 0);
    }
    return RITZ_OK;
}

/* The frequency of the pole that is damped least, or beside it where that has
   no response; 0 if none is in the range. */
static ritz_status find_quietest(const ritz_krylov *k,
                                 const ritz_response_request *request,
                                 double *out)
{
    const double band_hz[2] = {request->from_hz, request->to_hz};
    ritz_status status = RITZ_OK;
    ritz_damped damped = {0};
    double least = HUGE_VAL;

    *out = 0.0;
    RITZ_TRY(ritz_damped_new(&k->small.poles, NULL, NULL, band_hz, &damped));
    for (int64_t j = 0; j < damped.listing.count; j++) {
        double _Complex s = damped.listing.s[j];
        double hertz = cimag(s) / (2.0 * RITZ_PI);
        double zeta = ritz_spectrum_ratio(s);

        if (hertz > band_hz[0] && hertz < band_hz[1] && zeta < least) {
            least = zeta;
            *out = hertz;
        }
    }
    if (least < beside)
        *out *= 1.0 + beside;
done:
    ritz_damped_free(&damped);
    return status;
}

/* Full answers at the worst point, and at the pole that is damped least. */
static ritz_status confirm(ritz_krylov *k, const ritz_response_request *request,
                           bool *held)
{
    double hertz = k->hertz[k->at];
    double was = 0.0;
    int64_t added = 0;

    for (int t = 0; t < 2 && hertz > 0.0; t++) {
        RITZ_CHECK(ritz_krylov_expand(k, hertz, &added, &was));
        *held = was <= 1.0;
        if (!*held)
            break;
        RITZ_CHECK(find_quietest(k, request, &hertz));
    }
    return RITZ_OK;
}

static ritz_status converge(ritz_krylov *k,
                            const ritz_response_request *request)
{
    bool held = false;

    RITZ_CHECK(ritz_krylov_begin(k));
    for (int t = 0; t < MOST_CONFIRMED && !held; t++) {
        RITZ_CHECK(grow(k, &held));
        if (!held)
            break;
        if (ritz_krylov_couples(k))
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
    return modes_beyond * request->to_hz;
}

static ritz_status start(const ritz_response_request *request, ritz_krylov *k)
{
    const ritz_io *io = &request->component->io;
    double highest = highest_of(request);

    RITZ_REFUSE_IF(highest < request->to_hz, RITZ_ERR_ARGUMENT,
                   "modes up to %g Hz cannot give a response up to %g Hz",
                   highest, request->to_hz);
    k->tolerance =
        request->tolerance > 0.0 ? request->tolerance : usual_tolerance;
    k->tolerance = fmax(k->tolerance, least_tolerance);
    k->amplify = 1.0;
    k->lambda_h = ritz_eigen_lambda(highest);
    k->outputs = io->num_outputs;
    k->inputs = io->num_inputs;
    k->values = k->outputs * k->inputs;
    RITZ_CHECK(ritz_direct_new(request->component, request->damping, highest,
                               &k->full));
    RITZ_CHECK(ritz_krylov_space_new(
        &k->full, ritz_eigen_lambda(request->to_hz), &k->space));
    RITZ_CHECK(ritz_krylov_place(k, request->from_hz, request->to_hz));
    return converge(k, request);
}

static ritz_status at(void *state, double hertz, double _Complex *H)
{
    return ritz_poles_add(&((ritz_krylov *)state)->small.poles, hertz, H);
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
    ritz_krylov *k = NULL;

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
    out->state = k;
    k = NULL;
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
