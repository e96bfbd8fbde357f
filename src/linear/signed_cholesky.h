/*
 * Cholesky factors of indefinite matrices, with the signs of their pivots:
 *
 *     P A P' = L S L',   S = diag(+1 or -1),   L lower triangular
 *
 * As many signs are negative as A has negative eigenvalues, by Sylvester's law
 * of inertia. Pivots are exchanged within supernodes only, so that L has the
 * pattern of a Cholesky factor, and is packed and solved with like one. L may
 * still grow where a leading part of A is nearly singular: a caller checks a
 * solve, and takes another A.
 */
#ifndef RITZ_LINEAR_SIGNED_CHOLESKY_H
#define RITZ_LINEAR_SIGNED_CHOLESKY_H

#include <ritz/matrix.h>

#include <suitesparse/cholmod.h>

/**
 * Fill a supernodal factor that CHOLMOD has analysed. Two threads and more work
 * on independent subtrees of the elimination tree, and the threads of the BLAS
 * on the rest.
 *
 * @param[in]     A     n x n, symmetric, both triangles stored
 * @param[in,out] L     its values are allocated and computed; its order and the
 *                      order of rows in its columns change
 * @param[out]    sign  n, of each pivot, in the order of L
 * @return RITZ_ERR_SINGULAR if a pivot is zero or not finite; RITZ_ERR_MEMORY
 */
ritz_status ritz_signed_cholesky(const ritz_sparse *A, cholmod_factor *L,
                                 cholmod_common *common, double *sign);

#endif
