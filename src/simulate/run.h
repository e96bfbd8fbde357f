/* A motion, its march and its inputs, on the way through a request. */
#ifndef RITZ_SIMULATE_RUN_H
#define RITZ_SIMULATE_RUN_H

#include "simulate/reach.h"

/** How many steps a request takes. @return RITZ_ERR_ARGUMENT */
ritz_status ritz_request_steps(const ritz_simulation_request *request,
                               int64_t *out);

/**
 * ritz_simulate, with or without energies.
 *
 * @param[out] reach  may be NULL; the caller frees it
 */
ritz_status ritz_simulate_noting(ritz_model subject,
                                 const ritz_simulation_request *request,
                                 bool energies, ritz_reach *reach,
                                 ritz_simulation *out);

#endif
