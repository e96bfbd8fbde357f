#include "print/print.h"

/* Remember the file of "FILE[:NAME[#K]]"; NULL: none was given. */
static ritz_status take_matrix(cli_run *run, const char *spec)
{
    RITZ_OWN_ARRAY char *path = NULL;

    if (!spec)
        return RITZ_OK;
    RITZ_CHECK(ritz_foreign_path(spec, &path));
    return cli_input_unread(run, path);
}

/* Remember the file of "FILE@LOAD". */
static ritz_status take_load(cli_run *run, const char *spec)
{
    const char *at = strrchr(spec, '@');
    RITZ_OWN_ARRAY char *file = NULL;

    RITZ_REFUSE_IF(!at || at == spec || !at[1], RITZ_ERR_ARGUMENT,
                   "--geometric-stiffness '%s' is not FILE@LOAD", spec);
    RITZ_CHECK_NEW(file, at - spec + 1);
    memcpy(file, spec, (size_t)(at - spec));
    return take_matrix(run, file);
}

/* Remember the file of "NAME=F[,KIND]", or of "NAME=FILE". */
static ritz_status take_recovery(cli_run *run, const char *text, bool matrix)
{
    RITZ_OWN_ARRAY char *spec = NULL;

    if (!matrix) {
        const char *equals = strchr(text, '=');

        return equals ? cli_input(run, equals + 1) : RITZ_OK;
    }
    RITZ_CHECK_IN("--recovery", ritz_import_recovery_spec(text, &spec));
    return take_matrix(run, spec);
}

static ritz_status take_inputs(cli_run *run, const ritz_import_request *request)
{
    double number = 0.0;
    const char *ratios = request->ratios;
    const char *const matrices[] = {
        request->stiffness,
        request->mass,
        request->damping,
        request->structural_damping,
        request->frequencies,
        ratios && !ritz_text_real(ratios, &number) ? ratios : NULL,
        request->input_matrix,
        request->output_matrix,
        request->velocity_matrix,
        request->acceleration_matrix,
    };

    for (size_t k = 0; k < sizeof matrices / sizeof *matrices; k++)
        RITZ_CHECK(take_matrix(run, matrices[k]));
    for (int64_t k = 0; k < request->num_loads; k++)
        RITZ_CHECK(take_load(run, request->load[k]));
    for (int64_t k = 0; k < request->num_recoveries; k++)
        RITZ_CHECK(take_recovery(run, request->recovery[k], true));
    for (int64_t k = 0; k < request->num_recovery_rows; k++)
        RITZ_CHECK(take_recovery(run, request->recovery_rows[k], false));
    if (request->bulk)
        RITZ_CHECK(cli_input(run, request->bulk));
    if (request->dofs)
        RITZ_CHECK(cli_input(run, request->dofs));
    return RITZ_OK;
}

/* Sums of the files that were read for their matrices. */
static void take_sums(cli_run *run, const ritz_file_sums *sums)
{
    for (int64_t k = 0; k < sums->count; k++)
        cli_input_sum(run, sums->sum[k].path, sums->sum[k].digest);
}

/* Rows that are gone: the first few by name, all of them in JSON. */
static void say_rows(cli_run *run, const char *key, const char *what,
                     int64_t count, const ritz_dof *dof)
{
    enum { SHOWN = 8 };

    if (count > 0)
        sink_part(run, "%ld rows %s removed: ", count, what);
    SINK_EACH(run, key, k, count) {
        char name[RITZ_DOF_NAME_SIZE];

        ritz_dof_name(dof[k], name);
        sink_add(run, "%s", name);
        if (k < SHOWN)
            sink_part(run, "%s%s", k > 0 ? ", " : "", name);
    }
    if (count > 0)
        cli_say(run, "%s", count > SHOWN ? ", ..." : "");
}

/* "RBE2 600, MPC 12, ..." */
static void list_constraints(cli_run *run, const ritz_import_report *report,
                             size_t size, char *text)
{
    enum { SHOWN = 6 };

    text[0] = '\0';
    SINK_EACH(run, "constraints", k, report->num_constraints) {
        sink_add(run, "%s", report->constraint[k]);
        if (k < SHOWN)
            sink_append(text, size, "%s%s", k > 0 ? ", " : "",
                        report->constraint[k]);
    }
    if (report->num_constraints > SHOWN)
        sink_append(text, size, ", ...");
}

/* Dependent dofs: of elements of the deck, and of grids of ports. */
static void say_constraints(cli_run *run, const ritz_import_report *report)
{
    char text[512];

    list_constraints(run, report, sizeof text, text);
    sink_set(run, "eliminated,not_recovered", "%ld %ld", report->num_eliminated,
             report->num_lost);
    if (report->num_eliminated > 0)
        cli_say(run, "%ld rows eliminated, of dofs that depend on others%s%s",
                report->num_eliminated, *text ? ": " : "", text);
    else if (report->num_recovered > 0 && *text)
        cli_say(run, "the matrices are without what depends by %s", text);
    if (report->num_lost > 0)
        cli_say(run,
                "%ld dofs are not recovered: they depend on dofs that the "
                "matrices have not",
                report->num_lost);
    if (report->unknown)
        cli_warn(run, "nothing is recovered: %s", report->unknown);
    for (int64_t k = 0; k < report->num_grids; k++)
        cli_say(run, "port '%s' is the new grid %ld, tied to %ld dofs",
                report->grid[k].port, report->grid[k].id,
                report->grid[k].num_tied);
}

static void say_import(cli_run *run, const ritz_component *component,
                       const ritz_import_report *done)
{
    sink_say(run, "map", "  rows named by  %s", done->map);
    say_rows(run, "removed", "empty in stiffness and mass", done->num_removed,
             done->removed);
    say_rows(run, "fixed", "that the deck fixes", done->num_fixed, done->fixed);
    say_constraints(run, done);
    sink_set(run, "massless,floating,elements,elements_left_out",
             "%ld %ld %ld %ld", done->num_massless, done->num_floating,
             component->elements.count, done->num_hidden);
    if (done->num_massless > 0)
        cli_say(run, "%ld rows have stiffness but no mass, kept",
                done->num_massless);
    if (done->num_floating > 0)
        cli_say(run,
                "%ld rows have mass but no stiffness, kept: they move "
                "freely",
                done->num_floating);
    if (component->num_loads > 0)
        cli_say(run, "geometric stiffness of %ld load%s is stored",
                component->num_loads, component->num_loads > 1 ? "s" : "");
    if (component->elements.count + done->num_hidden > 0)
        cli_say(run,
                "%ld elements for pictures; %ld left out, as not all of "
                "their grids are there",
                component->elements.count, done->num_hidden);
    if (component->asymmetry > MODEL_ROUNDING)
        cli_warn(run, "unsymmetric by %.1e of the largest entry, averaged away",
                 component->asymmetry);
    cli_record(run, "import", component->num_dofs);
}

/* Lists of options as the request has them. */
static void take_lists(import_options *lists)
{
    ritz_import_request *request = &lists->request;

    request->num_loads = lists->load.count;
    request->load = lists->load.text;
    request->num_preloads = lists->preload.count;
    request->preload = lists->preload.text;
    request->num_ports = lists->port.count;
    request->port = lists->port.text;
    request->num_rigid_ports = lists->rigid.count;
    request->rigid_port = lists->rigid.text;
    request->num_averaged_ports = lists->averaged.count;
    request->averaged_port = lists->averaged.text;
    request->num_inputs = lists->input.count;
    request->input = lists->input.text;
    request->num_outputs = lists->output.count;
    request->output = lists->output.text;
    request->num_recoveries = lists->recovery.count;
    request->recovery = lists->recovery.text;
    request->num_recovery_rows = lists->recovery_rows.count;
    request->recovery_rows = lists->recovery_rows.text;
    request->num_dampers = lists->damper.count;
    request->damper = lists->damper.text;
}

/* Put a text in front of a list. */
static ritz_status put_first(const char *text, const char *option,
                             cli_list *list)
{
    RITZ_REFUSE_IF(list->count == CLI_MAX_LIST, RITZ_ERR_ARGUMENT,
                   "--superelement has rows to recover, and --%s is given %d "
                   "times already",
                   option, CLI_MAX_LIST);
    memmove(list->text + 1, list->text,
            (size_t)list->count * sizeof *list->text);
    list->text[0] = text;
    list->count++;
    return RITZ_OK;
}

/* Whether a --recovery of the command line has the name of this one. */
static bool has_name(const cli_list *list, const char *text)
{
    const size_t length = strcspn(text, "=") + 1;

    for (int k = 0; k < list->count; k++)
        if (strncmp(list->text[k], text, length) == 0)
            return true;
    return false;
}

/* Rows that its tables name, in front of those of the command line; a quantity
 * of the command line takes the place of one of the same name. */
static ritz_status request_recovery(const ritz_superelement *found,
                                    import_options *given)
{
    for (int64_t k = found->num_recoveries - 1; k >= 0; k--) {
        if (has_name(&given->recovery, found->recovery[k]))
            continue;
        RITZ_CHECK(put_first(found->recovery[k], "recovery", &given->recovery));
        RITZ_CHECK(put_first(found->recovery_rows[k], "recovery-rows",
                             &given->recovery_rows));
    }
    return RITZ_OK;
}

/* Request the matrices of an external superelement, and its deck. */
static ritz_status request_superelement(import_options *given,
                                        ritz_superelement *found)
{
    const char *path = given->superelement;
    ritz_import_request *request = &given->request;

    RITZ_CHECK_IN("--superelement",
                  ritz_superelement_find(path, request->bulk, found));
    request->stiffness = found->stiffness;
    request->mass = found->mass;
    request->damping = found->damping;
    request->structural_damping = found->structural_damping;
    request->bulk = found->bulk;
    RITZ_REFUSE_IF(!request->bulk && !request->dofs, RITZ_ERR_ARGUMENT,
                   "--superelement: no .pch and no .asm next to '%s' names its "
                   "rows: name a deck with --bulk",
                   path);
    return request_recovery(found, given);
}

/* Matrices of a superelement that are neither a component's nor recovered. */
static void say_others(cli_run *run, const ritz_superelement *found)
{
    char text[512] = "";

    SINK_EACH(run, "not_taken", k, found->num_others) {
        sink_add(run, "%s", found->other[k]);
        sink_append(text, sizeof text, "%s%s", k > 0 ? ", " : "",
                    found->other[k]);
    }
    if (found->num_others > 0)
        cli_say(run, "not taken: %s", text);
}

static ritz_status import_component(cli_run *run, import_options *given)
{
    ritz_import_request *request = &given->request;
    RITZ_OWN(ritz_superelement) found = {0};
    RITZ_OWN(ritz_file_sums) sums = {0};
    RITZ_OWN(model) made = {.kind = MODEL_COMPONENT};
    RITZ_OWN(ritz_import_report) done = {0};

    if (given->superelement)
        RITZ_CHECK(request_superelement(given, &found));
    take_lists(given);
    RITZ_CHECK(take_inputs(run, request));
    request->sums = &sums;
    RITZ_CHECK(ritz_import(request, &made.component, &done));
    take_sums(run, &sums);
    RITZ_CHECK(describe_output(run, &made));
    say_import(run, &made.component, &done);
    for (int64_t k = 0; k < request->num_preloads; k++)
        cli_say(run, "the stiffness is that under load %s",
                request->preload[k]);
    if (given->superelement)
        say_others(run, &found);
    return RITZ_OK;
}

/* Files of "A=F,B=F,..." or one file. */
static ritz_status take_space_inputs(cli_run *run, const char *matrices)
{
    RITZ_OWN_ARRAY char *spec = malloc(strlen(matrices) + 1);

    RITZ_REFUSE_IF(!spec, RITZ_ERR_MEMORY, "no memory for '%s'", matrices);
    while (ritz_import_space_next(&matrices, spec))
        RITZ_CHECK(take_matrix(run, spec));
    return RITZ_OK;
}

static ritz_status import_states(cli_run *run,
                                 ritz_import_space_request *request)
{
    RITZ_OWN(model) made = {.kind = MODEL_STATES};
    RITZ_OWN(ritz_file_sums) sums = {0};

    RITZ_CHECK(take_space_inputs(run, request->matrices));
    request->sums = &sums;
    RITZ_CHECK_IN("--state-space",
                  ritz_import_state_space(request, &made.states));
    take_sums(run, &sums);
    RITZ_CHECK(describe_output(run, &made));
    cli_record(run, "import", ritz_state_space_order(&made.states));
    return RITZ_OK;
}

/* Whether the command line gave this flag, text or list. */
static bool is_given(const cli_option *option)
{
    return (option->kind == CLI_KIND_FLAG && *option->to.flag) ||
           (option->kind == CLI_KIND_TEXT && *option->to.text) ||
           (option->kind == CLI_KIND_LIST && option->to.list->count > 0);
}

/* A state space has neither rows with names nor ports. */
static void refuse_others(const cli_run *run)
{
    static const char *const own[] = {"state-space", "input-names",
                                      "output-names", "units"};

    for (const cli_option *o = run->options; o->kind != CLI_KIND_END; o++) {
        bool other = is_given(o);

        for (size_t k = 0; k < sizeof own / sizeof *own; k++)
            other = other && strcmp(o->name, own[k]) != 0;
        if (other)
            cli_refuse(run->program,
                       "--state-space is a whole model, --%s is not for it",
                       o->name);
    }
}

ritz_status import_run(cli_run *run, import_options *given)
{
    const cli_program *program = run->program;
    const ritz_import_request *request = &given->request;

    if (given->space.matrices) {
        refuse_others(run);
        given->space.units = request->units;
        given->space.inputs = request->input_names;
        given->space.outputs = request->output_names;
        return import_states(run, &given->space);
    }
    if ((request->input_names && !request->input_matrix) ||
        (request->output_names && !request->output_matrix &&
         !request->velocity_matrix && !request->acceleration_matrix))
        cli_refuse(program, "--input-names and --output-names are for "
                            "--state-space, --input-matrix and "
                            "--output-matrix");
    if (request->ratios && !request->frequencies)
        cli_refuse(program, "--ratios are those of --frequencies");
    if (given->superelement &&
        (request->stiffness || request->mass || request->damping ||
         request->structural_damping || request->frequencies))
        cli_refuse(program, "--superelement names all matrices: give no other "
                            "option for one");
    if (!request->stiffness && !request->mass && !request->frequencies &&
        !given->superelement)
        cli_refuse(program, "nothing to import: name --stiffness, --mass or "
                            "both, or --superelement, --frequencies or "
                            "--state-space");
    return import_component(run, given);
}
