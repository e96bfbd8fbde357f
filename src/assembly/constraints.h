/*
 * The constraints of joints, and the springs and dampers of caged directions.
 */
#ifndef RITZ_ASSEMBLY_CONSTRAINTS_H
#define RITZ_ASSEMBLY_CONSTRAINTS_H

#include <ritz/assembly.h>

/*
 * Spring k is stretched by row k of S q: it adds k_k s_k s_k' to K, and its
 * damper c_k s_k s_k' to D.
 */
typedef struct ritz_springs {
    ritz_dense S; /* springs x Q */
    ritz_freedom *hold;
} ritz_springs;

/**
 * The springs of all joints at some settings, in the coordinates of the stage.
 */
ritz_status ritz_stage_springs(const ritz_stage *stage, const double *setting,
                               ritz_springs *out);

/** A dense matrix of a body by its offset in ritz_reduced. */
const ritz_dense *ritz_body_matrix(const ritz_reduced *body, size_t offset);

/** Whether one of the springs has damping. */
bool ritz_springs_damp(const ritz_springs *springs);

/** K += P'S' k S P and, where D is not empty, D += P'S' c S P. */
ritz_status ritz_springs_add(const ritz_springs *springs, const ritz_dense *P,
                             ritz_dense *K, ritz_dense *D);

/**
 * A += S' k S, or with @p damping S' c S, where the coordinates are some of the
 * n of a full model. An empty A stays {0} if there is nothing to add.
 *
 * @param[in] at  Q, the index of each coordinate among the n
 */
ritz_status ritz_springs_add_sparse(const ritz_springs *springs, bool damping,
                                    int64_t n, const int64_t *at,
                                    ritz_sparse *A);

void ritz_springs_free(ritz_springs *springs);

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
