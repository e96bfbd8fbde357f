/* One channel: magnitudes over each other, peaks, strips of errors below. */
#include "chart/chart_response.h"

#include <math.h>

/* 10 % of a magnitude, in decibels: 20 log10(1.1). */
static const double ten_percent_db = 0.827853703164501;

enum { FOOT = 52, HEAD = 44, STRIP = 139, GAP = 14 };

/* Lines of all curves: of singular values the largest, then the others, thin.
   Widths are of the first curve's, and of others', in both ways. */
static void put_curves(const chart_overlay *o, int64_t c, int64_t from,
                       int column, const double wide[2][2])
{
    FILE *file = o->picture->plot.file;
    int ways = chart_response_singular(o, c) ? 2 : 1;

    fprintf(file, "plot NaN notitle");
    for (int64_t w = from; w < o->count; w++) {
        bool under = w == 0 && o->count > 1;
        const char *colour = under ? SVG_PALE : chart_colour(w > 0 ? w - 1 : 0);

        for (int thin = 0; thin < ways; thin++)
            fprintf(file,
                    ", \\\n  data skip 1 using (($1 == %lld && $2 == %lld && "
                    "$3 %s 0) ? $4 : NaN):%d with lines lw %g lc rgb '%s' "
                    "dt %lld notitle",
                    (long long)c, (long long)w, thin ? ">" : "==", column,
                    wide[!under][thin], colour, (long long)(w < 2 ? 1 : w));
    }
}

/* What can be pointed at: peaks of the first, and true ones as they are
   stored. */
static void put_marks(const chart_overlay *o, int64_t c)
{
    FILE *file = o->picture->plot.file;

    fprintf(file,
            ", \\\n  data skip 1 using (($1 == %lld && $2 == -1) ? $4 : NaN):5"
            ":9 with labels hypertext point pt 6 ps 0.7 lc rgb '" SVG_MUTED
            "' notitle",
            (long long)c);
    for (int64_t w = 0; chart_response_singular(o, c) && w < o->count; w++)
        if (o->curve[w].r->singular_peak[1] > 0.0)
            fprintf(file,
                    ", \\\n  data skip 1 using (($1 == %lld && $2 == -2 && "
                    "$3 == %lld) ? $4 : NaN):5:9 with labels hypertext point "
                    "pt 12 ps 1.1 lw 1.4 lc rgb '%s' notitle",
                    (long long)c, (long long)w,
                    w == 0 ? SVG_INK : chart_colour(w - 1));
    fprintf(file, "\n");
}

/* Frequencies over decades get a logarithmic axis. */
static axis hertz_axis(const chart_overlay *o)
{
    const ritz_response *r = o->curve[0].r;
    axis a = {.low = r->hertz[0], .high = r->hertz[r->count - 1]};

    a.log = a.low > 0.0 && a.high / a.low >= 10.0;
    if (!(a.high > a.low))
        a.high = a.low + 1.0;
    return a;
}

static axis decades(double least, double most)
{
    axis a = {.log = true};

    most = most > 0.0 ? most : 1.0;
    least = least < most ? least : most / 10.0;
    a.low = pow(10.0, floor(log10(fmax(least, 1e-14 * most))));
    a.high = pow(10.0, ceil(log10(1.01 * most)));
    return a;
}

static void begin(const chart_overlay *o, chart_area *area, const char *title,
                  const char *xlabel, const char *ylabel)
{
    area->x.from = area->left;
    area->x.to = area->right;
    area->y.from = area->bottom;
    area->y.to = area->top;
    chart_area_begin(o->picture, area, title, xlabel, ylabel);
    if (!*xlabel)
        fprintf(o->picture->plot.file, "set format x ''\n");
}

/* "tip / torque: error at most 0.31 %, 0.027 dB" */
static void put_title(const chart_overlay *o, int64_t c, const chart_extent *e,
                      char out[2 * CHART_WORD])
{
    const ritz_response *r = o->curve[0].r;
    char worst[32];
    size_t used = 0;

    if (chart_response_singular(o, c))
        used = (size_t)snprintf(out, CHART_WORD, "singular values");
    else
        used = (size_t)snprintf(out, 2 * RITZ_NAME_SIZE + 4, "%s / %s",
                                r->output[o->output[c]], r->input[o->input[c]]);
    if (o->count < 2 || e->shared == 0)
        return;
    chart_say_error(e->worst[CHART_RELATIVE], worst);
    used += (size_t)snprintf(out + used, 40, ": %s at most%s%s",
                             o->strip[CHART_RELATIVE] ? "error" : "difference",
                             o->strip[CHART_RELATIVE] ? " " : "",
                             o->strip[CHART_RELATIVE] ? worst : "");
    if (o->strip[CHART_DECIBELS])
        snprintf(out + used, 40,
                 "%s %.2g\xc2\xa0"
                 "dB",
                 o->strip[CHART_RELATIVE] ? "," : "", e->worst[CHART_DECIBELS]);
}

/* One strip of errors; the lowest has frequencies below it. */
static void put_strip(const chart_overlay *o, int64_t c, int strip,
                      const chart_extent *e, chart_area *area)
{
    static const struct {
        const char *label;
        int column;
    } known[CHART_STRIPS] = {
        [CHART_RELATIVE] = {"error / largest", 7},
        [CHART_DECIBELS] = {"difference, dB", 8},
    };
    static const double wide[2][2] = {{1.2, 0.7}, {1.2, 0.7}};
    double level = strip == CHART_DECIBELS ? ten_percent_db : 0.1;
    bool last = strip == CHART_DECIBELS || !o->strip[CHART_DECIBELS];
    FILE *file = o->picture->plot.file;

    area->top = area->bottom - GAP;
    area->bottom = area->top - STRIP;
    area->y = decades(e->best[strip], e->worst[strip]);
    begin(o, area, "", last ? "Hz" : "", known[strip].label);
    if (log10(area->y.high / area->y.low) > 4.0)
        fprintf(file, "set ytics %g\n",
                pow(10.0, ceil(log10(area->y.high / area->y.low) / 4.0)));
    if (area->y.high >= level && area->y.low <= level) {
        chart_level(o->picture, area, level,
                    "lw 1.2 dt 2 lc rgb '" SVG_INK "'");
        chart_text(o->picture, area->right - 2.0,
                   axis_place(&area->y, level) + 7.0, "10 %",
                   "right font ',11' tc rgb '" SVG_INK "'");
    }
    put_curves(o, c, 1, known[strip].column, wide);
    fprintf(file, "\n");
}

void chart_response_channel(const chart_overlay *o, int64_t c, double left,
                            double bottom)
{
    static const double wide[2][2] = {{6.0, 3.0}, {1.6, 0.8}};
    chart_extent e = chart_response_extent(o, c);
    chart_area area = {.left = left + OVERLAY_LEFT,
                       .right = left + OVERLAY_WIDE - OVERLAY_RIGHT,
                       .top = bottom + o->high - HEAD,
                       .bottom = bottom + FOOT,
                       .edge = left,
                       .x = hertz_axis(o)};
    bool errors = o->count > 1 && e.shared > 0;
    char title[2 * CHART_WORD] = "";

    for (int s = 0; errors && s < CHART_STRIPS; s++)
        area.bottom += o->strip[s] ? STRIP + GAP : 0;
    put_title(o, c, &e, title);
    area.y = decades(e.least, e.top);
    begin(o, &area, title, errors ? "" : "Hz",
          chart_response_singular(o, c) ? "singular values" : "magnitude");
    chart_response_data(o, c, &e);
    put_curves(o, c, 0, 5, wide);
    put_marks(o, c);
    for (int s = 0; errors && s < CHART_STRIPS; s++)
        if (o->strip[s])
            put_strip(o, c, s, &e, &area);
}
