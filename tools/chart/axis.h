/* Scales of charts, in pixels. */
#ifndef RITZ_TOOLS_CHART_AXIS_H
#define RITZ_TOOLS_CHART_AXIS_H

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

/** Width of a text in pixels, about. */
double axis_width(const char *text, double size);

#endif
