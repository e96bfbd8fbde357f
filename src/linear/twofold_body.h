/*
 * The kernel `twofold` of tiles.h. twofold_2.c, twofold_4.c and twofold_8.c
 * define LANES and include this file. Each is compiled for the same processors
 * as tiles_2.c, tiles_4.c and tiles_8.c, but the compiler must not fuse products
 * with sums, as rounding errors would be lost. All three give the same bits.
 */
#include "linear/tiles.h"

#ifdef __FMA__
#include <immintrin.h>
#endif

#define INLINE static inline __attribute__((always_inline))

typedef double vector
    __attribute__((vector_size(8 * LANES), aligned(8), may_alias));

/* The rounding error of product = fl(a x). */
#if defined __FMA__ && LANES == 8
INLINE vector error_of(vector a, vector x, vector product)
{
    return (vector)_mm512_fmsub_pd((__m512d)a, (__m512d)x, (__m512d)product);
}
#elif defined __FMA__ && LANES == 4
INLINE vector error_of(vector a, vector x, vector product)
{
    return (vector)_mm256_fmsub_pd((__m256d)a, (__m256d)x, (__m256d)product);
}
#else
/* The leading 26 bits of x. */
INLINE vector leading(vector x)
{
    const vector far = 0x1.0000002p27 * x;

    return far - (far - x);
}

/* By products of halves, which are exact [Dekker1971]. */
INLINE vector error_of(vector a, vector x, vector product)
{
    const vector a1 = leading(a), x1 = leading(x);
    const vector a2 = a - a1, x2 = x - x1;

    return a2 * x2 - (((product - a1 * x1) - a2 * x1) - a1 * x2);
}
#endif

/* y + low := y + low + a x with a rounding error of the order of eps^2: `low`
   collects the rounding errors of y [OgitaRumpOishi2005]. */
INLINE void add_product(vector a, vector x, vector *y, vector *low)
{
    const vector product = a * x;
    const vector sum = *y + product;
    const vector part = sum - *y;

    *low += error_of(a, x, product) + (*y - (sum - part)) + (product - part);
    *y = sum;
}

INLINE void add_twofold(const ritz_sparse *A, const double *X, double *Y,
                        double *low)
{
    enum { T = RITZ_TILE };

    for (int64_t j = 0; j < A->ncol; j++) {
        vector x[T / LANES];

        for (int64_t v = 0; v < T / LANES; v++)
            x[v] = *(const vector *)(X + T * j + v * LANES);
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const vector a = (vector){0} + A->val[p];
            const int64_t row = T * A->rowind[p];

            for (int64_t v = 0; v < T / LANES; v++)
                add_product(a, x[v], (vector *)(Y + row + v * LANES),
                            (vector *)(low + row + v * LANES));
        }
    }
}
