/* The krylov engine for state spaces. */
#ifndef RITZ_RESPONSE_KRYLOV_STATES_H
#define RITZ_RESPONSE_KRYLOV_STATES_H

#include "response/responder.h"

/** Prepare the krylov engine for a dense or sparse state space. */
ritz_status ritz_krylov_states(const ritz_response_request *request,
                               ritz_responder *out);

#endif
