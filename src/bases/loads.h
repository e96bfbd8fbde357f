/* The load vectors of a basis, as columns of a matrix. */
#ifndef RITZ_BASES_LOADS_H
#define RITZ_BASES_LOADS_H

#include <ritz/basis.h>

/* Room for what ritz_loads_name writes. */
enum { RITZ_LOADS_NAME_SIZE = RITZ_NAME_SIZE + 16 };

/**
 * The number of columns that ritz_loads_collect would give; zero is no failure
 * here.
 *
 * @param[in] loads  sum of RITZ_LOADS_...
 * @cost   O(n p)
 */
int64_t ritz_loads_count(const ritz_request *request, int loads);

/**
 * Unit forces at the attached dofs, columns of B, rows of C, then of Cv and Ca,
 * influence vectors of dampers: the requested ones, in this order, without zero
 * columns.
 *
 * @param[in]  loads  sum of RITZ_LOADS_...
 * @param[out] F      n x p, p at least 1
 * @param[out] dof    p, the row of an attached dof, -1 of others; the caller's
 *                    to free
 * @return RITZ_ERR_ARGUMENT if there is none, or an attached dof is out of
 *         range or repeated
 */
ritz_status ritz_loads_collect(const ritz_request *request, int loads,
                               ritz_dense *F, int64_t **dof);

/** "grid 3 T1", "input 'torque'": what column @p j is; returns @p text. */
const char *ritz_loads_name(const ritz_request *request, int loads, int64_t j,
                            char text[RITZ_LOADS_NAME_SIZE]);

#endif
