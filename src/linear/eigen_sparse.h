/* Lowest eigenpairs of a sparse pencil whose stiffness is already factored. */
#ifndef RITZ_LINEAR_EIGEN_SPARSE_H
#define RITZ_LINEAR_EIGEN_SPARSE_H

#include <ritz/matrix.h>

/**
 * ritz_eigen_sparse() for a positive definite K whose Cholesky factor the
 * caller has. The search uses this factor (sigma = 0) instead of making one of
 * K - sigma M. The factor is freed once the pairs are found, before the count
 * makes its own, so that memory holds one factor at a time.
 *
 * @param[in,out] L  the factor of K; freed and NULL afterwards, also on failure
 */
ritz_status ritz_eigen_factored(const ritz_sparse *K, const ritz_sparse *M,
                                ritz_factor **L, const ritz_span *span,
                                ritz_pairs *out);

/** Something that needs the factor of a search as well as its pairs. */
typedef struct ritz_factor_use {
    /**
     * @param[in] found  the search's pairs
     * @param[in] count  the first so many of them were requested
     * @param[in] A      the factor of K - sigma M
     */
    ritz_status (*call)(void *of, const ritz_pairs *found, int64_t count,
                        ritz_factor *A, double sigma);
    void *of;
} ritz_factor_use;

/**
 * ritz_eigen_sparse() that lends its factor: use->call is called when the pairs
 * are found, before they are counted. Pairs that the count proves to be
 * incomplete are searched for again, and use->call is called again. It is not
 * called where no factor is left: with dense methods and with slices.
 */
ritz_status ritz_eigen_lending(const ritz_sparse *K, const ritz_sparse *M,
                               const ritz_span *span,
                               const ritz_factor_use *use, ritz_pairs *out);

/*
 * Decisions of a search for the lowest pairs, of ritz_eigen_sparse() and of the
 * one by several processes (libexec/slepc/modes.c).
 */

/**
 * How many of the pairs found were requested: rigid modes and span->modes
 * others, or all up to @p limit if span->modes is negative; and the rest of a
 * cluster that the last of them belongs to.
 *
 * @param[in] limit  highest eigenvalue requested  [rad^2/s^2]
 */
int64_t ritz_pairs_wanted(const ritz_pairs *P, const ritz_span *span,
                          double limit);

/** The index k >= @p end with the widest relative gap between pairs k - 1 and
 * k: modes are counted below a value in that gap. */
int64_t ritz_pairs_gap(const ritz_pairs *P, int64_t end);

/** A value between eigenvalues k - 1 and k of @p P, at @p part (0 to 1) of the
 * way; beyond the first or the last one if there is only one of them. */
double ritz_pairs_between(const ritz_pairs *P, int64_t k, double part);

#endif
