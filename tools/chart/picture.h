/*
 * Pictures that gnuplot draws from a table of numbers, separated by tabs, and a
 * script. The script sets variables and continues with a template, KIND.gp of
 * this folder. Both are kept, so that `gnuplot -d PICTURE.svg.gp` draws the
 * picture again. Names that users chose are in single quotes or in the table,
 * and always `noenhanced`, so that gnuplot does not interpret them.
 */
#ifndef RITZ_TOOLS_CHART_PICTURE_H
#define RITZ_TOOLS_CHART_PICTURE_H

#include "chart/markup.h"
#include "cli/cli.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    PICTURE_PATH = 4096,
    PICTURE_WORD = 160,
    PICTURE_SIGNS = 64,
    PICTURE_WIDE = 560, /* wider ones take the whole width of a page */
};

/* A line or a mark of the legend. */
typedef struct picture_sign {
    char name[PICTURE_WORD];
    const char *role;   /* "the reference"; NULL: none */
    const char *colour; /* a name of svg_colours */
    int mark;           /* gnuplot's number of it; 0: a line */
    int dash;           /* of a line; 1 or less: none */
    double wide;        /* of a line */
} picture_sign;

typedef struct picture {
    char path[PICTURE_PATH];
    bool keep;   /* the picture, its data and its script become files */
    double wide; /* pixels */
    double body; /* height in pixels, less that of the legend */
    char note[PICTURE_WORD]; /* below the legend */
    cli_table data;          /* numbers, which gnuplot reads */
    cli_table given;         /* variables of the template */
    cli_table
        table; /* numbers for readers, with tabs, names of columns first */
    int num_signs;
    picture_sign sign[PICTURE_SIGNS];
    cli_table drawn; /* what gnuplot drew */
    char title[4 * PICTURE_WORD];
    const char *summary;
} picture;

/**
 * Begin a picture.
 *
 * @param[in] path  "NAME.svg"; with @p keep false the picture stays in memory,
 *                  without its legend, and temporary files are made next to
 *                  the path
 */
ritz_status picture_new(const char *path, bool keep, picture *out);

/** Add a sign to the legend under this name, as long as there is room. */
[[gnu::format(printf, 3, 4)]] void
picture_add_sign(picture *p, picture_sign sign, const char *format, ...);

/** NAME = 'TEXT' for the template. */
void picture_give_text(picture *p, const char *name, const char *text);

/** An array of @p count texts, the k-th at text + k * size. */
void picture_give_texts(picture *p, const char *name, int64_t count,
                        const char *text, size_t size);

/**
 * Arrays of numbers that are members of structs of some @p size: "A,B" are
 * neighbours, and the first A is at @p value.
 */
void picture_give_reals(picture *p, const char *names, int64_t count,
                        const double *value, size_t size);

/** The tooltip of a point, as a column of the data. */
[[gnu::format(printf, 2, 3)]] void picture_tip(picture *p, const char *format,
                                               ...);

/* A point in pixels. */
typedef struct picture_point {
    double x, y;
    int64_t group; /* its series; -1: it is not drawn */
    bool keep;
    int64_t column, row; /* of its square, by picture_thin */
} picture_point;

/**
 * Keep one point of each series in each square of @p cell pixels, the lowest: a
 * reader cannot distinguish the others. Those that are kept anyway stay.
 */
ritz_status picture_thin(int64_t count, picture_point *point, double cell);

/**
 * Draw it by a template and, with `keep`, write all three files.
 *
 * @param[in] title    read aloud in place of the picture
 * @param[in] summary  a sentence of what it shows, borrowed
 * @return RITZ_ERR_FILE if gnuplot is not there or fails
 */
ritz_status picture_draw(picture *p, const char *template, const char *title,
                         const char *summary);

void picture_free(picture *p);

/* Files of this folder that are part of the program, as CMake embeds them. */
typedef struct chart_text {
    const char *name;        /* "pareto.gp" */
    const char *const *line; /* ended by NULL */
} chart_text;

/** Lines of the file of that name, which there is. */
const char *const *chart_text_find(const char *name);

#endif
