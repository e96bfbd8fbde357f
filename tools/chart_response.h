/* Responses over each other: what its two files share. */
#ifndef RITZ_TOOLS_CHART_RESPONSE_H
#define RITZ_TOOLS_CHART_RESPONSE_H

#include "chart.h"

enum {
    CHART_MOST_RESPONSES = 12,
    CHART_MOST_CHANNELS = 4,
    MOST_PEAKS = 24,
    OVERLAY_WIDE = 490,
    OVERLAY_HIGH = 470,
    OVERLAY_LEFT = 64,
    OVERLAY_RIGHT = 22,
};

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
    gnuplot *picture;
} chart_overlay;

/** Place of a name among some; -1: it is none of them. */
int64_t chart_response_name(int64_t count, char (*name)[RITZ_NAME_SIZE],
                            const char *wanted);

/** Draw one channel, magnitudes and errors, into a cell. */
void chart_response_channel(const chart_overlay *o, int64_t c, double left,
                            double bottom);

#endif
