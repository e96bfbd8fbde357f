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
 *
 * It is written with 17 digits, which read back to the same bits. A matrix is
 * called symmetric, and written as its lower triangle, if it says so and its
 * triangles agree in every bit; else nothing would bring the difference back.
 * It is an array if all its entries are stored.
 */
#include "base/alloc.h"
#include "base/search.h"
#include "formats/decimal.h"
#include "formats/matrix.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* In the order of their names below. */
enum { RITZ_MARKET_COORDINATE, RITZ_MARKET_ARRAY };
enum {
    RITZ_MARKET_REAL,
    RITZ_MARKET_DOUBLE,
    RITZ_MARKET_INTEGER,
    RITZ_MARKET_COMPLEX,
    RITZ_MARKET_PATTERN,
};
enum {
    RITZ_MARKET_GENERAL,
    RITZ_MARKET_SYMMETRIC,
    RITZ_MARKET_SKEW,
    RITZ_MARKET_HERMITIAN,
};

typedef struct ritz_market_entry {
    int64_t row, col; /* from 0; of symmetric files in the lower triangle */
    double re, im;
    bool flipped; /* stood in the upper triangle */
} ritz_market_entry;

typedef struct ritz_market {
    ritz_lines text;
    int layout, field, symmetry;
    const char *kind; /* its symmetry in words */
    int64_t nrow, ncol;
    int64_t most; /* entries there is room for */
    int64_t count;
    ritz_market_entry *entry;
    int64_t digits;
} ritz_market;

static void ritz_market_free(ritz_market *m)
{
    free(m->entry);
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

/* All entries of the matrix, both triangles of symmetric ones. */
static ritz_status compress_entries(ritz_market *m, ritz_matrix *out)
{
    ritz_market_entry sign = {.re = 1.0, .im = 1.0};
    RITZ_OWN(ritz_matrix) new = {0};
    RITZ_OWN(ritz_triplets)
    list = {.is_complex = m->field == RITZ_MARKET_COMPLEX};

    RITZ_CHECK(ritz_triplets_reserve(&list, m->count));
    for (int64_t k = 0; k < m->count; k++) {
        const ritz_market_entry *e = &m->entry[k];

        ritz_triplets_put_value(&list, e->row, e->col, e->re, e->im);
    }
    ritz_market_free(m);
    m->entry = NULL;
    RITZ_CHECK(ritz_triplets_compress(&list, m->nrow, m->ncol, &new));
    mirror_value(m, &sign.re, &sign.im);
    if (m->symmetry != RITZ_MARKET_GENERAL)
        RITZ_CHECK(ritz_matrix_mirror(&new, sign.re, sign.im));
    RITZ_MOVE(*out, new);
    return RITZ_OK;
}

/* ---- lines of entries --------------------------------------------------- */

/* Take the next line that is neither blank nor a comment, less its blanks. */
static bool next_line(ritz_market *m)
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

    RITZ_REFUSE_IF(!ritz_decimal_scan_wholes(&at, m->text.line_end, 2, n),
                   RITZ_ERR_FORMAT, "'%.*s' is not an entry 'row column value'",
                   ritz_lines_quoted(m->text.line, m->text.line_end),
                   m->text.line);
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

/* Entries from the next line to the end of the file. */
static ritz_status read_entries(ritz_market *m)
{
    ritz_market_entry next = {.row = m->symmetry == RITZ_MARKET_SKEW};

    while (next_line(m))
        RITZ_CHECK(m->layout == RITZ_MARKET_COORDINATE ? read_entry(m)
                                                       : read_values(m, &next));
    RITZ_REFUSE_IF(m->count < m->most, RITZ_ERR_FORMAT,
                   "ends after %" PRId64 " of %" PRId64 " entries", m->count,
                   m->most);
    return RITZ_OK;
}

/* ---- head of the file --------------------------------------------------- */

/* Rows or columns that a file may declare beyond one for each byte. */
enum { NULL_ROWS = 32000000 };

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

    RITZ_REFUSE_IF(!next_line(m), RITZ_ERR_FORMAT, "ends before its size");
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
    RITZ_REFUSE_IF(m->nrow - NULL_ROWS > bytes || m->ncol - NULL_ROWS > bytes,
                   RITZ_ERR_FORMAT,
                   "%" PRId64 " x %" PRId64
                   " is far more than the file can fill",
                   m->nrow, m->ncol);
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
    char line[32];

    if (status == RITZ_OK)
        status = read_size(m);
    if (status == RITZ_OK && entries) {
        RITZ_CHECK_NEW(m->entry, m->most);
        status = read_entries(m);
    }
    snprintf(line, sizeof line, "line %" PRId64,
             m->text.number > 0 ? m->text.number : 1);
    return ritz_context(status, line);
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

static int64_t count_digits(const ritz_market *m)
{
    if (m->field == RITZ_MARKET_INTEGER || m->field == RITZ_MARKET_PATTERN ||
        m->digits > 17)
        return 17; /* whole numbers are exact */
    return m->digits < 1 ? 1 : m->digits;
}

static ritz_status read_matrix(const ritz_foreign *file,
                               const ritz_listed *which, ritz_matrix *out)
{
    RITZ_OWN(ritz_market)
    m = {.text = {.at = file->bytes, .end = file->bytes + file->size}};

    (void)which; /* there is one */
    RITZ_CHECK(read_lines(&m, true));
    RITZ_CHECK(settle_entries(&m));
    RITZ_CHECK(compress_entries(&m, out));
    out->symmetric = m.symmetry == RITZ_MARKET_SYMMETRIC;
    out->digits = count_digits(&m);
    snprintf(out->spelling, sizeof out->spelling, "Matrix Market %s, %s, %s",
             layouts[m.layout], fields[m.field], m.kind);
    return RITZ_OK;
}

const ritz_format ritz_format_matrix_market = {
    .name = "matrix-market",
    .summary = "Matrix Market, coordinate or array",
    .reference = "BoisvertPozoRemington1996",
    .recognise = has_banner,
    .list = list_file,
    .read = read_matrix,
};

/* ---- writing ------------------------------------------------------------ */

typedef struct market_job {
    const ritz_matrix *matrix;
    const char *comment;
} market_job;

/* Place of A(i,j) among the entries; -1 if nothing is stored there. */
static int64_t find_entry(const ritz_sparse *A, int64_t i, int64_t j)
{
    int64_t p = A->colptr[j];
    int64_t k = ritz_search(A->colptr[j + 1] - p, A->rowind + p, i);

    return k < 0 ? -1 : p + k;
}

/* True if A(j,i) is stored and equal for each A(i,j). */
static bool is_mirrored(const ritz_matrix *m)
{
    for (int64_t j = 0; j < m->A.ncol; j++)
        for (int64_t p = m->A.colptr[j]; p < m->A.colptr[j + 1]; p++) {
            int64_t q = find_entry(&m->A, j, m->A.rowind[p]);

            if (q < 0 || m->A.val[p] != m->A.val[q] ||
                (m->imaginary && m->imaginary[p] != m->imaginary[q]))
                return false;
        }
    return true;
}

static void write_comment(FILE *file, const char *comment)
{
    while (comment && *comment) {
        size_t length = strcspn(comment, "\r\n");

        fprintf(file, "%% %.*s\n", (int)length, comment);
        comment += length;
        comment += *comment != '\0';
    }
}

static ritz_status write_market(FILE *file, const void *what)
{
    const market_job *all = what;
    const ritz_matrix *m = all->matrix;
    const ritz_sparse *A = &m->A;
    int64_t nnz = A->colptr[A->ncol];
    bool symmetric =
        m->symmetric && A->nrow == A->ncol && nnz > 0 && is_mirrored(m);
    bool array = A->ncol > 0 && nnz % A->ncol == 0 && nnz / A->ncol == A->nrow;
    int64_t count = 0;

    RITZ_CHECK(ritz_sink_check(m));
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            count += !symmetric || A->rowind[p] >= j;
    fprintf(file, "%%%%MatrixMarket matrix %s %s %s\n",
            array ? "array" : "coordinate", m->imaginary ? "complex" : "real",
            symmetric ? "symmetric" : "general");
    write_comment(file, all->comment);
    fprintf(file, "%" PRId64 " %" PRId64, A->nrow, A->ncol);
    if (!array)
        fprintf(file, " %" PRId64, count);
    fputc('\n', file);
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            if (symmetric && A->rowind[p] < j)
                continue;
            if (!array)
                fprintf(file, "%" PRId64 " %" PRId64 " ", A->rowind[p] + 1,
                        j + 1);
            fprintf(file, "%.16e", A->val[p]);
            if (m->imaginary)
                fprintf(file, " %.16e", m->imaginary[p]);
            fputc('\n', file);
        }
    return RITZ_OK;
}

ritz_status ritz_matrix_market_write(const char *path,
                                     const ritz_matrix *matrix,
                                     const char *comment)
{
    market_job all = {matrix, comment};

    return ritz_sink_write(path, write_market, &all);
}

/*
 * Matrices of a reduced component or state space in Matrix Market form, each in
 * a file of its own: "small-%.mtx" becomes small-A.mtx, small-B.mtx, ...
 */

/* The output with the matrix' name in the place of its '%', if there is one. */
static ritz_status name_file(const char *output, const char *name, char **out)
{
    int64_t room = (int64_t)(strlen(output) + strlen(name)) + 1;
    const char *mark = strchr(output, '%');
    char *path = NULL;

    RITZ_CHECK_NEW(path, room);
    if (mark)
        snprintf(path, (size_t)room, "%.*s%s%s", (int)(mark - output), output,
                 name, mark + 1);
    else
        snprintf(path, (size_t)room, "%s", output);
    *out = path;
    return RITZ_OK;
}

/* One file takes one matrix, a pattern of names all of them. */
static ritz_status write_matrices(const ritz_export_object *object,
                                  const ritz_export_request *request,
                                  ritz_export_report *report)
{
    bool pattern = strchr(request->output, '%') != NULL;
    const char *one = object->states ? "A" : "K";
    const char *method = object->states ? object->states->origin.method
                                        : object->reduced->origin.method;
    RITZ_OWN(ritz_matrices) list = {0};

    RITZ_CHECK(ritz_export_damped(object, request, pattern ? NULL : one, report,
                                  &list));
    RITZ_REFUSE_IF(list.count != 1 && !pattern, RITZ_ERR_ARGUMENT,
                   "a Matrix Market file holds one matrix: name it with "
                   "--matrix, or write '%%' for it in the output's name");
    for (int64_t k = 0; k < list.count; k++) {
        const char *name = list.matrix[k].name;
        char comment[4 * RITZ_NAME_SIZE];
        RITZ_OWN_ARRAY char *path = NULL;

        snprintf(comment, sizeof comment, *method ? "%s, reduced by %s" : "%s",
                 name, method);
        RITZ_CHECK(name_file(request->output, name, &path));
        RITZ_CHECK(ritz_matrix_market_write(path, &list.matrix[k], comment));
    }
    return RITZ_OK;
}

const ritz_exporter ritz_exporter_matrix_market = {
    .name = "matrix-market",
    .summary = "Matrix Market text: one matrix, or -o NAME-%.mtx for all",
    .reference = "BoisvertPozoRemington1996",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_STATES | RITZ_EXPORT_MATRICES,
    .write = write_matrices,
};
