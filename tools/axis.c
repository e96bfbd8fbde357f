#include "axis.h"

#include <math.h>
#include <stddef.h>

axis axis_log(int64_t count, const double *values, double floor_value,
              int64_t *lifted)
{
    axis a = {.log = true};
    double least = HUGE_VAL;
    double most = 0.0;

    *lifted = 0;
    for (int64_t k = 0; k < count; k++) {
        if (!isfinite(values[k]))
            continue;
        *lifted += values[k] <= floor_value;
        if (values[k] > floor_value)
            least = fmin(least, values[k]);
        most = fmax(most, values[k]);
    }
    if (!(most > floor_value))
        least = most = 3.0 * floor_value;
    a.low = pow(10.0, floor(log10(least) - 0.08));
    a.high = pow(10.0, ceil(log10(most) + 0.08));
    if (*lifted > 0)
        a.low /= 10.0;
    return a;
}

/* 1, 2 or 5 of a decade, next to a value on the one side or the other. */
static double round_part(double value, bool up)
{
    static const double parts[] = {1.0, 2.0, 5.0, 10.0};
    double decade = pow(10.0, floor(log10(value)));
    double part = value / decade;
    int k = 0;

    while (k < 2 && (up ? parts[k] < part : parts[k + 1] <= part))
        k++;
    if (up && parts[k] < part)
        k++;
    return parts[k] * decade;
}

axis axis_tight(int64_t count, const double *values)
{
    axis a = {.log = true};
    double least = HUGE_VAL;
    double most = 0.0;

    for (int64_t k = 0; k < count; k++) {
        if (!isfinite(values[k]))
            continue;
        least = fmin(least, values[k]);
        most = fmax(most, values[k]);
    }
    if (!(most > 0.0))
        least = most = 1.0;
    a.low = round_part(0.88 * least, false);
    a.high = round_part(1.15 * most, true);
    return a;
}

axis axis_linear(int64_t count, const double *values, bool from_zero)
{
    axis a = {0};
    bool any = false;
    double room = 0.0;

    for (int64_t k = 0; k < count; k++) {
        if (!isfinite(values[k]))
            continue;
        a.low = any ? fmin(a.low, values[k]) : values[k];
        a.high = any ? fmax(a.high, values[k]) : values[k];
        any = true;
    }
    if (from_zero)
        a.low = fmin(a.low, 0.0);
    room = 0.05 * (a.high - a.low);
    if (!(room > 0.0))
        room = fmax(0.05 * fabs(a.high), 0.5);
    a.high += room;
    if (!from_zero || a.low < 0.0)
        a.low -= room;
    return a;
}

double axis_clamp(const axis *a, double value)
{
    if (!isfinite(value) || !a->log)
        return isfinite(value) ? value : nan("");
    return fmax(value, a->low);
}

double axis_place(const axis *a, double value)
{
    double share = a->log ? log(value / a->low) / log(a->high / a->low)
                          : (value - a->low) / (a->high - a->low);

    return a->from + share * (a->to - a->from);
}

static bool cross(const axis_word *a, const axis_word *b)
{
    return a->left < b->left + b->wide && b->left < a->left + a->wide &&
           a->base < b->base + b->high && b->base < a->base + a->high;
}

/* Whether a word at its place covers no word before it and, unless it may, no
   other point. */
static bool is_free(int64_t count, const axis_word *words, int64_t k,
                    const double box[4], bool across)
{
    const double mark = 5.0; /* half a mark, pixels */
    const axis_word *w = &words[k];

    if (w->left < box[0] || w->base < box[1] || w->left + w->wide > box[2] ||
        w->base + w->high > box[3])
        return false;
    for (int64_t i = 0; i < count; i++) {
        axis_word point = {.left = words[i].x - mark,
                           .base = words[i].y - mark,
                           .wide = 2.0 * mark,
                           .high = 2.0 * mark};

        if ((!across && cross(w, &point)) ||
            (words[i].written && i != k && cross(w, &words[i])))
            return false;
    }
    return true;
}

/* Try places beside a point, the nearest first. */
static bool find_room(int64_t count, axis_word *words, int64_t k,
                      const double box[4], bool across)
{
    /* of the word's size, then pixels; behind the point's centre */
    static const struct {
        double wide, high, x, y;
    } beside[] = {
        {0.0, -0.5, 8.0, 0.0},    {-0.5, 0.0, 0.0, 7.0},
        {-1.0, -0.5, -8.0, 0.0},  {-0.5, -1.0, 0.0, -7.0},
        {0.0, 0.0, 5.0, 5.0},     {-1.0, 0.0, -5.0, 5.0},
        {0.0, -1.0, 5.0, -5.0},   {-1.0, -1.0, -5.0, -5.0},
        {0.0, 0.0, 10.0, 14.0},   {0.0, -1.0, 10.0, -14.0},
        {-1.0, 0.0, -10.0, 14.0}, {-1.0, -1.0, -10.0, -14.0},
        {-0.5, 0.0, 0.0, 24.0},   {-0.5, -1.0, 0.0, -24.0},
    };
    axis_word *w = &words[k];

    for (size_t p = 0; p < sizeof beside / sizeof *beside; p++) {
        w->left = w->x + beside[p].wide * w->wide + beside[p].x +
                  copysign(beside[p].x == 0.0 ? 0.0 : w->gap, beside[p].x);
        w->base = w->y + beside[p].high * w->high + beside[p].y +
                  copysign(beside[p].y == 0.0 ? 0.0 : w->gap, beside[p].y);
        if (is_free(count, words, k, box, across))
            return true;
    }
    return false;
}

void axis_words(int64_t count, axis_word *words, const double box[4])
{
    for (int64_t k = 0; k < count; k++)
        words[k].written = false;
    for (int64_t k = 0; k < count; k++) {
        axis_word *w = &words[k];

        if (!(w->wide > 0.0))
            continue;
        w->written = find_room(count, words, k, box, false) ||
                     (w->must && find_room(count, words, k, box, true));
        if (w->written || !w->must)
            continue;
        w->left = fmin(w->x + 8.0, box[2] - w->wide);
        w->base = fmin(w->y + 5.0, box[3] - w->high);
        w->written = true;
    }
}

double axis_width(const char *text, double size)
{
    double letters = 0.0;

    for (; *text; text++)
        letters += ((unsigned char)*text >> 6) != 2;
    return 0.58 * size * letters;
}
