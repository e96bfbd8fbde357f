/* Lines of Matrix Market: entries with their places, or values by columns. */
#include "formats/matrix_market.h"

#include "formats/decimal.h"

#include <inttypes.h>
#include <math.h>

bool ritz_market_next(ritz_market *m)
{
    ritz_lines *text = &m->text;

    while (ritz_lines_next(text)) {
        while (text->line_end > text->line && text->line_end[-1] == '\r')
            text->line_end--;
        text->line = ritz_decimal_skip(text->line, text->line_end);
        if (text->line < text->line_end && *text->line != '%')
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
                   RITZ_ERR_FORMAT, "line %" PRId64 ": '%.*s' is not a number",
                   m->text.number, ritz_lines_quoted(begin, m->text.line_end),
                   begin);
    RITZ_REFUSE_IF(!isfinite(number.value), RITZ_ERR_FORMAT,
                   "line %" PRId64 ": the value is not finite", m->text.number);
    if (number.digits > m->digits)
        m->digits = number.digits;
    *out = number.value;
    return RITZ_OK;
}

static ritz_status append(ritz_market *m, ritz_market_entry e)
{
    int64_t row = e.row;

    RITZ_REFUSE_IF(m->count == m->most, RITZ_ERR_FORMAT,
                   "line %" PRId64 ": more entries than the %" PRId64
                   " that are declared",
                   m->text.number, m->most);
    RITZ_REFUSE_IF(e.row < 0 || e.row >= m->nrow || e.col < 0 ||
                       e.col >= m->ncol,
                   RITZ_ERR_FORMAT,
                   "line %" PRId64 ": entry (%" PRId64 ", %" PRId64
                   ") lies outside a %" PRId64 " x %" PRId64 " matrix",
                   m->text.number, e.row + 1, e.col + 1, m->nrow, m->ncol);
    RITZ_REFUSE_IF(
        row == e.col && ((m->symmetry == RITZ_MARKET_SKEW &&
                          (e.re != 0.0 || e.im != 0.0)) ||
                         (m->symmetry == RITZ_MARKET_HERMITIAN && e.im != 0.0)),
        RITZ_ERR_FORMAT,
        "line %" PRId64 ": diagonal entry %" PRId64 " cannot be in a %s matrix",
        m->text.number, row + 1, m->kind);
    if (m->symmetry != RITZ_MARKET_GENERAL && e.row < e.col) {
        e.row = e.col;
        e.col = row;
        e.flipped = true;
        ritz_market_mirror(m, &e.re, &e.im);
    }
    m->entry[m->count++] = e;
    return RITZ_OK;
}

/* The line "i j value". */
static ritz_status read_entry(ritz_market *m)
{
    ritz_market_entry e = {.re = 1.0};
    const char *at = m->text.line;
    const char *second = NULL;
    bool good = ritz_decimal_scan_whole(&at, m->text.line_end, &e.row);

    second = ritz_decimal_skip(at, m->text.line_end);
    good = good && second > at;
    at = second;
    good = good && ritz_decimal_scan_whole(&at, m->text.line_end, &e.col);
    RITZ_REFUSE_IF(
        !good || ritz_decimal_is_inside(at, m->text.line_end), RITZ_ERR_FORMAT,
        "line %" PRId64 ": '%.*s' is not an entry 'row column value'",
        m->text.number, ritz_lines_quoted(m->text.line, m->text.line_end),
        m->text.line);
    e.row--;
    e.col--;
    if (m->field != RITZ_MARKET_PATTERN)
        RITZ_CHECK(read_number(m, &at, &e.re));
    if (m->field == RITZ_MARKET_COMPLEX)
        RITZ_CHECK(read_number(m, &at, &e.im));
    RITZ_REFUSE_IF(ritz_decimal_skip(at, m->text.line_end) != m->text.line_end,
                   RITZ_ERR_FORMAT,
                   "line %" PRId64 ": more than an entry on the line",
                   m->text.number);
    return append(m, e);
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
                       "line %" PRId64 ": more values than the %" PRId64
                       " that are declared",
                       m->text.number, m->most);
        RITZ_CHECK(append(m, *next));
        next->row++;
        if (next->row == m->nrow) {
            next->col++;
            next->row = m->symmetry == RITZ_MARKET_GENERAL ? 0 : next->col;
            next->row += m->symmetry == RITZ_MARKET_SKEW;
        }
    }
    return RITZ_OK;
}

ritz_status ritz_market_read_entries(ritz_market *m)
{
    ritz_market_entry next = {.row = m->symmetry == RITZ_MARKET_SKEW};

    while (ritz_market_next(m)) {
        if (m->layout == RITZ_MARKET_COORDINATE)
            RITZ_CHECK(read_entry(m));
        else
            RITZ_CHECK(read_values(m, &next));
    }
    RITZ_REFUSE_IF(m->count < m->most, RITZ_ERR_FORMAT,
                   "line %" PRId64 ": ends after %" PRId64 " of %" PRId64
                   " entries",
                   m->text.number, m->count, m->most);
    return RITZ_OK;
}
