/* One area of a chart of errors: points, lines, levels, words. */
#include "chart_errors.h"

#include "html.h"

#include <math.h>
#include <stdlib.h>

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

/* Coordinates of all records in an area, which becomes their axes'. */
static void place(chart_errors_work *w, const measure *m, chart_area *area)
{
    int64_t lifted = 0;

    for (int64_t k = 0; k < w->all.count; k++) {
        w->x[k] = w->form->x(&w->all.item[k]);
        w->y[k] = record_error(&w->all.item[k], m->name);
        if (!isfinite(w->y[k]) || !isfinite(w->x[k]) ||
            (w->form->seconds && !(w->x[k] > 0.0))) {
            w->left_out++;
            w->x[k] = w->y[k] = nan("");
        }
    }
    area->y = axis_log(w->all.count, w->y, RECORDS_ROUNDING, &lifted);
    if (m->tolerance > 0.0 && m->tolerance < area->y.low)
        area->y.low = m->tolerance / 2.0;
    if (m->tolerance > 0.0 && m->tolerance >= area->y.high)
        area->y.high = 2.0 * m->tolerance;
    w->lifted += lifted;
    area->x = w->form->seconds ? axis_tight(w->all.count, w->x)
                               : axis_linear(w->all.count, w->x, true);
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

/* Points of a front or of one method, from left to right: x, y, record. */
static void put_line(chart_errors_work *w, int64_t panel, int64_t method,
                     int style, double *room)
{
    int64_t count = 0;

    for (int64_t k = 0; k < w->all.count; k++) {
        if (isnan(w->x[k]) || (style == ON_FRONT && !w->front[k]) ||
            (style == ON_LINE && w->which[k] != method))
            continue;
        room[3 * count] = w->x[k];
        room[3 * count + 1] = w->y[k];
        room[3 * count++ + 2] = (double)k;
    }
    qsort(room, (size_t)count, 3 * sizeof *room, by_place);
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

/* Points under a word. */
static int64_t count_under(const chart_errors_work *w, const chart_area *area,
                           const axis_word *word)
{
    int64_t count = 0;

    for (int64_t k = 0; k < w->all.count; k++) {
        double x = axis_place(&area->x, w->x[k]) - word->left;
        double y = axis_place(&area->y, w->y[k]) - word->base;

        count += x > -8.0 && x < word->wide + 8.0 && y > -6.0 &&
                 y < word->high + 6.0;
    }
    return count;
}

/* A name on a level, where it covers few points: right, left or between.
 * Other words keep clear of it. */
static void name_level(const chart_errors_work *w, const chart_area *area,
                       double value, const char *text, const char *how,
                       axis_word *out)
{
    static const double places[] = {1.0, 0.0, 0.75, 0.25, 0.5};
    double y = axis_place(&area->y, value);
    int64_t least = INT64_MAX;

    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        axis_word word = {.fixed = true,
                          .wide = axis_width(text, 11.0) + 6.0,
                          .high = 15.0,
                          .base = y - 2.0};
        int64_t under = 0;

        word.left = area->left + 4.0 +
                    places[k] * (area->right - area->left - 4.0 - word.wide);
        under = count_under(w, area, &word);
        if (under >= least)
            continue;
        least = under;
        *out = word;
    }
    chart_text(w->picture, out->left + 2.0, y + 8.0, text, how);
}

/* Lines of equal error that mean something; how many. */
static int64_t put_levels(const chart_errors_work *w, const measure *m,
                          const chart_area *area, axis_word names[2])
{
    char word[32], text[CHART_WORD];
    int64_t count = 0;

    if (m->tolerance > 0.0) {
        chart_level(w->picture, area, m->tolerance,
                    "lw 1.4 lc rgb '" SVG_ALARM "'");
        chart_say_error(m->tolerance, word);
        snprintf(text, sizeof text, "tolerance %s", word);
        name_level(w, area, m->tolerance, text,
                   "front font ',11' tc rgb '" SVG_ALARM "'", &names[count++]);
    }
    if (area->y.high < CHART_UNCERTAINTY || area->y.low > CHART_UNCERTAINTY ||
        fabs(m->tolerance - CHART_UNCERTAINTY) < 1e-3)
        return count;
    chart_level(w->picture, area, CHART_UNCERTAINTY,
                "lw 1.2 dt 2 lc rgb '" SVG_INK "'");
    name_level(w, area, CHART_UNCERTAINTY,
               "10 %: below, models are as uncertain",
               "front font ',11' tc rgb '" SVG_INK "'", &names[count++]);
    return count;
}

/* How gladly the order of a point is written, least first. */
static int rank_of(const chart_errors_work *w, int64_t k)
{
    const record *r = &w->all.item[k];

    return r->chosen ? 0 : r->runner_up ? 1 : w->front[k] ? 2 : 3;
}

static void say_point(const chart_errors_work *w, int64_t k,
                      char out[CHART_WORD])
{
    const record *r = &w->all.item[k];

    if (r->chosen || r->runner_up)
        snprintf(out, CHART_WORD, "%s: %.26s, %lld",
                 r->chosen ? "chosen" : "runner-up", r->method,
                 (long long)r->order);
    else
        snprintf(out, CHART_WORD, "%lld", (long long)r->order);
}

/* Orders beside points: those that count first, others where there is room. */
static ritz_status put_words(const chart_errors_work *w, const measure *m,
                             const chart_area *area)
{
    enum { SIZE = 11, MOST = 400 };
    ritz_status status = RITZ_OK;
    const double box[] = {area->left + 2.0, area->bottom + 2.0,
                          area->right + 14.0, area->top + 6.0};
    axis_word *words = calloc((size_t)w->all.count + 3, sizeof *words);
    int64_t *of = calloc((size_t)w->all.count + 3, sizeof *of);
    int64_t count = 0, first = 0;
    char text[CHART_WORD];

    RITZ_FAIL_IF(!words || !of, RITZ_ERR_MEMORY, "no memory for a chart");
    first = count = put_levels(w, m, area, words);
    for (int rank = 0; rank < 4; rank++)
        for (int64_t k = 0; k < w->all.count && count < MOST; k++) {
            if (isnan(w->x[k]) || rank_of(w, k) != rank)
                continue;
            say_point(w, k, text);
            words[count] = (axis_word){.x = axis_place(&area->x, w->x[k]),
                                       .y = axis_place(&area->y, w->y[k]),
                                       .wide = axis_width(text, SIZE),
                                       .high = SIZE + 1.0,
                                       .gap = rank < 2 ? 7.0 : 0.0,
                                       .must = rank < 2};
            if ((w->form->lines && rank > 1) || w->all.item[k].incomplete)
                words[count].wide = 0.0; /* the axis says the order */
            of[count++] = k;
        }
    axis_words(count, words, box);
    for (int64_t i = first; i < count; i++) {
        if (!words[i].written)
            continue;
        say_point(w, of[i], text);
        chart_text(w->picture, words[i].left,
                   words[i].base + 0.5 * words[i].high, text,
                   rank_of(w, of[i]) < 2
                       ? "front font ',12' tc rgb '" SVG_INK "'"
                       : "front font ',11' tc rgb '" SVG_MUTED "'");
    }
done:
    free(words);
    free(of);
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
    ritz_status status = RITZ_OK;
    const measure *m = &w->measure[panel];
    chart_area area = {.left = left + CHART_LEFT,
                       .bottom = bottom + BOTTOM,
                       .right = left + CHART_CELL_WIDE - CHART_RIGHT,
                       .top = bottom + CHART_CELL_HIGH - TOP};

    place(w, m, &area);
    area.x.from = area.left;
    area.x.to = area.right;
    area.y.from = area.bottom;
    area.y.to = area.top;
    chart_area_begin(w->picture, &area, m->title, w->form->xlabel, "");
    if (w->form->seconds)
        chart_tics_seconds(w->picture, &area.x);
    RITZ_TRY(put_words(w, m, &area));
    RITZ_TRY(put_points(w, panel));
    put_plot(w, panel);
done:
    return status;
}
