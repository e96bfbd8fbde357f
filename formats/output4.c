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

    for (int64_t k = 0, j = 0; k < t->count && !(above && below); j++)
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

/* Read the matrix whose header was taken. */
static ritz_status read_columns(ritz_output4_reader *r,
                                const ritz_output4_header *header,
                                const ritz_marks *marks, ritz_matrix *out)
{
    RITZ_OWN(ritz_output4_build) build = {0};
    RITZ_OWN(ritz_matrix) new = {.digits = r->digits};

    RITZ_CHECK(ritz_output4_read_columns(r, header, marks, &build));
    snprintf(new.spelling, sizeof new.spelling, "OUTPUT4 %s, %s, %s",
             r->as->name,
             !build.sparse    ? "dense"
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
    return read_columns(&r, &header, which->marks, out);
}

/* ---- directory ---------------------------------------------------------- */

/* Bytes of a file from which its matrices get marks. */
enum { LARGE = 2 << 20, APART = 256 << 10 };

/* Where counts do not lead behind a matrix, or values are to be checked, it is
 * read. */
static ritz_status pass_matrix(ritz_output4_reader *r,
                               const ritz_output4_header *header, bool check,
                               ritz_marks **out)
{
    RITZ_OWN(ritz_matrix) unused = {0};
    RITZ_OWN_ARRAY ritz_marks *marks = NULL;
    ritz_output4_reader ahead = *r;
    int64_t size = 0;

    if (!check && r->text.end - r->text.at >= LARGE) {
        RITZ_CHECK_NEW(marks, 1);
        marks->apart = APART;
    }
    if (check || !ritz_output4_skip_columns(&ahead, header, &size, marks))
        return read_columns(r, header, NULL, &unused);
    if (marks && ahead.text.at - r->text.at >= LARGE && marks->count > 1)
        RITZ_MOVE(*out, marks);
    *r = ahead;
    return RITZ_OK;
}

/* What the header of a matrix says in the directory. */
static void describe_header(const ritz_output4_header *header, ritz_listed *out)
{
    *out = (ritz_listed){
        .nrow = header->nrow,
        .ncol = header->ncol,
        .symmetric = header->symmetric,
        .is_complex = header->numbers == 2,
        .at = header->at,
        .line = header->line,
    };
    memcpy(out->name, header->name, sizeof out->name);
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
        describe_header(&header, &item);
        RITZ_CHECK(ritz_listing_add(out, &item));
        RITZ_CHECK(
            pass_matrix(&r, &header, check, &out->item[out->count - 1].marks));
    }
}

/* Of a damaged file all values are read, to find where the damage begins. */
static ritz_status list_file(const ritz_foreign *file, ritz_listing *out)
{
    ritz_status status = list_matrices(file, false, out);

    if (status == RITZ_ERR_FORMAT) {
        ritz_listing_clear(out);
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
    .maps = true,
    .list = list_file,
    .read = read_matrix,
};
