/*
 * A measured response as a responder. Between its points it is interpolated
 * like any response (ritz_response_at); outside their range it is not known. It
 * has no states and no poles.
 */
#include "base/alloc.h"
#include "response/responder.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

typedef struct measured {
    const ritz_response *response; /* borrowed */
    ritz_poles poles; /* no poles, but names of inputs and outputs */
} measured;

static ritz_status measured_at(void *state, double hertz, double _Complex *H)
{
    const measured *s = state;
    const ritz_response *r = s->response;

    RITZ_REFUSE_IF(hertz < r->hertz[0] || hertz > r->hertz[r->count - 1],
                   RITZ_ERR_ARGUMENT,
                   "%g Hz is outside what was measured, %g to %g Hz", hertz,
                   r->hertz[0], r->hertz[r->count - 1]);
    return ritz_response_at(r, hertz, H);
}

static void free_measured(void *state)
{
    measured *s = state;

    ritz_poles_free(&s->poles);
}

static const ritz_response_engine measured_engine = {
    .name = "measured",
    .summary = "a table of a response, interpolated between its points",
    .reference = "Sirlin1992",
};

ritz_io ritz_response_io(const ritz_response *response)
{
    return (ritz_io){.num_inputs = response->num_inputs,
                     .num_outputs = response->num_outputs,
                     .input = response->input,
                     .output = response->output};
}

ritz_status ritz_measured_responder(const ritz_response *response,
                                    ritz_responder **out)
{
    const ritz_io io = ritz_response_io(response);
    RITZ_OWN(ritz_responder) *r = NULL;
    measured *s = NULL;

    RITZ_REFUSE_IF(response->count < 2, RITZ_ERR_ARGUMENT,
                   "a response of %" PRId64 " frequencies is none",
                   response->count);
    RITZ_CHECK_NEW(r, 1);
    RITZ_CHECK_NEW(s, 1);
    r->state = s;
    r->free = free_measured;
    s->response = response;
    RITZ_CHECK(ritz_poles_name(&io, &s->poles));
    r->engine = &measured_engine;
    r->poles = &s->poles;
    r->from_hz = response->hertz[0];
    r->to_hz = response->hertz[response->count - 1];
    memcpy(r->damping, response->damping, sizeof r->damping);
    r->at = measured_at;
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}
