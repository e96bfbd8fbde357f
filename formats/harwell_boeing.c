/*
 * Harwell-Boeing and Rutherford-Boeing, assembled matrices by columns
 * [DuffGrimesLewis1989, DuffGrimesLewis1997]:
 *
 *     title                                              A72, key A8
 *     lines: all, pointers, rows, values, right sides    5I14
 *     type such as RSA, rows, columns, entries           A3, 11X, 4I14
 *     formats of pointers, rows, values, right sides     2A16, 2A20
 *     the kind of right sides, if there are any          A3, 11X, 2I14
 *
 * and then the pointers to each column's first entry, the rows of the entries
 * and their values, as the formats say: (16I5), (1P,5E15.8), (3D25.16).
 * Numbers are cut out by columns, as neighbours may touch. Rutherford-Boeing
 * has its type in small letters and no right sides.
 *
 * Symmetric matrices give one triangle, the lower by the rules, the upper in
 * files that break them. Right sides stand behind the matrix and are not read.
 */
#include "base/alloc.h"
#include "formats/decimal.h"
#include "formats/matrix.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    RITZ_BOEING_POINTERS,
    RITZ_BOEING_ROWS,
    RITZ_BOEING_VALUES,
    RITZ_BOEING_SECTIONS,
    RITZ_BOEING_RIGHT_SIDES = RITZ_BOEING_SECTIONS,
};

/* "(1P,5E15.8)": five numbers of fifteen columns on a line. */
typedef struct ritz_boeing_form {
    char text[21]; /* what the fourth line has room for */
    int64_t repeat, width;
    int64_t scale; /* of P */
    char letter;   /* I, E, D, F or G */
} ritz_boeing_form;

typedef struct ritz_boeing_entry {
    int64_t row, col; /* from 0; of one triangle of symmetric matrices */
    double re, im;
} ritz_boeing_entry;

typedef struct ritz_boeing {
    ritz_lines text;
    bool cut;           /* no end of line behind the line taken last */
    char type[4];       /* in capitals */
    bool is_rutherford; /* the file has it in small letters */
    int64_t lines[RITZ_BOEING_SECTIONS + 1];
    int64_t nrow, ncol, count;
    ritz_boeing_form form[RITZ_BOEING_SECTIONS];
    int64_t used; /* numbers taken of the line */
    int64_t digits;
    int64_t *first; /* entry of each column, from 0, and one more */
    ritz_boeing_entry *entry;
} ritz_boeing;

static void ritz_boeing_free(ritz_boeing *b)
{
    RITZ_FREE(b->first, b->entry);
}

/* ---- head --------------------------------------------------------------- */

static bool take_line(ritz_boeing *b)
{
    ritz_lines *text = &b->text;

    if (!ritz_lines_next(text))
        return false;
    b->cut = text->line_end == text->end;
    if (text->line_end > text->line && text->line_end[-1] == '\r')
        text->line_end--;
    return true;
}

/* What the line has from column `at` on, counted from 0, at most `width`. */
static const char *cut_field(const ritz_lines *text, int64_t at, int64_t width,
                             const char **end)
{
    const int64_t length = text->line_end - text->line;
    const int64_t from = at < length ? at : length;

    *end = text->line + (length - from < width ? length : from + width);
    return text->line + from;
}

/* The count in columns of fourteen, 0 if they are blank. */
static bool take_count(const ritz_lines *text, int64_t which, int64_t *out)
{
    enum { WIDTH = 14 };
    const char *end = NULL;
    const char *at = cut_field(text, WIDTH * which, WIDTH, &end);

    *out = 0;
    at = ritz_decimal_skip(at, end);
    if (at == end)
        return true;
    return ritz_decimal_scan_whole(&at, end, out) && *out >= 0 &&
           ritz_decimal_skip(at, end) == end;
}

static char capital(char c)
{
    return (char)(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
}

/* The three letters of a type that the formats define. */
static bool take_type(ritz_boeing *b)
{
    enum { WIDTH = 3, BLANK = 11 };
    static const char *const letters[WIDTH] = {"RCIPQ", "SUHZR", "AE"};
    const char *end = NULL;
    const char *at = cut_field(&b->text, 0, WIDTH, &end);

    if (end - at < WIDTH)
        return false;
    b->is_rutherford = at[0] != capital(at[0]);
    for (int k = 0; k < WIDTH; k++) {
        b->type[k] = capital(at[k]);
        if (!b->type[k] || !strchr(letters[k], b->type[k]))
            return false;
    }
    at = cut_field(&b->text, WIDTH, BLANK, &end);
    return ritz_decimal_skip(at, end) == end;
}

/* The first three lines. @return false if they are none of such a file */
static bool take_counts(ritz_boeing *b)
{
    int64_t total = 0;
    int64_t sum = 0;

    for (int k = 0; k < 2; k++)
        if (!take_line(b))
            return false;
    if (!take_count(&b->text, 0, &total))
        return false;
    for (int k = 0; k <= RITZ_BOEING_SECTIONS; k++) {
        if (!take_count(&b->text, k + 1, &b->lines[k]))
            return false;
        if (k < RITZ_BOEING_RIGHT_SIDES)
            sum += b->lines[k];
    }
    return total >= sum && b->lines[RITZ_BOEING_POINTERS] > 0 && take_line(b) &&
           take_type(b) && take_count(&b->text, 1, &b->nrow) &&
           take_count(&b->text, 2, &b->ncol) &&
           take_count(&b->text, 3, &b->count);
}

static bool has_counts(const char *bytes, int64_t size)
{
    ritz_boeing b = {.text = {.at = bytes, .end = bytes + size}};

    return take_counts(&b) && b.nrow > 0 && b.ncol > 0;
}

/* A number from 1 to 999; false if there is none. */
static bool scan_repeat(const char **at, int64_t *out)
{
    enum { MOST = 999 };
    const char *end = *at + strlen(*at);

    return ritz_decimal_scan_whole(at, end, out) && *out > 0 && *out <= MOST;
}

/* Take a format apart that has no blanks and capitals only. */
static bool scan_form(const char *at, ritz_boeing_form *out)
{
    int64_t unused = 0;

    out->repeat = 1;
    if (*at++ != '(')
        return false;
    if (isdigit((unsigned char)*at) && !scan_repeat(&at, &out->repeat))
        return false;
    if (*at == 'P') {
        out->scale = out->repeat;
        out->repeat = 1;
        at += at[1] == ',' ? 2 : 1;
        if (isdigit((unsigned char)*at) && !scan_repeat(&at, &out->repeat))
            return false;
    }
    if (!*at || !strchr("IEDFG", *at))
        return false;
    out->letter = *at++;
    if (!isdigit((unsigned char)*at) || !scan_repeat(&at, &out->width))
        return false;
    if (*at == '.') {
        const char *end = at + 1 + strspn(at + 1, "0123456789");

        if (end == at + 1)
            return false;
        at = end;
        if (*at == 'E' &&
            (!isdigit((unsigned char)*++at) || !scan_repeat(&at, &unused)))
            return false;
    }
    return strcmp(at, ")") == 0;
}

/* The format of a section, which the fourth line has. */
static ritz_status take_form(const ritz_boeing *b, int section,
                             ritz_boeing_form *out)
{
    enum { WIDTH = 16, VALUE_WIDTH = 20 };
    const bool whole = section != RITZ_BOEING_VALUES;
    const char *end = NULL;
    const char *at = cut_field(&b->text, (int64_t)WIDTH * section,
                               whole ? WIDTH : VALUE_WIDTH, &end);
    size_t used = 0;

    for (; at < end; at++)
        if (*at > ' ')
            out->text[used++] = capital(*at);
    RITZ_REFUSE_IF(!scan_form(out->text, out) || (whole && out->letter != 'I'),
                   RITZ_ERR_FORMAT, "'%s' is not a format of %s, such as %s",
                   out->text, whole ? "whole numbers" : "values",
                   whole ? "(16I5)" : "(1P,5E15.8)");
    return RITZ_OK;
}

/* Types that are not read. */
static ritz_status check_type(const ritz_boeing *b)
{
    const char *type = b->type;

    RITZ_REFUSE_IF(type[0] == 'P' || type[0] == 'Q', RITZ_ERR_FORMAT,
                   "type '%s' is a pattern without values", type);
    RITZ_REFUSE_IF(type[2] == 'E', RITZ_ERR_FORMAT,
                   "type '%s' has matrices of elements, and only assembled "
                   "ones are read",
                   type);
    RITZ_REFUSE_IF(type[1] == 'H' && type[0] != 'C', RITZ_ERR_FORMAT,
                   "type '%s' is hermitian, but not complex", type);
    return RITZ_OK;
}

/* Rows that a file may declare beyond one for each byte, as Matrix Market. */
enum { NULL_ROWS = 32000000 };

static ritz_status check_sizes(const ritz_boeing *b, int64_t bytes)
{
    RITZ_REFUSE_IF(strchr("SHZ", b->type[1]) && b->nrow != b->ncol,
                   RITZ_ERR_FORMAT,
                   "type '%s' cannot be %" PRId64 " x %" PRId64, b->type,
                   b->nrow, b->ncol);
    RITZ_REFUSE_IF(b->ncol > bytes || b->nrow - NULL_ROWS > bytes ||
                       b->count > bytes / 2,
                   RITZ_ERR_FORMAT,
                   "%" PRId64 " x %" PRId64 " with %" PRId64
                   " entries is more than %" PRId64 " bytes can hold",
                   b->nrow, b->ncol, b->count, bytes);
    return RITZ_OK;
}

static ritz_status read_head(ritz_boeing *b)
{
    const int64_t bytes = b->text.end - b->text.at;

    RITZ_REFUSE_IF(!take_counts(b), RITZ_ERR_FORMAT,
                   "counts of lines or a type such as RSA are not there");
    RITZ_CHECK(check_type(b));
    RITZ_CHECK(check_sizes(b, bytes));
    RITZ_REFUSE_IF(!take_line(b), RITZ_ERR_FORMAT, "ends before its formats");
    for (int k = 0; k < RITZ_BOEING_SECTIONS; k++)
        RITZ_CHECK(take_form(b, k, &b->form[k]));
    RITZ_REFUSE_IF(b->lines[RITZ_BOEING_RIGHT_SIDES] > 0 && !take_line(b),
                   RITZ_ERR_FORMAT, "ends before its fifth line");
    return RITZ_OK;
}

/* ---- numbers ------------------------------------------------------------ */

/* The format must put the numbers on as many lines as there are said to be. */
static ritz_status begin_section(ritz_boeing *b, int section, int64_t count)
{
    static const char *const what[] = {"pointers", "rows", "values"};
    const ritz_boeing_form *form = &b->form[section];
    const int64_t lines = (count + form->repeat - 1) / form->repeat;

    RITZ_REFUSE_IF(b->lines[section] != lines, RITZ_ERR_FORMAT,
                   "%" PRId64 " %s as %s take %" PRId64
                   " lines, but the head says %" PRId64,
                   count, what[section], form->text, lines, b->lines[section]);
    b->used = form->repeat;
    return RITZ_OK;
}

/* Nothing may stand behind the numbers of a line that were taken. */
static ritz_status check_rest(const ritz_boeing *b,
                              const ritz_boeing_form *form)
{
    const char *end = NULL;
    const char *at =
        cut_field(&b->text, b->used * form->width, INT32_MAX, &end);

    at = ritz_decimal_skip(at, end);
    RITZ_REFUSE_IF(at < end, RITZ_ERR_FORMAT,
                   "'%.*s' follows the numbers that are due as %s",
                   ritz_lines_quoted(at, end), at, form->text);
    return RITZ_OK;
}

/* The next field, less its blanks; the first on a new line where that is due. A
 * field that the end of the file cuts may have lost digits. */
static ritz_status take_field(ritz_boeing *b, const ritz_boeing_form *form,
                              bool begins, const char **at, const char **end)
{
    if (b->used == form->repeat) {
        if (!begins)
            RITZ_CHECK(check_rest(b, form));
        RITZ_REFUSE_IF(!take_line(b), RITZ_ERR_FORMAT,
                       "ends before all numbers as %s", form->text);
        b->used = 0;
    }
    *at = cut_field(&b->text, b->used++ * form->width, form->width, end);
    RITZ_REFUSE_IF(b->cut && *end - *at < form->width, RITZ_ERR_FORMAT,
                   "ends within a number as %s", form->text);
    *at = ritz_decimal_skip(*at, *end);
    while (*end > *at && ritz_decimal_skip(*end - 1, *end) == *end)
        (*end)--;
    RITZ_REFUSE_IF(*at == *end, RITZ_ERR_FORMAT,
                   "number %" PRId64 " of the line, as %s, is blank", b->used,
                   form->text);
    return RITZ_OK;
}

/* A whole number from `least` to `most`. */
static ritz_status take_whole(ritz_boeing *b, int section, bool begins,
                              const int64_t range[2], int64_t *out)
{
    const char *at = NULL, *from = NULL;
    const char *end = NULL;

    RITZ_CHECK(take_field(b, &b->form[section], begins, &at, &end));
    from = at;
    RITZ_REFUSE_IF(!ritz_decimal_scan_whole(&at, end, out) || at != end,
                   RITZ_ERR_FORMAT, "'%.*s' is not a whole number",
                   ritz_lines_quoted(from, end), from);
    RITZ_REFUSE_IF(*out < range[0] || *out > range[1], RITZ_ERR_FORMAT,
                   "%s %" PRId64 " is not from %" PRId64 " to %" PRId64,
                   section == RITZ_BOEING_ROWS ? "row" : "pointer", *out,
                   range[0], range[1]);
    return RITZ_OK;
}

/* Whether Fortran takes the number as it stands: without a point it puts one in
 * as the format says, and without an exponent P scales. */
static bool is_literal(const ritz_boeing_form *form, const char *at,
                       const char *end)
{
    const bool point = memchr(at, '.', (size_t)(end - at)) != NULL;
    bool exponent = false;

    for (const char *c = at + 1; c < end; c++)
        exponent = exponent || strchr("EeDd+-", *c);
    return form->letter == 'I' || (point && (exponent || form->scale == 0));
}

static ritz_status take_value(ritz_boeing *b, bool begins, double *out)
{
    const ritz_boeing_form *form = &b->form[RITZ_BOEING_VALUES];
    ritz_decimal number = {0};
    const char *at = NULL, *from = NULL;
    const char *end = NULL;

    RITZ_CHECK(take_field(b, form, begins, &at, &end));
    from = at;
    RITZ_REFUSE_IF(!ritz_decimal_scan(&at, end, &number) || at != end,
                   RITZ_ERR_FORMAT, "'%.*s' is not a number",
                   ritz_lines_quoted(from, end), from);
    RITZ_REFUSE_IF(!isfinite(number.value), RITZ_ERR_FORMAT,
                   "'%.*s' is not finite", ritz_lines_quoted(from, end), from);
    RITZ_REFUSE_IF(number.value != 0.0 && !is_literal(form, from, end),
                   RITZ_ERR_FORMAT,
                   "'%.*s' has no point or exponent, and is scaled as %s",
                   ritz_lines_quoted(from, end), from, form->text);
    if (number.digits > b->digits)
        b->digits = number.digits;
    *out = number.value;
    return RITZ_OK;
}

/* ---- sections ----------------------------------------------------------- */

static ritz_status read_pointers(ritz_boeing *b)
{
    int64_t range[2] = {1, 1};
    int64_t pointer = 0;

    RITZ_CHECK(begin_section(b, RITZ_BOEING_POINTERS, b->ncol + 1));
    RITZ_CHECK_NEW(b->first, b->ncol + 1);
    for (int64_t j = 0; j <= b->ncol; j++) {
        RITZ_CHECK(
            take_whole(b, RITZ_BOEING_POINTERS, j == 0, range, &pointer));
        b->first[j] = pointer - 1;
        range[1] = b->count + 1;
        range[0] = j + 1 < b->ncol ? pointer : range[1]; /* the last is behind
                                                            all entries */
    }
    return check_rest(b, &b->form[RITZ_BOEING_POINTERS]);
}

static ritz_status read_rows(ritz_boeing *b)
{
    const int64_t range[2] = {1, b->nrow};
    int64_t k = 0;

    RITZ_CHECK(begin_section(b, RITZ_BOEING_ROWS, b->count));
    RITZ_CHECK_NEW(b->entry, b->count);
    for (int64_t j = 0; j < b->ncol; j++)
        for (; k < b->first[j + 1]; k++) {
            int64_t row = 0;

            RITZ_CHECK(take_whole(b, RITZ_BOEING_ROWS, k == 0, range, &row));
            b->entry[k].row = row - 1;
            b->entry[k].col = j;
        }
    return b->count > 0 ? check_rest(b, &b->form[RITZ_BOEING_ROWS]) : RITZ_OK;
}

/* im and re of A(i,j) times these are those of A(j,i). */
static double mirror_sign(const ritz_boeing *b, bool imaginary)
{
    return b->type[1] == 'Z' || (imaginary && b->type[1] == 'H') ? -1.0 : 1.0;
}

/* Move an entry of a symmetric matrix to the lower triangle. */
static ritz_status fold_entry(const ritz_boeing *b, ritz_boeing_entry *e)
{
    const int64_t row = e->row;

    RITZ_REFUSE_IF(row == e->col &&
                       ((b->type[1] == 'Z' && (e->re != 0.0 || e->im != 0.0)) ||
                        (b->type[1] == 'H' && e->im != 0.0)),
                   RITZ_ERR_FORMAT,
                   "diagonal entry %" PRId64 " cannot be in type '%s'", row + 1,
                   b->type);
    if (!strchr("SHZ", b->type[1]) || row >= e->col)
        return RITZ_OK;
    e->row = e->col;
    e->col = row;
    e->re *= mirror_sign(b, false);
    e->im *= mirror_sign(b, true);
    return RITZ_OK;
}

static ritz_status read_values(ritz_boeing *b)
{
    const bool pairs = b->type[0] == 'C';

    RITZ_CHECK(
        begin_section(b, RITZ_BOEING_VALUES, b->count * (pairs ? 2 : 1)));
    for (int64_t k = 0; k < b->count; k++) {
        ritz_boeing_entry *e = &b->entry[k];

        RITZ_CHECK(take_value(b, k == 0, &e->re));
        if (pairs)
            RITZ_CHECK(take_value(b, false, &e->im));
        RITZ_CHECK(fold_entry(b, e));
    }
    return b->count > 0 ? check_rest(b, &b->form[RITZ_BOEING_VALUES]) : RITZ_OK;
}

/* Only right sides may stand behind the values. */
static ritz_status check_end(ritz_boeing *b)
{
    while (b->lines[RITZ_BOEING_RIGHT_SIDES] == 0 && take_line(b)) {
        const char *at = ritz_decimal_skip(b->text.line, b->text.line_end);

        RITZ_REFUSE_IF(at < b->text.line_end, RITZ_ERR_FORMAT,
                       "more than the head says");
    }
    return RITZ_OK;
}

static ritz_status read_sections(ritz_boeing *b)
{
    RITZ_CHECK(read_pointers(b));
    RITZ_CHECK(read_rows(b));
    RITZ_CHECK(read_values(b));
    return check_end(b);
}

/* ---- entries to columns ------------------------------------------------- */

/* By column, then row. */
static int compare_entries(const void *left, const void *right)
{
    const ritz_boeing_entry *a = left;
    const ritz_boeing_entry *b = right;
    int order = (a->col > b->col) - (a->col < b->col);

    return order ? order : (a->row > b->row) - (a->row < b->row);
}

/* Sorted; no place may occur twice. */
static ritz_status sort_entries(ritz_boeing *b)
{
    bool ascend = true;

    for (int64_t k = 1; k < b->count && ascend; k++)
        ascend = compare_entries(&b->entry[k - 1], &b->entry[k]) < 0;
    if (!ascend)
        qsort(b->entry, (size_t)b->count, sizeof *b->entry, compare_entries);
    for (int64_t k = 1; k < b->count; k++)
        RITZ_REFUSE_IF(compare_entries(&b->entry[k - 1], &b->entry[k]) == 0,
                       RITZ_ERR_FORMAT,
                       "entry (%" PRId64 ", %" PRId64 ") is given twice%s",
                       b->entry[k].row + 1, b->entry[k].col + 1,
                       strchr("SHZ", b->type[1])
                           ? "; such a type gives one triangle only"
                           : "");
    return RITZ_OK;
}

static ritz_status compress_entries(ritz_boeing *b, ritz_matrix *out)
{
    RITZ_OWN(ritz_matrix) new = {0};
    RITZ_OWN(ritz_triplets) list = {.is_complex = b->type[0] == 'C'};

    RITZ_CHECK(ritz_triplets_reserve(&list, b->count));
    for (int64_t k = 0; k < b->count; k++) {
        const ritz_boeing_entry *e = &b->entry[k];

        ritz_triplets_put_value(&list, e->row, e->col, e->re, e->im);
    }
    RITZ_CHECK(ritz_triplets_compress(&list, b->nrow, b->ncol, &new));
    if (strchr("SHZ", b->type[1]))
        RITZ_CHECK(ritz_matrix_mirror(&new, mirror_sign(b, false),
                                      mirror_sign(b, true)));
    RITZ_MOVE(*out, new);
    return RITZ_OK;
}

/* ---- files -------------------------------------------------------------- */

/* Read the head, and the numbers too if they are wanted; what is wrong is said
 * with its line. */
static ritz_status read_lines(ritz_boeing *b, bool numbers)
{
    ritz_status status = read_head(b);
    char line[32];

    if (status == RITZ_OK && numbers)
        status = read_sections(b);
    snprintf(line, sizeof line, "line %" PRId64,
             b->text.number > 0 ? b->text.number : 1);
    return ritz_context(status, line);
}

static ritz_status list_file(const ritz_foreign *file, ritz_listing *out)
{
    ritz_boeing b = {
        .text = {.at = file->bytes, .end = file->bytes + file->size}};
    ritz_listed item = {0};

    RITZ_CHECK(read_lines(&b, false));
    item.nrow = b.nrow;
    item.ncol = b.ncol;
    item.symmetric = b.type[1] == 'S';
    item.is_complex = b.type[0] == 'C';
    return ritz_listing_add(out, &item);
}

static int64_t count_digits(const ritz_boeing *b)
{
    enum { EXACT = 17 };

    if (b->form[RITZ_BOEING_VALUES].letter == 'I' || b->digits > EXACT)
        return EXACT; /* whole numbers are exact */
    return b->digits < 1 ? 1 : b->digits;
}

static ritz_status read_matrix(const ritz_foreign *file,
                               const ritz_listed *which, ritz_matrix *out)
{
    RITZ_OWN(ritz_boeing)
    b = {.text = {.at = file->bytes, .end = file->bytes + file->size}};

    (void)which; /* there is one */
    RITZ_CHECK(read_lines(&b, true));
    RITZ_CHECK(sort_entries(&b));
    RITZ_CHECK(compress_entries(&b, out));
    out->symmetric = b.type[1] == 'S';
    out->digits = count_digits(&b);
    snprintf(out->spelling, sizeof out->spelling, "%s-Boeing %s, %s%s",
             b.is_rutherford ? "Rutherford" : "Harwell", b.type,
             b.form[RITZ_BOEING_VALUES].text,
             b.lines[RITZ_BOEING_RIGHT_SIDES] > 0 ? ", right sides unread"
                                                  : "");
    return RITZ_OK;
}

const ritz_format ritz_format_harwell_boeing = {
    .name = "harwell-boeing",
    .summary = "Harwell-Boeing and Rutherford-Boeing, assembled",
    .reference = "DuffGrimesLewis1989",
    .recognise = has_counts,
    .list = list_file,
    .read = read_matrix,
};
