/* Blocks: dense matrices of a few vectors, with rows distributed over the
   ranks. */
#ifndef RITZ_LIBEXEC_SLEPC_BLOCKS_H
#define RITZ_LIBEXEC_SLEPC_BLOCKS_H

#include "pencil.h"

/** A new block of zeros, with rows distributed as those of A. */
void block_new(Mat A, int64_t columns, Mat *out);

/** Access the rows of this rank, without a copy, until block_return(). */
ritz_dense block_take(Mat X);
void block_return(Mat X, ritz_dense *rows);

/** out := X'Y, the sum over all ranks, in every rank. Collective. */
ritz_status block_product(Mat X, Mat Y, ritz_dense *out);

/** *out := A X, a new block. Collective. */
void block_multiply(Mat A, Mat X, Mat *out);

/**
 * One step of inverse iteration with the present factor, and Rayleigh-Ritz. X
 * becomes M-orthonormal, with eigenvalues lambda in ascending order.
 *
 *     A Y = M X,   A_r = Y'(M X),   M_r = Y'M Y,   A_r q = theta M_r q,
 *     X := Y q,   lambda = sigma + theta
 *
 * Collective.
 *
 * @return RITZ_ERR_CONVERGENCE if vectors depend on each other
 */
ritz_status block_polish(const rank_pencil *p, Mat X, double *lambda);

/** Distribute @p count columns from rank 0 to a new block, whose rows are
 * distributed as those of A. Rank 0 calls @p give for each column, which sets
 * all rows of @p x. Collective. */
ritz_status block_scatter(Mat A, int64_t count,
                          void (*give)(const void *state, int64_t column,
                                       double *x),
                          const void *state, Mat *out);

/** X := X - Phi Phi'M X, twice, where Phi is the first @p count columns of
 * @p of, which are M-orthonormal. Collective. */
ritz_status block_remove(const rank_pencil *p, Mat of, int64_t count, Mat X);

/** Gather the first @p count columns in rank 0, one at a time: there @p take is
 * called for each column, with all its rows in @p x. Collective. */
ritz_status block_gather(Mat X, int64_t count,
                         void (*take)(void *state, int64_t column,
                                      const double *x),
                         void *state);

#endif
