#include "linear/blocks.h"

#include "base/alloc.h"
#include "base/team.h"

#include <math.h>
#include <string.h>

enum {
    B = RITZ_BLOCK,
    SQUARE = RITZ_SQUARE,
    CHUNK = 128, /* rows of all blocks at a time, which stay in the cache */
};

ritz_status ritz_blocks_new(int64_t n, int threads, int64_t most,
                            ritz_blocks *out)
{
    RITZ_CHECK_NEW(out->sums, threads * most * SQUARE);
    out->n = n;
    out->threads = threads;
    out->tiles = ritz_tiles_here();
    out->most = most;
    return RITZ_OK;
}

void ritz_blocks_free(ritz_blocks *on)
{
    RITZ_FREE(on->sums);
    *on = (ritz_blocks){0};
}

ritz_status ritz_row_matrix_new(const ritz_sparse *A, const int64_t *order,
                                ritz_row_matrix *out)
{
    const int64_t n = A->ncol;
    RITZ_OWN(ritz_row_matrix) R = {.n = n};
    RITZ_OWN_ARRAY int32_t *place = NULL;
    int64_t count = 0;

    RITZ_CHECK_NEW(place, n);
    for (int64_t k = 0; k < n; k++)
        place[order[k]] = (int32_t)k;
    for (int64_t p = 0; p < A->colptr[n]; p++)
        count += A->val[p] != 0.0;
    RITZ_CHECK_NEW(R.start, n + 1);
    RITZ_CHECK_NEW(R.col, count);
    RITZ_CHECK_NEW(R.val, count);
    count = 0;
    for (int64_t k = 0; k < n; k++) {
        const int64_t j = order[k]; /* a column is a row: A is symmetric */

        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            if (A->val[p] == 0.0)
                continue;
            R.col[count] = place[A->rowind[p]];
            R.val[count++] = A->val[p];
        }
        R.start[k + 1] = count;
    }
    RITZ_MOVE(*out, R);
    return RITZ_OK;
}

ritz_status ritz_row_matrix_restore(const ritz_row_matrix *R,
                                    const int64_t *order, ritz_sparse *A)
{
    RITZ_OWN(ritz_sparse) copy = {0};

    RITZ_CHECK(ritz_sparse_new(R->n, R->n, R->start[R->n], &copy));
    for (int64_t k = 0; k < R->n; k++) /* row k is column order[k] */
        copy.colptr[order[k] + 1] = R->start[k + 1] - R->start[k];
    for (int64_t j = 0; j < R->n; j++)
        copy.colptr[j + 1] += copy.colptr[j];
    for (int64_t k = 0; k < R->n; k++) {
        int64_t at = copy.colptr[order[k]];

        for (int64_t p = R->start[k]; p < R->start[k + 1]; p++, at++) {
            copy.rowind[at] = order[R->col[p]];
            copy.val[at] = R->val[p];
        }
    }
    RITZ_MOVE(*A, copy);
    return RITZ_OK;
}

void ritz_row_matrix_free(ritz_row_matrix *A)
{
    RITZ_FREE(A->start, A->col, A->val);
    *A = (ritz_row_matrix){0};
}

double ritz_row_matrix_terms(const ritz_row_matrix *A, const double *X, int j)
{
    double sum = 0.0;

    for (int64_t i = 0; i < A->n; i++)
        for (int64_t p = A->start[i]; p < A->start[i + 1]; p++)
            sum +=
                fabs(X[i * B + j] * A->val[p] * X[(int64_t)A->col[p] * B + j]);
    return sum;
}

/* --- products of blocks --------------------------------------------------- */

/* The operands of one product; those that it does not have are NULL. */
typedef struct block_task {
    const ritz_blocks *on;
    const ritz_row_matrix *A;
    int64_t count, width, kept, stride;
    double *const *V; /* blocks of a basis */
    const double *X, *Y, *C;
    double *to, *room;
} block_task;

/* Row @p r of the p-th of several blocks that lie one after the other. */
static int64_t at_row(const ritz_blocks *on, int64_t p, int64_t r)
{
    return (p * on->n + r) * B;
}

static int64_t rows_of_chunk(int64_t r, int64_t to)
{
    return to - r < CHUNK ? to - r : CHUNK;
}

/* The sums of a thread. */
static double *sums_of(const ritz_blocks *on, int thread)
{
    return on->sums + thread * on->most * SQUARE;
}

/* to := the sums of all threads, added in their order. */
static void add_sums(const ritz_blocks *on, int64_t count, double *to)
{
    for (int64_t i = 0; i < count * SQUARE; i++) {
        to[i] = 0.0;
        for (int t = 0; t < on->threads; t++)
            to[i] += sums_of(on, t)[i];
    }
}

static void multiply_rows(int thread, int64_t from, int64_t to, void *task)
{
    const block_task *t = task;
    const ritz_row_matrix *A = t->A;

    (void)thread;
    t->on->tiles->times(from, to, A->start, A->col, A->val, t->X, t->to);
}

void ritz_blocks_multiply(const ritz_blocks *on, const ritz_row_matrix *A,
                          const double *X, double *Y)
{
    ritz_team_over(on->threads, on->n, multiply_rows,
                   &(block_task){.on = on, .A = A, .X = X, .to = Y});
}

static void project_rows(int thread, int64_t from, int64_t to, void *task)
{
    const block_task *t = task;
    double *C = sums_of(t->on, thread);

    memset(C, 0, (size_t)(t->width * t->count * SQUARE) * sizeof *C);
    for (int64_t r = from; r < to; r += CHUNK)
        for (int64_t k = 0; k < t->count * t->width; k++) {
            const int64_t p = k / t->width;
            const int64_t q = k % t->width;
            double *sum = C + (q * t->count + p) * SQUARE;
            double part[SQUARE];

            t->on->tiles->inner(rows_of_chunk(r, to), t->V[p] + r * B,
                                t->X + at_row(t->on, q, r), part);
            for (int i = 0; i < SQUARE; i++)
                sum[i] += part[i];
        }
}

void ritz_blocks_project(const ritz_blocks *on, int64_t count, double *const *V,
                         int64_t width, const double *X, double *C)
{
    ritz_team_over(
        on->threads, on->n, project_rows,
        &(block_task){
            .on = on, .count = count, .width = width, .V = V, .X = X});
    add_sums(on, width * count, C);
}

static void add_rows(int thread, int64_t from, int64_t to, void *task)
{
    const block_task *t = task;

    (void)thread;
    for (int64_t r = from; r < to; r += CHUNK)
        for (int64_t k = 0; k < t->count * t->width; k++) {
            const int64_t p = k / t->width;
            const int64_t q = k % t->width;

            t->on->tiles->outer(rows_of_chunk(r, to), t->V[p] + r * B,
                                t->C + (q * t->count + p) * SQUARE,
                                t->to + at_row(t->on, q, r));
        }
}

void ritz_blocks_add(const ritz_blocks *on, int64_t count, double *const *V,
                     int64_t width, const double *C, double *X)
{
    ritz_team_over(
        on->threads, on->n, add_rows,
        &(block_task){
            .on = on, .count = count, .width = width, .V = V, .C = C, .to = X});
}

static void transform_rows(int thread, int64_t from, int64_t to, void *task)
{
    const block_task *t = task;

    (void)thread;
    for (int64_t r = from; r < to; r += CHUNK) {
        const int64_t rows = rows_of_chunk(r, to);
        const size_t size = (size_t)(rows * B) * sizeof(double);
        double X[CHUNK * B];

        memcpy(X, t->to + r * B, size);
        memset(t->to + r * B, 0, size);
        t->on->tiles->outer(rows, X, t->C, t->to + r * B);
    }
}

void ritz_blocks_transform(const ritz_blocks *on, const double *C, double *X)
{
    ritz_team_over(on->threads, on->n, transform_rows,
                   &(block_task){.on = on, .C = C, .to = X});
}

static void inner_rows(int thread, int64_t from, int64_t to, void *task)
{
    const block_task *t = task;

    t->on->tiles->inner(to - from, t->X + from * B, t->Y + from * B,
                        sums_of(t->on, thread));
}

void ritz_blocks_inner(const ritz_blocks *on, const double *X, const double *Y,
                       double *G)
{
    ritz_team_over(on->threads, on->n, inner_rows,
                   &(block_task){.on = on, .X = X, .Y = Y});
    add_sums(on, 1, G);
}

static void combine_rows(int thread, int64_t from, int64_t to, void *task)
{
    const block_task *t = task;
    const int64_t piece = (int64_t)CHUNK * B;
    double *Y = t->room + thread * t->kept * piece;

    for (int64_t r = from; r < to; r += CHUNK) {
        const int64_t rows = rows_of_chunk(r, to);

        memset(Y, 0, (size_t)(t->kept * piece) * sizeof *Y);
        for (int64_t g = 0; g < t->kept; g++)
            for (int64_t p = 0; p < t->count; p++)
                t->on->tiles->outer(rows, t->V[p] + r * B,
                                    t->C + g * t->stride + p * SQUARE,
                                    Y + g * piece);
        for (int64_t g = 0; g < t->kept; g++)
            memcpy(t->V[g] + r * B, Y + g * piece,
                   (size_t)(rows * B) * sizeof *Y);
    }
}

void ritz_blocks_combine(const ritz_blocks *on, int64_t count, int64_t kept,
                         int64_t stride, const double *C, double *room,
                         double *const *V)
{
    ritz_team_over(on->threads, on->n, combine_rows,
                   &(block_task){.on = on,
                                 .count = count,
                                 .kept = kept,
                                 .stride = stride,
                                 .C = C,
                                 .V = V,
                                 .room = room});
}

int64_t ritz_blocks_room(const ritz_blocks *on, int64_t kept)
{
    return on->threads * kept * CHUNK * B;
}

/* --- single vectors ------------------------------------------------------- */

double ritz_columns_inner(int64_t n, const double *X, int j, const double *Y,
                          int k)
{
    double sum = 0.0;

    for (int64_t i = 0; i < n; i++)
        sum += X[i * B + j] * Y[i * B + k];
    return sum;
}

void ritz_columns_add(int64_t n, double a, int k, int j, double *X)
{
    for (int64_t i = 0; i < n; i++)
        X[i * B + j] += a * X[i * B + k];
}

void ritz_columns_scale(int64_t n, double a, int j, double *X)
{
    for (int64_t i = 0; i < n; i++)
        X[i * B + j] *= a;
}

/* --- small matrices ------------------------------------------------------- */

bool ritz_square_factor(const double *G, double *R, double least)
{
    memset(R, 0, SQUARE * sizeof *R);
    for (int j = 0; j < B; j++)
        for (int i = 0; i <= j; i++) {
            double sum = 0.5 * (G[i * B + j] + G[j * B + i]);

            for (int k = 0; k < i; k++)
                sum -= R[k * B + i] * R[k * B + j];
            if (i == j && !(sum > least * G[j * B + j]))
                return false;
            R[i * B + j] = i == j ? sqrt(sum) : sum / R[i * B + i];
        }
    return true;
}

void ritz_square_invert(const double *R, double *U)
{
    memset(U, 0, SQUARE * sizeof *U);
    for (int j = 0; j < B; j++) {
        U[j * B + j] = 1.0 / R[j * B + j];
        for (int i = j - 1; i >= 0; i--) {
            double sum = 0.0;

            for (int k = i + 1; k <= j; k++)
                sum += R[i * B + k] * U[k * B + j];
            U[i * B + j] = -sum / R[i * B + i];
        }
    }
}

void ritz_square_multiply(const double *Q, double *R)
{
    double P[SQUARE] = {0};

    for (int i = 0; i < B; i++)
        for (int k = 0; k < B; k++)
            for (int j = 0; j < B; j++)
                P[i * B + j] += Q[i * B + k] * R[k * B + j];
    memcpy(R, P, sizeof P);
}

double ritz_square_size(const double *C)
{
    double sum = 0.0;

    for (int i = 0; i < SQUARE; i++)
        sum += C[i] * C[i];
    return sqrt(sum);
}
