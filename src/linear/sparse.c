/* Sparse matrices, their sums and products. */
#include "base/alloc.h"
#include "base/search.h"
#include "base/team.h"

#include <ritz/matrix.h>

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum {
    EIGHT = 8,          /* columns of a product at a time */
    WORTHWHILE = 50000, /* entries from which several threads are used */
};

ritz_status ritz_sparse_new(int64_t nrow, int64_t ncol, int64_t nnz,
                            ritz_sparse *out)
{
    RITZ_OWN(ritz_sparse) A = {.nrow = nrow, .ncol = ncol};

    RITZ_REFUSE_IF(nrow < 0 || ncol < 0 || nnz < 0, RITZ_ERR_ARGUMENT,
                   "a matrix cannot be %" PRId64 " x %" PRId64, nrow, ncol);
    RITZ_CHECK_NEW(A.colptr, ncol + 1);
    RITZ_CHECK_NEW(A.rowind, nnz);
    RITZ_CHECK_NEW(A.val, nnz);
    RITZ_MOVE(*out, A);
    return RITZ_OK;
}

/* Turn counts kept in start[1..n] into offsets start[0..n]. */
static void accumulate_counts(int64_t n, int64_t *start)
{
    for (int64_t j = 0; j < n; j++)
        start[j + 1] += start[j];
}

/* order = the entries sorted by row, stably: one pass of counting sort. */
static ritz_status sort_by_row(int64_t nrow, int64_t count, const int64_t *row,
                               int64_t *order)
{
    RITZ_OWN_ARRAY int64_t *start = NULL;

    RITZ_CHECK_NEW(start, nrow + 1);
    for (int64_t k = 0; k < count; k++)
        start[row[k] + 1]++;
    accumulate_counts(nrow, start);
    for (int64_t k = 0; k < count; k++)
        order[start[row[k]]++] = k;
    return RITZ_OK;
}

/* Close the gaps that summing left: column j holds entries up to end[j]. */
static void squeeze_zeros(ritz_sparse *A, const int64_t *end)
{
    int64_t kept = 0;

    for (int64_t j = 0; j < A->ncol; j++) {
        int64_t begin = A->colptr[j];

        A->colptr[j] = kept;
        for (int64_t p = begin; p < end[j]; p++, kept++) {
            A->rowind[kept] = A->rowind[p];
            A->val[kept] = A->val[p];
        }
    }
    A->colptr[A->ncol] = kept;
}

ritz_status ritz_sparse_from_triplets(int64_t nrow, int64_t ncol, int64_t count,
                                      const int64_t *row, const int64_t *col,
                                      const double *val, ritz_sparse *out)
{
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN_ARRAY int64_t *order = NULL;
    RITZ_OWN_ARRAY int64_t *end = NULL;

    for (int64_t k = 0; k < count; k++)
        RITZ_REFUSE_IF(row[k] < 0 || row[k] >= nrow || col[k] < 0 ||
                           col[k] >= ncol,
                       RITZ_ERR_ARGUMENT,
                       "entry (%" PRId64 ", %" PRId64
                       ") lies outside a %" PRId64 " x %" PRId64 " matrix",
                       row[k], col[k], nrow, ncol);

    RITZ_CHECK_NEW(order, count);
    RITZ_CHECK(sort_by_row(nrow, count, row, order));
    RITZ_CHECK(ritz_sparse_new(nrow, ncol, count, &A));
    for (int64_t k = 0; k < count; k++)
        A.colptr[col[k] + 1]++;
    accumulate_counts(ncol, A.colptr);

    /* Rows arrive ascending, so entries to be summed meet as neighbours. */
    RITZ_CHECK_NEW(end, ncol);
    memcpy(end, A.colptr, (size_t)ncol * sizeof *end);
    for (int64_t n = 0; n < count; n++) {
        int64_t k = order[n];
        int64_t p = end[col[k]];

        if (p > A.colptr[col[k]] && A.rowind[p - 1] == row[k]) {
            A.val[p - 1] += val[k];
        } else {
            A.rowind[p] = row[k];
            A.val[p] = val[k];
            end[col[k]]++;
        }
    }
    squeeze_zeros(&A, end);
    RITZ_MOVE(*out, A);
    return RITZ_OK;
}

ritz_status ritz_sparse_extract(const ritz_sparse *A, int64_t num_rows,
                                const int64_t *rows, int64_t num_cols,
                                const int64_t *cols, ritz_sparse *out)
{
    /* position in rows plus one, 0 if not wanted */
    RITZ_OWN_ARRAY int64_t *new_row = NULL;
    RITZ_OWN_ARRAY int64_t *row = NULL, *col = NULL;
    RITZ_OWN_ARRAY double *val = NULL;
    int64_t nnz = 0;
    int64_t kept = 0;

    RITZ_CHECK_NEW(new_row, A->nrow);
    for (int64_t k = 0; k < num_rows; k++) {
        RITZ_REFUSE_IF(rows[k] < 0 || rows[k] >= A->nrow, RITZ_ERR_ARGUMENT,
                       "row %" PRId64 " is out of range", rows[k]);
        new_row[rows[k]] = k + 1;
    }
    for (int64_t k = 0; k < num_cols; k++) {
        RITZ_REFUSE_IF(cols[k] < 0 || cols[k] >= A->ncol, RITZ_ERR_ARGUMENT,
                       "column %" PRId64 " is out of range", cols[k]);
        nnz += A->colptr[cols[k] + 1] - A->colptr[cols[k]];
    }
    RITZ_CHECK_NEW(row, nnz);
    RITZ_CHECK_NEW(col, nnz);
    RITZ_CHECK_NEW(val, nnz);
    for (int64_t k = 0; k < num_cols; k++) {
        for (int64_t p = A->colptr[cols[k]]; p < A->colptr[cols[k] + 1]; p++) {
            if (!new_row[A->rowind[p]])
                continue;
            row[kept] = new_row[A->rowind[p]] - 1;
            col[kept] = k;
            val[kept++] = A->val[p];
        }
    }
    return ritz_sparse_from_triplets(num_rows, num_cols, kept, row, col, val,
                                     out);
}

/* Merge column j of both into C from entry *at on. */
static void merge_column(double alpha, const ritz_sparse *A, double beta,
                         const ritz_sparse *B, int64_t j, ritz_sparse *C,
                         int64_t *at)
{
    int64_t p = A->colptr[j];
    int64_t q = B->colptr[j];

    while (p < A->colptr[j + 1] || q < B->colptr[j + 1]) {
        int64_t a = p < A->colptr[j + 1] ? A->rowind[p] : INT64_MAX;
        int64_t b = q < B->colptr[j + 1] ? B->rowind[q] : INT64_MAX;
        double value = 0.0;

        if (a <= b)
            value += alpha * A->val[p++];
        if (b <= a)
            value += beta * B->val[q++];
        C->rowind[*at] = a < b ? a : b;
        C->val[(*at)++] = value;
    }
    C->colptr[j + 1] = *at;
}

ritz_status ritz_sparse_add(double alpha, const ritz_sparse *A, double beta,
                            const ritz_sparse *B, ritz_sparse *C)
{
    int64_t at = 0;

    RITZ_REFUSE_IF(A->nrow != B->nrow || A->ncol != B->ncol, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " x %" PRId64 " meets %" PRId64 " x %" PRId64,
                   A->nrow, A->ncol, B->nrow, B->ncol);
    RITZ_CHECK(ritz_sparse_new(A->nrow, A->ncol,
                               A->colptr[A->ncol] + B->colptr[B->ncol], C));
    for (int64_t j = 0; j < A->ncol; j++)
        merge_column(alpha, A, beta, B, j, C, &at);
    return RITZ_OK;
}

ritz_status ritz_sparse_copy(const ritz_sparse *A, ritz_sparse *out)
{
    int64_t nnz = A->colptr[A->ncol];

    RITZ_CHECK(ritz_sparse_new(A->nrow, A->ncol, nnz, out));
    memcpy(out->colptr, A->colptr, (size_t)(A->ncol + 1) * sizeof *A->colptr);
    if (nnz > 0) {
        memcpy(out->rowind, A->rowind, (size_t)nnz * sizeof *A->rowind);
        memcpy(out->val, A->val, (size_t)nnz * sizeof *A->val);
    }
    return RITZ_OK;
}

/* Eight columns of a product are made at a time, so that A is read once for
   them. */
typedef struct columns_task {
    const ritz_sparse *A;
    const ritz_dense *X;
    ritz_dense *Y;
    double *room; /* each thread's eight columns of X and Y, row by row */
} columns_task;

/* y := A x, eight columns row by row; each sum in the order of the entries of
   A, so that it has the same bits as that of a single column. */
static void multiply_eight(const ritz_sparse *A, const double *x, double *y)
{
    memset(y, 0, (size_t)(A->nrow * EIGHT) * sizeof *y);
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            double *to = y + A->rowind[p] * EIGHT;

            for (int c = 0; c < EIGHT; c++)
                to[c] += A->val[p] * x[j * EIGHT + c];
        }
}

static void multiply_groups(int thread, int threads, void *task)
{
    const columns_task *t = task;
    const ritz_sparse *A = t->A;
    double *x = t->room + thread * (A->nrow + A->ncol) * EIGHT;
    double *y = x + A->ncol * EIGHT;

    for (int64_t k = (int64_t)thread * EIGHT; k < t->X->ncol;
         k += (int64_t)threads * EIGHT) {
        const int64_t left = t->X->ncol - k;
        const int64_t count = left < EIGHT ? left : EIGHT;

        for (int64_t i = 0; i < A->ncol; i++)
            for (int64_t c = 0; c < EIGHT; c++)
                x[i * EIGHT + c] =
                    c < count ? ritz_dense_col(t->X, k + c)[i] : 0.0;
        multiply_eight(A, x, y);
        for (int64_t c = 0; c < count; c++)
            for (int64_t i = 0; i < A->nrow; i++)
                ritz_dense_col(t->Y, k + c)[i] = y[i * EIGHT + c];
    }
}

/* Y := A X by several threads, eight columns at a time. */
static ritz_status multiply_columns(const ritz_sparse *A, const ritz_dense *X,
                                    ritz_dense *Y)
{
    const int64_t groups = (X->ncol + EIGHT - 1) / EIGHT;
    const bool large = A->colptr[A->ncol] >= WORTHWHILE;
    const int threads = ritz_team_ready(large ? groups : 1);
    RITZ_OWN_ARRAY double *room = NULL;

    RITZ_CHECK_NEW(room, threads * (A->nrow + A->ncol) * EIGHT);
    ritz_team_run(threads, multiply_groups, &(columns_task){A, X, Y, room});
    return RITZ_OK;
}

ritz_status ritz_sparse_mul(const ritz_sparse *A, const ritz_dense *X,
                            ritz_dense *Y)
{
    RITZ_REFUSE_IF(A->ncol != X->nrow, RITZ_ERR_ARGUMENT,
                   "A has %" PRId64 " columns but X has %" PRId64 " rows",
                   A->ncol, X->nrow);
    RITZ_CHECK(ritz_dense_new(A->nrow, X->ncol, Y));
    if (X->ncol >= EIGHT / 2)
        return multiply_columns(A, X, Y);
    for (int64_t k = 0; k < X->ncol; k++) {
        const double *x = ritz_dense_col(X, k);
        double *y = ritz_dense_col(Y, k);

        for (int64_t j = 0; j < A->ncol; j++)
            for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
                y[A->rowind[p]] += A->val[p] * x[j];
    }
    return RITZ_OK;
}

/* y + low := y + low + a x, its rounding of eps^2 [OgitaRumpOishi2005]. */
static void add_product(double a, double x, double *y, double *low)
{
    double product = a * x;
    double sum = *y + product;
    double part = sum - *y;

    *low += fma(a, x, -product) + (*y - (sum - part)) + (product - part);
    *y = sum;
}

ritz_status ritz_sparse_mul_twofold(const ritz_sparse *A, const ritz_dense *X,
                                    ritz_dense *Y)
{
    RITZ_OWN_ARRAY double *low = NULL;

    RITZ_CHECK_NEW(low, A->nrow);
    RITZ_CHECK(ritz_dense_new(A->nrow, X->ncol, Y));
    for (int64_t k = 0; k < X->ncol; k++) {
        double *y = ritz_dense_col(Y, k);

        for (int64_t j = 0; j < A->ncol; j++)
            for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
                add_product(A->val[p], ritz_dense_col(X, k)[j],
                            &y[A->rowind[p]], &low[A->rowind[p]]);
        for (int64_t i = 0; i < A->nrow; i++) {
            y[i] += low[i];
            low[i] = 0.0;
        }
    }
    return RITZ_OK;
}

static ritz_status check_column(const ritz_sparse *A, int64_t j)
{
    int64_t above = -1;

    for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
        int64_t i = A->rowind[p];

        RITZ_REFUSE_IF(i <= above || i >= A->nrow, RITZ_ERR_FORMAT,
                       "rows of column %" PRId64 " do not ascend", j);
        RITZ_REFUSE_IF(!isfinite(A->val[p]), RITZ_ERR_FORMAT,
                       "entry (%" PRId64 ", %" PRId64 ") is not finite", i, j);
        above = i;
    }
    return RITZ_OK;
}

ritz_status ritz_sparse_check(const ritz_sparse *A, int64_t nnz)
{
    RITZ_REFUSE_IF(A->colptr[0] != 0 || A->colptr[A->ncol] != nnz,
                   RITZ_ERR_FORMAT, "column pointers and entries disagree");
    for (int64_t j = 0; j < A->ncol; j++)
        RITZ_REFUSE_IF(A->colptr[j] > A->colptr[j + 1], RITZ_ERR_FORMAT,
                       "column pointers descend at column %" PRId64, j);
    for (int64_t j = 0; j < A->ncol; j++)
        RITZ_CHECK(check_column(A, j));
    return RITZ_OK;
}

/* A(i,j), 0 where nothing is stored. */
static double entry_at(const ritz_sparse *A, int64_t i, int64_t j, bool *stored)
{
    int64_t p = A->colptr[j];
    int64_t k = ritz_search(A->colptr[j + 1] - p, A->rowind + p, i);

    *stored = k >= 0;
    return *stored ? A->val[p + k] : 0.0;
}

double ritz_sparse_diagonal(const ritz_sparse *A, int64_t j)
{
    bool stored = false;

    return entry_at(A, j, j, &stored);
}

double ritz_sparse_max(const ritz_sparse *A)
{
    double largest = 0.0;

    for (int64_t p = 0; p < A->colptr[A->ncol]; p++)
        largest = fmax(largest, fabs(A->val[p]));
    return largest;
}

/* Number of entries above the diagonal minus the number below it. */
static int64_t compare_triangles(const ritz_sparse *A)
{
    int64_t more = 0;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            more += (A->rowind[p] < j) - (A->rowind[p] > j);
    return more;
}

/*
 * The largest |A(i,j) - A(j,i)| over the stored (i,j) of the lower triangle, or
 * of both triangles. *whole is true if A(j,i) is stored for each of them. The
 * lower triangle is enough if it is whole and has as many entries as the upper
 * one, because then no entry of the upper one is left unpaired.
 */
static double largest_gap(const ritz_sparse *A, bool both, bool *whole)
{
    double gap = 0.0;
    bool stored = false;

    *whole = true;
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            int64_t i = A->rowind[p];
            double other = 0.0;

            if (i == j || (i < j && !both))
                continue;
            other = entry_at(A, j, i, &stored);
            gap = fmax(gap, fabs(A->val[p] - other));
            *whole = *whole && stored;
        }
    return gap;
}

double ritz_sparse_asymmetry(const ritz_sparse *A)
{
    bool whole = false;
    double gap = largest_gap(A, false, &whole);

    if (!whole || compare_triangles(A) != 0)
        gap = largest_gap(A, true, &whole);
    return gap > 0.0 ? gap / ritz_sparse_max(A) : 0.0;
}

/* Move next[i] to the first entry of column i that is not above `row`; the
 * largest of the entries A(r,i) passed. Their counterparts A(i,r) are not
 * stored: the sweep has passed column r without meeting one. */
static double pass_unpaired(const ritz_sparse *A, int64_t i, int64_t row,
                            int64_t *next)
{
    double gap = 0.0;

    for (; next[i] < A->colptr[i + 1] && A->rowind[next[i]] < row; next[i]++)
        gap = fmax(gap, fabs(A->val[next[i]]));
    return gap;
}

/*
 * The sweep takes the entries A(i,j), i > j, by ascending j. Their counterparts
 * A(j,i) stand in column i by ascending row j: so next[i], the next entry of
 * column i to be compared, only moves forward.
 */
double ritz_sparse_sweep_asymmetry(const ritz_sparse *A, int64_t *next)
{
    double gap = 0.0;

    memcpy(next, A->colptr, (size_t)A->ncol * sizeof *next);
    for (int64_t j = 0; j < A->ncol; j++) {
        gap = fmax(gap, pass_unpaired(A, j, j, next));
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            int64_t i = A->rowind[p];
            double other = 0.0;

            if (i <= j)
                continue;
            gap = fmax(gap, pass_unpaired(A, i, j, next));
            if (next[i] < A->colptr[i + 1] && A->rowind[next[i]] == j)
                other = A->val[next[i]++];
            gap = fmax(gap, fabs(A->val[p] - other));
        }
    }
    return gap > 0.0 ? gap / ritz_sparse_max(A) : 0.0;
}

double ritz_sparse_skew(const ritz_sparse *A)
{
    double all = 0.0;
    double skew = 0.0; /* of A - A' */
    bool stored = false;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            double other = entry_at(A, j, A->rowind[p], &stored);
            double gap = 0.5 * (A->val[p] - other);

            all = hypot(all, A->val[p]);
            skew = hypot(skew, gap);
            if (!stored) /* the loop does not come to A(j,i) */
                skew = hypot(skew, gap);
        }
    return all > 0.0 ? skew / all : 0.0;
}

ritz_status ritz_sparse_symmetrise(ritz_sparse *A)
{
    RITZ_OWN(ritz_sparse) turned = {0}, mean = {0};

    RITZ_CHECK(ritz_sparse_transpose(A, &turned));
    RITZ_CHECK(ritz_sparse_add(0.5, A, 0.5, &turned, &mean));
    ritz_sparse_free(A);
    RITZ_MOVE(*A, mean);
    return RITZ_OK;
}

void ritz_sparse_free(ritz_sparse *A)
{
    RITZ_FREE(A->colptr, A->rowind, A->val);
    *A = (ritz_sparse){0};
}

/* Products of sparse matrices, and of theirs with few dense columns. */

ritz_status ritz_sparse_transpose(const ritz_sparse *A, ritz_sparse *out)
{
    int64_t nnz = A->colptr[A->ncol];
    RITZ_OWN(ritz_sparse) B = {0};
    RITZ_OWN_ARRAY int64_t *next = NULL;

    RITZ_CHECK(ritz_sparse_new(A->ncol, A->nrow, nnz, &B));
    RITZ_CHECK_NEW(next, A->nrow);
    for (int64_t p = 0; p < nnz; p++)
        B.colptr[A->rowind[p] + 1]++;
    accumulate_counts(A->nrow, B.colptr);
    if (A->nrow > 0)
        memcpy(next, B.colptr, (size_t)A->nrow * sizeof *next);
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            int64_t q = next[A->rowind[p]]++;

            B.rowind[q] = j;
            B.val[q] = A->val[p];
        }
    RITZ_MOVE(*out, B);
    return RITZ_OK;
}

/* Entries of A B, each place of a column counted once. */
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

/* Column j of A B, as it comes: rows are put in order by transposing twice. */
static void multiply_column(const ritz_sparse *A, const ritz_sparse *B,
                            int64_t j, int64_t *place, ritz_sparse *C)
{
    int64_t first = C->colptr[j];
    int64_t at = first;

    for (int64_t q = B->colptr[j]; q < B->colptr[j + 1]; q++) {
        int64_t k = B->rowind[q];

        for (int64_t p = A->colptr[k]; p < A->colptr[k + 1]; p++) {
            int64_t i = A->rowind[p];

            if (place[i] <= first) { /* one more than where it lies */
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

ritz_status ritz_sparse_project(const ritz_sparse *A, const ritz_dense *T,
                                ritz_dense *out)
{
    RITZ_OWN(ritz_dense) AT = {0};

    if (!A->colptr)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_mul(A, T, &AT));
    RITZ_CHECK(ritz_dense_mul_tn(T, &AT, out));
    if (ritz_sparse_asymmetry(A) == 0.0)
        ritz_dense_symmetrise(out);
    return RITZ_OK;
}

ritz_status ritz_sparse_condense(const ritz_sparse *A, const ritz_dense *T,
                                 ritz_dense *out)
{
    RITZ_CHECK(ritz_sparse_project(A, T, out));
    ritz_dense_symmetrise(out);
    return RITZ_OK;
}

ritz_status ritz_sparse_terms(const ritz_sparse *A, const ritz_dense *T,
                              ritz_dense *out)
{
    RITZ_OWN(ritz_sparse) size = {0};
    RITZ_OWN(ritz_dense) columns = {0};

    RITZ_CHECK(ritz_sparse_copy(A, &size));
    for (int64_t k = 0; k < size.colptr[size.ncol]; k++)
        size.val[k] = fabs(size.val[k]);
    RITZ_CHECK(ritz_dense_abs(T, &columns));
    return ritz_sparse_condense(&size, &columns, out);
}

/* Between sparse and dense. */

ritz_status ritz_sparse_dense(const ritz_sparse *A, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(A->nrow, A->ncol, out));
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            ritz_dense_col(out, j)[A->rowind[p]] = A->val[p];
    return RITZ_OK;
}

ritz_status ritz_sparse_from_dense(const ritz_dense *A, ritz_sparse *out)
{
    RITZ_OWN(ritz_sparse) made = {0};
    int64_t count = 0;

    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        count += A->val[k] != 0.0;
    RITZ_CHECK(ritz_sparse_new(A->nrow, A->ncol, count, &made));
    count = 0;
    for (int64_t j = 0; j < A->ncol; j++) {
        for (int64_t i = 0; i < A->nrow; i++)
            if (ritz_dense_col(A, j)[i] != 0.0) {
                made.rowind[count] = i;
                made.val[count++] = ritz_dense_col(A, j)[i];
            }
        made.colptr[j + 1] = count;
    }
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}
