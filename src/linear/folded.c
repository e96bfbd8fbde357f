#include "linear/folded.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/* Zeros of different sign are not the same. */
static bool is_same(double a, double b)
{
    return a == b && signbit(a) == signbit(b);
}

/*
 * Whether A(i,j) and A(j,i) are the same bits for all stored entries. The
 * entries below the diagonal are met by ascending j; their counterparts stand in
 * column i by ascending row j, so that next[i] only moves forward.
 */
static bool is_symmetric(const ritz_sparse *A, int64_t *next)
{
    memcpy(next, A->colptr, (size_t)A->ncol * sizeof *next);
    for (int64_t j = 0; j < A->ncol; j++) {
        int64_t p = next[j]; /* all entries above the diagonal were met */

        if (p < A->colptr[j + 1] && A->rowind[p] < j)
            return false;
        if (p < A->colptr[j + 1] && A->rowind[p] == j)
            p++;
        for (; p < A->colptr[j + 1]; p++) {
            const int64_t i = A->rowind[p];
            const int64_t q = next[i]++;

            if (q >= A->colptr[i + 1] || A->rowind[q] != j ||
                !is_same(A->val[q], A->val[p]))
                return false;
        }
    }
    return true;
}

/* Move the lower triangle to the front of the arrays; returns its entries. Rows
   become numbers of half the size, so that each is written before or where it
   was read. */
static int64_t compact_triangle(ritz_sparse *A)
{
    char *rows = (char *)A->rowind;
    int64_t count = 0;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int32_t row = (int32_t)A->rowind[p];

            if (row < j)
                continue;
            memcpy(rows + (size_t)count * sizeof row, &row, sizeof row);
            A->val[count++] = A->val[p];
        }
    return count;
}

/* The first @p bytes of an array; the array itself if it cannot be made shorter,
   which costs only memory. */
static void *shorten_array(void *array, size_t bytes)
{
    void *shorter = bytes > 0 ? realloc(array, bytes) : NULL;

    return shorter ? shorter : array;
}

ritz_status ritz_folded_new(ritz_sparse *A, ritz_folded *out)
{
    RITZ_OWN_ARRAY int64_t *next = NULL;
    size_t count = 0;

    RITZ_CHECK_NEW(next, A->ncol);
    if (A->nrow != A->ncol || A->ncol > INT32_MAX || !is_symmetric(A, next))
        return RITZ_OK;
    count = (size_t)compact_triangle(A);
    *out = (ritz_folded){.n = A->ncol, .colptr = A->colptr};
    out->row = shorten_array(A->rowind, count * sizeof *out->row);
    out->val = shorten_array(A->val, count * sizeof *out->val);
    *A = (ritz_sparse){0};
    return RITZ_OK;
}

static int32_t row_at(const char *rows, int64_t k)
{
    int32_t row = 0;

    memcpy(&row, rows + (size_t)k * sizeof row, sizeof row);
    return row;
}

static void put_row(char *rows, int64_t p, int64_t row)
{
    memcpy(rows + (size_t)p * sizeof row, &row, sizeof row);
}

/* behind[j] := where the entries above the diagonal of column j end; returns the
   number of entries of the triangle. */
static int64_t end_upper_parts(const ritz_folded *F, int64_t *behind)
{
    int64_t at = 0;

    memcpy(behind, F->colptr, (size_t)F->n * sizeof *behind);
    for (int64_t j = 0; j < F->n; j++)
        for (int64_t p = behind[j]; p < F->colptr[j + 1]; p++, at++)
            behind[F->row[at]] += F->row[at] != j;
    return at;
}

/*
 * Spread the triangle over arrays that have room for both triangles, from the
 * last column to the first. An entry is written where it was read, behind it, or
 * in a later column, so that nothing is overwritten before it was read.
 */
static void spread_triangle(const ritz_folded *F, int64_t at, int64_t *behind,
                            char *rows, double *val)
{
    for (int64_t j = F->n - 1; j >= 0; j--) {
        const int64_t first = behind[j];

        for (int64_t p = F->colptr[j + 1] - 1; p >= first; p--) {
            const int64_t i = row_at(rows, --at);
            const double value = val[at];

            put_row(rows, p, i);
            val[p] = value;
            if (i == j)
                continue;
            put_row(rows, --behind[i], j);
            val[behind[i]] = value;
        }
    }
}

ritz_status ritz_folded_open(ritz_folded *F, ritz_sparse *A)
{
    RITZ_OWN_ARRAY int64_t *behind = NULL;
    int64_t count = 0;
    void *rows = NULL;

    if (!F->colptr)
        return RITZ_OK;
    RITZ_CHECK_NEW(behind, F->n);
    count = end_upper_parts(F, behind);
    if (F->colptr[F->n] > 0) {
        RITZ_CHECK(
            ritz_array_lengthen(&F->val, F->colptr[F->n], sizeof *A->val));
        RITZ_CHECK(
            ritz_array_lengthen(&F->row, F->colptr[F->n], sizeof *A->rowind));
    }
    rows = F->row;
    spread_triangle(F, count, behind, rows, F->val);
    *A = (ritz_sparse){F->n, F->n, F->colptr, rows, F->val};
    *F = (ritz_folded){0};
    return RITZ_OK;
}

void ritz_folded_free(ritz_folded *F)
{
    RITZ_FREE(F->colptr, F->row, F->val);
    *F = (ritz_folded){0};
}
