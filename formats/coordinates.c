/*
 * A sparse matrix as text without a header, an entry a line, counted from 1:
 *
 *     row column value
 *
 * CalculiX writes one triangle with the diagonal, by columns (*FREQUENCY,
 * SOLVER=MATRIXSTORAGE) [Dhondt2022]; Abaqus writes all entries (*MATRIX
 * OUTPUT, FORMAT=COORDINATE) [Abaqus2016]. Such a file states neither its order
 * nor its symmetry. The order is the largest row or column, of entries that are
 * zero too. A matrix with entries in one triangle only is symmetric; one with
 * entries in both is taken as it stands.
 */
#include "formats/market.h"
#include "formats/matrix.h"

#include <stdio.h>

/* Whether the text is a value with a point or an exponent, and nothing else:
 * three whole numbers may be a size. */
static bool is_real(const char *at, const char *end)
{
    ritz_decimal number = {0};
    const char *from = at;
    bool marked = false;

    if (!ritz_decimal_scan(&at, end, &number))
        return false;
    for (; from < at; from++)
        marked = marked || *from == '.' || (*from | 32) == 'e';
    return marked && ritz_decimal_skip(at, end) == end;
}

/* The first line that is not blank is an entry: what is wrong with others is
 * said with their line. */
static bool begins_with_entry(const char *bytes, int64_t size)
{
    ritz_market m = {.text = {.at = bytes, .end = bytes + size}, .bare = true};
    const char *at = NULL;
    int64_t place[2] = {0};

    if (!ritz_market_next_line(&m))
        return false;
    at = m.text.line;
    return ritz_decimal_scan_wholes(&at, m.text.line_end, 2, place) &&
           place[0] > 0 && place[1] > 0 && is_real(at, m.text.line_end);
}

static int64_t count_lines(const char *bytes, int64_t size)
{
    ritz_lines text = {.at = bytes, .end = bytes + size};

    while (ritz_lines_next(&text))
        continue;
    return text.number;
}

/* The order of the matrix, and whether a triangle has to be completed. */
static void settle_shape(ritz_market *m)
{
    bool above = false, below = false;
    int64_t n = 0;

    for (int64_t k = 0; k < m->count; k++) {
        const ritz_market_entry *e = &m->entry[k];

        above = above || e->row < e->col;
        below = below || e->row > e->col;
        n = e->row >= n ? e->row + 1 : n;
        n = e->col >= n ? e->col + 1 : n;
    }
    m->nrow = m->ncol = n;
    m->symmetry = above && below ? RITZ_MARKET_GENERAL : RITZ_MARKET_SYMMETRIC;
}

/* Nothing but reading tells how large it is. */
static ritz_status list_file(const ritz_foreign *file, ritz_listing *out)
{
    const ritz_listed item = {.nrow = -1, .ncol = -1};

    (void)file;
    return ritz_listing_add(out, &item);
}

static ritz_status read_matrix(const ritz_foreign *file,
                               const ritz_listed *which, ritz_matrix *out)
{
    RITZ_OWN(ritz_market)
    m = {.text = {.at = file->bytes, .end = file->bytes + file->size},
         .bare = true,
         .kind = "general",
         .nrow = INT64_MAX,
         .ncol = INT64_MAX,
         .most = count_lines(file->bytes, file->size)};

    (void)which; /* there is one */
    RITZ_CHECK(ritz_market_at_line(&m, ritz_market_read_entries(&m)));
    RITZ_REFUSE_IF(m.count == 0, RITZ_ERR_FORMAT, "has no entry");
    settle_shape(&m);
    RITZ_CHECK(ritz_market_admit_size(&m, file->size));
    RITZ_CHECK(ritz_market_compress(&m, out));
    snprintf(out->spelling, sizeof out->spelling,
             "coordinates without a header, %s",
             out->symmetric ? "one triangle" : "both triangles");
    return RITZ_OK;
}

const ritz_format ritz_format_coordinates = {
    .name = "coordinates",
    .summary = "row column value without a header, of CalculiX or Abaqus",
    .reference = "Dhondt2022",
    .recognise = begins_with_entry,
    .maps = true,
    .list = list_file,
    .read = read_matrix,
};
