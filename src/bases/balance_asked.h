/* Steps that the balancing methods share. */
#ifndef RITZ_BASES_BALANCE_ASKED_H
#define RITZ_BASES_BALANCE_ASKED_H

#include "gramians/states.h"
#include <ritz/basis.h>

/**
 * Gramians of the component or state space of a request, by its engine. With
 * among_hz given, or a band, the engine is the modal one.
 *
 * @return RITZ_ERR_ARGUMENT if the request is not for a number of vectors, or
 *         has an option of components for a state space
 */
ritz_status ritz_gramians_asked(const ritz_request *request,
                                ritz_gramians *out);

/**
 * Truncate the balanced states as requested.
 *
 * @return RITZ_ERR_ARGUMENT if nothing is left
 */
ritz_status ritz_balance_asked(const ritz_request *request,
                               const ritz_gramians *gramians,
                               ritz_balanced *out);

/**
 * T = [T_apart, T_kept, T_rest] of states, and W likewise: states without
 * Gramian, balanced states that are kept and, if requested, those that respond
 * statically.
 *
 * @param[in] bounded  whether the rest of the values bounds the error
 */
ritz_status ritz_balanced_states(const ritz_request *request,
                                 const ritz_gramians *gramians, bool bounded,
                                 ritz_basis *out);

/** Append a text to a remark, as far as there is room. */
void ritz_remark_append(ritz_basis *basis, const char *text);

/** Add the values, and a remark on their reliability; @p what: "states". */
ritz_status ritz_balanced_note(const ritz_request *request,
                               const ritz_gramians *gramians,
                               const ritz_balanced *balanced, bool bounded,
                               const char *what, ritz_basis *basis);

/** The requested damping, or else the component's own. */
ritz_status ritz_request_damping(const ritz_request *request,
                                 ritz_damping *out);

/**
 * The component of the request in states, less the shift.
 *
 * @return RITZ_ERR_ARGUMENT if the request is not for a number of states with
 *         at most one shift, or as ritz_states_new
 */
ritz_status ritz_states_asked(const ritz_request *request, ritz_states *out);

#endif
