/*
 * Frequencies of modes over configurations, from a table of --tracks. The axis
 * is the one setting that differs, or else the number of the configuration.
 */
#include "chart/chart.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TRACKS = 200, MOST_ROWS = 20000, MOST_SETTINGS = 16 };

/* A mode that is followed with a MAC below this is marked as doubtful. */
static const double doubt = 0.9;

typedef struct track_row {
    int64_t track, mode;
    int64_t at; /* which configuration, in order of appearance */
    double hertz, mac;
    const char *name; /* of the configuration */
} track_row;

typedef struct track_table {
    int64_t count, num_tracks, num_at;
    track_row *row;
    const char **at; /* each configuration, */
    double *x;       /* and its place */
    char xlabel[RITZ_NAME_SIZE];
    bool swept; /* x is a setting; else only the number of its configuration */
    int64_t num_squares; /* negative squares of forces, which are left out: the
                            largest number at any configuration */
} track_table;

static void track_table_free(track_table *t)
{
    RITZ_FREE(t->row, t->at, t->x);
}

/* --- reading -------------------------------------------------------------- */

/* Read the five columns of a line, in which tabs become ends of text. */
static bool take_row(char *line, track_row *out)
{
    char *field[5] = {line};

    for (int k = 1; k < 5; k++) {
        char *tab = strchr(field[k - 1], '\t');

        if (!tab)
            return false;
        *tab = '\0';
        field[k] = tab + 1;
    }
    field[4][strcspn(field[4], "\t\r")] = '\0';
    out->mac = nan("");
    out->name = field[1];
    return ritz_text_whole(field[0], &out->track) && out->track >= 0 &&
           ritz_text_whole(field[2], &out->mode) &&
           ritz_text_real(field[3], &out->hertz) &&
           (out->hertz < 0.0) == (out->track == 0) &&
           (strcmp(field[4], "nan") == 0 || strcmp(field[4], "-nan") == 0 ||
            ritz_text_real(field[4], &out->mac));
}

/* Index of the configuration of a row, which may be a new one. */
static int64_t find_configuration(const char *name, track_table *t)
{
    int64_t k = t->num_at - 1;

    while (k >= 0 && strcmp(t->at[k], name) != 0)
        k--;
    if (k < 0)
        t->at[k = t->num_at++] = name;
    return k;
}

/* Count a negative square, which has no track. */
static void count_square(const track_row *r, const char **at, int64_t *squares,
                         track_table *t)
{
    *squares = *at && strcmp(*at, r->name) == 0 ? *squares + 1 : 1;
    *at = r->name;
    if (*squares > t->num_squares)
        t->num_squares = *squares;
}

/* Read the rows up to a frequency, cutting up the text. */
static ritz_status read_rows(char *text, double up_to_hz, track_table *t)
{
    int64_t lines = 1, number = 1, squares = 0;
    const char *squared = NULL;

    for (const char *c = text; *c; c++)
        lines += *c == '\n';
    RITZ_REFUSE_IF(lines > MOST_ROWS, RITZ_ERR_FORMAT,
                   "more than %d lines cannot be told apart", (int)MOST_ROWS);
    RITZ_CHECK_NEW(t->row, lines + 1);
    RITZ_CHECK_NEW(t->at, lines); /* NOLINT: of pointers */
    RITZ_CHECK_NEW(t->x, lines);
    /* behind the names of columns */
    for (char *line = strchr(text, '\n'), *end = NULL; line && *++line;
         line = end) {
        track_row *r = &t->row[t->count];

        end = strchr(line, '\n');
        if (end)
            *end = '\0';
        number++;
        RITZ_REFUSE_IF(line[strspn(line, "\r")] && !take_row(line, r),
                       RITZ_ERR_FORMAT, "line %ld is no row of tracks", number);
        if (!r->name || fabs(r->hertz) > up_to_hz)
            continue;
        if (r->track == 0) {
            count_square(r, &squared, &squares, t);
            *r = (track_row){0};
            continue;
        }
        r->at = find_configuration(r->name, t);
        t->num_tracks = r->track > t->num_tracks ? r->track : t->num_tracks;
        t->count++;
    }
    RITZ_REFUSE_IF(t->count == 0, RITZ_ERR_FORMAT, "no mode is in it");
    RITZ_REFUSE_IF(t->num_tracks > MOST_TRACKS, RITZ_ERR_FORMAT,
                   "%ld tracks, more than %d cannot be told apart",
                   t->num_tracks, (int)MOST_TRACKS);
    return RITZ_OK;
}

/* Value of "name=VALUE" at place k of "a=1,b=2"; false: there is none. */
static bool take_setting(const char *at, int k, char name[RITZ_NAME_SIZE],
                         double *out)
{
    char value[RITZ_NAME_SIZE];
    size_t length = 0;

    for (; k > 0 && *at; k--) {
        at += strcspn(at, ",");
        at += *at == ',';
    }
    length = strcspn(at, "=");
    if (at[length] != '=' || length >= RITZ_NAME_SIZE)
        return false;
    snprintf(name, RITZ_NAME_SIZE, "%.*s", (int)length, at);
    at += length + 1;
    length = strcspn(at, ",");
    snprintf(value, sizeof value, "%.*s", (int)length, at);
    return length < RITZ_NAME_SIZE && ritz_text_real(value, out);
}

/* Take the k-th setting as x; false: one has none, or all have the same. */
static bool take_sweep(track_table *t, int k, char name[RITZ_NAME_SIZE])
{
    bool differs = false;

    for (int64_t i = 0; i < t->num_at; i++) {
        if (!take_setting(t->at[i], k, name, &t->x[i]))
            return false;
        differs = differs || t->x[i] != t->x[0];
    }
    return differs;
}

static void place_configurations(track_table *t)
{
    char other[RITZ_NAME_SIZE];
    int found = -1, many = 0;

    for (int k = 0; k < MOST_SETTINGS; k++)
        if (take_sweep(t, k, other)) {
            found = k;
            many++;
        }
    t->swept = many == 1 && take_sweep(t, found, t->xlabel);
    if (t->swept)
        return;
    snprintf(t->xlabel, RITZ_NAME_SIZE, "configuration");
    for (int64_t i = 0; i < t->num_at; i++)
        t->x[i] = (double)i + 1.0;
}

static int by_track(const void *a, const void *b)
{
    const track_row *x = a, *y = b;

    if (x->track != y->track)
        return x->track < y->track ? -1 : 1;
    return (x->at > y->at) - (x->at < y->at);
}

/* --- the picture ---------------------------------------------------------- */

static void put_data(const track_table *t, picture *p)
{
    FILE *data = p->data.file, *rows = p->table.file;
    bool doubtful = false;

    fprintf(data, "track\tx\thertz\tmac\ttip\tmode\tconfiguration\n");
    fprintf(rows, "track\tconfiguration\tmode\tHz\tMAC\n");
    for (int64_t k = 0; k < t->count; k++) {
        const track_row *r = &t->row[k];
        const int64_t track = r->track, mode = r->mode;

        if (k > 0 && t->row[k - 1].track != track)
            fprintf(data, "\n");
        fprintf(data, "%ld\t%.9g\t%.9g\t%.6g\t", track, t->x[r->at], r->hertz,
                r->mac);
        picture_tip(p, "track %ld, mode %ld at %.100s\n%.6g Hz\nMAC %.3f%s",
                    track, mode, r->name, r->hertz, r->mac,
                    r->mac < doubt ? ": hardly the same mode" : "");
        fprintf(data, "\t%ld\t", mode);
        html_line(data, r->name);
        fprintf(data, "\n");
        fprintf(rows, "%ld\t", track);
        html_line(rows, r->name);
        fprintf(rows, "\t%ld\t%.6g\t%.4g\n", mode, r->hertz, r->mac);
        doubtful = doubtful || r->mac < doubt;
    }
    if (doubtful)
        picture_add_sign(p, (picture_sign){.colour = "alarm", .mark = 6},
                         "MAC below 0.9 to where the mode comes from");
}

ritz_status chart_tracks(const chart_sources *sources,
                         const chart_request *request, picture *p)
{
    const chart_file *file = sources->file;
    RITZ_OWN(track_table) t = {0};
    double most = 0.0, least = HUGE_VAL, last = -HUGE_VAL;

    RITZ_REFUSE_IF(sources->count > 1, RITZ_ERR_ARGUMENT,
                   "'%s' and '%s': a chart has one table of tracks", file->path,
                   file[1].path);
    RITZ_CHECK_IN(file->path, read_rows(file->text, request->up_to_hz, &t));
    place_configurations(&t);
    qsort(t.row, (size_t)t.count, sizeof *t.row, by_track);
    for (int64_t k = 0; k < t.count; k++)
        most = fmax(most, t.row[k].hertz);
    for (int64_t k = 0; k < t.num_at; k++) {
        least = fmin(least, t.x[k]);
        last = fmax(last, t.x[k]);
    }
    put_data(&t, p);
    p->wide = 720.0;
    p->body = 460.0;
    chart_leave_squares(sources, file->path, t.num_squares, p);
    fprintf(p->given.file,
            "tracks = %ld\nx_low = %.9g\nx_high = %.9g\ny_high = %.9g\n"
            "swept = %d\ndoubt = %g\n",
            t.num_tracks, least, last, most > 0.0 ? 1.04 * most : 1.0, t.swept,
            doubt);
    picture_give_text(p, "xlabel", t.xlabel);
    return picture_draw(p, "tracks.gp", "Modes over configurations",
                        "frequency of each mode, followed by its shape");
}
