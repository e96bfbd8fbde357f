/* Pictures as gnuplot writes them, made fit for readers and for a page. */
#ifndef RITZ_TOOLS_CHART_SVG_H
#define RITZ_TOOLS_CHART_SVG_H

#include <ritz/status.h>

#include <stdint.h>
#include <stdio.h>

/*
 * Colours of all pictures, told apart by colour-blind readers and each with a
 * contrast of 3 to white. A page shows them by name, light or dark.
 */
enum { SVG_COLOURS = 8 };
extern const char *const svg_colour[SVG_COLOURS];
#define SVG_INK   "#1b1f24" /* text and lines that count */
#define SVG_MUTED "#5a6270" /* text and lines beside them */
#define SVG_GRID  "#d9dee5"
#define SVG_PAPER "#ffffff"
#define SVG_ALARM "#b00020" /* limits */
#define SVG_PALE  "#9fb0c3" /* what others are drawn over */

/* Wider pictures are illegible on a telephone, and to be scrolled; pixels. */
#define SVG_WIDE 560.0

/**
 * Name a picture and its points. gnuplot's own names go, its scripts, and
 * groups that are empty; a point of hypertext "17" has the 17th tip.
 *
 * @param[out] out  to be freed
 */
ritz_status svg_dress(const char *drawn, const char *title, const char *summary,
                      int64_t num_tips, char *const *tip, char **out);

/**
 * Write a dressed picture into a page: names are made its own by @p prefix,
 * colours become those of the page.
 */
void svg_embed(FILE *file, const char *svg, const char *prefix);

#endif
