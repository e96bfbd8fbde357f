/* The krylov engine of state spaces. */
#ifndef RITZ_RESPONSE_KRYLOV_STATES_H
#define RITZ_RESPONSE_KRYLOV_STATES_H

#include "response/responder.h"

/** What the krylov engine makes of a state space, dense or sparse. */
ritz_status ritz_krylov_states(const ritz_response_request *request,
                               ritz_responder *out);

#endif
