/*
 * Balanced truncation over a band [GawronskiJuang1990]: Gramians are integrals
 * over frequency, and those over w1 <= |w| <= w2 alone,
 *
 *     W_c = 1/2pi int (i w - A)^-1 B B' (i w - A)^-* dw,
 *
 * show which states matter in the band. They solve Lyapunov equations whose
 * right side is indefinite, so that the reduced model may be unstable, and no
 * sum of the values bounds its error: ritz-reduce checks its stability. In
 * modal coordinates they have closed forms.
 */
#include "base/alloc.h"
#include "bases/balancing.h"

static ritz_status make_balanced_band(const ritz_request *request,
                                      ritz_basis *out)
{
    RITZ_OWN(ritz_gramians) gramians = {0};

    RITZ_REFUSE_IF(
        !(request->choice.given & RITZ_USES_BAND), RITZ_ERR_ARGUMENT,
        "a band is needed, from and to which frequency: band-hz 0,10");
    RITZ_CHECK(ritz_request_gramians(request, &gramians));
    return ritz_balanced_states(request, &gramians, false, out);
}

const ritz_method ritz_method_balanced_band = {
    .name = "balanced-band",
    .summary = "states balanced over a band of frequencies alone",
    .reference = "GawronskiJuang1990",
    .when = "a response over one band, modal damping, in states",
    .cost = "all modes, or those up to a frequency; O(m^3)",
    .holds = "nothing: stability is checked, the error measured",
    .fails = "one reduction in ten is unstable; coupled damping",
    .uses = RITZ_USES_MODES | RITZ_USES_DAMPING | RITZ_USES_ENGINE |
            RITZ_USES_AMONG | RITZ_USES_BAND,
    .only_named = RITZ_NAMED_FOR_COMPONENTS,
    .make = make_balanced_band,
};
