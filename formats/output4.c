/* NASTRAN OUTPUT4, whichever way it is spelled. */
#include "formats/output4.h"
#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const ritz_output4_spelling *const spellings[] = {
    &ritz_output4_binary, &ritz_output4_text, NULL};

static bool open_bytes(const char *bytes, int64_t size,
                       ritz_output4_reader *out)
{
    for (int k = 0; spellings[k]; k++) {
        *out = (ritz_output4_reader){
            .as = spellings[k],
            .begin = bytes,
            .text = {.at = bytes, .end = bytes + size},
        };
        if (out->as->recognise(out))
            return true;
    }
    return false;
}

static bool is_output4(const char *bytes, int64_t size)
{
    ritz_output4_reader r;

    return open_bytes(bytes, size, &r);
}

/* ---- FORM --------------------------------------------------------------- */

/*
 * What FORM says of an OUTPUT4 matrix: 3 with one row or column is a diagonal;
 * 6 symmetric, both triangles stored, a file with one only is completed; 8
 * without entries the identity.
 */

enum { DIAGONAL = 3, IDENTITY = 8 };

/* True if entries lie beside the diagonal, and all on one side of it. */
static bool is_triangle(const ritz_triplets *t)
{
    bool above = false;
    bool below = false;

    for (int64_t k = 0, j = 0; k < t->count; j++)
        for (int64_t end = k + t->counts[j + 1]; k < end; k++) {
            above = above || t->row[k] < j;
            below = below || t->row[k] > j;
        }
    return above != below;
}

/* One row or one column becomes the diagonal of an n x n matrix. */
static ritz_status spread_diagonal(ritz_triplets *t, int64_t n)
{
    int64_t *counts = NULL;

    RITZ_CHECK_NEW(counts, n + 1);
    for (int64_t k = 0, j = 0; k < t->count; j++)
        for (int64_t end = k + t->counts[j + 1]; k < end; k++) {
            t->row[k] += j; /* one of them is 0 */
            counts[t->row[k] + 1] = 1;
        }
    free(t->counts);
    t->counts = counts;
    return RITZ_OK;
}

/* Give the entries the meaning that FORM says; nrow and ncol follow. */
static ritz_status obey_form(ritz_output4_build *build)
{
    ritz_output4_header *h = &build->header;
    ritz_triplets *t = &build->entries;
    int64_t n = h->nrow > h->ncol ? h->nrow : h->ncol;
    bool square = h->nrow == h->ncol;
    bool vector =
        h->form == DIAGONAL && (h->nrow == 1 || h->ncol == 1) && n > 1;
    bool unit = h->form == IDENTITY && square && t->count == 0;

    RITZ_REFUSE_IF((vector || unit) && n > build->columns, RITZ_ERR_FORMAT,
                   "'%s' is said to be a diagonal of %" PRId64
                   " rows, far more than its file can fill",
                   h->name, n);
    RITZ_CHECK(ritz_triplets_reserve(t, unit ? n : 0));
    for (int64_t k = 0; unit && k < n; k++)
        ritz_triplets_put(t, k, k, 1.0, 0.0);
    if (!vector)
        return RITZ_OK;
    h->nrow = h->ncol = n;
    return spread_diagonal(t, n);
}

/* ---- columns ------------------------------------------------------------ */

/*
 * Columns that a file may declare beyond one for each of its bytes. A matrix of
 * ten million columns, nearly all null, is legal and takes 150 bytes; a limit
 * keeps such bytes from asking for all memory there is.
 */
enum { NULL_COLUMNS = 32000000 };

static void name_column(ritz_output4_build *build)
{
    snprintf(build->where, sizeof build->where, "column %" PRId64 " of '%s'",
             build->column + 1, build->header.name);
}

/* Begin a matrix of a file of so many bytes. */
static ritz_status begin_matrix(const ritz_output4_header *header, int64_t size,
                                ritz_output4_build *out)
{
    int64_t most = NULL_COLUMNS + size;

    RITZ_REFUSE_IF(header->ncol > most, RITZ_ERR_FORMAT,
                   "'%s' is said to have %" PRId64
                   " columns, far more than its file can fill",
                   header->name, header->ncol);
    *out = (ritz_output4_build){
        .header = *header,
        .columns = most - header->ncol,
        .column = -1,
        .rule = header->bigmat ? RITZ_OUTPUT4_BIGMAT : RITZ_OUTPUT4_WORDS,
        .entries.is_complex = header->numbers == 2,
    };
    name_column(out);
    RITZ_CHECK_NEW(out->entries.counts, header->ncol + 1);
    return RITZ_OK;
}

/* Begin a column, from 1; those between are null. */
static ritz_status begin_column(ritz_output4_build *build, int64_t column)
{
    RITZ_REFUSE_IF(column < 1 || column > build->header.ncol, RITZ_ERR_FORMAT,
                   "'%s' has %" PRId64 " columns, but one is numbered %" PRId64,
                   build->header.name, build->header.ncol, column);
    RITZ_REFUSE_IF(column <= build->column + 1, RITZ_ERR_FORMAT,
                   "column %" PRId64 " of '%s' follows column %" PRId64, column,
                   build->header.name, build->column + 1);
    build->column = column - 1;
    name_column(build);
    build->first = build->entries.count;
    build->below = 0;
    return RITZ_OK;
}

/* Forget what this column got so far. */
static void rewind_column(ritz_output4_build *build)
{
    build->entries.count = build->first;
    build->entries.counts[build->column + 1] = 0;
    build->below = 0;
}

/* After the last column: obey FORM and hand the matrix over. */
static ritz_status end_matrix(ritz_output4_build *build, ritz_matrix *out)
{
    const ritz_output4_header *h = &build->header;
    bool half = h->symmetric && is_triangle(&build->entries);

    RITZ_CHECK(obey_form(build));
    RITZ_CHECK(ritz_triplets_compress(&build->entries, h->nrow, h->ncol, out));
    if (half)
        RITZ_CHECK(ritz_matrix_mirror(out, 1.0, 1.0));
    memcpy(out->name, h->name, sizeof out->name);
    out->symmetric =
        h->nrow == h->ncol &&
        (h->symmetric || h->form == DIAGONAL || h->form == IDENTITY);
    return RITZ_OK;
}

static void ritz_output4_build_free(ritz_output4_build *build)
{
    ritz_triplets_free(&build->entries);
}

/* ---- one matrix --------------------------------------------------------- */

/* The strings of a column, of so many words, by one reading of their
   headers. */
static ritz_status read_strings(ritz_output4_reader *r,
                                ritz_output4_build *build, int64_t words)
{
    for (int64_t left = words; left > 0;) {
        ritz_output4_string string = {0};

        RITZ_CHECK(r->as->take_string(r, build, words, left, &string));
        RITZ_CHECK(r->as->read_numbers(r, build, string.row, string.reals));
        left -= string.words;
    }
    return RITZ_OK;
}

static ritz_status try_strings(ritz_output4_reader *r,
                               const ritz_output4_reader *start,
                               ritz_output4_build *build, int64_t rule,
                               int64_t wide, int64_t words)
{
    *r = *start;
    rewind_column(build);
    build->rule = rule;
    build->wide = wide;
    return read_strings(r, build, words);
}

/* The reading whose strings add up, tried first the one that fitted last; if
 * none does, that one says what is wrong. */
static ritz_status read_sparse(ritz_output4_reader *r,
                               ritz_output4_build *build, int64_t words)
{
    const ritz_output4_reader start = *r;
    int64_t rule = build->rule;
    int64_t wide = build->wide;

    for (int64_t k = 0; k < r->widths * RITZ_OUTPUT4_RULES; k++) {
        ritz_status status =
            try_strings(r, &start, build, (rule + k) % RITZ_OUTPUT4_RULES,
                        k < RITZ_OUTPUT4_RULES ? wide : 3 - wide, words);

        if (status != RITZ_ERR_FORMAT)
            return status;
    }
    return try_strings(r, &start, build, rule, wide, words);
}

/*
 * Move behind a matrix by its counts alone; false if these do not fit.
 *
 * @param[out] size  bytes of the records that were passed, where columns are
 *                   records
 */
static bool skip_columns(ritz_output4_reader *r,
                         const ritz_output4_header *header, int64_t *size)
{
    const ritz_output4_build build = {.header = *header};
    int64_t column = 0;
    int64_t n[3] = {0};

    *size = 0;
    while (column <= header->ncol) {
        if (r->as->take_column(r, &build, n) != RITZ_OK || n[0] <= column ||
            n[0] > header->ncol + 1)
            return false;
        column = n[0];
        *size += r->data_end - r->data;
        if (column <= header->ncol && r->as->skip_column &&
            !r->as->skip_column(r, n))
            return false;
    }
    return !r->as->skip_last || r->as->skip_last(r, &build, n[2]) == RITZ_OK;
}

/* Entries that a matrix can hold, by its records or else by what is left of its
 * file: with room for these at once nothing is copied. */
static int64_t most_entries(const ritz_output4_reader *r,
                            const ritz_output4_header *h)
{
    ritz_output4_reader ahead = *r;
    int64_t most = (r->text.end - r->text.at) / (r->width > 0 ? r->width : 1);

    if (r->width == 0) {
        (void)skip_columns(&ahead, h, &most);
        most /= r->real;
    }
    most /= h->numbers;
    return h->nrow > 0 && most / h->nrow < h->ncol ? most : h->nrow * h->ncol;
}

/* The matrix whose header was taken. */
static ritz_status read_columns(ritz_output4_reader *r,
                                const ritz_output4_header *header,
                                ritz_matrix *out)
{
    RITZ_OWN(ritz_output4_build) build = {0};
    RITZ_OWN(ritz_matrix) new = {.digits = r->digits};
    bool sparse = false;
    int64_t n[3] = {0};

    RITZ_CHECK(begin_matrix(header, r->text.end - r->begin, &build));
    build.wide = r->wide;
    RITZ_CHECK(ritz_triplets_reserve(&build.entries, most_entries(r, header)));
    for (;;) {
        RITZ_CHECK(r->as->take_column(r, &build, n));
        if (n[0] == header->ncol + 1) {
            if (r->as->skip_last)
                RITZ_CHECK(r->as->skip_last(r, &build, n[2]));
            break;
        }
        RITZ_CHECK(begin_column(&build, n[0]));
        sparse = sparse || n[1] == 0;
        if (n[1] == 0)
            RITZ_CHECK(read_sparse(r, &build, n[2]));
        else
            RITZ_CHECK(r->as->read_dense(r, &build, n));
    }
    snprintf(new.spelling, sizeof new.spelling, "OUTPUT4 %s, %s, %s",
             r->as->name,
             !sparse          ? "dense"
             : header->bigmat ? "bigmat"
                              : "sparse",
             r->format);
    RITZ_CHECK(end_matrix(&build, &new));
    RITZ_MOVE(*out, new);
    return RITZ_OK;
}

static ritz_status read_matrix(const ritz_foreign *file,
                               const ritz_listed *which, ritz_matrix *out)
{
    ritz_output4_reader r;
    ritz_output4_header header = {0};
    bool found = false;

    RITZ_REFUSE_IF(!open_bytes(file->bytes, file->size, &r), RITZ_ERR_FORMAT,
                   "holds no matrix");
    r.text.at = file->bytes + which->at;
    r.text.number = which->line - 1;
    RITZ_CHECK(r.as->take_header(&r, &header, &found));
    return read_columns(&r, &header, out);
}

/* ---- directory ---------------------------------------------------------- */

/* Where counts do not lead behind a matrix, or values are to be checked, it is
 * read. */
static ritz_status pass_matrix(ritz_output4_reader *r,
                               const ritz_output4_header *header, bool check)
{
    RITZ_OWN(ritz_matrix) unused = {0};
    ritz_output4_reader ahead = *r;
    int64_t size = 0;

    if (check || !skip_columns(&ahead, header, &size))
        return read_columns(r, header, &unused);
    *r = ahead;
    return RITZ_OK;
}

static ritz_status list_matrices(const ritz_foreign *file, bool check,
                                 ritz_listing *out)
{
    ritz_output4_reader r;
    ritz_output4_header header = {0};
    bool found = false;

    RITZ_REFUSE_IF(!open_bytes(file->bytes, file->size, &r), RITZ_ERR_FORMAT,
                   "holds no matrix");
    for (;;) {
        ritz_listed item = {0};

        RITZ_CHECK(r.as->take_header(&r, &header, &found));
        if (!found)
            return RITZ_OK;
        item.nrow = header.nrow;
        item.ncol = header.ncol;
        item.symmetric = header.symmetric;
        item.is_complex = header.numbers == 2;
        item.at = header.at;
        item.line = header.line;
        memcpy(item.name, header.name, sizeof item.name);
        RITZ_CHECK(ritz_listing_add(out, &item));
        RITZ_CHECK(pass_matrix(&r, &header, check));
    }
}

/* Of a damaged file all values are read, to find where the damage begins. */
static ritz_status list_file(const ritz_foreign *file, ritz_listing *out)
{
    ritz_status status = list_matrices(file, false, out);

    if (status == RITZ_ERR_FORMAT) {
        out->count = 0;
        status = list_matrices(file, true, out);
    }
    RITZ_CHECK(status);
    RITZ_REFUSE_IF(out->count == 0, RITZ_ERR_FORMAT, "holds no matrix");
    return RITZ_OK;
}

const ritz_format ritz_format_output4 = {
    .name = "output4",
    .summary = "NASTRAN OUTPUT4, text or binary, dense or sparse",
    .reference = "MSC2014",
    .recognise = is_output4,
    .list = list_file,
    .read = read_matrix,
};
