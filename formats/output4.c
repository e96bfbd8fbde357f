/* NASTRAN OUTPUT4, whichever way it is spelled. */
#include "formats/output4.h"

#include <stdio.h>
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
    ritz_output4_rewind(build);
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

    RITZ_CHECK(ritz_output4_begin(header, r->text.end - r->begin, &build));
    build.wide = r->wide;
    RITZ_CHECK(ritz_triplets_reserve(&build.entries, most_entries(r, header)));
    for (;;) {
        RITZ_CHECK(r->as->take_column(r, &build, n));
        if (n[0] == header->ncol + 1) {
            if (r->as->skip_last)
                RITZ_CHECK(r->as->skip_last(r, &build, n[2]));
            break;
        }
        RITZ_CHECK(ritz_output4_column(&build, n[0]));
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
    RITZ_CHECK(ritz_output4_end(&build, &new));
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
