#include "linear/tall.h"

#include "base/alloc.h"
#include "base/team.h"
#include "linear/blas_threads.h"
#include "linear/tiles.h"

#include <cblas.h>
#include <limits.h>
#include <math.h>
#include <string.h>

enum {
    EIGHT = RITZ_TILE,
    WIDEST = 2 * EIGHT,  /* columns of W X at a time */
    WORTHWHILE = 100000, /* multiplications for each thread */
    ENTRIES = 25000,     /* of W for each thread */
    ROWS = 32,           /* rows of W X at a time */
};

ritz_status ritz_tall_new(int64_t nrow, int64_t ncol, ritz_dense *out)
{
    RITZ_REFUSE_IF(nrow > INT_MAX || ncol > INT_MAX, RITZ_ERR_ARGUMENT,
                   "a dense matrix has too many rows or columns");
    RITZ_CHECK_RAW(out->val, nrow * ncol);
    out->nrow = nrow;
    out->ncol = ncol;
    return RITZ_OK;
}

/* The operands of one product. */
typedef struct tall_task {
    const ritz_dense *A, *B, *H;
    ritz_dense *to;
    double *sums; /* of each thread, column-major */
} tall_task;

/* Threads for a product of so many columns by so many. */
static int threads_for(const ritz_dense *A, int64_t columns)
{
    return ritz_team_ready(1 + A->nrow * A->ncol * columns / WORTHWHILE);
}

static void multiply_rows(int thread, int64_t from, int64_t to, void *task)
{
    const tall_task *t = task;
    const int m = (int)t->A->ncol, n = (int)t->B->ncol;
    double *sum = t->sums + (int64_t)thread * m * n;

    ritz_blas_single_here(thread);
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, m, n, (int)(to - from),
                1.0, t->A->val + from, (int)t->A->nrow, t->B->val + from,
                (int)t->B->nrow, 0.0, sum, m);
}

ritz_status ritz_tall_inner(const ritz_dense *A, const ritz_dense *B,
                            ritz_dense *out)
{
    [[maybe_unused]] RITZ_OWN(ritz_blas_single) single = ritz_blas_single_new();
    const int threads = threads_for(A, B->ncol);
    const int64_t size = A->ncol * B->ncol;
    RITZ_OWN(ritz_dense) G = {0};
    RITZ_OWN_ARRAY double *sums = NULL;

    RITZ_CHECK(ritz_dense_new(A->ncol, B->ncol, &G));
    RITZ_CHECK_NEW(sums, threads * size);
    if (A->nrow > 0 && size > 0)
        ritz_team_over(threads, A->nrow, multiply_rows,
                       &(tall_task){.A = A, .B = B, .sums = sums});
    for (int64_t k = 0; k < threads * size; k++)
        G.val[k % size] += sums[k];
    RITZ_MOVE(*out, G);
    return RITZ_OK;
}

static void add_dots(int thread, int64_t from, int64_t to, void *task)
{
    const tall_task *t = task;

    ritz_blas_single_here(thread);
    for (int64_t j = from; j < to; j++)
        t->sums[j] = ritz_dense_dot(t->A, j, t->B, j);
}

void ritz_tall_dots(const ritz_dense *A, const ritz_dense *B, double *size)
{
    [[maybe_unused]] RITZ_OWN(ritz_blas_single) single = ritz_blas_single_new();

    ritz_team_over(threads_for(A, 1), A->ncol, add_dots,
                   &(tall_task){.A = A, .B = B, .sums = size});
}

static void subtract_rows(int thread, int64_t from, int64_t to, void *task)
{
    const tall_task *t = task;
    ritz_dense *A = t->to;

    ritz_blas_single_here(thread);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, (int)(to - from),
                (int)A->ncol, (int)t->B->ncol, -1.0, t->B->val + from,
                (int)t->B->nrow, t->H->val, (int)t->H->nrow, 1.0, A->val + from,
                (int)A->nrow);
}

void ritz_tall_subtract(const ritz_dense *B, const ritz_dense *H, ritz_dense *A)
{
    [[maybe_unused]] RITZ_OWN(ritz_blas_single) single = ritz_blas_single_new();

    if (A->nrow > 0 && A->ncol > 0 && B->ncol > 0)
        ritz_team_over(threads_for(B, A->ncol), A->nrow, subtract_rows,
                       &(tall_task){.B = B, .H = H, .to = A});
}

ritz_status ritz_tall_take_out(const ritz_dense *left, const ritz_dense *right,
                               ritz_dense *X)
{
    RITZ_OWN(ritz_dense) H = {0};

    RITZ_CHECK(ritz_tall_inner(right, X, &H));
    ritz_tall_subtract(left, &H, X);
    return RITZ_OK;
}

static void divide_rows(int thread, int64_t from, int64_t to, void *task)
{
    const tall_task *t = task;
    ritz_dense *A = t->to;

    ritz_blas_single_here(thread);
    if (to > from)
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans,
                    CblasNonUnit, (int)(to - from), (int)A->ncol, 1.0,
                    t->H->val, (int)t->H->nrow, A->val + from, (int)A->nrow);
}

void ritz_tall_divide(const ritz_dense *L, ritz_dense *A)
{
    [[maybe_unused]] RITZ_OWN(ritz_blas_single) single = ritz_blas_single_new();

    if (A->nrow > 0 && A->ncol > 0)
        ritz_team_over(threads_for(A, A->ncol), A->nrow, divide_rows,
                       &(tall_task){.H = L, .to = A});
}

/* --- products with a symmetric sparse matrix ------------------------------ */

/* Columns [k, k + count) of W X, and of |V|'|W||X|. */
typedef struct weigh_task {
    const ritz_sparse *W;
    const ritz_dense *V, *X;
    ritz_dense *WX, *size;
    const ritz_tile_width *tile;
    int64_t k, count;
    double *x;    /* the columns of X, row by row */
    double *sums; /* WIDEST for each thread */
} weigh_task;

/* Columns of X, row by row, filled up to eight with columns of zeros. */
static void take_rows(int thread, int64_t from, int64_t to, void *task)
{
    const weigh_task *t = task;
    const int64_t n = t->X->nrow;
    const int64_t width = t->tile->width;
    const double *X = ritz_dense_col(t->X, t->k);

    (void)thread;
    for (int64_t i = from; i < to; i++)
        for (int64_t c = 0; c < width; c++)
            t->x[i * width + c] = c < t->count ? X[i + c * n] : 0.0;
}

/* Rows of a block become rows of columns k, k + 1, ... of Y. */
static void put_rows(const weigh_task *t, int64_t from, int64_t rows,
                     const double *y, const ritz_dense *Y)
{
    for (int64_t c = 0; c < t->count; c++) {
        double *to = ritz_dense_col(Y, t->k + c) + from;

        for (int64_t i = 0; i < rows; i++)
            to[i] = y[i * t->tile->width + c];
    }
}

static void weigh_rows(int thread, int64_t from, int64_t to, void *task)
{
    const weigh_task *t = task;

    (void)thread;
    for (int64_t r = from; r < to; r += ROWS) {
        const int64_t rows = to - r < ROWS ? to - r : ROWS;
        double y[ROWS * WIDEST];

        t->tile->symmetric(r, r + rows, t->W, t->x, y);
        put_rows(t, r, rows, y, t->WX);
    }
}

static void weigh_rows_sizes(int thread, int64_t from, int64_t to, void *task)
{
    const weigh_task *t = task;
    const int64_t width = t->tile->width;
    double *sum = t->sums + (int64_t)thread * WIDEST;

    memset(sum, 0, WIDEST * sizeof *sum);
    for (int64_t r = from; r < to; r += ROWS) {
        const int64_t rows = to - r < ROWS ? to - r : ROWS;
        double y[ROWS * WIDEST], s[ROWS * WIDEST];

        t->tile->terms(r, r + rows, t->W, t->x, y, s);
        for (int64_t c = 0; c < t->count; c++) {
            const double *v = ritz_dense_col(t->V, t->k + c) + r;

            for (int64_t i = 0; i < rows; i++)
                sum[c] += fabs(v[i]) * s[i * width + c];
        }
        if (t->WX)
            put_rows(t, r, rows, y, t->WX);
    }
}

static void weigh_rows_terms(int thread, int64_t from, int64_t to, void *task)
{
    const weigh_task *t = task;

    (void)thread;
    for (int64_t r = from; r < to; r += ROWS) {
        const int64_t rows = to - r < ROWS ? to - r : ROWS;
        double y[ROWS * WIDEST], s[ROWS * WIDEST];

        t->tile->terms(r, r + rows, t->W, t->x, y, s);
        put_rows(t, r, rows, y, t->WX);
        put_rows(t, r, rows, s, t->size);
    }
}

/* Rows of W x, of one column after the other. */
static void weigh_few(int thread, int64_t from, int64_t to, void *task)
{
    const weigh_task *t = task;
    const ritz_sparse *W = t->W;

    (void)thread;
    for (int64_t k = 0; k < t->X->ncol; k++) {
        const double *x = ritz_dense_col(t->X, k);
        double *y = ritz_dense_col(t->WX, k);

        for (int64_t i = from; i < to; i++) {
            double sum = 0.0;

            for (int64_t p = W->colptr[i]; p < W->colptr[i + 1]; p++)
                sum += W->val[p] * x[W->rowind[p]];
            y[i] = sum;
        }
    }
}

/* The next columns: as many as a kernel takes at a time. */
static bool next_columns(weigh_task *t)
{
    int64_t left = 0;

    t->k += t->count;
    left = t->X->ncol - t->k;
    t->tile = &ritz_tiles_here()->of[left > EIGHT ? 1 : 0];
    t->count = left < t->tile->width ? left : t->tile->width;
    return left > 0;
}

static int threads_for_sparse(const ritz_sparse *W)
{
    return ritz_team_ready(1 + W->colptr[W->ncol] / ENTRIES);
}

ritz_status ritz_tall_weigh(const ritz_sparse *W, const ritz_dense *X,
                            ritz_dense *Y)
{
    const int threads = W ? threads_for_sparse(W) : 1;
    weigh_task t = {.W = W, .X = X, .WX = Y};
    RITZ_OWN_ARRAY double *x = NULL;

    if (X->nrow * X->ncol == 0)
        return RITZ_OK;
    if (!W)
        memcpy(Y->val, X->val, (size_t)(X->nrow * X->ncol) * sizeof *X->val);
    else if (X->ncol < EIGHT / 2)
        ritz_team_over(threads, X->nrow, weigh_few, &t);
    if (!W || X->ncol < EIGHT / 2)
        return RITZ_OK;
    RITZ_CHECK_RAW(x, X->nrow * WIDEST);
    t.x = x;
    while (next_columns(&t)) {
        ritz_team_over(threads, X->nrow, take_rows, &t);
        ritz_team_over(threads, X->nrow, weigh_rows, &t);
    }
    return RITZ_OK;
}

ritz_status ritz_tall_weigh_terms(const ritz_sparse *W, const ritz_dense *X,
                                  ritz_dense *WX, ritz_dense *size)
{
    const int threads = threads_for_sparse(W);
    RITZ_OWN(ritz_dense) Y = {0}, S = {0};
    RITZ_OWN_ARRAY double *x = NULL;
    weigh_task t = {.W = W, .X = X, .WX = &Y, .size = &S};

    RITZ_CHECK(ritz_tall_new(X->nrow, X->ncol, &Y));
    RITZ_CHECK(ritz_tall_new(X->nrow, X->ncol, &S));
    RITZ_CHECK_RAW(x, X->nrow * WIDEST);
    t.x = x;
    while (next_columns(&t)) {
        ritz_team_over(threads, X->nrow, take_rows, &t);
        ritz_team_over(threads, X->nrow, weigh_rows_terms, &t);
    }
    RITZ_MOVE(*WX, Y);
    RITZ_MOVE(*size, S);
    return RITZ_OK;
}

/* size[j] := |v_j|'|x_j|, and a copy of X. */
static void copy_sizes(const ritz_dense *V, const ritz_dense *X, ritz_dense *WX,
                       double *size)
{
    for (int64_t j = 0; j < X->ncol; j++) {
        const double *v = ritz_dense_col(V, j);
        const double *x = ritz_dense_col(X, j);

        size[j] = 0.0;
        for (int64_t i = 0; i < X->nrow; i++)
            size[j] += fabs(v[i] * x[i]);
    }
    if (WX && X->nrow * X->ncol > 0)
        memcpy(WX->val, X->val, (size_t)(X->nrow * X->ncol) * sizeof *X->val);
}

ritz_status ritz_tall_weigh_sizes(const ritz_sparse *W, const ritz_dense *V,
                                  const ritz_dense *X, ritz_dense *WX,
                                  double *size)
{
    const int threads = W ? threads_for_sparse(W) : 1;
    weigh_task t = {.W = W, .V = V, .X = X, .WX = WX};
    RITZ_OWN_ARRAY double *x = NULL, *sums = NULL;

    if (!W) {
        copy_sizes(V, X, WX, size);
        return RITZ_OK;
    }
    RITZ_CHECK_RAW(x, X->nrow * WIDEST);
    RITZ_CHECK_RAW(sums, (int64_t)threads * WIDEST);
    t.x = x;
    t.sums = sums;
    while (next_columns(&t)) {
        ritz_team_over(threads, X->nrow, take_rows, &t);
        ritz_team_over(threads, X->nrow, weigh_rows_sizes, &t);
        for (int64_t c = 0; c < t.count; c++) {
            size[t.k + c] = 0.0;
            for (int i = 0; i < threads; i++)
                size[t.k + c] += sums[(int64_t)i * WIDEST + c];
        }
    }
    return RITZ_OK;
}
