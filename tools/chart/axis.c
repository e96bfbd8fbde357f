#include "chart/axis.h"

#include <math.h>
#include <string.h>

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

/* Letters of common fonts, in units of their size. */
double axis_width(const char *text, double size)
{
    static const char narrow[] = "fijlrtI.,:;'|!()[]- ", wide[] = "mwMW%@";
    double sum = 0.0;

    for (; *text; text++)
        if (((unsigned char)*text >> 6) != 2)
            sum += strchr(narrow, *text) ? 0.37
                   : strchr(wide, *text) ? 0.97
                                         : 0.61;
    return sum * size;
}
