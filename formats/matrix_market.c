/*
 * Matrix Market: a banner, a line of sizes, entries or all values by columns.
 *
 *     %%MatrixMarket matrix coordinate|array
 *                           real|integer|complex|pattern
 *                           general|symmetric|skew-symmetric|hermitian
 *
 * Files deviate: the upper triangle instead of the lower, or both. Both are
 * taken if they agree (market_entries.c).
 */
#include "formats/market.h"

#include "formats/matrix.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static const char *const layouts[] = {"coordinate", "array", NULL};
static const char *const fields[] = {"real",    "double",  "integer",
                                     "complex", "pattern", NULL};
static const char *const symmetries[] = {"general", "symmetric",
                                         "skew-symmetric", "hermitian", NULL};

/* Move over one word of the banner; its place in `words`, -1 if not there. */
static int take_word(const char **at, const char *end, const char *const *words)
{
    const char *begin = ritz_decimal_skip(*at, end);
    const char *stop = begin;

    while (stop<end && * stop> ' ')
        stop++;
    *at = stop;
    for (int k = 0; words[k]; k++)
        if (strlen(words[k]) == (size_t)(stop - begin) &&
            strncasecmp(words[k], begin, (size_t)(stop - begin)) == 0)
            return k;
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
                   RITZ_ERR_FORMAT, "not '%%%%MatrixMarket matrix'");
    m->layout = take_word(&at, stop, layouts);
    RITZ_REFUSE_IF(m->layout < 0, RITZ_ERR_FORMAT,
                   "neither 'coordinate' nor 'array'");
    m->field = take_word(&at, stop, fields);
    RITZ_REFUSE_IF(m->field < 0 || (m->field == RITZ_MARKET_PATTERN &&
                                    m->layout == RITZ_MARKET_ARRAY),
                   RITZ_ERR_FORMAT,
                   "the values are not real, integer, complex or "
                   "a pattern");
    m->symmetry = take_word(&at, stop, symmetries);
    RITZ_REFUSE_IF(m->symmetry < 0, RITZ_ERR_FORMAT,
                   "not general, symmetric, skew-symmetric or "
                   "hermitian");
    m->kind = symmetries[m->symmetry];
    RITZ_REFUSE_IF(m->symmetry == RITZ_MARKET_HERMITIAN &&
                       m->field != RITZ_MARKET_COMPLEX,
                   RITZ_ERR_FORMAT, "hermitian, but not complex");
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

/* Sizes; an entry takes at least two bytes of the file. */
static ritz_status read_size(ritz_market *m)
{
    int64_t n[3] = {0};
    int64_t bytes = 0;
    const char *at = NULL;

    RITZ_REFUSE_IF(!ritz_market_next_line(m), RITZ_ERR_FORMAT,
                   "ends before its size");
    at = m->text.line;
    RITZ_REFUSE_IF(
        !ritz_decimal_scan_wholes(&at, m->text.line_end,
                                  m->layout == RITZ_MARKET_COORDINATE ? 3 : 2,
                                  n) ||
            at < m->text.line_end || n[0] < 0 || n[1] < 0 || n[2] < 0,
        RITZ_ERR_FORMAT, "'%.*s' is not a size",
        ritz_lines_quoted(m->text.line, m->text.line_end), m->text.line);
    m->nrow = n[0];
    m->ncol = n[1];
    bytes = m->text.end - m->text.at;
    RITZ_REFUSE_IF(m->symmetry != RITZ_MARKET_GENERAL && m->nrow != m->ncol,
                   RITZ_ERR_FORMAT,
                   "a %s matrix cannot be %" PRId64 " x %" PRId64, m->kind,
                   m->nrow, m->ncol);
    RITZ_CHECK(ritz_market_admit_size(m, bytes));
    m->most =
        m->layout == RITZ_MARKET_COORDINATE ? n[2] : array_values(m, bytes);
    RITZ_REFUSE_IF(m->most < 0 || m->most > bytes / 2 + 1, RITZ_ERR_FORMAT,
                   "declares more entries than %" PRId64 " bytes can hold",
                   bytes);
    return RITZ_OK;
}

/* Read the head, and the entries too if they are wanted; what is wrong is
 * said with its line. */
static ritz_status read_lines(ritz_market *m, bool entries)
{
    ritz_status status = read_banner(m);

    if (status == RITZ_OK)
        status = read_size(m);
    if (status == RITZ_OK && entries)
        status = ritz_market_read_entries(m);
    return ritz_market_at_line(m, status);
}

static bool has_banner(const char *bytes, int64_t size)
{
    static const char *const banner[] = {"%%MatrixMarket", NULL};
    const char *at = bytes;

    return take_word(&at, bytes + size, banner) == 0;
}

static ritz_status list_file(const ritz_foreign *file, ritz_listing *out)
{
    ritz_market m = {
        .text = {.at = file->bytes, .end = file->bytes + file->size}};
    ritz_listed item = {0};

    RITZ_CHECK(read_lines(&m, false));
    item.nrow = m.nrow;
    item.ncol = m.ncol;
    item.symmetric = m.symmetry == RITZ_MARKET_SYMMETRIC;
    item.is_complex = m.field == RITZ_MARKET_COMPLEX;
    return ritz_listing_add(out, &item);
}

static ritz_status read_matrix(const ritz_foreign *file,
                               const ritz_listed *which, ritz_matrix *out)
{
    RITZ_OWN(ritz_market)
    m = {.text = {.at = file->bytes, .end = file->bytes + file->size}};

    (void)which; /* there is one */
    RITZ_CHECK(read_lines(&m, true));
    RITZ_CHECK(ritz_market_compress(&m, out));
    snprintf(out->spelling, sizeof out->spelling, "Matrix Market %s, %s, %s",
             layouts[m.layout], fields[m.field], m.kind);
    return RITZ_OK;
}

const ritz_format ritz_format_matrix_market = {
    .name = "matrix-market",
    .summary = "Matrix Market, coordinate or array",
    .reference = "BoisvertPozoRemington1996",
    .recognise = has_banner,
    .maps = true,
    .list = list_file,
    .read = read_matrix,
};
