/*
 * NASTRAN OUTPUT4: matrices by columns, what text and binary have in common.
 *
 * A sparse column is a sequence of strings, each consecutive rows behind one or
 * two integers. There are three readings of these, w words to a value:
 *
 *     words    IS = 65536 (w + 1) + row
 *     values   IS = 65536 v + row            NASTRAN-95, v counts values
 *     bigmat   w + 1, row
 *
 * Headers do not always tell which (a bigmat of few rows may be unmarked), so
 * that one is taken by which the strings of a column add up to its word count.
 */
#include "base/alloc.h"
#include "formats/matrix.h"
#include "formats/output4.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* ---- FORM --------------------------------------------------------------- */

/*
 * What FORM says of an OUTPUT4 matrix: 3 with one row or column is a diagonal;
 * 6 symmetric, both triangles stored, a file with one only is completed; 8
 * without entries the identity.
 */

enum { DIAGONAL = 3, SYMMETRIC = 6, IDENTITY = 8 };

/* True if entries lie beside the diagonal, and all on one side of it. */
static bool is_triangle(const ritz_sparse *A)
{
    bool above = false;
    bool below = false;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            above = above || A->rowind[p] < j;
            below = below || A->rowind[p] > j;
        }
    return above != below;
}

/* The matrix that an entry of the file is a shorthand of. */
typedef enum shape { MIRRORED, ON_DIAGONAL, UNIT } shape;

/* The entries that the file's own stand for, as the n x n matrix has them. */
static ritz_status list_entries(const ritz_matrix *m, shape as, int64_t n,
                                ritz_triplets *out)
{
    const ritz_sparse *A = &m->A;

    RITZ_CHECK(ritz_triplets_new(as == UNIT ? n : 2 * A->colptr[A->ncol], out));
    for (int64_t k = 0; as == UNIT && k < n; k++)
        ritz_triplets_put(out, k, k, 1.0, 0.0);
    for (int64_t j = 0; as != UNIT && j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            double im = m->imaginary ? m->imaginary[p] : 0.0;
            int64_t i = A->rowind[p];
            int64_t at = A->ncol == 1 ? i : j;

            if (as == ON_DIAGONAL)
                ritz_triplets_put(out, at, at, A->val[p], im);
            else
                ritz_triplets_put(out, i, j, A->val[p], im);
            if (as == MIRRORED && i != j)
                ritz_triplets_put(out, j, i, A->val[p], im);
        }
    return RITZ_OK;
}

/* m := the n x n matrix that its entries are a shorthand of. */
static ritz_status expand_form(ritz_matrix *m, shape as, int64_t n)
{
    RITZ_OWN(ritz_triplets) list = {0};

    RITZ_CHECK(list_entries(m, as, n, &list));
    return ritz_triplets_compress(&list, n, n, m->imaginary != NULL, m);
}

/* Give the matrix the meaning that FORM says. */
static ritz_status obey_form(ritz_output4_build *build)
{
    ritz_matrix *m = &build->matrix;
    int64_t nrow = m->A.nrow;
    int64_t ncol = m->A.ncol;
    int64_t n = nrow > ncol ? nrow : ncol;
    int64_t form = build->header.form;
    bool vector = form == DIAGONAL && (nrow == 1 || ncol == 1) && n > 1;
    bool unit = form == IDENTITY && nrow == ncol && build->nnz == 0;

    RITZ_REFUSE_IF((vector || unit) && n > build->columns, RITZ_ERR_FORMAT,
                   "'%s' is said to be a diagonal of %" PRId64
                   " rows, far more than its file can fill",
                   build->header.name, n);
    if (vector || unit) {
        build->columns -= n;
        RITZ_CHECK(expand_form(m, unit ? UNIT : ON_DIAGONAL, n));
    }
    if (form == SYMMETRIC && nrow == ncol && is_triangle(&m->A))
        RITZ_CHECK(expand_form(m, MIRRORED, n));
    m->symmetric = m->A.nrow == m->A.ncol &&
                   (form == SYMMETRIC || form == DIAGONAL || form == IDENTITY);
    return RITZ_OK;
}

/* ---- columns ------------------------------------------------------------ */

enum { WORDS, VALUES, BIGMAT };

int64_t ritz_output4_integers(int64_t rule)
{
    return rule == BIGMAT ? 2 : 1;
}

int64_t ritz_output4_rule(const ritz_output4_build *build, int64_t k)
{
    return (build->rule + k) % RITZ_OUTPUT4_RULES;
}

bool ritz_output4_decode(const ritz_output4_build *build, int64_t rule,
                         int64_t wide, const int64_t *integers, int64_t left,
                         ritz_output4_string *out)
{
    int64_t count = rule == BIGMAT ? integers[0] : integers[0] / 65536;
    int64_t row = rule == BIGMAT ? integers[1] : integers[0] % 65536;
    int64_t value = build->numbers * wide; /* words of one */
    int64_t words = count - 1;

    if (count < 1 || count > left)
        return false;
    if (rule == VALUES)
        words = count * value;
    *out = (ritz_output4_string){
        .row = row - 1,
        .reals = words / wide,
        .words = words + ritz_output4_integers(rule),
    };
    return words >= 1 && words % value == 0 && out->words <= left && row >= 1 &&
           row - 1 + words / value <= build->header.nrow;
}

/* Room for `need` entries, doubled so that growing costs O(1) an entry. */
static ritz_status grow_entries(ritz_output4_build *build, int64_t need)
{
    ritz_matrix *m = &build->matrix;
    int64_t room = need > 2 * build->room ? need : 2 * build->room;
    size_t used = (size_t)build->nnz;
    RITZ_OWN_ARRAY int64_t *rowind = NULL;
    RITZ_OWN_ARRAY double *val = NULL;
    RITZ_OWN_ARRAY double *imaginary = NULL;

    RITZ_CHECK_NEW(rowind, room);
    RITZ_CHECK_NEW(val, room);
    if (build->numbers == 2)
        RITZ_CHECK_NEW(imaginary, room);
    if (used > 0) {
        memcpy(rowind, m->A.rowind, used * sizeof *rowind);
        memcpy(val, m->A.val, used * sizeof *val);
        if (imaginary)
            memcpy(imaginary, m->imaginary, used * sizeof *imaginary);
    }
    free(m->A.rowind);
    free(m->A.val);
    free(m->imaginary);
    RITZ_MOVE(m->A.rowind, rowind);
    m->A.val = val;
    m->imaginary = imaginary;
    build->room = room;
    val = imaginary = NULL;
    return RITZ_OK;
}

/* Room for pointers 0..column + 1, at most of all columns. */
static ritz_status grow_pointers(ritz_output4_build *build, int64_t column)
{
    int64_t most = build->header.ncol + 1;
    int64_t room = 2 * build->pointers;
    int64_t *colptr = NULL;

    if (column + 2 <= build->pointers)
        return RITZ_OK;
    if (room < column + 2)
        room = column + 2;
    if (room > most)
        room = most;
    RITZ_CHECK_NEW(colptr, room);
    if (build->pointers > 0)
        memcpy(colptr, build->matrix.A.colptr,
               (size_t)build->pointers * sizeof *colptr);
    free(build->matrix.A.colptr);
    build->matrix.A.colptr = colptr;
    build->pointers = room;
    return RITZ_OK;
}

ritz_status ritz_output4_begin(const ritz_output4_header *header, int64_t size,
                               int64_t nnz, ritz_output4_build *out)
{
    ritz_status status = RITZ_OK;
    ritz_output4_build build = {.header = *header,
                                .column = -1,
                                .columns = RITZ_OUTPUT4_NULL_COLUMNS + size};

    RITZ_FAIL_IF(header->ncol > build.columns, RITZ_ERR_FORMAT,
                 "'%s' is said to have %" PRId64
                 " columns, far more than its file can fill",
                 header->name, header->ncol);
    build.columns -= header->ncol;
    build.matrix.A.nrow = header->nrow;
    build.matrix.A.ncol = header->ncol;
    build.numbers = header->type > 2 ? 2 : 1;
    build.rule = header->bigmat ? BIGMAT : WORDS;
    memcpy(build.matrix.name, header->name, sizeof build.matrix.name);
    RITZ_TRY(grow_entries(&build, nnz > 0 ? nnz : 1));
    RITZ_TRY(grow_pointers(&build, -1));
    RITZ_MOVE(*out, build);
done:
    ritz_matrix_free(&build.matrix);
    return status;
}

/* Columns after the present one up to `column` begin where entries end. */
static ritz_status close_columns(ritz_output4_build *build, int64_t column)
{
    RITZ_CHECK(grow_pointers(build, column - 1));
    for (int64_t j = build->column + 1; j <= column; j++)
        build->matrix.A.colptr[j] = build->nnz;
    build->column = column;
    build->below = 0;
    return RITZ_OK;
}

ritz_status ritz_output4_column(ritz_output4_build *build, int64_t column)
{
    RITZ_REFUSE_IF(column < 1 || column > build->header.ncol, RITZ_ERR_FORMAT,
                   "'%s' has %" PRId64 " columns, but one is numbered %" PRId64,
                   build->header.name, build->header.ncol, column);
    RITZ_REFUSE_IF(column <= build->column + 1, RITZ_ERR_FORMAT,
                   "column %" PRId64 " of '%s' follows column %" PRId64, column,
                   build->header.name, build->column + 1);
    return close_columns(build, column - 1);
}

void ritz_output4_rewind(ritz_output4_build *build)
{
    build->nnz = build->matrix.A.colptr[build->column];
    build->below = 0;
}

ritz_status ritz_output4_rows(ritz_output4_build *build, int64_t row,
                              int64_t count)
{
    RITZ_REFUSE_IF(row < build->below, RITZ_ERR_FORMAT,
                   "rows of column %" PRId64 " of '%s' do not ascend",
                   build->column + 1, build->header.name);
    RITZ_REFUSE_IF(
        count > build->header.nrow || row > build->header.nrow - count,
        RITZ_ERR_FORMAT,
        "column %" PRId64 " of '%s' has %" PRId64 " values from row %" PRId64
        ", but the matrix %" PRId64 " rows",
        build->column + 1, build->header.name, count, row + 1,
        build->header.nrow);
    build->below = row + count;
    if (count > build->room - build->nnz)
        RITZ_CHECK(grow_entries(build, build->nnz + count));
    return RITZ_OK;
}

ritz_status ritz_output4_infinite(const ritz_output4_build *build, int64_t row)
{
    return ritz_fail(RITZ_ERR_FORMAT,
                     "row %" PRId64 " of column %" PRId64
                     " of '%s' is not finite",
                     row + 1, build->column + 1, build->header.name);
}

ritz_status ritz_output4_end(ritz_output4_build *build, ritz_matrix *out)
{
    RITZ_CHECK(close_columns(build, build->header.ncol));
    RITZ_CHECK(obey_form(build));
    *out = build->matrix;
    build->matrix = (ritz_matrix){0};
    return RITZ_OK;
}

void ritz_output4_name(const char *bytes, int64_t size,
                       char out[RITZ_NAME_SIZE])
{
    int64_t used = 0;

    for (int64_t k = 0; k < size && used < RITZ_NAME_SIZE - 1; k++)
        if (bytes[k] > ' ' && bytes[k] < 127)
            out[used++] = bytes[k];
    out[used] = '\0';
}

ritz_status ritz_output4_list(ritz_listing *listing,
                              const ritz_output4_header *header, int64_t at,
                              int64_t line)
{
    bool square = header->nrow == header->ncol;
    ritz_listed item = {.nrow = header->nrow,
                        .ncol = header->ncol,
                        .symmetric = square && header->form == SYMMETRIC,
                        .is_complex = header->type > 2,
                        .at = at,
                        .line = line};

    memcpy(item.name, header->name, sizeof item.name);
    return ritz_listing_add(listing, &item);
}
