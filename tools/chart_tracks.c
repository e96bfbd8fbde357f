/* Frequencies of modes over configurations, from a table of --tracks. */
#include "chart.h"

#include "html.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A mode is known again by less than this only with doubt. */
#define DOUBT 0.9

enum { MOST_TRACKS = 200, MOST_ROWS = 20000 };

typedef struct row {
    int64_t track, mode;
    int64_t at; /* which configuration, in order of appearance */
    double hertz, mac;
    const char *name; /* of the configuration */
} row;

typedef struct table {
    int64_t count, num_tracks, num_at;
    row *row;
    const char **at;   /* borrowed from the text */
    double *x;         /* of each configuration */
    const char *sweep; /* what x is; NULL: only its number */
    char *text;
} table;

static void free_table(table *t)
{
    free(t->row);
    free(t->at);
    free(t->x);
    free(t->text);
}

/* Five columns of a line, which is cut up for that. */
static bool split(char *line, char *field[5])
{
    for (int k = 0; k < 5; k++) {
        char *tab = strchr(line, '\t');

        field[k] = line;
        if (k < 4 && !tab)
            return false;
        if (tab)
            *tab = '\0';
        line = tab ? tab + 1 : line;
    }
    return true;
}

static bool take_row(char *line, row *out)
{
    char *field[5];
    double mac = nan("");

    if (!split(line, field) || !ritz_text_whole(field[0], &out->track) ||
        !ritz_text_whole(field[2], &out->mode) ||
        !ritz_text_real(field[3], &out->hertz) || out->track < 1 ||
        out->hertz < 0.0)
        return false;
    if (strcmp(field[4], "nan") != 0 && strcmp(field[4], "-nan") != 0 &&
        !ritz_text_real(field[4], &mac))
        return false;
    out->mac = mac;
    out->name = field[1];
    return true;
}

/* Number of a configuration, which is met again in one run of rows. */
static int64_t number_of(table *t, const char *name)
{
    for (int64_t k = t->num_at - 1; k >= 0; k--)
        if (strcmp(t->at[k], name) == 0)
            return k;
    t->at[t->num_at] = name;
    return t->num_at++;
}

/* Room for as many rows as a text has lines, and a copy of it to cut up. */
static ritz_status make_room(const char *text, table *t)
{
    ritz_status status = RITZ_OK;
    int64_t lines = 1;

    for (const char *c = text; *c; c++)
        lines += *c == '\n';
    RITZ_FAIL_IF(lines > MOST_ROWS, RITZ_ERR_FORMAT,
                 "more than %d lines cannot be told apart", (int)MOST_ROWS);
    t->text = strdup(text);
    t->row = calloc((size_t)lines, sizeof *t->row);
    t->at = calloc((size_t)lines, sizeof *t->at);
    t->x = calloc((size_t)lines, sizeof *t->x);
    RITZ_FAIL_IF(!t->text || !t->row || !t->at || !t->x, RITZ_ERR_MEMORY,
                 "no memory for tracks");
done:
    return status;
}

/* A row, unless its frequency is above. */
static ritz_status put_row(char *line, int64_t number, double up_to_hz,
                           table *t)
{
    ritz_status status = RITZ_OK;
    row *r = &t->row[t->count];

    RITZ_FAIL_IF(!take_row(line, r), RITZ_ERR_FORMAT,
                 "line %lld is no row of tracks", (long long)number);
    if (!(r->hertz <= up_to_hz))
        return RITZ_OK;
    r->at = number_of(t, r->name);
    t->num_tracks = r->track > t->num_tracks ? r->track : t->num_tracks;
    t->count++;
done:
    return status;
}

static ritz_status read_rows(const char *text, double up_to_hz, table *t)
{
    ritz_status status = RITZ_OK;
    int64_t number = 1;
    char *line = NULL;

    RITZ_TRY(make_room(text, t));
    line = strchr(t->text, '\n'); /* behind the names of columns */
    while (line && *++line) {
        char *end = line + strcspn(line, "\n");
        bool more = *end != '\0';

        *end = '\0';
        line[strcspn(line, "\r")] = '\0';
        number++;
        if (*line)
            RITZ_TRY(put_row(line, number, up_to_hz, t));
        line = more ? end : NULL;
    }
    RITZ_FAIL_IF(t->count == 0, RITZ_ERR_FORMAT, "no mode is in it");
    RITZ_FAIL_IF(t->num_tracks > MOST_TRACKS, RITZ_ERR_FORMAT,
                 "%lld tracks, more than %d cannot be told apart",
                 (long long)t->num_tracks, (int)MOST_TRACKS);
done:
    return status;
}

/* Value of "name=VALUE" at place k of "a=1,b=2"; false: there is none. */
static bool setting_of(const char *at, int k, char name[RITZ_NAME_SIZE],
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
    if (length >= RITZ_NAME_SIZE)
        return false;
    snprintf(value, sizeof value, "%.*s", (int)length, at);
    return ritz_text_real(value, out);
}

/* Whether the k-th setting alone differs; then it is x. */
static bool try_setting(table *t, int k, char name[RITZ_NAME_SIZE])
{
    double first = 0.0;
    bool differs = false;

    for (int64_t i = 0; i < t->num_at; i++) {
        if (!setting_of(t->at[i], k, name, &t->x[i]))
            return false;
        first = i == 0 ? t->x[i] : first;
        differs = differs || t->x[i] != first;
    }
    return differs;
}

/* The one setting that differs, or else the configuration's number. */
static void find_x(table *t, char name[RITZ_NAME_SIZE])
{
    char other[RITZ_NAME_SIZE];
    int found = -1;
    int many = 0;

    for (int k = 0; k < 16; k++)
        if (try_setting(t, k, other)) {
            found = k;
            many++;
        }
    if (many == 1 && try_setting(t, found, name)) {
        t->sweep = name;
        return;
    }
    for (int64_t i = 0; i < t->num_at; i++)
        t->x[i] = (double)i + 1.0;
    snprintf(name, RITZ_NAME_SIZE, "configuration");
}

static int by_track(const void *a, const void *b)
{
    const row *x = a, *y = b;

    if (x->track != y->track)
        return x->track < y->track ? -1 : 1;
    return (x->at > y->at) - (x->at < y->at);
}

static void put_data(const table *t, gnuplot *out)
{
    FILE *data = out->data.file, *rows = out->table.file;

    fprintf(data, "track\tx\thertz\tmac\ttip\tmode\tconfiguration\n");
    fprintf(rows, "track\tconfiguration\tmode\tHz\tMAC\n");
    for (int64_t k = 0; k < t->count; k++) {
        const row *r = &t->row[k];
        int64_t tip = gnuplot_tip(
            out, "track %lld, mode %lld at %.100s\n%.6g Hz\nMAC %.3f%s",
            (long long)r->track, (long long)r->mode, r->name, r->hertz, r->mac,
            r->mac < DOUBT ? ": hardly the same mode" : "");

        if (k > 0 && t->row[k - 1].track != r->track)
            fprintf(data, "\n");
        fprintf(data, "%lld\t%.9g\t%.9g\t%.6g\t%lld\t%lld\t",
                (long long)r->track, t->x[r->at], r->hertz, r->mac,
                (long long)tip, (long long)r->mode);
        html_line(data, r->name);
        fprintf(rows, "%lld\t", (long long)r->track);
        html_line(rows, r->name);
        fprintf(rows, "\t%lld\t%.6g\t%.4g\n", (long long)r->mode, r->hertz,
                r->mac);
        fprintf(data, "\n");
    }
}

static void put_plot(const table *t, gnuplot *out, bool doubts)
{
    FILE *file = out->plot.file;

    fprintf(file, "plot NaN notitle");
    for (int64_t k = 0; k < t->num_tracks; k++)
        fprintf(file,
                ", \\\n  data skip 1 using ($1 == %lld ? $2 : NaN):3 with "
                "lines lw 1.6 lc rgb '%s' notitle"
                ", \\\n  data skip 1 using ($1 == %lld ? $2 : NaN):3:5 with "
                "labels hypertext point pt %d ps 0.55 lc rgb '%s' notitle",
                (long long)k + 1, chart_colour(k), (long long)k + 1,
                chart_mark(k, false), chart_colour(k));
    if (doubts)
        fprintf(file,
                ", \\\n  data skip 1 using ($4 < %g ? $2 : NaN):3 with points "
                "pt 6 ps 1.2 lw 1.4 lc rgb '" SVG_ALARM "' notitle",
                DOUBT);
    fprintf(file, "\n");
}

static bool has_doubts(const table *t)
{
    for (int64_t k = 0; k < t->count; k++)
        if (t->row[k].mac < DOUBT)
            return true;
    return false;
}

static void set_areas(const table *t, chart_area *area)
{
    double most = 0.0, least = t->x[0], last = t->x[0];

    for (int64_t k = 0; k < t->count; k++)
        most = fmax(most, t->row[k].hertz);
    for (int64_t k = 0; k < t->num_at; k++) {
        least = fmin(least, t->x[k]);
        last = fmax(last, t->x[k]);
    }
    area->x = (axis){.low = least, .high = last};
    if (!(last > least)) {
        area->x.low -= 0.5;
        area->x.high += 0.5;
    }
    area->y = (axis){.high = most > 0.0 ? 1.04 * most : 1.0};
}

static ritz_status draw(const table *t, const char *xlabel, gnuplot *out)
{
    ritz_status status = RITZ_OK;
    chart_area area = {.left = 62, .bottom = 84, .right = 702, .top = 446};
    bool doubts = has_doubts(t);
    const chart_sign signs[] = {
        {.name = "MAC below 0.9 to where the mode comes from",
         .colour = SVG_ALARM,
         .mark = 6},
    };

    gnuplot_size(out, 720, 490);
    set_areas(t, &area);
    chart_area_begin(out, &area, "Modes over configurations", xlabel, "Hz");
    if (!t->sweep)
        fprintf(out->plot.file, "set xtics 1 nomirror\n");
    if (t->num_at == 1)
        fprintf(out->plot.file, "unset xtics\n");
    if (doubts)
        chart_legend(out, 1, signs, area.left, 26, area.right, true);
    put_data(t, out);
    put_plot(t, out, doubts);
    RITZ_TRY(gnuplot_draw(out, "Modes over configurations",
                          "frequency of each mode, followed by its shape"));
done:
    return status;
}

ritz_status chart_tracks(const chart_sources *sources, const chart_wish *wish,
                         gnuplot *out)
{
    ritz_status status = RITZ_OK;
    table t = {0};
    const chart_file *file = NULL;
    char name[RITZ_NAME_SIZE] = "";

    for (int64_t k = 0; k < sources->count; k++) {
        if (sources->file[k].holds != CHART_TRACKS)
            continue;
        RITZ_FAIL_IF(file, RITZ_ERR_ARGUMENT,
                     "'%s' and '%s': a chart has one table of tracks",
                     file->path, sources->file[k].path);
        file = &sources->file[k];
    }
    RITZ_FAIL_IF(!file, RITZ_ERR_ARGUMENT, "there is no table of tracks");
    RITZ_TRY_IN(file->path, read_rows(file->text, wish->up_to_hz, &t));
    find_x(&t, name);
    qsort(t.row, (size_t)t.count, sizeof *t.row, by_track);
    RITZ_TRY(gnuplot_new(wish->path, wish->keep, out));
    RITZ_TRY(draw(&t, name, out));
done:
    free_table(&t);
    return status;
}
