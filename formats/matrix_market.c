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
#include "formats/decimal.h"

#include "base/alloc.h"

#include <ritz/foreign.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Rows or columns that a file may declare beyond one for each byte. */
enum { NULL_ROWS = 32000000 };

typedef enum layout { COORDINATE, ARRAY } layout;
typedef enum field { REAL, DOUBLE, INTEGER, COMPLEX, PATTERN } field;
typedef enum symmetry { GENERAL, SYMMETRIC, SKEW, HERMITIAN } symmetry;

static const char *const layouts[] = {"coordinate", "array", NULL};
static const char *const fields[] = {"real",    "double",  "integer",
                                     "complex", "pattern", NULL};
static const char *const symmetries[] = {"general", "symmetric",
                                         "skew-symmetric", "hermitian", NULL};

typedef struct entry {
    int64_t row, col; /* from 0; of symmetric files in the lower triangle */
    double re, im;
    bool flipped; /* stood in the upper triangle */
} entry;

typedef struct market {
    const char *at, *end;
    const char *line, *line_end;
    int64_t number; /* of that line, from 1 */
    int layout, field, symmetry;
    int64_t nrow, ncol;
    int64_t most; /* entries there is room for */
    int64_t count;
    entry *entry;
    int64_t digits;
} market;

/* Take the next line that is neither blank nor a comment. */
static bool take_line(market *m)
{
    while (m->at < m->end) {
        const char *stop = memchr(m->at, '\n', (size_t)(m->end - m->at));

        m->line = m->at;
        m->line_end = stop ? stop : m->end;
        m->at = stop ? stop + 1 : m->end;
        m->number++;
        while (m->line_end > m->line && m->line_end[-1] == '\r')
            m->line_end--;
        m->line = ritz_decimal_skip(m->line, m->line_end);
        if (m->line < m->line_end && *m->line != '%')
            return true;
    }
    return false;
}

/* Move over one word of the banner; its place in `words`, -1 if not there. */
static int take_word(const char **at, const char *end, const char *const *words)
{
    const char *begin = ritz_decimal_skip(*at, end);
    const char *stop = begin;

    while (stop<end && * stop> ' ')
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

static ritz_status read_banner(market *m)
{
    static const char *const banner[] = {"%%MatrixMarket", NULL};
    static const char *const object[] = {"matrix", NULL};
    ritz_status status = RITZ_OK;
    const char *stop = memchr(m->at, '\n', (size_t)(m->end - m->at));
    const char *at = m->at;

    stop = stop ? stop : m->end;
    m->at = stop < m->end ? stop + 1 : stop;
    m->number = 1;
    RITZ_FAIL_IF(take_word(&at, stop, banner) < 0 ||
                     take_word(&at, stop, object) < 0,
                 RITZ_ERR_FORMAT, "line 1: not '%%%%MatrixMarket matrix'");
    m->layout = take_word(&at, stop, layouts);
    RITZ_FAIL_IF(m->layout < 0, RITZ_ERR_FORMAT,
                 "line 1: neither 'coordinate' nor 'array'");
    m->field = take_word(&at, stop, fields);
    RITZ_FAIL_IF(m->field < 0 || (m->field == PATTERN && m->layout == ARRAY),
                 RITZ_ERR_FORMAT,
                 "line 1: the values are not real, integer, complex or "
                 "a pattern");
    m->symmetry = take_word(&at, stop, symmetries);
    RITZ_FAIL_IF(m->symmetry < 0, RITZ_ERR_FORMAT,
                 "line 1: not general, symmetric, skew-symmetric or "
                 "hermitian");
    RITZ_FAIL_IF(m->symmetry == HERMITIAN && m->field != COMPLEX,
                 RITZ_ERR_FORMAT, "line 1: hermitian, but not complex");
done:
    return status;
}

/* Whole numbers, the whole line. */
static bool read_whole(const market *m, int64_t count, int64_t *out)
{
    const char *at = m->line;

    for (int64_t k = 0; k < count; k++) {
        if (!ritz_decimal_scan_whole(&at, m->line_end, &out[k]) ||
            (at < m->line_end && at == ritz_decimal_skip(at, m->line_end)))
            return false;
        at = ritz_decimal_skip(at, m->line_end);
    }
    return at == m->line_end;
}

/* Values of an array, or -1 if there are more than the file has bytes. */
static int64_t array_values(const market *m, int64_t bytes)
{
    int64_t n = m->nrow;

    if (m->nrow == 0 || m->ncol == 0)
        return 0;
    if (m->symmetry == GENERAL)
        return m->nrow > bytes / m->ncol ? -1 : m->nrow * m->ncol;
    if (n / 2 > bytes / n)
        return -1;
    return m->symmetry == SKEW ? n * (n - 1) / 2 : n * (n + 1) / 2;
}

/* Sizes, and room for entries: each takes at least two bytes of the file. */
static ritz_status read_size(market *m)
{
    ritz_status status = RITZ_OK;
    int64_t n[3] = {0};
    int64_t bytes = 0;

    RITZ_FAIL_IF(!take_line(m), RITZ_ERR_FORMAT,
                 "line %" PRId64 ": ends before its size", m->number);
    RITZ_FAIL_IF(!read_whole(m, m->layout == COORDINATE ? 3 : 2, n) ||
                     n[0] < 0 || n[1] < 0 || n[2] < 0,
                 RITZ_ERR_FORMAT, "line %" PRId64 ": '%.*s' is not a size",
                 m->number, (int)(m->line_end - m->line) % 80, m->line);
    m->nrow = n[0];
    m->ncol = n[1];
    bytes = m->end - m->at;
    RITZ_FAIL_IF(m->symmetry != GENERAL && m->nrow != m->ncol, RITZ_ERR_FORMAT,
                 "line %" PRId64 ": a %s matrix cannot be %" PRId64
                 " x %" PRId64,
                 m->number, symmetries[m->symmetry], m->nrow, m->ncol);
    RITZ_FAIL_IF(m->nrow - NULL_ROWS > bytes || m->ncol - NULL_ROWS > bytes,
                 RITZ_ERR_FORMAT,
                 "line %" PRId64 ": %" PRId64 " x %" PRId64
                 " is far more than the file can fill",
                 m->number, m->nrow, m->ncol);
    m->most = m->layout == COORDINATE ? n[2] : array_values(m, bytes);
    RITZ_FAIL_IF(m->most < 0 || m->most > bytes / 2 + 1, RITZ_ERR_FORMAT,
                 "line %" PRId64 ": declares more entries than %" PRId64
                 " bytes can hold",
                 m->number, bytes);
    RITZ_NEW(m->entry, m->most);
done:
    return status;
}

/* a := the value that entry (col, row) has if (row, col) has a. */
static void mirror(const market *m, double *re, double *im)
{
    if (m->symmetry == SKEW) {
        *re = -*re;
        *im = -*im;
    } else if (m->symmetry == HERMITIAN) {
        *im = -*im;
    }
}

/* One number, which a blank or the end of the line must follow. */
static ritz_status read_number(market *m, const char **at, double *out)
{
    ritz_status status = RITZ_OK;
    const char *begin = ritz_decimal_skip(*at, m->line_end);
    ritz_decimal number = {0};

    *at = begin;
    RITZ_FAIL_IF(
        !ritz_decimal_scan(at, m->line_end, &number) ||
            (*at < m->line_end && *at == ritz_decimal_skip(*at, m->line_end)),
        RITZ_ERR_FORMAT, "line %" PRId64 ": '%.*s' is not a number", m->number,
        (int)(m->line_end - begin) % 80, begin);
    RITZ_FAIL_IF(!isfinite(number.value), RITZ_ERR_FORMAT,
                 "line %" PRId64 ": the value is not finite", m->number);
    if (number.digits > m->digits)
        m->digits = number.digits;
    *out = number.value;
done:
    return status;
}

static ritz_status append(market *m, entry e)
{
    ritz_status status = RITZ_OK;
    int64_t row = e.row;

    RITZ_FAIL_IF(m->count == m->most, RITZ_ERR_FORMAT,
                 "line %" PRId64 ": more entries than the %" PRId64
                 " that are declared",
                 m->number, m->most);
    RITZ_FAIL_IF(e.row < 0 || e.row >= m->nrow || e.col < 0 || e.col >= m->ncol,
                 RITZ_ERR_FORMAT,
                 "line %" PRId64 ": entry (%" PRId64 ", %" PRId64
                 ") lies outside a %" PRId64 " x %" PRId64 " matrix",
                 m->number, e.row + 1, e.col + 1, m->nrow, m->ncol);
    RITZ_FAIL_IF(row == e.col &&
                     ((m->symmetry == SKEW && (e.re != 0.0 || e.im != 0.0)) ||
                      (m->symmetry == HERMITIAN && e.im != 0.0)),
                 RITZ_ERR_FORMAT,
                 "line %" PRId64 ": diagonal entry %" PRId64
                 " cannot be in a %s matrix",
                 m->number, row + 1, symmetries[m->symmetry]);
    if (m->symmetry != GENERAL && e.row < e.col) {
        e.row = e.col;
        e.col = row;
        e.flipped = true;
        mirror(m, &e.re, &e.im);
    }
    m->entry[m->count++] = e;
done:
    return status;
}

/* The line "i j value". */
static ritz_status read_entry(market *m)
{
    ritz_status status = RITZ_OK;
    entry e = {.re = 1.0};
    const char *at = m->line;
    const char *second = NULL;
    bool good = ritz_decimal_scan_whole(&at, m->line_end, &e.row);

    second = ritz_decimal_skip(at, m->line_end);
    good = good && second > at;
    at = second;
    good = good && ritz_decimal_scan_whole(&at, m->line_end, &e.col);
    RITZ_FAIL_IF(
        !good || (at < m->line_end && at == ritz_decimal_skip(at, m->line_end)),
        RITZ_ERR_FORMAT,
        "line %" PRId64 ": '%.*s' is not an entry 'row column value'",
        m->number, (int)(m->line_end - m->line) % 80, m->line);
    e.row--;
    e.col--;
    if (m->field != PATTERN)
        RITZ_TRY(read_number(m, &at, &e.re));
    if (m->field == COMPLEX)
        RITZ_TRY(read_number(m, &at, &e.im));
    RITZ_FAIL_IF(ritz_decimal_skip(at, m->line_end) != m->line_end,
                 RITZ_ERR_FORMAT,
                 "line %" PRId64 ": more than an entry on the line", m->number);
    RITZ_TRY(append(m, e));
done:
    return status;
}

/* Values of an array on one line, which follow those of the lines before. */
static ritz_status read_values(market *m, entry *next)
{
    ritz_status status = RITZ_OK;
    const char *at = m->line;

    while (ritz_decimal_skip(at, m->line_end) != m->line_end) {
        RITZ_TRY(read_number(m, &at, &next->re));
        if (m->field == COMPLEX)
            RITZ_TRY(read_number(m, &at, &next->im));
        RITZ_FAIL_IF(m->count == m->most, RITZ_ERR_FORMAT,
                     "line %" PRId64 ": more values than the %" PRId64
                     " that are declared",
                     m->number, m->most);
        RITZ_TRY(append(m, *next));
        next->row++;
        if (next->row == m->nrow) {
            next->col++;
            next->row = m->symmetry == GENERAL ? 0 : next->col;
            next->row += m->symmetry == SKEW;
        }
    }
done:
    return status;
}

static ritz_status read_entries(market *m)
{
    ritz_status status = RITZ_OK;
    entry next = {.row = m->symmetry == SKEW};

    while (take_line(m)) {
        if (m->layout == COORDINATE)
            RITZ_TRY(read_entry(m));
        else
            RITZ_TRY(read_values(m, &next));
    }
    RITZ_FAIL_IF(m->count < m->most, RITZ_ERR_FORMAT,
                 "line %" PRId64 ": ends after %" PRId64 " of %" PRId64
                 " entries",
                 m->number, m->count, m->most);
done:
    return status;
}

static bool is_sorted(const market *m)
{
    for (int64_t k = 1; k < m->count; k++) {
        const entry *a = &m->entry[k - 1];
        const entry *b = &m->entry[k];

        if (a->col > b->col || (a->col == b->col && a->row > b->row))
            return false;
    }
    return true;
}

/* Stable counting sort of the entries, by row or by column. */
static ritz_status sort_by(market *m, bool by_row)
{
    ritz_status status = RITZ_OK;
    int64_t n = by_row ? m->nrow : m->ncol;
    int64_t *start = NULL;
    entry *sorted = NULL;

    RITZ_NEW(start, n + 1);
    RITZ_NEW(sorted, m->count);
    for (int64_t k = 0; k < m->count; k++)
        start[(by_row ? m->entry[k].row : m->entry[k].col) + 1]++;
    for (int64_t j = 0; j < n; j++)
        start[j + 1] += start[j];
    for (int64_t k = 0; k < m->count; k++)
        sorted[start[by_row ? m->entry[k].row : m->entry[k].col]++] =
            m->entry[k];
    free(m->entry);
    m->entry = sorted;
    sorted = NULL;
done:
    free(start);
    free(sorted);
    return status;
}

/* Sort; of a mirrored pair that agrees keep one, refuse other repetitions. */
static ritz_status settle(market *m)
{
    ritz_status status = RITZ_OK;
    int64_t kept = 0;
    int64_t run = 0; /* entries at one place */

    if (!is_sorted(m)) {
        RITZ_TRY(sort_by(m, true));
        RITZ_TRY(sort_by(m, false));
    }
    for (int64_t k = 0; k < m->count; k++) {
        const entry *e = &m->entry[k];
        const entry *last = kept > 0 ? &m->entry[kept - 1] : NULL;

        if (!last || last->row != e->row || last->col != e->col) {
            m->entry[kept++] = *e;
            run = 1;
            continue;
        }
        run++;
        RITZ_FAIL_IF(last->flipped == e->flipped || run > 2, RITZ_ERR_FORMAT,
                     "entry (%" PRId64 ", %" PRId64 ") is given twice",
                     e->row + 1, e->col + 1);
        RITZ_FAIL_IF(last->re != e->re || last->im != e->im, RITZ_ERR_FORMAT,
                     "entries (%" PRId64 ", %" PRId64 ") and (%" PRId64
                     ", %" PRId64 ") of a %s matrix disagree",
                     e->row + 1, e->col + 1, e->col + 1, e->row + 1,
                     symmetries[m->symmetry]);
    }
    m->count = kept;
done:
    return status;
}

static bool is_zero(const entry *e)
{
    return e->re == 0.0 && e->im == 0.0;
}

/*
 * Columns from sorted entries. Mirrored ones come from columns further left, so
 * that they are in place, in order, when a column's own entries follow.
 */
static ritz_status compress(const market *m, ritz_matrix *out)
{
    ritz_status status = RITZ_OK;
    ritz_sparse A = {0};
    int64_t *next = NULL;
    double *imaginary = NULL;

    RITZ_NEW(next, m->ncol + 1);
    for (int64_t k = 0; k < m->count; k++) {
        const entry *e = &m->entry[k];

        if (is_zero(e))
            continue;
        next[e->col + 1]++;
        if (m->symmetry != GENERAL && e->row != e->col)
            next[e->row + 1]++;
    }
    for (int64_t j = 0; j < m->ncol; j++)
        next[j + 1] += next[j];
    RITZ_TRY(ritz_sparse_new(m->nrow, m->ncol, next[m->ncol], &A));
    memcpy(A.colptr, next, (size_t)(m->ncol + 1) * sizeof *next);
    if (m->field == COMPLEX)
        RITZ_NEW(imaginary, next[m->ncol]);
    for (int64_t k = 0; k < m->count; k++) {
        entry e = m->entry[k];
        bool twice = m->symmetry != GENERAL && e.row != e.col;

        for (int turn = 0; turn < (twice ? 2 : 1) && !is_zero(&e); turn++) {
            int64_t p = next[turn ? e.row : e.col]++;

            if (turn)
                mirror(m, &e.re, &e.im);
            A.rowind[p] = turn ? e.col : e.row;
            A.val[p] = e.re;
            if (imaginary)
                imaginary[p] = e.im;
        }
    }
    out->A = A;
    out->imaginary = imaginary;
    A = (ritz_sparse){0};
    imaginary = NULL;
done:
    free(next);
    free(imaginary);
    ritz_sparse_free(&A);
    return status;
}

static bool recognise(const char *bytes, int64_t size)
{
    static const char *const banner[] = {"%%MatrixMarket", NULL};
    const char *at = bytes;

    return take_word(&at, bytes + size, banner) == 0;
}

static ritz_status read_all(const char *bytes, int64_t size, ritz_matrices *out)
{
    ritz_status status = RITZ_OK;
    market m = {.at = bytes, .end = bytes + size};
    ritz_matrix *matrix = NULL;

    RITZ_TRY(read_banner(&m));
    RITZ_TRY(read_size(&m));
    RITZ_TRY(read_entries(&m));
    RITZ_TRY(settle(&m));
    RITZ_NEW(matrix, 1);
    RITZ_TRY(compress(&m, matrix));
    matrix->symmetric = m.symmetry == SYMMETRIC;
    matrix->digits = m.digits;
    if (m.field == INTEGER || m.field == PATTERN || m.digits > 17)
        matrix->digits = 17; /* whole numbers are exact */
    if (matrix->digits < 1)
        matrix->digits = 1;
    snprintf(matrix->spelling, sizeof matrix->spelling,
             "Matrix Market %s, %s, %s", layouts[m.layout], fields[m.field],
             symmetries[m.symmetry]);
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
