/*
 * Pictures that gnuplot draws. Numbers go into a table with tabs and what is to
 * be drawn into a script; both stay beside the picture, so that it can be drawn
 * again: `gnuplot PICTURE.svg.gp`. Names that others chose reach gnuplot in
 * single quotes, where it reads nothing into them, and always `noenhanced`.
 */
#ifndef RITZ_TOOLS_CHART_GNUPLOT_H
#define RITZ_TOOLS_CHART_GNUPLOT_H

#include "base/draft.h"
#include "chart/svg.h"
#include "cli/cli_table.h"

#include <stdbool.h>
#include <stdint.h>

enum { GNUPLOT_PATH = 4096 };

typedef struct gnuplot {
    char path[GNUPLOT_PATH];
    bool keep;         /* the picture, its data and its script become files */
    double wide, high; /* pixels */
    cli_table data;    /* to be written to: what gnuplot reads */
    cli_table plot;    /* the same, commands behind those of gnuplot_size */
    cli_table table;   /* the same, what a reader may want to read; with tabs,
                          names of columns first */
    int64_t num_tips;
    char **tip; /* what is said of a point that is pointed at */
    char *svg;  /* the picture, once drawn */
} gnuplot;

/**
 * Begin a picture.
 *
 * @param[in] path  where it appears, "NAME.svg"; with @p keep false it stays
 *                  in memory, and only short-lived files appear beside path
 */
ritz_status gnuplot_new(const char *path, bool keep, gnuplot *out);

/** Its size in pixels and the words that every script begins with. */
void gnuplot_size(gnuplot *picture, double wide, double high);

/** Text in gnuplot's single quotes. */
void gnuplot_quote(FILE *file, const char *text);

/** What is said of a point; the number that its hypertext is. -1: no memory. */
[[gnu::format(printf, 2, 3)]] int64_t gnuplot_tip(gnuplot *picture,
                                                  const char *format, ...);

/**
 * Draw it and, with `keep`, write all three files.
 *
 * @param[in] title    its name for those who do not see it
 * @param[in] summary  a sentence of what it shows
 * @return RITZ_ERR_FILE if gnuplot is not there or fails
 */
ritz_status gnuplot_draw(gnuplot *picture, const char *title,
                         const char *summary);

void gnuplot_free(gnuplot *picture);

#endif
