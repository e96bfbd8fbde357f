/* What moves where a stiffness that must be definite is not. */
#ifndef RITZ_BASES_MECHANISM_H
#define RITZ_BASES_MECHANISM_H

#include <ritz/component.h>

/**
 * Record a sentence that names the dofs which move freely while the rest of
 * the component is held, and return RITZ_ERR_SINGULAR (or a worse failure).
 *
 * @param[in] K_ii,M_ii  the singular block and its mass
 * @param[in] i          rows of the component that they stand for
 * @param[in] weak       row of the block that gave way, -1 if not known
 */
ritz_status ritz_mechanism_refuse(const ritz_component *component,
                                  const ritz_sparse *K_ii,
                                  const ritz_sparse *M_ii, const ritz_dofs *i,
                                  int64_t weak);

#endif
