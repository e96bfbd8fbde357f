/* Responses over each other: what its files share. */
#ifndef RITZ_TOOLS_CHART_CHART_RESPONSE_H
#define RITZ_TOOLS_CHART_CHART_RESPONSE_H

#include "chart/chart.h"

enum {
    CHART_MOST_RESPONSES = 12,
    CHART_MOST_CHANNELS = 4,
    OVERLAY_WIDE = 490,
    OVERLAY_HIGH = 470,  /* of a cell with one strip of errors or none */
    OVERLAY_STRIP = 153, /* what another strip adds */
    OVERLAY_LEFT = 64,
    OVERLAY_RIGHT = 22,
};

/* How errors are measured; each has a strip below the magnitudes. */
enum { CHART_RELATIVE, CHART_DECIBELS, CHART_STRIPS };

/* The word for the channel of singular values; and its place of an output. */
#define CHART_SINGULAR_WORD "singular-values"
enum { CHART_SINGULAR = -1 };

/* One that is drawn: those with points in common lie over each other. */
typedef struct chart_curve {
    const ritz_response *r;
    const char *name;
} chart_curve;

typedef struct chart_overlay {
    int64_t count;
    chart_curve curve[CHART_MOST_RESPONSES];
    int64_t num_channels;
    int64_t output[CHART_MOST_CHANNELS], input[CHART_MOST_CHANNELS];
    int64_t passed; /* channels that are not drawn */
    bool strip[CHART_STRIPS];
    double high; /* of a cell */
    gnuplot *picture;
} chart_overlay;

/* Ends of axes. */
typedef struct chart_extent {
    double most, least; /* of magnitudes above 0 */
    double top;         /* the same as most, or a true peak above it */
    double worst[CHART_STRIPS], best[CHART_STRIPS]; /* of errors above 0 */
    int64_t shared; /* points that curves have in common */
} chart_extent;

/** Place of a name among some; -1: it is none of them. */
int64_t chart_response_name(int64_t count, char (*name)[RITZ_NAME_SIZE],
                            const char *wanted);

/** Whether channel @p c is that of singular values. */
bool chart_response_singular(const chart_overlay *o, int64_t c);

chart_extent chart_response_extent(const chart_overlay *o, int64_t c);

/**
 * Lines of one channel, and marks: channel, response, value, hertz, magnitude,
 * degrees, errors, tip. Value counts singular values from 0. Response -1 marks
 * peaks of the first, -2 true peaks, whose value is the response.
 */
void chart_response_data(const chart_overlay *o, int64_t c,
                         const chart_extent *e);

/** Draw one channel, magnitudes and errors, into a cell. */
void chart_response_channel(const chart_overlay *o, int64_t c, double left,
                            double bottom);

#endif
