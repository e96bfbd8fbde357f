/*
 * The dofs of a component in two parts, boundary b, on which other bodies act,
 * and interior i, and the constraint modes Psi:
 *
 *     | u_b |   | I   |
 *     | u_i | = | Psi | u_b,      K_ii Psi = -K_ib
 *
 * For the methods that hold the boundary: fixed_interface.c, irs.c,
 * krylov_fixed.c.
 */
#ifndef RITZ_BASES_PARTITION_H
#define RITZ_BASES_PARTITION_H

#include "bases/columns.h"

/* Boundary b, on which other bodies act, and interior i. */
typedef struct ritz_partition {
    const ritz_component *component; /* borrowed */
    const ritz_dofs *b;              /* borrowed */
    ritz_dofs i;
    ritz_sparse K_ii, K_ib, M_ii, M_ib;
    ritz_factor *L;  /* of K_ii; NULL where there is no interior */
    ritz_dense Psi;  /* -K_ii^-1 K_ib: constraint modes */
    ritz_basis held; /* the columns [I; Psi], and as its T, where whole vectors
                        are needed, the vectors; Psi is then {0} */
} ritz_partition;

void ritz_partition_free(ritz_partition *s);

/** Whether the partition may take K and M of the component for its parts of
 * them. Characteristic constraint modes and a test of the damping matrix still
 * need the whole matrices. */
bool ritz_partition_may_take(const ritz_request *request);

/** The matrices of a partition, which takes those of the component if @p take. */
ritz_status ritz_partition_split(const ritz_request *request, bool take,
                                 ritz_partition *out);

/** L := the factor of K_ii. @return RITZ_ERR_SINGULAR if dofs move freely while
 * the boundary is held, or their motion has negative energy */
ritz_status ritz_partition_factor(ritz_partition *s);

/** Psi and labels of the boundary's columns. @param[in] L  the factor of K_ii;
 * NULL: there is no interior */
ritz_status ritz_constraint_modes_find(ritz_partition *s, ritz_factor *L);

/** held.T := [I; Psi] */
ritz_status ritz_constraint_modes_expand(ritz_partition *s);

/** Matrices, the factor and the constraint modes. @param[in] take  as for
 * ritz_partition_split() */
ritz_status ritz_partition_hold(const ritz_request *request, bool take,
                                ritz_partition *out);

/**
 * The columns of the boundary, and then [0; X]; labels of the latter are the
 * caller's to set.
 */
ritz_status ritz_partition_join(const ritz_partition *s, const ritz_dense *X,
                                ritz_basis *out);

/**
 * A sentence that names the dofs which move freely while the boundary is held,
 * or whose motion has negative energy.
 *
 * @param[in] weak  row of K_ii that gave way, -1 if not known
 */
ritz_status ritz_partition_refuse(const ritz_partition *s, int64_t weak);

/**
 * T_b'KT_b and T_b'MT_b, exactly symmetric. For motions that store no energy
 * the first is rounding of |T_b|'|K||T_b|, and is set to zero.
 */
ritz_status ritz_condense_boundary(const ritz_component *component,
                                   const ritz_dense *T_b, ritz_dense *K,
                                   ritz_dense *M);

#endif
