#include "bases/states_asked.h"

#include "base/tolerances.h"

static ritz_status check(const ritz_request *request)
{
    RITZ_REFUSE_IF(request->up_to_hz > 0.0, RITZ_ERR_ARGUMENT,
                   "states are asked for by their number, not by a frequency");
    RITZ_REFUSE_IF(request->modes < 1, RITZ_ERR_ARGUMENT,
                   "no states are asked for, one at least is needed");
    RITZ_REFUSE_IF(request->choice.num_shifts > 1, RITZ_ERR_ARGUMENT,
                   "the states are shifted by one frequency, not by several");
    return RITZ_OK;
}

ritz_status ritz_request_damping(const ritz_request *request, ritz_damping *out)
{
    if (request->choice.given & RITZ_USES_DAMPING) {
        *out = request->choice.damping;
        return RITZ_OK;
    }
    return ritz_context(ritz_damping_parse(request->component->damping, out),
                        "damping of the component");
}

ritz_status ritz_states_asked(const ritz_request *request, ritz_states *out)
{
    ritz_damping damping = {0};
    double alpha = 0.0;

    RITZ_CHECK(check(request));
    RITZ_CHECK(ritz_request_damping(request, &damping));
    if (request->choice.num_shifts > 0)
        alpha = 2.0 * RITZ_PI * request->choice.shift_hz[0];
    return ritz_states_new(request->component, &damping, alpha, out);
}
