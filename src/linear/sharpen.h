/* Eigenpairs of a sparse pencil by sums with twice the digits, for low modes in
 * which the terms of K x cancel. */
#ifndef RITZ_LINEAR_SHARPEN_H
#define RITZ_LINEAR_SHARPEN_H

#include <ritz/matrix.h>

/**
 * Compute pairs again that have lost digits, by Rayleigh-Ritz in the span of all
 * of P: x'K x of a thin plate is ten orders below |x|'|K||x|, so that eigenvalues
 * have relative errors of 1e-9, and vectors have errors of 1e-9 along each other.
 *
 * @param[in]     K, M    n x n, symmetric, both triangles stored
 * @param[in]     energy  |x|'|K||x| of each pair (ritz_pairs_assess())
 * @param[in,out] P       ascending, of unit mass. If no flexible pair has lost
 *                        digits, nothing changes; else Phi and lambda of all
 *                        pairs are replaced, and rigid-body modes are counted
 *                        again. Residuals stay as they are: the
 *                        change of K x - lambda M x is of the order of
 *                        eps |K||x|.
 * @return RITZ_ERR_MEMORY, or that of ritz_eigen_dense()
 * @cost  a product by K with twice the digits, which takes five times as long as
 *        ritz_sparse_mul(), of all flexible vectors up to the last that has lost
 *        digits; a product by M of the same vectors; O(n m^2) for m pairs
 */
ritz_status ritz_pairs_sharpen(const ritz_sparse *K, const ritz_sparse *M,
                               const double *energy, ritz_pairs *P);

/** One more than the last flexible pair that has lost digits; num_rigid if none
 * has. P and energy as for ritz_pairs_sharpen(); of P->Phi only ncol is read. */
int64_t ritz_pairs_lost(const ritz_pairs *P, const double *energy);

/**
 * The Rayleigh-Ritz step of ritz_pairs_sharpen(), where vectors are distributed.
 *
 * @param[in]  P               num_rigid, lambda and Phi.ncol are read
 * @param[in]  some_K, some_M  columns of Phi'K Phi and Phi'M Phi, from num_rigid
 *                             to that before ritz_pairs_lost()
 * @param[out] out             lambda, and as Phi the coefficients of the vectors
 * @return RITZ_ERR_MEMORY, or that of ritz_eigen_dense()
 */
ritz_status ritz_pairs_turn(const ritz_pairs *P, const ritz_dense *some_K,
                            const ritz_dense *some_M, ritz_pairs *out);

#endif
