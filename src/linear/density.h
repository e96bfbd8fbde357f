/* How many eigenvalues a pencil has below a value, estimated without finding
 * any of them. */
#ifndef RITZ_LINEAR_DENSITY_H
#define RITZ_LINEAR_DENSITY_H

#include "linear/general.h"

/**
 * Estimate the k-th lowest eigenvalue of K x = lambda M x, within a third as a
 * rule: of a hundred eigenvalues or more, and for M that is nearly diagonal.
 *
 * @param[in]  S    K, M, sigma below all eigenvalues, factor of K - sigma M
 * @param[out] out  HUGE_VAL if there seem to be fewer than k  [rad^2/s^2]
 * @return RITZ_ERR_MEMORY; RITZ_ERR_CONVERGENCE
 * @cost   14 solves of eight right-hand sides
 * @see    [LinSaadYang2016]
 */
ritz_status ritz_density_reach(const ritz_shifted *S, int64_t k, double *out);

#endif
