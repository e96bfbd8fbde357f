/* K and M as attached dofs see them. */
#ifndef RITZ_BASES_CONDENSE_H
#define RITZ_BASES_CONDENSE_H

#include <ritz/component.h>

/**
 * T_b'KT_b and T_b'MT_b. What the first shows of motions that cost no energy is
 * rounding of |T_b|'|K||T_b|, and is taken for the zero that it stands for.
 *
 * @param[in]  T_b  n x b, [I; Psi]: constraint modes
 * @param[out] K,M  b x b, exactly symmetric
 * @cost   O(b nnz + n b^2)
 */
ritz_status ritz_condense(const ritz_component *component,
                          const ritz_dense *T_b, ritz_dense *K, ritz_dense *M);

#endif
