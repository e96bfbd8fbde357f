/*
 * Pictures that gnuplot draws: numbers go into a table with tabs, what is to be
 * said of them into variables in front of a template, KIND.gp of this folder.
 * Table and script stay beside the picture, so that it can be drawn again:
 * `gnuplot PICTURE.svg.gp`. Text that others chose reaches gnuplot in single
 * quotes or in the table, and always `noenhanced`: it reads nothing into it.
 */
#ifndef RITZ_TOOLS_CHART_PICTURE_H
#define RITZ_TOOLS_CHART_PICTURE_H

#include "chart/svg.h"
#include "cli/cli_table.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    PICTURE_PATH = 4096,
    PICTURE_WORD = 160,
    PICTURE_SIGNS = 64,
    PICTURE_WIDE = 560, /* wider ones take the whole width of a page */
};

/* What a legend shows beside a name. */
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
    cli_table data;          /* to be written to: what gnuplot reads */
    cli_table given;         /* the same, variables of the template */
    cli_table table; /* the same, what a reader may want to read; with tabs,
                        names of columns first */
    int num_signs;
    picture_sign sign[PICTURE_SIGNS];
    char *drawn; /* what gnuplot drew */
    void *rooms; /* memory that is freed with it */
    char title[4 * PICTURE_WORD];
    const char *summary;
} picture;

/**
 * Begin a picture.
 *
 * @param[in] path  where it appears, "NAME.svg"; with @p keep false it stays
 *                  in memory, without its legend, and only short-lived files
 *                  appear beside path
 */
ritz_status picture_new(const char *path, bool keep, picture *out);

/** Zeroed memory that is freed with the picture; NULL, with a message: none. */
void *picture_room(picture *p, int64_t count, size_t size);

#define PICTURE_NEW(picture, pointer, count)                                   \
    do {                                                                       \
        (pointer) = picture_room((picture), (count), sizeof *(pointer));       \
        if (!(pointer))                                                        \
            return RITZ_ERR_MEMORY;                                            \
    } while (0)

/** "rotor.h5" of "build/rotor.h5". */
const char *picture_base(const char *path);

/** Add a sign to the legend under this name, as long as there is room. */
[[gnu::format(printf, 3, 4)]] void
picture_add_sign(picture *p, picture_sign sign, const char *format, ...);

/** NAME = 'TEXT' for the template. */
void picture_give_text(picture *p, const char *name, const char *text);

/** An array of so many texts, the k-th at text + k * size. */
void picture_give_texts(picture *p, const char *name, int64_t count,
                        const char *text, size_t size);

/** An array of numbers, the k-th at value + k * stride. */
void picture_give_reals(picture *p, const char *name, int64_t count,
                        const double *value, int64_t stride);

/** What is said of a point, as a column of the data: lines of markup. */
[[gnu::format(printf, 2, 3)]] void picture_tip(picture *p, const char *format,
                                               ...);

/**
 * Of points of one series at x, y in pixels, which a reader can tell apart: of
 * those in one square of @p cell pixels the lowest stays.
 *
 * @param[in]     group  which series a point is of; -1: it is none
 * @param[in,out] keep   those that must stay are true already
 */
ritz_status picture_thin(int64_t count, const double *x, const double *y,
                         double cell, const int64_t *group, bool *keep);

/**
 * Draw it by a template and, with `keep`, write all three files.
 *
 * @param[in] title    its name for those who do not see it
 * @param[in] summary  a sentence of what it shows, borrowed
 * @return RITZ_ERR_FILE if gnuplot is not there or fails
 */
ritz_status picture_draw(picture *p, const char *template, const char *title,
                         const char *summary);

void picture_free(picture *p);

#endif
