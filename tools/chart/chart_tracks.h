/* A table of --tracks, as it is drawn. */
#ifndef RITZ_TOOLS_CHART_CHART_TRACKS_H
#define RITZ_TOOLS_CHART_CHART_TRACKS_H

#include "chart/chart.h"

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

/**
 * Rows up to a frequency; x is not known yet.
 *
 * @return RITZ_ERR_FORMAT naming the line that is no row
 */
ritz_status track_table_read(const char *text, double up_to_hz,
                             track_table *out);

/** What x is: the one setting that differs, or else the number. */
void track_table_place(track_table *table);

void track_table_free(track_table *table);

#endif
