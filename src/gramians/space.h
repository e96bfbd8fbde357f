/* Gramians of state spaces: the low-rank engine and that of a band. */
#ifndef RITZ_GRAMIANS_SPACE_H
#define RITZ_GRAMIANS_SPACE_H

#include "model/space.h"

#include <ritz/basis.h>

/**
 * Factors of both Gramians by low-rank ADI with sparse factors of A - s E.
 * Poles at 0 are decoupled; their vectors are T and W of the result.
 *
 * @param[in] tolerance  of both residuals, |R| / |B B'| and |R| / |C'C|; 0:
 *                       default
 * @return RITZ_ERR_CONVERGENCE if the Gramians have no low rank, or another
 *         pole is not left of the axis
 * @cost   a complex factorisation for each of some 20 to 300 shifts
 */
ritz_status ritz_gramians_space_low_rank(const ritz_state_space *model,
                                         double tolerance, ritz_gramians *out);

/**
 * The same by Galerkin's condition in the rational Krylov space that the columns
 * of ADI span. Both residuals are computed from the equations, in the 2-norm.
 *
 * @return as ritz_gramians_space_low_rank(); RITZ_ERR_ARGUMENT if E or
 *         -(A + A') is not definite
 * @cost   about the factorisations of ADI, most often fewer, and O(n k^2 + k^3)
 *         each time that k columns are projected on
 * @see    [DruskinSimoncini2011]
 */
ritz_status ritz_gramians_space_projection(const ritz_state_space *model,
                                           double tolerance,
                                           ritz_gramians *out);

/**
 * H2 norm of the response C x of a sparse model without its poles at 0, by both
 * factors: with what ADI leaves in its equations, W_c W_c',
 *
 *     |G|_2^2 = |C Z_c|^2 + |Z_o'W_c|^2
 *
 * up to the product of both residuals.
 *
 * @param[in]  last  number of states at the end that are decoupled from all
 *                   others
 * @param[out] part  the norm of the response of these states alone
 * @return as ritz_gramians_space_low_rank
 */
ritz_status ritz_space_norm_two(const ritz_state_space *model, int64_t last,
                                double *whole, double *part);

/**
 * Factors of both Gramians over a band, 0 <= w1 < w2, w2 finite,
 *
 *     W_c = 1/pi Re int_{w1}^{w2} (i w E - A)^-1 B B' (i w E - A)^-* dw,
 *
 * and W_o likewise, by adaptive Gauss-Kronrod quadrature. Poles at 0 are
 * decoupled; their vectors are T and W of the result.
 *
 * @return RITZ_ERR_CONVERGENCE if another pole on the axis lies in the band
 * @cost   a complex factorisation for each point, fifteen points a panel
 */
ritz_status ritz_gramians_space_band(const ritz_state_space *model,
                                     const double band_hz[2],
                                     ritz_gramians *out);

/** Replace A by a factor of A A' with fewer columns: the singular vectors of A,
 * scaled, without those shorter than rounding. They are orthogonal, longest
 * first. */
ritz_status ritz_factor_compress(ritz_dense *A);

#endif
