/* Every mode of a dense model, as ritz_response_dense uses them. */
#ifndef RITZ_POLES_DENSE_POLES_H
#define RITZ_POLES_DENSE_POLES_H

#include "poles/poles.h"

/**
 * Poles of all modes.
 *
 * @param[in] to_hz  where responses end that are of interest; 0: not known
 * @return RITZ_ERR_ARGUMENT if an eigenvalue is negative beyond rounding, of
 *         the largest eigenvalue or of (2 pi to_hz)^2
 */
ritz_status ritz_poles_of_dense(const ritz_second_order *model,
                                const ritz_damping *damping, double to_hz,
                                ritz_poles *out);

/**
 * Poles of pairs that are known: all modes of finite frequency, `lambda` with
 * room for as many as there are coordinates.
 *
 * @param[in]     beside  whether motions without mass become coordinates even
 *                        where no damping acts on them
 * @param[in,out] pairs   gets their shapes behind those of its modes
 */
ritz_status ritz_poles_of_pairs(const ritz_second_order *model,
                                const ritz_damping *damping, bool beside,
                                ritz_pairs *pairs, ritz_poles *out);

#endif
