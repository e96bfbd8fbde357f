/*
 * The report of ritz-compare: what was reduced, how far, how wrong it is.
 *
 * Its last table is Table 1 of [LeeTsuha1992], a column for each reduced
 * component and one for each configuration; a dagger stands at modes of the
 * system that were kept and are those of the first stage.
 */
#include "comparison.h"

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

static int64_t order_of(const ritz_reduced *body)
{
    return body->K.nrow > 0 ? body->K.nrow : body->M.nrow;
}

static void say_orders(cli_run *run, const ritz_stage *first,
                       const ritz_stage *second)
{
    json_t *array = json_array();
    int64_t sum[3] = {0};

    cli_say(run, "%-20s %10s %10s %10s  %s", "component", "full dofs",
            "stage 1", "stage 2", "basis of stage 1");
    for (int64_t k = 0; k < first->count; k++) {
        const ritz_reduced *body = &first->body[k];
        const char *name = first->scene->component[k].name;
        int64_t order[] = {body->num_dofs, order_of(body),
                           order_of(&second->body[k])};
        json_t *item = json_object();

        for (int i = 0; i < 3; i++)
            sum[i] += order[i];
        cli_say(run, "%-20s %10lld %10lld %10lld  %s", name,
                (long long)order[0], (long long)order[1], (long long)order[2],
                body->origin.method);
        json_object_set_new(item, "name", cli_string(name));
        json_object_set_new(item, "dofs_full", json_integer(order[0]));
        json_object_set_new(item, "stage1", json_integer(order[1]));
        json_object_set_new(item, "dofs", json_integer(order[2]));
        json_array_append_new(array, item);
    }
    cli_say(run, "%-20s %10lld %10lld %10lld", "total", (long long)sum[0],
            (long long)sum[1], (long long)sum[2]);
    json_object_set_new(run->report, "components", array);
    cli_record(run, "compare", sum[2]);
}

static void say_composite(cli_run *run, const ritz_stage *first,
                          const ritz_comparison *c)
{
    const ritz_scene *scene = first->scene;
    const char *rank = *scene->select_by ? scene->select_by : "hankel";
    int64_t count = scene->num_reference > 0 ? scene->num_reference
                                             : scene->num_configurations;

    cli_say(run,
            "Composite mode set: %lld vectors from %lld configurations, "
            "modes by %s above %g of the",
            (long long)c->composite, (long long)count, rank,
            scene->select_tolerance);
    cli_say(run,
            "largest value, vectors dependent within %g removed on each "
            "component.",
            scene->composite_tolerance);
    if (!c->removed)
        cli_warn(run, "stage two removed nothing: every component kept its "
                      "order; choose fewer modes (select: tolerance) or a "
                      "looser composite tolerance");
    if (!c->removed)
        cli_say(run, "STAGE TWO REMOVED NOTHING: the reduced components are as "
                     "large as those of stage 1.");
    json_object_set_new(run->report, "removed", json_boolean(c->removed));
    cli_report_int(run, "composite", c->composite);
}

static void name_row(const ritz_stage *stage, const ritz_comparison *c,
                     const ritz_compare_row *row, char out[RITZ_NAME_SIZE])
{
    const ritz_system *system = &c->second_system;

    snprintf(out, RITZ_NAME_SIZE, "as joined");
    if (stage->scene->num_sweeps > 0)
        ritz_configuration_name(system->num_sweeps,
                                (const char(*)[RITZ_NAME_SIZE])system->sweep,
                                row->setting, out);
}

static json_t *row_json(const ritz_compare_row *row, const char *at)
{
    json_t *item = json_object();
    json_t *errors = json_object();

    json_object_set_new(errors, "frequency", cli_real(row->frequency_error));
    json_object_set_new(errors, "frequency_allowed", cli_real(row->allowed));
    json_object_set_new(errors, "rigid_hz", cli_real(row->rigid_error));
    json_object_set_new(errors, "gain", cli_real(row->gain_error));
    json_object_set_new(errors, "response", cli_real(row->response_error));
    json_object_set_new(errors, "mac", cli_real(row->mac));
    json_object_set_new(item, "at", cli_string(at));
    json_object_set_new(item, "listed", json_boolean(row->listed));
    json_object_set_new(item, "rigid", json_integer(row->num_rigid));
    json_object_set_new(item, "flexible", json_integer(row->num_flexible));
    json_object_set_new(item, "dofs", json_integer(row->order));
    json_object_set_new(item, "errors", errors);
    return item;
}

/* One row for each configuration; the listed ones are numbered. */
static void say_rows(cli_run *run, const ritz_stage *stage,
                     const ritz_comparison *c)
{
    json_t *array = json_array();
    json_t *kept = json_array();
    int64_t between = 0;
    double worst = 0.0;

    cli_say(run, "%3s  %-28s %5s %4s %4s %5s %9s %9s %9s %9s %9s %9s", "#",
            "configuration", "rigid", "flex", "kept", "order", "frequency",
            "allowed", "rigid Hz", "gain", "response", "1 - MAC");
    for (int64_t k = 0; k < c->num_rows; k++) {
        const ritz_compare_row *row = &c->row[k];
        json_t *modes = json_array();
        char at[RITZ_NAME_SIZE];
        char number[24] = "*";
        char chosen[24];
        char allowed[24] = "-";

        name_row(stage, c, row, at);
        if (row->listed) {
            snprintf(number, sizeof number, "%lld", (long long)k + 1);
            snprintf(allowed, sizeof allowed, "%.1e", row->allowed);
        }
        snprintf(chosen, sizeof chosen, row->listed ? "%lld" : "(%lld)",
                 (long long)row->num_kept);
        between += !row->listed;
        cli_say(run,
                "%3s  %-28s %5lld %4lld %4s %5lld %9.1e %9s %9.1e %9.1e %9.1e "
                "%9.1e",
                number, at, (long long)row->num_rigid,
                (long long)row->num_flexible, chosen, (long long)row->order,
                row->frequency_error, allowed, row->rigid_error,
                row->gain_error, row->response_error,
                fmax(1.0 - row->mac, 0.0));
        json_array_append_new(array, row_json(row, at));
        for (int64_t i = 0; row->listed && i < row->num_kept; i++)
            json_array_append_new(modes, json_integer(row->kept[i] + 1));
        if (row->listed)
            json_array_append(kept, modes);
        json_decref(modes);
        if (row->response_error > worst)
            worst = row->response_error;
    }
    cli_say(run, "  rigid, flex, kept: modes of stage 1; order: of the stage-2 "
                 "system; frequency of kept modes (and what");
    cli_say(run, "  rounding allows it), flexible static gain, response in the "
                 "band: largest relative errors");
    if (between > 0)
        cli_say(run, "  * between listed angles: errors of the modes (so many) "
                     "that would have been kept there");
    json_object_set_new(run->report, "configurations", array);
    json_object_set_new(run->report, "kept", kept);
    cli_record_error(run, "response", worst);
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
    ritz_status status = RITZ_OK;

    out->hertz = calloc((size_t)count + 1, sizeof *out->hertz);
    out->kept = calloc((size_t)count + 1, sizeof *out->kept);
    RITZ_FAIL_IF(!out->hertz || !out->kept, RITZ_ERR_MEMORY,
                 "no memory for the report");
    out->count = count;
    snprintf(out->title, sizeof out->title, "%s", title);
done:
    return status;
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
    ritz_status status = RITZ_OK;
    const ritz_configuration *first = &c->first_system.configuration[number];
    const ritz_configuration *second = &c->second_system.configuration[number];
    char title[32];

    snprintf(title, sizeof title, "#%lld", (long long)number + 1);
    RITZ_TRY(new_column(title, second->K.nrow - second->num_rigid, out));
    for (int64_t k = 0; k < out->count; k++)
        out->hertz[k] = ritz_eigen_hertz(second->lambda[second->num_rigid + k]);
    mark_kept(&c->row[number], first, second, out);
done:
    return status;
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

static ritz_status say_frequencies(cli_run *run, const ritz_comparison *c)
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

ritz_status comparison_say(cli_run *run, const ritz_stage *first,
                           const ritz_comparison *c)
{
    const ritz_scene *scene = first->scene;
    char band[64] = "no band";

    if (scene->band_hz[1] > 0.0)
        snprintf(band, sizeof band, "band %g to %g Hz", scene->band_hz[0],
                 scene->band_hz[1]);
    cli_say(run,
            "Two-stage reduction of '%s', %lld configurations, %s "
            "[LeeTsuha1992]\n",
            *scene->name ? scene->name : run->operand[0],
            (long long)scene->num_configurations, band);
    say_orders(run, first, &c->second);
    cli_say(run, "%s", "");
    say_composite(run, first, c);
    cli_say(run, "\nErrors of the stage-2 system against the stage-1 system");
    say_rows(run, first, c);
    cli_say(run, "%s", "");
    return say_frequencies(run, c);
}
