/* NASTRAN OUTPUT4 as text. */
#include "formats/output4_strings.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* ---- text --------------------------------------------------------------- */

/*
 * Lines of fixed fields, which may touch each other.
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

/* Take a line, less its '\r'; false at the end of the file. */
static bool take_line(ritz_output4_reader *t)
{
    ritz_lines *lines = &t->text;

    if (!ritz_lines_next(lines))
        return false;
    if (lines->line_end > lines->line && lines->line_end[-1] == '\r')
        lines->line_end--;
    return true;
}

/* Take lines until one is not blank. */
static bool take_filled_line(ritz_output4_reader *t)
{
    while (take_line(t))
        if (ritz_decimal_skip(t->text.line, t->text.line_end) !=
            t->text.line_end)
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

/* ---- the usual lines ---------------------------------------------------- */

/*
 * Most lines of a large file have integers that end in fields of eight letters,
 * or full fields of numbers as 1P,nEw.d writes them. Their ends are known, and
 * they are read field by field in a third of the time. A line that is spelled
 * otherwise is left to the readers below, which find the same in usual ones.
 */

/* Letters of "\n" or "\r\n" behind @p size letters; 0 if the next line is not as
   long as that. */
static int64_t measure_end(const ritz_output4_reader *t, int64_t size)
{
    const int64_t left = t->text.end - t->text.at - size;
    const char *at = left > 0 ? t->text.at + size : "";

    if (*at == '\n')
        return 1;
    return left > 1 && at[0] == '\r' && at[1] == '\n' ? 2 : 0;
}

/* Move behind the next line, of @p size letters and @p end behind them. */
static void pass_line(ritz_output4_reader *t, int64_t size, int64_t end)
{
    ritz_lines *lines = &t->text;

    lines->line = lines->at;
    lines->line_end = lines->at + size;
    lines->at += size + end;
    lines->number++;
}

/* Take a line of @p count integers. @return false if it is not a usual one */
static bool take_usual_integers(ritz_output4_reader *t, int64_t count,
                                int64_t *out)
{
    enum { FIELD = 8 };
    const int64_t end = measure_end(t, FIELD * count);

    if (end == 0)
        return false;
    for (int64_t k = 0; k < count; k++)
        if (!ritz_decimal_scan_eight(t->text.at + FIELD * k, &out[k]))
            return false;
    pass_line(t, FIELD * count, end);
    return true;
}

enum { FEW = 8 }; /* numbers of a usual line, at most */

/* Take a line of @p count numbers. @return false if it is not a usual one */
static bool take_usual_numbers(ritz_output4_reader *t, int64_t count,
                               double out[static FEW])
{
    const int64_t width = t->width, decimals = t->decimals;
    const int64_t end = measure_end(t, count * width);

    if (count > FEW || decimals < 1 || decimals > 18 || decimals > width - 7 ||
        end == 0)
        return false;
    for (int64_t k = 0; k < count; k++)
        if (!ritz_decimal_scan_field(t->text.at + width * k, width, decimals,
                                     &out[k]))
            return false;
    pass_line(t, count * width, end);
    return true;
}

/* ---- lines -------------------------------------------------------------- */

/* @p count integers of the line: words, or else fields of 8 or of 16. */
static bool take_integers(const ritz_output4_reader *t, int64_t count,
                          int64_t *out)
{
    const char *at = t->text.line;
    int64_t each = (t->text.line_end - at) / count;
    const int64_t widths[3] = {each, each, each};

    if (ritz_decimal_scan_wholes(&at, t->text.line_end, count, out) &&
        at == t->text.line_end)
        return true;
    return (each == 8 || each == 16) &&
           t->text.line_end - t->text.line == each * count &&
           read_fields(t->text.line, t->text.line_end, widths, count, out);
}

/* A whole number of at most 3 digits that must be followed by something. */
static bool small_number(const char **at, const char *end, int64_t *out)
{
    const char *start = *at;

    return *at < end && **at >= '0' && **at <= '9' &&
           ritz_decimal_scan_whole(at, end, out) && *at - start <= 3;
}

/* "1P,3E23.16" or "5E16.9" at `at`, up to a blank, '|' or the end. */
static bool read_format(const char *at, const char *end, ritz_output4_reader *t)
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
    t->decimals = decimals;
    snprintf(t->format, sizeof t->format, "%.*s", (int)(at - start), start);
    return true;
}

/* Format behind the four integers of a header and the name, whose end is told
 * too. */
static bool read_label(const char *at, const char *end, ritz_output4_reader *t,
                       const char **behind)
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
    *behind = name_end;
    return found;
}

/* The line as a header of a matrix, and the nEw.d that it states. */
static bool read_header(ritz_output4_reader *t, ritz_output4_header *out)
{
    static const int64_t widths[2][4] = {{8, 8, 8, 8}, {16, 16, 8, 8}};
    static const int64_t total[2] = {32, 48};

    for (int k = 0; k < 2; k++) {
        const char *name = t->text.line + total[k];
        const char *behind = NULL;
        int64_t n[4] = {0};

        if (t->text.line_end - t->text.line < total[k] ||
            !read_fields(t->text.line, name, widths[k], 4, n) ||
            !read_label(name, t->text.line_end, t, &behind))
            continue;
        t->wide = t->widths = 2 - n[3] % 2;
        return ritz_output4_set_header(n, name, behind - name, out);
    }
    return false;
}

/* The next header; false at the end of the file. */
static ritz_status take_text_header(ritz_output4_reader *t,
                                    ritz_output4_header *out, bool *found)
{
    *found = take_filled_line(t);
    RITZ_REFUSE_IF(*found && !read_header(t, out), RITZ_ERR_FORMAT,
                   "line %" PRId64 ": '%.*s' begins no matrix", t->text.number,
                   ritz_lines_quoted(t->text.line, t->text.line_end),
                   t->text.line);
    out->at = t->text.line - t->begin;
    out->line = t->text.number;
    return RITZ_OK;
}

static bool is_text(ritz_output4_reader *r)
{
    ritz_output4_reader t = *r;
    ritz_output4_header header = {0};

    return take_filled_line(&t) && read_header(&t, &header);
}

/* One number of the line, `k` fields from its left. */
static ritz_status read_number(const ritz_output4_reader *t,
                               const ritz_output4_build *build, int64_t k,
                               double *out)
{
    ritz_decimal number = {0};
    const char *left = t->text.line + k * t->width;
    const char *end = NULL;
    const char *at = left;

    RITZ_REFUSE_IF(left >= t->text.line_end, RITZ_ERR_FORMAT,
                   "line %" PRId64 ": %s wants more numbers than the %" PRId64
                   " here",
                   t->text.number, build->where, k);
    end =
        t->text.line_end - left > t->width ? left + t->width : t->text.line_end;
    at = ritz_decimal_skip(at, end);
    RITZ_REFUSE_IF(!ritz_decimal_scan(&at, end, &number) ||
                       ritz_decimal_skip(at, end) != end,
                   RITZ_ERR_FORMAT,
                   "line %" PRId64 ": '%.*s' in %s is not a number",
                   t->text.number, (int)(end - left), left, build->where);
    *out = number.value;
    return RITZ_OK;
}

/* `reals` numbers, n to a line, as values from row `row`. */
static ritz_status read_text_numbers(ritz_output4_reader *t,
                                     ritz_output4_build *build, int64_t row,
                                     int64_t reals)
{
    double number[2] = {0.0, 0.0};
    int64_t held = 0;
    const int64_t numbers = build->header.numbers; /* 1 or 2 */

    RITZ_REFUSE_IF(reals / 2 > t->text.end - t->text.at, RITZ_ERR_FORMAT,
                   "%s wants %" PRId64
                   " numbers, more than are left in the file",
                   build->where, reals);
    RITZ_CHECK(ritz_output4_begin_rows(build, row, reals >> (numbers - 1)));
    for (int64_t done_ = 0; done_ < reals;) {
        int64_t here =
            reals - done_ < t->per_line ? reals - done_ : t->per_line;
        double usual[FEW];
        const bool is_usual = take_usual_numbers(t, here, usual);

        RITZ_REFUSE_IF(!is_usual && !take_line(t), RITZ_ERR_FORMAT,
                       "%s ends after %" PRId64 " of %" PRId64 " numbers",
                       build->where, done_, reals);
        for (int64_t k = 0; k < here; k++) {
            if (is_usual)
                number[held] = usual[k];
            else
                RITZ_CHECK(read_number(t, build, k, &number[held]));
            held++;
            if (held < numbers)
                continue;
            RITZ_CHECK(
                ritz_output4_put_value(build, row++, number[0], number[1]));
            held = 0;
        }
        RITZ_REFUSE_IF(
            t->text.line_end - t->text.line > here * t->width &&
                ritz_decimal_skip(t->text.line + here * t->width,
                                  t->text.line_end) != t->text.line_end,
            RITZ_ERR_FORMAT,
            "line %" PRId64 ": %s wants no more than %" PRId64 " numbers here",
            t->text.number, build->where, here);
        done_ += here;
    }
    return RITZ_OK;
}

static ritz_status take_text_string(ritz_output4_reader *t,
                                    const ritz_output4_build *build,
                                    int64_t words, int64_t left,
                                    ritz_output4_string *out)
{
    const int64_t count = ritz_output4_count_integers(build);
    int64_t integers[2] = {0};
    const bool is_usual = take_usual_integers(t, count, integers);

    RITZ_REFUSE_IF(!is_usual && !take_line(t), RITZ_ERR_FORMAT,
                   "%s ends after %" PRId64 " of %" PRId64 " words",
                   build->where, words - left, words);
    RITZ_REFUSE_IF(
        (!is_usual && !take_integers(t, count, integers)) ||
            !ritz_output4_decode_string(build, integers, left, out),
        RITZ_ERR_FORMAT,
        "line %" PRId64 ": '%.*s' begins no string of %s, of which %" PRId64
        " words are to come",
        t->text.number, ritz_lines_quoted(t->text.line, t->text.line_end),
        t->text.line, build->where, left);
    return RITZ_OK;
}

static ritz_status read_text_dense(ritz_output4_reader *t,
                                   ritz_output4_build *build,
                                   const int64_t n[3])
{
    RITZ_REFUSE_IF(n[2] % build->header.numbers != 0, RITZ_ERR_FORMAT,
                   "%s has half a complex value", build->where);
    return read_text_numbers(t, build, n[1] - 1, n[2]);
}

/* The line in front of a column. */
static ritz_status take_text_column(ritz_output4_reader *t,
                                    const ritz_output4_build *build,
                                    int64_t n[3])
{
    const bool is_usual = take_usual_integers(t, 3, n);

    RITZ_REFUSE_IF(!is_usual && !take_filled_line(t), RITZ_ERR_FORMAT,
                   "'%s' ends after column %" PRId64 " of %" PRId64,
                   build->header.name, build->column + 1, build->header.ncol);
    RITZ_REFUSE_IF(
        (!is_usual && !take_integers(t, 3, n)) || n[1] < 0 || n[2] < 1,
        RITZ_ERR_FORMAT, "line %" PRId64 ": '%.*s' begins no column of '%s'",
        t->text.number, ritz_lines_quoted(t->text.line, t->text.line_end),
        t->text.line, build->header.name);
    return RITZ_OK;
}

/*
 * What stands behind column NCOL + 1: numbers that nobody needs. NW may count
 * them or their words, so that after the first line a header may come.
 */
static ritz_status skip_last(ritz_output4_reader *t,
                             const ritz_output4_build *build, int64_t words)
{
    ritz_output4_header header = {0};
    double number = 0.0;

    RITZ_REFUSE_IF(!take_line(t), RITZ_ERR_FORMAT,
                   "the record that ends '%s' is cut short",
                   build->header.name);
    RITZ_CHECK(read_number(t, build, 0, &number));
    for (int64_t k = t->per_line; k < words; k += t->per_line) {
        ritz_output4_reader ahead = *t;

        if (!take_filled_line(&ahead) || read_header(&ahead, &header))
            return RITZ_OK;
        *t = ahead;
    }
    return RITZ_OK;
}

/* Whether a line may hold three integers: as words, or in fields of 8 or 16
 * letters that touch. Headers of strings have two words at most, and are by far
 * the most lines without a point. */
static bool may_hold_three(const char *at, const char *end)
{
    int words = 0;
    bool inside = false;

    if (end - at == 24 || end - at == 48)
        return true;
    for (; at < end; at++) {
        const bool blank = *at == ' ' || *at == '\t' || *at == '\0';

        words += !blank && !inside;
        inside = !blank;
    }
    return words == 3;
}

/*
 * Strings of a sparse column, up to the header of the next one, which alone has
 * three integers: headers of strings have one or two, numbers have a point.
 */
static bool skip_strings(ritz_output4_reader *t)
{
    for (;;) {
        const ritz_lines before = t->text;
        int64_t n[3];

        if (!take_line(t))
            return false;
        if (!memchr(t->text.line, '.',
                    (size_t)(t->text.line_end - t->text.line)) &&
            may_hold_three(t->text.line, t->text.line_end) &&
            take_integers(t, 3, n)) {
            t->text = before;
            return true;
        }
    }
}

static bool skip_column(ritz_output4_reader *t, const int64_t n[3])
{
    if (n[1] == 0)
        return skip_strings(t);
    for (int64_t lines = (n[2] - 1) / t->per_line; lines >= 0; lines--)
        if (!take_line(t))
            return false;
    return true;
}

/* Move behind the lines of so many numbers: at once if the last of these lines
 * ends where full lines of w letters a number would, else line by line. */
static bool pass_numbers(ritz_output4_reader *t, int64_t reals)
{
    ritz_lines *text = &t->text;
    const int64_t lines = reals <= t->per_line /* most often: no division */
                              ? 1
                              : (reals + t->per_line - 1) / t->per_line;
    int64_t size = 0;

    if (reals > text->end - text->at)
        return false;
    size = reals * t->width + lines - 1;
    if (text->end - text->at > size && text->at[size] == '\n') {
        text->at += size + 1;
        text->number += lines;
        return true;
    }
    for (int64_t k = 0; k < lines; k++)
        if (!take_line(t))
            return false;
    return true;
}

static int64_t count_lines(ritz_output4_reader *t,
                           const ritz_output4_build *build, const int64_t n[3])
{
    const int64_t integers = ritz_output4_count_integers(build);
    int64_t reals = 0;

    if (n[1] != 0)
        return pass_numbers(t, n[2]) ? n[2] / build->header.numbers : -1;
    for (int64_t left = n[2]; left > 0;) {
        ritz_output4_string string = {0};
        int64_t header[2] = {0};

        if ((!take_usual_integers(t, integers, header) &&
             (!take_line(t) || !take_integers(t, integers, header))) ||
            !ritz_output4_decode_string(build, header, left, &string) ||
            !pass_numbers(t, string.reals))
            return -1;
        reals += string.reals;
        left -= string.words;
    }
    return reals / build->header.numbers;
}

const ritz_output4_spelling ritz_output4_text = {
    .name = "text",
    .recognise = is_text,
    .take_header = take_text_header,
    .take_column = take_text_column,
    .read_dense = read_text_dense,
    .take_string = take_text_string,
    .read_numbers = read_text_numbers,
    .skip_column = skip_column,
    .count_column = count_lines,
    .skip_last = skip_last,
};
