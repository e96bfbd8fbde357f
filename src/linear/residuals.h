/* Residuals of eigenpairs of sparse matrices, and the size of the rounding of
 * x'A x. */
#ifndef RITZ_LINEAR_RESIDUALS_H
#define RITZ_LINEAR_RESIDUALS_H

#include <ritz/matrix.h>

/**
 * Compute the residual of each pair, | K x - lambda M x | divided by
 * | |K||x| + |lambda||M||x| |, and how many pairs are rigid-body modes. That of
 * a rigid-body mode is divided by the largest such norm of all pairs: in the
 * motion of a mass that no stiffness holds, |K||x| is itself rounding.
 *
 * @param[in]     K, M   n x n, symmetric, both triangles stored
 * @param[in,out] P      Phi and lambda are read; residual, one number for each
 *                       column of Phi, and num_rigid are set
 * @param[out]    energy |x|'|K||x| of each pair; NULL: not wanted
 * @param[out]    worst  largest residual; NaN if one is NaN, 0 without pairs
 * @return RITZ_ERR_MEMORY
 * @cost  one pass over K and M for every eight pairs, on all threads. The last
 *        bits depend on the number of threads, as sums are divided among them.
 */
ritz_status ritz_pairs_assess(const ritz_sparse *K, const ritz_sparse *M,
                              ritz_pairs *P, double *energy, double *worst);

/**
 * The last step of ritz_pairs_assess(): how many pairs are rigid-body modes, and
 * their residuals.
 *
 * @param[in,out] P       residual is |K x - lambda M x| on entry
 * @param[in]     size    | |K||x| + |lambda||M||x| | of each pair
 * @param[in]     energy  |x|'|K||x| of each pair
 */
void ritz_pairs_relate(ritz_pairs *P, const double *size, const double *energy,
                       double *worst);

/**
 * R = K X - M X diag(lambda), and |x|'|K||x| and |x|'|M||x| of each column x of
 * @p X. The rounding errors of x'K x and x'M x are of the order of eps times
 * these.
 *
 * @param[in]  K, M    n x n, symmetric, both triangles stored
 * @param[in]  X       n x k
 * @param[in]  lambda  k numbers
 * @param[out] R       n x k, freed by the caller
 * @param[out] stiffness_terms, mass_terms  k numbers each, of which the last
 *                     bits depend on the number of threads
 * @return RITZ_ERR_MEMORY
 * @cost  one pass over K and M for every eight columns, on all threads
 */
ritz_status ritz_pairs_subtract(const ritz_sparse *K, const ritz_sparse *M,
                                const ritz_dense *X, const double *lambda,
                                ritz_dense *R, double *stiffness_terms,
                                double *mass_terms);

#endif
