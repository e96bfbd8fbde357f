/* Slaves and masters of constraints. */
#ifndef RITZ_ASSEMBLY_ELIMINATE_H
#define RITZ_ASSEMBLY_ELIMINATE_H

#include <ritz/dense.h>

/**
 * Gauss-Jordan elimination with complete pivoting: C becomes rows with one
 * slave each, u_s + sum_m C_sm u_m = 0. Rows that depend on others are left
 * without a slave; among equal pivots later columns become slaves.
 *
 * @param[in]  C         rows of largest norm 1, for what is rounding
 * @param[out] pivot_of  C->ncol: the row in which a column is the slave, -1 for
 *                       masters
 */
void ritz_eliminate(ritz_dense *C, int64_t *pivot_of);

#endif
