/* Responses over each other, and how far each is from the first. */
#include "chart/chart_response.h"

#include "chart/html.h"

#include <string.h>

/* Curves, and what two more signs mean. */
enum { MOST_SIGNS = CHART_MOST_RESPONSES + 2 };

int64_t chart_response_name(int64_t count, char (*name)[RITZ_NAME_SIZE],
                            const char *wanted)
{
    for (int64_t k = 0; k < count; k++)
        if (strcmp(name[k], wanted) == 0)
            return k;
    return -1;
}

static ritz_status take_responses(const chart_sources *sources,
                                  chart_overlay *o)
{
    const ritz_response *first = NULL;

    for (int64_t k = 0; k < sources->count; k++) {
        const chart_file *file = &sources->file[k];
        const ritz_response *r = &file->model.response;

        if (file->holds != CHART_RESPONSE)
            continue;
        RITZ_REFUSE_IF(o->count == CHART_MOST_RESPONSES, RITZ_ERR_ARGUMENT,
                       "more than %d responses cannot be told apart",
                       (int)CHART_MOST_RESPONSES);
        RITZ_REFUSE_IF(r->count < 2, RITZ_ERR_ARGUMENT,
                       "'%s' has fewer than two points", file->path);
        first = first ? first : r;
        for (int64_t i = 0; i < first->num_outputs; i++)
            RITZ_REFUSE_IF(chart_response_name(r->num_outputs, r->output,
                                               first->output[i]) < 0,
                           RITZ_ERR_ARGUMENT, "'%s' has no output '%s'",
                           file->path, first->output[i]);
        for (int64_t i = 0; i < first->num_inputs; i++)
            RITZ_REFUSE_IF(chart_response_name(r->num_inputs, r->input,
                                               first->input[i]) < 0,
                           RITZ_ERR_ARGUMENT, "'%s' has no input '%s'",
                           file->path, first->input[i]);
        o->curve[o->count++] =
            (chart_curve){.r = r, .name = chart_base(file->path)};
    }
    RITZ_REFUSE_IF(o->count == 0, RITZ_ERR_ARGUMENT, "there is no response");
    return RITZ_OK;
}

/* Singular values, of which all files hold as many. */
static ritz_status add_singular(chart_overlay *o)
{
    const ritz_response *first = o->curve[0].r;

    for (int64_t w = 0; w < o->count; w++) {
        const ritz_response *r = o->curve[w].r;

        RITZ_REFUSE_IF(r->num_singular == 0, RITZ_ERR_ARGUMENT,
                       "'%s' holds no singular values: ritz-frf "
                       "--singular-values stores them",
                       o->curve[w].name);
        RITZ_REFUSE_IF(r->num_inputs != first->num_inputs ||
                           r->num_outputs != first->num_outputs,
                       RITZ_ERR_ARGUMENT,
                       "'%s' has more inputs or outputs than '%s', their "
                       "singular values do not compare",
                       o->curve[w].name, o->curve[0].name);
    }
    o->output[o->num_channels] = CHART_SINGULAR;
    o->input[o->num_channels++] = CHART_SINGULAR;
    return RITZ_OK;
}

static ritz_status add_channel(chart_overlay *o, const char *text)
{
    const ritz_response *r = o->curve[0].r;
    const char *slash = strchr(text, '/');
    char output[RITZ_NAME_SIZE] = "";
    int64_t i = -1, j = -1;

    if (slash && slash - text < RITZ_NAME_SIZE) {
        snprintf(output, sizeof output, "%.*s", (int)(slash - text), text);
        i = chart_response_name(r->num_outputs, r->output, output);
        j = chart_response_name(r->num_inputs, r->input, slash + 1);
    }
    RITZ_REFUSE_IF(o->num_channels == CHART_MOST_CHANNELS, RITZ_ERR_ARGUMENT,
                   "more than %d channels do not fit",
                   (int)CHART_MOST_CHANNELS);
    if (strcmp(text, CHART_SINGULAR_WORD) == 0)
        return add_singular(o);
    RITZ_REFUSE_IF(i < 0 || j < 0, RITZ_ERR_ARGUMENT,
                   "no channel '%s': say OUTPUT/INPUT, such as '%s/%s', or "
                   "'" CHART_SINGULAR_WORD "'",
                   text, r->output[0], r->input[0]);
    o->output[o->num_channels] = i;
    o->input[o->num_channels++] = j;
    return RITZ_OK;
}

static ritz_status choose_channels(const cli_list *asked, chart_overlay *o)
{
    const ritz_response *r = o->curve[0].r;

    if (!r)
        return RITZ_OK;
    RITZ_REFUSE_IF(r->num_outputs < 1 || r->num_inputs < 1, RITZ_ERR_ARGUMENT,
                   "'%s' has no channel", o->curve[0].name);
    for (int k = 0; k < asked->count; k++)
        RITZ_CHECK(add_channel(o, asked->text[k]));
    for (int64_t c = 0; asked->count == 0 && c < r->num_outputs * r->num_inputs;
         c++) {
        if (o->num_channels == CHART_MOST_CHANNELS) {
            o->passed++;
            continue;
        }
        o->output[o->num_channels] = c / r->num_inputs;
        o->input[o->num_channels++] = c % r->num_inputs;
    }
    return RITZ_OK;
}

static int64_t list_signs(const chart_overlay *o, chart_sign signs[MOST_SIGNS])
{
    int64_t count = o->count;
    bool singular = false, many = false, peak = false;

    for (int64_t w = 0; w < o->count; w++) {
        bool under = w == 0 && o->count > 1;

        signs[w] = (chart_sign){
            .colour = under ? SVG_PALE : chart_colour(w > 0 ? w - 1 : 0),
            .dash = (int)(w < 2 ? 1 : w),
            .wide = under ? 6.0 : 0.0};
        snprintf(signs[w].name, CHART_WORD, "%.80s%s", o->curve[w].name,
                 under ? ", the reference" : "");
        peak = peak || o->curve[w].r->singular_peak[1] > 0.0;
        many = many || o->curve[w].r->num_singular > 1;
    }
    for (int64_t c = 0; c < o->num_channels; c++)
        singular = singular || chart_response_singular(o, c);
    if (singular && many)
        signs[count++] = (chart_sign){.name = "thin: all but the largest",
                                      .colour = SVG_MUTED,
                                      .dash = 1,
                                      .wide = 0.8};
    if (singular && peak)
        signs[count++] = (chart_sign){
            .name = "peak between points", .colour = SVG_MUTED, .mark = 12};
    return count;
}

static void put_head(const chart_overlay *o)
{
    FILE *table = o->picture->table.file;

    fprintf(o->picture->data.file,
            "channel\tresponse\tvalue\thertz\tmagnitude\tdegrees\terror\t"
            "decibels\ttip\n");
    fprintf(table, "channel\tpeak, Hz\tvalue of ");
    html_line(table, o->curve[0].name);
    for (int64_t w = 1; w < o->count; w++) {
        fprintf(table, "\terror of ");
        html_line(table, o->curve[w].name);
        fprintf(table, "\tthe same in dB");
    }
    fprintf(table, "\n");
}

static ritz_status compose(const chart_overlay *o)
{
    int64_t columns = o->num_channels > 1 ? 2 : 1;
    int64_t rows = (o->num_channels + columns - 1) / columns;
    chart_sign signs[MOST_SIGNS];
    int64_t count = list_signs(o, signs);
    double wide = (double)columns * OVERLAY_WIDE, foot = 0.0;

    foot = 30.0 + 20.0 * (double)chart_legend(o->picture, count, signs,
                                              OVERLAY_LEFT, 0.0,
                                              wide - OVERLAY_RIGHT, false);
    foot += o->passed > 0 ? 16.0 : 0.0;
    gnuplot_size(o->picture, wide, (double)rows * o->high + foot);
    put_head(o);
    fprintf(o->picture->plot.file, "set multiplot\n");
    for (int64_t c = 0; c < o->num_channels; c++) {
        int64_t column = c % columns, row = rows - 1 - c / columns;

        chart_response_channel(o, c, (double)(column * OVERLAY_WIDE),
                               foot + (double)row * o->high);
    }
    chart_canvas(o->picture);
    chart_legend(o->picture, count, signs, OVERLAY_LEFT, foot - 14.0,
                 wide - OVERLAY_RIGHT, true);
    if (o->passed > 0) {
        char text[CHART_WORD];

        snprintf(text, sizeof text,
                 "%lld more channels are not drawn: choose by --channel",
                 (long long)o->passed);
        chart_text(o->picture, OVERLAY_LEFT, 10.0, text,
                   "font ',11' tc rgb '" SVG_MUTED "'");
    }
    fprintf(o->picture->plot.file, "plot NaN notitle\nunset multiplot\n");
    return gnuplot_draw(o->picture, "Frequency responses",
                        "magnitudes or singular values over each other, and "
                        "below them how far they are from the first");
}

ritz_status chart_response(const chart_sources *sources, const chart_wish *wish,
                           gnuplot *out)
{
    chart_overlay o = {.picture = out, .high = OVERLAY_HIGH};
    const char *error = wish->error ? wish->error : "relative";

    o.strip[CHART_RELATIVE] = strcmp(error, "decibels") != 0;
    o.strip[CHART_DECIBELS] = strcmp(error, "relative") != 0;
    if (o.strip[CHART_RELATIVE] && o.strip[CHART_DECIBELS])
        o.high += OVERLAY_STRIP;
    RITZ_CHECK(take_responses(sources, &o));
    RITZ_CHECK(choose_channels(&wish->channel, &o));
    RITZ_CHECK(gnuplot_new(wish->path, wish->keep, out));
    return compose(&o);
}
