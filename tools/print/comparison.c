/*
 * The report of ritz-compare: what was reduced, how far, how wrong it is. Its
 * tables of choices are in comparison_choices.c, that of modes in
 * comparison_modes.c.
 */
#include "print/comparison.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* What the composite set is made from. */
static void describe_choice(const ritz_scene *scene, char out[160])
{
    const size_t size = 160;
    bool ranked = scene->num_inputs > 0 && scene->num_outputs > 0;

    switch (scene->select) {
    case RITZ_SELECT_LISTED:
        snprintf(out, size, "modes by a list of %lld",
                 (long long)scene->num_select_modes);
        break;
    case RITZ_SELECT_KRYLOV:
        snprintf(out, size, "up to %lld Krylov vectors from %s at each",
                 (long long)scene->select_vectors,
                 scene->select_outputs ? "inputs and outputs" : "inputs");
        break;
    case RITZ_SELECT_RANKED:
        if (ranked) {
            snprintf(out, size, "modes by %s above %g of the largest value",
                     *scene->select_by ? scene->select_by : "hankel",
                     scene->select_tolerance);
            break;
        }
        [[fallthrough]];
    case RITZ_SELECT_BAND:
        snprintf(out, size, "modes in the band");
        break;
    }
}

static void say_composite(cli_run *run, const ritz_stage *first,
                          const ritz_comparison *c)
{
    const ritz_scene *scene = first->scene;
    int64_t count = scene->num_reference > 0 ? scene->num_reference
                                             : scene->num_configurations;
    int64_t completed = 0;
    char choice[160];

    describe_choice(scene, choice);
    for (int64_t k = 0; k < c->num_rows; k++)
        completed += c->row[k].listed ? c->row[k].num_completed : 0;
    cli_say(run, "Composite set: %lld vectors from %lld configurations, %s,",
            (long long)c->composite, (long long)count, choice);
    cli_say(run, "vectors dependent within %g removed on each component.",
            scene->composite_tolerance);
    if (completed > 0)
        cli_say(run,
                "%lld modes are kept beside those chosen, as a cluster is "
                "never split.",
                (long long)completed);
    if (!c->removed)
        cli_warn(run, "stage two removed nothing: every component kept its "
                      "order; choose fewer modes (select: tolerance) or a "
                      "looser composite tolerance");
    if (!c->removed)
        cli_say(run, "STAGE TWO REMOVED NOTHING: the reduced components are as "
                     "large as those of stage 1.");
    json_object_set_new(run->report, "removed", json_boolean(c->removed));
    cli_report_int(run, "composite", c->composite);
    cli_report_int(run, "completed", completed);
}

void comparison_name_row(const ritz_stage *stage, const ritz_comparison *c,
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
    json_object_set_new(errors, "moments", cli_real(row->moment_error));
    json_object_set_new(item, "at", cli_string(at));
    json_object_set_new(item, "listed", json_boolean(row->listed));
    json_object_set_new(item, "rigid", json_integer(row->num_rigid));
    json_object_set_new(item, "flexible", json_integer(row->num_flexible));
    json_object_set_new(item, "dofs", json_integer(row->order));
    json_object_set_new(item, "vectors", json_integer(row->num_vectors));
    json_object_set_new(item, "moments", json_integer(row->num_moments));
    json_object_set_new(item, "errors", errors);
    return item;
}

/* "1.0e-03", or "-" where there is none. */
static const char *print_error(double error, char out[16])
{
    snprintf(out, 16, isnan(error) ? "-" : "%.1e", error);
    return out;
}

/* One row of the table; listed ones are numbered. */
static void say_row(cli_run *run, const ritz_compare_row *row, int64_t number,
                    const char *at)
{
    char first[24] = "*";
    char chosen[24];
    char text[6][16];
    int64_t kept = row->num_vectors > 0 ? row->num_vectors : row->num_kept;

    if (row->listed)
        snprintf(first, sizeof first, "%lld", (long long)number);
    snprintf(chosen, sizeof chosen, row->listed ? "%lld" : "(%lld)",
             (long long)kept);
    cli_say(run, "%3s  %-28s %5lld %4lld %4s %5lld %9s %9s %9s %9s %9s %9s",
            first, at, (long long)row->num_rigid, (long long)row->num_flexible,
            chosen, (long long)row->order,
            print_error(row->frequency_error, text[0]),
            print_error(row->allowed, text[1]),
            print_error(row->rigid_error, text[2]),
            print_error(row->gain_error, text[3]),
            print_error(row->response_error, text[4]),
            print_error(isnan(row->mac) ? row->mac : fmax(1.0 - row->mac, 0.0),
                        text[5]));
}

static void say_legend(cli_run *run, const ritz_comparison *c)
{
    bool between = c->num_rows > c->first_system.num_configurations;
    int64_t moments = c->row[0].num_moments;
    double worst = nan("");

    for (int64_t k = 0; k < c->num_rows; k++)
        if (c->row[k].listed) {
            worst = fmax(worst, c->row[k].moment_error);
            moments = c->row[k].num_moments < moments ? c->row[k].num_moments
                                                      : moments;
        }
    cli_say(run,
            "  rigid, flex, kept: modes of stage 1%s; order: of the "
            "stage-2 system; frequency of kept modes (and what",
            moments > 0 ? ", kept: Krylov vectors" : "");
    cli_say(run, "  rounding allows it), flexible static gain, response in the "
                 "band: largest relative errors");
    if (between)
        cli_say(run, "  * between listed angles: errors of the modes (so many) "
                     "that would have been kept there");
    if (moments > 0)
        cli_say(run,
                "  the first %lld moments C (K^-1 M)^i K^-1 B are kept, of the "
                "flexible part: worst relative error %.1e",
                (long long)moments, worst);
}

static void say_rows(cli_run *run, const ritz_stage *stage,
                     const ritz_comparison *c)
{
    json_t *array = json_array();
    json_t *kept = json_array();
    double worst = 0.0;

    cli_say(run, "%3s  %-28s %5s %4s %4s %5s %9s %9s %9s %9s %9s %9s", "#",
            "configuration", "rigid", "flex", "kept", "order", "frequency",
            "allowed", "rigid Hz", "gain", "response", "1 - MAC");
    for (int64_t k = 0; k < c->num_rows; k++) {
        const ritz_compare_row *row = &c->row[k];
        json_t *modes = json_array();
        char at[RITZ_NAME_SIZE];

        comparison_name_row(stage, c, row, at);
        say_row(run, row, k + 1, at);
        json_array_append_new(array, row_json(row, at));
        for (int64_t i = 0; row->listed && i < row->num_kept; i++)
            json_array_append_new(modes, json_integer(row->kept[i] + 1));
        if (row->listed)
            json_array_append(kept, modes);
        json_decref(modes);
        if (row->response_error > worst)
            worst = row->response_error;
    }
    say_legend(run, c);
    json_object_set_new(run->report, "configurations", array);
    json_object_set_new(run->report, "kept", kept);
    cli_record_error(run, "response", worst);
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
    comparison_say_candidates(run, first, c);
    cli_say(run, "\nErrors of the stage-2 system against the stage-1 system");
    say_rows(run, first, c);
    comparison_say_suggestion(run, first, c);
    comparison_say_strays(run, first, c);
    cli_say(run, "%s", "");
    return comparison_say_frequencies(run, c);
}
