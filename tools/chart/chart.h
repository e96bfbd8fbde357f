/*
 * Charts: the files that each kind draws, and the function that draws them. A
 * kind is one file and one row of the table in charts.c.
 */
#ifndef RITZ_TOOLS_CHART_CHART_H
#define RITZ_TOOLS_CHART_CHART_H

#include "chart/picture.h"
#include "cli/model.h"
#include "cli/records.h"
#include "print/print.h"

/* Contents of files: kinds of containers, or texts. */
enum {
    CHART_RECORDS = MODEL_ANY + 1,
    CHART_TRACKS = 2 * CHART_RECORDS,
    CHART_MOTION = 2 * CHART_TRACKS,
    CHART_MODES = MODEL_REDUCED | MODEL_BASIS | MODEL_COMPONENT,
    CHART_REPORT = CHART_RECORDS | CHART_TRACKS | CHART_MOTION | CHART_MODES |
                   MODEL_RANKING | MODEL_SYSTEM | MODEL_RESPONSE |
                   MODEL_SIMULATION,
};

typedef struct chart_file {
    int holds;
    const char *path;
    model model; /* of a container */
    char *text;  /* of tracks, which are cut up where they are drawn, and of
                    lists of frames */
} chart_file;

typedef struct chart_sources {
    cli_run *run;
    records runs; /* of all files of records */
    int64_t count;
    chart_file *file;
} chart_sources;

typedef struct chart_request {
    const char *path; /* of the picture or page */
    cli_list measure, channel;
    cli_list at;         /* of systems: which configurations */
    const char *subject; /* NULL: the only one */
    const char *against; /* "reduce", "simulate"; NULL: "simulate" if records
                            have its cost */
    const char *error;   /* "relative", "decibels", "both" */
    double up_to_hz;     /* of tracks */
    int64_t top;         /* most modes of each ranking */
} chart_request;

/* Draws files of its kind, one or more, into a new picture. */
typedef ritz_status chart_draw(const chart_sources *sources,
                               const chart_request *request, picture *out);

chart_draw chart_pareto, chart_convergence, chart_hankel, chart_response,
    chart_mac, chart_tracks, chart_simulation, chart_diagnostics,
    chart_switched, chart_motion;

typedef struct chart_kind {
    const char *name, *summary;
    int holds; /* contents that it draws */
    const char *files;
    chart_draw *draw;
} chart_kind;

/** All kinds; the last row has no name. */
extern const chart_kind chart_kinds[];

/** Read files of some contents; others are refused. */
ritz_status chart_read(cli_run *run, int64_t count, char *const *path,
                       int holds, chart_sources *out);

/** Put the names of the files with some contents before the sentence of a
 * failure, unless the sentence names one of them. */
ritz_status chart_name_files(ritz_status status, const chart_sources *sources,
                             int holds);
void chart_sources_free(chart_sources *sources);

/** If a system has negative squares, state in the report and below the picture
 * that they are left out: see model_negative_squares. */
void chart_leave_squares(const chart_sources *sources, const char *name,
                         int64_t count, picture *out);

/**
 * Draw the values of modes as bars: PATH, an SVG, with its data in PATH.tsv and
 * its script in PATH.gp.
 *
 * @param[in] most  modes of each ranking
 * @return RITZ_ERR_FILE if gnuplot is not there or fails
 */
ritz_status chart_rankings(const char *path, const char *title,
                           const contest *all, int64_t most);

/* --- words of charts ------------------------------------------------------ */

/* A number in words: "0.31 %", "3.1e-06", "2.1 ms". */
typedef struct chart_word {
    char text[32];
} chart_word;

chart_word chart_say_error(double error);
chart_word chart_say_seconds(double seconds);

/** Refuse a file that lacks one of some names, such as its first "output"s. */
ritz_status chart_check_names(const char *path, const char *what, int64_t count,
                              char (*name)[RITZ_NAME_SIZE], int64_t num_wanted,
                              char (*wanted)[RITZ_NAME_SIZE]);

typedef struct chart_range {
    double low, high;
} chart_range;

/**
 * Whole decades around the finite values that are above @p floor_value. A
 * logarithm cannot show the others: a decade is added below, at whose foot they
 * are drawn. If nothing is above the floor, it is the decade above the floor.
 *
 * @param[in]  floor_value  > 0
 * @param[out] lifted       how many are drawn at the foot
 */
chart_range chart_decades(int64_t count, const double *values,
                          double floor_value, int64_t *lifted);

/** The channel of singular values. */
#define CHART_SINGULAR_WORD "singular-values"

#endif
