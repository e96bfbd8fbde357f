/*
 * OUTPUT4 as text: lines of fixed fields, which may touch each other.
 *
 *     NCOL NROW FORM TYPE NAME 1P,nEw.d    4I8,A8 or 2I16,2I8,A8
 *     ICOL IROW NW                         3I8; IROW = 0: strings follow
 *     IS  or  L+1 IROW                     before each string
 *     numbers, n to a line, w wide
 *
 * NW counts numbers in a dense column, words and string headers in a sparse
 * one. A column numbered NCOL + 1 ends the matrix. Integers are taken as words
 * where there are as many as expected, else as fields of 8 or 16.
 */
#include "formats/decimal.h"
#include "formats/lines.h"
#include "formats/output4.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

typedef struct ritz_output4_text {
    ritz_lines lines;
    int64_t per_line, width, digits; /* of nEw.d */
    char format[24];                 /* the same as written */
} ritz_output4_text;

/* ---- lines -------------------------------------------------------------- */

/* Take a line, less its '\r'; false at the end of the file. */
static bool take_line(ritz_output4_text *t)
{
    ritz_lines *lines = &t->lines;

    if (!ritz_lines_next(lines))
        return false;
    if (lines->line_end > lines->line && lines->line_end[-1] == '\r')
        lines->line_end--;
    return true;
}

/* Take lines until one is not blank. */
static bool take_filled_line(ritz_output4_text *t)
{
    while (take_line(t))
        if (ritz_decimal_skip(t->lines.line, t->lines.line_end) !=
            t->lines.line_end)
            return true;
    return false;
}

/* `count` integers in fields of some width, the line blank behind them. */
static bool read_fields(const char *at, const char *end, const int64_t *width,
                        int64_t count, int64_t *out)
{
    for (int64_t k = 0; k < count; k++) {
        const char *stop = end - at > width[k] ? at + width[k] : end;

        at = ritz_decimal_skip(at, stop);
        if (!ritz_decimal_scan_whole(&at, stop, &out[k]) ||
            ritz_decimal_skip(at, stop) != stop)
            return false;
        at = stop;
    }
    return true;
}

/* @p count integers of the line: words, or else fields of 8 or of 16. */
static bool take_integers(const ritz_output4_text *t, int64_t count,
                          int64_t *out)
{
    static const int64_t widths[2][3] = {{8, 8, 8}, {16, 16, 16}};

    if (ritz_decimal_scan_row(t->lines.line, t->lines.line_end, count, out))
        return true;
    for (int k = 0; k < 2; k++)
        if (t->lines.line_end - t->lines.line == widths[k][0] * count &&
            read_fields(t->lines.line, t->lines.line_end, widths[k], count,
                        out))
            return true;
    return false;
}

/* A whole number of at most 3 digits that must be followed by something. */
static bool small_number(const char **at, const char *end, int64_t *out)
{
    const char *start = *at;

    return *at < end && **at >= '0' && **at <= '9' &&
           ritz_decimal_scan_whole(at, end, out) && *at - start <= 3;
}

/* "1P,3E23.16" or "5E16.9" at `at`, up to a blank, '|' or the end. */
static bool read_format(const char *at, const char *end, ritz_output4_text *t)
{
    const char *start = at;
    bool scaled = end - at > 3 && at[0] == '1' && (at[1] | 32) == 'p';
    int64_t decimals = 0;

    if (scaled)
        at += at[2] == ',' ? 3 : 2;
    if (!small_number(&at, end, &t->per_line) || at == end ||
        ((*at | 32) != 'e' && (*at | 32) != 'd'))
        return false;
    at++;
    if (!small_number(&at, end, &t->width) || at == end || *at++ != '.' ||
        !small_number(&at, end, &decimals))
        return false;
    if (at < end && *at != ' ' && *at != '|' && *at != '\0')
        return false;
    if (t->per_line < 1 || t->width < 3 || decimals >= t->width)
        return false;
    t->digits = decimals + scaled;
    snprintf(t->format, sizeof t->format, "%.*s", (int)(at - start), start);
    return true;
}

/* Name and format behind the four integers of a header. */
static bool read_label(const char *at, const char *end, ritz_output4_text *t,
                       char name[RITZ_NAME_SIZE])
{
    const char *name_end = end - at > 8 ? at + 8 : end;
    bool found = false;

    for (const char *c = name_end; c < end && !found; c++)
        found = read_format(c, end, t);
    if (!found && ritz_decimal_skip(name_end, end) != end)
        return false;
    for (const char *c = at; c < name_end && !found; c++) {
        found = read_format(c, end, t); /* a short name without padding */
        if (found)
            name_end = c;
    }
    if (!found) {
        static const char usual[] = "5E16.9";

        /* without 1P the point is in front of all digits, but not here */
        found = read_format(usual, usual + strlen(usual), t);
        t->digits++;
    }
    if (t->digits > 17)
        t->digits = 17;
    if (t->digits < 1)
        t->digits = 1;
    ritz_output4_name(at, name_end - at, name);
    return found;
}

/* The line as a header of a matrix, and the nEw.d that it states. */
static bool take_header(ritz_output4_text *t, ritz_output4_header *out)
{
    static const int64_t widths[2][4] = {{8, 8, 8, 8}, {16, 16, 8, 8}};
    static const int64_t total[2] = {32, 48};
    int64_t n[4] = {0};

    for (int k = 0; k < 2; k++) {
        ritz_output4_header h = {0};

        if (t->lines.line_end - t->lines.line < total[k] ||
            !read_fields(t->lines.line, t->lines.line + total[k], widths[k], 4,
                         n) ||
            !read_label(t->lines.line + total[k], t->lines.line_end, t, h.name))
            continue;
        h.ncol = n[0];
        h.nrow = n[1] < 0 ? -n[1] : n[1];
        h.bigmat = n[1] < 0 || n[1] >= 65536;
        h.form = n[2];
        h.type = n[3];
        *out = h;
        return h.ncol >= 0 && h.type >= 1 && h.type <= 4;
    }
    return false;
}

/* ---- columns ------------------------------------------------------------ */

/* One number of the line, `k` fields from its left. */
static ritz_status read_number(const ritz_output4_text *t,
                               const ritz_output4_build *build, int64_t k,
                               double *out)
{
    ritz_decimal number = {0};
    const char *left = t->lines.line + k * t->width;
    const char *end = NULL;
    const char *at = left;

    RITZ_REFUSE_IF(left >= t->lines.line_end, RITZ_ERR_FORMAT,
                   "line %" PRId64 ": column %" PRId64
                   " of '%s' wants more numbers than the %" PRId64 " here",
                   t->lines.number, build->column + 1, build->header.name, k);
    end = t->lines.line_end - left > t->width ? left + t->width
                                              : t->lines.line_end;
    at = ritz_decimal_skip(at, end);
    RITZ_REFUSE_IF(!ritz_decimal_scan(&at, end, &number) ||
                       ritz_decimal_skip(at, end) != end,
                   RITZ_ERR_FORMAT,
                   "line %" PRId64 ": '%.*s' in column %" PRId64
                   " of '%s' is not a number",
                   t->lines.number, (int)(end - left), left, build->column + 1,
                   build->header.name);
    *out = number.value;
    return RITZ_OK;
}

/* `reals` numbers, n to a line, as values from row `row`. */
static ritz_status read_numbers(ritz_output4_text *t, ritz_output4_build *build,
                                int64_t row, int64_t reals)
{
    double number[2] = {0.0, 0.0};
    int64_t held = 0;

    RITZ_REFUSE_IF(reals / 2 > t->lines.end - t->lines.at, RITZ_ERR_FORMAT,
                   "column %" PRId64 " of '%s' wants %" PRId64
                   " numbers, more than are left in the file",
                   build->column + 1, build->header.name, reals);
    RITZ_CHECK(ritz_output4_rows(build, row, reals / build->numbers));
    for (int64_t done_ = 0; done_ < reals;) {
        int64_t here =
            reals - done_ < t->per_line ? reals - done_ : t->per_line;

        RITZ_REFUSE_IF(!take_line(t), RITZ_ERR_FORMAT,
                       "column %" PRId64 " of '%s' ends after %" PRId64
                       " of %" PRId64 " numbers",
                       build->column + 1, build->header.name, done_, reals);
        for (int64_t k = 0; k < here; k++) {
            RITZ_CHECK(read_number(t, build, k, &number[held++]));
            if (held < build->numbers)
                continue;
            if (!isfinite(number[0]) || !isfinite(number[1]))
                RITZ_CHECK(ritz_output4_infinite(build, row));
            ritz_output4_put(build, row++, number[0], number[1]);
            held = 0;
        }
        RITZ_REFUSE_IF(
            t->lines.line_end - t->lines.line > here * t->width &&
                ritz_decimal_skip(t->lines.line + here * t->width,
                                  t->lines.line_end) != t->lines.line_end,
            RITZ_ERR_FORMAT,
            "line %" PRId64 ": column %" PRId64
            " of '%s' wants no more than %" PRId64 " numbers here",
            t->lines.number, build->column + 1, build->header.name, here);
        done_ += here;
    }
    return RITZ_OK;
}

/* The strings of one column by one reading of their headers. */
static ritz_status read_strings(ritz_output4_text *t, ritz_output4_build *build,
                                int64_t rule, int64_t wide, int64_t words)
{
    for (int64_t left = words; left > 0;) {
        ritz_output4_string string = {0};
        int64_t integers[2] = {0};

        RITZ_REFUSE_IF(!take_line(t), RITZ_ERR_FORMAT,
                       "column %" PRId64 " of '%s' ends after %" PRId64
                       " of %" PRId64 " words",
                       build->column + 1, build->header.name, words - left,
                       words);
        RITZ_REFUSE_IF(
            !take_integers(t, ritz_output4_integers(rule), integers) ||
                !ritz_output4_decode(build, rule, wide, integers, left,
                                     &string),
            RITZ_ERR_FORMAT,
            "line %" PRId64 ": '%.*s' begins no string of column %" PRId64
            " of '%s', of which %" PRId64 " words are to come",
            t->lines.number,
            ritz_lines_quoted(t->lines.line, t->lines.line_end), t->lines.line,
            build->column + 1, build->header.name, left);
        RITZ_CHECK(read_numbers(t, build, string.row, string.reals));
        left -= string.words;
    }
    return RITZ_OK;
}

/*
 * The reading whose strings add up. Solvers with 8-byte words count one word to
 * a double, so that is tried too; if none fits, the first one says what is
 * wrong.
 */
static ritz_status read_sparse(ritz_output4_text *t, ritz_output4_build *build,
                               int64_t words)
{
    ritz_status status = RITZ_OK;
    ritz_output4_text start = *t;
    int64_t most = build->header.type % 2 == 0 ? 2 : 1;
    int64_t wide = build->wide > 0 ? build->wide : most;

    build->sparse = true;
    for (int64_t turn = 0; turn < most; turn++)
        for (int64_t k = 0; k < RITZ_OUTPUT4_RULES; k++) {
            int64_t w = turn == 0 ? wide : 3 - wide;
            int64_t rule = ritz_output4_rule(build, k);

            *t = start;
            ritz_output4_rewind(build);
            status = read_strings(t, build, rule, w, words);
            if (status != RITZ_ERR_FORMAT) {
                build->rule = rule;
                build->wide = w;
                return status;
            }
        }
    *t = start;
    ritz_output4_rewind(build);
    return read_strings(t, build, ritz_output4_rule(build, 0), wide, words);
}

/*
 * What stands behind column NCOL + 1: numbers that nobody needs. NW may count
 * them or their words, so that after the first line a header may come.
 */
static ritz_status skip_last(ritz_output4_text *t,
                             const ritz_output4_build *build, int64_t count)
{
    ritz_output4_header header = {0};
    double number = 0.0;

    RITZ_REFUSE_IF(!take_line(t), RITZ_ERR_FORMAT,
                   "the record that ends '%s' is cut short",
                   build->header.name);
    RITZ_CHECK(read_number(t, build, 0, &number));
    for (int64_t k = t->per_line; k < count; k += t->per_line) {
        ritz_output4_text ahead = *t;

        if (!take_filled_line(&ahead) || take_header(&ahead, &header))
            return RITZ_OK;
        *t = ahead;
    }
    return RITZ_OK;
}

/* The column whose first line was taken; `last` if it ends the matrix. */
static ritz_status read_column(ritz_output4_text *t, ritz_output4_build *build,
                               bool *last)
{
    int64_t n[3] = {0};
    int64_t after = build->header.ncol + 1;

    RITZ_REFUSE_IF(
        !take_integers(t, 3, n) || n[1] < 0 || n[2] < 1, RITZ_ERR_FORMAT,
        "line %" PRId64 ": '%.*s' begins no column of '%s'", t->lines.number,
        ritz_lines_quoted(t->lines.line, t->lines.line_end), t->lines.line,
        build->header.name);
    *last = n[0] == after;
    if (*last) {
        RITZ_CHECK(skip_last(t, build, n[2]));
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_output4_column(build, n[0]));
    if (n[1] == 0) {
        RITZ_CHECK(read_sparse(t, build, n[2]));
        return RITZ_OK;
    }
    RITZ_REFUSE_IF(n[2] % build->numbers != 0, RITZ_ERR_FORMAT,
                   "column %" PRId64 " of '%s' has half a complex value", n[0],
                   build->header.name);
    return read_numbers(t, build, n[1] - 1, n[2]);
}

/* The matrix whose header was taken. */
static ritz_status read_columns(ritz_output4_text *t,
                                const ritz_output4_header *header, int64_t size,
                                ritz_matrix *out)
{
    ritz_status status = RITZ_OK;
    ritz_output4_build build = {0};

    RITZ_TRY(ritz_output4_begin(header, size, 0, &build));
    for (bool last = false; !last;) {
        RITZ_FAIL_IF(!take_filled_line(t), RITZ_ERR_FORMAT,
                     "'%s' ends after column %" PRId64 " of %" PRId64,
                     header->name, build.column + 1, header->ncol);
        RITZ_TRY(read_column(t, &build, &last));
    }
    build.matrix.digits = t->digits;
    snprintf(build.matrix.spelling, sizeof build.matrix.spelling,
             "OUTPUT4 text, %s, %s",
             !build.sparse    ? "dense"
             : header->bigmat ? "bigmat"
                              : "sparse",
             t->format);
    RITZ_TRY(ritz_output4_end(&build, out));
done:
    ritz_matrix_free(&build.matrix);
    return status;
}

/* The next header; false at the end of the file. */
static ritz_status next_header(ritz_output4_text *t, ritz_output4_header *out,
                               bool *found)
{
    *found = take_filled_line(t);
    RITZ_REFUSE_IF(*found && !take_header(t, out), RITZ_ERR_FORMAT,
                   "line %" PRId64 ": '%.*s' begins no matrix", t->lines.number,
                   ritz_lines_quoted(t->lines.line, t->lines.line_end),
                   t->lines.line);
    return RITZ_OK;
}

bool ritz_output4_is_text(const char *bytes, int64_t size)
{
    ritz_output4_text t = {.lines = {.at = bytes, .end = bytes + size}};
    ritz_output4_header header = {0};

    return take_filled_line(&t) && take_header(&t, &header);
}

/* ---- directory ---------------------------------------------------------- */

static bool skip_lines(ritz_output4_text *t, int64_t count)
{
    for (; count > 0; count--)
        if (!take_line(t))
            return false;
    return true;
}

/*
 * Strings of a sparse column, up to the header of the next one, which alone has
 * three integers: headers of strings have one or two, numbers have a point.
 */
static bool skip_strings(ritz_output4_text *t)
{
    ritz_output4_text ahead = *t;
    int64_t n[3];

    while (take_line(&ahead)) {
        int64_t length = ahead.lines.line_end - ahead.lines.line;

        if (!memchr(ahead.lines.line, '.', (size_t)length) &&
            take_integers(&ahead, 3, n))
            return true;
        *t = ahead;
    }
    return false;
}

/* Move behind a matrix by its counts alone; false if these do not fit. */
static bool skip_columns(ritz_output4_text *t,
                         const ritz_output4_header *header)
{
    const ritz_output4_build build = {.header = *header};
    int64_t column = 0;
    int64_t n[3] = {0};

    for (;;) {
        if (!take_filled_line(t) || !take_integers(t, 3, n) || n[1] < 0 ||
            n[2] < 1 || n[0] <= column || n[0] > header->ncol + 1)
            return false;
        column = n[0];
        if (column > header->ncol)
            return skip_last(t, &build, n[2]) == RITZ_OK;
        if (n[1] == 0 ? !skip_strings(t)
                      : !skip_lines(t, (n[2] - 1) / t->per_line + 1))
            return false;
    }
}

/* Where counts do not lead behind a matrix, or values are to be checked, it is
 * read. */
static ritz_status pass_matrix(ritz_output4_text *t,
                               const ritz_output4_header *header, int64_t size,
                               bool check)
{
    ritz_status status = RITZ_OK;
    ritz_output4_text ahead = *t;
    ritz_matrix unused = {0};

    if (!check && skip_columns(&ahead, header))
        *t = ahead;
    else
        status = read_columns(t, header, size, &unused);
    ritz_matrix_free(&unused);
    return status;
}

ritz_status ritz_output4_list_text(const ritz_foreign *file, bool check,
                                   ritz_listing *out)
{
    ritz_output4_text t = {
        .lines = {.at = file->bytes, .end = file->bytes + file->size}};
    ritz_output4_header header = {0};
    bool found = false;

    for (;;) {
        RITZ_CHECK(next_header(&t, &header, &found));
        if (!found)
            return RITZ_OK;
        RITZ_CHECK(ritz_output4_list(out, &header, t.lines.line - file->bytes,
                                     t.lines.number));
        RITZ_CHECK(pass_matrix(&t, &header, file->size, check));
    }
}

ritz_status ritz_output4_read_text(const ritz_foreign *file,
                                   const ritz_listed *which, ritz_matrix *out)
{
    ritz_output4_text t = {.lines = {.at = file->bytes + which->at,
                                     .end = file->bytes + file->size,
                                     .number = which->line - 1}};
    ritz_output4_header header = {0};
    bool found = false;

    RITZ_CHECK(next_header(&t, &header, &found));
    return read_columns(&t, &header, file->size, out);
}
