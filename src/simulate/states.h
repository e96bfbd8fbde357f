/* State spaces: by the exponential of A, and by the trapezoidal rule. */
#ifndef RITZ_SIMULATE_STATES_H
#define RITZ_SIMULATE_STATES_H

#include "simulate/motion.h"

ritz_status ritz_states_exact(const ritz_motion *motion, double step,
                              ritz_march *out);

/** @return RITZ_ERR_SINGULAR if 2 / step is an eigenvalue of A */
ritz_status ritz_states_trapezoidal(const ritz_motion *motion, double step,
                                    ritz_march *out);

#endif
