/* The signals of a loop in states, for the rooms above. */
#ifndef RITZ_RESPONSE_LOOP_H
#define RITZ_RESPONSE_LOOP_H

#include <ritz/response.h>

/**
 * What the controller measures, as rows over [x; w; r], its feedthrough and the
 * plant's solved for:
 *
 *     e = Q (C_y x + s D_yu C_c w + D_y r),   Q = (I - s D_yu D_c)^-1
 *
 * @param[in] C, D  of the plant, over its states and its inputs
 * @return RITZ_ERR_SINGULAR if Q does not exist
 */
ritz_status ritz_loop_measured(const ritz_dense *C, const ritz_dense *D,
                               const ritz_state_space *controller,
                               const ritz_loop *loop, ritz_dense *e);

/** What it puts out over the same, v = C_c w + D_c e. */
ritz_status ritz_loop_output(const ritz_dense *C, const ritz_dense *D,
                             const ritz_state_space *controller,
                             const ritz_loop *loop, ritz_dense *v);

#endif
