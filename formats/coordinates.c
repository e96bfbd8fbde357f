/*
 * A sparse matrix as text without a header, an entry a line, counted from 1:
 *
 *     row column value
 *
 * CalculiX writes one triangle with the diagonal, by columns (*FREQUENCY,
 * SOLVER=MATRIXSTORAGE) [Dhondt2022]; Abaqus writes all entries (*MATRIX
 * OUTPUT, FORMAT=COORDINATE) [Abaqus2016]. Such a file states neither its order
 * nor its symmetry. The order is the largest number of a row or column; entries
 * that are zero count. If no entry (i, j) off the diagonal has its counterpart
 * (j, i) in the file, the matrix is symmetric and the counterparts are equal.
 * If each has, the matrix is read as it is. If only some have, the file is
 * refused, since a missing counterpart could be zero or equal.
 */
#include "base/alloc.h"
#include "formats/market.h"
#include "formats/matrix.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

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

/* Only the first line that is not blank decides whether a file has this format.
 * A later line that is no entry is an error, which names the line. */
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

typedef struct pair_place {
    int64_t low, high; /* of row and column */
    int64_t k;         /* its entry */
} pair_place;

static int compare_places(const void *left, const void *right)
{
    const pair_place *a = left, *b = right;
    const int order = (a->low > b->low) - (a->low < b->low);

    return order ? order : (a->high > b->high) - (a->high < b->high);
}

/* Hash z to 64 bits that look random [Steele2014]. */
static uint64_t mix(uint64_t z)
{
    z += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

/* Whether each entry off the diagonal has a counterpart: then the hashes of
 * {row, column} have equal sums in both triangles. Otherwise the sums are
 * different, but for a chance of about 2^-64. It is faster than sorting. */
static bool all_paired(const ritz_market *m)
{
    uint64_t difference = 0;

    for (int64_t k = 0; k < m->count; k++) {
        const uint64_t i = (uint64_t)m->entry[k].row;
        const uint64_t j = (uint64_t)m->entry[k].col;

        if (i > j)
            difference += mix(mix(i) ^ j);
        else if (i < j)
            difference -= mix(mix(j) ^ i);
    }
    return difference == 0;
}

/* Entries off the diagonal, sorted so that counterparts are neighbours. */
static ritz_status list_places(const ritz_market *m, int64_t *count,
                               pair_place **out)
{
    RITZ_CHECK_NEW(*out, m->count);
    for (int64_t k = 0; k < m->count; k++) {
        const int64_t i = m->entry[k].row, j = m->entry[k].col;

        if (i != j)
            (*out)[(*count)++] = (pair_place){i < j ? i : j, i < j ? j : i, k};
    }
    qsort(*out, (size_t)*count, sizeof **out, compare_places);
    return RITZ_OK;
}

/* *out tells whether entries have counterparts. A file in which some have,
 * while others that are not zero have none, is refused. */
static ritz_status find_pairs(const ritz_market *m, bool *out)
{
    RITZ_OWN_ARRAY pair_place *place = NULL;
    const ritz_market_entry *alone = NULL;
    int64_t count = 0;

    *out = all_paired(m);
    if (*out)
        return RITZ_OK;
    RITZ_CHECK(list_places(m, &count, &place));
    for (int64_t k = 0; k < count; k++) {
        const ritz_market_entry *e = &m->entry[place[k].k];

        if (k + 1 < count && compare_places(&place[k], &place[k + 1]) == 0) {
            *out = true;
            while (k + 1 < count &&
                   compare_places(&place[k], &place[k + 1]) == 0)
                k++; /* an entry that is given twice is refused later */
        } else if (!alone && e->re != 0.0) {
            alone = e;
        }
    }
    RITZ_REFUSE_IF(*out && alone, RITZ_ERR_FORMAT,
                   "entry (%" PRId64 ", %" PRId64 ") has no counterpart across "
                   "the diagonal, but others have: it may be zero there, or "
                   "equal",
                   alone->row + 1, alone->col + 1);
    return RITZ_OK;
}

/* Entries of the upper triangle of a symmetric matrix go to the lower one. */
static void turn_to_lower(ritz_market *m)
{
    for (int64_t k = 0; k < m->count; k++) {
        ritz_market_entry *e = &m->entry[k];
        const int64_t row = e->row;

        if (row >= e->col)
            continue;
        e->row = e->col;
        e->col = row;
        e->flipped = true;
    }
}

/* The order of the matrix, and whether it has to be completed. */
static ritz_status settle_shape(ritz_market *m)
{
    bool above = false, below = false, paired = false;
    int64_t n = 0;

    for (int64_t k = 0; k < m->count; k++) {
        const ritz_market_entry *e = &m->entry[k];

        above = above || e->row < e->col;
        below = below || e->row > e->col;
        n = e->row >= n ? e->row + 1 : n;
        n = e->col >= n ? e->col + 1 : n;
    }
    m->nrow = m->ncol = n;
    if (above && below)
        RITZ_CHECK(find_pairs(m, &paired));
    if (above && below && !paired)
        turn_to_lower(m);
    m->symmetry = paired ? RITZ_MARKET_GENERAL : RITZ_MARKET_SYMMETRIC;
    return RITZ_OK;
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
    RITZ_CHECK(settle_shape(&m));
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
