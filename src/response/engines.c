/* The table of engines: a new one is a file with a descriptor, and a row. */
#include "response/responder.h"

const ritz_response_engine *const ritz_response_engines[] = {
    &ritz_response_engine_direct,
    &ritz_response_engine_krylov,
    &ritz_response_engine_modal,
    &ritz_response_engine_rational,
    &ritz_response_engine_sparse,
    &ritz_response_engine_states,
    NULL,
};
