/*
 * Negative squares: eigenvalues below 0 that forces between bodies of
 * dual-craig-bampton leave in a system, -1/m for each force of mass m. They
 * are of no motion of the bodies.
 */
#ifndef RITZ_MODEL_SQUARES_H
#define RITZ_MODEL_SQUARES_H

#include <ritz/model.h>

/** Name of the measure that such a configuration has: how many there are. */
#define RITZ_NEGATIVE_SQUARES "negative-eigenvalues"

/** Whether mode k of a configuration, from 0, is one. */
bool ritz_configuration_is_square(const ritz_configuration *configuration,
                                  int64_t k);

/**
 * Modes in the order of |lambda|, rigid ones first, as systems with negative
 * squares have them.
 */
ritz_status ritz_pairs_by_size(ritz_pairs *pairs);

#endif
