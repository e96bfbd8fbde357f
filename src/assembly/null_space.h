/* The null space of constraints, by rank with a tolerance. */
#ifndef RITZ_ASSEMBLY_NULL_SPACE_H
#define RITZ_ASSEMBLY_NULL_SPACE_H

#include <ritz/dense.h>

/**
 * Orthonormal columns that span the null space of C, c x n.
 *
 * @param[out] rank  singular values above 1e-9 of the largest
 * @param[out] out   n x (n - rank)
 * @cost   O(n^2 c)
 */
ritz_status ritz_null_space(const ritz_dense *C, int64_t *rank,
                            ritz_dense *out);

#endif
