/* Motions without mass, which no mode of a dense model shows. */
#ifndef RITZ_POLES_MASSLESS_H
#define RITZ_POLES_MASSLESS_H

#include "poles/poles.h"

/**
 * The part of a dense model's response that its modes do not have, the same at
 * all frequencies: with N of ritz_massless, C N N' B. No term where every
 * motion has mass; damping of such motions is left out.
 *
 * @param[in] pairs  of ritz_eigen_dense: all modes of finite frequency
 */
ritz_status ritz_static_rest(const ritz_second_order *model,
                             const ritz_pairs *pairs, ritz_residual *out);

/**
 * N, n x (n - m), given the m finite pairs of the model.
 *
 * @return RITZ_ERR_SINGULAR if K does not hold the motions without mass
 */
ritz_status ritz_massless(const ritz_second_order *model, const ritz_dense *Phi,
                          const double *lambda, ritz_dense *out);

#endif
