/*
 * Response of a state space with sparse A and E,
 *
 *     H = C (i w E - A)^-1 B + D,
 *
 * by a sparse complex factorisation of A - i w E at each point; the pattern is
 * analysed once. If there are more inputs than outputs, the transposed system
 * is solved for the rows of C.
 *
 * A grid is refined around the poles nearest to some frequencies of the range.
 * If A and E are symmetric and E is definite, all poles are real and no points
 * are added.
 */
#include "base/alloc.h"
#include "base/complex.h"
#include "base/tolerances.h"
#include "model/space.h"
#include "response/responder.h"
#include "response/state_poles.h"

#include <complex.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct sparse_responder {
    ritz_poles poles;
    const ritz_state_space *model; /* borrowed */
    ritz_pencil pencil;
} sparse_responder;

static void free_sparse(void *state)
{
    sparse_responder *h = state;

    ritz_poles_free(&h->poles);
    ritz_pencil_free(&h->pencil);
}

/* Whether all poles are known to be real: A = A', E = E', and E definite. */
static ritz_status is_overdamped(const ritz_pencil *pencil, bool *out)
{
    RITZ_OWN(ritz_factor) *L = NULL;
    ritz_status status = RITZ_OK;

    *out = false;
    if (!ritz_pencil_is_symmetric(pencil))
        return RITZ_OK;
    status = ritz_factor_spd(&pencil->E, &L);
    *out = status == RITZ_OK;
    return status == RITZ_ERR_SINGULAR ? RITZ_OK : status;
}

static ritz_status find_poles(sparse_responder *h,
                              const ritz_response_request *request)
{
    RITZ_OWN(ritz_near_poles) near = {0};
    bool overdamped = false;

    RITZ_CHECK(is_overdamped(&h->pencil, &overdamped));
    if (!overdamped)
        RITZ_CHECK(ritz_poles_near(&h->pencil, request, &near));
    return ritz_near_poles_list(&near, request, &h->poles);
}

static ritz_status sparse_at(void *state, double hertz, double _Complex *H)
{
    sparse_responder *h = state;
    ritz_status status = ritz_space_transfer(
        h->model, &h->pencil, ritz_complex(0.0, 2.0 * RITZ_PI * hertz), H);

    RITZ_REFUSE_IF(
        status == RITZ_ERR_SINGULAR, status,
        "%.9g Hz is the frequency of a pole: an undamped mode, or at "
        "0 Hz a rigid-body motion",
        hertz);
    return status;
}

static ritz_status make_sparse(const ritz_response_request *request,
                               ritz_responder *out)
{
    sparse_responder *s = NULL;

    RITZ_CHECK_NEW(s, 1);
    out->state = s;
    out->free = free_sparse;
    out->poles = &s->poles;
    out->at = sparse_at;
    s->model = request->model.states;
    memcpy(out->damping, s->model->damping, sizeof out->damping);
    RITZ_CHECK(ritz_pencil_of_space(s->model, &s->pencil));
    RITZ_CHECK(find_poles(s, request));
    if (s->poles.count > 0)
        (void)snprintf(out->remark, sizeof out->remark,
                       "points are added around %" PRId64
                       " poles, the nearest to %d frequencies of the range",
                       s->poles.count, (int)RITZ_POLE_PLACES);
    return RITZ_OK;
}

const ritz_response_engine ritz_response_engine_sparse = {
    .name = "sparse",
    .summary = "of a state space, by a sparse factor at each point",
    .reference = "AmestoyDuffLExcellentKoster2001",
    .when = "state spaces whose A and E are large and sparse",
    .cost = "a complex sparse factor a point, a solve an input or output",
    .holds = "exact to rounding",
    .fails = "a point on a pole is refused; narrow peaks between its points",
    .takes = RITZ_MODEL_STATES,
    .make = make_sparse,
};
