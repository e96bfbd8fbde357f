/* Points and directions from the poles of a projected component. */
#ifndef RITZ_BASES_DOMINANT_H
#define RITZ_BASES_DOMINANT_H

#include "bases/rational.h"

/**
 * Of (T'MT, T'DT, T'KT + i T'K4T) and damping beside it, each pole p with Im p
 * >= 0 and its vector x, x'(2 p M + D) x = 1, is a term of the response,
 *
 *     (C x) (x'B) / (s - p),     of H2 norm |C x| |x'B| / sqrt(2 |Re p|),
 *
 * by which poles are ordered, the largest first; uncontrollable and
 * unobservable ones are left out. B are all loads but outputs; if there are
 * only outputs, or none, B = C' or C = B'. Each pole gives a probe for each
 * group to be interpolated, in direction conj(F(-conj(s))'x).
 *
 * If the component has D or K4, the point of a pole is s = -conj(p), at least
 * 1e-4 |p| off the axis. If not, s^2 = -w^2 (1 - zeta), w^2 an eigenvalue and
 * zeta its ratio: half of the half-power distance below the resonance of a
 * component without damping, whose response there is real.
 *
 * @param[in] T  n x r, independent columns without rigid motion
 * @return RITZ_ERR_CONVERGENCE
 * @cost   O(r nnz + n r^2 + r^3)
 */
ritz_status ritz_dominant_probes(const ritz_rational *R,
                                 const ritz_damping *damping,
                                 const ritz_dense *T, ritz_probes *out);

#endif
