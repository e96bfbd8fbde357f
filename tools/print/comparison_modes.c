/*
 * The last table of ritz-compare's report, Table 1 of [LeeTsuha1992]: a column
 * for each reduced component and one for each configuration; a dagger stands at
 * modes of the system that were kept and are those of the first stage.
 */
#include "print/comparison.h"

#include <ritz/eigen.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Flexible frequencies of a column of the last table, and which are kept. */
typedef struct column {
    char title[RITZ_NAME_SIZE];
    int64_t count;
    double *hertz;
    bool *kept;
} column;

static void free_columns(int64_t count, column *columns)
{
    for (int64_t k = 0; columns && k < count; k++) {
        free(columns[k].hertz);
        free(columns[k].kept);
    }
    free(columns);
}

/*
 * The stage-2 mode nearest to each kept mode of stage 1 is marked if it is as
 * near as rounding allows: eps lambda_max / lambda_k, times 1000 for the two
 * projections and eigenproblems between them, or 1e-9.
 */
static void mark_kept(const ritz_compare_row *row,
                      const ritz_configuration *first,
                      const ritz_configuration *second, column *out)
{
    double highest = first->lambda[first->K.nrow - 1];

    for (int64_t i = 0; i < row->num_kept; i++) {
        double asked = first->lambda[first->num_rigid + row->kept[i]];
        double best = (double)INFINITY;
        int64_t at = -1;

        for (int64_t k = 0; k < out->count; k++) {
            double apart =
                fabs(second->lambda[second->num_rigid + k] - asked) / asked;

            if (apart < best && !out->kept[k]) {
                best = apart;
                at = k;
            }
        }
        if (at >= 0 && best <= fmax(1e-9, 1e3 * DBL_EPSILON * highest / asked))
            out->kept[at] = true;
    }
}

static ritz_status new_column(const char *title, int64_t count, column *out)
{
    out->hertz = calloc((size_t)count + 1, sizeof *out->hertz);
    out->kept = calloc((size_t)count + 1, sizeof *out->kept);
    RITZ_REFUSE_IF(!out->hertz || !out->kept, RITZ_ERR_MEMORY,
                   "no memory for the report");
    out->count = count;
    snprintf(out->title, sizeof out->title, "%s", title);
    return RITZ_OK;
}

static ritz_status body_column(const char *name, const ritz_reduced *body,
                               column *out)
{
    ritz_status status = RITZ_OK;
    int64_t rigid = 0;
    int64_t count = 0;
    double *hertz = NULL;

    RITZ_TRY(model_hertz(&body->K, &body->M, &rigid, &count, &hertz));
    RITZ_TRY(new_column(name, count - rigid, out));
    for (int64_t k = 0; k < count - rigid; k++)
        out->hertz[k] = hertz[rigid + k];
done:
    free(hertz);
    return status;
}

static ritz_status system_column(int64_t number, const ritz_comparison *c,
                                 column *out)
{
    const ritz_configuration *first = &c->first_system.configuration[number];
    const ritz_configuration *second = &c->second_system.configuration[number];
    char title[32];

    snprintf(title, sizeof title, "#%lld", (long long)number + 1);
    RITZ_CHECK(new_column(title, second->K.nrow - second->num_rigid, out));
    for (int64_t k = 0; k < out->count; k++)
        out->hertz[k] = ritz_eigen_hertz(second->lambda[second->num_rigid + k]);
    mark_kept(&c->row[number], first, second, out);
    return RITZ_OK;
}

static void say_column_line(cli_run *run, int64_t mode, int64_t count,
                            const column *columns)
{
    enum { WIDTH = 13, MOST = 512 };
    char line[MOST] = "";
    size_t used = 0;

    for (int64_t k = 0; k < count && used + WIDTH + WIDTH < MOST; k++) {
        const column *c = &columns[k];

        if (mode < 0)
            used += (size_t)snprintf(line + used, MOST - used, " %10.10s  ",
                                     c->title);
        else if (mode < c->count)
            used += (size_t)snprintf(line + used, MOST - used, " %10.5f%s",
                                     c->hertz[mode],
                                     c->kept[mode] ? " \u2020" : "  ");
        else
            used += (size_t)snprintf(line + used, MOST - used, "%13s", "");
    }
    while (used > 0 && line[used - 1] == ' ')
        line[--used] = '\0';
    if (mode < 0)
        cli_say(run, "%5s%s", "mode", line);
    else
        cli_say(run, "%5lld%s", (long long)mode + 1, line);
}

ritz_status comparison_say_frequencies(cli_run *run, const ritz_comparison *c)
{
    enum { MOST_SYSTEMS = 12 };
    ritz_status status = RITZ_OK;
    const ritz_stage *stage = &c->second;
    json_t *rows = json_object_get(run->report, "configurations");
    int64_t systems = c->second_system.num_configurations;
    int64_t shown = systems < MOST_SYSTEMS ? systems : MOST_SYSTEMS;
    int64_t count = stage->count + systems;
    int64_t longest = 0;
    column *columns = calloc((size_t)count + 1, sizeof *columns);

    RITZ_FAIL_IF(!columns, RITZ_ERR_MEMORY, "no memory for the report");
    for (int64_t k = 0; k < stage->count; k++)
        RITZ_TRY(body_column(stage->scene->component[k].name, &stage->body[k],
                             &columns[k]));
    for (int64_t k = 0; k < systems; k++) {
        const ritz_configuration *at = &c->second_system.configuration[k];
        double *hertz = NULL;

        RITZ_TRY(system_column(k, c, &columns[stage->count + k]));
        RITZ_TRY(model_hertz_at(at, &hertz));
        json_object_set_new(json_array_get(rows, (size_t)k), "frequencies_hz",
                            model_reals_json(at->K.nrow, hertz));
        free(hertz);
    }
    for (int64_t k = 0; k < stage->count + shown; k++)
        longest = columns[k].count > longest ? columns[k].count : longest;
    cli_say(run, "Flexible modes after stage 2, Hz: of each component by "
                 "itself, and of the system at each configuration");
    say_column_line(run, -1, stage->count + shown, columns);
    for (int64_t mode = 0; mode < longest; mode++)
        say_column_line(run, mode, stage->count + shown, columns);
    cli_say(run, "  \u2020 a mode of the stage-1 system that was kept, and is "
                 "there exactly");
    if (shown < systems)
        cli_say(run, "  %lld more configurations are in the output",
                (long long)systems - (long long)shown);
done:
    free_columns(count, columns);
    return status;
}
