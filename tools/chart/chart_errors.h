/* Charts of errors: what is common to Pareto charts and convergence. */
#ifndef RITZ_TOOLS_CHART_CHART_ERRORS_H
#define RITZ_TOOLS_CHART_CHART_ERRORS_H

#include "chart/chart.h"

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
    CHART_RIGHT = 56,  /* where lines of equal error say how much they are */
    CHART_MARGIN = 14, /* right of a legend */
    CHART_HEAD = 34,
};

/* Records that are not drawn where they are: at the foot, or not at all. */
enum { CHART_LIFTED, CHART_LEFT_OUT };

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
    int64_t lifted, left_out; /* to be said below */
    gnuplot *picture;
} chart_errors_work;

/** Coordinates of all records in an area, which becomes their axes'; how many
 * are lifted and left out. */
void chart_errors_place(chart_errors_work *w, const measure *m,
                        chart_area *area, int64_t count[2]);

/** Lines of equal error, of the tolerance and of what models are wrong by. */
void chart_errors_levels(const chart_errors_work *w, const measure *m,
                         const chart_area *area);

/** Whether an area shows what models are wrong by. */
bool chart_errors_uncertain(const chart_area *area);

/** Decades that have lines, from first to last; every how many of them. */
int chart_errors_decades(const chart_area *area, int *first, int *last);

/**
 * Points of the front, or the best of one method at each order, from left to
 * right: x, y, record. What misses modes is on neither.
 *
 * @param[out] room  three numbers for each record
 * @return how many
 */
int64_t chart_errors_line(const chart_errors_work *w, int64_t method,
                          bool front, double *room);

/**
 * What was chosen, a line leading to the words if they are not beside it, and
 * orders of other points where they cover nothing.
 */
ritz_status chart_errors_words(const chart_errors_work *w, const measure *m,
                               const chart_area *area);

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
