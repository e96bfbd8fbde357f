/*
 * A fill-reducing order of a sparse symmetric matrix by nested dissection
 * (METIS), which CHOLMOD and MUMPS are both given.
 *
 * The dofs of one grid have the same neighbours. So grids are ordered instead
 * of dofs, which takes a third of the time.
 */
#ifndef RITZ_LINEAR_ORDERING_H
#define RITZ_LINEAR_ORDERING_H

#include <ritz/matrix.h>

/** Smaller matrices are ordered by the library that factors them. */
enum { RITZ_ORDER_FROM = 2000 };

/**
 * Find the order from the pattern of A; its values do not matter.
 *
 * @param[in]  A      n x n, symmetric, both triangles stored
 * @param[out] order  n numbers, to be freed: pivot k is row order[k] of A
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_ordering_new(const ritz_sparse *A, int64_t **order);

#endif
