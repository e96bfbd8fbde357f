/* Reading a table of --tracks. */
#include "chart/chart_tracks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

void track_table_place(track_table *t)
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

ritz_status track_table_read(const char *text, double up_to_hz, track_table *t)
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

void track_table_free(track_table *t)
{
    free(t->row);
    free(t->at);
    free(t->x);
    free(t->text);
    *t = (track_table){0};
}
