/* Spin terms of a body, from its inertia invariants: see ritz/spin.h. */
#ifndef RITZ_MODEL_SPIN_H
#define RITZ_MODEL_SPIN_H

#include <ritz/reduced.h>
#include <ritz/spin.h>

/**
 * Spin terms of the columns of a reduced component; KG stays {0}.
 *
 * @param[in] axis     n, unit, along basic axes
 * @param[in] through  a point of the axis, in the basic frame
 * @return RITZ_ERR_ARGUMENT if the component has no invariants
 * @cost   O(r^2)
 */
ritz_status ritz_spin_terms_of(const ritz_invariants *invariants,
                               const double axis[static 3],
                               const double through[static 3],
                               ritz_spin_terms *out);

#endif
