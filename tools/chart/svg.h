/* The SVG of gnuplot, with names, tooltips and the colours of a page. */
#ifndef RITZ_TOOLS_CHART_SVG_H
#define RITZ_TOOLS_CHART_SVG_H

#include <stdint.h>
#include <stdio.h>

/*
 * Colours of all pictures: "c1" to "c8" of series, which colour-blind readers
 * can distinguish and which have a contrast of 3 to white, and those of words
 * and lines. A page has a light and a dark one under each name, as "--c1".
 */
typedef struct svg_colour {
    const char *name, *value;
} svg_colour;

enum { SVG_SERIES = 8 };

/** All colours, those of series first; the last row has no name. */
extern const svg_colour svg_colours[];

/** Name of the colour of a series. */
const char *svg_series(int64_t series);

typedef struct svg_names {
    const char *title, *summary;
    const char *prefix; /* of ids on a page; NULL: a file of its own */
} svg_names;

/**
 * Copy a picture of gnuplot: title and summary are added, hypertext becomes the
 * <title> of its mark, and on a page colours become those of the page.
 */
void svg_copy(FILE *file, const char *drawn, const svg_names *names);

#endif
