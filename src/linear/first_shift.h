/* A shift below all eigenvalues of a pencil, guessed before any is known. */
#ifndef RITZ_LINEAR_FIRST_SHIFT_H
#define RITZ_LINEAR_FIRST_SHIFT_H

#include "linear/general.h"

/**
 * s > 0 for the first factor of K + s M, of a body that may be free.
 *
 * It should be small relative to the eigenvalues that are requested, so that
 * modes are told apart and residual modes converge in few solves, and large
 * relative to rounding: Lanczos vectors lose as many digits as the last
 * requested eigenvalue has more than s. See the source for how it is guessed.
 *
 * @param[in]  K        symmetric, both triangles stored
 * @param[in]  typical  median of K_jj / M_jj  [rad^2/s^2]
 * @param[in]  modes    number of requested modes
 * @param[out] out      [rad^2/s^2]
 * @return RITZ_ERR_MEMORY
 * @cost   K is read twice
 */
ritz_status ritz_first_shift(const ritz_sparse *K, double typical,
                             int64_t modes, double *out);

/**
 * Call @p factor for K - sigma M, with shifts further and further away from 0
 * while it breaks down.
 *
 * @param[in] typical  as above
 * @param[in] sigma    < 0, the first shift
 * @param[in] factor   returns RITZ_ERR_SINGULAR if K - sigma M is not positive
 *                     definite
 * @return RITZ_ERR_SINGULAR if it is not at any shift up to 1e3 @p typical
 */
ritz_status ritz_first_factor(double typical, double sigma,
                              ritz_status (*factor)(void *of, double sigma),
                              void *of);

#endif
