/* Dofs of a component divided into attached ones and the rest. */
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
 * The columns of the boundary, [I; Psi] with Psi = -K_ii^-1 K_ib.
 *
 * @param[in] L  of ritz_partition_factor
 */
ritz_status ritz_partition_boundary(const ritz_partition *s, ritz_factor *L,
                                    ritz_basis *out);

/**
 * The columns of @p boundary, and then [0; X].
 *
 * @param[in] boundary  may span fewer motions of the boundary
 * @param[in] X         interior x k; labels of its columns are the caller's to
 *                      set
 */
ritz_status ritz_partition_join(const ritz_partition *s,
                                const ritz_basis *boundary, const ritz_dense *X,
                                ritz_basis *out);

void ritz_partition_free(ritz_partition *s);

/**
 * Record a sentence that names the dofs which move freely while the boundary
 * is held, and return RITZ_ERR_SINGULAR (or a worse failure).
 *
 * @param[in] weak  row of K_ii that gave way, -1 if not known
 */
ritz_status ritz_mechanism_refuse(const ritz_partition *s, int64_t weak);

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
