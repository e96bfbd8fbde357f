/*
 * Which of the pairs that a search found were requested, and where modes are
 * counted to prove that none is missing: for the search of ritz_eigen_sparse()
 * and for the one by several processes (libexec/slepc/modes.c).
 */
#ifndef RITZ_LINEAR_REQUESTED_H
#define RITZ_LINEAR_REQUESTED_H

#include <ritz/matrix.h>

#include <stdbool.h>

/**
 * How many of the pairs found were requested: rigid modes and span->modes
 * others, or all up to @p limit if span->modes is negative; and the rest of a
 * cluster that the last of them belongs to.
 *
 * @param[in] limit  highest eigenvalue requested  [rad^2/s^2]
 */
int64_t ritz_pairs_wanted(const ritz_pairs *P, const ritz_span *span,
                          double limit);

/** @p end, or the end of the cluster that it would cut. */
int64_t ritz_pairs_whole(const ritz_pairs *P, int64_t end);

/** The index k >= @p end with the widest relative gap between pairs k - 1 and
 * k, none of rounding: modes are counted below a value in that gap. */
int64_t ritz_pairs_gap(const ritz_pairs *P, int64_t end);

/** Whether eigenvalues k - 1 and k of @p P belong to one cluster. */
bool ritz_pairs_clustered(const ritz_pairs *P, int64_t k);

/** A value between eigenvalues k - 1 and k of @p P, at @p part (0 to 1) of the
 * way; below the first one if k is 0, above the last one if k is their number. */
double ritz_pairs_between(const ritz_pairs *P, int64_t k, double part);

/** Whether a pair lies so near to @p limit that a count of the modes below the
 * limit may include it or not (RITZ_COUNT_UNCLEAR). */
bool ritz_pairs_unclear(const ritz_pairs *P, double limit);

/** Keep the first @p end pairs. */
void ritz_pairs_truncate(ritz_pairs *P, int64_t end);

#endif
