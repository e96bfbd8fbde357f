/* Where words of a chart find room, in pixels, y upwards. */
#ifndef RITZ_TOOLS_CHART_CHART_PLACE_H
#define RITZ_TOOLS_CHART_CHART_PLACE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct chart_box {
    double left, bottom, right, top;
} chart_box;

/* A mark, or a ring around one: a square of that half. */
typedef struct chart_spot {
    double x, y, half;
} chart_spot;

typedef struct chart_stroke {
    double x[2], y[2];
    double weight; /* 1: what is drawn; less: what it is drawn over */
} chart_stroke;

/* What is there already. */
typedef struct chart_places {
    chart_box frame; /* words stay in it */
    int64_t num_spots, num_strokes, num_words;
    chart_spot *spot;
    chart_stroke *stroke;
    chart_box *word;
} chart_places;

typedef struct chart_word {
    double x, y, half;     /* the point, and of the mark around it */
    double wide, high;     /* of the word */
    chart_box at;          /* where it goes */
    bool led;              /* so far away that a line should lead to it */
    double from[2], to[2]; /* that line */
} chart_word;

/** Beside the point where the word covers nothing and no other mark is as
 * near; false: there is no such place. */
bool chart_place_beside(const chart_places *p, chart_word *word);

/** Wherever it covers least, and as near as that goes; always somewhere. */
void chart_place_around(const chart_places *p, chart_word *word);

#endif
