/* Bodies with force columns are joined by interface forces. */
#ifndef RITZ_ASSEMBLY_DUAL_H
#define RITZ_ASSEMBLY_DUAL_H

#include "assembly/constraints.h"

/** Whether a body of the stage has columns of kind force. */
bool ritz_dual_is_due(const ritz_stage *stage);

/** RITZ_ERR_ARGUMENT naming the body if there is one; where modes are chosen. */
ritz_status ritz_dual_refuse(const ritz_stage *stage);

/**
 * The modes of such a system as its coordinates: rank, K, M, D, K4, lambda,
 * num_rigid and how many eigenvalues are negative, among the errors.
 *
 * @param[in]  C      constraints, columns of scaled coordinates
 * @param[in]  scale  of the coordinates
 * @param[out] P      Q x e, coordinates of the bodies by modes of the system
 * @return RITZ_ERR_SINGULAR if force columns have no stiffness
 */
ritz_status ritz_dual_assemble(const ritz_stage *stage,
                               const ritz_springs *springs, const ritz_dense *C,
                               const double *scale, ritz_dense *P,
                               ritz_configuration *c);

#endif
