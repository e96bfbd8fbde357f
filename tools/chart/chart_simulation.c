/* Outputs over time, several simulations over each other. */
#include "chart/chart.h"

#include "base/text.h"

#include <math.h>

enum {
    MOST_RUNS = 8,
    MOST_OUTPUTS = 6,
    MOST_POINTS = 2000, /* points of a line; a page has fewer pixels */
    WIDE = 560,
    HIGH = 210,
};

typedef struct runs {
    int64_t count;
    const ritz_simulation *run[MOST_RUNS];
    const char *name[MOST_RUNS];
    int64_t num_outputs;
    picture *picture;
} runs;

static ritz_status take_runs(const chart_sources *sources, runs *out)
{
    for (int64_t k = 0; k < sources->count; k++) {
        const chart_file *file = &sources->file[k];
        const ritz_simulation *s = &file->model.simulation;

        RITZ_REFUSE_IF(out->count == MOST_RUNS, RITZ_ERR_ARGUMENT,
                       "more than %d simulations cannot be told apart",
                       (int)MOST_RUNS);
        RITZ_REFUSE_IF(s->count < 2 || s->num_outputs < 1, RITZ_ERR_ARGUMENT,
                       "'%s' has no output over time", file->path);
        if (out->count > 0)
            RITZ_CHECK(chart_check_names(file->path, "output", s->num_outputs,
                                         s->output, out->num_outputs,
                                         out->run[0]->output));
        else
            out->num_outputs =
                s->num_outputs < MOST_OUTPUTS ? s->num_outputs : MOST_OUTPUTS;
        out->name[out->count] = ritz_path_name(file->path);
        out->run[out->count++] = s;
    }
    return RITZ_OK;
}

/* One output of one run; of each few points the least and the largest stay.
   Returns its extremes. */
static chart_range put_line(runs *all, int64_t i, int64_t w)
{
    const ritz_simulation *s = all->run[w];
    const int64_t few = 1 + 2 * s->count / MOST_POINTS, n = s->num_outputs;
    const int64_t output =
        ritz_name_index(s->num_outputs, s->output, all->run[0]->output[i]);
    FILE *file = all->picture->data.file, *table = all->picture->table.file;
    chart_range y = {HUGE_VAL, -HUGE_VAL};

    for (int64_t k = 0; k < s->count; k += few) {
        int64_t least = k, most = k;

        for (int64_t p = k; p < k + few && p < s->count; p++) {
            if (s->y[p * n + output] < s->y[least * n + output])
                least = p;
            if (s->y[p * n + output] > s->y[most * n + output])
                most = p;
        }
        y.low = fmin(y.low, s->y[least * n + output]);
        y.high = fmax(y.high, s->y[most * n + output]);
        for (int64_t part = 0; part < (least == most ? 1 : 2); part++) {
            int64_t p = (part == 0) == (least <= most) ? least : most;

            fprintf(file, "%ld\t%ld\t%.9g\t%.9g\n", i, w, s->seconds[p],
                    s->y[p * n + output]);
        }
    }
    fputc('\n', file);
    html_line(table, s->output[output]);
    fprintf(table, "\t");
    html_line(table, all->name[w]);
    fprintf(table, "\t%.6g\t%.6g\t%.6g\t", y.low, y.high,
            s->y[(s->count - 1) * n + output]);
    html_line(table, s->integrator);
    fputc('\n', table);
    return y;
}

ritz_status chart_simulation(const chart_sources *sources,
                             const chart_request *request, picture *p)
{
    const ritz_simulation *first = &sources->file->model.simulation;
    runs all = {.picture = p};
    chart_range y[MOST_OUTPUTS];

    (void)request;
    RITZ_CHECK(take_runs(sources, &all));
    for (int64_t w = 0; w < all.count; w++) {
        const bool under = w == 0 && all.count > 1;

        picture_add_sign(
            p,
            (picture_sign){.colour = under ? "pale" : svg_series(w),
                           .dash = (int)w,
                           .wide = w == 0 ? 4.0 : 1.5,
                           .role = all.run[w]->integrator},
            "%.60s", all.name[w]);
    }
    p->wide = WIDE;
    p->body = (double)(HIGH * all.num_outputs);
    fprintf(p->data.file, "output\tsimulation\tseconds\tvalue\n");
    fprintf(p->table.file,
            "output\tsimulation\tleast\tmost\tlast\tintegrator\n");
    for (int64_t i = 0; i < all.num_outputs; i++) {
        double room = 0.0;

        y[i] = (chart_range){HUGE_VAL, -HUGE_VAL};
        for (int64_t w = 0; w < all.count; w++) {
            const chart_range own = put_line(&all, i, w);

            y[i].low = fmin(y[i].low, own.low);
            y[i].high = fmax(y[i].high, own.high);
        }
        room = 0.05 * (y[i].high - y[i].low);
        room = room > 0.0 ? room : fmax(0.05 * fabs(y[i].high), 0.5);
        y[i].low -= room;
        y[i].high += room;
    }
    fprintf(p->given.file,
            "outputs = %ld\nruns = %ld\nx_low = %.9g\nx_high = %.9g\n",
            all.num_outputs, all.count, first->seconds[0],
            first->seconds[first->count - 1]);
    picture_give_texts(p, "title", all.num_outputs, first->output[0],
                       sizeof *first->output);
    picture_give_reals(p, "y_low,y_high", all.num_outputs, &y->low, sizeof *y);
    return picture_draw(p, "simulation.gp", "Time responses",
                        "outputs over time, one below the other");
}
