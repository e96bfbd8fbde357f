/* Eigenpairs of a sparse pencil from sums of twice the digits, where K x of a
 * low mode cancels. */
#ifndef RITZ_LINEAR_SHARPEN_H
#define RITZ_LINEAR_SHARPEN_H

#include <ritz/matrix.h>

/**
 * Compute pairs again that have lost digits, by Rayleigh-Ritz in the span of all
 * of P: x'K x of a thin plate is ten orders below |x|'|K||x|, so that eigenvalues
 * have errors of 1e-9 and vectors hold as much of each other.
 *
 * @param[in]     K, M    n x n, symmetric, both triangles stored
 * @param[in]     energy  |x|'|K||x| of each pair (ritz_pairs_assess())
 * @param[in,out] P       ascending, of unit mass. If no flexible pair has lost
 *                        digits, nothing changes; else Phi and lambda of all
 *                        pairs are replaced. Residuals stay as they are: the
 *                        change of K x - lambda M x is of the order of
 *                        eps |K||x|.
 * @return RITZ_ERR_MEMORY, or that of ritz_eigen_dense()
 * @cost  K times the vectors that have lost digits, at five times the cost of
 *        ritz_sparse_mul(); 2 n m^2 for m pairs
 */
ritz_status ritz_pairs_sharpen(const ritz_sparse *K, const ritz_sparse *M,
                               const double *energy, ritz_pairs *P);

#endif
