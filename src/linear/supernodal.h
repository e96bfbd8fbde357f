/*
 * Triangular solves with a supernodal Cholesky factor for blocks of right-hand
 * sides, near the speed of memory on all threads.
 *
 * The columns of L are packed as tiles.h has them. Subtrees of the elimination
 * tree are independent of each other: each thread has some, and adds what they
 * subtract from the rows of the tree's top to rows of its own. The top is
 * shared: every thread has some panels of each of its block columns.
 */
#ifndef RITZ_LINEAR_SUPERNODAL_H
#define RITZ_LINEAR_SUPERNODAL_H

#include <ritz/base.h>

#include <suitesparse/cholmod.h>

typedef struct ritz_supernodal ritz_supernodal;

/** Right-hand sides that one solve has at most. */
enum { RITZ_SOLVE_WIDTH = 16 };

/**
 * Pack a factor L L', whose values are lost: their pages are given back while
 * they are read, so that the factor is held once.
 *
 * @return RITZ_ERR_MEMORY; RITZ_ERR_ARGUMENT beyond 2^31 rows
 */
ritz_status ritz_supernodal_new(cholmod_factor *L, ritz_supernodal **out);

/**
 * x := (L L')^-1 x, n x @p width row by row, in the factor's order. It has the
 * same bits whenever it is run with the same number of threads.
 *
 * @param[in] width  8 or 16
 */
void ritz_supernodal_solve(ritz_supernodal *S, int64_t width, double *x);

/** Threads that each solve takes. */
int ritz_supernodal_threads(const ritz_supernodal *S);

void ritz_supernodal_free(ritz_supernodal **S);

#endif
