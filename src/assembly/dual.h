/*
 * Assembly of bodies with force columns, which are joined by interface forces.
 */
#ifndef RITZ_ASSEMBLY_DUAL_H
#define RITZ_ASSEMBLY_DUAL_H

#include "assembly/constraints.h"

/** Whether a body of the stage has columns of kind force. */
bool ritz_dual_is_due(const ritz_stage *stage);

/**
 * RITZ_ERR_ARGUMENT naming the first body with force columns; for methods that
 * choose modes.
 */
ritz_status ritz_dual_refuse(const ritz_stage *stage);

/**
 * A system with force columns in its modal coordinates: rank, K, M, D, K4,
 * lambda, num_rigid and, among the errors, the number of negative eigenvalues.
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
