/* Pictures as gnuplot writes them, made fit for readers and for a page. */
#ifndef RITZ_TOOLS_CHART_SVG_H
#define RITZ_TOOLS_CHART_SVG_H

#include <stdint.h>
#include <stdio.h>

/*
 * Colours of all pictures, "c1" to "c8" of series, told apart by colour-blind
 * readers and each with a contrast of 3 to white, and those of words and lines.
 * A page has a light and a dark one under each name, as "--c1".
 */
typedef struct svg_colour {
    const char *name, *value;
} svg_colour;

enum { SVG_SERIES = 8 };

/** All colours, those of series first, ended by one without a name. */
extern const svg_colour svg_colours[];

/** Name of the colour of a series. */
const char *svg_series(int64_t series);

typedef struct svg_names {
    const char *title, *summary;
    const char *prefix; /* of ids on a page; NULL: a file of its own */
} svg_names;

/**
 * Copy a picture of gnuplot's: it gets its name, and labels of hypertext become
 * titles of marks. On a page colours become those of the page.
 */
void svg_copy(FILE *file, const char *drawn, const svg_names *names);

#endif
