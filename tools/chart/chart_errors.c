#include "chart/chart_errors.h"

#include "chart/html.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void free_work(chart_errors_work *w)
{
    free(w->all.item);
    free(w->measure);
    free(w->method);
    free(w->which);
    free(w->x);
    free(w->y);
    free(w->front);
}

enum { MOST_SIGNS = 64, OTHER_SIGNS = 7 };

/* Methods, then what the other signs mean. */
static int64_t list_signs(chart_errors_work *w, chart_sign signs[MOST_SIGNS])
{
    bool any[OTHER_SIGNS] = {[3] = w->form->front, [4] = true};
    int64_t n = 0;

    for (int64_t s = 0; s < w->num_methods && n < MOST_SIGNS - OTHER_SIGNS;
         s++) {
        signs[n] = (chart_sign){.colour = chart_colour(s),
                                .mark = chart_mark(s, false)};
        snprintf(signs[n++].name, CHART_WORD, "%.60s", w->method[s]);
    }
    for (int64_t k = 0; k < w->all.count; k++) {
        any[0] = any[0] || w->all.item[k].chosen;
        any[1] = any[1] || w->all.item[k].runner_up;
        any[2] = any[2] || !w->all.item[k].feasible;
    }
    for (int64_t k = 0; k < w->num_measures; k++) {
        chart_area area = {.right = 1.0, .top = 1.0};
        int64_t count[2];

        chart_errors_place(w, &w->measure[k], &area, count);
        any[5] = any[5] || w->measure[k].tolerance > 0.0;
        any[6] = any[6] || chart_errors_uncertain(&area);
    }
    const chart_sign others[] = {
        {.name = "chosen", .colour = SVG_ALARM, .mark = 6},
        {.name = "runner-up", .colour = SVG_INK, .mark = 6},
        {.name = "hollow: misses a limit", .colour = SVG_MUTED, .mark = 6},
        {.name = "Pareto front", .colour = SVG_MUTED, .dash = 1, .wide = 2.0},
        {.name = "equal error", .colour = SVG_PALE, .dash = 1, .wide = 1.0},
        {.name = "tolerance", .colour = SVG_ALARM, .dash = 1, .wide = 1.6},
        {.name = "10 %: model uncertainty",
         .colour = SVG_INK,
         .dash = 2,
         .wide = 1.4},
    };
    for (int k = 0; k < OTHER_SIGNS; k++)
        if (any[k])
            signs[n++] = others[k];
    return n;
}

/* What the picture cannot show, said below it. */
static void put_notes(const chart_errors_work *w, double y)
{
    char text[CHART_WORD] = "";
    size_t used = 0;

    if (w->lifted > 0)
        used = (size_t)snprintf(
            text, sizeof text, "%lld error%s below %.0e %s at the foot. ",
            (long long)w->lifted, w->lifted > 1 ? "s" : "", RECORDS_ROUNDING,
            w->lifted > 1 ? "stand" : "stands");
    if (w->left_out > 0)
        snprintf(text + used, sizeof text - used,
                 "%lld %s not known and left out.", (long long)w->left_out,
                 w->left_out > 1 ? "are" : "is");
    chart_text(w->picture, CHART_LEFT, y, text,
               "font ',11' tc rgb '" SVG_MUTED "'");
}

static void put_table(const chart_errors_work *w)
{
    FILE *file = w->picture->table.file;

    fprintf(file, "method\torder\tto reduce, s\tone simulated second, s");
    for (int64_t m = 0; m < w->num_measures; m++)
        fprintf(file, "\t%s", w->measure[m].title);
    fprintf(file, "\tverdict\n");
    for (int64_t k = 0; k < w->all.count; k++) {
        const record *r = &w->all.item[k];

        html_line(file, r->method);
        fprintf(file, "\t%lld\t%.4g\t%.4g", (long long)r->order, r->cpu,
                r->cost);
        for (int64_t m = 0; m < w->num_measures; m++)
            fprintf(file, "\t%.4g", record_error(r, w->measure[m].name));
        fprintf(file, "\t%s\n",
                r->chosen      ? "chosen"
                : r->runner_up ? "runner-up"
                : r->feasible  ? "meets"
                               : "misses");
    }
}

static ritz_status compose(chart_errors_work *w)
{
    int64_t columns = w->num_measures > 1 ? 2 : 1;
    int64_t rows = (w->num_measures + columns - 1) / columns;
    double wide = (double)columns * CHART_CELL_WIDE;
    chart_sign signs[MOST_SIGNS];
    int64_t count = list_signs(w, signs);
    double foot = 0.0, high = 0.0;

    w->picture->wide = wide;
    foot =
        44.0 + 20.0 * (double)chart_legend(w->picture, count, signs, CHART_LEFT,
                                           0.0, wide - CHART_MARGIN, false);
    high = (w->num_measures > 1 ? CHART_HEAD : 0.0) +
           (double)(rows * CHART_CELL_HIGH) + foot;
    gnuplot_size(w->picture, wide, high);
    fprintf(w->picture->data.file,
            "area\tseries\tstyle\tx\ty\ttip\torder\tmethod\n");
    fprintf(w->picture->plot.file, "set multiplot\n");
    for (int64_t k = 0; k < w->num_measures; k++) {
        int64_t column = k % columns, row = rows - 1 - k / columns;

        RITZ_CHECK(chart_errors_area(w, k, (double)(column * CHART_CELL_WIDE),
                                     foot + (double)(row * CHART_CELL_HIGH)));
        fprintf(w->picture->plot.file, "\n");
    }
    chart_canvas(w->picture);
    if (w->num_measures > 1)
        chart_text(w->picture, CHART_LEFT, high - 18.0, w->form->title,
                   "font ',16' tc rgb '" SVG_INK "'");
    chart_legend(w->picture, count, signs, CHART_LEFT, foot - 14.0,
                 wide - CHART_MARGIN, true);
    put_notes(w, 12.0);
    fprintf(w->picture->plot.file, "plot NaN notitle\nunset multiplot\n");
    put_table(w);
    return RITZ_OK;
}

/* Measures of which every error is rounding have nothing to show. */
static void drop_rounding(chart_errors_work *w)
{
    int64_t kept = 0;

    for (int64_t m = 0; m < w->num_measures; m++)
        if (m == 0 || records_matter(&w->all, &w->measure[m]))
            w->measure[kept++] = w->measure[m];
    w->num_measures = kept;
}

/* Of measures the first @p kept are taken. */
static ritz_status not_there(const chart_errors_work *w, const char *asked,
                             int64_t kept)
{
    char names[16 * RITZ_NAME_SIZE] = "";
    size_t used = 0;

    for (int64_t k = 0; k < w->num_measures; k++) {
        if (k < kept && strcmp(w->measure[k].name, asked) == 0)
            return ritz_fail(RITZ_ERR_ARGUMENT, "--measure '%s' is given twice",
                             asked);
        if (used < sizeof names)
            used += (size_t)snprintf(names + used, sizeof names - used, "%s%s",
                                     used > 0 ? ", " : "", w->measure[k].name);
    }
    return ritz_fail(RITZ_ERR_ARGUMENT, "no record has an error '%s', but %s",
                     asked, names);
}

/* Measures that are asked for, or all. */
static ritz_status choose_measures(chart_errors_work *w, const cli_list *asked)
{
    int64_t kept = 0;

    RITZ_CHECK(records_measures(&w->all, &w->num_measures, &w->measure));
    if (asked->count == 0)
        drop_rounding(w);
    for (int a = 0; a < asked->count; a++) {
        int64_t k = kept;

        while (k < w->num_measures &&
               strcmp(w->measure[k].name, asked->text[a]) != 0)
            k++;
        if (k >= w->num_measures)
            return not_there(w, asked->text[a], kept);
        measure found = w->measure[k];

        w->measure[k] = w->measure[kept];
        w->measure[kept++] = found;
    }
    if (asked->count > 0)
        w->num_measures = kept;
    return RITZ_OK;
}

ritz_status chart_errors_draw(const chart_sources *sources,
                              const chart_wish *wish, const chart_errors *form,
                              gnuplot *out)
{
    ritz_status status = RITZ_OK;
    chart_errors_work w = {.form = form, .picture = out};
    size_t room = 0;
    bool any = false;

    RITZ_TRY(records_select(&sources->runs, wish->subject, &w.all));
    RITZ_TRY(choose_measures(&w, &wish->measure));
    RITZ_TRY(records_methods(&w.all, &w.num_methods, &w.method, &w.which));
    room = (size_t)w.all.count + 1;
    w.x = calloc(room, sizeof *w.x);
    w.y = calloc(room, sizeof *w.y);
    w.front = calloc(room, sizeof *w.front);
    RITZ_FAIL_IF(!w.x || !w.y || !w.front, RITZ_ERR_MEMORY,
                 "no memory for a chart");
    for (int64_t k = 0; k < w.all.count; k++)
        any = any || isfinite(form->x(&w.all.item[k]));
    RITZ_FAIL_IF(!any, RITZ_ERR_ARGUMENT, "no record says what its model cost");
    RITZ_TRY(gnuplot_new(wish->path, wish->keep, out));
    RITZ_TRY(compose(&w));
    RITZ_TRY(gnuplot_draw(out, form->title, form->xlabel));
done:
    free_work(&w);
    return status;
}
