/* Dofs of a component split into attached ones and the rest. */
#ifndef RITZ_BASES_PARTITION_H
#define RITZ_BASES_PARTITION_H

#include <ritz/basis.h>
#include <ritz/matrix.h>
#include <ritz/model.h>

/* Boundary b, on which other bodies act, and interior i. */
typedef struct ritz_partition {
    const ritz_component *component; /* borrowed */
    const ritz_dofs *b;              /* borrowed */
    ritz_dofs i;
    ritz_sparse K_ii, K_ib, M_ii;
} ritz_partition;

/** @return RITZ_ERR_ARGUMENT if an attached dof is listed twice */
ritz_status ritz_partition_new(const ritz_request *request,
                               ritz_partition *out);

/**
 * Factor of K_ii; NULL where there is no interior.
 *
 * @return RITZ_ERR_SINGULAR, naming dofs that move while b is held
 */
ritz_status ritz_partition_factor(const ritz_partition *s, ritz_factor **out);

/**
 * Psi = -K_ii^-1 K_ib, interior x boundary.
 *
 * @param[in] L  of ritz_partition_factor
 */
ritz_status ritz_partition_constraint_modes(const ritz_partition *s,
                                            ritz_factor *L, ritz_dense *Psi);

/** Rows of @p part go to the dofs @p to, its columns from @p first on in T. */
void ritz_partition_scatter(const ritz_dense *part, const ritz_dofs *to,
                            int64_t first, ritz_dense *T);

void ritz_partition_free(ritz_partition *s);

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

/**
 * T_b'KT_b and T_b'MT_b. For motions that store no energy the first is rounding
 * of |T_b|'|K||T_b|, and is set to zero.
 *
 * @param[in]  T_b  n x b, [I; Psi]: constraint modes
 * @param[out] K,M  b x b, exactly symmetric
 * @cost   O(b nnz + n b^2)
 */
ritz_status ritz_condense(const ritz_component *component,
                          const ritz_dense *T_b, ritz_dense *K, ritz_dense *M);

#endif
