/*
 * Blocks of eight vectors, which block methods work on.
 *
 * The vectors of a block lie row by row: x[8 i + c] is row i of vector c, so
 * that a sparse matrix or a factor is read once for all eight. A basis is a list
 * of blocks, each in memory of its own. Small matrices between two blocks are
 * 8 x 8, row by row.
 *
 * All threads of a ritz_blocks work on each product, each on its own rows. Sums
 * over rows are made for each thread and then added in the order of the
 * threads, so that a result has the same bits whenever the number of threads is
 * the same.
 */
#ifndef RITZ_LINEAR_BLOCKS_H
#define RITZ_LINEAR_BLOCKS_H

#include "linear/tiles.h"

#include <ritz/matrix.h>

#include <stdbool.h>

enum {
    RITZ_BLOCK = RITZ_TILE,                /* vectors of a block */
    RITZ_SQUARE = RITZ_BLOCK * RITZ_BLOCK, /* numbers of a small matrix */
};

/** What all products of blocks of n rows have in common. */
typedef struct ritz_blocks {
    int64_t n;
    int threads;
    const ritz_tiles *tiles;
    int64_t most; /* 8 x 8 matrices that one product can return */
    double *sums; /* threads x most x 64 */
} ritz_blocks;

/**
 * Allocate the workspace of products of blocks.
 *
 * @param[in]  n        rows of each block
 * @param[in]  threads  at most what ritz_team_ready() returned
 * @param[in]  most     largest number of 8 x 8 matrices that one call of
 *                      ritz_blocks_project() returns, 1 or more
 * @param[out] out      freed by ritz_blocks_free()
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_blocks_new(int64_t n, int threads, int64_t most,
                            ritz_blocks *out);

void ritz_blocks_free(ritz_blocks *on);

/** A square sparse matrix by rows: row i has the entries [start[i],
 * start[i + 1]). */
typedef struct ritz_row_matrix {
    int64_t n;
    int64_t *start;
    int32_t *col;
    double *val;
} ritz_row_matrix;

/**
 * Copy a symmetric A with its rows and columns in another order, without stored
 * zeros.
 *
 * @param[in]  A      n x n, both triangles stored
 * @param[in]  order  n numbers: row k of the copy is row order[k] of A
 * @param[out] out    freed by ritz_row_matrix_free()
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_row_matrix_new(const ritz_sparse *A, const int64_t *order,
                                ritz_row_matrix *out);

/**
 * A := the matrix that was copied, with the same bits.
 *
 * @param[in]  R      of a matrix without stored zeros
 * @param[in]  order  as for ritz_row_matrix_new()
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_row_matrix_restore(const ritz_row_matrix *R,
                                    const int64_t *order, ritz_sparse *A);

void ritz_row_matrix_free(ritz_row_matrix *A);

/** |x_j|'|A||x_j| of vector @p j of a block. The rounding error of x_j'A x_j is
 * at most n eps times this. */
double ritz_row_matrix_terms(const ritz_row_matrix *A, const double *X, int j);

/* --- products of blocks, n x 8 each --------------------------------------- */

/** Y := A X */
void ritz_blocks_multiply(const ritz_blocks *on, const ritz_row_matrix *A,
                          const double *X, double *Y);

/**
 * C := V'X. V is read once for all blocks of X.
 *
 * @param[in]  count  blocks of V
 * @param[in]  V      the address of each block
 * @param[in]  width  blocks of X, one after the other
 * @param[out] C      V_p'X_q is the matrix number q count + p
 */
void ritz_blocks_project(const ritz_blocks *on, int64_t count, double *const *V,
                         int64_t width, const double *X, double *C);

/** X += V C, with the arguments of ritz_blocks_project(). */
void ritz_blocks_add(const ritz_blocks *on, int64_t count, double *const *V,
                     int64_t width, const double *C, double *X);

/** X := X C, C 8 x 8. */
void ritz_blocks_transform(const ritz_blocks *on, const double *C, double *X);

/** G := X'Y, 8 x 8, of two blocks. */
void ritz_blocks_inner(const ritz_blocks *on, const double *X, const double *Y,
                       double *G);

/**
 * V := V C in place: the first @p kept blocks of V become combinations of its
 * @p count blocks, kept <= count.
 *
 * @param[in] C       block g of the result is the sum of V_p C_gp, and C_gp the
 *                    8 x 8 numbers from C[g stride + 64 p]
 * @param[in] stride  at least 64 count
 * @param     room    ritz_blocks_room() numbers, overwritten
 */
void ritz_blocks_combine(const ritz_blocks *on, int64_t count, int64_t kept,
                         int64_t stride, const double *C, double *room,
                         double *const *V);

/** Numbers of room that ritz_blocks_combine() needs to keep so many blocks. */
int64_t ritz_blocks_room(const ritz_blocks *on, int64_t kept);

/* --- single vectors of blocks, n x 8, by one thread ----------------------- */

/** x_j'y_k */
double ritz_columns_inner(int64_t n, const double *X, int j, const double *Y,
                          int k);

/** x_j += a x_k */
void ritz_columns_add(int64_t n, double a, int k, int j, double *X);

/** x_j := a x_j */
void ritz_columns_scale(int64_t n, double a, int j, double *X);

/* --- small matrices, 8 x 8 row by row ------------------------------------- */

/**
 * Cholesky factor of (G + G') / 2 = R'R, R upper triangular.
 *
 * @param[in] least  a pivot must be larger than this part of its diagonal entry
 *                   of G
 * @return false if one is not; R is undefined then
 */
bool ritz_square_factor(const double *G, double *R, double least);

/** U := R^-1 of an upper triangular R. */
void ritz_square_invert(const double *R, double *U);

/** R := Q R */
void ritz_square_multiply(const double *Q, double *R);

/** Frobenius norm. */
double ritz_square_size(const double *C);

#endif
