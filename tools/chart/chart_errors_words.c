/* Words beside points: their orders, and what was chosen. */
#include "chart/chart_errors.h"

#include "chart/chart_place.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 11, LARGE = 12, MOST = 400 };

/* Half of a mark and of a ring, pixels. */
static const double half_mark = 5.0, half_ring = 13.0;
/* Level lines stand behind all else. */
static const double pale = 0.2;

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

static void add_stroke(chart_places *p, const double from[2],
                       const double to[2], double weight)
{
    p->stroke[p->num_strokes++] =
        (chart_stroke){{from[0], to[0]}, {from[1], to[1]}, weight};
}

static void add_level(const chart_area *area, double value, double weight,
                      chart_places *p)
{
    const double y = axis_place(&area->y, value);

    add_stroke(p, (double[]){area->left, y}, (double[]){area->right, y},
               weight);
}

static void add_levels(const measure *m, const chart_area *area,
                       chart_places *p)
{
    int first = 0, last = 0;
    int step = chart_errors_decades(area, &first, &last);

    for (int e = first; e <= last; e += step)
        add_level(area, pow(10.0, e), pale, p);
    if (chart_errors_uncertain(area))
        add_level(area, CHART_UNCERTAINTY, 1.0, p);
    if (m->tolerance > 0.0)
        add_level(area, m->tolerance, 1.0, p);
}

/* From order to order, or of the front in steps. */
static void add_line(const chart_errors_work *w, const chart_area *area,
                     int64_t method, double *room, chart_places *p)
{
    bool front = method < 0;
    int64_t count = chart_errors_line(w, method, front, room);
    double last[2] = {0.0, 0.0};

    for (int64_t i = 0; i < count; i++) {
        const double at[2] = {axis_place(&area->x, room[3 * i]),
                              axis_place(&area->y, room[3 * i + 1])};
        const double corner[2] = {at[0], last[1]};

        if (i > 0 && front) {
            add_stroke(p, last, corner, 1.0);
            add_stroke(p, corner, at, 1.0);
        } else if (i > 0) {
            add_stroke(p, last, at, 1.0);
        }
        last[0] = at[0];
        last[1] = at[1];
    }
}

/* All that words should not cover. */
static ritz_status list_places(const chart_errors_work *w, const measure *m,
                               const chart_area *area, chart_places *p)
{
    enum { LEVELS = 40 };
    ritz_status status = RITZ_OK;
    size_t n = (size_t)w->all.count;
    double *room = calloc(3 * n + 1, sizeof *room);

    p->frame = (chart_box){area->left + 3.0, area->bottom + 3.0,
                           area->right - 3.0, area->top - 1.0};
    p->spot = calloc(n + 1, sizeof *p->spot);
    p->word = calloc(n + 1, sizeof *p->word);
    p->stroke = calloc(3 * n + LEVELS, sizeof *p->stroke);
    RITZ_FAIL_IF(!room || !p->spot || !p->word || !p->stroke, RITZ_ERR_MEMORY,
                 "no memory for a chart");
    for (int64_t k = 0; k < w->all.count; k++)
        if (!isnan(w->x[k]))
            p->spot[p->num_spots++] = (chart_spot){
                axis_place(&area->x, w->x[k]), axis_place(&area->y, w->y[k]),
                rank_of(w, k) < 2 ? half_ring : half_mark};
    add_levels(m, area, p);
    if (w->form->front)
        add_line(w, area, -1, room, p);
    for (int64_t s = 0; w->form->lines && s < w->num_methods; s++)
        add_line(w, area, s, room, p);
done:
    free(room);
    return status;
}

static void write_word(const chart_errors_work *w, const chart_word *word,
                       const char *text, bool large)
{
    const gnuplot *picture = w->picture;

    if (large && word->led)
        fprintf(picture->plot.file,
                "set arrow from screen %.6f, screen %.6f to screen %.6f, "
                "screen %.6f nohead front lw 0.8 lc rgb '" SVG_INK "'\n",
                word->from[0] / picture->wide, word->from[1] / picture->high,
                word->to[0] / picture->wide, word->to[1] / picture->high);
    chart_text(w->picture, word->at.left,
               0.5 * (word->at.bottom + word->at.top), text,
               large ? "front font ',12' tc rgb '" SVG_INK "'"
                     : "front font ',11' tc rgb '" SVG_MUTED "'");
}

/* An order, or what was chosen, which is always said. */
static void place_word(const chart_errors_work *w, const chart_area *area,
                       int64_t k, chart_places *p)
{
    const bool large = rank_of(w, k) < 2;
    const double size = large ? LARGE : SIZE;
    chart_word word = {.x = axis_place(&area->x, w->x[k]),
                       .y = axis_place(&area->y, w->y[k]),
                       .half = large ? half_ring : half_mark,
                       .high = size + 1.0};
    char text[CHART_WORD];

    say_point(w, k, text);
    word.wide = axis_width(text, size);
    if (large)
        chart_place_around(p, &word);
    else if (!chart_place_beside(p, &word))
        return;
    write_word(w, &word, text, large);
    p->word[p->num_words++] = word.at;
    if (large && word.led)
        add_stroke(p, word.from, word.to, 2.0);
}

ritz_status chart_errors_words(const chart_errors_work *w, const measure *m,
                               const chart_area *area)
{
    ritz_status status = RITZ_OK;
    /* where lines join orders the axis says them */
    int last = w->form->lines ? 2 : 4;
    chart_places places = {0};

    RITZ_TRY(list_places(w, m, area, &places));
    for (int rank = 0; rank < last; rank++)
        for (int64_t k = 0, tried = 0; k < w->all.count && tried < MOST; k++) {
            if (isnan(w->x[k]) || rank_of(w, k) != rank ||
                (rank > 1 && w->all.item[k].incomplete))
                continue;
            place_word(w, area, k, &places);
            tried++;
        }
done:
    free(places.spot);
    free(places.word);
    free(places.stroke);
    return status;
}
