/* Chart of switched models: the number of vectors over time, and below it the
   error relative to the first run, which is that of the full model. */
#include "chart/chart.h"

#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"

#include <math.h>

enum {
    MOST_RUNS = 8,
    MOST_POINTS = 600, /* of a line; a page has few more pixels */
    WIDE = 700,
    HIGH = 440,
};

/* A run, and its error at each time that it has in common with the first. */
typedef struct run_errors {
    const char *name;
    const ritz_simulation *run;
    int64_t vectors;    /* number of the diagnostic; -1: `order` at all times */
    int64_t count;      /* common times */
    int64_t *at, *of;   /* count: their numbers in this run and in the first */
    double *error;      /* count: largest error of all outputs, each relative
                         to the largest value of its output */
    double worst, mean; /* largest error; mean number of vectors */
} run_errors;

typedef struct switched_runs {
    int64_t count;
    run_errors run[MOST_RUNS];
} switched_runs;

static void switched_runs_free(switched_runs *all)
{
    for (int64_t w = 0; w < all->count; w++) {
        RITZ_FREE(all->run[w].at);
        RITZ_FREE(all->run[w].of);
        RITZ_FREE(all->run[w].error);
    }
}

static double vectors_at(const run_errors *r, int64_t k)
{
    const ritz_simulation *s = r->run;

    return r->vectors < 0
               ? (double)s->order
               : s->diagnosis[r->at[k] * s->num_diagnostics + r->vectors];
}

/* Find the common times of two runs. Until the shorter one ends, as where it
   was interrupted, one must have all times of the other, which may have been
   written at every few steps. */
static ritz_status find_times(const chart_file *file,
                              const ritz_simulation *full, run_errors *r)
{
    const ritz_simulation *s = r->run;
    const double near = RITZ_SAME * full->seconds[full->count - 1];
    int64_t k = 0, i = 0;

    RITZ_CHECK_NEW(r->at, s->count);
    RITZ_CHECK_NEW(r->of, s->count);
    while (k < s->count && i < full->count) {
        const double off = s->seconds[k] - full->seconds[i];

        if (fabs(off) <= near) {
            r->at[r->count] = k;
            r->of[r->count++] = i;
        }
        k += off <= near;
        i += off >= -near;
    }
    RITZ_REFUSE_IF(r->count < k && r->count < i, RITZ_ERR_ARGUMENT,
                   "'%s' has other times than the first run", file->path);
    RITZ_REFUSE_IF(r->count < 2, RITZ_ERR_ARGUMENT,
                   "'%s' and the first run have fewer than two times in common",
                   file->path);
    return RITZ_OK;
}

/* Raise the errors to those of an output. */
static void add_output(const ritz_simulation *full, int64_t i, run_errors *r)
{
    const ritz_simulation *s = r->run;
    const int64_t other =
        ritz_name_index(s->num_outputs, s->output, full->output[i]);
    double size = 0.0;

    for (int64_t k = 0; k < full->count; k++)
        size = fmax(size, fabs(full->y[k * full->num_outputs + i]));
    for (int64_t k = 0; size > 0.0 && k < r->count; k++)
        r->error[k] =
            fmax(r->error[k], fabs(s->y[r->at[k] * s->num_outputs + other] -
                                   full->y[r->of[k] * full->num_outputs + i]) /
                                  size);
}

static ritz_status take_run(const chart_file *file, const ritz_simulation *full,
                            switched_runs *all)
{
    const ritz_simulation *s = &file->model.simulation;
    run_errors *r = &all->run[all->count];

    RITZ_REFUSE_IF(all->count == MOST_RUNS, RITZ_ERR_ARGUMENT,
                   "more than %d runs cannot be told apart", (int)MOST_RUNS);
    RITZ_REFUSE_IF(s->count < 2, RITZ_ERR_ARGUMENT,
                   "'%s' has no output over time", file->path);
    RITZ_CHECK(chart_check_names(file->path, "output", s->num_outputs,
                                 s->output, full->num_outputs, full->output));
    *r = (run_errors){.name = ritz_path_name(file->path), .run = s};
    all->count++;
    RITZ_CHECK(find_times(file, full, r));
    RITZ_CHECK_NEW(r->error, r->count);
    r->vectors = ritz_name_index(s->num_diagnostics, s->diagnostic, "vectors");
    for (int64_t i = 0; i < full->num_outputs; i++)
        add_output(full, i, r);
    for (int64_t k = 1; k < r->count; k++) {
        r->worst = fmax(r->worst, r->error[k]);
        r->mean += vectors_at(r, k) / (double)(r->count - 1);
    }
    return RITZ_OK;
}

/* Write the largest error of every few times, and the vectors there. */
static void put_run(const run_errors *r, int64_t w, double floor_value,
                    picture *p)
{
    const ritz_simulation *s = r->run;
    const int64_t few = 1 + r->count / MOST_POINTS;

    for (int64_t k = 1; k < r->count; k += few) {
        int64_t worst = k;

        for (int64_t i = k; i < k + few && i < r->count; i++)
            if (r->error[i] > r->error[worst])
                worst = i;
        fprintf(p->data.file, "%ld\t%.9g\t%g\t%.9g\n", w,
                s->seconds[r->at[worst]], vectors_at(r, worst),
                fmax(r->error[worst], floor_value));
    }
    fputc('\n', p->data.file);
    html_line(p->table.file, r->name);
    fprintf(p->table.file, "\t%.4g\t%.3g\t", r->mean, r->worst);
    html_line(p->table.file, s->integrator);
    fputc('\n', p->table.file);
}

static void put_signs(const switched_runs *all, picture *p)
{
    for (int64_t w = 0; w < all->count; w++)
        picture_add_sign(p,
                         (picture_sign){.colour = svg_series(w),
                                        .dash = (int)w,
                                        .wide = 1.6,
                                        .role = all->run[w].run->integrator},
                         "%.40s: %.3g vectors, error %.2g", all->run[w].name,
                         all->run[w].mean, all->run[w].worst);
}

/* Smaller errors, relative to the largest, are drawn at this value. */
static const double error_floor = 1e-8;

static ritz_status draw_runs(const switched_runs *all,
                             const ritz_simulation *full, picture *p)
{
    double most = 0.0, worst = 0.0;

    for (int64_t w = 0; w < all->count; w++) {
        worst = fmax(worst, all->run[w].worst);
        for (int64_t k = 1; k < all->run[w].count; k++)
            most = fmax(most, vectors_at(&all->run[w], k));
    }
    worst = worst > 0.0 ? worst : 1.0;
    p->wide = WIDE;
    p->body = HIGH;
    put_signs(all, p);
    fprintf(p->data.file, "simulation\tseconds\tvectors\terror\n");
    fprintf(p->table.file,
            "simulation\tvectors a step\tlargest error\tintegrator\n");
    for (int64_t w = 0; w < all->count; w++)
        put_run(&all->run[w], w, worst * error_floor, p);
    fprintf(p->given.file,
            "runs = %ld\nx_low = %.9g\nx_high = %.9g\nmost = %.9g\n"
            "y_low = %.9g\ny_high = %.9g\n",
            all->count, full->seconds[0], full->seconds[full->count - 1], most,
            worst * error_floor, 2.0 * worst);
    return picture_draw(p, "switched.gp", "Switched models",
                        "number of vectors over time, and the error below");
}

ritz_status chart_switched(const chart_sources *sources,
                           const chart_request *request, picture *p)
{
    const ritz_simulation *full = &sources->file->model.simulation;
    RITZ_OWN(switched_runs) all = {0};

    (void)request;
    RITZ_REFUSE_IF(sources->count < 2, RITZ_ERR_ARGUMENT,
                   "give the run of the full model first, and then those that "
                   "are compared with it");
    RITZ_REFUSE_IF(full->count < 2 || full->num_outputs < 1, RITZ_ERR_ARGUMENT,
                   "'%s' has no output over time", sources->file->path);
    for (int64_t k = 1; k < sources->count; k++)
        RITZ_CHECK(take_run(&sources->file[k], full, &all));
    return draw_runs(&all, full, p);
}
