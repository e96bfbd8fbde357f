/*
 * Balancing of positions: displacements that inputs reach, against those that
 * outputs see in the dual model. See balanced_second.c for the equations.
 */
#include "bases/balanced_second.h"

static ritz_status make(const ritz_request *request, ritz_basis *out)
{
    return ritz_balanced_second(request, RITZ_HALF_POSITION, out);
}

const ritz_method ritz_method_balanced_position = {
    .name = "balanced-position",
    .summary = "vectors balanced by positions, second order stays second order",
    .reference = "ReisStykel2008",
    .when = "few inputs, displacements as outputs, a second-order result",
    .cost = "as balanced: modal O(m^2 r), dense O(n^3), low rank",
    .holds = "symmetry and stability if outputs lie at inputs, or on one side",
    .fails = "inputs and outputs apart: stability is probed, error measured",
    .uses = RITZ_USES_MODES | RITZ_USES_DAMPING | RITZ_USES_ENGINE |
            RITZ_USES_AMONG | RITZ_USES_SIDES,
    .make = make,
};
