/* Steps that methods of balanced and other states share. */
#ifndef RITZ_BASES_BALANCING_H
#define RITZ_BASES_BALANCING_H

#include "gramians/modes.h"

#include <ritz/basis.h>

/**
 * Gramians of the component or state space of a request, by its engine. With
 * among_hz given, or a band, the engine is the modal one.
 *
 * @return RITZ_ERR_ARGUMENT if the request is not for a number of vectors, or
 *         has an option of components for a state space
 */
ritz_status ritz_request_gramians(const ritz_request *request,
                                  ritz_gramians *out);

/**
 * Truncate the balanced states as requested.
 *
 * @return RITZ_ERR_ARGUMENT if nothing is left
 */
ritz_status ritz_request_balance(const ritz_request *request,
                                 const ritz_gramians *gramians,
                                 ritz_balanced *out);

/** Add the values, and a remark on their reliability; @p what: "states". */
ritz_status ritz_balanced_note(const ritz_request *request,
                               const ritz_gramians *gramians,
                               const ritz_balanced *balanced, bool bounded,
                               const char *what, ritz_basis *basis);

/** The requested damping, or else the component's own. */
ritz_status ritz_request_damping(const ritz_request *request,
                                 ritz_damping *out);

#endif
