/*
 * Matrix Market: a banner, a line of sizes, entries or all values by columns.
 *
 *     %%MatrixMarket matrix coordinate|array
 *                           real|integer|complex|pattern
 *                           general|symmetric|skew-symmetric|hermitian
 *
 * Files deviate: the upper triangle instead of the lower, or both. Both are
 * taken if they agree. An entry given twice is refused: the format leaves open
 * whether it is to be summed, and a stiffness twice too large looks like one.
 * Zeros are not kept, so that array and coordinate give one pattern.
 */
#include "formats/matrix_market.h"

#include "base/alloc.h"
#include "formats/decimal.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Rows or columns that a file may declare beyond one for each byte. */
enum { NULL_ROWS = 32000000 };

static const char *const layouts[] = {"coordinate", "array", NULL};
static const char *const fields[] = {"real",    "double",  "integer",
                                     "complex", "pattern", NULL};
static const char *const symmetries[] = {"general", "symmetric",
                                         "skew-symmetric", "hermitian", NULL};

static bool is_gap(char c)
{
    return c <= ' ';
}

/* Move over one word of the banner; its place in `words`, -1 if not there. */
static int take_word(const char **at, const char *end, const char *const *words)
{
    const char *begin = ritz_decimal_skip(*at, end);
    const char *stop = begin;

    while (stop < end && !is_gap(*stop))
        stop++;
    *at = stop;
    for (int k = 0; words[k]; k++) {
        size_t length = strlen(words[k]);
        size_t same = 0;

        while (same < length && begin + same < stop &&
               (begin[same] | 32) == (words[k][same] | 32))
            same++;
        if (same == length && begin + same == stop)
            return k;
    }
    return -1;
}

static ritz_status read_banner(ritz_market *m)
{
    static const char *const banner[] = {"%%MatrixMarket", NULL};
    static const char *const object[] = {"matrix", NULL};
    const char *at = m->text.at;
    const char *stop = ritz_lines_next(&m->text) ? m->text.line_end : at;

    RITZ_REFUSE_IF(take_word(&at, stop, banner) < 0 ||
                       take_word(&at, stop, object) < 0,
                   RITZ_ERR_FORMAT, "line 1: not '%%%%MatrixMarket matrix'");
    m->layout = take_word(&at, stop, layouts);
    RITZ_REFUSE_IF(m->layout < 0, RITZ_ERR_FORMAT,
                   "line 1: neither 'coordinate' nor 'array'");
    m->field = take_word(&at, stop, fields);
    RITZ_REFUSE_IF(m->field < 0 || (m->field == RITZ_MARKET_PATTERN &&
                                    m->layout == RITZ_MARKET_ARRAY),
                   RITZ_ERR_FORMAT,
                   "line 1: the values are not real, integer, complex or "
                   "a pattern");
    m->symmetry = take_word(&at, stop, symmetries);
    RITZ_REFUSE_IF(m->symmetry < 0, RITZ_ERR_FORMAT,
                   "line 1: not general, symmetric, skew-symmetric or "
                   "hermitian");
    m->kind = symmetries[m->symmetry];
    RITZ_REFUSE_IF(m->symmetry == RITZ_MARKET_HERMITIAN &&
                       m->field != RITZ_MARKET_COMPLEX,
                   RITZ_ERR_FORMAT, "line 1: hermitian, but not complex");
    return RITZ_OK;
}

/* Values of an array, or -1 if there are more than the file has bytes. */
static int64_t array_values(const ritz_market *m, int64_t bytes)
{
    int64_t n = m->nrow;

    if (m->nrow == 0 || m->ncol == 0)
        return 0;
    if (m->symmetry == RITZ_MARKET_GENERAL)
        return m->nrow > bytes / m->ncol ? -1 : m->nrow * m->ncol;
    if (n / 2 > bytes / n)
        return -1;
    return m->symmetry == RITZ_MARKET_SKEW ? n * (n - 1) / 2 : n * (n + 1) / 2;
}

/* Sizes, and room for entries: each takes at least two bytes of the file. */
static ritz_status read_size(ritz_market *m)
{
    int64_t n[3] = {0};
    int64_t bytes = 0;

    RITZ_REFUSE_IF(!ritz_market_next(m), RITZ_ERR_FORMAT,
                   "line %" PRId64 ": ends before its size", m->text.number);
    RITZ_REFUSE_IF(!ritz_decimal_scan_row(
                       m->text.line, m->text.line_end,
                       m->layout == RITZ_MARKET_COORDINATE ? 3 : 2, n) ||
                       n[0] < 0 || n[1] < 0 || n[2] < 0,
                   RITZ_ERR_FORMAT, "line %" PRId64 ": '%.*s' is not a size",
                   m->text.number,
                   ritz_lines_quoted(m->text.line, m->text.line_end),
                   m->text.line);
    m->nrow = n[0];
    m->ncol = n[1];
    bytes = m->text.end - m->text.at;
    RITZ_REFUSE_IF(m->symmetry != RITZ_MARKET_GENERAL && m->nrow != m->ncol,
                   RITZ_ERR_FORMAT,
                   "line %" PRId64 ": a %s matrix cannot be %" PRId64
                   " x %" PRId64,
                   m->text.number, m->kind, m->nrow, m->ncol);
    RITZ_REFUSE_IF(m->nrow - NULL_ROWS > bytes || m->ncol - NULL_ROWS > bytes,
                   RITZ_ERR_FORMAT,
                   "line %" PRId64 ": %" PRId64 " x %" PRId64
                   " is far more than the file can fill",
                   m->text.number, m->nrow, m->ncol);
    m->most =
        m->layout == RITZ_MARKET_COORDINATE ? n[2] : array_values(m, bytes);
    RITZ_REFUSE_IF(m->most < 0 || m->most > bytes / 2 + 1, RITZ_ERR_FORMAT,
                   "line %" PRId64 ": declares more entries than %" PRId64
                   " bytes can hold",
                   m->text.number, bytes);
    RITZ_CHECK_NEW(m->entry, m->most);
    return RITZ_OK;
}

static bool recognise(const char *bytes, int64_t size)
{
    static const char *const banner[] = {"%%MatrixMarket", NULL};
    const char *at = bytes;

    return take_word(&at, bytes + size, banner) == 0;
}

static ritz_status read_all(const char *bytes, int64_t size, const char *folder,
                            ritz_matrices *out)
{
    ritz_status status = RITZ_OK;
    ritz_market m = {.text = {.at = bytes, .end = bytes + size}};
    ritz_matrix *matrix = NULL;

    (void)folder; /* the format includes no other file */
    RITZ_TRY(read_banner(&m));
    RITZ_TRY(read_size(&m));
    RITZ_TRY(ritz_market_read_entries(&m));
    RITZ_TRY(ritz_market_settle(&m));
    RITZ_NEW(matrix, 1);
    RITZ_TRY(ritz_market_compress(&m, matrix));
    matrix->symmetric = m.symmetry == RITZ_MARKET_SYMMETRIC;
    matrix->digits = m.digits;
    if (m.field == RITZ_MARKET_INTEGER || m.field == RITZ_MARKET_PATTERN ||
        m.digits > 17)
        matrix->digits = 17; /* whole numbers are exact */
    if (matrix->digits < 1)
        matrix->digits = 1;
    snprintf(matrix->spelling, sizeof matrix->spelling,
             "Matrix Market %s, %s, %s", layouts[m.layout], fields[m.field],
             m.kind);
    out->count = 1;
    out->matrix = matrix;
    matrix = NULL;
done:
    free(m.entry);
    free(matrix);
    return status;
}

const ritz_format ritz_format_matrix_market = {
    .name = "matrix-market",
    .summary = "Matrix Market, coordinate or array",
    .reference = "BoisvertPozoRemington1996",
    .recognise = recognise,
    .read = read_all,
};
