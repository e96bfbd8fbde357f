/* The picture of likenesses: one colour, the more of it the more alike. */
#include "chart/chart_mac.h"

#include "chart/html.h"

#include <math.h>

/* Cells are numbered up to so many. */
enum { NUMBERED = 24 };

static void say_mode(const mac_shapes *s, int64_t k, char out[32])
{
    if (isnan(s->hertz[k]))
        snprintf(out, 32, "%lld", (long long)k + 1);
    else
        snprintf(out, 32, "%lld: %.3g", (long long)k + 1, s->hertz[k]);
}

static void put_data(const mac_shapes *a, const mac_shapes *b,
                     const int64_t *row, gnuplot *out)
{
    FILE *data = out->data.file, *table = out->table.file;
    char x[32], y[32];

    fprintf(data, "column\trow\tmac\ttip\n");
    html_line(table, a->name);
    for (int64_t j = 0; j < b->count; j++) {
        say_mode(b, j, x);
        fprintf(table, "\t%s", x);
    }
    for (int64_t i = 0; i < a->count; i++) {
        say_mode(a, i, y);
        fprintf(table, "\n%s", y);
        for (int64_t j = 0; j < b->count; j++) {
            double mac = mac_of(a, b, row, i, j);
            int64_t tip = 0;

            say_mode(b, j, x);
            tip = gnuplot_tip(out, "%.60s %s Hz\n%.60s %s Hz\nMAC %.4f",
                              a->name, y, b->name, x, mac);
            fprintf(data, "%lld\t%lld\t%.6g\t%lld\n", (long long)j,
                    (long long)i, mac, (long long)tip);
            fprintf(table, "\t%.4f", mac);
        }
        fprintf(data, "\n");
    }
    fprintf(table, "\n");
}

/* Of the longest name of a mode, pixels. */
static double wide_of(const mac_shapes *s)
{
    double wide = 0.0;
    char word[32];

    for (int64_t k = 0; k < s->count; k++) {
        say_mode(s, k, word);
        wide = fmax(wide, axis_width(word, 11.0));
    }
    return wide;
}

static void put_tics(FILE *file, char which, const mac_shapes *s,
                     const char *how)
{
    int64_t step = 1 + (s->count - 1) / 30;
    char word[32];

    fprintf(file, "set %ctics nomirror noenhanced %s (", which, how);
    for (int64_t k = 0; k < s->count; k += step) {
        say_mode(s, k, word);
        fprintf(file, "%s'%s' %lld", k > 0 ? ", " : "", word, (long long)k);
    }
    fprintf(file, ") font ',11' tc rgb '" SVG_MUTED "'\n");
}

/* One colour, the more of it the more alike: legible on any paper. */
static void put_plot(const mac_shapes *a, const mac_shapes *b, gnuplot *out)
{
    FILE *file = out->plot.file;

    put_tics(file, 'x', b, "rotate by 60 right");
    put_tics(file, 'y', a, "");
    fprintf(file,
            "unset grid\nset tics scale 0\nset style fill solid 1 noborder\n"
            "shade(x) = (int(255.5 * (1 - 0.94 * x - 0.06)) << 24) + 0x%s\n"
            "plot data skip 1 using 1:2:(0.48):(0.48):(shade($3)) with "
            "boxxyerror lc rgb variable notitle, \\\n"
            "  data skip 1 using 1:2:4 with labels hypertext point pt 7 ps 0.1 "
            "lc rgb '#ff%s' notitle",
            svg_colour[0] + 1, svg_colour[0] + 1);
    if (a->count <= NUMBERED && b->count <= NUMBERED)
        fprintf(file,
                ", \\\n  data skip 1 using ($3 < 0.5 ? NaN : $1):2:"
                "(sprintf('%%.2f', $3)) with labels font ',10' "
                "tc rgb '" SVG_PAPER "' notitle"
                ", \\\n  data skip 1 using (($3 >= 0.5 || $3 < 0.005) ? NaN : "
                "$1):2:(sprintf('%%.2f', $3)) with labels font ',10' "
                "tc rgb '" SVG_INK "' notitle");
    fprintf(file, "\n");
}

/* What the colour says, beside the cells: from 1 at the top down to 0. */
static void put_scale(const chart_area *area, gnuplot *out)
{
    enum { STEPS = 11, STEP = 10, WIDE = 12 };
    const char *const how = "font ',11' tc rgb '" SVG_MUTED "'";
    const double left = area->right + 18.0;
    const double word = left + WIDE + 6.0;

    for (int k = 0; k < STEPS; k++) {
        double top = area->top - 1.0 - STEP * k;
        double mac = 1.0 - (double)k / (STEPS - 1);

        fprintf(out->plot.file,
                "set object %d rectangle from screen %.6f, screen %.6f to "
                "screen %.6f, screen %.6f fc rgb '#%02x%s' fs solid noborder\n",
                k + 1, left / out->wide, (top - STEP) / out->high,
                (left + WIDE) / out->wide, top / out->high,
                (unsigned)(255.5 * (0.94 - 0.94 * mac)), svg_colour[0] + 1);
        if (k == 0 || 2 * k == STEPS - 1 || k == STEPS - 1)
            chart_text(out, word, top - 0.5 * STEP,
                       k == 0           ? "1"
                       : k == STEPS - 1 ? "0"
                                        : "0.5",
                       how);
    }
}

/* As many modes can be told apart as there are inputs and outputs. */
static bool has_note(const mac_shapes *a, const mac_shapes *b)
{
    return a->num_seen > 0 &&
           (a->num_seen < a->count || a->num_seen < b->count);
}

static void put_note(const mac_shapes *a, const mac_shapes *b, gnuplot *out)
{
    char text[CHART_WORD];

    if (!has_note(a, b))
        return;
    snprintf(text, sizeof text,
             "%lld inputs and outputs tell no more modes apart than that: "
             "likeness can be chance",
             (long long)a->num_seen);
    chart_text(out, 20.0, 12.0, text, "font ',11' tc rgb '" SVG_MUTED "'");
}

ritz_status mac_draw(const mac_shapes *a, const mac_shapes *b,
                     const int64_t *row, const char *how, gnuplot *out)
{
    int64_t most = a->count > b->count ? a->count : b->count;
    double cell = most <= NUMBERED ? 34.0 : 640.0 / (double)most;
    chart_area area = {.left = 44.0 + wide_of(a),
                       .bottom = has_note(a, b) ? 124.0 : 100.0};
    char title[4 * CHART_WORD];

    area.right = area.left + cell * (double)b->count;
    area.top = area.bottom + cell * (double)a->count;
    area.x = (axis){.low = -0.5, .high = (double)b->count - 0.5};
    area.y = (axis){.low = (double)a->count - 0.5, .high = -0.5};
    snprintf(title, sizeof title, "MAC of %.160s and %.160s, %s", a->name,
             b->name, how);
    gnuplot_size(
        out,
        fmax(area.right + 64.0, area.left + axis_width(title, 14.0) + 10.0),
        area.top + 40.0);
    chart_area_begin(out, &area, title, b->name, a->name);
    put_note(a, b, out);
    put_scale(&area, out);
    put_data(a, b, row, out);
    put_plot(a, b, out);
    return gnuplot_draw(out, title,
                        "likeness of mode shapes: 1 the same, 0 nothing in "
                        "common");
}
