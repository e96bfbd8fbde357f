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
#include "formats/output4.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
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

enum { WORDS, VALUES, BIGMAT };

/*
 * Columns that a file may declare beyond one for each of its bytes. A matrix of
 * ten million columns, nearly all null, is legal and takes 150 bytes; a limit
 * keeps such bytes from asking for all memory there is.
 */
enum { NULL_COLUMNS = 32000000 };

bool ritz_output4_header_of(const int64_t n[static 4], const char *name,
                            int64_t length, ritz_output4_header *out)
{
    int64_t used = 0;

    if (n[0] < 0 || n[1] == INT64_MIN || n[3] < 1 || n[3] > 4)
        return false;
    *out = (ritz_output4_header){
        .ncol = n[0],
        .nrow = n[1] < 0 ? -n[1] : n[1],
        .bigmat = n[1] < 0 || n[1] >= 65536,
        .form = n[2],
        .type = n[3],
        .numbers = n[3] > 2 ? 2 : 1,
        .symmetric = n[2] == SYMMETRIC && (n[1] == n[0] || n[1] == -n[0]),
    };
    for (int64_t k = 0; k < length && used < RITZ_NAME_SIZE - 1; k++)
        if (name[k] > ' ' && name[k] < 127)
            out->name[used++] = name[k];
    return true;
}

int64_t ritz_output4_integers(const ritz_output4_build *build)
{
    return build->rule == BIGMAT ? 2 : 1;
}

bool ritz_output4_decode(const ritz_output4_build *build,
                         const int64_t *integers, int64_t left,
                         ritz_output4_string *out)
{
    bool pair = build->rule == BIGMAT;
    int64_t count = pair ? integers[0] : integers[0] / 65536;
    int64_t row = pair ? integers[1] : integers[0] % 65536;
    int64_t value = build->header.numbers * build->wide; /* words of one */
    int64_t words = count - 1;

    if (count < 1 || count > left)
        return false;
    if (build->rule == VALUES)
        words = count * value;
    *out = (ritz_output4_string){
        .row = row - 1,
        .reals = words / build->wide,
        .words = words + ritz_output4_integers(build),
    };
    return words >= 1 && words % value == 0 && out->words <= left && row >= 1 &&
           row - 1 + words / value <= build->header.nrow;
}

static void name_column(ritz_output4_build *build)
{
    snprintf(build->where, sizeof build->where, "column %" PRId64 " of '%s'",
             build->column + 1, build->header.name);
}

ritz_status ritz_output4_begin(const ritz_output4_header *header, int64_t size,
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
        .rule = header->bigmat ? BIGMAT : WORDS,
        .entries.is_complex = header->numbers == 2,
    };
    name_column(out);
    RITZ_CHECK_NEW(out->entries.counts, header->ncol + 1);
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
    build->column = column - 1;
    name_column(build);
    build->first = build->entries.count;
    build->below = 0;
    return RITZ_OK;
}

void ritz_output4_rewind(ritz_output4_build *build)
{
    build->entries.count = build->first;
    build->entries.counts[build->column + 1] = 0;
    build->below = 0;
}

ritz_status ritz_output4_rows(ritz_output4_build *build, int64_t row,
                              int64_t count)
{
    RITZ_REFUSE_IF(row < build->below, RITZ_ERR_FORMAT,
                   "rows of %s do not ascend", build->where);
    RITZ_REFUSE_IF(count > build->header.nrow ||
                       row > build->header.nrow - count,
                   RITZ_ERR_FORMAT,
                   "%s has %" PRId64 " values from row %" PRId64
                   ", but the matrix %" PRId64 " rows",
                   build->where, count, row + 1, build->header.nrow);
    build->below = row + count;
    return ritz_triplets_reserve(&build->entries, count);
}

ritz_status ritz_output4_put(ritz_output4_build *build, int64_t row, double re,
                             double im)
{
    RITZ_REFUSE_IF(!isfinite(re) || !isfinite(im), RITZ_ERR_FORMAT,
                   "row %" PRId64 " of %s is not finite", row + 1,
                   build->where);
    ritz_triplets_put_value(&build->entries, row, build->column, re, im);
    return RITZ_OK;
}

ritz_status ritz_output4_end(ritz_output4_build *build, ritz_matrix *out)
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

void ritz_output4_build_free(ritz_output4_build *build)
{
    ritz_triplets_free(&build->entries);
}
