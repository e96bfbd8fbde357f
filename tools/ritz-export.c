/* ritz-export - a reduced model or a response as a file of others. */
#include "print/dampers.h"
#include "print/nested.h"
#include "print/shapes.h"
#include "print/stability.h"

#include <ritz/export.h>

#include <string.h>

enum { MAX_EXPORTERS = 64 };

static void list_formats(void)
{
    for (const ritz_exporter *const *e = ritz_exporters; *e; e++)
        printf("%-16s %-9s %-52s [%s]\n", (*e)->name, (*e)->kind, (*e)->summary,
               (*e)->reference);
}

static const ritz_exporter *find(const cli_program *program, const char *word)
{
    const ritz_exporter *exporter = ritz_exporter_find(word);
    const char *names[MAX_EXPORTERS];
    int64_t count = 0;

    if (exporter)
        return exporter;
    while (ritz_exporters[count] && count < MAX_EXPORTERS) {
        names[count] = ritz_exporters[count]->name;
        count++;
    }
    cli_refuse_name(program, "no format", word, count, names);
}

/* Which errors are known of it: no number without its error. */
static ritz_status vouch(cli_run *run, const ritz_measures *errors,
                         const ritz_measures *estimates, bool force)
{
    const char *rests = errors->count > 0      ? "measured"
                        : estimates->count > 0 ? "estimated"
                                               : "unknown";
    const ritz_measures *known = errors->count > 0 ? errors : estimates;

    cli_report_text(run, "errors_rest_on", rests);
    if (known->count == 0)
        model_set_measures(run, "errors", known, rests);
    RITZ_REFUSE_IF(known->count == 0 && !force, RITZ_ERR_ARGUMENT,
                   "'%s' carries neither estimated nor measured errors: run "
                   "ritz-verify, or export it all the same with --force",
                   run->operand[0]);
    if (known->count == 0) {
        cli_warn(run, "nothing is known of the errors of '%s'",
                 run->operand[0]);
        return RITZ_OK;
    }
    cli_say(run, "errors %s by %s:", rests,
            errors->count > 0 ? "ritz-verify or ritz-compare"
                              : "ritz-reduce, not verified");
    model_say_measures(run, "errors", known, rests);
    for (int64_t k = 0; k < known->count; k++) {
        cli_record_error(run, known->item[k].name, known->item[k].value);
        if (!ritz_measure_holds(&known->item[k]))
            cli_warn(run, "'%s' does not meet its limit", known->item[k].name);
    }
    return RITZ_OK;
}

/* Other codes join bodies by displacements, as which force columns are those
   of macneal-rubin. */
static ritz_status check_forces(cli_run *run, const ritz_columns *columns,
                                bool force)
{
    static const char sentence[] =
        "'%s' has columns for a joint by forces, which no other code makes of "
        "them: export the same made by macneal-rubin";
    bool any = false;

    for (int64_t k = 0; k < columns->count; k++)
        any = any || columns->kind[k] == RITZ_COLUMN_FORCE;
    RITZ_REFUSE_IF(any && !force, RITZ_ERR_ARGUMENT, sentence, run->operand[0]);
    if (any)
        cli_warn(run, sentence, run->operand[0]);
    return RITZ_OK;
}

static ritz_status export_reduced(cli_run *run, model *m,
                                  const ritz_exporter *exporter,
                                  const ritz_export_request *request,
                                  bool force, ritz_export_report *done)
{
    ritz_status status = RITZ_OK;
    ritz_audit audit = {0};

    RITZ_TRY(vouch(run, &m->reduced.errors, &m->reduced.estimates, force));
    RITZ_TRY(check_forces(run, &m->reduced.columns, force));
    RITZ_TRY_IN(run->operand[0],
                stability_of_reduced(&m->reduced, request, &audit));
    RITZ_TRY(stability_check(run, &audit, m->reduced.origin.method, force));
    RITZ_TRY(exporter->write_reduced(&m->reduced, request, done));
done:
    ritz_audit_free(&audit);
    return status;
}

/* What was imported is no reduction and has no errors; of some reductions
   nothing but their stability is known. */
static ritz_status vouch_states(cli_run *run, const ritz_state_space *states,
                                bool force)
{
    bool bounded = false;

    if (!*states->origin.method && states->errors.count == 0)
        return RITZ_OK;
    for (int64_t k = 0; k < states->estimates.count; k++)
        bounded = bounded || strcmp(states->estimates.item[k].name,
                                    "growth-relative") != 0;
    if (states->errors.count > 0 || bounded)
        return vouch(run, &states->errors, &states->estimates, force);
    cli_warn(run, "nothing is known of the errors of '%s' but its stability",
             run->operand[0]);
    return RITZ_OK;
}

static ritz_status export_states(cli_run *run, model *m,
                                 const ritz_exporter *exporter,
                                 const ritz_export_request *request, bool force,
                                 ritz_export_report *done)
{
    ritz_status status = RITZ_OK;
    ritz_audit audit = {0};

    cli_record(run, exporter->name, m->states.A.nrow);
    RITZ_TRY_IN(run->operand[0],
                stability_of_states(&m->states, request, &audit));
    RITZ_TRY(stability_check(run, &audit, m->states.origin.method, force));
    RITZ_TRY(vouch_states(run, &m->states, force));
    RITZ_TRY(exporter->write_states(&m->states, request, done));
done:
    ritz_audit_free(&audit);
    return status;
}

/* What an exporter takes: kinds of model, summed. */
static int kinds_of(const ritz_exporter *exporter)
{
    if (strcmp(exporter->kind, "response") == 0)
        return MODEL_RESPONSE |
               (exporter->write_simulation ? MODEL_SIMULATION : 0);
    if (exporter->write_shapes)
        return MODEL_REDUCED | MODEL_COMPONENT | MODEL_BASIS;
    return MODEL_REDUCED | (exporter->write_states ? MODEL_STATES : 0);
}

/* The file of another code has them in K and D, and not apart. */
static void say_dampers(const cli_run *run, const ritz_dampers *dampers)
{
    for (int64_t j = 0; j < dampers->count; j++)
        cli_say(run, "damper '%s' installed: c = %g, k = %g", dampers->name[j],
                dampers->c[j], dampers->k[j]);
}

/* What is asked beside the format. */
typedef struct export_how {
    int64_t order;
    const char *component; /* that a basis is of */
    bool force;
} export_how;

static ritz_status export(cli_run *run, const ritz_exporter *exporter,
                          const ritz_export_request *request,
                          const cli_list *damper, const export_how *how)
{
    ritz_status status = RITZ_OK;
    const char *path = run->operand[0];
    bool force = how->force;
    model m = {0};
    ritz_export_report done = {0};
    json_t *said = json_array();

    json_object_set_new(run->report, "said", said);
    cli_report_text(run, "format", exporter->name);
    cli_record(run, exporter->name, -1);
    RITZ_TRY(model_read(run, path, kinds_of(exporter), &m));
    RITZ_TRY(nested_take(path, how->order, &m));
    if (exporter->write_shapes) {
        RITZ_TRY_IN(path, dampers_install(&m, damper));
        RITZ_TRY(
            shapes_export(run, &m, how->component, exporter, request, &done));
    } else if (m.kind == MODEL_RESPONSE) {
        RITZ_TRY(exporter->write_response(&m.response, request, &done));
    } else if (m.kind == MODEL_SIMULATION) {
        RITZ_TRY(exporter->write_simulation(&m.simulation, request, &done));
    } else if (m.kind == MODEL_STATES) {
        RITZ_TRY(export_states(run, &m, exporter, request, force, &done));
    } else {
        cli_record(run, exporter->name, m.reduced.K.nrow);
        RITZ_TRY_IN(path, dampers_install(&m, damper));
        say_dampers(run, &m.reduced.dampers);
        RITZ_TRY(export_reduced(run, &m, exporter, request, force, &done));
    }
    cli_say(run, "%s: %s", run->output, exporter->summary);
    for (int64_t k = 0; k < done.count; k++) {
        cli_say(run, "  %s", done.line[k]);
        json_array_append_new(said, cli_string(done.line[k]));
    }
done:
    ritz_export_report_free(&done);
    model_free(&m);
    return status;
}

int main(int argc, char **argv)
{
    const char *to = NULL;
    export_how how = {0};
    cli_list damper = {0};
    ritz_export_request request = {0};
    const cli_option options[] = {
        {CLI_TEXT(&to), .name = "to", .argument = "FORMAT",
         .help = "one of those that --list shows"},
        {CLI_TEXT(&request.matrices), .name = "matrix",
         .argument = "NAME[,NAME]", .help = "these matrices only [all]"},
        {CLI_FLAG(&request.text), .name = "text",
         .help = "text, not binary (output4)"},
        {CLI_FLAG(&request.dense), .name = "dense",
         .help = "every entry, zeros too (output4)"},
        {CLI_INT(&request.digits), .name = "digits", .argument = "N", .min = 1,
         .max = 17, .help = "significant, of text; 17 if not given"},
        ORDER_OPTION(&how.order),
        DAMPERS_OPTION(&damper),
        {CLI_FLAG(&how.force), .name = "force",
         .help = "even if nothing is known of the errors, or if unstable"},
        {CLI_TEXT(&request.modes), .name = "modes", .argument = "LIST",
         .help = "shapes of these modes, or columns, 1-6,9 (vtu, xdmf) [all; "
                 "10 of a component]"},
        {CLI_TEXT(&how.component), .name = "component", .argument = "FILE",
         .help = "the component that a basis is of (vtu, xdmf)"},
        {CLI_ACTION(list_formats), .name = "list",
         .help = "list formats and what they take"},
        {0},
    };
    const cli_program program = {
        .name = "ritz-export",
        .operands = {{"FILE",
                      "a reduced component, state space, response over hertz "
                      "or seconds; for shapes also a component or a basis",
                      false}},
        .summary = "Write a reduced component for a simulator, or a response "
                   "as a table, and say what\nis known of its errors and "
                   "whether it is stable.",
        .example = "ritz-export blade-verified.h5 --to exudyn -o blade.hdf5",
        .options = options,
        .output = "the file in that format",
    };
    const ritz_exporter *exporter = NULL;
    cli_run run;

    cli_parse(&program, argc, argv, &run);
    if (!to)
        cli_refuse(&program, "no format, name it with --to; --list shows all");
    exporter = find(&program, to);
    if (ritz_export_check(exporter, &request) != RITZ_OK)
        cli_refuse(&program, "%s", ritz_error_message());
    request.output = run.output;
    if (how.component && !exporter->write_shapes)
        cli_refuse(&program, "--component is for shapes of a basis");
    return cli_finish(&run, export(&run, exporter, &request, &damper, &how));
}
