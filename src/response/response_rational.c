/*
 * Response by rational interpolation [KenneyStubberudLaub1992]: a factor of the
 * full matrices at a few nodes, and between them a polynomial for what is left
 * of H once the poles that the eigensolver found, in the range and half as far
 * again, are cancelled; of small components the zeros too, in those channels
 * that they help. As H(-i w) is the conjugate of H(i w), unless there is K4,
 * each node counts twice.
 *
 * The next node is where prod |s - s_m| / prod |s - pole| is largest: near
 * resonances, but never on a pole or zero, beside which candidates begin at a
 * half-power width. What the interpolant errs there is known before it is
 * added; three nodes in a row within the tolerance are the end.
 */
#include "response/rational.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static const double usual_tolerance = 1e-9;
/* Of the end: a free body has its first node so far above 0 Hz. */
static const double above_rest = 1e-4;
/* Of w^2: nearer to an undamped pole than this there is no answer. */
static const double pole_within = 1e-12;
/* Of channels: of more, zeros take longer than nodes. */
static const int64_t most_channels = 9;

static void rational_free(ritz_nodes *s)
{
    ritz_direct_free(&s->full);
    ritz_whole_free(&s->whole);
    ritz_interpolant_free(&s->poles);
    ritz_interpolant_free(&s->both);
    free(s->pole);
    free(s->hertz);
    free(s->used);
    free(s->with_zeros);
    free(s->missed);
    free(s->miss);
    free(s->peak);
    free(s->level);
    free(s->scale);
    free(s->H);
    free(s->guess);
    free(s->other);
}

static ritz_status start(const ritz_response_request *request,
                         const ritz_responder *out, ritz_nodes *s)
{
    const ritz_io *io = &request->component->io;
    double unit = 2.0 * RITZ_PI * request->to_hz;
    double low = request->from_hz;

    s->values = io->num_outputs * io->num_inputs;
    s->noise = &out->noise;
    s->mirror = !request->component->K4.colptr;
    if (s->full.poles.num_rigid > 0 && low == 0.0)
        low = above_rest * request->to_hz;
    RITZ_CHECK(ritz_nodes_find_poles(s, out));
    RITZ_CHECK(ritz_interpolant_new(s->values, unit, s->num_poles, s->pole,
                                    &s->poles));
    RITZ_CHECK(
        ritz_interpolant_new(s->values, unit, s->num_poles, s->pole, &s->both));
    RITZ_CHECK_NEW(s->with_zeros, s->values);
    RITZ_CHECK_NEW(s->missed, 2 * s->values);
    RITZ_CHECK_NEW(s->miss, 2 * s->values * RITZ_RATIONAL_ENOUGH);
    RITZ_CHECK_NEW(s->peak, s->values);
    RITZ_CHECK_NEW(s->level, s->values);
    RITZ_CHECK_NEW(s->scale, s->values);
    RITZ_CHECK_NEW(s->H, s->values);
    RITZ_CHECK_NEW(s->guess, s->values);
    RITZ_CHECK_NEW(s->other, s->values);
    if (s->mirror && s->small && s->values <= most_channels)
        RITZ_CHECK(ritz_nodes_find_zeros(s));
    RITZ_CHECK(ritz_nodes_place(s, low, request->to_hz));
    return ritz_nodes_converge(s, request->tolerance > 0.0 ? request->tolerance
                                                           : usual_tolerance);
}

/* An undamped pole that was cancelled has no response. */
static ritz_status refuse_pole(const ritz_nodes *s, double hertz)
{
    double w = 2.0 * RITZ_PI * hertz;

    for (int64_t k = 0; k < s->num_poles; k++) {
        bool on = cabs(ritz_complex(0.0, w) - s->pole[k]) <=
                  pole_within * (w + cabs(s->pole[k]));

        RITZ_REFUSE_IF(
            on && s->pole[k] == 0.0, RITZ_ERR_SINGULAR,
            "at 0 Hz the response is infinite: a rigid-body motion is "
            "driven and seen, begin above 0 Hz");
        RITZ_REFUSE_IF(on, RITZ_ERR_SINGULAR,
                       "%.9g Hz is the frequency of an undamped mode: give it "
                       "damping or leave the point out",
                       hertz);
    }
    return RITZ_OK;
}

static ritz_status at(void *state, double hertz, double _Complex *H)
{
    ritz_nodes *s = state;
    const double _Complex at = ritz_complex(0.0, 2.0 * RITZ_PI * hertz);

    RITZ_CHECK(refuse_pole(s, hertz));
    ritz_interpolant_at(&s->poles, at, s->guess);
    ritz_interpolant_at(&s->both, at, s->other);
    for (int64_t v = 0; v < s->values; v++)
        H[v] = s->with_zeros[v] ? s->other[v] : s->guess[v];
    return RITZ_OK;
}

static void finish(void *state)
{
    rational_free(state);
    free(state);
}

static ritz_status make(const ritz_response_request *request,
                        ritz_responder *out)
{
    ritz_status status = RITZ_OK;
    ritz_nodes *s = NULL;

    RITZ_NEW(s, 1);
    RITZ_TRY(ritz_direct_new(request->component, request->damping,
                             ritz_response_highest(request), &s->full));
    out->poles = &s->full.poles;
    out->pairs = &s->full.pairs;
    RITZ_TRY(start(request, out, s));
    (void)snprintf(out->remark, sizeof out->remark,
                   "%" PRId64 " factors at nodes, %" PRId64 " poles cancelled",
                   s->nodes, s->num_poles);
    out->at = at;
    out->free = finish;
    out->state = s;
    s = NULL;
done:
    if (s)
        finish(s);
    return status;
}

const ritz_response_engine ritz_response_engine_rational = {
    .name = "rational",
    .summary = "interpolation between factored nodes, poles cancelled",
    .reference = "KenneyStubberudLaub1992",
    .when = "a range with few modes, few inputs and outputs; no space is kept",
    .cost = "about a factor for each mode that shows and ten more, then "
            "O(nodes) a point and channel",
    .holds = "what the nodes that came last showed, three in a row",
    .fails = "many modes: krylov needs fewer factors; D or K4 of a large "
             "component, whose poles take factors too",
    .takes = RITZ_RESPONDS_COMPONENT,
    .make = make,
};
