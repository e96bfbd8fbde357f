/* One channel: magnitudes over each other, peaks, errors below. */
#include "chart_response.h"

#include <complex.h>
#include <math.h>

/* H of a curve's k-th point in the first curve's channel c. */
static double _Complex value_of(const chart_overlay *o, int64_t which,
                                int64_t k, int64_t c)
{
    const ritz_response *first = o->curve[0].r, *r = o->curve[which].r;
    int64_t i = chart_response_name(r->num_outputs, r->output,
                                    first->output[o->output[c]]);
    int64_t j =
        chart_response_name(r->num_inputs, r->input, first->input[o->input[c]]);

    return r->H[(k * r->num_outputs + i) * r->num_inputs + j];
}

/* Point of a curve at a frequency of the first; -1: it has none there. */
static int64_t point_at(const ritz_response *r, double hertz)
{
    int64_t low = 0, high = r->count;

    while (low < high) {
        int64_t middle = low + (high - low) / 2;

        if (r->hertz[middle] < hertz * (1.0 - 1e-12))
            low = middle + 1;
        else
            high = middle;
    }
    return low < r->count && r->hertz[low] <= hertz * (1.0 + 1e-12) ? low : -1;
}

typedef struct extent {
    double most, least; /* of magnitudes */
    double worst, best; /* of errors over the largest magnitude */
    int64_t shared;     /* points that curves have in common */
} extent;

/* |H_r - H| / max |H| of curve w at point k of the first; NaN: none there. */
static double error_of(const chart_overlay *o, int64_t w, int64_t k, int64_t c,
                       double most)
{
    int64_t other = point_at(o->curve[w].r, o->curve[0].r->hertz[k]);

    if (other < 0)
        return nan("");
    return cabs(value_of(o, w, other, c) - value_of(o, 0, k, c)) / most;
}

static extent extent_of(const chart_overlay *o, int64_t c)
{
    const ritz_response *first = o->curve[0].r;
    extent e = {.least = HUGE_VAL, .best = HUGE_VAL};

    for (int64_t k = 0; k < first->count; k++) {
        double size = cabs(value_of(o, 0, k, c));

        e.most = fmax(e.most, size);
        if (size > 0.0)
            e.least = fmin(e.least, size);
    }
    for (int64_t w = 1; w < o->count; w++)
        for (int64_t k = 0; e.most > 0.0 && k < first->count; k++) {
            double error = error_of(o, w, k, c, e.most);

            if (isnan(error))
                continue;
            e.shared++;
            e.worst = fmax(e.worst, error);
            if (error > 0.0)
                e.best = fmin(e.best, error);
        }
    return e;
}

/* channel, curve, hertz, magnitude, phase, error; -1 for tips: see below. */
static void put_curve(const chart_overlay *o, int64_t w, int64_t c, double most)
{
    const ritz_response *r = o->curve[w].r;
    FILE *file = o->picture->data.file;

    for (int64_t k = 0; k < r->count; k++) {
        double _Complex H = value_of(o, w, k, c);
        int64_t at = point_at(o->curve[0].r, r->hertz[k]);
        double error =
            w == 0 || at < 0 ? nan("") : cabs(H - value_of(o, 0, at, c)) / most;

        fprintf(file, "%lld\t%lld\t%.9g\t%.9g\t%.6g\t%.6g\t-1\n", (long long)c,
                (long long)w, r->hertz[k], cabs(H), carg(H) * 180.0 / M_PI,
                error);
    }
    fputc('\n', file);
}

/* Peaks of the first curve, largest first: where a reader points at. */
static int64_t find_peaks(const chart_overlay *o, int64_t c,
                          int64_t peak[MOST_PEAKS])
{
    int64_t count = 0;
    int64_t last = o->curve[0].r->count - 1;

    for (int64_t k = 1; k < last; k++) {
        double size = cabs(value_of(o, 0, k, c));
        int64_t at = count;

        if (size <= cabs(value_of(o, 0, k - 1, c)) ||
            size < cabs(value_of(o, 0, k + 1, c)))
            continue;
        while (at > 0 && cabs(value_of(o, 0, peak[at - 1], c)) < size)
            at--;
        if (at == MOST_PEAKS)
            continue;
        count += count < MOST_PEAKS;
        for (int64_t i = count - 1; i > at; i--)
            peak[i] = peak[i - 1];
        peak[at] = k;
    }
    return count;
}

static void put_peaks(const chart_overlay *o, int64_t c, double most)
{
    int64_t peak[MOST_PEAKS];
    int64_t count = find_peaks(o, c, peak);
    const ritz_response *first = o->curve[0].r;
    char text[1500];

    for (int64_t p = 0; p < count; p++) {
        double hertz = first->hertz[peak[p]];
        double size = cabs(value_of(o, 0, peak[p], c));
        size_t used = (size_t)snprintf(text, sizeof text,
                                       "peak at %.6g Hz\n%.60s: |H| = %.5g",
                                       hertz, o->curve[0].name, size);
        int64_t tip = 0;

        fprintf(o->picture->table.file, "%s/%s\t%.6g\t%.5g",
                first->output[o->output[c]], first->input[o->input[c]], hertz,
                size);
        for (int64_t w = 1; w < o->count; w++) {
            double error = error_of(o, w, peak[p], c, most);

            if (used < sizeof text)
                used += (size_t)snprintf(text + used, sizeof text - used,
                                         "\n%.60s: error %.2e of the largest",
                                         o->curve[w].name, error);
            fprintf(o->picture->table.file, "\t%.3e", error);
        }
        fprintf(o->picture->table.file, "\n");
        tip = gnuplot_tip(o->picture, "%s", text);
        fprintf(o->picture->data.file, "%lld\t-1\t%.9g\t%.9g\tnan\tnan\t%lld\n",
                (long long)c, hertz, size, (long long)tip);
    }
    fputc('\n', o->picture->data.file);
}

static void put_magnitudes(const chart_overlay *o, int64_t c)
{
    FILE *file = o->picture->plot.file;

    fprintf(file, "plot NaN notitle");
    for (int64_t w = 0; w < o->count; w++)
        fprintf(file,
                ", \\\n  data skip 1 using (($1 == %lld && $2 == %lld) ? $3 : "
                "NaN):4 with lines lw %s lc rgb '%s' dt %lld notitle",
                (long long)c, (long long)w, w == 0 ? "6" : "1.6",
                w == 0 ? SVG_PALE : chart_colour(w - 1),
                (long long)(w < 2 ? 1 : w));
    fprintf(file,
            ", \\\n  data skip 1 using (($1 == %lld && $2 == -1) ? $3 : NaN):4"
            ":7 with labels hypertext point pt 6 ps 0.7 lc rgb '" SVG_MUTED
            "' notitle\n",
            (long long)c);
}

static void put_errors(const chart_overlay *o, int64_t c)
{
    FILE *file = o->picture->plot.file;

    fprintf(file, "plot NaN notitle");
    for (int64_t w = 1; w < o->count; w++)
        fprintf(file,
                ", \\\n  data skip 1 using (($1 == %lld && $2 == %lld) ? $3 : "
                "NaN):6 with lines lw 1.2 lc rgb '%s' dt %lld notitle",
                (long long)c, (long long)w, chart_colour(w - 1),
                (long long)(w < 2 ? 1 : w));
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
}

void chart_response_channel(const chart_overlay *o, int64_t c, double left,
                            double bottom)
{
    const ritz_response *r = o->curve[0].r;
    extent e = extent_of(o, c);
    chart_area area = {.left = left + OVERLAY_LEFT,
                       .right = left + OVERLAY_WIDE - OVERLAY_RIGHT,
                       .x = hertz_axis(o)};
    bool errors = o->count > 1 && e.shared > 0;
    char title[CHART_WORD + 40], worst[32];

    chart_say_error(e.worst, worst);
    snprintf(title, sizeof title,
             errors ? "%s / %s: error at most %s" : "%s / %s",
             r->output[o->output[c]], r->input[o->input[c]], worst);
    area.bottom = bottom + (errors ? 205.0 : 52.0);
    area.top = bottom + OVERLAY_HIGH - 44.0;
    area.y = decades(e.least, e.most);
    begin(o, &area, title, errors ? "" : "Hz", "magnitude");
    if (errors)
        fprintf(o->picture->plot.file, "set format x ''\n");
    for (int64_t w = 0; w < o->count; w++)
        put_curve(o, w, c, e.most > 0.0 ? e.most : 1.0);
    put_peaks(o, c, e.most > 0.0 ? e.most : 1.0);
    put_magnitudes(o, c);
    if (!errors)
        return;
    area.top = area.bottom - 14.0;
    area.bottom = bottom + 52.0;
    area.y = decades(e.best, e.worst);
    begin(o, &area, "", "Hz", "error / largest");
    if (log10(area.y.high / area.y.low) > 4.0)
        fprintf(o->picture->plot.file, "set ytics %g\n",
                pow(10.0, ceil(log10(area.y.high / area.y.low) / 4.0)));
    if (area.y.high >= 0.1 && area.y.low <= 0.1)
        chart_level(o->picture, &area, 0.1, "lw 1.2 dt 2 lc rgb '" SVG_INK "'");
    put_errors(o, c);
}
