/* Matrices of foreign files, put together from their entries. */
#include "formats/matrix.h"

#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

ritz_status ritz_triplets_reserve(ritz_triplets *list, int64_t more)
{
    int64_t used = list->count;
    int64_t room = list->room + (more > list->room ? more : list->room);
    int64_t longer = room - used;

    if (more <= list->room - used)
        return RITZ_OK;
    RITZ_REFUSE_IF(list->borrowed, RITZ_ERR_FORMAT,
                   "more values than were counted");
    RITZ_CHECK(ritz_array_extend(&list->row, used, longer, sizeof *list->row));
    if (!list->counts)
        RITZ_CHECK(
            ritz_array_extend(&list->col, used, longer, sizeof *list->col));
    RITZ_CHECK(ritz_array_extend(&list->re, used, longer, sizeof *list->re));
    if (list->is_complex)
        RITZ_CHECK(
            ritz_array_extend(&list->im, used, longer, sizeof *list->im));
    list->room = room;
    return RITZ_OK;
}

ritz_status ritz_triplets_room(ritz_triplets *list, int64_t count)
{
    RITZ_CHECK_RAW(list->row, count);
    if (!list->counts)
        RITZ_CHECK_RAW(list->col, count);
    RITZ_CHECK_RAW(list->re, count);
    if (list->is_complex)
        RITZ_CHECK_RAW(list->im, count);
    list->room = count;
    return RITZ_OK;
}

static bool is_sorted(const ritz_triplets *list)
{
    for (int64_t k = 1; k < list->count && !list->counts; k++)
        if (list->col[k - 1] > list->col[k] ||
            (list->col[k - 1] == list->col[k] &&
             list->row[k - 1] >= list->row[k]))
            return false;
    return true;
}

/* Sorted entries become the columns as they are. */
static ritz_status move_entries(ritz_triplets *list, int64_t ncol,
                                ritz_sparse *A, double **imaginary)
{
    RITZ_MOVE(A->colptr, list->counts);
    if (!A->colptr) {
        RITZ_CHECK_NEW(A->colptr, ncol + 1);
        for (int64_t k = 0; k < list->count; k++)
            A->colptr[list->col[k] + 1]++;
    }
    for (int64_t j = 0; j < ncol; j++)
        A->colptr[j + 1] += A->colptr[j];
    A->rowind = list->row;
    A->val = list->re;
    *imaginary = list->im;
    free(list->col);
    *list = (ritz_triplets){0};
    return RITZ_OK;
}

ritz_status ritz_triplets_compress(ritz_triplets *list, int64_t nrow,
                                   int64_t ncol, ritz_matrix *m)
{
    RITZ_OWN(ritz_sparse) A = {.nrow = nrow, .ncol = ncol}, imaginary = {0};

    if (is_sorted(list)) {
        if (list->room == 0) /* arrays of nothing are arrays too */
            RITZ_CHECK(ritz_triplets_reserve(list, 1));
        RITZ_CHECK(move_entries(list, ncol, &A, &imaginary.val));
    } else {
        RITZ_CHECK(ritz_sparse_from_triplets(nrow, ncol, list->count, list->row,
                                             list->col, list->re, &A));
        if (list->is_complex)
            RITZ_CHECK(ritz_sparse_from_triplets(nrow, ncol, list->count,
                                                 list->row, list->col, list->im,
                                                 &imaginary));
        ritz_triplets_free(list);
    }
    RITZ_MOVE(m->A, A);
    RITZ_MOVE(m->imaginary, imaginary.val); /* the pattern is the same */
    return RITZ_OK;
}

/* Ends of the columns of both triangles, of which one is stored. */
static void count_mirrored(const ritz_sparse *A, int64_t *end)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            end[j + 1]++;
            end[A->rowind[p] + 1] += A->rowind[p] != j;
        }
    for (int64_t j = 0; j < A->ncol; j++)
        end[j + 1] += end[j];
}

/* Columns come in order: what is mirrored of those further left is in place
 * when a column's own entries follow, and behind them what is of others. */
ritz_status ritz_matrix_mirror(ritz_matrix *m, double re, double im)
{
    const ritz_sparse *half = &m->A;
    int64_t n = half->ncol;
    RITZ_OWN(ritz_matrix) both = {0};
    RITZ_OWN_ARRAY int64_t *next = NULL;

    RITZ_CHECK_NEW(next, n + 1);
    count_mirrored(half, next);
    RITZ_CHECK(ritz_sparse_new(n, n, next[n], &both.A));
    memcpy(both.A.colptr, next, (size_t)(n + 1) * sizeof *next);
    if (m->imaginary)
        RITZ_CHECK_NEW(both.imaginary, next[n]);
    for (int64_t j = 0; j < n; j++)
        for (int64_t p = half->colptr[j]; p < half->colptr[j + 1]; p++) {
            int64_t i = half->rowind[p];

            for (int64_t turn = 0; turn < (i == j ? 1 : 2); turn++) {
                int64_t q = next[turn ? i : j]++;

                both.A.rowind[q] = turn ? j : i;
                both.A.val[q] = (turn ? re : 1.0) * half->val[p];
                if (m->imaginary)
                    both.imaginary[q] = (turn ? im : 1.0) * m->imaginary[p];
            }
        }
    ritz_sparse_free(&m->A);
    free(m->imaginary);
    RITZ_MOVE(m->A, both.A);
    RITZ_MOVE(m->imaginary, both.imaginary);
    return RITZ_OK;
}

void ritz_triplets_free(ritz_triplets *list)
{
    RITZ_FREE(list->row, list->col, list->counts, list->re, list->im);
    *list = (ritz_triplets){0};
}

void ritz_matrix_free(ritz_matrix *matrix)
{
    ritz_sparse_free(&matrix->A);
    RITZ_FREE(matrix->imaginary, matrix->row, matrix->col);
    *matrix = (ritz_matrix){0};
}

void ritz_matrices_free(ritz_matrices *matrices)
{
    RITZ_FREE_EACH(ritz_matrix, matrices->count, matrices->matrix);
    *matrices = (ritz_matrices){0};
}

void ritz_marks_add(ritz_marks *marks, const ritz_mark *mark)
{
    const int64_t most = (int64_t)(sizeof marks->mark / sizeof *marks->mark);

    if (marks->count > 0 &&
        mark->at - marks->mark[marks->count - 1].at < marks->apart)
        return;
    if (marks->count == most) {
        for (int64_t k = 1; k < most / 2; k++)
            marks->mark[k] = marks->mark[2 * k];
        marks->count = most / 2;
        marks->apart *= 2;
    }
    marks->mark[marks->count++] = *mark;
}

void ritz_listing_clear(ritz_listing *listing)
{
    for (int64_t k = 0; k < listing->count; k++)
        free(listing->item[k].marks);
    listing->count = 0;
}

ritz_status ritz_listing_add(ritz_listing *listing, const ritz_listed *item)
{
    RITZ_CHECK_ROOM(listing->item, listing->count, listing->room);
    listing->item[listing->count++] = *item;
    return RITZ_OK;
}
