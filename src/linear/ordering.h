/*
 * One fill-reducing order of a sparse symmetric matrix, for every library that
 * factors it.
 *
 * Dofs of one grid have the same neighbours: nested dissection (METIS) orders
 * grids instead of dofs, in a third of the time.
 */
#ifndef RITZ_LINEAR_ORDERING_H
#define RITZ_LINEAR_ORDERING_H

#include <ritz/matrix.h>

/** Rows below which the libraries' own choice is as good and as fast. */
enum { RITZ_ORDER_FROM = 2000 };

/**
 * @param[in]  A      n x n, symmetric, both triangles stored
 * @param[out] order  row at each place, n of them, to be freed
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_ordering_new(const ritz_sparse *A, int64_t **order);

#endif
