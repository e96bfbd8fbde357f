/*
 * OUTPUT4 as it is written: FORM 1, 2 or 6 (both triangles), TYPE 2 or 4.
 *
 * Text is 1P,nEw.d with d = digits - 1 and w = d + 7, one more where an
 * exponent has three digits, as many numbers as fit 80 letters. Sparse is
 * bigmat: it has no limit of rows. Binary has 4-byte integers in native order.
 */
#include "base/tolerances.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    RITZ_OUTPUT4_MOST_8 = 99999999, /* in eight letters */
    RITZ_OUTPUT4_LINE = 80,
};

/* A file, and the matrix that is being written to it. */
typedef struct ritz_output4_writer {
    FILE *file;
    const ritz_matrix *matrix;
    ritz_output4_style style;
    int64_t numbers; /* per value: 1 real, 2 complex */
    int width;       /* of a number in text */
    int integer;     /* of an integer */
    int64_t placed;  /* numbers on the present line */
} ritz_output4_writer;

/* ---- words -------------------------------------------------------------- */

/* Up to 8 letters, digits and '_', capitals, a letter first. */
static void write_name(const char *name, char out[9])
{
    size_t used = 0;

    memset(out, 0, 9);
    for (; *name && used < 8; name++) {
        char c = *name;
        bool digit = c >= '0' && c <= '9';

        if (c >= 'a' && c <= 'z')
            c = (char)(c - 'a' + 'A');
        if (!digit && (c < 'A' || c > 'Z'))
            c = '_';
        if (used == 0 && (digit || c == '_'))
            out[used++] = 'M';
        out[used++] = c;
    }
    if (used == 0)
        out[used++] = 'M';
    memset(out + used, ' ', 8 - used);
}

/* Integers, which are a line of their own in text. */
static void put_integers(const ritz_output4_writer *w, int64_t count,
                         const int64_t *n)
{
    for (int64_t k = 0; k < count; k++) {
        int32_t narrow = (int32_t)n[k];

        if (w->style.text)
            fprintf(w->file, "%*" PRId64, w->integer, n[k]);
        else
            fwrite(&narrow, sizeof narrow, 1, w->file);
    }
    if (w->style.text)
        fputc('\n', w->file);
}

static void put_number(ritz_output4_writer *w, double number)
{
    if (!w->style.text) {
        fwrite(&number, sizeof number, 1, w->file);
        return;
    }
    fprintf(w->file, "%#*.*E", w->width, (int)w->style.digits - 1, number);
    w->placed++;
    if (w->placed == RITZ_OUTPUT4_LINE / w->width) {
        fputc('\n', w->file);
        w->placed = 0;
    }
}

/* The value of entry @p p, or zero if it is -1. */
static void put_value(ritz_output4_writer *w, int64_t p)
{
    put_number(w, p < 0 ? 0.0 : w->matrix->A.val[p]);
    if (w->numbers == 2)
        put_number(w, p < 0 ? 0.0 : w->matrix->imaginary[p]);
}

static void end_line(ritz_output4_writer *w)
{
    if (w->style.text && w->placed > 0)
        fputc('\n', w->file);
    w->placed = 0;
}

/* The length in front of and behind a record of bytes. */
static void put_mark(const ritz_output4_writer *w, int64_t bytes)
{
    int32_t mark = (int32_t)bytes;

    if (!w->style.text)
        fwrite(&mark, sizeof mark, 1, w->file);
}

static void put_header(const ritz_output4_writer *w)
{
    const ritz_matrix *m = w->matrix;
    int64_t nrow = w->style.sparse ? -m->A.nrow : m->A.nrow;
    int64_t square = m->A.nrow == m->A.ncol ? 1 : 2;
    int64_t n[4] = {m->A.ncol, nrow, square, 2 * w->numbers};
    bool wide = n[0] > RITZ_OUTPUT4_MOST_8 || nrow > RITZ_OUTPUT4_MOST_8 ||
                nrow < -RITZ_OUTPUT4_MOST_8 / 10;
    char name[9];

    if (m->symmetric && square == 1)
        n[2] = 6;
    write_name(m->name, name);
    put_mark(w, 24);
    if (w->style.text) {
        fprintf(w->file, "%*" PRId64 "%*" PRId64 "%8" PRId64 "%8" PRId64 "%s",
                wide ? 16 : 8, n[0], wide ? 16 : 8, n[1], n[2], n[3], name);
        fprintf(w->file, "1P,%dE%d.%d%s\n", RITZ_OUTPUT4_LINE / w->width,
                w->width, (int)w->style.digits - 1, wide ? "|I16" : "");
    } else {
        put_integers(w, 4, n);
        fwrite(name, 1, 8, w->file);
    }
    put_mark(w, 24);
}

/* ---- matrices ----------------------------------------------------------- */

enum { MOST_RECORD = 0x7fffffff };

/* The matrices of one file. */
typedef struct job {
    int64_t count;
    const ritz_matrix *matrix;
    ritz_output4_style style;
} job;

static bool is_zero(const ritz_matrix *m, int64_t p)
{
    return m->A.val[p] == 0.0 && (!m->imaginary || m->imaginary[p] == 0.0);
}

/* First entry from `p` that is not zero; `end` if there is none. */
static int64_t next_entry(const ritz_matrix *m, int64_t p, int64_t end)
{
    while (p < end && is_zero(m, p))
        p++;
    return p;
}

/* Behind the last entry of the run that begins at `p`: consecutive rows of a
 * sparse column, all of a dense one. */
static int64_t end_of_run(const ritz_output4_writer *w, int64_t p, int64_t end)
{
    const ritz_matrix *m = w->matrix;
    int64_t q = p + 1;

    while (!w->style.sparse && is_zero(m, end - 1))
        end--;
    if (!w->style.sparse)
        return end;
    while (q < end && m->A.rowind[q] == m->A.rowind[q - 1] + 1 &&
           !is_zero(m, q))
        q++;
    return q;
}

/* Words in front of the data of a record: ICOL, IROW, NW; 4 bytes each. */
static ritz_status begin_column(const ritz_output4_writer *w, int64_t j,
                                int64_t row, int64_t words)
{
    RITZ_REFUSE_IF(
        !w->style.text && words > MOST_RECORD / 4 - 3, RITZ_ERR_ARGUMENT,
        "column %" PRId64 " of '%s' is too long for a record of 2 GiB", j + 1,
        w->matrix->name);
    put_mark(w, 4 * (words + 3));
    put_integers(w, 3, (const int64_t[]){j + 1, row, words});
    return RITZ_OK;
}

/* The runs of a column, those of a sparse one behind L + 1 and IROW. */
static ritz_status write_column(ritz_output4_writer *w, int64_t j,
                                int64_t begin, int64_t end)
{
    const ritz_matrix *m = w->matrix;
    const int64_t *row = m->A.rowind;
    bool sparse = w->style.sparse;
    int64_t wide = w->numbers * (w->style.text && !sparse ? 1 : 2);
    int64_t words = 0;

    for (int64_t p = begin, q = 0; p < end; p = next_entry(m, q, end)) {
        q = end_of_run(w, p, end);
        words += (sparse ? 2 : 0) + wide * (row[q - 1] - row[p] + 1);
    }
    RITZ_CHECK(begin_column(w, j, sparse ? 0 : row[begin] + 1, words));
    for (int64_t p = begin, q = 0; p < end; p = next_entry(m, q, end)) {
        int64_t first = row[p];

        q = end_of_run(w, p, end);
        if (sparse)
            put_integers(w, 2,
                         (const int64_t[]){wide * (q - p) + 1, first + 1});
        for (int64_t i = first, k = p; i <= row[q - 1]; i++)
            put_value(w, row[k] == i ? k++ : -1);
        end_line(w);
    }
    put_mark(w, 4 * (words + 3));
    return RITZ_OK;
}

/* Refuse a matrix that cannot be written, before anything is written. */
static ritz_status check_matrix(const ritz_matrix *m,
                                const ritz_output4_style *style)
{
    int64_t most = INT32_MAX - 1;

    RITZ_REFUSE_IF(!style->text && (m->A.nrow > most || m->A.ncol > most),
                   RITZ_ERR_ARGUMENT,
                   "'%s' is %" PRId64 " x %" PRId64
                   ", too large for 4-byte integers",
                   m->name, m->A.nrow, m->A.ncol);
    return ritz_sink_check(m);
}

/* True if the exponent takes three digits after rounding. */
static bool is_long(double x)
{
    x = fabs(x);
    return x > 0.0 && (x < RITZ_TWO_DIGIT_EXPONENT || x > 9e98);
}

static int number_width(const ritz_matrix *m, int64_t digits)
{
    int width = (int)digits + 6;

    for (int64_t p = 0; p < m->A.colptr[m->A.ncol]; p++)
        if (is_long(m->A.val[p]) || (m->imaginary && is_long(m->imaginary[p])))
            return width + 1;
    return width;
}

static ritz_status write_matrix(FILE *file, const ritz_matrix *m,
                                const ritz_output4_style *style)
{
    ritz_output4_writer w = {.file = file, .matrix = m, .style = *style};
    int64_t last = m->A.ncol;

    RITZ_CHECK(check_matrix(m, style));
    w.numbers = m->imaginary ? 2 : 1;
    w.width = number_width(m, style->digits);
    w.integer =
        last >= RITZ_OUTPUT4_MOST_8 || m->A.nrow > RITZ_OUTPUT4_MOST_8 ? 16 : 8;
    put_header(&w);
    for (int64_t j = 0; j < last; j++) {
        int64_t end = m->A.colptr[j + 1];
        int64_t begin = next_entry(m, m->A.colptr[j], end);

        if (begin < end)
            RITZ_CHECK(write_column(&w, j, begin, end));
    }
    RITZ_CHECK(begin_column(&w, last, 1, style->text ? 1 : 2));
    put_number(&w, sqrt(2.0));
    end_line(&w);
    put_mark(&w, 20);
    return RITZ_OK;
}

static ritz_status write_all(FILE *file, const void *what)
{
    const job *all = what;

    for (int64_t k = 0; k < all->count; k++)
        RITZ_CHECK(write_matrix(file, &all->matrix[k], &all->style));
    return RITZ_OK;
}

ritz_status ritz_output4_fill(const ritz_draft *draft, int64_t count,
                              const ritz_matrix *matrix,
                              const ritz_output4_style *style)
{
    job all = {count, matrix, *style};

    if (all.style.digits == 0)
        all.style.digits = 17;
    RITZ_REFUSE_IF(count < 1, RITZ_ERR_ARGUMENT, "there is no matrix for '%s'",
                   draft->path);
    RITZ_REFUSE_IF(
        all.style.digits < 1 || all.style.digits > 17, RITZ_ERR_ARGUMENT,
        "%" PRId64 " digits cannot be written, 1 to 17 can", all.style.digits);
    return ritz_sink_fill(draft, write_all, &all);
}

ritz_status ritz_output4_write(const char *path, int64_t count,
                               const ritz_matrix *matrix,
                               const ritz_output4_style *style)
{
    RITZ_OWN(ritz_draft) draft = {0};

    RITZ_CHECK_IN(path, ritz_draft_new(path, &draft));
    RITZ_CHECK(ritz_output4_fill(&draft, count, matrix, style));
    return ritz_draft_publish(&draft);
}

/* ---- exporter ----------------------------------------------------------- */

ritz_status ritz_output4_style_of(const ritz_export_request *request,
                                  ritz_export_report *report,
                                  ritz_output4_style *out)
{
    *out = (ritz_output4_style){
        .text = request->text,
        .sparse = !request->dense,
        .digits = request->digits > 0 ? request->digits : 17,
    };
    if (!out->text || out->digits == 17)
        return RITZ_OK;
    return ritz_export_say(report,
                           "%lld digits: values are rounded, and a free "
                           "body is then not quite free",
                           (long long)out->digits);
}

static ritz_status write_matrices(const ritz_export_object *object,
                                  const ritz_export_request *request,
                                  ritz_export_report *report)
{
    ritz_output4_style style = {0};
    RITZ_OWN(ritz_matrices) list = {0};

    RITZ_CHECK(ritz_export_damped(object, request, NULL, report, &list));
    RITZ_CHECK(ritz_output4_style_of(request, report, &style));
    RITZ_CHECK(ritz_export_say_rest(object, request, &list, report));
    if (!style.text || style.digits == 17)
        RITZ_CHECK(ritz_export_say(report, "numbers keep every bit"));
    RITZ_CHECK(ritz_export_say(report, "the file has no place for names, "
                                       "inertia and the certificate"));
    return ritz_output4_write(request->output, list.count, list.matrix, &style);
}

const ritz_exporter ritz_exporter_output4 = {
    .name = "output4",
    .summary = "NASTRAN OUTPUT4 matrices, binary or text",
    .reference = "MSC2014",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_STATES | RITZ_EXPORT_MATRICES |
             RITZ_EXPORT_STYLE | RITZ_EXPORT_LOADS,
    .write = write_matrices,
};
