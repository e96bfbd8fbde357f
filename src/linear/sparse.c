/* Sparse matrices: construction, submatrices, sums, transposes and symmetry. */
#include "base/alloc.h"
#include "base/memory.h"
#include "base/search.h"
#include "base/team.h"

#include <ritz/matrix.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum {
    WORTHWHILE = 50000, /* entries from which one more thread is used */
    ENTRY = sizeof(int64_t) + sizeof(double), /* bytes of an entry */
};

ritz_status ritz_sparse_new(int64_t nrow, int64_t ncol, int64_t nnz,
                            ritz_sparse *out)
{
    RITZ_OWN(ritz_sparse) A = {.nrow = nrow, .ncol = ncol};

    RITZ_REFUSE_IF(nrow < 0 || ncol < 0 || nnz < 0, RITZ_ERR_ARGUMENT,
                   "a matrix cannot be %" PRId64 " x %" PRId64, nrow, ncol);
    if (nnz <= INT64_MAX / ENTRY)
        RITZ_CHECK(ritz_memory_admit_array(ENTRY * nnz));
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

/* A submatrix of A to be copied to `out`: its columns, and where each row of A
   goes. */
typedef struct extraction {
    const ritz_sparse *A;
    const int64_t *cols;
    int64_t *place; /* row of `out` of each row of A; -1: not wanted */
    ritz_sparse *out;
} extraction;

static void extraction_free(extraction *e)
{
    free(e->place);
}

static ritz_status place_rows(extraction *e, int64_t count, const int64_t *rows)
{
    const int64_t n = e->A->nrow;

    RITZ_CHECK_NEW(e->place, n);
    for (int64_t i = 0; i < n; i++)
        e->place[i] = -1;
    for (int64_t k = 0; k < count; k++) {
        RITZ_REFUSE_IF(rows[k] < 0 || rows[k] >= n, RITZ_ERR_ARGUMENT,
                       "row %" PRId64 " is out of range", rows[k]);
        e->place[rows[k]] = k;
    }
    return RITZ_OK;
}

/* colptr[k + 1] := the number of entries of column k of the submatrix. */
static void count_extracted(int thread, int64_t from, int64_t to, void *task)
{
    const extraction *e = task;

    (void)thread;
    for (int64_t k = from; k < to; k++)
        for (int64_t p = e->A->colptr[e->cols[k]];
             p < e->A->colptr[e->cols[k] + 1]; p++)
            e->out->colptr[k + 1] += e->place[e->A->rowind[p]] >= 0;
}

static void copy_extracted(int thread, int64_t from, int64_t to, void *task)
{
    const extraction *e = task;

    (void)thread;
    for (int64_t k = from; k < to; k++) {
        int64_t at = e->out->colptr[k];

        for (int64_t p = e->A->colptr[e->cols[k]];
             p < e->A->colptr[e->cols[k] + 1]; p++) {
            const int64_t row = e->place[e->A->rowind[p]];

            if (row < 0)
                continue;
            e->out->rowind[at] = row;
            e->out->val[at++] = e->A->val[p];
        }
    }
}

/* Sort the rows within each column. A transpose has its rows in ascending order,
   so that two transpositions sort them. */
static ritz_status sort_columns(ritz_sparse *A)
{
    RITZ_OWN(ritz_sparse) turned = {0}, sorted = {0};

    RITZ_CHECK(ritz_sparse_transpose(A, &turned));
    RITZ_CHECK(ritz_sparse_transpose(&turned, &sorted));
    ritz_sparse_free(A);
    RITZ_MOVE(*A, sorted);
    return RITZ_OK;
}

static bool is_ascending(int64_t count, const int64_t *item)
{
    for (int64_t k = 1; k < count; k++)
        if (item[k] <= item[k - 1])
            return false;
    return true;
}

ritz_status ritz_sparse_extract(const ritz_sparse *A, int64_t num_rows,
                                const int64_t *rows, int64_t num_cols,
                                const int64_t *cols, ritz_sparse *out)
{
    RITZ_OWN(ritz_sparse) B = {.nrow = num_rows, .ncol = num_cols};
    RITZ_OWN(extraction) e = {.A = A, .cols = cols, .out = &B};
    const int threads = ritz_team_ready(1 + A->colptr[A->ncol] / WORTHWHILE);

    RITZ_CHECK(place_rows(&e, num_rows, rows));
    for (int64_t k = 0; k < num_cols; k++)
        RITZ_REFUSE_IF(cols[k] < 0 || cols[k] >= A->ncol, RITZ_ERR_ARGUMENT,
                       "column %" PRId64 " is out of range", cols[k]);
    RITZ_CHECK_NEW(B.colptr, num_cols + 1);
    ritz_team_over(threads, num_cols, count_extracted, &e);
    accumulate_counts(num_cols, B.colptr);
    RITZ_CHECK_NEW(B.rowind, B.colptr[num_cols]);
    RITZ_CHECK_NEW(B.val, B.colptr[num_cols]);
    ritz_team_over(threads, num_cols, copy_extracted, &e);
    if (!is_ascending(num_rows, rows))
        RITZ_CHECK(sort_columns(&B));
    RITZ_MOVE(*out, B);
    return RITZ_OK;
}

/* Copy the entries of A from `begin` to `end` - 1 that have a place to entry `at`
   and behind it; returns where they end. */
static int64_t keep_column(ritz_sparse *A, const int64_t *place, int64_t begin,
                           int64_t end, int64_t at)
{
    for (int64_t p = begin; p < end; p++) {
        const int64_t row = place[A->rowind[p]];

        if (row < 0)
            continue;
        A->rowind[at] = row;
        A->val[at++] = A->val[p];
    }
    return at;
}

ritz_status ritz_sparse_keep(ritz_sparse *A, int64_t count, const int64_t *rows)
{
    RITZ_OWN(extraction) e = {.A = A};
    int64_t begin = 0;
    int64_t at = 0;

    RITZ_REFUSE_IF(A->nrow != A->ncol || !is_ascending(count, rows),
                   RITZ_ERR_ARGUMENT,
                   "rows and columns of a square matrix are kept in their "
                   "order");
    RITZ_CHECK(place_rows(&e, count, rows));
    for (int64_t k = 0; k < count; k++) {
        const int64_t end = A->colptr[rows[k] + 1];

        /* that of the next column may have been overwritten just now */
        if (k == 0 || rows[k] > rows[k - 1] + 1)
            begin = A->colptr[rows[k]];
        at = keep_column(A, e.place, begin, end, at);
        A->colptr[k + 1] = at;
        begin = end;
    }
    A->colptr[0] = 0;
    A->nrow = A->ncol = count;
    RITZ_CHECK(ritz_array_lengthen(&A->colptr, count + 1, sizeof *A->colptr));
    if (at == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_array_lengthen(&A->rowind, at, sizeof *A->rowind));
    return ritz_array_lengthen(&A->val, at, sizeof *A->val);
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
    const int64_t room = A->colptr[A->ncol] + B->colptr[B->ncol];
    RITZ_OWN(ritz_sparse) sum = {.nrow = A->nrow, .ncol = A->ncol};
    int64_t at = 0;

    RITZ_REFUSE_IF(A->nrow != B->nrow || A->ncol != B->ncol, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " x %" PRId64 " meets %" PRId64 " x %" PRId64,
                   A->nrow, A->ncol, B->nrow, B->ncol);
    RITZ_CHECK_NEW(sum.colptr, A->ncol + 1);
    RITZ_CHECK_RAW(sum.rowind, room); /* where patterns agree, half is unused */
    RITZ_CHECK_RAW(sum.val, room);
    for (int64_t j = 0; j < A->ncol; j++)
        merge_column(alpha, A, beta, B, j, &sum, &at);
    if (at > 0) {
        RITZ_CHECK(ritz_array_lengthen(&sum.rowind, at, sizeof *sum.rowind));
        RITZ_CHECK(ritz_array_lengthen(&sum.val, at, sizeof *sum.val));
    }
    RITZ_MOVE(*C, sum);
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

/* Whether columns are as ritz_sparse_check() wants them: each thread looks at
   some of them. */
typedef struct column_check {
    const ritz_sparse *A;
    bool refused[RITZ_TEAM_SHARES]; /* by each thread */
} column_check;

static void look_at_columns(int thread, int64_t from, int64_t to, void *task)
{
    column_check *all = task;
    const ritz_sparse *A = all->A;
    bool refused = false;

    for (int64_t j = from; j < to; j++) {
        int64_t above = -1;

        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const bool ascends = A->rowind[p] > above;
            const bool finite = fabs(A->val[p]) <= DBL_MAX;

            refused |= !ascends | !finite;
            above = A->rowind[p];
        }
        refused |= above >= A->nrow; /* the last row is the largest */
    }
    all->refused[thread] = refused;
}

/* Threads that gain from a pass over the entries; at most RITZ_TEAM_SHARES. */
static int sweep_threads(const ritz_sparse *A)
{
    enum { ENTRIES = 1 << 18 }; /* a fraction of a millisecond */
    const int64_t gain = A->colptr[A->ncol] / ENTRIES;

    return ritz_team_ready(gain < RITZ_TEAM_SHARES ? gain : RITZ_TEAM_SHARES);
}

/* Where a column is refused, one thread finds the first that is. */
static ritz_status check_columns(const ritz_sparse *A)
{
    column_check all = {.A = A};
    bool refused = false;

    ritz_team_over(sweep_threads(A), A->ncol, look_at_columns, &all);
    for (int k = 0; k < RITZ_TEAM_SHARES; k++)
        refused = refused || all.refused[k];
    for (int64_t j = 0; refused && j < A->ncol; j++)
        RITZ_CHECK(check_column(A, j));
    return RITZ_OK;
}

ritz_status ritz_sparse_check(const ritz_sparse *A, int64_t nnz)
{
    RITZ_REFUSE_IF(A->colptr[0] != 0 || A->colptr[A->ncol] != nnz,
                   RITZ_ERR_FORMAT, "column pointers and entries disagree");
    for (int64_t j = 0; j < A->ncol; j++)
        RITZ_REFUSE_IF(A->colptr[j] > A->colptr[j + 1], RITZ_ERR_FORMAT,
                       "column pointers descend at column %" PRId64, j);
    return check_columns(A);
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
        largest = ritz_larger(largest, fabs(A->val[p]));
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
            gap = ritz_larger(gap, fabs(A->val[p] - other));
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
        gap = ritz_larger(gap, fabs(A->val[next[i]]));
    return gap;
}

/* The first entry of column j below the diagonal and not above row `from`. If j
   is a row of this thread, next[j] is not above the diagonal by now. */
static int64_t first_to_sweep(const ritz_sparse *A, int64_t j, int64_t from,
                              const int64_t *next)
{
    const int64_t begin = A->colptr[j], end = A->colptr[j + 1];

    if (j >= from)
        return next[j] + (next[j] < end && A->rowind[next[j]] == j);
    if (begin == end || A->rowind[end - 1] < from)
        return end;
    return begin + ritz_lower_bound(end - begin, A->rowind + begin, from);
}

/*
 * The sweep takes the entries A(i,j), i > j, by ascending j. Their counterparts
 * A(j,i) stand in column i by ascending row j: so next[i], the next entry of
 * column i to be compared, only moves forward. In a symmetric matrix it is the
 * counterpart. More columns are gone through side by side than the processor
 * fetches ahead by itself.
 */
static double sweep_column(const ritz_sparse *A, int64_t j, int64_t from,
                           int64_t to, int64_t *next)
{
    enum { AHEAD = 8 }; /* entries of a line of the cache */
    double gap = 0.0;

    for (int64_t p = first_to_sweep(A, j, from, next);
         p < A->colptr[j + 1] && A->rowind[p] < to; p++) {
        const int64_t i = A->rowind[p];
        int64_t q = next[i];
        double other = 0.0;

        if (q < A->colptr[i + 1] && A->rowind[q] < j) {
            gap = ritz_larger(gap, pass_unpaired(A, i, j, next));
            q = next[i];
        }
        if (q < A->colptr[i + 1] && A->rowind[q] == j) {
            other = A->val[q];
            next[i] = q + 1;
            __builtin_prefetch(&A->rowind[q + AHEAD]);
            __builtin_prefetch(&A->val[q + AHEAD]);
        }
        gap = ritz_larger(gap, fabs(A->val[p] - other));
    }
    return gap;
}

/* A thread compares the entries A(i,j) of its rows i. */
typedef struct sweeping {
    const ritz_sparse *A;
    int64_t *next;
    double gap[RITZ_TEAM_SHARES]; /* the largest of each thread */
} sweeping;

static void sweep_rows(int thread, int64_t from, int64_t to, void *task)
{
    sweeping *all = task;
    const ritz_sparse *A = all->A;
    double gap = 0.0;

    for (int64_t j = 0; j < to; j++) {
        if (j >= from)
            gap = ritz_larger(gap, pass_unpaired(A, j, j, all->next));
        gap = ritz_larger(gap, sweep_column(A, j, from, to, all->next));
    }
    all->gap[thread] = gap;
}

double ritz_sparse_sweep_asymmetry(const ritz_sparse *A, int64_t *next)
{
    sweeping all = {.A = A, .next = next};
    double gap = 0.0;

    memcpy(next, A->colptr, (size_t)A->ncol * sizeof *next);
    ritz_team_over(sweep_threads(A), A->ncol, sweep_rows, &all);
    for (int k = 0; k < RITZ_TEAM_SHARES; k++)
        gap = ritz_larger(gap, all.gap[k]);
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
