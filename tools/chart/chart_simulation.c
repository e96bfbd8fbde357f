/* Outputs over time, or the diagnostics of runs, several simulations over each
   other. Diagnostics that span decades, as violations of constraints do, have a
   logarithmic scale. */
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

/* A scale is logarithmic if the ratio of the largest to the least positive
   value is above this; values that are smaller by more are drawn at the
   edge. */
static const double decades = 1e5, deepest = 1e-18;

/* Values of a simulation that are drawn. */
typedef struct series {
    int64_t count;
    char (*name)[RITZ_NAME_SIZE];
    const double *value; /* value[k * count + i] */
} series;

typedef struct runs {
    bool diagnostics; /* not outputs */
    int64_t count;
    const ritz_simulation *run[MOST_RUNS];
    const char *name[MOST_RUNS];
    int64_t num_outputs;
    picture *picture;
} runs;

static series series_of(const runs *all, const ritz_simulation *s)
{
    return all->diagnostics
               ? (series){s->num_diagnostics, s->diagnostic, s->diagnosis}
               : (series){s->num_outputs, s->output, s->y};
}

static ritz_status take_runs(const chart_sources *sources, runs *out)
{
    for (int64_t k = 0; k < sources->count; k++) {
        const chart_file *file = &sources->file[k];
        const ritz_simulation *s = &file->model.simulation;
        const series drawn = series_of(out, s);
        const char *what = out->diagnostics ? "diagnostic" : "output";

        RITZ_REFUSE_IF(out->count == MOST_RUNS, RITZ_ERR_ARGUMENT,
                       "more than %d simulations cannot be told apart",
                       (int)MOST_RUNS);
        RITZ_REFUSE_IF(s->count < 2 || drawn.count < 1, RITZ_ERR_ARGUMENT,
                       "'%s' has no %s over time", file->path, what);
        if (out->count > 0)
            RITZ_CHECK(chart_check_names(file->path, what, drawn.count,
                                         drawn.name, out->num_outputs,
                                         series_of(out, out->run[0]).name));
        else
            out->num_outputs =
                drawn.count < MOST_OUTPUTS ? drawn.count : MOST_OUTPUTS;
        out->name[out->count] = ritz_path_name(file->path);
        out->run[out->count++] = s;
    }
    return RITZ_OK;
}

/* Extremes of a line, and its least value above 0. */
typedef struct extremes {
    chart_range y;
    double positive;
} extremes;

/* One output of one run: the least and the largest of every few points. */
static extremes put_line(runs *all, int64_t i, int64_t w)
{
    const ritz_simulation *s = all->run[w];
    const series drawn = series_of(all, s);
    const int64_t few = 1 + 2 * s->count / MOST_POINTS, n = drawn.count;
    const int64_t output =
        ritz_name_index(n, drawn.name, series_of(all, all->run[0]).name[i]);
    const double *value = drawn.value + output;
    FILE *file = all->picture->data.file, *table = all->picture->table.file;
    extremes found = {{HUGE_VAL, -HUGE_VAL}, HUGE_VAL};

    for (int64_t k = 0; k < s->count; k += few) {
        int64_t least = k, most = k;

        for (int64_t p = k; p < k + few && p < s->count; p++) {
            if (value[p * n] < value[least * n])
                least = p;
            if (value[p * n] > value[most * n])
                most = p;
            if (value[p * n] > 0.0)
                found.positive = fmin(found.positive, value[p * n]);
        }
        found.y.low = fmin(found.y.low, value[least * n]);
        found.y.high = fmax(found.y.high, value[most * n]);
        for (int64_t part = 0; part < (least == most ? 1 : 2); part++) {
            int64_t p = (part == 0) == (least <= most) ? least : most;

            fprintf(file, "%ld\t%ld\t%.9g\t%.9g\n", i, w, s->seconds[p],
                    value[p * n]);
        }
    }
    fputc('\n', file);
    html_line(table, drawn.name[output]);
    fprintf(table, "\t");
    html_line(table, all->name[w]);
    fprintf(table, "\t%.6g\t%.6g\t%.6g\t", found.y.low, found.y.high,
            value[(s->count - 1) * n]);
    html_line(table, s->integrator);
    fputc('\n', table);
    return found;
}

/* Whether values with these extremes span decades, and the range of the
   scale. */
static bool choose_scale(const runs *all, extremes found, chart_range *y)
{
    const double most = found.y.high;
    const bool spans = all->diagnostics && found.y.low >= 0.0 && most > 0.0 &&
                       most > decades * found.positive;
    double room = 0.05 * (most - found.y.low);

    *y = found.y;
    if (spans) {
        y->low = 0.5 * fmax(found.positive, most * deepest);
        y->high *= 2.0;
        return true;
    }
    room = room > 0.0 ? room : fmax(0.05 * fabs(most), 0.5);
    y->low -= room;
    y->high += room;
    return false;
}

static void add_signs(const runs *all, picture *p)
{
    for (int64_t w = 0; w < all->count; w++) {
        const bool under = w == 0 && all->count > 1;

        picture_add_sign(
            p,
            (picture_sign){.colour = under ? "pale" : svg_series(w),
                           .dash = (int)w,
                           .wide = w == 0 ? 4.0 : 1.5,
                           .role = all->run[w]->integrator},
            "%.60s", all->name[w]);
    }
}

static void put_lines(runs *all, chart_range *y, double *spans)
{
    for (int64_t i = 0; i < all->num_outputs; i++) {
        extremes found = {{HUGE_VAL, -HUGE_VAL}, HUGE_VAL};

        for (int64_t w = 0; w < all->count; w++) {
            const extremes own = put_line(all, i, w);

            found.y.low = fmin(found.y.low, own.y.low);
            found.y.high = fmax(found.y.high, own.y.high);
            found.positive = fmin(found.positive, own.positive);
        }
        spans[i] = choose_scale(all, found, &y[i]) ? 1.0 : 0.0;
    }
}

static ritz_status draw_runs(const chart_sources *sources, runs *all,
                             const char *title, const char *description)
{
    const ritz_simulation *first = &sources->file->model.simulation;
    double last = 0.0; /* of all runs, some of which may be interrupted */
    picture *p = all->picture;
    chart_range y[MOST_OUTPUTS];
    double spans[MOST_OUTPUTS];

    RITZ_CHECK(take_runs(sources, all));
    add_signs(all, p);
    p->wide = WIDE;
    p->body = (double)(HIGH * all->num_outputs);
    fprintf(p->data.file, "output\tsimulation\tseconds\tvalue\n");
    fprintf(p->table.file,
            "output\tsimulation\tleast\tmost\tlast\tintegrator\n");
    put_lines(all, y, spans);
    for (int64_t w = 0; w < all->count; w++)
        last = fmax(last, all->run[w]->seconds[all->run[w]->count - 1]);
    fprintf(p->given.file,
            "outputs = %ld\nruns = %ld\nx_low = %.9g\nx_high = %.9g\n",
            all->num_outputs, all->count, first->seconds[0], last);
    picture_give_texts(p, "title", all->num_outputs,
                       *series_of(all, first).name,
                       sizeof *series_of(all, first).name);
    picture_give_reals(p, "y_low,y_high", all->num_outputs, &y->low, sizeof *y);
    picture_give_reals(p, "y_log", all->num_outputs, spans, sizeof *spans);
    return picture_draw(p, "simulation.gp", title, description);
}

ritz_status chart_simulation(const chart_sources *sources,
                             const chart_request *request, picture *p)
{
    runs all = {.picture = p};

    (void)request;
    return draw_runs(sources, &all, "Time responses",
                     "outputs over time, one below the other");
}

ritz_status chart_diagnostics(const chart_sources *sources,
                              const chart_request *request, picture *p)
{
    runs all = {.picture = p, .diagnostics = true};

    (void)request;
    return draw_runs(sources, &all, "Diagnostics of runs",
                     "what runs tell of themselves over time");
}
