#include "chart/chart_place.h"

#include "base/tolerances.h"

#include <math.h>
#include <stddef.h>

/* Between words, and between a word and a mark; pixels. */
static const double apart_x = 4.0, apart_y = 1.0;
/* Other marks are so much farther from a word than its own. */
static const double clearly = 3.0;
/* Nearer words need no line to their points. */
static const double leads_from = 9.0;

/* What it is worth to cover none of them, in pixels of distance. */
enum { PER_WORD = 2000, PER_SPOT = 300, PER_STROKE = 90, PER_LED_SPOT = 25 };

static bool meet(const chart_box *a, const chart_box *b, double x, double y)
{
    return a->left < b->right + x && b->left < a->right + x &&
           a->bottom < b->top + y && b->bottom < a->top + y;
}

static chart_box around(const chart_spot *s)
{
    return (chart_box){s->x - s->half, s->y - s->half, s->x + s->half,
                       s->y + s->half};
}

/* Of a line, what lies within low..high of one coordinate: from..to of it. */
static bool clip(double a, double b, double low, double high, double part[2])
{
    double first = 0.0, last = 1.0;

    if (a == b)
        return a > low && a < high;
    first = ((a < b ? low : high) - a) / (b - a);
    last = ((a < b ? high : low) - a) / (b - a);
    part[0] = fmax(part[0], first);
    part[1] = fmin(part[1], last);
    return part[0] < part[1];
}

static bool crosses(const chart_stroke *s, const chart_box *b)
{
    double part[2] = {0.0, 1.0};

    return clip(s->x[0], s->x[1], b->left, b->right, part) &&
           clip(s->y[0], s->y[1], b->bottom, b->top, part);
}

static bool is_within(const chart_box *b, const chart_box *frame)
{
    return b->left >= frame->left && b->bottom >= frame->bottom &&
           b->right <= frame->right && b->top <= frame->top;
}

static double distance(const chart_box *b, double x, double y)
{
    double dx = fmax(fmax(b->left - x, x - b->right), 0.0);
    double dy = fmax(fmax(b->bottom - y, y - b->top), 0.0);

    return hypot(dx, dy);
}

/* The word in a direction from its point, its near edge at the given gap. */
static chart_box toward(const chart_word *w, double cosine, double sine,
                        double gap)
{
    double x = w->x + gap * cosine + 0.5 * w->wide * (cosine - 1.0);
    double y = w->y + gap * sine + 0.5 * w->high * (sine - 1.0);

    return (chart_box){x, y, x + w->wide, y + w->high};
}

/* A point that stands where the word's own does is the same. */
static bool is_free(const chart_places *p, const chart_word *w,
                    const chart_box *b)
{
    double own = distance(b, w->x, w->y);

    if (!is_within(b, &p->frame))
        return false;
    for (int64_t k = 0; k < p->num_words; k++)
        if (meet(b, &p->word[k], apart_x, apart_y))
            return false;
    for (int64_t k = 0; k < p->num_spots; k++) {
        const chart_spot *s = &p->spot[k];
        const chart_box mark = around(s);
        bool same = hypot(s->x - w->x, s->y - w->y) < 1.0;

        if (meet(b, &mark, 0.0, 0.0) ||
            (!same && distance(b, s->x, s->y) < own + clearly))
            return false;
    }
    for (int64_t k = 0; k < p->num_strokes; k++)
        if (crosses(&p->stroke[k], b))
            return false;
    return true;
}

bool chart_place_beside(const chart_places *p, chart_word *word)
{
    static const double side[][2] = {{1.0, 0.0},  {0.0, 1.0},  {-1.0, 0.0},
                                     {0.0, -1.0}, {0.7, 0.7},  {-0.7, 0.7},
                                     {0.7, -0.7}, {-0.7, -0.7}};

    for (size_t k = 0; k < sizeof side / sizeof *side; k++) {
        word->at = toward(word, side[k][0], side[k][1], word->half + 2.0);
        if (is_free(p, word, &word->at))
            return true;
    }
    return false;
}

/* From the edge of the mark to the nearest of the word. */
static void lead(chart_word *w)
{
    double dx = fmin(fmax(w->x, w->at.left), w->at.right) - w->x;
    double dy = fmin(fmax(w->y, w->at.bottom), w->at.top) - w->y;
    double far = hypot(dx, dy);

    w->led = far > w->half + leads_from;
    w->from[0] = w->x + (far > 0.0 ? w->half * dx / far : 0.0);
    w->from[1] = w->y + (far > 0.0 ? w->half * dy / far : 0.0);
    w->to[0] = w->x + dx;
    w->to[1] = w->y + dy;
}

/* What the word covers at its place, and its line. */
static double burden(const chart_places *p, const chart_word *w)
{
    const chart_stroke line = {.x = {w->from[0], w->to[0]},
                               .y = {w->from[1], w->to[1]}};
    double sum = 0.0;

    for (int64_t k = 0; k < p->num_words; k++)
        sum += meet(&w->at, &p->word[k], apart_x, apart_y) ||
                       (w->led && crosses(&line, &p->word[k]))
                   ? PER_WORD
                   : 0.0;
    for (int64_t k = 0; k < p->num_spots; k++) {
        const chart_box mark = around(&p->spot[k]);

        if (meet(&w->at, &mark, 1.0, 1.0))
            sum += PER_SPOT;
        else if (w->led && crosses(&line, &mark))
            sum += PER_LED_SPOT;
    }
    for (int64_t k = 0; k < p->num_strokes; k++)
        if (crosses(&p->stroke[k], &w->at))
            sum += PER_STROKE * p->stroke[k].weight;
    return sum;
}

void chart_place_around(const chart_places *p, chart_word *word)
{
    enum { TURNS = 24, RINGS = 40 };
    const double turn = 2.0 * RITZ_PI / TURNS, step = 7.0;
    double least = HUGE_VAL;
    chart_word best = *word;

    best.at = (chart_box){p->frame.left, p->frame.top - word->high,
                          p->frame.left + word->wide, p->frame.top};
    lead(&best);
    for (int ring = 0; ring < RINGS; ring++)
        for (int k = 0; k < TURNS; k++) {
            double gap = word->half + 3.0 + step * ring, sum = 0.0;

            word->at = toward(word, cos(turn * k), sin(turn * k), gap);
            if (!is_within(&word->at, &p->frame) || gap >= least)
                continue;
            lead(word);
            sum = gap + burden(p, word);
            if (sum < least) {
                least = sum;
                best = *word;
            }
        }
    *word = best;
}
