/* The direct engine: a factor of the full matrices at each point. */
#include "base/alloc.h"
#include "response/direct.h"
#include "response/responder.h"

#include <stdlib.h>

static ritz_status at(void *state, double hertz, double _Complex *H)
{
    return ritz_direct_at(state, hertz, H);
}

static void finish(void *state)
{
    ritz_direct_free(state);
    free(state);
}

static ritz_status make(const ritz_response_request *request,
                        ritz_responder *out)
{
    ritz_status status = RITZ_OK;
    ritz_direct *s = NULL;

    RITZ_NEW(s, 1);
    RITZ_TRY(ritz_direct_new(request->component, request->damping,
                             ritz_response_highest(request), s));
    out->poles = &s->poles;
    out->pairs = &s->pairs;
    out->at = at;
    out->free = finish;
    out->state = s;
    s = NULL;
done:
    free(s);
    return status;
}

const ritz_response_engine ritz_response_engine_direct = {
    .name = "direct",
    .summary = "a sparse complex factor at each frequency",
    .when = "the reference; a handful of frequencies; anything that damps",
    .cost = "a factor for each point, and modes where ratios act on them",
    .holds = "D, K4 and Rayleigh damping exactly, ratios on the modes up to "
             "--up-to-hz",
    .fails = "many points of a large model take hours",
    .takes = RITZ_RESPONDS_COMPONENT,
    .make = make,
};

ritz_status ritz_response_direct(const ritz_component *component,
                                 const ritz_damping *damping, double up_to_hz,
                                 const ritz_grid *grid, ritz_response *out)
{
    ritz_response_request request = {
        .component = component, .damping = damping, .up_to_hz = up_to_hz};

    return ritz_response_once(&ritz_response_engine_direct, &request, grid,
                              out);
}
