/* Bars of values by mode. */
#include "print/rankings.h"

#include "chart/html.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the largest value: what is less is left out of the picture. */
static const double invisible = 1e-12;

/* Rankings of different kinds share one axis only as parts of their largest. */
static bool is_mixed(const contest *all)
{
    for (int64_t c = 1; c < all->count; c++)
        if (strcmp(all->ranking[c]->by, all->ranking[0]->by) != 0)
            return true;
    return false;
}

static double largest_of(const ritz_ranking *r)
{
    return r->count > 0 ? fabs(r->value[r->order[0]]) : 0.0;
}

static int64_t number_of(const contest *all, int64_t c, int64_t mode)
{
    return all->track[c] ? all->track[c][mode] : mode;
}

/* Mode of that number in ranking c; -1: none. */
static int64_t find(const contest *all, int64_t c, int64_t number)
{
    for (int64_t k = 0; k < all->ranking[c]->count; k++)
        if (number_of(all, c, k) == number)
            return k;
    return -1;
}

/* Magnitude of a number in ranking c, as drawn; NaN: nothing to see. */
static double height(const contest *all, int64_t c, int64_t number, bool mixed)
{
    const ritz_ranking *r = all->ranking[c];
    int64_t mode = find(all, c, number);
    double top = largest_of(r);

    if (mode < 0 || !(fabs(r->value[mode]) > invisible * top))
        return nan("");
    return fabs(r->value[mode]) / (mixed ? top : 1.0);
}

/* Numbers that are among the first few of some ranking, ascending. */
static ritz_status pick(const contest *all, int64_t most, int64_t *count,
                        int64_t **out)
{
    int64_t *number = calloc((size_t)(all->count * most) + 1, sizeof *number);
    int64_t n = 0;

    RITZ_REFUSE_IF(!number, RITZ_ERR_MEMORY, "no memory for a chart");
    for (int64_t c = 0; c < all->count; c++)
        for (int64_t k = 0; k < all->ranking[c]->count && k < most; k++) {
            int64_t wanted = number_of(all, c, all->ranking[c]->order[k]);
            int64_t at = n;

            while (at > 0 && number[at - 1] > wanted)
                at--;
            if (at > 0 && number[at - 1] == wanted)
                continue;
            memmove(number + at + 1, number + at,
                    (size_t)(n - at) * sizeof *number);
            number[at] = wanted;
            n++;
        }
    *count = n;
    *out = number;
    return RITZ_OK;
}

static double hertz_of(const contest *all, int64_t number)
{
    int64_t c = 0;

    while (find(all, c, number) < 0)
        c++;
    return all->ranking[c]->hertz[find(all, c, number)];
}

/* mode, label, then a column for each ranking. */
static void write_data(gnuplot *picture, const contest *all, int64_t count,
                       const int64_t *number)
{
    FILE *file = picture->data.file;
    bool mixed = is_mixed(all);
    const char *noun = all->track[0] ? "track" : "mode";

    fprintf(file, "mode\tlabel");
    for (int64_t c = 0; c < all->count; c++) {
        fprintf(file, "\t");
        html_line(file, all->name[c]);
    }
    fprintf(file, "\n");
    for (int64_t k = 0; k < count; k++) {
        long long named = (long long)number[k] + 1;
        double hertz = hertz_of(all, number[k]);

        fprintf(file, "%lld\t%lld: %.3g", named, named, hertz);
        for (int64_t c = 0; c < all->count; c++) {
            double value = height(all, c, number[k], mixed);

            fprintf(file, "\t%.6g", value);
            gnuplot_tip(picture, "%s %lld, %.4g Hz\n%s: %.4g", noun, named,
                        hertz, all->name[c], value);
        }
        fprintf(file, "\n");
    }
}

/* Bars stand side by side, c of n in each mode's place. */
static void write_bars(FILE *file, const contest *all)
{
    double wide = 0.8 / (double)all->count;

    fprintf(file, "set boxwidth %.5f absolute\nplot ", 0.94 * wide);
    for (int64_t c = 0; c < all->count; c++) {
        double shift = wide * ((double)c - 0.5 * (double)(all->count - 1));

        fprintf(file,
                "%sdata skip 1 using ($0 + (%.5f)):%lld with boxes "
                "lc rgb '%s' title ",
                c > 0 ? ", \\\n  " : "", shift, (long long)c + 3,
                svg_colour[c % SVG_COLOURS]);
        gnuplot_quote(file, all->name[c]);
        fprintf(file,
                ", \\\n  data skip 1 using ($0 + (%.5f)):($%lld * 0.93):($0 * "
                "%lld + "
                "%lld) with labels hypertext point pt 7 ps 0.3 lc rgb '%s' "
                "notitle",
                shift, (long long)c + 3, (long long)all->count, (long long)c,
                svg_colour[c % SVG_COLOURS]);
    }
    fprintf(file, "\n");
}

static void write_script(gnuplot *picture, const char *title,
                         const contest *all, int64_t count,
                         const int64_t *number)
{
    double wide = 220.0 + (double)(count * (14 + 7 * all->count));
    FILE *file = picture->plot.file;

    gnuplot_size(picture, fmin(fmax(wide, 640.0), 2400.0), 480.0);
    fprintf(file, "set title ");
    gnuplot_quote(file, title);
    fprintf(file,
            " noenhanced tc rgb '" SVG_INK "'\nset logscale y\n"
            "set format y '10^{%%L}'\n"
            "set ylabel '%s' noenhanced tc rgb '" SVG_INK "'\n"
            "set xlabel '%s: Hz' offset 0,1.7 tc rgb '" SVG_INK "'\n"
            "set grid y lc rgb '" SVG_GRID "' lt 1\nset key below center "
            "horizontal Left reverse noenhanced tc rgb '" SVG_INK "'\n"
            "set border 3\nset tics scale 0.6\nset ytics nomirror tc rgb "
            "'" SVG_MUTED "'\n"
            "set xtics rotate by 60 right nomirror noenhanced font ',11' "
            "tc rgb '" SVG_MUTED "'\nset xrange [-0.7:%g]\n"
            "set style fill solid 1 noborder\n",
            is_mixed(all) ? "part of the largest value" : all->ranking[0]->by,
            all->track[0] ? "track" : "mode", (double)count - 0.3);
    fprintf(file, "set xtics (");
    for (int64_t k = 0; k < count; k++)
        fprintf(file, "%s'%lld: %.3g' %lld", k > 0 ? ", " : "",
                (long long)number[k] + 1, hertz_of(all, number[k]),
                (long long)k);
    fprintf(file, ")\n");
    write_bars(file, all);
}

ritz_status rankings_plot(gnuplot *picture, const char *title,
                          const contest *all, int64_t most)
{
    ritz_status status = RITZ_OK;
    double largest = 0.0;
    int64_t *number = NULL;
    int64_t count = 0;

    for (int64_t c = 0; c < all->count; c++)
        largest = fmax(largest, largest_of(all->ranking[c]));
    RITZ_FAIL_IF(!(largest > 0.0), RITZ_ERR_ARGUMENT,
                 "no mode has a value that could be drawn");
    RITZ_TRY(pick(all, most, &count, &number));
    write_data(picture, all, count, number);
    write_script(picture, title, all, count, number);
    RITZ_TRY(gnuplot_draw(picture, title, "values of modes as bars"));
done:
    free(number);
    return status;
}

ritz_status rankings_draw(const char *path, const char *title,
                          const contest *all, int64_t most)
{
    ritz_status status = RITZ_OK;
    gnuplot picture = {0};

    RITZ_TRY(gnuplot_new(path, true, &picture));
    RITZ_TRY(rankings_plot(&picture, title, all, most));
done:
    gnuplot_free(&picture);
    return status;
}
