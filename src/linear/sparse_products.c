/* Products of sparse matrices with dense and with sparse matrices, and
 * projections T'A T. */
#include "base/alloc.h"
#include "base/team.h"
#include "linear/blas_threads.h"
#include "linear/tall.h"
#include "linear/tiles.h"

#include <ritz/matrix.h>

#include <cblas.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum {
    EIGHT = RITZ_TILE, /* columns of a product at a time */
    WIDE = 4 * EIGHT,  /* columns of L'A T at a time: A T is never held whole */
    ROWS = 32,         /* rows of magnitudes at a time */
    WORTHWHILE = 50000, /* entries of A from which several threads are used */
};

/* The product Y = A X, eight columns at a time, so that A is read once for every
   eight. */
typedef struct columns_task {
    const ritz_sparse *A;
    const ritz_dense *X;
    ritz_dense *Y;
    bool twofold; /* with twice the digits */
    int64_t per_thread;
    double *room; /* each thread's eight columns of X, of Y and, if twofold, of
                     the rounding errors of Y, row by row */
} columns_task;

/* y := A x for eight columns, row by row. `low` is room for the rounding errors
   of y, used if the product is twofold. */
static void multiply_eight(const columns_task *t, const double *x, double *y,
                           double *low)
{
    const int64_t size = t->A->nrow * EIGHT;

    memset(y, 0, (size_t)size * sizeof *y);
    if (!t->twofold) {
        ritz_tiles_here()->spread(t->A, x, y);
        return;
    }
    memset(low, 0, (size_t)size * sizeof *low);
    ritz_tiles_here()->twofold(t->A, x, y, low);
    for (int64_t i = 0; i < size; i++)
        y[i] += low[i];
}

static void multiply_groups(int thread, int threads, void *task)
{
    const columns_task *t = task;
    const ritz_sparse *A = t->A;
    double *x = t->room + thread * t->per_thread;
    double *y = x + A->ncol * EIGHT;

    for (int64_t k = (int64_t)thread * EIGHT; k < t->X->ncol;
         k += (int64_t)threads * EIGHT) {
        const int64_t left = t->X->ncol - k;
        const int64_t count = left < EIGHT ? left : EIGHT;

        for (int64_t i = 0; i < A->ncol; i++)
            for (int64_t c = 0; c < EIGHT; c++)
                x[i * EIGHT + c] =
                    c < count ? t->X->val[i + (k + c) * A->ncol] : 0.0;
        multiply_eight(t, x, y, y + A->nrow * EIGHT);
        for (int64_t i = 0; i < A->nrow; i++)
            for (int64_t c = 0; c < count; c++)
                t->Y->val[i + (k + c) * A->nrow] = y[i * EIGHT + c];
    }
}

/* Y := A X by several threads, eight columns at a time. */
static ritz_status multiply_columns(const ritz_sparse *A, const ritz_dense *X,
                                    bool twofold, ritz_dense *Y)
{
    const int64_t size = (A->ncol + (twofold ? 2 : 1) * A->nrow) * EIGHT;
    const int64_t groups = (X->ncol + EIGHT - 1) / EIGHT;
    const bool large = A->colptr[A->ncol] >= WORTHWHILE;
    const int threads = ritz_team_ready(large ? groups : 1);
    RITZ_OWN_ARRAY double *room = NULL;

    RITZ_CHECK_RAW(room, threads * size);
    ritz_team_run(threads, multiply_groups,
                  &(columns_task){A, X, Y, twofold, size, room});
    return RITZ_OK;
}

/* Y := A X, one column after the other. */
static void multiply_few(const ritz_sparse *A, const ritz_dense *X,
                         ritz_dense *Y)
{
    for (int64_t k = 0; k < X->ncol; k++) {
        const double *x = ritz_dense_col(X, k);
        double *y = ritz_dense_col(Y, k);

        for (int64_t j = 0; j < A->ncol; j++)
            for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
                y[A->rowind[p]] += A->val[p] * x[j];
    }
}

static ritz_status multiply(const ritz_sparse *A, const ritz_dense *X,
                            bool twofold, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) Y = {0};

    RITZ_REFUSE_IF(A->ncol != X->nrow, RITZ_ERR_ARGUMENT,
                   "A has %" PRId64 " columns but X has %" PRId64 " rows",
                   A->ncol, X->nrow);
    if (twofold || X->ncol >= EIGHT / 2) {
        RITZ_CHECK(ritz_tall_new(A->nrow, X->ncol, &Y));
        RITZ_CHECK(multiply_columns(A, X, twofold, &Y));
    } else {
        RITZ_CHECK(ritz_dense_new(A->nrow, X->ncol, &Y));
        multiply_few(A, X, &Y);
    }
    RITZ_MOVE(*out, Y);
    return RITZ_OK;
}

ritz_status ritz_sparse_mul(const ritz_sparse *A, const ritz_dense *X,
                            ritz_dense *Y)
{
    return multiply(A, X, false, Y);
}

ritz_status ritz_sparse_mul_twofold(const ritz_sparse *A, const ritz_dense *X,
                                    ritz_dense *Y)
{
    return multiply(A, X, true, Y);
}

/* The number of entries of A B. mark[i] is the last column + 1 in which row i was
   counted. */
static int64_t count_product(const ritz_sparse *A, const ritz_sparse *B,
                             int64_t *mark)
{
    int64_t count = 0;

    for (int64_t j = 0; j < B->ncol; j++)
        for (int64_t q = B->colptr[j]; q < B->colptr[j + 1]; q++) {
            int64_t k = B->rowind[q];

            for (int64_t p = A->colptr[k]; p < A->colptr[k + 1]; p++)
                if (mark[A->rowind[p]] != j + 1) {
                    mark[A->rowind[p]] = j + 1;
                    count++;
                }
        }
    return count;
}

/* Append column j of A B to C, its rows in no order. place[i] is one more than
   the index in C of the last entry of row i. */
static void multiply_column(const ritz_sparse *A, const ritz_sparse *B,
                            int64_t j, int64_t *place, ritz_sparse *C)
{
    int64_t first = C->colptr[j];
    int64_t at = first;

    for (int64_t q = B->colptr[j]; q < B->colptr[j + 1]; q++) {
        int64_t k = B->rowind[q];

        for (int64_t p = A->colptr[k]; p < A->colptr[k + 1]; p++) {
            int64_t i = A->rowind[p];

            if (place[i] <= first) { /* not yet in this column */
                C->rowind[at] = i;
                C->val[at] = 0.0;
                place[i] = ++at;
            }
            C->val[place[i] - 1] += A->val[p] * B->val[q];
        }
    }
    C->colptr[j + 1] = at;
}

ritz_status ritz_sparse_product(const ritz_sparse *A, const ritz_sparse *B,
                                ritz_sparse *C)
{
    RITZ_OWN(ritz_sparse) raw = {0}, turned = {0};
    RITZ_OWN_ARRAY int64_t *mark = NULL;
    RITZ_OWN_ARRAY int64_t *place = NULL;

    RITZ_REFUSE_IF(A->ncol != B->nrow, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " columns meet %" PRId64 " rows", A->ncol,
                   B->nrow);
    RITZ_CHECK_NEW(mark, A->nrow);
    RITZ_CHECK_NEW(place, A->nrow);
    RITZ_CHECK(
        ritz_sparse_new(A->nrow, B->ncol, count_product(A, B, mark), &raw));
    for (int64_t j = 0; j < B->ncol; j++)
        multiply_column(A, B, j, place, &raw);
    /* two transpositions sort the rows of each column */
    RITZ_CHECK(ritz_sparse_transpose(&raw, &turned));
    return ritz_sparse_transpose(&turned, C);
}

ritz_status ritz_sparse_congruence(const ritz_sparse *A, const ritz_sparse *T,
                                   ritz_sparse *out)
{
    RITZ_OWN(ritz_sparse) AT = {0}, turned = {0}, C = {0};

    RITZ_CHECK(ritz_sparse_product(A, T, &AT));
    RITZ_CHECK(ritz_sparse_transpose(T, &turned));
    RITZ_CHECK(ritz_sparse_product(&turned, &AT, &C));
    if (ritz_sparse_asymmetry(A) == 0.0)
        RITZ_CHECK(ritz_sparse_symmetrise(&C));
    RITZ_MOVE(*out, C);
    return RITZ_OK;
}

ritz_status ritz_sparse_between(const ritz_dense *L, const ritz_sparse *A,
                                const ritz_dense *T, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) product = {0};

    RITZ_CHECK(ritz_dense_new(L->ncol, T->ncol, &product));
    for (int64_t j = 0; j < T->ncol; j += WIDE) {
        const int64_t left = T->ncol - j;
        const ritz_dense some =
            ritz_dense_part(T, j, left < WIDE ? left : WIDE);
        RITZ_OWN(ritz_dense) AT = {0}, LAT = {0};

        RITZ_CHECK(ritz_sparse_mul(A, &some, &AT));
        RITZ_CHECK(ritz_dense_mul_tn(L, &AT, &LAT));
        ritz_dense_put(&LAT, 0, j, &product);
    }
    RITZ_MOVE(*out, product);
    return RITZ_OK;
}

/* T'A T; out stays empty if A is empty. */
static ritz_status project_matrix(const ritz_sparse *A, const ritz_dense *T,
                                  ritz_dense *out)
{
    return A->colptr ? ritz_sparse_between(T, A, T, out) : RITZ_OK;
}

ritz_status ritz_sparse_project(const ritz_sparse *A, const ritz_dense *T,
                                ritz_dense *out)
{
    RITZ_OWN_ARRAY int64_t *next = NULL;

    if (!A->colptr)
        return RITZ_OK;
    RITZ_CHECK_NEW(next, A->ncol);
    RITZ_CHECK(project_matrix(A, T, out));
    if (ritz_sparse_sweep_asymmetry(A, next) == 0.0)
        ritz_dense_symmetrise(out);
    return RITZ_OK;
}

ritz_status ritz_sparse_condense(const ritz_sparse *A, const ritz_dense *T,
                                 ritz_dense *out)
{
    RITZ_CHECK(project_matrix(A, T, out));
    ritz_dense_symmetrise(out);
    return RITZ_OK;
}

/* A X and |A||X|, eight columns at a time; the one that is not wanted is NULL. */
typedef struct sizes_task {
    const ritz_sparse *A;
    const ritz_dense *X;
    ritz_dense *AX, *size;
    double *room; /* each thread's eight columns of X, row by row */
} sizes_task;

/* Rows of eight columns become rows of columns k, k + 1, ... of to. */
static void put_rows(int64_t rows, int64_t count, const double *y, int64_t row,
                     int64_t k, ritz_dense *to)
{
    for (int64_t c = 0; to && c < count; c++)
        for (int64_t i = 0; i < rows; i++)
            ritz_dense_col(to, k + c)[row + i] = y[i * EIGHT + c];
}

static void multiply_sizes(int thread, int threads, void *task)
{
    const sizes_task *t = task;
    const int64_t n = t->A->ncol;
    double *x = t->room + thread * n * EIGHT;

    for (int64_t k = (int64_t)thread * EIGHT; k < t->X->ncol;
         k += (int64_t)threads * EIGHT) {
        const int64_t left = t->X->ncol - k;
        const int64_t count = left < EIGHT ? left : EIGHT;
        double y[ROWS * EIGHT], size[ROWS * EIGHT];

        for (int64_t i = 0; i < n; i++)
            for (int64_t c = 0; c < EIGHT; c++)
                x[i * EIGHT + c] = c < count ? t->X->val[i + (k + c) * n] : 0.0;
        for (int64_t r = 0; r < n; r += ROWS) {
            const int64_t rows = n - r < ROWS ? n - r : ROWS;

            ritz_tiles_here()->of[0].terms(r, r + rows, t->A, x, y, size);
            put_rows(rows, count, y, r, k, t->AX);
            put_rows(rows, count, size, r, k, t->size);
        }
    }
}

ritz_status ritz_sparse_mul_sizes(const ritz_sparse *A, const ritz_dense *X,
                                  ritz_dense *AX, ritz_dense *size)
{
    const int64_t groups = (X->ncol + EIGHT - 1) / EIGHT;
    const bool large = A->colptr[A->ncol] >= WORTHWHILE;
    const int threads = ritz_team_ready(large ? groups : 1);
    RITZ_OWN(ritz_dense) product = {0}, sizes = {0};
    RITZ_OWN_ARRAY double *room = NULL;

    RITZ_CHECK_RAW(room, threads * A->ncol * EIGHT);
    if (AX)
        RITZ_CHECK(ritz_tall_new(X->nrow, X->ncol, &product));
    RITZ_CHECK(ritz_tall_new(X->nrow, X->ncol, &sizes));
    ritz_team_run(threads, multiply_sizes,
                  &(sizes_task){A, X, AX ? &product : NULL, &sizes, room});
    if (AX)
        RITZ_MOVE(*AX, product);
    RITZ_MOVE(*size, sizes);
    return RITZ_OK;
}

enum { PANEL = 1024 }; /* rows of |T| at a time */

/* C += |T|'S */
typedef struct magnitudes_task {
    const ritz_dense *T, *S;
    ritz_dense *C;
    double *room; /* PANEL rows of |T| */
} magnitudes_task;

/* Rows [from, to) of C, which are columns of T. */
static void add_magnitudes(int thread, int64_t from, int64_t to, void *task)
{
    const magnitudes_task *t = task;
    const int64_t n = t->T->nrow;
    double *rows = t->room + PANEL * from;

    (void)thread;
    for (int64_t r = 0; r < n && from < to; r += PANEL) {
        const int64_t count = n - r < PANEL ? n - r : PANEL;

        for (int64_t j = from; j < to; j++)
            for (int64_t i = 0; i < count; i++)
                rows[(j - from) * count + i] =
                    fabs(ritz_dense_col(t->T, j)[r + i]);
        cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, (int)(to - from),
                    (int)t->S->ncol, (int)count, 1.0, rows, (int)count,
                    t->S->val + r, (int)n, 1.0, t->C->val + from,
                    (int)t->C->nrow);
    }
}

ritz_status ritz_sparse_terms(const ritz_sparse *A, const ritz_dense *T,
                              int64_t count, const int64_t *at, ritz_dense *out)
{
    const int threads = ritz_team_ready(1 + T->nrow * T->ncol / WORTHWHILE);
    [[maybe_unused]] RITZ_OWN(ritz_blas_single) single = ritz_blas_single_new();
    RITZ_OWN(ritz_dense) terms = {0};
    RITZ_OWN_ARRAY double *room = NULL;

    RITZ_CHECK(ritz_dense_new(T->ncol, count, &terms));
    RITZ_CHECK_NEW(room, PANEL * T->ncol);
    for (int64_t j = 0; j < count; j += WIDE) {
        const int64_t some = count - j < WIDE ? count - j : WIDE;
        ritz_dense part = ritz_dense_part(&terms, j, some);
        RITZ_OWN(ritz_dense) X = {0}, size = {0};

        if (at)
            RITZ_CHECK(ritz_dense_pick(T, some, at + j, &X));
        else
            RITZ_CHECK(ritz_dense_columns(T, j, some, &X));
        RITZ_CHECK(ritz_sparse_mul_sizes(A, &X, NULL, &size));
        ritz_team_over(threads, T->ncol, add_magnitudes,
                       &(magnitudes_task){T, &size, &part, room});
    }
    RITZ_MOVE(*out, terms);
    return RITZ_OK;
}
