/*
 * Charts: what each is made from and who draws it. A kind is one file and one
 * line in the table of chart.c.
 */
#ifndef RITZ_TOOLS_CHART_CHART_H
#define RITZ_TOOLS_CHART_CHART_H

#include "chart/axis.h"
#include "chart/gnuplot.h"
#include "cli/model.h"
#include "cli/records.h"

/* What a file can hold, by its content. */
enum {
    CHART_RECORDS = 1,
    CHART_TRACKS = 2,
    CHART_RANKING = 4,
    CHART_RESPONSE = 8,
    CHART_MODES = 16, /* a reduced component, a basis, a component */
    CHART_SIMULATION = 32,
    CHART_SYSTEM = 64,
};

typedef struct chart_file {
    int holds;
    const char *path;
    model model; /* of a container */
    char *text;  /* of tracks */
} chart_file;

typedef struct chart_sources {
    cli_run *run;
    records runs; /* of all files of records */
    int64_t count;
    chart_file *file;
} chart_sources;

typedef struct chart_wish {
    const char *path; /* of the picture */
    bool keep;        /* see gnuplot_new */
    cli_list measure, channel;
    cli_list at;         /* of systems: which configurations */
    const char *subject; /* NULL: the only one */
    const char *against; /* "reduce", "simulate"; NULL: what is known */
    const char *error;   /* "relative", "decibels", "both" */
    double up_to_hz;     /* of tracks */
    int64_t top;         /* so many modes at most */
} chart_wish;

typedef struct chart_kind {
    const char *name, *summary;
    int holds; /* of files that it takes */
    const char *files;
    ritz_status (*draw)(const chart_sources *sources, const chart_wish *wish,
                        gnuplot *out);
} chart_kind;

/** All kinds, ended by one without a name. */
extern const chart_kind chart_kinds[];

ritz_status chart_pareto(const chart_sources *sources, const chart_wish *wish,
                         gnuplot *out);
ritz_status chart_convergence(const chart_sources *sources,
                              const chart_wish *wish, gnuplot *out);
ritz_status chart_hankel(const chart_sources *sources, const chart_wish *wish,
                         gnuplot *out);
ritz_status chart_response(const chart_sources *sources, const chart_wish *wish,
                           gnuplot *out);
ritz_status chart_mac(const chart_sources *sources, const chart_wish *wish,
                      gnuplot *out);
ritz_status chart_simulation(const chart_sources *sources,
                             const chart_wish *wish, gnuplot *out);
ritz_status chart_tracks(const chart_sources *sources, const chart_wish *wish,
                         gnuplot *out);

/** Read files, each by its content; one that is none of @p holds is refused. */
ritz_status chart_read(cli_run *run, int64_t count, char *const *path,
                       int holds, chart_sources *out);
void chart_sources_free(chart_sources *sources);

/* --- parts of charts ------------------------------------------------------ */

enum { CHART_WORD = 160 };

/** "0.31 %", "3.1e-06", "2.1 ms". */
void chart_say_error(double error, char out[32]);
void chart_say_seconds(double seconds, char out[32]);

/** "rotor.h5" of "build/rotor.h5". */
const char *chart_base(const char *path);

/** Colour and mark of one of several series; @p hollow or filled. */
const char *chart_colour(int64_t series);
int chart_mark(int64_t series, bool hollow);

/* A plot area, in pixels from the lower left corner of the picture. */
typedef struct chart_area {
    double left, bottom, right, top;
    axis x, y;
    double edge; /* left end of its cell, where the label of y stands */
} chart_area;

/** Margins, ranges, tics at decades or as gnuplot likes, labels, title. */
void chart_area_begin(gnuplot *picture, const chart_area *area,
                      const char *title, const char *xlabel,
                      const char *ylabel);

/** The whole picture as one bare area, for legends and notes at the end. */
void chart_canvas(gnuplot *picture);

/** Tics of a logarithmic axis in seconds: "20 ms", "50 ms". */
void chart_tics_seconds(gnuplot *picture, const axis *x);

/** A text at a place in pixels. */
void chart_text(gnuplot *picture, double x, double y, const char *text,
                const char *how);

/** A level line through an area, from side to side. */
void chart_level(gnuplot *picture, const chart_area *area, double value,
                 const char *how);

/* What a legend shows beside a name. */
typedef struct chart_sign {
    char name[CHART_WORD];
    const char *colour;
    int mark;    /* 0: a line */
    int dash;    /* of a line */
    double wide; /* of a line; 0: as others */
} chart_sign;

/** Rows that a legend needs at a width; draw it, or only count. */
int64_t chart_legend(gnuplot *picture, int64_t count, const chart_sign *signs,
                     double left, double top, double right, bool draw);

#endif
