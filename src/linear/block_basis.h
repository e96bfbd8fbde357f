/*
 * An M-orthonormal basis that grows by one or two blocks of eight vectors at a
 * time, for block_lanczos.h. Two blocks are read and multiplied together where
 * this saves time; they are orthonormalised one after the other.
 */
#ifndef RITZ_LINEAR_BLOCK_BASIS_H
#define RITZ_LINEAR_BLOCK_BASIS_H

#include "linear/block_list.h"
#include "linear/blocks.h"
#include "linear/general.h"

enum {
    RITZ_STEP_WIDEST = 2, /* blocks of a step */
    RITZ_STEP_SQUARES = RITZ_STEP_WIDEST * RITZ_STEP_WIDEST,
};

/** Blocks are n x 8 as blocks.h has them, with rows in the order of the factor
 * S->A. */
typedef struct ritz_block_basis {
    const ritz_shifted *S;
    int64_t n;
    int64_t width;  /* blocks of a step, 1 or 2 */
    uint64_t noise; /* state of random vectors */
    int64_t blocks; /* of V, without those of the next step */
    ritz_block_list V;
    double *W;  /* width blocks, one after the other: the next step */
    double *MW; /* M times them; when W is put behind V, M times that */
    double *C;  /* 8 x 8 coefficients for each block of V and of W */
    ritz_blocks on;
    const ritz_row_matrix *M; /* rows in the order of the factor; borrowed */
} ritz_block_basis;

/**
 * Allocate what a basis needs. V has no blocks yet: each is allocated when it is
 * filled, so that they fit where memory was freed before.
 *
 * @param[in]     room  blocks of V, a multiple of the width
 * @param[in,out] b     with S, n, width, noise and M; freed by
 *                      ritz_block_basis_free(), also on failure
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_block_basis_new(int64_t room, ritz_block_basis *b);

/** What memory must hold beside the blocks of V. */
typedef struct ritz_basis_needs {
    int64_t kept;       /* blocks of V that are left at the end */
    int64_t meanwhile;  /* bytes for other things during the iteration */
    int64_t afterwards; /* bytes for other things beside the blocks kept */
} ritz_basis_needs;

/**
 * Compare the blocks of V with the limit of memory. Those that would exceed it
 * will be in a file. Memory that was freed before is returned, as blocks of V
 * may not fill it.
 *
 * @return RITZ_ERR_MEMORY if less than that must be in memory does not fit, which
 *         is the blocks kept, one more, and RITZ_BLOCK_WINDOW of the file;
 *         also if the file cannot be opened
 */
ritz_status ritz_block_basis_admit(ritz_block_basis *b,
                                   const ritz_basis_needs *needs);

void ritz_block_basis_free(ritz_block_basis *b);

/** Let the step behind the blocks of V, which b->blocks does not count yet,
 * follow the first @p kept blocks; the others are no longer counted, and what
 * they hold is void. @return RITZ_ERR_MEMORY if the file fails */
ritz_status ritz_block_basis_move_step(ritz_block_basis *b, int64_t kept);

/** V := one step of random vectors, multiplied by A^-1 M and orthonormalised.
 * @param[out] exhausted  the range of A^-1 M is empty */
ritz_status ritz_block_basis_begin(ritz_block_basis *b, bool *exhausted);

/** Y := M X for all blocks of a step. */
void ritz_block_basis_multiply(const ritz_block_basis *b, double *X, double *Y);

/** b->C := V'X for blocks [first, first + count) of V and @p width blocks of X,
 * in the order of ritz_blocks_project().
 * @return RITZ_ERR_MEMORY if the file fails */
ritz_status ritz_block_basis_project(const ritz_block_basis *b, int64_t first,
                                     int64_t count, int64_t width,
                                     const double *X);

/** X -= V b->C with the same blocks; b->C changes its sign.
 * @return RITZ_ERR_MEMORY if the file fails */
ritz_status ritz_block_basis_subtract(const ritz_block_basis *b, int64_t first,
                                      int64_t count, int64_t width, double *X);

/** Where the 8 x 8 block R_pq of the R of a step is: W_q = sum over p of Q_p R_pq
 * (ritz_block_basis_orthonormalise()). */
double *ritz_block_basis_square(const ritz_block_basis *b, double *R, int64_t p,
                                int64_t q);

/**
 * Put Q of W = Q R behind the blocks of V, which b->blocks does not count yet,
 * and MW := M Q, for W that is orthogonal to V. W is void then. Vectors of W
 * that depend on those before them are replaced by random ones, orthogonal to
 * all others; where no direction is left they are zero.
 *
 * @param[in]  size       norm of what was subtracted from W to make it
 *                        orthogonal: vectors that are much shorter are rounding
 * @param[out] R          upper triangular, see ritz_block_basis_square(); rows
 *                        of replaced vectors are zero
 * @param[out] exhausted  no direction was left for any vector of the first
 *                        block
 * @return RITZ_ERR_MEMORY, also if the file fails
 */
ritz_status ritz_block_basis_orthonormalise(ritz_block_basis *b, double size,
                                            double *R, bool *exhausted);

#endif
