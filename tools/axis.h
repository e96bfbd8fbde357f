/* Scales of charts, in pixels, and where words find room. */
#ifndef RITZ_TOOLS_AXIS_H
#define RITZ_TOOLS_AXIS_H

#include <stdbool.h>
#include <stdint.h>

/* low..high of the data at pixels from..to. */
typedef struct axis {
    bool log;
    double low, high;
    double from, to;
} axis;

/**
 * Whole decades around the finite ones of some values that are above @p floor.
 * Where others are not, and a logarithm cannot show zero, a decade is added
 * below for them to stand at its foot: see axis_clamp.
 *
 * @param[in]  floor   > 0
 * @param[out] lifted  how many do
 * @return the decade above floor if nothing is above it
 */
axis axis_log(int64_t count, const double *values, double floor,
              int64_t *lifted);

/** The same, ending at 1, 2 or 5 of a decade; all must be positive. */
axis axis_tight(int64_t count, const double *values);

/** 0 or the least, to a little above the largest. */
axis axis_linear(int64_t count, const double *values, bool from_zero);

/** What is drawn of a value: itself, or the foot of the axis; NaN: nothing. */
double axis_clamp(const axis *a, double value);

/** Pixel of a value. */
double axis_place(const axis *a, double value);

/* A word beside a point: in pixels, y upwards. */
typedef struct axis_word {
    double x, y;       /* the point */
    double wide, high; /* of the word */
    double gap;        /* further from the point, pixels */
    double left, base; /* where it goes: lower left corner */
    bool must;         /* it is written across points, or even words, too */
    bool written;
} axis_word;

/**
 * Find room for words beside their points, first come first served: right,
 * above, left, below and farther out. One that finds none is not written.
 *
 * @param[in] box  left, bottom, right, top of where words may be
 */
void axis_words(int64_t count, axis_word *words, const double box[4]);

/** Width of a text in pixels, about. */
double axis_width(const char *text, double size);

#endif
