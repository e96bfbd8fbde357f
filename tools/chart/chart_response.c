/*
 * Responses over each other, and the difference of each from the first: of a
 * channel H, or of the singular values s of the transfer function,
 *
 *     |H_r - H| / max |H|      or      |s_r - s| / max s
 *     |20 log10(|H_r| / |H|)|  or      |20 log10(s_r / s)|
 *
 * at frequencies that both have. Decibels have gaps where a value is 0, or a
 * singular value is rounding relative to the largest.
 */
#include "chart/chart.h"

#include "base/alloc.h"
#include "base/text.h"

#include <complex.h>
#include <math.h>
#include <string.h>

enum {
    MOST_RESPONSES = 12,
    MOST_CHANNELS = 4,
    MOST_PEAKS = 24,
    CELL_WIDE = 490,
    CELL_HIGH = 470,  /* with one strip of errors or none */
    STRIP_HIGH = 153, /* what another strip adds */
    PANEL_WIDE = 404,
};

/* How errors are measured; each has a strip below the magnitudes. */
enum { RELATIVE, DECIBELS, STRIPS };

/* A singular value is rounding below this part of the largest. */
static const double rounding = 1e-12;

/* A channel, and the ends of its axes; the template is given the doubles. */
typedef struct channel {
    int64_t lines; /* one, or as many as there are singular values */
    int64_t place[MOST_RESPONSES]; /* of each response: its index in H of a
                                      point */
    char title[2 * PICTURE_WORD];  /* "tip / torque", then errors */
    double *size;    /* of the first response at each point, the largest */
    double singular; /* whether it is that of singular values */
    double shared;   /* points in common with the first response */
    chart_range y, strip[STRIPS];
    double most, least; /* of magnitudes above 0 */
    double top;         /* the same as most, or a true peak above it */
    double worst[STRIPS], best[STRIPS]; /* of errors above 0 */
} channel;

typedef struct overlay {
    int64_t count;
    const ritz_response *curve[MOST_RESPONSES];
    const char *name[MOST_RESPONSES];
    int64_t num_channels;
    channel channel[MOST_CHANNELS];
    int64_t passed; /* channels for which there is no room */
    bool strip[STRIPS];
    picture *picture;
} overlay;

/* --- what is drawn -------------------------------------------------------- */

static ritz_status take_response(const chart_file *file, overlay *o)
{
    const ritz_response *r = &file->model.response, *first = o->curve[0];

    RITZ_REFUSE_IF(o->count == MOST_RESPONSES, RITZ_ERR_ARGUMENT,
                   "more than %d responses cannot be told apart",
                   (int)MOST_RESPONSES);
    RITZ_REFUSE_IF(r->count < 2, RITZ_ERR_ARGUMENT,
                   "'%s' has fewer than two points", file->path);
    RITZ_CHECK(chart_check_names(file->path, "output", r->num_outputs,
                                 r->output, first->num_outputs, first->output));
    RITZ_CHECK(chart_check_names(file->path, "input", r->num_inputs, r->input,
                                 first->num_inputs, first->input));
    o->name[o->count] = ritz_path_name(file->path);
    o->curve[o->count++] = r;
    return RITZ_OK;
}

/* The channel of singular values: all files must hold as many. */
static ritz_status add_singular(overlay *o)
{
    const ritz_response *first = o->curve[0];

    for (int64_t w = 0; w < o->count; w++) {
        const ritz_response *r = o->curve[w];

        RITZ_REFUSE_IF(r->num_singular == 0, RITZ_ERR_ARGUMENT,
                       "'%s' holds no singular values: ritz-frf "
                       "--singular-values stores them",
                       o->name[w]);
        RITZ_REFUSE_IF(r->num_inputs != first->num_inputs ||
                           r->num_outputs != first->num_outputs,
                       RITZ_ERR_ARGUMENT,
                       "'%s' has more inputs or outputs than '%s', their "
                       "singular values do not compare",
                       o->name[w], o->name[0]);
    }
    o->channel[o->num_channels++] = (channel){.lines = first->num_singular,
                                              .title = "singular values",
                                              .singular = 1.0};
    return RITZ_OK;
}

/* The channel of an output and an input of the first response; all have it. */
static void add_pair(overlay *o, int64_t output, int64_t input)
{
    const ritz_response *first = o->curve[0];
    channel *c = &o->channel[o->num_channels++];

    *c = (channel){.lines = 1};
    snprintf(c->title, sizeof c->title, "%s / %s", first->output[output],
             first->input[input]);
    for (int64_t w = 0; w < o->count; w++) {
        const ritz_response *r = o->curve[w];

        c->place[w] =
            ritz_name_index(r->num_outputs, r->output, first->output[output]) *
                r->num_inputs +
            ritz_name_index(r->num_inputs, r->input, first->input[input]);
    }
}

static ritz_status add_channel(overlay *o, const char *text)
{
    const ritz_response *r = o->curve[0];
    const char *slash = strchr(text, '/');
    char output[RITZ_NAME_SIZE] = "";
    int64_t i = -1, j = -1;

    if (slash && slash - text < RITZ_NAME_SIZE) {
        snprintf(output, sizeof output, "%.*s", (int)(slash - text), text);
        i = ritz_name_index(r->num_outputs, r->output, output);
        j = ritz_name_index(r->num_inputs, r->input, slash + 1);
    }
    RITZ_REFUSE_IF(o->num_channels == MOST_CHANNELS, RITZ_ERR_ARGUMENT,
                   "more than %d channels do not fit", (int)MOST_CHANNELS);
    if (strcmp(text, CHART_SINGULAR_WORD) == 0)
        return add_singular(o);
    RITZ_REFUSE_IF(i < 0 || j < 0, RITZ_ERR_ARGUMENT,
                   "no channel '%s': say OUTPUT/INPUT, such as '%s/%s', or "
                   "'" CHART_SINGULAR_WORD "'",
                   text, r->output[0], r->input[0]);
    add_pair(o, i, j);
    return RITZ_OK;
}

static ritz_status choose_channels(const cli_list *asked, overlay *o)
{
    const ritz_response *r = o->curve[0];

    RITZ_REFUSE_IF(r->num_outputs < 1 || r->num_inputs < 1, RITZ_ERR_ARGUMENT,
                   "'%s' has no channel", o->name[0]);
    for (int k = 0; k < asked->count; k++)
        RITZ_CHECK(add_channel(o, asked->text[k]));
    for (int64_t c = 0; asked->count == 0 && c < r->num_outputs * r->num_inputs;
         c++)
        if (o->num_channels == MOST_CHANNELS)
            o->passed++;
        else
            add_pair(o, c / r->num_inputs, c % r->num_inputs);
    return RITZ_OK;
}

/* --- values and errors ---------------------------------------------------- */

/* H of a curve's k-th point in a channel, or one of its singular values. */
static double _Complex value_of(const overlay *o, const channel *c,
                                int64_t which, int64_t k, int64_t line)
{
    const ritz_response *r = o->curve[which];

    if (c->singular > 0.0)
        return r->singular[k * r->num_singular + line];
    return r->H[k * r->num_outputs * r->num_inputs + c->place[which]];
}

/* Values at point k of the first response are rounding up to this. */
static double nothing_at(const channel *c, int64_t k)
{
    return c->singular > 0.0 ? rounding * c->size[k] : 0.0;
}

/* Index of the point at a frequency; -1: the response has none there. */
static int64_t find_point(const ritz_response *r, double hertz)
{
    int64_t low = 0, high = r->count;

    while (low < high) {
        int64_t middle = low + (high - low) / 2;

        if (r->hertz[middle] < hertz * (1.0 - rounding))
            low = middle + 1;
        else
            high = middle;
    }
    return low < r->count && r->hertz[low] <= hertz * (1.0 + rounding) ? low
                                                                       : -1;
}

/* Errors of curve w at its point k; NaN where the first has no such point, or
   a value is rounding. */
static void measure_errors(const overlay *o, const channel *c, int64_t w,
                           int64_t k, int64_t line, double error[STRIPS])
{
    const int64_t at = find_point(o->curve[0], o->curve[w]->hertz[k]);
    double _Complex H = 0.0, H_r = 0.0;
    double least = 0.0;

    error[RELATIVE] = error[DECIBELS] = nan("");
    if (at < 0 || w == 0)
        return;
    H = value_of(o, c, 0, at, line);
    H_r = value_of(o, c, w, k, line);
    least = nothing_at(c, at);
    error[RELATIVE] = cabs(H_r - H) / (c->most > 0.0 ? c->most : 1.0);
    if (cabs(H) > least && cabs(H_r) > least)
        error[DECIBELS] = fabs(20.0 * log10(cabs(H_r) / cabs(H)));
}

/* Whole decades that hold both ends, at most fourteen. */
static chart_range find_decades(double least, double most)
{
    most = most > 0.0 ? most : 1.0;
    least = least < most ? least : most / 10.0;
    return (chart_range){pow(10.0, floor(log10(fmax(least, 1e-14 * most)))),
                         pow(10.0, ceil(log10(1.01 * most)))};
}

/* Magnitudes of the first response, by which errors are measured. */
static void find_extent(const overlay *o, channel *c)
{
    for (int64_t k = 0; k < o->curve[0]->count; k++)
        c->size[k] = cabs(value_of(o, c, 0, k, 0));
    c->least = c->best[RELATIVE] = c->best[DECIBELS] = HUGE_VAL;
    for (int64_t line = 0; line < c->lines; line++)
        for (int64_t k = 0; k < o->curve[0]->count; k++) {
            double size = cabs(value_of(o, c, 0, k, line));

            c->most = fmax(c->most, size);
            if (size > nothing_at(c, k))
                c->least = fmin(c->least, size);
        }
    c->top = c->most;
    for (int64_t w = 0; c->singular > 0.0 && w < o->count; w++)
        if (isfinite(o->curve[w]->singular_peak[1]))
            c->top = fmax(c->top, o->curve[w]->singular_peak[1]);
}

/* --- data ----------------------------------------------------------------- */

/* Frequencies over decades get a logarithmic axis. */
static bool is_decades(const ritz_response *r)
{
    return r->hertz[0] > 0.0 && r->hertz[r->count - 1] >= 10.0 * r->hertz[0];
}

/* Pixel column of a frequency in a panel. */
static int64_t column_of(const ritz_response *r, double hertz)
{
    const double low = r->hertz[0], high = r->hertz[r->count - 1];
    const double part = is_decades(r) ? log(hertz / low) / log(high / low)
                                      : (hertz - low) / (high - low);

    return fabs(part) < 10.0 ? (int64_t)floor(PANEL_WIDE * part) : -1;
}

/* "NaN" leaves a gap in a line, "nan" is bridged. */
static void put_real(FILE *file, double value)
{
    if (isnan(value))
        fprintf(file, "\tNaN");
    else
        fprintf(file, "\t%.9g", value);
}

/* A point of a line: magnitude, degrees, errors. */
enum { VALUES = 2 + STRIPS, FEW = 2 * VALUES };

typedef struct point {
    double value[VALUES];
    bool keep;
} point;

/*
 * Thin the points of a line in one column of pixels: the first, the last, the
 * least and largest of magnitude and errors are kept, and gaps.
 */
static void keep_extremes(int64_t count, point *p)
{
    for (int64_t k = 0; k < count; k++)
        p[k].keep =
            count <= FEW || k == 0 || k == count - 1 ||
            isnan(p[k].value[2 + DECIBELS]) != isnan(p[0].value[2 + DECIBELS]);
    for (int v = 0; v < VALUES; v++) {
        int64_t least = 0, most = 0;

        for (int64_t k = 0; k < count; k++) {
            least = p[k].value[v] < p[least].value[v] ? k : least;
            most = p[k].value[v] > p[most].value[v] ? k : most;
        }
        p[least].keep = p[most].keep = true;
    }
}

/* The points of a line and, if anything is not 0, how far errors reach. */
static void measure_line(const overlay *o, channel *c, int64_t w, int64_t line,
                         point *all)
{
    for (int64_t k = 0; k < o->curve[w]->count; k++) {
        const double _Complex H = value_of(o, c, w, k, line);
        double *error = all[k].value + 2;

        all[k].value[0] = cabs(H);
        all[k].value[1] = c->singular > 0.0 ? nan("") : carg(H) * 180.0 / M_PI;
        measure_errors(o, c, w, k, line, error);
        c->shared += c->most > 0.0 && !isnan(error[RELATIVE]);
        for (int s = 0; s < STRIPS && c->most > 0.0; s++) {
            if (error[s] > 0.0)
                c->best[s] = fmin(c->best[s], error[s]);
            c->worst[s] = fmax(c->worst[s], error[s]);
        }
    }
}

static ritz_status put_line(const overlay *o, channel *c, int64_t w,
                            int64_t line)
{
    const ritz_response *r = o->curve[w];
    FILE *file = o->picture->data.file;
    RITZ_OWN_ARRAY point *all = NULL;

    RITZ_CHECK_NEW(all, r->count);
    measure_line(o, c, w, line, all);
    for (int64_t k = 0, end = 0; k < r->count; k = end) {
        const int64_t column = column_of(o->curve[0], r->hertz[k]);

        while (end < r->count &&
               column_of(o->curve[0], r->hertz[end]) == column)
            end++;
        keep_extremes(end - k, all + k);
    }
    for (int64_t k = 0; k < r->count; k++) {
        if (!all[k].keep)
            continue;
        fprintf(file, "%ld\t%ld\t%ld", (c - o->channel), w, line);
        put_real(file, r->hertz[k]);
        for (int v = 0; v < VALUES; v++)
            put_real(file, all[k].value[v]);
        fprintf(file, "\t\n");
    }
    fputc('\n', file);
    return RITZ_OK;
}

/* Peaks of the first response, largest first. */
static int64_t find_peaks(int64_t points, const double *size,
                          int64_t peak[MOST_PEAKS])
{
    int64_t count = 0;

    for (int64_t k = 1; k < points - 1; k++) {
        int64_t at = count;

        if (size[k] <= size[k - 1] || size[k] < size[k + 1])
            continue;
        while (at > 0 && size[peak[at - 1]] < size[k])
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

/* Begin the rows of a mark: of the data up to its tooltip, of the table up to
   errors. */
static void begin_rows(const overlay *o, const channel *c, int which, int64_t w,
                       double hertz, double drawn, double value)
{
    FILE *table = o->picture->table.file;

    fprintf(o->picture->data.file, "%ld\t%d\t%ld\t%.9g\t%.9g\tNaN\tNaN\tNaN\t",
            (c - o->channel), which, w, hertz, drawn);
    html_line(table, c->title);
    fprintf(table, "\t%.6g\t%.5g", hertz, value);
}

static void end_rows(const overlay *o)
{
    fputc('\n', o->picture->data.file);
    fputc('\n', o->picture->table.file);
}

/* A peak of the first response and the errors of the others there. */
static void put_peak(const overlay *o, const channel *c, int64_t k)
{
    const double hertz = o->curve[0]->hertz[k], size = c->size[k];
    double error[STRIPS];
    char others[1000] = "";

    begin_rows(o, c, -1, 0, hertz, size, size);
    for (int64_t w = 1; w < o->count; w++) {
        int64_t at = find_point(o->curve[w], hertz);

        error[RELATIVE] = error[DECIBELS] = nan("");
        if (at >= 0) {
            measure_errors(o, c, w, at, 0, error);
            sink_append(others, sizeof others,
                        "\n%.40s: error %.2e of the largest, %.2g dB",
                        o->name[w], error[RELATIVE], error[DECIBELS]);
        }
        fprintf(o->picture->table.file, "\t%.3e\t%.3g", error[RELATIVE],
                error[DECIBELS]);
    }
    picture_tip(o->picture, "peak at %.6g Hz\n%.60s: %s = %.5g%s", hertz,
                o->name[0], c->singular > 0.0 ? "largest" : "|H|", size,
                others);
    end_rows(o);
}

/* The largest singular value between points, which the file holds. */
static void put_true_peak(const overlay *o, const channel *c, int64_t w)
{
    const double *own = o->curve[w]->singular_peak;
    const double *first = o->curve[0]->singular_peak;

    if (!(own[1] > 0.0))
        return;
    begin_rows(o, c, -2, w, own[0], isinf(own[1]) ? c->top : own[1], own[1]);
    if (isinf(own[1]))
        picture_tip(o->picture,
                    "%.60s: infinite\na pole at %.6g Hz is not damped",
                    o->name[w], own[0]);
    else
        picture_tip(o->picture,
                    "%.60s: largest of all\n%.6g at %.6g Hz, between points "
                    "too",
                    o->name[w], own[1], own[0]);
    for (int64_t i = 1; i < o->count; i++) {
        bool known = i == w && first[1] > 0.0 && isfinite(first[1] + own[1]);

        fprintf(o->picture->table.file, "\t%.3e\t%.3g",
                known ? fabs(own[1] - first[1]) / first[1] : nan(""),
                known ? fabs(20.0 * log10(own[1] / first[1])) : nan(""));
    }
    end_rows(o);
}

static ritz_status put_channel(const overlay *o, channel *c)
{
    RITZ_OWN_ARRAY double *size = NULL;
    int64_t peak[MOST_PEAKS], count = 0;

    RITZ_CHECK_NEW(size, o->curve[0]->count);
    c->size = size;
    find_extent(o, c);
    count = find_peaks(o->curve[0]->count, size, peak);
    for (int64_t w = 0; w < o->count; w++)
        for (int64_t line = 0; line < c->lines; line++)
            RITZ_CHECK(put_line(o, c, w, line));
    for (int64_t p = 0; p < count; p++)
        put_peak(o, c, peak[p]);
    fputc('\n', o->picture->data.file);
    for (int64_t w = 0; c->singular > 0.0 && w < o->count; w++)
        put_true_peak(o, c, w);
    fputc('\n', o->picture->data.file);
    c->y = find_decades(c->least, c->top);
    for (int s = 0; s < STRIPS; s++)
        c->strip[s] = find_decades(c->best[s], c->worst[s]);
    return RITZ_OK;
}

/* --- the picture ---------------------------------------------------------- */

static void put_heads(const overlay *o)
{
    FILE *table = o->picture->table.file;

    fprintf(o->picture->data.file,
            "channel\tresponse\tvalue\thertz\tmagnitude\tdegrees\terror\t"
            "decibels\ttip\n");
    fprintf(table, "channel\tpeak, Hz\tvalue of ");
    html_line(table, o->name[0]);
    for (int64_t w = 1; w < o->count; w++) {
        fprintf(table, "\terror of ");
        html_line(table, o->name[w]);
        fprintf(table, "\tthe same in dB");
    }
    fprintf(table, "\n");
}

static void add_signs(const overlay *o)
{
    bool singular = false, many = false, peak = false;

    for (int64_t w = 0; w < o->count; w++) {
        const bool under = w == 0 && o->count > 1;

        picture_add_sign(
            o->picture,
            (picture_sign){.role = under ? "the reference" : NULL,
                           .colour =
                               under ? "pale" : svg_series(w > 0 ? w - 1 : 0),
                           .dash = (int)w,
                           .wide = under ? 6.0 : 1.8},
            "%.80s", o->name[w]);
        peak = peak || o->curve[w]->singular_peak[1] > 0.0;
        many = many || o->curve[w]->num_singular > 1;
    }
    for (int64_t c = 0; c < o->num_channels; c++)
        singular = singular || o->channel[c].singular > 0.0;
    if (singular && many)
        picture_add_sign(o->picture,
                         (picture_sign){.colour = "muted", .wide = 0.8},
                         "thin: all but the largest");
    if (singular && peak)
        picture_add_sign(o->picture,
                         (picture_sign){.colour = "muted", .mark = 12},
                         "peak between points");
}

/* "tip / torque: error at most 0.31 %, 0.027 dB" */
static void say_title(const overlay *o, channel *c)
{
    const bool relative = o->strip[RELATIVE], decibels = o->strip[DECIBELS];

    if (c->shared == 0.0)
        return;
    sink_append(c->title, sizeof c->title, ": %s at most %s%s",
                relative ? "error" : "difference",
                relative ? chart_say_error(c->worst[RELATIVE]).text : "",
                relative && decibels ? ", " : "");
    if (decibels)
        sink_append(c->title, sizeof c->title,
                    "%.2g\xc2\xa0"
                    "dB",
                    c->worst[DECIBELS]);
}

/* Variables of the template: those of all channels, then of each. */
static void give_channels(const overlay *o)
{
    const ritz_response *r = o->curve[0];
    const double low = r->hertz[0], high = r->hertz[r->count - 1];
    const channel *all = o->channel;
    picture *p = o->picture;
    const int64_t n = o->num_channels, across = n > 1 ? 2 : 1;
    const int64_t down = (n + across - 1) / across;
    const int strips = o->strip[RELATIVE] + o->strip[DECIBELS];
    const int tall = CELL_HIGH + (strips > 1 ? STRIP_HIGH : 0);

    p->wide = (double)(across * CELL_WIDE);
    p->body = (double)(down * tall);
    fprintf(p->given.file,
            "channels = %ld\nacross = %ld\ntall = %d\ncurves = %ld\n"
            "strips = %d\ndecibels = %d\nx_low = %.9g\nx_high = %.9g\n"
            "x_log = %d\n",
            n, across, tall, o->count, strips, o->strip[DECIBELS], low,
            high > low ? high : low + 1.0, is_decades(r));
    picture_give_texts(p, "title", n, all->title, sizeof *all);
    picture_give_reals(p,
                       "singular,shared,y_low,y_high,error_low,error_high,"
                       "decibel_low,decibel_high",
                       n, &all->singular, sizeof *all);
}

ritz_status chart_response(const chart_sources *sources,
                           const chart_request *request, picture *p)
{
    overlay o = {.curve = {&sources->file->model.response}, .picture = p};
    const char *error = request->error ? request->error : "relative";

    o.strip[RELATIVE] = strcmp(error, "decibels") != 0;
    o.strip[DECIBELS] = strcmp(error, "relative") != 0;
    for (int64_t k = 0; k < sources->count; k++)
        RITZ_CHECK(take_response(&sources->file[k], &o));
    RITZ_CHECK(choose_channels(&request->channel, &o));
    put_heads(&o);
    for (int64_t k = 0; k < o.num_channels; k++) {
        channel *c = &o.channel[k];

        RITZ_CHECK(put_channel(&o, c));
        say_title(&o, c);
        c->shared = c->shared > 0.0;
    }
    give_channels(&o);
    add_signs(&o);
    if (o.passed > 0)
        snprintf(p->note, sizeof p->note,
                 "%ld more channels are not drawn: choose by --channel",
                 o.passed);
    return picture_draw(p, "response.gp", "Frequency responses",
                        "magnitudes or singular values over each other, and "
                        "below them how far they are from the first");
}
