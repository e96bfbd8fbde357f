/* Damping ratios of damped eigenpairs (s^2 M + s D + K) x = 0. */
#ifndef RITZ_VERIFY_DAMPED_H
#define RITZ_VERIFY_DAMPED_H

#include "verify/poles.h"

/**
 * zeta = -Re s / |s| of the damped mode nearest to each undamped one; NaN where
 * a mode does not oscillate any more, 0 where rigid.
 *
 * @param[in] component  may be NULL; else modes in `band_hz` are made exact by
 *                       inverse iteration on its matrices
 * @param[in] pairs      of the component; NULL with it
 */
ritz_status ritz_damped_ratios(const ritz_poles *poles,
                               const ritz_component *component,
                               const ritz_pairs *pairs, const double band_hz[2],
                               double **out);

#endif
