/*
 * Negative squares of frequencies: in a system of dual-craig-bampton, the
 * forces between bodies leave eigenvalues below 0, -1/m for each force of mass
 * m. The bodies have no such motion.
 */
#ifndef RITZ_MODEL_SQUARES_H
#define RITZ_MODEL_SQUARES_H

#include <ritz/model.h>

/** Measure of a configuration with negative squares: their number. */
#define RITZ_NEGATIVE_SQUARES "negative-eigenvalues"

/** Whether mode k = 0, 1, ... of a configuration is a negative square. */
bool ritz_configuration_is_square(const ritz_configuration *configuration,
                                  int64_t k);

/**
 * Order modes by |lambda|, so that rigid modes come before negative squares.
 */
ritz_status ritz_pairs_by_size(ritz_pairs *pairs);

#endif
