/* Charts of errors: what is common to Pareto charts and convergence. */
#ifndef RITZ_TOOLS_CHART_ERRORS_H
#define RITZ_TOOLS_CHART_ERRORS_H

#include "chart.h"

/* Models are themselves wrong by about so much: see docs/chart.md. */
#define CHART_UNCERTAINTY 0.1

typedef struct chart_errors {
    const char *title;
    const char *xlabel;
    bool seconds;                 /* x is a time, on a logarithmic axis */
    double (*x)(const record *r); /* NaN: not known */
    bool front;                   /* what nothing beats in both */
    bool lines;                   /* from order to order of a method */
} chart_errors;

/* Sizes in pixels. */
enum {
    CHART_CELL_WIDE = 490,
    CHART_CELL_HIGH = 380,
    CHART_LEFT = 58,
    CHART_RIGHT = 30,
    CHART_HEAD = 34,
};

/* A chart in the making. */
typedef struct chart_errors_work {
    const chart_errors *form;
    records all;
    int64_t num_measures;
    measure *measure;
    int64_t num_methods;
    const char **method;
    int64_t *which; /* method of each record */
    double *x, *y;  /* of each record, as drawn; NaN: not in this area */
    bool *front;
    int64_t lifted, absent, left_out; /* to be said below */
    gnuplot *picture;
} chart_errors_work;

/** Draw one measure into a cell. */
ritz_status chart_errors_area(chart_errors_work *w, int64_t panel, double left,
                              double bottom);

/** One area for each measure, one series for each method. */
ritz_status chart_errors_draw(const chart_sources *sources,
                              const chart_wish *wish, const chart_errors *form,
                              gnuplot *out);

/** What a point is, in lines. */
void chart_errors_tip(const record *r, const measure *m, size_t size,
                      char *out);

#endif
