/*
 * Lines of equal error: one at every decade of an area, or at few of many, the
 * tolerance, and what models are uncertain by. Each says beside its right end
 * how much it is.
 */
#include "chart/chart_errors.h"

#include <math.h>

/* More lines than these are too near to each other. */
enum { MOST_LINES = 12, FEWER_LINES = 8 };

/* Half the height of a word at the end of a line, pixels. */
static const double half_word = 7.0;

/* "0.1 %", or "1e-6" where percents have too many zeros. */
static void say_decade(int exponent, char out[32])
{
    if (exponent >= -5 && exponent <= 2)
        snprintf(out, 32, "%g\xc2\xa0%%", pow(10.0, exponent + 2));
    else
        snprintf(out, 32, "1e%d", exponent);
}

static void say_level(const chart_errors_work *w, const chart_area *area,
                      double value, const char *text, const char *colour)
{
    char how[64];

    snprintf(how, sizeof how, "font ',11' tc rgb '%s'", colour);
    chart_text(w->picture, area->right + 6.0, axis_place(&area->y, value), text,
               how);
}

static bool is_near(const chart_area *area, double a, double b)
{
    return a > 0.0 && b > 0.0 &&
           fabs(axis_place(&area->y, a) - axis_place(&area->y, b)) <
               2.0 * half_word;
}

bool chart_errors_uncertain(const chart_area *area)
{
    return area->y.low <= CHART_UNCERTAINTY &&
           CHART_UNCERTAINTY <= area->y.high;
}

int chart_errors_decades(const chart_area *area, int *first, int *last)
{
    *first = (int)ceil(log10(area->y.low) - 1e-9);
    *last = (int)floor(log10(area->y.high) + 1e-9);
    return *last - *first > MOST_LINES ? 1 + (*last - *first) / FEWER_LINES : 1;
}

/* Decades, and the numbers of the axis with them. */
static void put_decades(const chart_errors_work *w, const measure *m,
                        const chart_area *area)
{
    FILE *file = w->picture->plot.file;
    int first = 0, last = 0;
    int step = chart_errors_decades(area, &first, &last);
    char word[32];

    fprintf(file, "unset grid\nset grid x lc rgb '" SVG_GRID "' lt 1 lw 0.8\n"
                  "set ytics nomirror (");
    for (int e = first; e <= last; e += step)
        fprintf(file, "%s'10^{%d}' 1e%d", e > first ? ", " : "", e, e);
    fprintf(file, ") tc rgb '" SVG_MUTED "'\n");
    for (int e = first; e <= last; e += step) {
        double value = pow(10.0, e);

        chart_level(w->picture, area, value, "lw 1 lc rgb '" SVG_PALE "'");
        say_decade(e, word);
        if (!is_near(area, value, m->tolerance) &&
            !(chart_errors_uncertain(area) &&
              is_near(area, value, CHART_UNCERTAINTY)))
            say_level(w, area, value, word, SVG_MUTED);
    }
}

void chart_errors_levels(const chart_errors_work *w, const measure *m,
                         const chart_area *area)
{
    char word[32];

    put_decades(w, m, area);
    if (chart_errors_uncertain(area)) {
        chart_level(w->picture, area, CHART_UNCERTAINTY,
                    "lw 1.4 dt 2 lc rgb '" SVG_INK "'");
        if (!is_near(area, CHART_UNCERTAINTY, m->tolerance)) {
            chart_say_error(CHART_UNCERTAINTY, word);
            say_level(w, area, CHART_UNCERTAINTY, word, SVG_INK);
        }
    }
    if (!(m->tolerance > 0.0))
        return;
    chart_level(w->picture, area, m->tolerance,
                "lw 1.6 lc rgb '" SVG_ALARM "'");
    chart_say_error(m->tolerance, word);
    say_level(w, area, m->tolerance, word, SVG_ALARM);
}
