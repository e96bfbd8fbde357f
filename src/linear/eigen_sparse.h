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

/*
 * What a search for the lowest pairs decides from those that it has found, also
 * where another program searches (libexec/slepc/modes.c).
 */

/** How many of the pairs were requested: by number, or up to @p limit; a
 * cluster at the end is kept whole. */
int64_t ritz_pairs_wanted(const ritz_pairs *P, const ritz_span *span,
                          double limit);

/** Pair k at or behind @p end with the widest relative gap to pair k - 1, in
 * which modes are counted. */
int64_t ritz_pairs_gap(const ritz_pairs *P, int64_t end);

/** A value between pairs k - 1 and k, part of the way. */
double ritz_pairs_between(const ritz_pairs *P, int64_t k, double part);

#endif
