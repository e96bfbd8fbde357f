/*
 * Kernels of dense arithmetic on tiles of eight rows, compiled for processors
 * with vectors of eight, four or two numbers. ritz_tiles_here() chooses among
 * them when the program runs.
 *
 * A block of right-hand sides is stored row by row: x[p i + c] is row i of
 * right-hand side c, with a width p of 8 or 16. A factor L is stored in block
 * columns of at most RITZ_TILE_COLS columns:
 *
 *     | D |    D     inverse of its diagonal block, lower triangular
 *     | B |    B     the rows below it that are not zero
 *
 * D and B are cut into panels of eight rows, each stored column by column:
 * entry (i, j) of a panel is a[8 j + i]. The last panel is filled up with rows
 * of zeros. A panel of D ends with the last column that is not zero in its
 * rows.
 */
#ifndef RITZ_LINEAR_TILES_H
#define RITZ_LINEAR_TILES_H

#include <ritz/matrix.h>

#include <stdint.h>

enum {
    RITZ_TILE = 8,
    RITZ_TILE_COLS = 64, /* the inverse of a larger block loses digits */
    RITZ_TILE_WIDTHS = 2,
};

typedef struct ritz_block_column {
    int64_t first, cols; /* columns of L */
    int64_t below;       /* rows of B */
    const int32_t *row;  /* row i of B belongs to row row[i] of x; if row[i] is
                            negative, to row ~row[i] of the array `top` */
    const double *diagonal, *panel;
} ritz_block_column;

/* Kernels for one width of x. Where they take panels [from, to) of B, threads
 * can share the work; a panel has eight rows. */
typedef struct ritz_tile_width {
    int64_t width;
    /** z := D x, cols rows; z has room for cols rounded up to whole panels. */
    void (*lower)(const ritz_block_column *b, const double *x, double *z);
    /** z := D'x */
    void (*upper)(const ritz_block_column *b, const double *x, double *z);
    /** x -= B z, where the rows of B are in x, and in @p top for the others. */
    void (*scatter)(const ritz_block_column *b, int64_t from, int64_t to,
                    const double *z, double *x, double *top);
    /** z += B'x, with the same rows. */
    void (*gather)(const ritz_block_column *b, int64_t from, int64_t to,
                   const double *x, const double *top, double *z);
    /** Y := rows [from, to) of A X for a symmetric A. X has all rows, Y has to -
     * from of them. */
    void (*symmetric)(int64_t from, int64_t to, const ritz_sparse *A,
                      const double *X, double *Y);
    /** The same, and S := rows of |A||X|. */
    void (*terms)(int64_t from, int64_t to, const ritz_sparse *A,
                  const double *X, double *Y, double *S);
} ritz_tile_width;

typedef struct ritz_tiles {
    const char *name;
    ritz_tile_width of[RITZ_TILE_WIDTHS]; /* 8, 16 */
    /** C := A'X, A and X rows x 8, C 8 x 8. */
    void (*inner)(int64_t rows, const double *A, const double *X, double *C);
    /** X += A C, A and X rows x 8, C 8 x 8. */
    void (*outer)(int64_t rows, const double *A, const double *C, double *X);
    /** Rows [from, to) of Y := A X, X and Y with 8 numbers a row. Row i of the
     * sparse A has the entries [start[i], start[i + 1]) of @p col and @p val.
     * */
    void (*times)(int64_t from, int64_t to, const int64_t *start,
                  const int32_t *col, const double *val, const double *X,
                  double *Y);
    /** Y += A X, X and Y with 8 numbers a row. */
    void (*spread)(const ritz_sparse *A, const double *X, double *Y);
    /** Y + L += A X with a rounding error of the order of eps^2: L collects the
     * rounding errors of Y. X, Y and L with 8 numbers a row. */
    void (*twofold)(const ritz_sparse *A, const double *X, double *Y,
                    double *L);
} ritz_tiles;

/** The kernels with the widest vectors that this processor has. The environment
 * variable RITZ_TILES limits their width, in bits: 128, 256 or 512. */
const ritz_tiles *ritz_tiles_here(void);

/** `twofold` for vectors of 2, 4 and 8 numbers. */
void ritz_twofold_2(const ritz_sparse *A, const double *X, double *Y,
                    double *L);
void ritz_twofold_4(const ritz_sparse *A, const double *X, double *Y,
                    double *L);
void ritz_twofold_8(const ritz_sparse *A, const double *X, double *Y,
                    double *L);

/** Kernels for vectors of 2, 4 and 8 numbers (128, 256 and 512 bits). */
extern const ritz_tiles ritz_tiles_2;
extern const ritz_tiles ritz_tiles_4;
extern const ritz_tiles ritz_tiles_8;

#endif
