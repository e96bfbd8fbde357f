/* Parts that charts share: words for numbers, areas, legends. */
#include "chart/chart.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void chart_say_error(double error, char out[32])
{
    if (isnan(error))
        snprintf(out, 32, "not measured");
    else if (error <= 0.0)
        snprintf(out, 32, error < 0.0 ? "below 0" : "0");
    else if (error < RECORDS_ROUNDING)
        snprintf(out, 32, "< %.0e", RECORDS_ROUNDING);
    else if (error >= 0.0995 && error < 100.0)
        snprintf(out, 32, "%.0f\xc2\xa0%%", 100.0 * error);
    else if (error >= 1e-4 && error < 100.0)
        snprintf(out, 32, "%.2g\xc2\xa0%%", 100.0 * error);
    else
        snprintf(out, 32, "%.1e", error);
}

void chart_say_seconds(double seconds, char out[32])
{
    static const struct {
        double unit;
        const char *name;
    } units[] = {{1.0, "s"}, {1e-3, "ms"}, {1e-6, "\xc2\xb5s"}, {1e-9, "ns"}};
    int k = 0;

    while (k < 3 && seconds < 0.9995 * units[k].unit)
        k++;
    snprintf(out, 32,
             seconds >= 99.95 * units[k].unit ? "%.0f\xc2\xa0%s"
                                              : "%.2g\xc2\xa0%s",
             seconds / units[k].unit, units[k].name);
}

const char *chart_base(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

const char *chart_colour(int64_t series)
{
    return svg_colour[series % SVG_COLOURS];
}

/*
 * Five marks and eight colours: forty series are told apart. Of the first
 * eight, colours that are alike, such as the two blues, have other marks, and a
 * colour that comes again has the next.
 */
int chart_mark(int64_t series, bool hollow)
{
    static const int filled[] = {7, 5, 9, 13, 11};
    static const int first[SVG_COLOURS] = {0, 1, 2, 3, 4, 3, 1, 2};

    return filled[(first[series % SVG_COLOURS] + series / SVG_COLOURS) % 5] -
           hollow;
}

static void put_range(FILE *file, char which, const axis *a)
{
    fprintf(file, "%s logscale %c\nset %crange [%.9g:%.9g]\n",
            a->log ? "set" : "unset", which, which, a->low, a->high);
}

void chart_area_begin(gnuplot *picture, const chart_area *area,
                      const char *title, const char *xlabel, const char *ylabel)
{
    FILE *file = picture->plot.file;
    double decades = log10(area->y.high / area->y.low);

    fprintf(file,
            "unset label\nunset arrow\nset lmargin at screen %.6f\n"
            "set rmargin at screen %.6f\nset bmargin at screen %.6f\n"
            "set tmargin at screen %.6f\nunset key\n"
            "set grid lc rgb '" SVG_GRID "' lt 1 lw 0.8\n",
            area->left / picture->wide, area->right / picture->wide,
            area->bottom / picture->high, area->top / picture->high);
    put_range(file, 'x', &area->x);
    put_range(file, 'y', &area->y);
    fprintf(file,
            "set xtics autofreq nomirror tc rgb '" SVG_MUTED "'\n"
            "set ytics autofreq nomirror tc rgb '" SVG_MUTED "'\n"
            "unset mxtics\nunset mytics\nset border 3\nset tics scale 0.6\n"
            "set format x '%%g'\n");
    if (area->y.log && decades > 12.0)
        fprintf(file, "set ytics %.3g\n", pow(10.0, ceil(decades / 8.0)));
    fprintf(file, "set format y '%s'\n", area->y.log ? "10^{%L}" : "%g");
    fprintf(file, "set xlabel ");
    gnuplot_quote(file, xlabel);
    fprintf(file, " noenhanced tc rgb '" SVG_INK "' offset 0,0.4\n");
    if (*ylabel)
        chart_text(picture, area->edge + 13.0, 0.5 * (area->bottom + area->top),
                   ylabel, "center rotate by 90 tc rgb '" SVG_INK "'");
    chart_text(picture, area->left, area->top + 16.0, title,
               "font ',14' tc rgb '" SVG_INK "'");
}

void chart_canvas(gnuplot *picture)
{
    fprintf(picture->plot.file,
            "unset label\nunset arrow\nunset tics\nunset border\n"
            "unset xlabel\nunset ylabel\nunset logscale\nunset grid\n"
            "set lmargin at screen 0\nset rmargin at screen 1\n"
            "set bmargin at screen 0\nset tmargin at screen 1\n"
            "set xrange [0:1]\nset yrange [0:1]\n");
}

void chart_tics_seconds(gnuplot *picture, const axis *x)
{
    static const double parts[] = {1.0, 2.0, 5.0};
    FILE *file = picture->plot.file;
    bool dense = x->high / x->low < 150.0;
    bool any = false;
    char word[32];

    fprintf(file, "set xtics nomirror (");
    for (int decade = (int)floor(log10(x->low)); decade < 12; decade++)
        for (int k = 0; k < (dense ? 3 : 1); k++) {
            double at = parts[k] * pow(10.0, decade);

            if (at < 0.999 * x->low || at > 1.001 * x->high)
                continue;
            chart_say_seconds(at, word);
            fprintf(file, "%s'%s' %.6g", any ? ", " : "", word, at);
            any = true;
        }
    fprintf(file, ") tc rgb '" SVG_MUTED "'\n");
}

void chart_text(gnuplot *picture, double x, double y, const char *text,
                const char *how)
{
    FILE *file = picture->plot.file;

    fprintf(file, "set label ");
    gnuplot_quote(file, text);
    fprintf(file, " at screen %.6f, screen %.6f noenhanced %s\n",
            x / picture->wide, y / picture->high, how);
}

void chart_level(gnuplot *picture, const chart_area *area, double value,
                 const char *how)
{
    double y = axis_place(&area->y, value);

    if (y < area->bottom || y > area->top)
        return;
    fprintf(picture->plot.file,
            "set arrow from screen %.6f, screen %.6f to screen %.6f, "
            "screen %.6f nohead %s\n",
            area->left / picture->wide, y / picture->high,
            area->right / picture->wide, y / picture->high, how);
}

static void put_sign(gnuplot *picture, const chart_sign *sign, double x,
                     double y)
{
    char how[96];

    if (sign->mark > 0) {
        snprintf(how, sizeof how, "point pt %d ps 0.9 lw 1.6 lc rgb '%s'",
                 sign->mark, sign->colour);
        chart_text(picture, x + 10.0, y, "", how);
    } else {
        fprintf(picture->plot.file,
                "set arrow from screen %.6f, screen %.6f to screen %.6f, "
                "screen %.6f nohead lw %.1f dt %d lc rgb '%s'\n",
                x / picture->wide, y / picture->high,
                (x + 20.0) / picture->wide, y / picture->high,
                sign->wide > 0.0 ? sign->wide : 1.8, sign->dash, sign->colour);
    }
    chart_text(picture, x + 26.0, y, sign->name,
               "font ',12' tc rgb '" SVG_INK "'");
}

int64_t chart_legend(gnuplot *picture, int64_t count, const chart_sign *signs,
                     double left, double top, double right, bool draw)
{
    const double row = 20.0;
    double column = 0.0;
    double x = left;
    int64_t rows = 1;

    for (int64_t k = 0; k < count; k++)
        column = fmax(column, 44.0 + axis_width(signs[k].name, 12.0));
    if (column > right - left)
        column = right - left;
    for (int64_t k = 0; k < count; k++) {
        if (k > 0 && x + column > right) {
            x = left;
            rows++;
        }
        if (draw)
            put_sign(picture, &signs[k], x, top - row * ((double)rows - 0.5));
        x += column;
    }
    return rows;
}
