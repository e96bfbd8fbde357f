/*
 * Markup: text of users in it, and the SVG of gnuplot with names, tooltips and
 * the colours of a page.
 */
#ifndef RITZ_TOOLS_CHART_MARKUP_H
#define RITZ_TOOLS_CHART_MARKUP_H

#include <stdint.h>
#include <stdio.h>

/**
 * Write text between tags or into a quoted attribute: characters that markup
 * interprets are escaped, control characters become spaces, and bytes that are
 * not UTF-8 question marks.
 */
void html_text(FILE *file, const char *text);

/** The same of plain text, where nothing is escaped. */
void html_line(FILE *file, const char *text);

/** One letter of such a text. @return bytes of text it took */
int html_symbol(FILE *file, const char *text);
int html_letter(FILE *file, const char *text);

/**
 * Write markup as printf would, the texts of "%s" escaped. It knows "%s",
 * "%ld", "%g", "%.3g" and "%%".
 */
[[gnu::format(printf, 2, 3)]] void html_print(FILE *file, const char *format,
                                              ...);

/*
 * Colours of all pictures: "c1" to "c8" of series, which colour-blind readers
 * can distinguish and which have a contrast of 3 to white, and those of words
 * and lines. A page has a light and a dark one under each name, as "--c1".
 */
typedef struct svg_colour {
    const char *name;
    unsigned long rgb;
} svg_colour;

enum { SVG_SERIES = 8 };

/** All colours, those of series first; the last row has no name. */
extern const svg_colour svg_colours[];

/** Name of the colour of a series. */
const char *svg_series(int64_t series);

/**
 * Copy a picture of gnuplot: title and summary are added, hypertext becomes the
 * <title> of its mark, and on a page colours become those of the page.
 *
 * @param[in] prefix  of ids on a page; NULL: the picture is a file of its own
 */
void svg_copy(FILE *file, const char *drawn, const char *title,
              const char *summary, const char *prefix);

#endif
