/*
 * Modes as a universal file, which programs of modal testing read
 * [AllemangBrown1987]. Its data sets are, in this order,
 *
 *     164  units, if those of the model are among the ones below
 *      15  nodes: label, two frames, color, position
 *      82  trace lines: labels of nodes, 0 lifts the pen
 *      55  data at nodes, one for each mode
 *
 * Each begins and ends with a record of -1, six letters wide, and its number is
 * in its second record. Whole numbers have ten letters, reals thirteen and
 * six digits. Frames are the basic one, 0.
 */
#include "base/alloc.h"
#include "formats/certificate.h"
#include "formats/sink.h"
#include "model/cell_edges.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    COLOR = 8,
    NODES_PER_LINE = 125, /* programs are known that take no more */
    TEXT_WIDTH = 80,
};

/* ---- edges of elements -------------------------------------------------- */

/* A straight line between two nodes, from < to. */
typedef struct trace_edge {
    int64_t from, to; /* labels */
} trace_edge;

static int compare_edges(const void *left, const void *right)
{
    const trace_edge *a = left;
    const trace_edge *b = right;

    if (a->from != b->from)
        return a->from < b->from ? -1 : 1;
    return (a->to > b->to) - (a->to < b->to);
}

static void put_edge(int64_t a, int64_t b, trace_edge *edge, int64_t *count)
{
    if (a != b)
        edge[(*count)++] = (trace_edge){a < b ? a : b, a < b ? b : a};
}

/* Append the edges of cell k; of an edge with a node between its ends both
   halves. */
static void put_cell(const ritz_shapes *s, int64_t k, trace_edge *edge,
                     int64_t *count)
{
    const ritz_cell_shape *shape = ritz_cell_shape_of(s->cells.kind[k]);
    const ritz_cell_edges *edges = ritz_cell_edges_of(s->cells.kind[k]);
    const int64_t *point = s->cells.grid + s->cells.first[k];

    for (int i = 0; i < edges->count; i++) {
        int64_t a = s->id[point[edges->end[i][0]]];
        int64_t b = s->id[point[edges->end[i][1]]];

        if (shape->size > shape->corners) {
            int64_t between = s->id[point[shape->corners + i]];

            put_edge(a, between, edge, count);
            put_edge(between, b, edge, count);
        } else {
            put_edge(a, b, edge, count);
        }
    }
}

/* All edges, each once, ascending. */
static ritz_status list_edges(const ritz_shapes *s, trace_edge **out,
                              int64_t *count)
{
    int64_t most = 0, kept = 0;
    trace_edge *edge = NULL;

    for (int64_t k = 0; k < s->cells.count; k++)
        most += ritz_cell_edges_of(s->cells.kind[k])->count;
    RITZ_CHECK_NEW(*out, 2 * most);
    edge = *out;
    for (int64_t k = 0; k < s->cells.count; k++)
        put_cell(s, k, edge, count);
    qsort(edge, (size_t)*count, sizeof *edge, compare_edges);
    for (int64_t k = 0; k < *count; k++)
        if (kept == 0 || compare_edges(&edge[kept - 1], &edge[k]) != 0)
            edge[kept++] = edge[k];
    *count = kept;
    return RITZ_OK;
}

/* ---- units -------------------------------------------------------------- */

/* A length of one SI unit is `length` units of the file. */
typedef struct uff_units {
    const char *labels; /* as ritz-import --units has them */
    int code;
    const char *description;
    double length, force;
} uff_units;

static const uff_units known_units[] = {
    {"kg m s", 1, "SI: Meter (newton)", 1.0, 1.0},
    {"kg mm s", 5, "mm (milli newton)", 1e3, 1e3},
    {"tonne mm s", 10, "mm (newton)", 1e3, 1.0},
    {"t mm s", 10, "mm (newton)", 1e3, 1.0},
};

static const uff_units *find_units(const char *labels)
{
    for (size_t k = 0; k < sizeof known_units / sizeof *known_units; k++)
        if (strcmp(known_units[k].labels, labels) == 0)
            return &known_units[k];
    return NULL;
}

/* ---- the file ----------------------------------------------------------- */

typedef struct uff_parts {
    const ritz_shapes *shapes;
    const char *certificate;
    const trace_edge *edge;
    int64_t num_edges;
} uff_parts;

static void begin_set(FILE *file, int number)
{
    fprintf(file, "%6d\n%6d\n", -1, number);
}

static void end_set(FILE *file)
{
    fprintf(file, "%6d\n", -1);
}

/* A text of the width of a line, which may not be blank. */
static void put_line(FILE *file, const char *text)
{
    if (!*text || *text == '\n')
        text = "NONE";
    for (int k = 0; k < TEXT_WIDTH && text[k] && text[k] != '\n'; k++)
        fputc(text[k] < ' ' || text[k] > '~' ? '?' : text[k], file);
    fputc('\n', file);
}

/* What is too small for the field is written as 0. */
static double drop_tiny(double value)
{
    /* E13.5 has room for exponents of two digits [AllemangBrown1987] */
    return fabs(value) < 1e-99 ? 0.0 : value;
}

static void put_reals(FILE *file, int count, const double *value)
{
    for (int k = 0; k < count; k++)
        fprintf(file, "%13.5E", drop_tiny(value[k]));
}

/* A double of the old spelling, 1.0D+00. */
static void put_double(FILE *file, double value)
{
    char text[40];

    snprintf(text, sizeof text, "%25.17E", value);
    for (const char *at = text; *at; at++)
        fputc(*at == 'E' ? 'D' : *at, file);
}

static void print_units(FILE *file, const uff_units *units)
{
    enum { RELATIVE = 2 };

    begin_set(file, 164);
    fprintf(file, "%10d%-20s%10d\n", units->code, units->description, RELATIVE);
    put_double(file, units->length);
    put_double(file, units->force);
    put_double(file, 1.0);
    fputc('\n', file);
    put_double(file, 273.15); /* kelvin at 0 degrees Celsius */
    fputc('\n', file);
    end_set(file);
}

static void print_nodes(FILE *file, const ritz_shapes *s)
{
    begin_set(file, 15);
    for (int64_t k = 0; k < s->num_points; k++) {
        fprintf(file, "%10" PRId64 "%10d%10d%10d", s->id[k], 0, 0, COLOR);
        put_reals(file, 3, s->position + 3 * k);
        fputc('\n', file);
    }
    end_set(file);
}

static void print_line(FILE *file, int64_t number, int count,
                       const int64_t *node)
{
    begin_set(file, 82);
    fprintf(file, "%10" PRId64 "%10d%10d\nedges\n", number, count, COLOR);
    for (int k = 0; k < count; k++)
        fprintf(file, "%10" PRId64 "%s", node[k],
                k % 8 == 7 || k + 1 == count ? "\n" : "");
    end_set(file);
}

/* An edge that begins where the last one ended continues the line. */
static void print_lines(FILE *file, const uff_parts *parts)
{
    int64_t node[NODES_PER_LINE], number = 0;
    int used = 0;

    for (int64_t k = 0; k < parts->num_edges; k++) {
        const trace_edge *edge = &parts->edge[k];

        if (used + 3 > NODES_PER_LINE) {
            print_line(file, ++number, used, node);
            used = 0;
        }
        if (used > 0 && node[used - 1] != edge->from)
            node[used++] = 0;
        if (used == 0 || node[used - 1] != edge->from)
            node[used++] = edge->from;
        node[used++] = edge->to;
    }
    if (used > 0)
        print_line(file, ++number, used, node);
}

/* The rest of a text from the first line that begins with `begin`; "" if there
   is none. */
static const char *line_of(const char *text, const char *begin)
{
    while (*text && strncmp(text, begin, strlen(begin)) != 0) {
        text += strcspn(text, "\n");
        text += *text == '\n';
    }
    return text;
}

/* A data set has five lines of text: the name of the mode and four lines of the
   certificate, its first, the first error, the damping and the first input. */
static void print_texts(FILE *file, const uff_parts *parts, int64_t j)
{
    const char *at = parts->certificate;

    put_line(file, parts->shapes->name[j]);
    put_line(file, line_of(at, ""));
    put_line(file, line_of(at, "error"));
    put_line(file, line_of(at, "damping: "));
    put_line(file, line_of(at, "input: "));
}

static void print_mode(FILE *file, const uff_parts *parts, int64_t j)
{
    enum {
        STRUCTURAL = 1,
        NORMAL_MODE = 2,
        TRANSLATIONS = 2,
        ROTATIONS_TOO = 3,
        DISPLACEMENT = 8,
        REAL = 2,
        LOAD_CASE = 1
    };
    const ritz_shapes *s = parts->shapes;
    const ritz_shape_mode *mode = &s->mode[j];
    bool turns = s->turn.val != NULL;

    begin_set(file, 55);
    print_texts(file, parts, j);
    fprintf(file, "%10d%10d%10d%10d%10d%10d\n", STRUCTURAL, NORMAL_MODE,
            turns ? ROTATIONS_TOO : TRANSLATIONS, DISPLACEMENT, REAL,
            turns ? 6 : 3);
    fprintf(file, "%10d%10d%10d%10" PRId64 "\n", 2, 4, LOAD_CASE, mode->number);
    put_reals(file, 4, (const double[]){mode->hertz, 1.0, mode->ratio, 0.0});
    fputc('\n', file);
    for (int64_t k = 0; k < s->num_points; k++) {
        fprintf(file, "%10" PRId64 "\n", s->id[k]);
        put_reals(file, 3, ritz_dense_col(&s->u, j) + 3 * k);
        if (turns)
            put_reals(file, 3, ritz_dense_col(&s->turn, j) + 3 * k);
        fputc('\n', file);
    }
    end_set(file);
}

static ritz_status print_sets(FILE *file, const void *what)
{
    const uff_parts *parts = what;
    const uff_units *units = find_units(parts->shapes->units);

    if (units)
        print_units(file, units);
    print_nodes(file, parts->shapes);
    print_lines(file, parts);
    for (int64_t j = 0; j < parts->shapes->count; j++)
        print_mode(file, parts, j);
    return RITZ_OK;
}

/* ---- what it takes ------------------------------------------------------ */

/* E13.5 has room for exponents of two digits [AllemangBrown1987] */
static bool fits(double value)
{
    return fabs(value) < 9.99999e99;
}

static ritz_status check_reals(const ritz_shapes *s, const double *value,
                               const char *what)
{
    for (int64_t i = 0; i < 3 * s->num_points; i++)
        RITZ_REFUSE_IF(!fits(value[i]), RITZ_ERR_ARGUMENT,
                       "%s of grid %" PRId64 " is %g: the file has room for "
                       "exponents of two digits",
                       what, s->id[i / 3], value[i]);
    return RITZ_OK;
}

static ritz_status check_shapes(const ritz_shapes *s)
{
    RITZ_REFUSE_IF(!s->mode, RITZ_ERR_ARGUMENT,
                   "columns of a basis are no modes: export the modes of the "
                   "component, or of a reduced component");
    for (int64_t k = 0; k < s->num_points; k++)
        RITZ_REFUSE_IF(s->id[k] < 1 || s->id[k] > INT32_MAX, RITZ_ERR_ARGUMENT,
                       "grid %" PRId64 " has no label in a universal file, "
                       "where they go from 1 to %" PRId32,
                       s->id[k], INT32_MAX);
    RITZ_CHECK(check_reals(s, s->position, "a coordinate"));
    for (int64_t j = 0; j < s->count; j++) {
        RITZ_REFUSE_IF(s->mode[j].hertz < 0.0, RITZ_ERR_ARGUMENT,
                       "'%s' does not oscillate: leave it out by --modes",
                       s->name[j]);
        RITZ_REFUSE_IF(!fits(s->mode[j].hertz) || !fits(s->mode[j].ratio),
                       RITZ_ERR_ARGUMENT,
                       "'%s' is at %g Hz with a damping ratio of %g: the file "
                       "has room for exponents of two digits",
                       s->name[j], s->mode[j].hertz, s->mode[j].ratio);
        RITZ_CHECK(check_reals(s, ritz_dense_col(&s->u, j), "a motion"));
        if (s->turn.val)
            RITZ_CHECK(
                check_reals(s, ritz_dense_col(&s->turn, j), "a rotation"));
    }
    return RITZ_OK;
}

static ritz_status say_losses(const ritz_shapes *s, ritz_export_report *report)
{
    if (s->coupled)
        RITZ_CHECK(ritz_export_say(
            report, "damping ratios are phi'D phi / (2 w): the file has no "
                    "room for modes that damping couples"));
    if (s->structural)
        RITZ_CHECK(ritz_export_say(report, "structural damping left out"));
    if (!find_units(s->units))
        RITZ_CHECK(ritz_export_say(
            report, "without data set 164: units are %s%s%s",
            *s->units ? "'" : "not known", s->units, *s->units ? "'" : ""));
    if (!s->meshed)
        RITZ_CHECK(ritz_export_say(report, "no elements are known: no trace "
                                           "lines (import with --bulk)"));
    if (s->num_placeless > 0)
        RITZ_CHECK(ritz_export_say(
            report, "%lld points have no position and are left out",
            (long long)s->num_placeless));
    return RITZ_OK;
}

static ritz_status write_shapes(const ritz_export_object *object,
                                const ritz_export_request *request,
                                ritz_export_report *report)
{
    const ritz_shapes *s = object->shapes;
    RITZ_OWN_ARRAY trace_edge *edge = NULL;
    RITZ_OWN_ARRAY char *certificate = NULL;
    uff_parts parts = {.shapes = s};

    RITZ_CHECK(check_shapes(s));
    RITZ_CHECK(ritz_certificate(object, request->stamp, &certificate));
    parts.certificate = certificate;
    RITZ_CHECK(list_edges(s, &edge, &parts.num_edges));
    parts.edge = edge;
    RITZ_CHECK(ritz_sink_write(request->output, print_sets, &parts));
    RITZ_CHECK(ritz_export_say(
        report, "%lld modes at %lld nodes, %s, modal mass 1; %lld edges",
        (long long)s->count, (long long)s->num_points,
        s->turn.val ? "translations and rotations" : "translations",
        (long long)parts.num_edges));
    RITZ_CHECK(ritz_export_say(report, "six digits of each number are kept: "
                                       "for pictures and comparison, not for "
                                       "computation"));
    RITZ_CHECK(ritz_export_say(report, "there is room for four lines of the "
                                       "certificate with each mode"));
    return say_losses(s, report);
}

const ritz_exporter ritz_exporter_uff = {
    .name = "uff",
    .summary = "modes for modal testing programs (universal file)",
    .reference = "AllemangBrown1987",
    .kind = "shapes",
    .takes = RITZ_EXPORT_SHAPES,
    .write = write_shapes,
};
