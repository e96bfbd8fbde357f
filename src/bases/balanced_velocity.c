/*
 * Balancing of velocities, the half of the states in which a mode's values are
 * nearly its Hankel values. See balanced_second.c for the equations.
 */
#include "bases/balanced_second.h"

static ritz_status make(const ritz_request *request, ritz_basis *out)
{
    return ritz_balanced_second(request, RITZ_HALF_VELOCITY, out);
}

const ritz_method ritz_method_balanced_velocity = {
    .name = "balanced-velocity",
    .summary = "vectors balanced by velocities, second order stays so",
    .reference = "ReisStykel2008",
    .when = "few inputs, velocities as outputs, a second-order result",
    .cost = "as balanced: modal O(m^2 r), dense O(n^3), low rank",
    .holds = "symmetry and stability if velocities lie at inputs, or one side",
    .fails = "inputs and outputs apart: stability is probed, error measured",
    .uses = RITZ_USES_MODES | RITZ_USES_DAMPING | RITZ_USES_ENGINE |
            RITZ_USES_AMONG | RITZ_USES_SIDES,
    .make = make,
};
