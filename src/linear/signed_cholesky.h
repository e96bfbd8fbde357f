/*
 * Cholesky factors of indefinite matrices, with the signs of their pivots:
 *
 *     P A P' = L S L',   S = diag(+1 or -1),   L lower triangular
 *
 * A has as many negative eigenvalues as S has negative signs, by Sylvester's
 * law of inertia. Pivots are exchanged only within a supernode, so that L has
 * the pattern of a Cholesky factor and the same code packs it and solves with
 * it. The factor is inaccurate if a leading submatrix of A is nearly singular,
 * as entries of L are then large. A caller must measure the error of a solve,
 * and choose another shift if it is large (ritz_factor_signed() does).
 */
#ifndef RITZ_LINEAR_SIGNED_CHOLESKY_H
#define RITZ_LINEAR_SIGNED_CHOLESKY_H

#include <ritz/matrix.h>

#include <suitesparse/cholmod.h>

/**
 * Compute the values of a supernodal factor whose pattern CHOLMOD has analysed.
 * Threads work on independent subtrees of the elimination tree, each with a
 * BLAS of one thread; the top of the tree is left to a BLAS of several threads.
 *
 * @param[in]     A     n x n, symmetric, both triangles stored
 * @param[in,out] L     from cholmod_l_analyze_p(); its values are allocated and
 *                      computed; its permutation, and the order of the rows
 *                      within a column, change with the exchange of pivots
 * @param[out]    sign  n numbers, +1 or -1 of each pivot, in the order of L
 * @return RITZ_ERR_SINGULAR if a pivot is zero or not finite; RITZ_ERR_MEMORY
 */
ritz_status ritz_signed_cholesky(const ritz_sparse *A, cholmod_factor *L,
                                 cholmod_common *common, double *sign);

#endif
