/* Characteristic constraint modes: an interface moves in a few shapes only. */
#ifndef RITZ_BASES_INTERFACE_H
#define RITZ_BASES_INTERFACE_H

#include <ritz/eigen.h>
#include <ritz/method.h>

/**
 * Modes of the component condensed to its attached dofs,
 *
 *     (T_b'KT_b) Phi = (T_b'MT_b) Phi Lambda,
 *
 * all rigid ones and the lowest request->choice.interface_modes others; a
 * cluster (relative gap below 1e-6) at the end is kept whole.
 *
 * @param[in]  T_b  n x b, [I; Psi]: constraint modes
 * @param[out] out  Phi is b x k
 * @return RITZ_ERR_SINGULAR
 * @cost   O(b^3) beside the condensation
 * @see    [CastanierTanPierre2001]
 */
ritz_status ritz_interface_modes(const ritz_request *request,
                                 const ritz_dense *T_b, ritz_pairs *out);

#endif
