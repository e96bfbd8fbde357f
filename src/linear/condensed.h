/* All modes of a pencil with few masses. */
#ifndef RITZ_LINEAR_CONDENSED_H
#define RITZ_LINEAR_CONDENSED_H

#include "linear/general.h"

/**
 * Vectors of all finite modes, by the dense pencil that is left when A = K -
 * sigma M is condensed to the dofs with mass.
 *
 * @param[in]  S      K, M, sigma below all eigenvalues, factor of A
 * @param[in]  heavy  the @p count columns of M that are not zero
 * @param[out] X      n x at most count
 * @return RITZ_ERR_SINGULAR if what is condensed is not positive definite;
 *         RITZ_ERR_CONVERGENCE; RITZ_ERR_MEMORY
 * @cost   count solves, O(count^3)
 */
ritz_status ritz_modes_condensed(const ritz_shifted *S, int64_t count,
                                 const int64_t *heavy, ritz_dense *X);

#endif
