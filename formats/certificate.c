#include "formats/certificate.h"
#include "base/text.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The parts of a reduced component or state space that its certificate states.
 */
typedef struct certified {
    const char *what;
    const ritz_origin *origin;
    const ritz_columns *columns;
    const char *units, *damping;
    bool damped; /* the matrices contain damping */
    const ritz_measures *errors, *estimates;
    int64_t order;
} certified;

static certified find_certified(const ritz_export_object *object)
{
    const ritz_reduced *r = object->reduced;
    const ritz_state_space *s = object->states;

    if (r)
        return (certified){"reduced component",
                           &r->origin,
                           &r->columns,
                           r->units,
                           r->damping,
                           r->D.val != NULL,
                           &r->errors,
                           &r->estimates,
                           r->K.ncol};
    return (certified){"state space", &s->origin,    &s->columns,
                       s->units,      s->damping,    true,
                       &s->errors,    &s->estimates, ritz_state_space_order(s)};
}

/* Names of files and commands may contain any byte. Control characters, and
   bytes that are no UTF-8, are written as '?'. */
static void put_clean(FILE *file, const char *before, const char *text)
{
    fputs(before, file);
    while (*text) {
        const int length = ritz_letter_length(text);

        if (length > 0)
            fwrite(text, 1, (size_t)length, file);
        else
            fputc('?', file);
        text += length > 0 ? length : 1;
    }
}

static void put_origin(FILE *file, const certified *c)
{
    const ritz_origin *origin = c->origin;

    fprintf(file, "%s by Ritz %s", c->what, ritz_version());
    if (*origin->method)
        put_clean(file, ": ", origin->method);
    if (*origin->options)
        put_clean(file, ", ", origin->options);
    if (*origin->reference)
        put_clean(file, ", reference ", origin->reference);
    fputc('\n', file);
}

static void put_band(FILE *file, const certified *c)
{
    double lowest = HUGE_VAL, highest = 0.0;

    fprintf(file, "order: %" PRId64, c->order);
    for (int64_t k = 0; k < c->columns->count; k++) {
        const double hertz = c->columns->hertz[k];

        if (hertz > 0.0) {
            lowest = fmin(lowest, hertz);
            highest = fmax(highest, hertz);
        }
    }
    if (highest > 0.0)
        fprintf(file, ", modes of the basis from %.6g to %.6g Hz", lowest,
                highest);
    fputc('\n', file);
}

static void put_measures(FILE *file, const char *by,
                         const ritz_measures *measures)
{
    for (int64_t k = 0; k < measures->count; k++) {
        const ritz_measure *m = &measures->item[k];

        put_clean(file, by, m->name);
        fprintf(file, " %.9g", m->value);
        if (!isnan(m->limit))
            fprintf(file, ", limit %.9g", m->limit);
        if (*m->where)
            put_clean(file, ", at ", m->where);
        fputc('\n', file);
    }
}

static void put_model(FILE *file, const certified *c)
{
    put_origin(file, c);
    put_band(file, c);
    put_clean(file, "units: ", *c->units ? c->units : "not known");
    put_clean(file, "\ndamping: ",
              *c->damping ? c->damping
              : c->damped ? "that of the matrices"
                          : "none");
    fputc('\n', file);
    put_measures(file, "error, measured: ", c->errors);
    put_measures(file, "error, estimated: ", c->estimates);
    if (c->errors->count + c->estimates->count == 0)
        fputs("errors: neither measured nor estimated\n", file);
}

typedef struct certificate_of {
    const ritz_export_object *object;
    const ritz_stamp *stamp; /* NULL: not known */
} certificate_of;

static ritz_status put_certificate(FILE *file, const void *what)
{
    const certificate_of *all = what;
    const ritz_export_object *object = all->object;
    const ritz_stamp *stamp = all->stamp;

    if (object->reduced || object->states) {
        const certified c = find_certified(object);

        put_model(file, &c);
    } else {
        fprintf(file, "by Ritz %s\n", ritz_version());
    }
    for (int64_t k = 0; stamp && k < stamp->num_inputs; k++) {
        put_clean(file, "input: ", stamp->input[k]);
        fputc('\n', file);
    }
    if (stamp && stamp->source) {
        put_clean(file, "made by: ", stamp->source);
        fputc('\n', file);
    }
    if (stamp && stamp->command) {
        put_clean(file, "command: ", stamp->command);
        fputc('\n', file);
    }
    return RITZ_OK;
}

ritz_status ritz_certificate(const ritz_export_object *object,
                             const ritz_stamp *stamp, char **out)
{
    const certificate_of all = {object, stamp};

    return ritz_sink_hold(put_certificate, &all, "the certificate", out, NULL);
}

/* Number of bytes, of the `length` that a line has left, that fit into one
   comment line. */
static int cut_line(const char *text, int length, int width)
{
    int whole = 0;

    if (width == 0 || length <= width)
        return length;
    for (int k = width; k > 0; k--)
        if (text[k - 1] == ' ')
            return k;
    for (int letter; whole < width; whole += letter) {
        letter = ritz_letter_size(text + whole);
        letter = letter > 0 ? letter : 1;
        if (whole + letter > width)
            break;
    }
    return whole;
}

void ritz_comment_put(FILE *file, const char *before, int width,
                      const char *text)
{
    while (*text) {
        int rest = (int)strcspn(text, "\n");

        do {
            const int length = cut_line(text, rest, width);

            fprintf(file, "%s%.*s\n", before, length, text);
            text += length;
            rest -= length;
        } while (rest > 0);
        text += *text == '\n';
    }
}

void ritz_comment_put_xml(FILE *file, const char *text)
{
    fputs("<!--\n", file);
    for (const char *at = text; *at; at++) {
        if (*at == '&' || *at == '<' || *at == '>')
            fputs(*at == '&' ? "&amp;" : *at == '<' ? "&lt;" : "&gt;", file);
        else
            fputc(*at, file);
        if (at[0] == '-' && (at[1] == '-' || at[1] == '\0'))
            fputc(' ', file);
    }
    fputs("-->\n", file);
}
