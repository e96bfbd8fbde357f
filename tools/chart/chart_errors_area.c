/* One area of a chart of errors: points, lines, levels, words. */
#include "chart/chart_errors.h"

#include "chart/html.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TOP = 42, BOTTOM = 58 };

/* Styles of points, as the data name them. */
enum { MEETS, MISSES, CHOSEN, RUNNER_UP, ON_FRONT, ON_LINE };

void chart_errors_tip(const record *r, const measure *m, size_t size, char *out)
{
    char error[32], word[32];
    size_t used = 0;

    chart_say_error(record_error(r, m->name), error);
    used = (size_t)snprintf(out, size, "%.60s, order %lld\n%s: %s (%.4g)",
                            r->method, (long long)r->order, m->title, error,
                            record_error(r, m->name));
    if (isfinite(r->cpu) && used < size) {
        chart_say_seconds(r->cpu, word);
        used +=
            (size_t)snprintf(out + used, size - used, "\nto reduce: %s", word);
    }
    if (isfinite(r->cost) && used < size) {
        chart_say_seconds(r->cost, word);
        used += (size_t)snprintf(out + used, size - used,
                                 "\none simulated second: %s", word);
    }
    if (r->tolerance && used < size)
        snprintf(out + used, size - used, "\n%s%s",
                 r->feasible ? "meets the tolerance" : "misses the tolerance",
                 r->chosen      ? "; chosen"
                 : r->runner_up ? "; runner-up"
                                : "");
}

/* What nothing beats: no other point is left of it and as low. */
static void find_front(chart_errors_work *w)
{
    for (int64_t k = 0; k < w->all.count; k++) {
        bool best = !isnan(w->x[k]) && !w->all.item[k].incomplete;

        for (int64_t i = 0; best && i < w->all.count; i++) {
            if (isnan(w->x[i]) || i == k || w->all.item[i].incomplete)
                continue;
            best = !(w->x[i] <= w->x[k] && w->y[i] <= w->y[k] &&
                     (w->x[i] < w->x[k] || w->y[i] < w->y[k] || i < k));
        }
        w->front[k] = best;
    }
}

void chart_errors_place(chart_errors_work *w, const measure *m,
                        chart_area *area, int64_t count[2])
{
    count[CHART_LIFTED] = count[CHART_LEFT_OUT] = 0;
    for (int64_t k = 0; k < w->all.count; k++) {
        w->x[k] = w->form->x(&w->all.item[k]);
        w->y[k] = record_error(&w->all.item[k], m->name);
        if (!isfinite(w->y[k]) || !isfinite(w->x[k]) ||
            (w->form->seconds && !(w->x[k] > 0.0))) {
            count[CHART_LEFT_OUT]++;
            w->x[k] = w->y[k] = nan("");
        }
    }
    area->y =
        axis_log(w->all.count, w->y, RECORDS_ROUNDING, &count[CHART_LIFTED]);
    if (m->tolerance > 0.0 && m->tolerance < area->y.low)
        area->y.low = m->tolerance / 2.0;
    if (m->tolerance > 0.0 && m->tolerance >= area->y.high)
        area->y.high = 2.0 * m->tolerance;
    area->x = w->form->seconds ? axis_tight(w->all.count, w->x)
                               : axis_linear(w->all.count, w->x, true);
    area->x.from = area->left;
    area->x.to = area->right;
    area->y.from = area->bottom;
    area->y.to = area->top;
    for (int64_t k = 0; k < w->all.count; k++)
        w->y[k] = axis_clamp(&area->y, w->y[k]);
    find_front(w);
}

static void put_row(chart_errors_work *w, int64_t panel, int64_t k, int style,
                    int64_t tip)
{
    const record *r = &w->all.item[k];

    fprintf(w->picture->data.file, "%lld\t%lld\t%d\t%.9g\t%.9g\t%lld\t%lld\t",
            (long long)panel, (long long)w->which[k], style, w->x[k], w->y[k],
            (long long)tip, (long long)r->order);
    html_line(w->picture->data.file, r->method);
    fputc('\n', w->picture->data.file);
}

static int by_place(const void *a, const void *b)
{
    const double *x = a, *y = b;

    return x[0] < y[0] ? -1 : x[0] > y[0] ? 1 : x[1] < y[1] ? -1 : x[1] > y[1];
}

int64_t chart_errors_line(const chart_errors_work *w, int64_t method,
                          bool front, double *room)
{
    int64_t count = 0, kept = 0;

    for (int64_t k = 0; k < w->all.count; k++) {
        if (isnan(w->x[k]) || (front && !w->front[k]) ||
            (!front && (w->which[k] != method || w->all.item[k].incomplete)))
            continue;
        room[3 * count] = w->x[k];
        room[3 * count + 1] = w->y[k];
        room[3 * count++ + 2] = (double)k;
    }
    qsort(room, (size_t)count, 3 * sizeof *room, by_place);
    for (int64_t i = 0; i < count; i++)
        if (front || kept == 0 || room[3 * i] > room[3 * (kept - 1)]) {
            memmove(room + 3 * kept, room + 3 * i, 3 * sizeof *room);
            kept++;
        }
    return kept;
}

static void put_line(chart_errors_work *w, int64_t panel, int64_t method,
                     int style, double *room)
{
    int64_t count = chart_errors_line(w, method, style == ON_FRONT, room);

    for (int64_t i = 0; i < count; i++)
        put_row(w, panel, (int64_t)room[3 * i + 2], style, -1);
    fputc('\n', w->picture->data.file); /* ends a line of gnuplot's */
}

static ritz_status put_points(chart_errors_work *w, int64_t panel)
{
    ritz_status status = RITZ_OK;
    const measure *m = &w->measure[panel];
    double *room = calloc(3 * (size_t)w->all.count + 1, sizeof *room);
    char text[1000];

    RITZ_FAIL_IF(!room, RITZ_ERR_MEMORY, "no memory for a chart");
    for (int64_t k = 0; k < w->all.count; k++) {
        const record *r = &w->all.item[k];
        int64_t tip = 0;

        if (isnan(w->x[k]))
            continue;
        chart_errors_tip(r, m, sizeof text, text);
        tip = gnuplot_tip(w->picture, "%s", text);
        put_row(w, panel, k, r->feasible ? MEETS : MISSES, tip);
        if (r->chosen || r->runner_up)
            put_row(w, panel, k, r->chosen ? CHOSEN : RUNNER_UP, tip);
    }
    if (w->form->front)
        put_line(w, panel, -1, ON_FRONT, room);
    for (int64_t s = 0; w->form->lines && s < w->num_methods; s++)
        put_line(w, panel, s, ON_LINE, room);
done:
    free(room);
    return status;
}

/* What is plotted of one area. */
static void put_plot(const chart_errors_work *w, int64_t panel)
{
    FILE *file = w->picture->plot.file;
    static const struct {
        int style, mark;
        const char *how;
    } rings[] = {
        {CHOSEN, 6, "ps 2.4 lw 2.4 lc rgb '" SVG_ALARM "'"},
        {RUNNER_UP, 6, "ps 2.2 lw 1.6 lc rgb '" SVG_INK "'"},
    };

    fprintf(file, "plot NaN notitle");
    if (w->form->front)
        fprintf(file,
                ", \\\n  data skip 1 using ($1 == %lld && $3 == %d ? $4 : NaN)"
                ":5 with steps lw 2 lc rgb '" SVG_MUTED "' notitle",
                (long long)panel, ON_FRONT);
    for (int64_t s = 0; w->form->lines && s < w->num_methods; s++)
        fprintf(file,
                ", \\\n  data skip 1 using (($1 == %lld && $2 == %lld && "
                "$3 == %d) ? $4 : NaN):5 with lines lw 1.8 lc rgb '%s' notitle",
                (long long)panel, (long long)s, ON_LINE, chart_colour(s));
    for (size_t k = 0; k < sizeof rings / sizeof *rings; k++)
        fprintf(file,
                ", \\\n  data skip 1 using ($1 == %lld && $3 == %d ? $4 : NaN)"
                ":5 with points pt %d %s notitle",
                (long long)panel, rings[k].style, rings[k].mark, rings[k].how);
    for (int64_t s = 0; s < w->num_methods; s++)
        for (int f = MEETS; f <= MISSES; f++)
            fprintf(file,
                    ", \\\n  data skip 1 using (($1 == %lld && $2 == %lld && "
                    "$3 == %d) ? $4 : NaN):5:6 with labels hypertext "
                    "point pt %d ps 1.0 lw 1.6 lc rgb '%s' notitle",
                    (long long)panel, (long long)s, f,
                    chart_mark(s, f == MISSES), chart_colour(s));
    fprintf(file, "\n");
}

ritz_status chart_errors_area(chart_errors_work *w, int64_t panel, double left,
                              double bottom)
{
    const measure *m = &w->measure[panel];
    int64_t count[2];
    chart_area area = {.left = left + CHART_LEFT,
                       .bottom = bottom + BOTTOM,
                       .right = left + CHART_CELL_WIDE - CHART_RIGHT,
                       .top = bottom + CHART_CELL_HIGH - TOP};

    chart_errors_place(w, m, &area, count);
    w->lifted += count[CHART_LIFTED];
    w->left_out += count[CHART_LEFT_OUT];
    chart_area_begin(w->picture, &area, m->title, w->form->xlabel, "");
    if (w->form->seconds)
        chart_tics_seconds(w->picture, &area.x);
    chart_errors_levels(w, m, &area);
    RITZ_CHECK(chart_errors_words(w, m, &area));
    RITZ_CHECK(put_points(w, panel));
    put_plot(w, panel);
    return RITZ_OK;
}
