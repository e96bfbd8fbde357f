/* Words of OUTPUT4 one by one, as text or as bytes. */
#include "formats/output4_put.h"

#include <inttypes.h>
#include <string.h>

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

void ritz_output4_put_integers(const ritz_output4_writer *w, int64_t count,
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

void ritz_output4_put_number(ritz_output4_writer *w, double number)
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

void ritz_output4_put_value(ritz_output4_writer *w, int64_t p)
{
    ritz_output4_put_number(w, p < 0 ? 0.0 : w->matrix->A.val[p]);
    if (w->numbers == 2)
        ritz_output4_put_number(w, p < 0 ? 0.0 : w->matrix->imaginary[p]);
}

void ritz_output4_end_line(ritz_output4_writer *w)
{
    if (w->style.text && w->placed > 0)
        fputc('\n', w->file);
    w->placed = 0;
}

void ritz_output4_put_mark(const ritz_output4_writer *w, int64_t bytes)
{
    int32_t mark = (int32_t)bytes;

    if (!w->style.text)
        fwrite(&mark, sizeof mark, 1, w->file);
}

void ritz_output4_put_header(const ritz_output4_writer *w)
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
    ritz_output4_put_mark(w, 24);
    if (w->style.text) {
        fprintf(w->file, "%*" PRId64 "%*" PRId64 "%8" PRId64 "%8" PRId64 "%s",
                wide ? 16 : 8, n[0], wide ? 16 : 8, n[1], n[2], n[3], name);
        fprintf(w->file, "1P,%dE%d.%d%s\n", RITZ_OUTPUT4_LINE / w->width,
                w->width, (int)w->style.digits - 1, wide ? "|I16" : "");
    } else {
        ritz_output4_put_integers(w, 4, n);
        fwrite(name, 1, 8, w->file);
    }
    ritz_output4_put_mark(w, 24);
}
