/* A motion, its march and its inputs, on the way through a request. */
#ifndef RITZ_SIMULATE_RUN_H
#define RITZ_SIMULATE_RUN_H

#include "simulate/motion.h"

/** How many steps a request takes. @return RITZ_ERR_ARGUMENT */
ritz_status ritz_request_steps(const ritz_simulation_request *request,
                               int64_t *out);

/** Simulate what has become a motion; names are left to the caller. */
ritz_status ritz_run(const ritz_motion *motion,
                     const ritz_simulation_request *request,
                     ritz_simulation *out);

#endif
