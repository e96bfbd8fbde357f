/* Distributed dense matrices: some vectors of the interior. */
#ifndef RITZ_LIBEXEC_SLEPC_BLOCKS_H
#define RITZ_LIBEXEC_SLEPC_BLOCKS_H

#include "pencil.h"

/** A block of zeros with the rows of A. */
void block_new(Mat A, int64_t columns, Mat *out);

/** The rows of this rank, to be given back by block_return. */
ritz_dense block_take(Mat X);
void block_return(Mat X, ritz_dense *rows);

/** X'Y, the same in every rank. Collective. */
ritz_status block_product(Mat X, Mat Y, ritz_dense *out);

/** A X, a new block. Collective. */
void block_multiply(Mat A, Mat X, Mat *out);

/**
 * Inverse iteration and Rayleigh-Ritz: X becomes M-orthonormal, lambda ascends.
 *
 *     A Y = M X,   A_r = Y'(M X),   M_r = Y'M Y,   A_r q = theta M_r q,
 *     X := Y q,   lambda = sigma + theta
 *
 * Collective.
 *
 * @return RITZ_ERR_CONVERGENCE if vectors depend on each other
 */
ritz_status block_polish(const rank_pencil *p, Mat X, double *lambda);

/**
 * Residuals |K x - lambda M x| / ||K||x| + |lambda||M||x||, and which pairs are
 * rigid. Collective.
 *
 * @param[in,out] P  eigenvalues, and the number of columns
 */
ritz_status block_assess(const rank_pencil *p, Mat X, ritz_pairs *P,
                         double *worst);

/**
 * Eigenvalues that have lost digits, as those of thin plates do, anew by
 * x'K x / x'M x with sums of more digits: they carry the rounding of the factor,
 * which differs from one number of ranks to another, and the quotient errs by
 * the square of that. Collective.
 */
ritz_status block_sharpen(const rank_pencil *p, Mat X, ritz_pairs *P);

/** The first columns one after the other, all rows of each, in rank 0, where
 * @p take gets them. Collective. */
ritz_status block_gather(Mat X, int64_t count,
                         void (*take)(void *state, int64_t column,
                                      const double *x),
                         void *state);

#endif
