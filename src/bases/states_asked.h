/* States as a request asks for them. */
#ifndef RITZ_BASES_STATES_ASKED_H
#define RITZ_BASES_STATES_ASKED_H

#include "gramians/states.h"

#include <ritz/method.h>

/** The damping that was asked for, or else the component's own. */
ritz_status ritz_request_damping(const ritz_request *request,
                                 ritz_damping *out);

/**
 * Its component in states, less the shift.
 *
 * @return RITZ_ERR_ARGUMENT if the request is not for a number of states with
 *         at most one shift, or as ritz_states_new
 */
ritz_status ritz_states_asked(const ritz_request *request, ritz_states *out);

#endif
