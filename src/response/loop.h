/* Signals of a closed loop as functions of its states. */
#ifndef RITZ_RESPONSE_LOOP_H
#define RITZ_RESPONSE_LOOP_H

#include <ritz/response.h>

/**
 * What the controller measures, as rows over [x; w; r]: states of the plant,
 * states of the controller, and inputs. The feedthroughs of both are
 * eliminated:
 *
 *     e = Q (C_y x + s D_yu C_c w + D_y r),   Q = (I - s D_yu D_c)^-1
 *
 * @param[in] C, D  of the plant, over its states and its inputs
 * @return RITZ_ERR_SINGULAR if Q does not exist
 */
ritz_status ritz_loop_measured(const ritz_dense *C, const ritz_dense *D,
                               const ritz_state_space *controller,
                               const ritz_loop *loop, ritz_dense *e);

/** Outputs of the controller over [x; w; r], v = C_c w + D_c e. */
ritz_status ritz_loop_output(const ritz_dense *C, const ritz_dense *D,
                             const ritz_state_space *controller,
                             const ritz_loop *loop, ritz_dense *v);

#endif
