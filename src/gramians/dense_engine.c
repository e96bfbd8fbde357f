/*
 * A component's Gramians by SLICOT, in states z = [S q; q'] of its modes
 * (states.h). Rigid modes that damping does not couple to others stand apart
 * before, whatever else does not decay is told apart by its poles.
 */
#include "gramians/engines.h"
#include "gramians/states.h"

#include <stdio.h>

/* A, B and C of the states as a state space, which takes them. */
static ritz_status space_of(const ritz_io *io, ritz_states *states,
                            ritz_state_space *out)
{
    ritz_status status = RITZ_OK;
    ritz_state_space space = {0};

    RITZ_TRY(ritz_state_space_new(states->count, io, &space));
    ritz_dense_free(&space.A);
    ritz_dense_free(&space.B);
    ritz_dense_free(&space.C);
    space.A = states->A;
    space.B = states->B;
    space.C = states->C;
    states->A = states->B = states->C = (ritz_dense){0};
    *out = space;
    space = (ritz_state_space){0};
done:
    ritz_state_space_free(&space);
    return status;
}

ritz_status ritz_gramians_dense(const ritz_gramians_request *request,
                                ritz_gramians *out)
{
    ritz_status status = RITZ_OK;
    ritz_states states = {0};
    ritz_state_space space = {0};
    ritz_gramians gramians = {0};
    ritz_mode_states layout = {.step = 1};

    RITZ_TRY(
        ritz_states_new(request->component, &request->damping, 0.0, &states));
    RITZ_TRY(space_of(&request->component->io, &states, &space));
    RITZ_TRY(ritz_gramians_of_space(&space, &gramians));
    RITZ_FAIL_IF(gramians.T.ncol == states.count, RITZ_ERR_ARGUMENT,
                 "no motion of the component decays, and none has a Gramian: "
                 "give it damping");
    layout.modes = &states.modes;
    layout.apart = states.num_apart;
    layout.scale = states.scale;
    RITZ_TRY(ritz_gramians_lift(&layout, &gramians));
    snprintf(gramians.damping, sizeof gramians.damping, "%s", states.damping);
    *out = gramians;
    gramians = (ritz_gramians){0};
done:
    ritz_states_free(&states);
    ritz_state_space_free(&space);
    ritz_gramians_free(&gramians);
    return status;
}
