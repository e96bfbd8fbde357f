/* Outputs over time, several simulations over each other. */
#include "chart/chart.h"

#include "chart/html.h"

#include <math.h>
#include <string.h>

enum {
    MOST_RUNS = 8,
    MOST_OUTPUTS = 6,
    MOST_POINTS = 2000, /* of a line: more than the pixels of a page */
    WIDE = 560,
    HIGH = 210,
    LEFT = 70,
    RIGHT = 22,
};

typedef struct runs {
    int64_t count;
    const ritz_simulation *run[MOST_RUNS];
    const char *name[MOST_RUNS];
    int64_t num_outputs;
    gnuplot *picture;
} runs;

static int64_t find_output(const ritz_simulation *s, const char *name)
{
    for (int64_t k = 0; k < s->num_outputs; k++)
        if (strcmp(s->output[k], name) == 0)
            return k;
    return -1;
}

static ritz_status take_runs(const chart_sources *sources, runs *out)
{
    for (int64_t k = 0; k < sources->count; k++) {
        const chart_file *file = &sources->file[k];
        const ritz_simulation *s = &file->model.simulation;

        if (file->holds != CHART_SIMULATION)
            continue;
        RITZ_REFUSE_IF(out->count == MOST_RUNS, RITZ_ERR_ARGUMENT,
                       "more than %d simulations cannot be told apart",
                       (int)MOST_RUNS);
        RITZ_REFUSE_IF(s->count < 2 || s->num_outputs < 1, RITZ_ERR_ARGUMENT,
                       "'%s' has no output over time", file->path);
        for (int64_t i = 0; i < out->num_outputs; i++)
            RITZ_REFUSE_IF(find_output(s, out->run[0]->output[i]) < 0,
                           RITZ_ERR_ARGUMENT, "'%s' has no output '%s'",
                           file->path, out->run[0]->output[i]);
        if (out->count == 0)
            out->num_outputs =
                s->num_outputs < MOST_OUTPUTS ? s->num_outputs : MOST_OUTPUTS;
        out->name[out->count] = chart_base(file->path);
        out->run[out->count++] = s;
    }
    return RITZ_OK;
}

/* Lines of one output; the least and the largest of each few points stay. */
static void put_lines(const runs *all, int64_t i, axis *y)
{
    FILE *file = all->picture->data.file;

    *y = (axis){.low = HUGE_VAL, .high = -HUGE_VAL};
    for (int64_t w = 0; w < all->count; w++) {
        const ritz_simulation *s = all->run[w];
        int64_t at = find_output(s, all->run[0]->output[i]);
        int64_t few = 1 + 2 * s->count / MOST_POINTS;

        for (int64_t k = 0; k < s->count; k += few) {
            int64_t least = k, most = k;

            for (int64_t p = k; p < k + few && p < s->count; p++) {
                double value = s->y[p * s->num_outputs + at];

                if (value < s->y[least * s->num_outputs + at])
                    least = p;
                if (value > s->y[most * s->num_outputs + at])
                    most = p;
            }
            for (int64_t n = 0; n < (least == most ? 1 : 2); n++) {
                int64_t p = (n == 0) == (least <= most) ? least : most;
                double value = s->y[p * s->num_outputs + at];

                y->low = fmin(y->low, value);
                y->high = fmax(y->high, value);
                fprintf(file, "%lld\t%lld\t%.9g\t%.9g\n", (long long)i,
                        (long long)w, s->seconds[p], value);
            }
        }
        fputc('\n', file);
    }
}

static void put_table(const runs *all, int64_t i)
{
    FILE *file = all->picture->table.file;

    for (int64_t w = 0; w < all->count; w++) {
        const ritz_simulation *s = all->run[w];
        int64_t at = find_output(s, all->run[0]->output[i]);
        double least = HUGE_VAL, most = -HUGE_VAL;

        for (int64_t k = 0; k < s->count; k++) {
            least = fmin(least, s->y[k * s->num_outputs + at]);
            most = fmax(most, s->y[k * s->num_outputs + at]);
        }
        html_line(file, s->output[at]);
        fprintf(file, "\t");
        html_line(file, all->name[w]);
        fprintf(file, "\t%.6g\t%.6g\t%.6g\t%s\n", least, most,
                s->y[(s->count - 1) * s->num_outputs + at], s->integrator);
    }
}

static void put_output(const runs *all, int64_t i, double bottom)
{
    const ritz_simulation *first = all->run[0];
    chart_area area = {.left = LEFT,
                       .right = WIDE - RIGHT,
                       .bottom = bottom + 48.0,
                       .top = bottom + HIGH - 30.0};
    double values[2];
    FILE *file = all->picture->plot.file;

    put_lines(all, i, &area.y);
    values[0] = area.y.low;
    values[1] = area.y.high;
    area.y = axis_linear(2, values, false);
    area.x = (axis){.low = first->seconds[0],
                    .high = first->seconds[first->count - 1]};
    chart_area_begin(all->picture, &area, first->output[i], "s", "");
    fprintf(file, "set ytics %.3g\nplot NaN notitle",
            pow(10.0, floor(log10(area.y.high - area.y.low))));
    for (int64_t w = 0; w < all->count; w++)
        fprintf(file,
                ", \\\n  data skip 1 using (($1 == %lld && $2 == %lld) ? $3 : "
                "NaN):4 with lines lw %s lc rgb '%s' dt %lld notitle",
                (long long)i, (long long)w, w == 0 ? "4" : "1.5",
                w == 0 && all->count > 1 ? SVG_PALE : chart_colour(w),
                (long long)(w < 2 ? 1 : w));
    fprintf(file, "\n");
    put_table(all, i);
}

static ritz_status compose(const runs *all)
{
    chart_sign signs[MOST_RUNS];
    double foot = 0.0;

    for (int64_t w = 0; w < all->count; w++) {
        signs[w] = (chart_sign){
            .colour = w == 0 && all->count > 1 ? SVG_PALE : chart_colour(w),
            .dash = (int)(w < 2 ? 1 : w),
            .wide = w == 0 ? 4.0 : 0.0};
        snprintf(signs[w].name, CHART_WORD, "%.60s, %.60s", all->name[w],
                 all->run[w]->integrator);
    }
    foot = 12.0 + 20.0 * (double)chart_legend(all->picture, all->count, signs,
                                              LEFT, 0.0, WIDE - RIGHT, false);
    gnuplot_size(all->picture, WIDE, foot + (double)(HIGH * all->num_outputs));
    fprintf(all->picture->data.file, "output\tsimulation\tseconds\tvalue\n");
    fprintf(all->picture->table.file,
            "output\tsimulation\tleast\tmost\tlast\tintegrator\n");
    fprintf(all->picture->plot.file, "set multiplot\n");
    for (int64_t i = 0; i < all->num_outputs; i++)
        put_output(all, i, foot + (double)((all->num_outputs - 1 - i) * HIGH));
    chart_canvas(all->picture);
    chart_legend(all->picture, all->count, signs, LEFT, foot - 4.0,
                 WIDE - RIGHT, true);
    fprintf(all->picture->plot.file, "plot NaN notitle\nunset multiplot\n");
    return gnuplot_draw(all->picture, "Time responses",
                        "outputs over time, one below the other");
}

ritz_status chart_simulation(const chart_sources *sources,
                             const chart_wish *wish, gnuplot *out)
{
    runs all = {.picture = out};

    RITZ_CHECK(take_runs(sources, &all));
    RITZ_CHECK(gnuplot_new(wish->path, wish->keep, out));
    return compose(&all);
}
