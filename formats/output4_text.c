/*
 * NASTRAN OUTPUT4: matrices by columns, as text and as binary records.
 *
 * A sparse column is a sequence of strings, each consecutive rows behind one or
 * two integers. There are three readings of these, w words to a value:
 *
 *     words    IS = 65536 (w + 1) + row
 *     values   IS = 65536 v + row            NASTRAN-95, v counts values
 *     bigmat   w + 1, row
 *
 * Headers do not always tell which (a bigmat of few rows may be unmarked), so
 * that one is taken by which the strings of a column add up to its word count.
 */
#include "formats/bytes.h"
#include "formats/output4.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* The header that NCOL NROW FORM TYPE and a padded name state. @return false
 * if no matrix has such numbers */
static bool set_header(const int64_t n[static 4], const char *name,
                       int64_t length, ritz_output4_header *out)
{
    int64_t used = 0;

    if (n[0] < 0 || n[1] == INT64_MIN || n[3] < 1 || n[3] > 4)
        return false;
    *out = (ritz_output4_header){
        .ncol = n[0],
        .nrow = n[1] < 0 ? -n[1] : n[1],
        .bigmat = n[1] < 0 || n[1] >= 65536,
        .form = n[2],
        .type = n[3],
        .numbers = n[3] > 2 ? 2 : 1,
        .symmetric =
            n[2] == RITZ_OUTPUT4_SYMMETRIC && (n[1] == n[0] || n[1] == -n[0]),
    };
    for (int64_t k = 0; k < length && used < RITZ_NAME_SIZE - 1; k++)
        if (name[k] > ' ' && name[k] < 127)
            out->name[used++] = name[k];
    return true;
}

static int64_t count_integers(const ritz_output4_build *build)
{
    return build->rule == RITZ_OUTPUT4_BIGMAT ? 2 : 1;
}

/*
 * What a string's header says.
 *
 * @return false if that is not possible within @p left words
 */
static bool decode_string(const ritz_output4_build *build,
                          const int64_t *integers, int64_t left,
                          ritz_output4_string *out)
{
    bool pair = build->rule == RITZ_OUTPUT4_BIGMAT;
    int64_t count = pair ? integers[0] : integers[0] / 65536;
    int64_t row = pair ? integers[1] : integers[0] % 65536;
    int64_t value = build->header.numbers * build->wide; /* words of one */
    int64_t words = count - 1;

    if (count < 1 || count > left)
        return false;
    if (build->rule == RITZ_OUTPUT4_VALUES)
        words = count * value;
    *out = (ritz_output4_string){
        .row = row - 1,
        .reals = words / build->wide,
        .words = words + count_integers(build),
    };
    return words >= 1 && words % value == 0 && out->words <= left && row >= 1 &&
           row - 1 + words / value <= build->header.nrow;
}

/* Make room for @p count values from @p row, from 0. */
static ritz_status begin_rows(ritz_output4_build *build, int64_t row,
                              int64_t count)
{
    RITZ_REFUSE_IF(row < build->below, RITZ_ERR_FORMAT,
                   "rows of %s do not ascend", build->where);
    RITZ_REFUSE_IF(count > build->header.nrow ||
                       row > build->header.nrow - count,
                   RITZ_ERR_FORMAT,
                   "%s has %" PRId64 " values from row %" PRId64
                   ", but the matrix %" PRId64 " rows",
                   build->where, count, row + 1, build->header.nrow);
    build->below = row + count;
    return ritz_triplets_reserve(&build->entries, count);
}

/*
 * Append @p count real values, little-endian doubles at @p at, from row @p row
 * on, if all are finite and none is zero. There is room for them.
 *
 * @return false, and nothing is appended, if that is not so
 */
static bool put_doubles(ritz_output4_build *build, int64_t row, int64_t count,
                        const char *at)
{
    ritz_triplets *to = &build->entries;
    double *re = to->re + to->count;
    bool usual = true;

    memcpy(re, at, (size_t)count * sizeof *re);
    for (int64_t k = 0; k < count; k++) {
        const bool is = isfinite(re[k]) && re[k] != 0.0;

        to->row[to->count + k] = row + k;
        usual = usual && is;
    }
    if (!usual)
        return false;
    to->counts[build->column + 1] += count;
    to->count += count;
    return true;
}

/* Append a value that there is room for; it must be finite. */
static ritz_status put_value(ritz_output4_build *build, int64_t row, double re,
                             double im)
{
    RITZ_REFUSE_IF(!isfinite(re) || !isfinite(im), RITZ_ERR_FORMAT,
                   "row %" PRId64 " of %s is not finite", row + 1,
                   build->where);
    ritz_triplets_put_value(&build->entries, row, build->column, re, im);
    return RITZ_OK;
}

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
        return set_header(n, name, behind - name, out);
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
    int64_t numbers = build->header.numbers;

    RITZ_REFUSE_IF(reals / 2 > t->text.end - t->text.at, RITZ_ERR_FORMAT,
                   "%s wants %" PRId64
                   " numbers, more than are left in the file",
                   build->where, reals);
    RITZ_CHECK(begin_rows(build, row, reals / numbers));
    for (int64_t done_ = 0; done_ < reals;) {
        int64_t here =
            reals - done_ < t->per_line ? reals - done_ : t->per_line;

        RITZ_REFUSE_IF(!take_line(t), RITZ_ERR_FORMAT,
                       "%s ends after %" PRId64 " of %" PRId64 " numbers",
                       build->where, done_, reals);
        for (int64_t k = 0; k < here; k++) {
            RITZ_CHECK(read_number(t, build, k, &number[held++]));
            if (held < numbers)
                continue;
            RITZ_CHECK(put_value(build, row++, number[0], number[1]));
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
    int64_t integers[2] = {0};

    RITZ_REFUSE_IF(!take_line(t), RITZ_ERR_FORMAT,
                   "%s ends after %" PRId64 " of %" PRId64 " words",
                   build->where, words - left, words);
    RITZ_REFUSE_IF(
        !take_integers(t, count_integers(build), integers) ||
            !decode_string(build, integers, left, out),
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
    RITZ_REFUSE_IF(!take_filled_line(t), RITZ_ERR_FORMAT,
                   "'%s' ends after column %" PRId64 " of %" PRId64,
                   build->header.name, build->column + 1, build->header.ncol);
    RITZ_REFUSE_IF(
        !take_integers(t, 3, n) || n[1] < 0 || n[2] < 1, RITZ_ERR_FORMAT,
        "line %" PRId64 ": '%.*s' begins no column of '%s'", t->text.number,
        ritz_lines_quoted(t->text.line, t->text.line_end), t->text.line,
        build->header.name);
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

/* The first line that begins behind `from` and looks like the header of a
 * column: three integers and no decimal point. */
static const char *find_text_column(const ritz_output4_reader *t,
                                    const char *from)
{
    ritz_output4_reader ahead = *t;

    ahead.text.at = from;
    return take_line(&ahead) && skip_strings(&ahead) ? ahead.text.at : NULL;
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
    .find_column = find_text_column,
    .skip_last = skip_last,
};

/* ---- binary ------------------------------------------------------------- */

/*
 * Unformatted records of Fortran: length, bytes, length again.
 *
 *     NCOL NROW FORM TYPE NAME(2 words)    24 bytes, or 48 of 8-byte integers
 *     ICOL IROW NW data                    IROW = 0: data are strings
 *
 * Data fill their record: where NW disagrees the record is right. Byte order
 * and size of integers follow from the first length. Lengths are integers of 4
 * bytes, of 8 by some compilers; records of no bytes may stand between others.
 */

typedef struct ritz_binary_record {
    const char *at;
    int64_t size;
} ritz_binary_record;

/** @p size bytes, 4 or 8, as an integer. */
static inline int64_t load_integer(const ritz_output4_reader *b, const char *at,
                                   int64_t size)
{
    uint64_t bits =
        ritz_bytes_bits((const unsigned char *)at, size, b->big_endian);

    return size == 4 ? (int64_t)(int32_t)(uint32_t)bits : (int64_t)bits;
}

/** @p count integers one after the other. */
static void load_integers(const ritz_output4_reader *b, const char *at,
                          int64_t count, int64_t *out)
{
    for (int64_t k = 0; k < count; k++)
        out[k] = load_integer(b, at + k * b->integer, b->integer);
}

/* How the file is spelled, from the length of its first record. */
static bool find_records(ritz_output4_reader *b)
{
    int64_t size = b->text.end - b->begin;

    for (int k = 0; k < 8 && size >= 4; k++) {
        b->big_endian = k & 1;
        b->integer = k & 2 ? 8 : 4;
        b->mark = k & 4 ? 4 : 8;
        if (size >= b->mark &&
            load_integer(b, b->begin, b->mark) == 6 * b->integer)
            return true;
    }
    return false;
}

/* Take a record that is not empty; its size is -1 at the end of the file. */
static ritz_status take_record(ritz_output4_reader *b, ritz_binary_record *out)
{
    int64_t size = 0;

    while (size == 0) {
        int64_t left = b->text.end - b->text.at;

        *out = (ritz_binary_record){.size = -1};
        if (left == 0)
            return RITZ_OK;
        RITZ_REFUSE_IF(left < 2 * b->mark, RITZ_ERR_FORMAT,
                       "byte %td: %" PRId64 " bytes are left, too few for "
                       "a record",
                       b->text.at - b->begin, left);
        size = load_integer(b, b->text.at, b->mark);
        RITZ_REFUSE_IF(size < 0 || size > left - 2 * b->mark, RITZ_ERR_FORMAT,
                       "byte %td: a record of %" PRId64
                       " bytes begins, but %" PRId64 " are left",
                       b->text.at - b->begin, size, left - b->mark);
        *out = (ritz_binary_record){b->text.at + b->mark, size};
        b->text.at += size + 2 * b->mark;
        RITZ_REFUSE_IF(load_integer(b, b->text.at - b->mark, b->mark) != size,
                       RITZ_ERR_FORMAT,
                       "byte %td: a record of %" PRId64
                       " bytes ends with another length",
                       b->text.at - b->mark - b->begin, size);
    }
    return RITZ_OK;
}

static ritz_status take_record_header(ritz_output4_reader *b,
                                      ritz_output4_header *out, bool *found)
{
    int64_t at = b->text.at - b->begin;
    ritz_binary_record first = {0};
    int64_t n[4] = {0};

    RITZ_CHECK(take_record(b, &first));
    *found = first.size >= 0;
    if (!*found)
        return RITZ_OK;
    if (first.size == 6 * b->integer)
        load_integers(b, first.at, 4, n);
    RITZ_REFUSE_IF(
        !set_header(n, first.at + 4 * b->integer, 2 * b->integer, out),
        RITZ_ERR_FORMAT,
        "byte %td: a record of %" PRId64 " bytes begins no matrix",
        first.at - b->begin, first.size);
    out->at = at;
    b->real = out->type % 2 == 1 && b->integer == 4 ? 4 : 8;
    b->digits = b->real == 4 ? 7 : 17;
    b->wide = b->real / b->integer;
    b->widths = 1;
    snprintf(b->format, sizeof b->format, "%s-endian, %d-byte integers",
             b->big_endian ? "big" : "little", (int)b->integer);
    return RITZ_OK;
}

static double load_real(const ritz_output4_reader *b, const char *at)
{
    const unsigned char *bytes = (const unsigned char *)at;

    return b->real == 4 ? ritz_bytes_single(bytes, b->big_endian)
                        : ritz_bytes_double(bytes, b->big_endian);
}

/* One record after the header. */
static ritz_status take_record_column(ritz_output4_reader *b,
                                      const ritz_output4_build *build,
                                      int64_t n[3])
{
    ritz_binary_record column = {0};
    bool whole = false;

    RITZ_CHECK(take_record(b, &column));
    RITZ_REFUSE_IF(column.size < 0, RITZ_ERR_FORMAT,
                   "'%s' ends after column %" PRId64 " of %" PRId64,
                   build->header.name, build->column + 1, build->header.ncol);
    whole = column.size >= 3 * b->integer;
    if (whole)
        load_integers(b, column.at, 3, n);
    RITZ_REFUSE_IF(
        !whole || (n[0] <= build->header.ncol && column.size % b->integer != 0),
        RITZ_ERR_FORMAT,
        "byte %td: a record of %" PRId64 " bytes is no column of '%s'",
        column.at - b->begin, column.size, build->header.name);
    b->data = column.at + 3 * b->integer;
    b->data_end = column.at + column.size;
    if (n[1] == 0)
        n[2] = (b->data_end - b->data) / b->integer;
    return RITZ_OK;
}

static ritz_status read_record_numbers(ritz_output4_reader *b,
                                       ritz_output4_build *build, int64_t row,
                                       int64_t reals)
{
    int64_t numbers = build->header.numbers;

    RITZ_CHECK(begin_rows(build, row, reals / numbers));
    if (__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ && !b->big_endian &&
        b->real == 8 && numbers == 1 && reals > 0 &&
        put_doubles(build, row, reals, b->data)) {
        b->data += reals * b->real;
        return RITZ_OK;
    }
    for (int64_t k = 0; k < reals; k += numbers) {
        double re = load_real(b, b->data);
        double im = numbers == 2 ? load_real(b, b->data + b->real) : 0.0;

        RITZ_CHECK(put_value(build, row++, re, im));
        b->data += numbers * b->real;
    }
    return RITZ_OK;
}

static ritz_status take_record_string(ritz_output4_reader *b,
                                      const ritz_output4_build *build,
                                      int64_t words, int64_t left,
                                      ritz_output4_string *out)
{
    int64_t integers = count_integers(build);
    int64_t n[2] = {0};

    load_integers(b, b->data, integers < left ? integers : left, n);
    RITZ_REFUSE_IF(!decode_string(build, n, left, out), RITZ_ERR_FORMAT,
                   "byte %td: strings of %s do not add up to %" PRId64 " words",
                   b->data - b->begin, build->where, words);
    b->data += integers * b->integer;
    return RITZ_OK;
}

/* NW may count words or numbers, but must fit the record. */
static ritz_status read_record_dense(ritz_output4_reader *b,
                                     ritz_output4_build *build,
                                     const int64_t n[3])
{
    int64_t size = b->data_end - b->data;
    int64_t words = size / b->integer;
    int64_t reals = size / b->real;

    RITZ_REFUSE_IF(n[1] < 0 || n[1] > build->header.nrow, RITZ_ERR_FORMAT,
                   "%s begins at row %" PRId64 ", but the matrix has %" PRId64
                   " rows",
                   build->where, n[1], build->header.nrow);
    RITZ_REFUSE_IF(size % (b->real * build->header.numbers) != 0,
                   RITZ_ERR_FORMAT, "%s holds part of a value", build->where);
    RITZ_REFUSE_IF(n[2] != words && n[2] != reals, RITZ_ERR_FORMAT,
                   "%s is said to hold %" PRId64
                   " words, but its record %" PRId64,
                   build->where, n[2], words);
    return read_record_numbers(b, build, n[1] - 1, reals);
}

/* Whether `LOOKED_AT` records in a row begin at `at`, whose lengths stand at
 * both ends and whose first numbers ascend, as those of columns do. */
static bool looks_like_columns(const ritz_output4_reader *b, const char *at)
{
    enum { LOOKED_AT = 4 };
    int64_t column = 0;

    for (int k = 0; k < LOOKED_AT; k++) {
        const int64_t left = b->text.end - at - 2 * b->mark;
        int64_t size = 0, number = 0;

        if (left < 3 * b->integer)
            return false;
        size = load_integer(b, at, b->mark);
        if (size < 3 * b->integer || size > left ||
            load_integer(b, at + b->mark + size, b->mark) != size)
            return false;
        number = load_integer(b, at + b->mark, b->integer);
        if (number <= column)
            return false;
        column = number;
        at += size + 2 * b->mark;
    }
    return true;
}

/* A record that begins at `from` or behind it: the first place that looks like
 * columns, or, if there is none nearby, found by passing from record to record
 * by their lengths. */
static const char *find_record(const ritz_output4_reader *b, const char *from)
{
    enum { NEARBY = 1 << 16 };
    ritz_output4_reader ahead = *b;
    ritz_binary_record passed = {0};
    const char *at = from + (b->text.at - from) % 4; /* as records are */

    at = at < from ? at + 4 : at;
    for (int64_t k = 0; k < NEARBY; k += 4)
        if (b->text.end - at > k && looks_like_columns(b, at + k))
            return at + k;
    while (ahead.text.at < from)
        if (take_record(&ahead, &passed) != RITZ_OK || passed.size < 0)
            return NULL;
    return ahead.text.at;
}

const ritz_output4_spelling ritz_output4_binary = {
    .name = "binary",
    .recognise = find_records,
    .take_header = take_record_header,
    .take_column = take_record_column,
    .read_dense = read_record_dense,
    .take_string = take_record_string,
    .read_numbers = read_record_numbers,
    .find_column = find_record,
};
