/*
 * Dense arithmetic on tiles of eight rows or columns, for vectors of eight,
 * four or two numbers; which of them the processor has is found out when the
 * program runs.
 *
 * Blocks of right-hand sides lie row by row: x[p i + c] is row i of column c,
 * with a width p of 8 or 16. A factor L lies in block columns of at most
 * RITZ_TILE_COLS columns
 *
 *     | D |    D     its inverted diagonal block, lower triangular
 *     | B |    B     the rows below, only those that are not zero
 *
 * in panels of eight rows, column by column: entry (i, j) of a panel is
 * a[8 j + i]. Rows beyond the last are zeros. A panel of D ends with the last
 * column that its rows have.
 */
#ifndef RITZ_LINEAR_TILES_H
#define RITZ_LINEAR_TILES_H

#include <stdint.h>

enum {
    RITZ_TILE = 8,
    RITZ_TILE_COLS = 64, /* the inverse of a larger block loses digits */
    RITZ_TILE_WIDTHS = 2,
};

typedef struct ritz_block_column {
    int64_t first, cols; /* columns of L */
    int64_t below;       /* rows of B */
    const int32_t *row;  /* of B: a row of x, or ~k for row k of the top */
    const double *diagonal, *panel;
} ritz_block_column;

/* Sums over the panels [from, to) of B. */
typedef struct ritz_tile_width {
    int64_t width;
    /** z := D x, cols rows; z has room for the rows of whole panels. */
    void (*lower)(const ritz_block_column *b, const double *x, double *z);
    /** z := D'x */
    void (*upper)(const ritz_block_column *b, const double *x, double *z);
    /** x -= B z, in rows of x or of the top. */
    void (*scatter)(const ritz_block_column *b, int64_t from, int64_t to,
                    const double *z, double *x, double *top);
    /** z += B'x, from rows of x or of the top. */
    void (*gather)(const ritz_block_column *b, int64_t from, int64_t to,
                   const double *x, const double *top, double *z);
} ritz_tile_width;

typedef struct ritz_tiles {
    const char *name;
    ritz_tile_width of[RITZ_TILE_WIDTHS]; /* 8, 16 */
    /** C := A'X, A and X rows x 8, C 8 x 8. */
    void (*inner)(int64_t rows, const double *A, const double *X, double *C);
    /** X += A C, A and X rows x 8, C 8 x 8. */
    void (*outer)(int64_t rows, const double *A, const double *C, double *X);
    /** Rows [from, to) of Y := A X, X and Y 8 wide, rows of A as of a CSR. */
    void (*times)(int64_t from, int64_t to, const int64_t *start,
                  const int32_t *col, const double *val, const double *X,
                  double *Y);
} ritz_tiles;

/** The widest that this processor has. RITZ_TILES=128, 256 or 512 in the
 * environment asks for no wider ones. */
const ritz_tiles *ritz_tiles_here(void);

/** Kernels of vectors of 2, 4 and 8 numbers. */
extern const ritz_tiles ritz_tiles_2;
extern const ritz_tiles ritz_tiles_4;
extern const ritz_tiles ritz_tiles_8;

#endif
