/*
 * What is drawn of a channel, of H or of the singular values s of all of it:
 *
 *     |H_r - H| / max |H|      or      |s_r - s| / max s
 *     |20 log10(|H_r| / |H|)|  or      |20 log10(s_r / s)|
 *
 * at points that both have. Decibels have gaps where a value is 0, or a
 * singular value is nothing but rounding beside the largest.
 */
#include "chart/chart_response.h"

#include "chart/html.h"

#include <complex.h>
#include <math.h>

enum { MOST_PEAKS = 24 };

/* A singular value is rounding below this part of the largest. */
static const double rounding = 1e-12;

bool chart_response_singular(const chart_overlay *o, int64_t c)
{
    return o->output[c] == CHART_SINGULAR;
}

static int64_t lines_of(const chart_overlay *o, int64_t c)
{
    return chart_response_singular(o, c) ? o->curve[0].r->num_singular : 1;
}

/* H of a curve's k-th point in channel c, or one of its singular values. */
static double _Complex value_of(const chart_overlay *o, int64_t which,
                                int64_t k, int64_t c, int64_t line)
{
    const ritz_response *first = o->curve[0].r, *r = o->curve[which].r;
    int64_t i = 0, j = 0;

    if (chart_response_singular(o, c))
        return r->singular[k * r->num_singular + line];
    i = chart_response_name(r->num_outputs, r->output,
                            first->output[o->output[c]]);
    j = chart_response_name(r->num_inputs, r->input, first->input[o->input[c]]);
    return r->H[(k * r->num_outputs + i) * r->num_inputs + j];
}

static double size_of(const chart_overlay *o, int64_t k, int64_t c)
{
    return cabs(value_of(o, 0, k, c, 0));
}

/* What at point k of the first is as good as nothing. */
static double nothing_at(const chart_overlay *o, int64_t k, int64_t c)
{
    return chart_response_singular(o, c) ? rounding * size_of(o, k, c) : 0.0;
}

/* Point of a curve at a frequency of another; -1: it has none there. */
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

/* Errors of curve w at its point k; NaN where the first has none, or none can
   be said. */
static void errors_of(const chart_overlay *o, int64_t w, int64_t k, int64_t c,
                      int64_t line, double most, double error[CHART_STRIPS])
{
    int64_t at = point_at(o->curve[0].r, o->curve[w].r->hertz[k]);
    double _Complex H = 0.0, H_r = 0.0;
    double least = 0.0;

    error[CHART_RELATIVE] = error[CHART_DECIBELS] = nan("");
    if (at < 0 || w == 0)
        return;
    H = value_of(o, 0, at, c, line);
    H_r = value_of(o, w, k, c, line);
    least = nothing_at(o, at, c);
    error[CHART_RELATIVE] = cabs(H_r - H) / most;
    if (cabs(H) > least && cabs(H_r) > least)
        error[CHART_DECIBELS] = fabs(20.0 * log10(cabs(H_r) / cabs(H)));
}

static void widen_by_errors(const chart_overlay *o, int64_t w, int64_t c,
                            chart_extent *e)
{
    const ritz_response *r = o->curve[w].r;
    double error[CHART_STRIPS];

    for (int64_t line = 0; line < lines_of(o, c); line++)
        for (int64_t k = 0; k < r->count; k++) {
            errors_of(o, w, k, c, line, e->most, error);
            e->shared += !isnan(error[CHART_RELATIVE]);
            for (int s = 0; s < CHART_STRIPS; s++) {
                if (error[s] > 0.0)
                    e->best[s] = fmin(e->best[s], error[s]);
                if (error[s] > e->worst[s])
                    e->worst[s] = error[s];
            }
        }
}

chart_extent chart_response_extent(const chart_overlay *o, int64_t c)
{
    const ritz_response *first = o->curve[0].r;
    chart_extent e = {.least = HUGE_VAL, .best = {HUGE_VAL, HUGE_VAL}};

    for (int64_t line = 0; line < lines_of(o, c); line++)
        for (int64_t k = 0; k < first->count; k++) {
            double size = cabs(value_of(o, 0, k, c, line));

            e.most = fmax(e.most, size);
            if (size > nothing_at(o, k, c))
                e.least = fmin(e.least, size);
        }
    e.top = e.most;
    for (int64_t w = 0; chart_response_singular(o, c) && w < o->count; w++)
        if (isfinite(o->curve[w].r->singular_peak[1]))
            e.top = fmax(e.top, o->curve[w].r->singular_peak[1]);
    for (int64_t w = 1; e.most > 0.0 && w < o->count; w++)
        widen_by_errors(o, w, c, &e);
    return e;
}

/* "NaN" leaves a gap in a line, "nan" is bridged. */
static void put_real(FILE *file, double value)
{
    if (isnan(value))
        fprintf(file, "\tNaN");
    else
        fprintf(file, "\t%.9g", value);
}

static void put_line(const chart_overlay *o, int64_t w, int64_t c, int64_t line,
                     double most)
{
    const ritz_response *r = o->curve[w].r;
    FILE *file = o->picture->data.file;
    double error[CHART_STRIPS];

    for (int64_t k = 0; k < r->count; k++) {
        double _Complex H = value_of(o, w, k, c, line);

        errors_of(o, w, k, c, line, most, error);
        fprintf(file, "%lld\t%lld\t%lld", (long long)c, (long long)w,
                (long long)line);
        put_real(file, r->hertz[k]);
        put_real(file, cabs(H));
        put_real(file, chart_response_singular(o, c) ? nan("")
                                                     : carg(H) * 180.0 / M_PI);
        put_real(file, error[CHART_RELATIVE]);
        put_real(file, error[CHART_DECIBELS]);
        fprintf(file, "\t-1\n");
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
        double size = size_of(o, k, c);
        int64_t at = count;

        if (size <= size_of(o, k - 1, c) || size < size_of(o, k + 1, c))
            continue;
        while (at > 0 && size_of(o, peak[at - 1], c) < size)
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

static void begin_row(const chart_overlay *o, int64_t c, double hertz,
                      double value)
{
    const ritz_response *first = o->curve[0].r;
    FILE *table = o->picture->table.file;

    if (chart_response_singular(o, c)) {
        fprintf(table, "singular values");
    } else {
        html_line(table, first->output[o->output[c]]);
        fprintf(table, "/");
        html_line(table, first->input[o->input[c]]);
    }
    fprintf(table, "\t%.6g\t%.5g", hertz, value);
}

static void put_mark(const chart_overlay *o, const int64_t which[3],
                     double hertz, double value, const char *text)
{
    fprintf(o->picture->data.file,
            "%lld\t%lld\t%lld\t%.9g\t%.9g\tNaN\tNaN\tNaN\t%lld\n",
            (long long)which[0], (long long)which[1], (long long)which[2],
            hertz, value, (long long)gnuplot_tip(o->picture, "%s", text));
}

/* A peak of the first, and how far the others are from it. */
static void put_peak(const chart_overlay *o, int64_t c, int64_t k, double most)
{
    const ritz_response *first = o->curve[0].r;
    const int64_t which[3] = {c, -1, 0};
    double error[CHART_STRIPS];
    char text[1500];
    size_t used = (size_t)snprintf(
        text, sizeof text, "peak at %.6g Hz\n%.60s: %s = %.5g", first->hertz[k],
        o->curve[0].name, chart_response_singular(o, c) ? "largest" : "|H|",
        size_of(o, k, c));

    begin_row(o, c, first->hertz[k], size_of(o, k, c));
    for (int64_t w = 1; w < o->count; w++) {
        int64_t at = point_at(o->curve[w].r, first->hertz[k]);

        error[CHART_RELATIVE] = error[CHART_DECIBELS] = nan("");
        if (at >= 0)
            errors_of(o, w, at, c, 0, most, error);
        if (at >= 0 && used < sizeof text)
            used += (size_t)snprintf(
                text + used, sizeof text - used,
                "\n%.60s: error %.2e of the largest, %.2g dB", o->curve[w].name,
                error[CHART_RELATIVE], error[CHART_DECIBELS]);
        fprintf(o->picture->table.file, "\t%.3e\t%.3g", error[CHART_RELATIVE],
                error[CHART_DECIBELS]);
    }
    fprintf(o->picture->table.file, "\n");
    put_mark(o, which, first->hertz[k], size_of(o, k, c), text);
}

/* The largest singular value between points, as stored beside them. */
static void put_true_peak(const chart_overlay *o, int64_t w, int64_t c,
                          const chart_extent *e)
{
    const double *own = o->curve[w].r->singular_peak;
    const double *first = o->curve[0].r->singular_peak;
    const int64_t which[3] = {c, -2, w};
    char text[400];

    if (!(own[1] > 0.0))
        return;
    if (isinf(own[1]))
        snprintf(text, sizeof text,
                 "%.60s: infinite\na pole at %.6g Hz is not damped",
                 o->curve[w].name, own[0]);
    else
        snprintf(text, sizeof text,
                 "%.60s: largest of all\n%.6g at %.6g Hz, between points too",
                 o->curve[w].name, own[1], own[0]);
    put_mark(o, which, own[0], isinf(own[1]) ? e->top : own[1], text);
    begin_row(o, c, own[0], own[1]);
    for (int64_t i = 1; i < o->count; i++) {
        bool known = i == w && first[1] > 0.0 && isfinite(first[1] + own[1]);

        fprintf(o->picture->table.file, "\t%.3e\t%.3g",
                known ? fabs(own[1] - first[1]) / first[1] : nan(""),
                known ? fabs(20.0 * log10(own[1] / first[1])) : nan(""));
    }
    fprintf(o->picture->table.file, "\n");
}

void chart_response_data(const chart_overlay *o, int64_t c,
                         const chart_extent *e)
{
    double most = e->most > 0.0 ? e->most : 1.0;
    int64_t peak[MOST_PEAKS];
    int64_t count = find_peaks(o, c, peak);

    for (int64_t w = 0; w < o->count; w++)
        for (int64_t line = 0; line < lines_of(o, c); line++)
            put_line(o, w, c, line, most);
    for (int64_t p = 0; p < count; p++)
        put_peak(o, c, peak[p], most);
    fputc('\n', o->picture->data.file);
    for (int64_t w = 0; chart_response_singular(o, c) && w < o->count; w++)
        put_true_peak(o, w, c, e);
    fputc('\n', o->picture->data.file);
}
