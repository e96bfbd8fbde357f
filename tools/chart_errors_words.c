/* Words beside points: their orders, and what was chosen. */
#include "chart_errors.h"

#include <math.h>
#include <stdlib.h>

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

static void write_words(const chart_errors_work *w, int64_t count,
                        const axis_word *words, const int64_t *of)
{
    char text[CHART_WORD];

    for (int64_t i = 0; i < count; i++) {
        if (!words[i].written)
            continue;
        say_point(w, of[i], text);
        chart_text(w->picture, words[i].left,
                   words[i].base + 0.5 * words[i].high, text,
                   rank_of(w, of[i]) < 2
                       ? "front font ',12' tc rgb '" SVG_INK "'"
                       : "front font ',11' tc rgb '" SVG_MUTED "'");
    }
}

ritz_status chart_errors_words(const chart_errors_work *w,
                               const chart_area *area)
{
    enum { SIZE = 11, MOST = 400 };
    ritz_status status = RITZ_OK;
    const double box[] = {area->left + 2.0, area->bottom + 2.0,
                          area->right - 2.0, area->top + 6.0};
    axis_word *words = calloc((size_t)w->all.count + 1, sizeof *words);
    int64_t *of = calloc((size_t)w->all.count + 1, sizeof *of);
    int64_t count = 0;
    char text[CHART_WORD];

    RITZ_FAIL_IF(!words || !of, RITZ_ERR_MEMORY, "no memory for a chart");
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
    write_words(w, count, words, of);
done:
    free(words);
    free(of);
    return status;
}
