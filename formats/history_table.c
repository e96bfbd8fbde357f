/*
 * Reads tables of text with a line for each time. Files of sensors and
 * solutions of Exudyn begin with comments of '#' and have times in the first
 * column [Gerstmayr2023]. Files that write_csv of FMPy makes begin with a line
 * of names, one of which is "time". Any other table with commas or blanks
 * between its columns can be read too.
 *
 * A solution of Exudyn has the coordinates of all bodies, and a comment says how
 * many,
 *
 *     #number of written coordinates [nODE2, nVel2, nAcc2, ...] = [19,19,..]
 *
 * A flexible body has those of its frame before its modes: 7 with Euler
 * parameters, 6 with other rotations.
 */
#include "formats/history_lines.h"

#include "base/alloc.h"
#include "base/text.h"

#include <ritz/recover.h>

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { RATES = 3 }; /* q, q', q'' */

static const char letters[RATES + 1] = "qva";

/* The text before and after k in the names of coordinates and rates; an FMU
   names rates as derivatives of its states. */
static const char *const spellings[RATES][2][2] = {
    {{"q[", "]"}},
    {{"v[", "]"}, {"der(q[", "])"}},
    {{"a[", "]"}, {"der(v[", "])"}},
};

static const char solution_head[] = "#number of written coordinates";

typedef struct table {
    history_lines lines;
    char mark;    /* separator of columns */
    bool waiting; /* the first line has numbers, which are still to be used */
    int64_t count, room;    /* columns */
    char *head;             /* the first line, cut into names */
    const char **name;      /* of each column; "" if the file has no names */
    double *value;          /* count, of the present line */
    int64_t time;           /* the column of times */
    int64_t *column[RATES]; /* order each, columns of q, q', q''; NULL: none */
    int64_t *input;         /* columns of the inputs; NULL: none */
} table;

static void end(void *own)
{
    table *t = own;

    history_lines_free(&t->lines);
    RITZ_FREE(t->head, t->name, t->value, t->column[0], t->column[1],
              t->column[2], t->input);
    free(t);
}

/* A table is a text whose first line that is no comment has a separator. */
static bool recognise(const char *bytes, int64_t size)
{
    const char *end_of = bytes + size;

    for (const char *at = bytes; at < end_of;) {
        const char *newline = memchr(at, '\n', (size_t)(end_of - at));
        const char *stop = newline ? newline : end_of;

        while (at < stop && (*at == ' ' || *at == '\t' || *at == '\r'))
            at++;
        if (at < stop && *at != '#')
            return !memchr(at, '\0', (size_t)(stop - at)) &&
                   (memchr(at, ',', (size_t)(stop - at)) ||
                    memchr(at, ' ', (size_t)(stop - at)) ||
                    memchr(at, '\t', (size_t)(stop - at)));
        at = stop + 1;
    }
    return false;
}

/* ---- columns ------------------------------------------------------------ */

/* The column called "time", the first one if none is. */
static ritz_status find_time(table *t)
{
    int64_t found = -1;

    for (int64_t k = 0; k < t->count; k++) {
        if (strcasecmp(t->name[k], "time") != 0)
            continue;
        RITZ_REFUSE_IF(found >= 0, RITZ_ERR_FORMAT,
                       "the columns %" PRId64 " and %" PRId64
                       " are both called 'time'",
                       found + 1, k + 1);
        found = k;
    }
    t->time = found >= 0 ? found : 0;
    return RITZ_OK;
}

/* Index of the column with a name; -1 if there is none. */
static ritz_status find_name(const table *t, const char *name, int64_t *out)
{
    *out = -1;
    for (int64_t k = 0; k < t->count && *name; k++) {
        if (strcmp(t->name[k], name) != 0)
            continue;
        RITZ_REFUSE_IF(*out >= 0, RITZ_ERR_FORMAT,
                       "the columns %" PRId64 " and %" PRId64
                       " are both called '%.60s'",
                       *out + 1, k + 1, name);
        *out = k;
    }
    return RITZ_OK;
}

/* Read the first line, which has the names of columns or the first numbers. */
static ritz_status read_names(table *t)
{
    char *rest = NULL;
    double number = 0.0;
    bool more = false;

    RITZ_CHECK(history_lines_next(&t->lines, &more));
    RITZ_REFUSE_IF(!more, RITZ_ERR_FORMAT, "holds no times");
    RITZ_CHECK_COPY(t->head, t->lines.text, (int64_t)strlen(t->lines.text) + 1);
    t->mark = history_lines_mark(t->head);
    rest = t->head;
    for (const char *field; (field = history_lines_field(&rest, t->mark));
         t->count++) {
        RITZ_CHECK_ROOM(t->name, t->count, t->room);
        if (t->count == 0)
            t->waiting = ritz_text_real(field, &number);
        t->name[t->count] = t->waiting ? "" : field;
    }
    RITZ_CHECK(find_time(t));
    RITZ_CHECK_NEW(t->value, t->count);
    return RITZ_OK;
}

/* Store a column, and count it even if more than `due` are named. */
static void put_column(int64_t column, int64_t due, int64_t *count,
                       int64_t *out)
{
    if (*count < due)
        out[*count] = column;
    (*count)++;
}

/* Append the columns that "7", "2-9", "NAME" or "PREFIX*" stands for. */
static ritz_status take_item(const table *t, const char *item, int64_t due,
                             int64_t *count, int64_t *out)
{
    size_t length = strlen(item);
    bool star = length > 0 && item[length - 1] == '*';
    int64_t from = 0, to = 0, before = *count;

    if (ritz_text_range(item, length, &from, &to)) {
        to = to > 0 ? to : from;
        RITZ_REFUSE_IF(to > t->count, RITZ_ERR_ARGUMENT,
                       "there is no column %" PRId64 ", there are %" PRId64, to,
                       t->count);
        for (; from <= to; from++)
            put_column(from - 1, due, count, out);
        return RITZ_OK;
    }
    if (!star) {
        RITZ_CHECK(find_name(t, item, &from));
        if (from >= 0)
            put_column(from, due, count, out);
    }
    for (int64_t k = 0; star && k < t->count; k++)
        if (strncmp(t->name[k], item, length - 1) == 0) {
            RITZ_CHECK(find_name(t, t->name[k], &from));
            put_column(k, due, count, out);
        }
    RITZ_REFUSE_IF(*count == before, RITZ_ERR_ARGUMENT,
                   "there is no column '%s'", item);
    return RITZ_OK;
}

static ritz_status take_list(const table *t, const char *list, char option,
                             int64_t due, int64_t **out)
{
    RITZ_OWN_ARRAY int64_t *column = NULL;
    char item[2 * RITZ_NAME_SIZE];
    int64_t count = 0;

    RITZ_CHECK_NEW(column, due);
    for (const char *at = list; *at;) {
        size_t length = strcspn(at, ",");

        RITZ_REFUSE_IF(length == 0 || length >= sizeof item, RITZ_ERR_ARGUMENT,
                       "--%c '%.60s' is no list of columns", option, list);
        memcpy(item, at, length);
        item[length] = '\0';
        RITZ_CHECK(take_item(t, item, due, &count, column));
        at += length + (at[length] == ',');
    }
    RITZ_REFUSE_IF(count != due, RITZ_ERR_ARGUMENT,
                   "--%c names %" PRId64 " columns, %" PRId64 " are due",
                   option, count, due);
    RITZ_MOVE(*out, column);
    return RITZ_OK;
}

/* Find the columns "q[1]", "q[2]", ...; *out stays NULL if there is no
   "q[1]". */
static ritz_status take_spelled(const table *t, const char *const spelling[2],
                                int64_t due, int64_t **out)
{
    RITZ_OWN_ARRAY int64_t *column = NULL;
    char name[RITZ_NAME_SIZE];
    int64_t more = -1;

    RITZ_CHECK_NEW(column, due);
    for (int64_t j = 0; j < due; j++) {
        snprintf(name, sizeof name, "%s%" PRId64 "%s", spelling[0], j + 1,
                 spelling[1]);
        RITZ_CHECK(find_name(t, name, &column[j]));
        if (column[j] < 0 && j == 0)
            return RITZ_OK;
        RITZ_REFUSE_IF(column[j] < 0, RITZ_ERR_FORMAT,
                       "there is no column '%s', of %" PRId64 " coordinates",
                       name, due);
    }
    snprintf(name, sizeof name, "%s%" PRId64 "%s", spelling[0], due + 1,
             spelling[1]);
    RITZ_CHECK(find_name(t, name, &more));
    RITZ_REFUSE_IF(more >= 0, RITZ_ERR_FORMAT,
                   "there is a column '%s', and %" PRId64
                   " coordinates are due: is it of another model?",
                   name, due);
    RITZ_MOVE(*out, column);
    return RITZ_OK;
}

static ritz_status take_indexed(const table *t, int rate, int64_t due,
                                int64_t **out)
{
    for (int k = 0; k < 2 && spellings[rate][k][0] && !*out; k++)
        RITZ_CHECK(take_spelled(t, spellings[rate][k], due, out));
    return RITZ_OK;
}

/* The columns of a table without names are the times and then q, or q and q',
   or q, q' and q''. */
static ritz_status take_blocks(table *t, int64_t order)
{
    const int64_t blocks = order > 0 ? (t->count - 1) / order : 0;

    RITZ_REFUSE_IF(t->count - 1 != blocks * order || blocks < 1 ||
                       blocks > RATES,
                   RITZ_ERR_ARGUMENT,
                   "%" PRId64 " columns are not times and one to three for "
                   "each of %" PRId64 " coordinates: name them by --q",
                   t->count, order);
    for (int64_t k = 0; k < blocks; k++) {
        RITZ_CHECK_NEW(t->column[k], order);
        for (int64_t j = 0; j < order; j++)
            t->column[k][j] = 1 + k * order + j;
    }
    return RITZ_OK;
}

/* Counts of columns of each rate in the head of a solution. */
static ritz_status read_head(const table *t, int64_t written[RATES])
{
    const char *at = strstr(t->lines.kept, "= [");

    at = at ? at + 2 : "";
    for (int k = 0; k < RATES; k++) {
        char *end_of = NULL;

        errno = 0;
        written[k] = *at ? strtoll(at + 1, &end_of, 10) : -1;
        RITZ_REFUSE_IF(written[k] < 0 || errno != 0 || end_of == at + 1 ||
                           *end_of != ',',
                       RITZ_ERR_FORMAT, "no counts follow '%s'", solution_head);
        at = end_of;
    }
    return RITZ_OK;
}

/* The only body of a solution of Exudyn. */
static ritz_status take_solution(const ritz_history_request *request, table *t)
{
    const int64_t order = request->order;
    int64_t written[RATES] = {0};
    int64_t frame = 0;
    int64_t first = 1;

    RITZ_CHECK(read_head(t, written));
    frame = written[0] - order;
    RITZ_REFUSE_IF(frame != 0 &&
                       !(request->floating && (frame == 6 || frame == 7)),
                   RITZ_ERR_ARGUMENT,
                   "the solution has %" PRId64 " coordinates of all bodies, "
                   "%" PRId64 " are due: name their columns by --q",
                   written[0], order);
    for (int k = 0; k < RATES; k++) {
        if (written[k] != written[0])
            continue;
        RITZ_REFUSE_IF(written[k] > t->count - first, RITZ_ERR_FORMAT,
                       "has %" PRId64 " columns, its head says that there are "
                       "more",
                       t->count);
        RITZ_CHECK_NEW(t->column[k], order);
        for (int64_t j = 0; j < order; j++)
            t->column[k][j] = first + frame + j;
        first += written[k];
    }
    return RITZ_OK;
}

static ritz_status find_inputs(const ritz_history_request *request, table *t)
{
    RITZ_OWN_ARRAY int64_t *input = NULL;

    if (request->f)
        return take_list(t, request->f, 'f', request->num_inputs, &t->input);
    RITZ_CHECK_NEW(input, request->num_inputs);
    for (int64_t j = 0; j < request->num_inputs; j++) {
        RITZ_CHECK(find_name(t, request->input[j], &input[j]));
        if (input[j] < 0)
            return RITZ_OK;
    }
    RITZ_MOVE(t->input, input);
    return RITZ_OK;
}

static ritz_status find_columns(const ritz_history_request *request, table *t)
{
    const char *const list[RATES] = {request->q, request->v, request->a};
    bool listed = false;

    for (int k = 0; k < RATES; k++)
        listed = listed || list[k];
    for (int k = 0; k < RATES; k++)
        if (list[k])
            RITZ_CHECK(take_list(t, list[k], letters[k], request->order,
                                 &t->column[k]));
        else if (!t->waiting)
            RITZ_CHECK(take_indexed(t, k, request->order, &t->column[k]));
    if (!listed && t->waiting)
        RITZ_CHECK(t->lines.kept ? take_solution(request, t)
                                 : take_blocks(t, request->order));
    RITZ_REFUSE_IF(!t->column[0], RITZ_ERR_ARGUMENT,
                   "no column is called 'q[1]': name those of the coordinates "
                   "by --q");
    return find_inputs(request, t);
}

static ritz_status begin(FILE *file, const ritz_history_request *request,
                         ritz_history *history)
{
    table *t = ritz_zalloc(1, sizeof *t);

    if (!t) {
        fclose(file);
        return RITZ_ERR_MEMORY;
    }
    t->lines.file = file;
    t->lines.wanted = solution_head;
    history->own = t;
    RITZ_CHECK(read_names(t));
    RITZ_CHECK(find_columns(request, t));
    history->has_v = t->column[1];
    history->has_a = t->column[2];
    history->has_f = t->input;
    return RITZ_OK;
}

/* ---- lines -------------------------------------------------------------- */

static ritz_status read_values(table *t)
{
    char *rest = t->lines.text;
    int64_t count = 0;

    for (const char *field; (field = history_lines_field(&rest, t->mark));
         count++)
        if (count < t->count)
            RITZ_CHECK(history_lines_real(&t->lines, field, &t->value[count]));
    RITZ_REFUSE_IF(count != t->count, RITZ_ERR_FORMAT,
                   "line %" PRId64 " has %" PRId64 " columns, the first has "
                   "%" PRId64,
                   t->lines.number, count, t->count);
    return RITZ_OK;
}

static ritz_status next(ritz_history *history, bool *more)
{
    table *t = history->own;

    *more = true;
    if (!t->waiting)
        RITZ_CHECK(history_lines_next(&t->lines, more));
    t->waiting = false;
    if (!*more)
        return RITZ_OK;
    RITZ_CHECK(read_values(t));
    history->seconds = t->value[t->time];
    for (int k = 0; k < RATES; k++)
        for (int64_t j = 0; t->column[k] && j < history->order; j++)
            history->x[k * history->order + j] = t->value[t->column[k][j]];
    for (int64_t j = 0; t->input && j < history->num_inputs; j++)
        history->f[j] = t->value[t->input[j]];
    return RITZ_OK;
}

const ritz_history_format ritz_history_format_table = {
    .name = "table",
    .summary = "a table of text, as Exudyn and FMPy write",
    .reference = "Gerstmayr2023",
    .recognise = recognise,
    .begin = begin,
    .next = next,
    .end = end,
};
