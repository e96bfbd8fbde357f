/*
 * Entries of a matrix as lines of text: "row column value", or the values of an
 * array by columns.
 *
 * An entry given twice is refused: the formats leave open whether it is to be
 * summed, and a stiffness twice too large looks like one. Zeros are not kept,
 * so that all spellings of a matrix give one pattern.
 */
#include "formats/market.h"

#include "base/alloc.h"
#include "base/team.h"
#include "formats/matrix.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void ritz_market_free(ritz_market *m)
{
    free(m->entry);
    m->entry = NULL;
}

/* ---- entries to columns ------------------------------------------------- */

/* a := the value that entry (col, row) has if (row, col) has a. */
static void mirror_value(const ritz_market *m, double *re, double *im)
{
    if (m->symmetry == RITZ_MARKET_SKEW) {
        *re = -*re;
        *im = -*im;
    } else if (m->symmetry == RITZ_MARKET_HERMITIAN) {
        *im = -*im;
    }
}

/* By column, then row. */
static int compare_entries(const void *left, const void *right)
{
    const ritz_market_entry *a = left;
    const ritz_market_entry *b = right;
    int order = (a->col > b->col) - (a->col < b->col);

    return order ? order : (a->row > b->row) - (a->row < b->row);
}

static bool is_sorted(const ritz_market *m)
{
    for (int64_t k = 1; k < m->count; k++)
        if (compare_entries(&m->entry[k - 1], &m->entry[k]) > 0)
            return false;
    return true;
}

/* Sort; of a mirrored pair that agrees keep one, refuse other repetitions. */
static ritz_status settle_entries(ritz_market *m)
{
    int64_t kept = 0;
    int64_t run = 0; /* entries at one place */

    if (!is_sorted(m))
        qsort(m->entry, (size_t)m->count, sizeof *m->entry, compare_entries);
    for (int64_t k = 0; k < m->count; k++) {
        const ritz_market_entry *e = &m->entry[k];
        const ritz_market_entry *last = kept > 0 ? &m->entry[kept - 1] : NULL;

        if (!last || last->row != e->row || last->col != e->col) {
            m->entry[kept++] = *e;
            run = 1;
            continue;
        }
        run++;
        RITZ_REFUSE_IF(last->flipped == e->flipped || run > 2, RITZ_ERR_FORMAT,
                       "entry (%" PRId64 ", %" PRId64 ") is given twice",
                       e->row + 1, e->col + 1);
        RITZ_REFUSE_IF(last->re != e->re || last->im != e->im, RITZ_ERR_FORMAT,
                       "entries (%" PRId64 ", %" PRId64 ") and (%" PRId64
                       ", %" PRId64 ") of a %s matrix disagree",
                       e->row + 1, e->col + 1, e->col + 1, e->row + 1, m->kind);
    }
    m->count = kept;
    return RITZ_OK;
}

static int64_t count_digits(const ritz_market *m)
{
    if (m->field == RITZ_MARKET_INTEGER || m->field == RITZ_MARKET_PATTERN ||
        m->digits > 17)
        return 17; /* whole numbers are exact */
    return m->digits < 1 ? 1 : m->digits;
}

ritz_status ritz_market_compress(ritz_market *m, ritz_matrix *out)
{
    ritz_market_entry sign = {.re = 1.0, .im = 1.0};
    RITZ_OWN(ritz_matrix) new = {0};
    RITZ_OWN(ritz_triplets)
    list = {.is_complex = m->field == RITZ_MARKET_COMPLEX};

    RITZ_CHECK(settle_entries(m));
    RITZ_CHECK(ritz_triplets_reserve(&list, m->count));
    for (int64_t k = 0; k < m->count; k++) {
        const ritz_market_entry *e = &m->entry[k];

        ritz_triplets_put_value(&list, e->row, e->col, e->re, e->im);
    }
    ritz_market_free(m);
    RITZ_CHECK(ritz_triplets_compress(&list, m->nrow, m->ncol, &new));
    mirror_value(m, &sign.re, &sign.im);
    if (m->symmetry != RITZ_MARKET_GENERAL)
        RITZ_CHECK(ritz_matrix_mirror(&new, sign.re, sign.im));
    new.symmetric = m->symmetry == RITZ_MARKET_SYMMETRIC;
    new.digits = count_digits(m);
    RITZ_MOVE(*out, new);
    return RITZ_OK;
}

/* ---- lines of entries --------------------------------------------------- */

bool ritz_market_next_line(ritz_market *m)
{
    ritz_lines *text = &m->text;

    while (ritz_lines_next(text)) {
        while (text->line_end > text->line && text->line_end[-1] == '\r')
            text->line_end--;
        text->line = ritz_decimal_skip(text->line, text->line_end);
        if (text->line < text->line_end && (m->bare || *text->line != '%'))
            return true;
    }
    return false;
}

/* One number, which a blank or the end of the line must follow. */
static ritz_status read_number(ritz_market *m, const char **at, double *out)
{
    const char *begin = ritz_decimal_skip(*at, m->text.line_end);
    ritz_decimal number = {0};

    *at = begin;
    RITZ_REFUSE_IF(!ritz_decimal_scan(at, m->text.line_end, &number) ||
                       ritz_decimal_is_inside(*at, m->text.line_end),
                   RITZ_ERR_FORMAT, "'%.*s' is not a number",
                   ritz_lines_quoted(begin, m->text.line_end), begin);
    RITZ_REFUSE_IF(!isfinite(number.value), RITZ_ERR_FORMAT,
                   "the value is not finite");
    if (number.digits > m->digits)
        m->digits = number.digits;
    *out = number.value;
    return RITZ_OK;
}

static ritz_status append_entry(ritz_market *m, ritz_market_entry e)
{
    int64_t row = e.row;

    RITZ_REFUSE_IF(m->count == m->most, RITZ_ERR_FORMAT,
                   "more entries than the %" PRId64 " that are declared",
                   m->most);
    RITZ_REFUSE_IF(m->bare && (e.row < 0 || e.col < 0), RITZ_ERR_FORMAT,
                   "entry (%" PRId64 ", %" PRId64
                   ") is none: rows and columns are counted from 1",
                   e.row + 1, e.col + 1);
    RITZ_REFUSE_IF(e.row < 0 || e.row >= m->nrow || e.col < 0 ||
                       e.col >= m->ncol,
                   RITZ_ERR_FORMAT,
                   "entry (%" PRId64 ", %" PRId64 ") lies outside a %" PRId64
                   " x %" PRId64 " matrix",
                   e.row + 1, e.col + 1, m->nrow, m->ncol);
    RITZ_REFUSE_IF(
        row == e.col && ((m->symmetry == RITZ_MARKET_SKEW &&
                          (e.re != 0.0 || e.im != 0.0)) ||
                         (m->symmetry == RITZ_MARKET_HERMITIAN && e.im != 0.0)),
        RITZ_ERR_FORMAT, "diagonal entry %" PRId64 " cannot be in a %s matrix",
        row + 1, m->kind);
    if (m->symmetry != RITZ_MARKET_GENERAL && e.row < e.col) {
        e.row = e.col;
        e.col = row;
        e.flipped = true;
        mirror_value(m, &e.re, &e.im);
    }
    m->entry[m->count++] = e;
    return RITZ_OK;
}

/* The line "i j value". */
static ritz_status read_entry(ritz_market *m)
{
    ritz_market_entry e = {.re = 1.0};
    const char *at = m->text.line;
    int64_t n[2] = {0};

    RITZ_REFUSE_IF(
        !ritz_decimal_scan_wholes(&at, m->text.line_end, 2, n) ||
            (m->field != RITZ_MARKET_PATTERN && at == m->text.line_end),
        RITZ_ERR_FORMAT, "'%.*s' is not an entry 'row column value'",
        ritz_lines_quoted(m->text.line, m->text.line_end), m->text.line);
    e.row = n[0] - 1;
    e.col = n[1] - 1;
    if (m->field != RITZ_MARKET_PATTERN)
        RITZ_CHECK(read_number(m, &at, &e.re));
    if (m->field == RITZ_MARKET_COMPLEX)
        RITZ_CHECK(read_number(m, &at, &e.im));
    RITZ_REFUSE_IF(ritz_decimal_skip(at, m->text.line_end) != m->text.line_end,
                   RITZ_ERR_FORMAT, "more than an entry on the line");
    return append_entry(m, e);
}

/* Values of an array on one line, which follow those of the lines before. */
static ritz_status read_values(ritz_market *m, ritz_market_entry *next)
{
    const char *at = m->text.line;

    while (ritz_decimal_skip(at, m->text.line_end) != m->text.line_end) {
        RITZ_CHECK(read_number(m, &at, &next->re));
        if (m->field == RITZ_MARKET_COMPLEX)
            RITZ_CHECK(read_number(m, &at, &next->im));
        RITZ_REFUSE_IF(m->count == m->most, RITZ_ERR_FORMAT,
                       "more values than the %" PRId64 " that are declared",
                       m->most);
        RITZ_CHECK(append_entry(m, *next));
        next->row++;
        if (next->row == m->nrow) {
            next->col++;
            next->row = m->symmetry == RITZ_MARKET_GENERAL ? 0 : next->col;
            next->row += m->symmetry == RITZ_MARKET_SKEW;
        }
    }
    return RITZ_OK;
}

/* Read all lines that are left of m->text. */
static ritz_status read_lines_of_entries(ritz_market *m)
{
    ritz_market_entry next = {.row = m->symmetry == RITZ_MARKET_SKEW};

    while (ritz_market_next_line(m))
        RITZ_CHECK(m->layout == RITZ_MARKET_COORDINATE ? read_entry(m)
                                                       : read_values(m, &next));
    return RITZ_OK;
}

/* ---- entries by several threads ----------------------------------------- */

/*
 * The text is cut into shares, contiguous runs of lines; each share is read by
 * one thread, and the entries are joined in the order of the file. If a share
 * cannot be read, or the number of entries is not the one that a head declares,
 * one thread reads all lines once more, so that the error names the first wrong
 * line.
 */
enum {
    SHARE_BYTES = 1 << 20, /* one thread for each so many bytes of text */
    SPARE = 1000,          /* entries of room in addition to the estimate */
};

typedef struct ritz_market_shares {
    const ritz_market *whole;
    int64_t count;
    ritz_market share[RITZ_TEAM_SHARES];
    ritz_status status[RITZ_TEAM_SHARES];
    int64_t offset[RITZ_TEAM_SHARES]; /* first entry of the share in all */
} ritz_market_shares;

static void ritz_market_shares_free(ritz_market_shares *all)
{
    for (int64_t k = 0; k < all->count; k++)
        ritz_market_free(&all->share[k]);
}

/* Cut the text at ends of lines into at most `most` shares, nearly equal. */
static void cut_shares(const ritz_market *m, int64_t most,
                       ritz_market_shares *all)
{
    const char *begin = m->text.at;
    const char *at = begin;
    const char *end = m->text.end;

    for (int64_t k = 0; k < most && at < end; k++) {
        const char *wanted = begin + (end - begin) / most * (k + 1);
        const char *stop = NULL;
        ritz_market *share = &all->share[all->count++];

        if (k + 1 < most && wanted < end)
            stop = memchr(wanted, '\n', (size_t)(end - wanted));
        *share = *m;
        share->entry = NULL;
        share->text.at = at;
        at = share->text.end = stop ? stop + 1 : end;
    }
}

/* Room is for twice the mean number of entries, as lines may be shorter than
 * the mean line; a share with more entries fails. */
static ritz_status read_share(const ritz_market *m, ritz_market *share)
{
    double part = (double)(share->text.end - share->text.at) /
                  (double)(m->text.end - m->text.at);

    share->most = (int64_t)(2.0 * part * (double)m->most) + SPARE;
    RITZ_CHECK_NEW(share->entry, share->most);
    return read_lines_of_entries(share);
}

static void take_share(int64_t k, void *task)
{
    ritz_market_shares *all = task;

    all->status[k] = read_share(all->whole, &all->share[k]);
}

/* Copy the entries of share k to their place among all. */
static void join_share(int64_t k, void *task)
{
    const ritz_market_shares *all = task;
    const ritz_market *share = &all->share[k];

    memcpy(all->whole->entry + all->offset[k], share->entry,
           (size_t)share->count * sizeof *share->entry);
}

/* Read the entries by several threads. @return false if one thread must read
 * them: the file is small, an array, or wrong */
static bool read_in_shares(ritz_market *m)
{
    const int64_t gain = (m->text.end - m->text.at) / SHARE_BYTES;
    const int threads =
        ritz_team_ready(m->layout == RITZ_MARKET_COORDINATE ? gain : 1);
    RITZ_OWN(ritz_market_shares) all = {.whole = m};
    int64_t total = 0;
    bool right = true;

    if (threads < 2)
        return false;
    cut_shares(m, ritz_team_shares(threads), &all);
    ritz_team_each(threads, all.count, take_share, &all);
    for (int64_t k = 0; k < all.count; k++) {
        right = right && all.status[k] == RITZ_OK;
        all.offset[k] = total;
        total += all.share[k].count;
    }
    if (!right || total > m->most || (total < m->most && !m->bare))
        return false;
    ritz_team_each(threads, all.count, join_share, &all);
    m->count = total;
    for (int64_t k = 0; k < all.count; k++)
        if (all.share[k].digits > m->digits)
            m->digits = all.share[k].digits;
    return true;
}

ritz_status ritz_market_read_entries(ritz_market *m)
{
    RITZ_CHECK_NEW(m->entry, m->most);
    if (read_in_shares(m))
        return RITZ_OK;
    RITZ_CHECK(read_lines_of_entries(m));
    RITZ_REFUSE_IF(m->count < m->most && !m->bare, RITZ_ERR_FORMAT,
                   "ends after %" PRId64 " of %" PRId64 " entries", m->count,
                   m->most);
    return RITZ_OK;
}

/* ---- what heads and errors share ---------------------------------------- */

/* Rows or columns that a file may have beyond one for each byte. Where no head
   states them, a wrong digit of an index would ask for as many. */
enum { NULL_ROWS = 32000000, BARE_ROWS = 1000000 };

ritz_status ritz_market_admit_size(const ritz_market *m, int64_t bytes)
{
    const int64_t spare = m->bare ? BARE_ROWS : NULL_ROWS;

    RITZ_REFUSE_IF(
        m->nrow - spare > bytes || m->ncol - spare > bytes, RITZ_ERR_FORMAT,
        "%" PRId64 " x %" PRId64 " is far more than the file can fill", m->nrow,
        m->ncol);
    return RITZ_OK;
}

ritz_status ritz_market_at_line(const ritz_market *m, ritz_status status)
{
    char line[32];

    snprintf(line, sizeof line, "line %" PRId64,
             m->text.number > 0 ? m->text.number : 1);
    return ritz_context(status, line);
}
