/* How a model in a basis of states comes about: parts of ritz_reduce_states. */
#ifndef RITZ_MODEL_STATE_REDUCE_H
#define RITZ_MODEL_STATE_REDUCE_H

#include <ritz/model.h>

/**
 * W'E T, W'A T, W'B and the outputs of T, of a component of any size whose M
 * is definite or neither drives nor is driven where it is not:
 *
 *     W'E T = W_q'T_q + W_v'M T_v,   W'A T = W_q'T_v - W_v'(K T_q + D T_v)
 *
 * @param[in,out] out  of as many states as T has columns; A and B are then
 *                     W'A T and W'B
 * @param[out]    E    W'E T
 * @return RITZ_ERR_ARGUMENT if damping needs modes that there are too many of
 */
ritz_status ritz_states_project(const ritz_component *component,
                                const ritz_damping *damping,
                                const ritz_basis *basis, ritz_state_space *out,
                                ritz_dense *E);

/**
 * x := E^-1 x, then columns as the basis names them: those of kind perturbed
 * are eliminated, and the bound that comes with Hankel values is noted.
 *
 * @param[in] E  W'E T
 * @return RITZ_ERR_SINGULAR if E is, or what is to be eliminated has no static
 *         response
 */
ritz_status ritz_states_settle(const ritz_basis *basis, const ritz_dense *E,
                               ritz_state_space *model);

#endif
