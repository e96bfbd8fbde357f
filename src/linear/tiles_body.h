/*
 * The kernels of tiles.h for vectors of LANES numbers. tiles_2.c, tiles_4.c and
 * tiles_8.c define LANES and include this file; each is compiled for processors
 * with such vectors.
 *
 * Products are made for ROWS rows of a panel and at most MOST columns of a
 * block at a time, so that their sums stay in registers: with 16 registers 4 x
 * 2 vectors of sums, with the 32 of AVX-512 8 x 2.
 */
#include "linear/tiles.h"

#include <string.h>

#define INLINE static inline __attribute__((always_inline))

typedef double vector
    __attribute__((vector_size(8 * LANES), aligned(8), may_alias));
typedef int64_t integers __attribute__((vector_size(8 * LANES), aligned(8)));

enum {
    T = RITZ_TILE,
    ROWS = LANES == 8 ? 8 : 4,
    MOST = LANES == 8 ? 16 : 2 * LANES, /* columns at once */
    AHEAD = 64, /* a panel is fetched so many columns in advance */
};

/* How many of `width` columns are worked on at a time. */
#define STRIP(width) ((width) < MOST ? (width) : MOST)

/* Panels follow each other in memory. A factor that exceeds the caches is read
   a third faster if it is fetched 64 to 256 columns in advance (measured). */
INLINE void fetch_ahead(const double *a)
{
    __builtin_prefetch(a + (ptrdiff_t)AHEAD * T, 0, 2);
}

/* y := a x, a one panel of k columns, x k x width, y 8 x width. */
INLINE void multiply_panel(const int64_t width, const double *a, int64_t k,
                           const double *x, double *y)
{
    enum { VECTORS = MOST / LANES };
    const int64_t vectors = STRIP(width) / LANES;

    for (int64_t c = 0; c < width; c += STRIP(width))
        for (int64_t r = 0; r < T; r += ROWS) {
            vector sum[ROWS][VECTORS] = {0};

            for (int64_t j = 0; j < k; j++) {
                const double *from = x + j * width + c;
                vector b[VECTORS];

                fetch_ahead(a + T * j + r);
                for (int64_t v = 0; v < vectors; v++)
                    b[v] = *(const vector *)(from + v * LANES);
                for (int i = 0; i < ROWS; i++)
                    for (int64_t v = 0; v < vectors; v++)
                        sum[i][v] += a[T * j + r + i] * b[v];
            }
            for (int i = 0; i < ROWS; i++)
                for (int64_t v = 0; v < vectors; v++)
                    *(vector *)(y + (r + i) * width + c + v * LANES) =
                        sum[i][v];
        }
}

/* z += a'y, a one panel of k columns, y 8 x width, z k x width. */
INLINE void add_transposed(const int64_t width, const double *a, int64_t k,
                           const double *y, double *z)
{
    enum { VECTORS = MOST / LANES };
    const int64_t vectors = STRIP(width) / LANES;

    for (int64_t c = 0; c < width; c += STRIP(width))
        for (int64_t r = 0; r < T; r += ROWS) {
            vector x[ROWS][VECTORS];

            for (int i = 0; i < ROWS; i++)
                for (int64_t v = 0; v < vectors; v++)
                    x[i][v] =
                        *(const vector *)(y + (r + i) * width + c + v * LANES);
            for (int64_t j = 0; j < k; j++) {
                double *to = z + j * width + c;

                fetch_ahead(a + T * j + r);
                for (int64_t v = 0; v < vectors; v++) {
                    vector sum = *(vector *)(to + v * LANES);

                    for (int i = 0; i < ROWS; i++)
                        sum += a[T * j + r + i] * x[i][v];
                    *(vector *)(to + v * LANES) = sum;
                }
            }
        }
}

/* Index of the first number of a row of B, in x or, if negative, in the top. */
INLINE int64_t index_of(const int64_t width, int32_t row)
{
    return (int64_t)(row >= 0 ? row : ~row) * width;
}

INLINE void subtract_row(const int64_t width, const double *y, double *to)
{
    for (int64_t c = 0; c < width; c += LANES)
        *(vector *)(to + c) -= *(const vector *)(y + c);
}

INLINE int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* Fetch the rows of x or `top` that panel p needs. */
INLINE void fetch_rows(const int64_t width, const ritz_block_column *b,
                       int64_t p, const double *x, const double *top)
{
    for (int64_t i = p * T; i < least(p * T + T, b->below); i++) {
        const int32_t row = b->row[i];

        for (int64_t c = 0; c < width; c += T)
            __builtin_prefetch((row >= 0 ? x : top) + index_of(width, row) + c);
    }
}

INLINE void lower(const int64_t width, const ritz_block_column *b,
                  const double *x, double *z)
{
    const double *a = b->diagonal;

    for (int64_t r = 0; r < b->cols; r += T) {
        const int64_t end = least(r + T, b->cols);

        multiply_panel(width, a, end, x, z + r * width);
        a += T * end;
    }
}

INLINE void upper(const int64_t width, const ritz_block_column *b,
                  const double *x, double *z)
{
    const double *a = b->diagonal;

    memset(z, 0, (size_t)(b->cols * width) * sizeof *z);
    for (int64_t r = 0; r < b->cols; r += T) {
        const int64_t end = least(r + T, b->cols);
        double y[T * 16] = {0};

        memcpy(y, x + r * width, (size_t)((end - r) * width) * sizeof *y);
        add_transposed(width, a, end, y, z);
        a += T * end;
    }
}

INLINE void scatter(const int64_t width, const ritz_block_column *b,
                    int64_t from, int64_t to, const double *z, double *x,
                    double *top)
{
    for (int64_t p = from; p < to; p++) {
        const int64_t count = least(T, b->below - p * T);
        double y[T * 16];

        fetch_rows(width, b, p + 1, x, top);
        multiply_panel(width, b->panel + p * T * b->cols, b->cols, z, y);
        for (int64_t i = 0; i < count; i++) {
            const int32_t row = b->row[p * T + i];

            subtract_row(width, y + i * width,
                         (row >= 0 ? x : top) + index_of(width, row));
        }
    }
}

INLINE void gather(const int64_t width, const ritz_block_column *b,
                   int64_t from, int64_t to, const double *x, const double *top,
                   double *z)
{
    for (int64_t p = from; p < to; p++) {
        const int64_t count = least(T, b->below - p * T);
        double y[T * 16] = {0};

        fetch_rows(width, b, p + 1, x, top);
        for (int64_t i = 0; i < count; i++) {
            const int32_t row = b->row[p * T + i];

            memcpy(y + i * width, (row >= 0 ? x : top) + index_of(width, row),
                   (size_t)width * sizeof *y);
        }
        add_transposed(width, b->panel + p * T * b->cols, b->cols, y, z);
    }
}

/* |x| of each number, by clearing its sign bit. */
INLINE vector magnitudes(vector x)
{
    return (vector)((integers)x & INT64_MAX);
}

INLINE void symmetric(const int64_t width, int64_t from, int64_t to,
                      const ritz_sparse *A, const double *X, double *Y)
{
    enum { VECTORS = 16 / LANES };
    const int64_t vectors = width / LANES;

    for (int64_t i = from; i < to; i++, Y += width) {
        vector sum[VECTORS] = {0};

        for (int64_t p = A->colptr[i]; p < A->colptr[i + 1]; p++)
            for (int64_t v = 0; v < vectors; v++)
                sum[v] +=
                    A->val[p] *
                    *(const vector *)(X + width * A->rowind[p] + v * LANES);
        for (int64_t v = 0; v < vectors; v++)
            *(vector *)(Y + v * LANES) = sum[v];
    }
}

INLINE void terms(const int64_t width, int64_t from, int64_t to,
                  const ritz_sparse *A, const double *X, double *Y, double *S)
{
    enum { VECTORS = 16 / LANES };
    const int64_t vectors = width / LANES;

    for (int64_t i = from; i < to; i++, Y += width, S += width) {
        vector sum[VECTORS] = {0}, size[VECTORS] = {0};

        for (int64_t p = A->colptr[i]; p < A->colptr[i + 1]; p++)
            for (int64_t v = 0; v < vectors; v++) {
                const vector part =
                    A->val[p] *
                    *(const vector *)(X + width * A->rowind[p] + v * LANES);

                sum[v] += part;
                size[v] += magnitudes(part);
            }
        for (int64_t v = 0; v < vectors; v++) {
            *(vector *)(Y + v * LANES) = sum[v];
            *(vector *)(S + v * LANES) = size[v];
        }
    }
}

/* The functions of one width. */
#define WIDTH(p)                                                               \
    static void lower_##p(const ritz_block_column *b, const double *x,         \
                          double *z)                                           \
    {                                                                          \
        lower(p, b, x, z);                                                     \
    }                                                                          \
    static void upper_##p(const ritz_block_column *b, const double *x,         \
                          double *z)                                           \
    {                                                                          \
        upper(p, b, x, z);                                                     \
    }                                                                          \
    static void scatter_##p(const ritz_block_column *b, int64_t from,          \
                            int64_t to, const double *z, double *x,            \
                            double *top)                                       \
    {                                                                          \
        scatter(p, b, from, to, z, x, top);                                    \
    }                                                                          \
    static void gather_##p(const ritz_block_column *b, int64_t from,           \
                           int64_t to, const double *x, const double *top,     \
                           double *z)                                          \
    {                                                                          \
        gather(p, b, from, to, x, top, z);                                     \
    }                                                                          \
    static void symmetric_##p(int64_t from, int64_t to, const ritz_sparse *A,  \
                              const double *X, double *Y)                      \
    {                                                                          \
        symmetric(p, from, to, A, X, Y);                                       \
    }                                                                          \
    static void terms_##p(int64_t from, int64_t to, const ritz_sparse *A,      \
                          const double *X, double *Y, double *S)               \
    {                                                                          \
        terms(p, from, to, A, X, Y, S);                                        \
    }

WIDTH(8)
WIDTH(16)

static void inner_8(int64_t rows, const double *A, const double *X, double *C)
{
    multiply_panel(T, A, rows, X, C);
}

static void outer_8(int64_t rows, const double *A, const double *C, double *X)
{
    add_transposed(T, A, rows, C, X);
}

static void times_8(int64_t from, int64_t to, const int64_t *start,
                    const int32_t *col, const double *val, const double *X,
                    double *Y)
{
    for (int64_t i = from; i < to; i++) {
        vector sum[T / LANES] = {0};

        for (int64_t k = start[i]; k < start[i + 1]; k++)
            for (int64_t v = 0; v < T / LANES; v++)
                sum[v] += val[k] * *(const vector *)(X + T * (int64_t)col[k] +
                                                     v * LANES);
        for (int64_t v = 0; v < T / LANES; v++)
            *(vector *)(Y + T * i + v * LANES) = sum[v];
    }
}

static void spread_8(const ritz_sparse *A, const double *X, double *Y)
{
    for (int64_t j = 0; j < A->ncol; j++) {
        vector x[T / LANES];

        for (int64_t v = 0; v < T / LANES; v++)
            x[v] = *(const vector *)(X + T * j + v * LANES);
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            for (int64_t v = 0; v < T / LANES; v++)
                *(vector *)(Y + T * A->rowind[p] + v * LANES) +=
                    A->val[p] * x[v];
    }
}

#define TILES(lanes, bits)                                                     \
    const ritz_tiles ritz_tiles_##lanes = {                                    \
        .name = #bits " bit",                                                  \
        .of = {{8, lower_8, upper_8, scatter_8, gather_8, symmetric_8,         \
                terms_8},                                                      \
               {16, lower_16, upper_16, scatter_16, gather_16, symmetric_16,   \
                terms_16}},                                                    \
        .inner = inner_8,                                                      \
        .outer = outer_8,                                                      \
        .times = times_8,                                                      \
        .spread = spread_8,                                                    \
        .twofold = ritz_twofold_##lanes,                                       \
    };
