/* What ritz-compare weighs: attached dofs, extraneous modes, angles to add. */
#include "cli/cli_table.h"
#include "print/comparison.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* "1.0e-03", or "-" where there is none. */
static const char *print_error(double error, char out[16])
{
    snprintf(out, 16, isnan(error) ? "-" : "%.1e", error);
    return out;
}

/* "31+19+6" */
static void print_orders(int64_t count, const int64_t *order, char out[80])
{
    size_t used = 0;

    out[0] = '\0';
    for (int64_t k = 0; k < count && used < 72; k++)
        used += (size_t)snprintf(out + used, 80 - used, "%s%lld",
                                 k > 0 ? "+" : "", (long long)order[k]);
}

static json_t *candidate_json(int64_t bodies, const ritz_candidate *k)
{
    json_t *item = json_object();
    json_t *orders = json_array();

    for (int64_t b = 0; b < bodies; b++)
        json_array_append_new(orders, json_integer(k->order[b]));
    json_object_set_new(item, "attached", cli_string(k->name));
    json_object_set_new(item, "orders", orders);
    json_object_set_new(item, "dofs", json_integer(k->largest));
    json_object_set_new(item, "gain_listed", cli_real(k->gain_listed));
    json_object_set_new(item, "gain_between", cli_real(k->gain_between));
    json_object_set_new(item, "singular_value", cli_real(k->deviation));
    json_object_set_new(item, "hertz", cli_real(k->hertz));
    json_object_set_new(item, "at", cli_string(k->at));
    json_object_set_new(item, "chosen", json_boolean(k->chosen));
    return item;
}

static void say_candidate(cli_run *run, int64_t bodies, const ritz_candidate *k)
{
    char orders[80];
    char text[3][16];
    char where[RITZ_NAME_SIZE + 32] = "";

    print_orders(bodies, k->order, orders);
    if (!isnan(k->deviation) && k->deviation > 0.0)
        snprintf(where, sizeof where, "%.4g Hz%s%s", k->hertz,
                 *k->at ? ", " : "", k->at);
    cli_say(run, "%c %-28s %-16s %6lld %9s %9s %9s  %s", k->chosen ? '>' : ' ',
            k->name, orders, (long long)k->largest,
            print_error(k->gain_listed, text[0]),
            print_error(k->gain_between, text[1]),
            print_error(k->deviation, text[2]), where);
}

void comparison_say_candidates(cli_run *run, const ritz_stage *first,
                               const ritz_comparison *c)
{
    const ritz_scene *scene = first->scene;
    bool open = scene->attached == RITZ_ATTACHED_AUTO;
    json_t *array = json_array();
    double chosen = 0.0;

    json_object_set_new(run->report, "candidates", array);
    if (c->num_candidates == 0)
        return;
    cli_say(run, "\nStatic corrections of %s, by the forces that they answer",
            c->candidate[0].level == RITZ_AUGMENT_COMPONENT
                ? "each component, with its rigid modes, once for all angles"
                : "the system");
    cli_say(run, "  %-28s %-16s %6s %9s %9s %9s", "attached", "orders",
            "system", "gain", "gain *", "sigma max");
    for (int64_t k = 0; k < c->num_candidates; k++) {
        const ritz_candidate *candidate = &c->candidate[k];

        say_candidate(run, first->count, candidate);
        json_array_append_new(array, candidate_json(first->count, candidate));
        if (candidate->chosen)
            chosen = candidate->deviation;
    }
    cli_say(run, "  worst relative errors: of the static gain at listed angles "
                 "and between them (*), of the largest singular");
    cli_say(run, "  value of H(i w) in the band at listed angles, and where; > "
                 "is what stage 2 was made with");
    if (open && !(chosen <= scene->attached_tolerance))
        cli_warn(run,
                 "no set of attached dofs brings the largest singular value "
                 "within %g: the nearest is %.1e off",
                 scene->attached_tolerance, chosen);
}

void comparison_say_suggestion(cli_run *run, const ritz_stage *first,
                               const ritz_comparison *c)
{
    const ritz_suggestion *s = &c->suggestion;
    char at[RITZ_NAME_SIZE];
    json_t *item = NULL;

    if (s->row < 0)
        return;
    comparison_name_row(first, c, &c->row[s->row], at);
    if (s->worth)
        cli_say(run,
                "  add %s: %s error %.1e there, %.1e at listed configurations",
                at, s->measure, s->error, s->listed);
    else
        cli_say(run,
                "  no angle need be added: the worst %s error between listed "
                "ones is %.1e, at %s",
                s->measure, s->error, at);
    item = json_object();
    json_object_set_new(item, "at", cli_string(at));
    json_object_set_new(item, "measure", cli_string(s->measure));
    json_object_set_new(item, "error", cli_real(s->error));
    json_object_set_new(item, "listed", cli_real(s->listed));
    json_object_set_new(item, "worth", json_boolean(s->worth));
    json_object_set_new(run->report, "suggestion", item);
}

static json_t *strays_json(const ritz_compare_row *row)
{
    json_t *array = json_array();

    for (int64_t i = 0; i < row->num_strays; i++) {
        const ritz_stray *stray = &row->stray[i];
        json_t *item = json_object();

        json_object_set_new(item, "mode", json_integer(stray->mode + 1));
        json_object_set_new(item, "hertz", cli_real(stray->hertz));
        json_object_set_new(item, "like", json_integer(stray->like + 1));
        json_object_set_new(item, "mac", cli_real(stray->mac));
        json_object_set_new(item, "removed", json_boolean(stray->removed));
        json_array_append_new(array, item);
    }
    return array;
}

/* Frequencies of one row's, as many as fit a line. */
static void say_stray_row(cli_run *run, const char *at,
                          const ritz_compare_row *row)
{
    enum { WIDTH = 72 };
    char line[WIDTH + 64] = "";
    size_t used = 0;
    int64_t shown = 0;

    while (shown < row->num_strays && used < WIDTH) {
        const ritz_stray *stray = &row->stray[shown++];

        used += (size_t)snprintf(line + used, sizeof line - used, " %.5g%s%s",
                                 stray->hertz, stray->mac >= 0.9 ? "~" : "",
                                 stray->removed ? "x" : "");
    }
    if (shown < row->num_strays)
        cli_say(run, "  %-28s %4lld %s ...", at, (long long)row->num_strays,
                line);
    else
        cli_say(run, "  %-28s %4lld %s", at, (long long)row->num_strays, line);
}

/* How many of the listed rows' extraneous modes were removed. */
static int64_t count_removed(const ritz_comparison *c)
{
    int64_t removed = 0;

    for (int64_t k = 0; k < c->num_rows; k++)
        for (int64_t i = 0; c->row[k].listed && i < c->row[k].num_strays; i++)
            removed += c->row[k].stray[i].removed;
    return removed;
}

void comparison_say_strays(cli_run *run, const ritz_stage *first,
                           const ritz_comparison *c)
{
    json_t *rows = json_object_get(run->report, "configurations");
    int64_t removed = count_removed(c);
    int64_t total = 0;

    for (int64_t k = 0; k < c->num_rows; k++) {
        json_object_set_new(json_array_get(rows, (size_t)k), "extraneous",
                            strays_json(&c->row[k]));
        total += c->row[k].listed ? c->row[k].num_strays : 0;
    }
    cli_report_int(run, "extraneous_removed", removed);
    if (total == 0)
        return;
    cli_say(run, "\nExtraneous modes of the stage-2 system, Hz: those that "
                 "stand for no mode that was kept");
    for (int64_t k = 0; k < c->num_rows; k++) {
        char at[RITZ_NAME_SIZE];

        if (!c->row[k].listed)
            continue;
        comparison_name_row(first, c, &c->row[k], at);
        say_stray_row(run, at, &c->row[k]);
    }
    cli_say(run, "  ~ yet has the shape of a mode of stage 1, MAC 0.9 or more; "
                 "x removed from the system that was written");
    if (removed > 0)
        cli_say(run,
                "  %lld of %lld were removed; the components still contain "
                "them%s",
                (long long)removed, (long long)total,
                first->scene->augment == RITZ_AUGMENT_NONE
                    ? ""
                    : ". What carries the static gain was among them: the "
                      "errors above are without");
}

static json_t *tolerance_json(int64_t bodies, const ritz_tolerance_row *row)
{
    json_t *item = json_object();
    json_t *orders = json_array();

    for (int64_t b = 0; b < bodies; b++)
        json_array_append_new(orders, json_integer(row->order[b]));
    json_object_set_new(item, "tolerance", cli_real(row->tolerance));
    json_object_set_new(item, "orders", orders);
    json_object_set_new(item, "dofs", json_integer(row->largest));
    json_object_set_new(item, "removed", json_boolean(row->removed));
    json_object_set_new(item, "frequency", cli_real(row->frequency_error));
    json_object_set_new(item, "gain", cli_real(row->gain_error));
    json_object_set_new(item, "response", cli_real(row->response_error));
    return item;
}

void comparison_say_tolerances(cli_run *run, const ritz_stage *first,
                               int64_t count, const ritz_tolerance_row *rows)
{
    json_t *array = json_array();

    cli_say(run, "\nComposite tolerance against orders, and worst errors at "
                 "listed configurations");
    cli_say(run, "%10s  %-16s %6s %6s %9s %9s %9s", "tolerance", "orders",
            "total", "system", "frequency", "gain", "response");
    for (int64_t k = 0; k < count; k++) {
        const ritz_tolerance_row *row = &rows[k];
        char orders[80];
        char text[3][16];

        print_orders(first->count, row->order, orders);
        cli_say(run, "%10.0e  %-16s %6lld %6lld %9s %9s %9s%s", row->tolerance,
                orders, (long long)row->total, (long long)row->largest,
                print_error(row->frequency_error, text[0]),
                print_error(row->gain_error, text[1]),
                print_error(row->response_error, text[2]),
                row->removed ? "" : "  stage two removed nothing");
        json_array_append_new(array, tolerance_json(first->count, row));
    }
    json_object_set_new(run->report, "tolerances", array);
}

ritz_status comparison_write_tolerances(const char *path,
                                        const ritz_stage *first, int64_t count,
                                        const ritz_tolerance_row *rows)
{
    ritz_status status = RITZ_OK;
    cli_table table = {0};

    RITZ_TRY(cli_table_new(&table));
    fprintf(table.file, "tolerance\ttotal\tsystem\tremoved\tfrequency\tgain\t"
                        "response");
    for (int64_t b = 0; b < first->count; b++)
        fprintf(table.file, "\t%s", first->scene->component[b].name);
    for (int64_t k = 0; k < count; k++) {
        const ritz_tolerance_row *row = &rows[k];

        fprintf(table.file, "\n%g\t%lld\t%lld\t%s\t%.6e\t%.6e\t%.6e",
                row->tolerance, (long long)row->total, (long long)row->largest,
                row->removed ? "yes" : "no", row->frequency_error,
                row->gain_error, row->response_error);
        for (int64_t b = 0; b < first->count; b++)
            fprintf(table.file, "\t%lld", (long long)row->order[b]);
    }
    fprintf(table.file, "\n");
    RITZ_TRY(cli_table_save(&table, path));
done:
    cli_table_free(&table);
    return status;
}
