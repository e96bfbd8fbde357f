/*
 * Balanced truncation: states are made equally controllable and observable, and
 * those with the largest Hankel values are kept. With factors of the Gramians,
 *
 *     Z_o'E Z_c = U S V',   T = Z_c V_1 S_1^-1/2,   W = Z_o U_1 S_1^-1/2,
 *
 * W'E T = I, and of the reduced model W'A T both Gramians are S_1. It is stable
 * and its error is at most twice the sum of the values in S_2 [Moore1981]. The
 * states of S_2 can be kept as columns that respond statically: then the
 * response at 0 Hz is exact, and the bound is the same [LiuAnderson1989].
 *
 * Rigid modes, and unstable poles of a state space, have no Gramian: they are
 * decoupled and always kept.
 */
#include "bases/balancing.h"

static ritz_status make_balanced(const ritz_request *request, ritz_basis *out)
{
    RITZ_OWN(ritz_gramians) gramians = {0};

    RITZ_CHECK(ritz_request_gramians(request, &gramians));
    return ritz_balanced_states(request, &gramians, true, out);
}

const ritz_method ritz_method_balanced = {
    .name = "balanced",
    .summary = "balanced states, with a bound of the error before it is made",
    .reference = "Moore1981",
    .when = "damped models for control, few inputs and outputs; state spaces",
    .cost = "modal O(m^2 r), dense O(n^3); low rank: some solves a state",
    .holds = "stability; error at most twice the values left out",
    .fails = "light damping: no value is small; interfaces of other bodies",
    .uses = RITZ_USES_MODES | RITZ_USES_DAMPING | RITZ_USES_ENGINE |
            RITZ_USES_AMONG | RITZ_USES_REMAINDER | RITZ_USES_SPACE,
    .make = make_balanced,
};
