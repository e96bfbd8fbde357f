/*
 * Frequencies of modes over configurations, from a table of --tracks. What x
 * is: the one setting that differs, or else the number of the configuration.
 */
#include "chart/chart.h"
#include "chart/html.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    const char **at; /* borrowed from the text */
    double *x;       /* of each configuration */
    char xlabel[RITZ_NAME_SIZE];
    bool swept; /* x is a setting; else only the number of its configuration */
    char *text;
} track_table;

/* --- reading -------------------------------------------------------------- */

enum { MOST_TRACKS = 200, MOST_ROWS = 20000 };

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

static bool take_row(char *line, track_row *out)
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
static int64_t number_of(track_table *t, const char *name)
{
    for (int64_t k = t->num_at - 1; k >= 0; k--)
        if (strcmp(t->at[k], name) == 0)
            return k;
    t->at[t->num_at] = name;
    return t->num_at++;
}

/* Room for as many rows as a text has lines, and a copy of it to cut up. */
static ritz_status make_room(const char *text, track_table *t)
{
    int64_t lines = 1;

    for (const char *c = text; *c; c++)
        lines += *c == '\n';
    RITZ_REFUSE_IF(lines > MOST_ROWS, RITZ_ERR_FORMAT,
                   "more than %d lines cannot be told apart", (int)MOST_ROWS);
    t->text = strdup(text);
    t->row = calloc((size_t)lines, sizeof *t->row);
    t->at = calloc((size_t)lines, sizeof *t->at);
    t->x = calloc((size_t)lines, sizeof *t->x);
    RITZ_REFUSE_IF(!t->text || !t->row || !t->at || !t->x, RITZ_ERR_MEMORY,
                   "no memory for tracks");
    return RITZ_OK;
}

/* A row, unless its frequency is above. */
static ritz_status put_row(char *line, int64_t number, double up_to_hz,
                           track_table *t)
{
    track_row *r = &t->row[t->count];

    RITZ_REFUSE_IF(!take_row(line, r), RITZ_ERR_FORMAT,
                   "line %lld is no row of tracks", (long long)number);
    if (!(r->hertz <= up_to_hz))
        return RITZ_OK;
    r->at = number_of(t, r->name);
    t->num_tracks = r->track > t->num_tracks ? r->track : t->num_tracks;
    t->count++;
    return RITZ_OK;
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
static bool try_setting(track_table *t, int k, char name[RITZ_NAME_SIZE])
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

static void place_rows(track_table *t)
{
    char other[RITZ_NAME_SIZE];
    int found = -1;
    int many = 0;

    for (int k = 0; k < 16; k++)
        if (try_setting(t, k, other)) {
            found = k;
            many++;
        }
    t->swept = many == 1 && try_setting(t, found, t->xlabel);
    for (int64_t i = 0; !t->swept && i < t->num_at; i++)
        t->x[i] = (double)i + 1.0;
    if (!t->swept)
        snprintf(t->xlabel, RITZ_NAME_SIZE, "configuration");
}

static ritz_status read_rows(const char *text, double up_to_hz, track_table *t)
{
    int64_t number = 1;
    char *line = NULL;

    RITZ_CHECK(make_room(text, t));
    line = strchr(t->text, '\n'); /* behind the names of columns */
    while (line && *++line) {
        char *end = line + strcspn(line, "\n");
        bool more = *end != '\0';

        *end = '\0';
        line[strcspn(line, "\r")] = '\0';
        number++;
        if (*line)
            RITZ_CHECK(put_row(line, number, up_to_hz, t));
        line = more ? end : NULL;
    }
    RITZ_REFUSE_IF(t->count == 0, RITZ_ERR_FORMAT, "no mode is in it");
    RITZ_REFUSE_IF(t->num_tracks > MOST_TRACKS, RITZ_ERR_FORMAT,
                   "%lld tracks, more than %d cannot be told apart",
                   (long long)t->num_tracks, (int)MOST_TRACKS);
    return RITZ_OK;
}

static void free_table(track_table *t)
{
    free(t->row);
    free(t->at);
    free(t->x);
    free(t->text);
    *t = (track_table){0};
}

/* --- the picture ---------------------------------------------------------- */

static int by_track(const void *a, const void *b)
{
    const track_row *x = a, *y = b;

    if (x->track != y->track)
        return x->track < y->track ? -1 : 1;
    return (x->at > y->at) - (x->at < y->at);
}

static void put_data(const track_table *t, picture *p)
{
    FILE *data = p->data.file, *rows = p->table.file;
    const picture_sign sign = {.name =
                                   "MAC below 0.9 to where the mode comes from",
                               .colour = "alarm",
                               .mark = 6};
    bool doubtful = false;

    fprintf(data, "track\tx\thertz\tmac\ttip\tmode\tconfiguration\n");
    fprintf(rows, "track\tconfiguration\tmode\tHz\tMAC\n");
    for (int64_t k = 0; k < t->count; k++) {
        const track_row *r = &t->row[k];

        if (k > 0 && t->row[k - 1].track != r->track)
            fprintf(data, "\n");
        fprintf(data, "%lld\t%.9g\t%.9g\t%.6g\t", (long long)r->track,
                t->x[r->at], r->hertz, r->mac);
        picture_tip(p, "track %lld, mode %lld at %.100s\n%.6g Hz\nMAC %.3f%s",
                    (long long)r->track, (long long)r->mode, r->name, r->hertz,
                    r->mac, r->mac < doubt ? ": hardly the same mode" : "");
        fprintf(data, "\t%lld\t", (long long)r->mode);
        html_line(data, r->name);
        fprintf(data, "\n");
        fprintf(rows, "%lld\t", (long long)r->track);
        html_line(rows, r->name);
        fprintf(rows, "\t%lld\t%.6g\t%.4g\n", (long long)r->mode, r->hertz,
                r->mac);
        doubtful = doubtful || r->mac < doubt;
    }
    if (doubtful)
        picture_add_sign(p, &sign);
}

static ritz_status draw_tracks(const track_table *t, picture *p)
{
    double most = 0.0, least = t->x[0], last = t->x[0];

    for (int64_t k = 0; k < t->count; k++)
        most = fmax(most, t->row[k].hertz);
    for (int64_t k = 0; k < t->num_at; k++) {
        least = fmin(least, t->x[k]);
        last = fmax(last, t->x[k]);
    }
    put_data(t, p);
    p->wide = 720.0;
    p->body = 460.0;
    fprintf(p->given.file,
            "tracks = %lld\nx_low = %.9g\nx_high = %.9g\ny_high = %.9g\n"
            "swept = %d\ndoubt = %g\n",
            (long long)t->num_tracks, least, last,
            most > 0.0 ? 1.04 * most : 1.0, t->swept, doubt);
    picture_give_text(p, "xlabel", t->xlabel);
    return picture_draw(p, "tracks.gp", "Modes over configurations",
                        "frequency of each mode, followed by its shape");
}

ritz_status chart_tracks(const chart_sources *sources, const chart_wish *wish,
                         picture *out)
{
    ritz_status status = RITZ_OK;
    track_table t = {0};
    const chart_file *file = NULL;

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
    place_rows(&t);
    qsort(t.row, (size_t)t.count, sizeof *t.row, by_track);
    RITZ_TRY(picture_new(wish->path, wish->keep, out));
    RITZ_TRY(draw_tracks(&t, out));
done:
    free_table(&t);
    return status;
}
