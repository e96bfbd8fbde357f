/* ritz-import - matrices and geometry of an FE code become a component. */
#include "print/describe.h"

#include <ritz/foreign.h>
#include <ritz/import.h>

#include <stdlib.h>
#include <string.h>

/* The options that may be repeated. */
typedef struct repeated {
    cli_list load, port, rigid, averaged, input, output, damper;
} repeated;

/* Remember the file of "FILE[:NAME[#K]]"; NULL: none was given. */
static ritz_status take_matrix(cli_run *run, const char *spec)
{
    ritz_status status = RITZ_OK;
    char *path = NULL;

    if (!spec)
        return RITZ_OK;
    RITZ_TRY(ritz_foreign_path(spec, &path));
    RITZ_TRY(cli_input_unread(run, path));
done:
    free(path);
    return status;
}

/* The same of "FILE@LOAD". */
static ritz_status take_load(cli_run *run, const char *spec)
{
    ritz_status status = RITZ_OK;
    const char *at = strrchr(spec, '@');
    char *file = NULL;

    RITZ_FAIL_IF(!at || at == spec || !at[1], RITZ_ERR_ARGUMENT,
                 "--geometric-stiffness '%s' is not FILE@LOAD", spec);
    file = strndup(spec, (size_t)(at - spec));
    RITZ_FAIL_IF(!file, RITZ_ERR_MEMORY, "no memory for '%s'", spec);
    RITZ_TRY(take_matrix(run, file));
done:
    free(file);
    return status;
}

static ritz_status take_inputs(cli_run *run, const ritz_import_request *request)
{
    RITZ_CHECK(take_matrix(run, request->stiffness));
    RITZ_CHECK(take_matrix(run, request->mass));
    RITZ_CHECK(take_matrix(run, request->damping));
    RITZ_CHECK(take_matrix(run, request->structural_damping));
    for (int64_t k = 0; k < request->num_loads; k++)
        RITZ_CHECK(take_load(run, request->load[k]));
    if (request->bulk)
        RITZ_CHECK(cli_input(run, request->bulk));
    if (request->dofs)
        RITZ_CHECK(cli_input(run, request->dofs));
    return RITZ_OK;
}

/* Sums of the files that were read for their matrices. */
static ritz_status take_sums(cli_run *run, const ritz_file_sums *sums)
{
    for (int64_t k = 0; k < sums->count; k++)
        RITZ_CHECK(cli_input_sum(run, sums->sum[k].path, sums->sum[k].digest));
    return RITZ_OK;
}

/* Rows that are gone: the first few by name, all of them in JSON. */
static void report_removed(cli_run *run, const ritz_import_report *report)
{
    enum { SHOWN = 8 };
    char name[RITZ_DOF_NAME_SIZE];
    char text[SHOWN * (RITZ_DOF_NAME_SIZE + 2) + 1] = "";
    size_t used = 0;
    json_t *all = json_array();

    for (int64_t k = 0; k < report->num_removed; k++) {
        ritz_dof_name(report->removed[k], name);
        json_array_append_new(all, cli_string(name));
        if (k < SHOWN)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s",
                                     k > 0 ? ", " : "", name);
    }
    json_object_set_new(run->report, "removed", all);
    if (report->num_removed > 0)
        cli_say(run, "%lld rows empty in stiffness and mass removed: %s%s",
                (long long)report->num_removed, text,
                report->num_removed > SHOWN ? ", ..." : "");
}

/* "RBE2 600, MPC 12, ..." */
static void list_constraints(cli_run *run, const ritz_import_report *report,
                             size_t size, char *text)
{
    enum { SHOWN = 6 };
    json_t *all = json_array();
    size_t used = 0;

    text[0] = '\0';
    for (int64_t k = 0; k < report->num_constraints; k++) {
        json_array_append_new(all, cli_string(report->constraint[k]));
        if (k < SHOWN)
            used += (size_t)snprintf(text + used, size - used, "%s%s",
                                     k > 0 ? ", " : "", report->constraint[k]);
    }
    if (report->num_constraints > SHOWN)
        snprintf(text + used, size - used, ", ...");
    json_object_set_new(run->report, "constraints", all);
}

/* What depends on what, by elements of the deck and by grids of ports. */
static void report_constraints(cli_run *run, const ritz_import_report *report)
{
    char text[512];

    list_constraints(run, report, sizeof text, text);
    if (report->num_eliminated > 0)
        cli_say(run, "%lld rows eliminated, of dofs that depend on others%s%s",
                (long long)report->num_eliminated, *text ? ": " : "", text);
    else if (report->num_recovered > 0 && *text)
        cli_say(run, "the matrices are without what depends by %s", text);
    if (report->num_lost > 0)
        cli_say(run,
                "%lld dofs are not recovered: they depend on dofs that the "
                "matrices have not",
                (long long)report->num_lost);
    if (report->unknown)
        cli_warn(run, "nothing is recovered: %s", report->unknown);
    for (int64_t k = 0; k < report->num_grids; k++)
        cli_say(run, "port '%s' is the new grid %lld, tied to %lld dofs",
                report->grid[k].port, (long long)report->grid[k].id,
                (long long)report->grid[k].num_tied);
    cli_report_int(run, "eliminated", report->num_eliminated);
    cli_report_int(run, "not_recovered", report->num_lost);
}

static void report(cli_run *run, const ritz_component *component,
                   const ritz_import_report *done)
{
    cli_say(run, "%s:", run->output);
    describe_component(run, component);
    cli_say(run, "  rows named by  %s", done->map);
    report_removed(run, done);
    report_constraints(run, done);
    if (done->num_massless > 0)
        cli_say(run, "%lld rows have stiffness but no mass, kept",
                (long long)done->num_massless);
    if (done->num_floating > 0)
        cli_say(run,
                "%lld rows have mass but no stiffness, kept: they move "
                "freely",
                (long long)done->num_floating);
    if (component->elements.count + done->num_hidden > 0)
        cli_say(run,
                "%lld elements for pictures; %lld left out, as not all of "
                "their grids are there",
                (long long)component->elements.count,
                (long long)done->num_hidden);
    if (component->asymmetry > MODEL_ROUNDING)
        cli_warn(run, "unsymmetric by %.1e of the largest entry, averaged away",
                 component->asymmetry);
    cli_report_text(run, "map", done->map);
    cli_report_int(run, "massless", done->num_massless);
    cli_report_int(run, "elements", component->elements.count);
    cli_report_int(run, "elements_left_out", done->num_hidden);
    cli_report_int(run, "floating", done->num_floating);
    cli_record(run, "import", component->num_dofs);
}

static ritz_status import(cli_run *run, ritz_import_request *request)
{
    ritz_status status = RITZ_OK;
    ritz_component component = {0};
    ritz_import_report done = {0};
    ritz_file_sums sums = {0};
    ritz_stamp stamp = {0};

    RITZ_TRY(take_inputs(run, request));
    request->sums = &sums;
    RITZ_TRY(ritz_import(request, &component, &done));
    RITZ_TRY(take_sums(run, &sums));
    stamp = cli_stamp(run);
    RITZ_TRY(ritz_container_write_component(run->output, &component, &stamp));
    report(run, &component, &done);
done:
    ritz_import_report_free(&done);
    ritz_file_sums_free(&sums);
    ritz_component_free(&component);
    return status;
}

/* Files of "A=F,B=F,..." or one file. */
static ritz_status take_space_inputs(cli_run *run, const char *matrices)
{
    ritz_status status = RITZ_OK;
    char *spec = malloc(strlen(matrices) + 1);

    RITZ_FAIL_IF(!spec, RITZ_ERR_MEMORY, "no memory for '%s'", matrices);
    while (ritz_import_space_next(&matrices, spec))
        RITZ_TRY(take_matrix(run, spec));
done:
    free(spec);
    return status;
}

static ritz_status import_space(cli_run *run,
                                ritz_import_space_request *request)
{
    ritz_status status = RITZ_OK;
    ritz_state_space space = {0};
    ritz_file_sums sums = {0};
    ritz_stamp stamp = {0};

    RITZ_TRY(take_space_inputs(run, request->matrices));
    request->sums = &sums;
    RITZ_TRY_IN("--state-space", ritz_import_state_space(request, &space));
    RITZ_TRY(take_sums(run, &sums));
    stamp = cli_stamp(run);
    RITZ_TRY(ritz_container_write_state_space(run->output, &space, &stamp));
    cli_say(run, "%s:", run->output);
    RITZ_TRY(describe_states(run, &space));
    cli_record(run, "import", space.A.nrow);
done:
    ritz_file_sums_free(&sums);
    ritz_state_space_free(&space);
    return status;
}

/* A state space has neither rows with names nor ports. */
static void refuse_others(const cli_program *program, const repeated *lists,
                          const ritz_import_request *request)
{
    const struct {
        bool given;
        const char *name;
    } none[] = {
        {request->stiffness, "stiffness"},
        {request->mass, "mass"},
        {request->damping, "damping"},
        {request->structural_damping, "structural-damping"},
        {request->bulk, "bulk"},
        {request->dofs, "dofs"},
        {request->symmetrise, "symmetrise"},
        {lists->load.count > 0, "geometric-stiffness"},
        {lists->port.count > 0, "port"},
        {lists->rigid.count > 0, "rigid-port"},
        {lists->averaged.count > 0, "averaged-port"},
        {lists->input.count > 0, "input"},
        {lists->output.count > 0, "output-at"},
        {lists->damper.count > 0, "damper"},
    };

    for (size_t k = 0; k < sizeof none / sizeof *none; k++)
        if (none[k].given)
            cli_refuse(program,
                       "--state-space is a whole model, --%s is not for it",
                       none[k].name);
}

/* Lists of options as the request has them. */
static void take_lists(const repeated *lists, ritz_import_request *request)
{
    request->num_loads = lists->load.count;
    request->load = lists->load.text;
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
    request->num_dampers = lists->damper.count;
    request->damper = lists->damper.text;
}

/* All that the options answer. */
typedef struct wish {
    repeated lists;
    ritz_import_request request;
    ritz_import_space_request space;
} wish;

/* The options stand in main, which has room for nothing else. */
static int serve(const cli_option *options, int argc, char **argv, wish *asked)
{
    const cli_program program = {
        .name = "ritz-import",
        .summary = "Matrices and geometry of a finite-element code become a "
                   "component.",
        .example = "ritz-import --stiffness blade.op4:KGG --mass "
                   "blade.op4:MGG --bulk blade.bdf \\\n"
                   "      --port root=1-4:123 --units \"kg m s\" -o blade.h5",
        .options = options,
        .output = "the component or state space",
    };
    cli_run run;

    cli_parse(&program, argc, argv, &run);
    if (asked->space.matrices) {
        refuse_others(&program, &asked->lists, &asked->request);
        asked->space.units = asked->request.units;
        return cli_finish(&run, import_space(&run, &asked->space));
    }
    if (asked->space.inputs || asked->space.outputs)
        cli_refuse(&program, "--input-names and --output-names are for "
                             "--state-space");
    if (!asked->request.stiffness && !asked->request.mass)
        cli_refuse(&program, "nothing to import: name --stiffness, --mass or "
                             "both, or --state-space");
    take_lists(&asked->lists, &asked->request);
    return cli_finish(&run, import(&run, &asked->request));
}

int main(int argc, char **argv)
{
    wish asked = {0};
    const cli_option options[] = {
        {CLI_TEXT(&asked.request.stiffness), .name = "stiffness",
         .argument = "F",
         .help = "matrix K, F being FILE[:NAME[#K]]; absent: a rigid body"},
        {CLI_TEXT(&asked.request.mass), .name = "mass", .argument = "F",
         .help = "matrix M"},
        {CLI_TEXT(&asked.request.damping), .name = "damping", .argument = "F",
         .help = "viscous damping D"},
        {CLI_TEXT(&asked.request.structural_damping),
         .name = "structural-damping", .argument = "F",
         .help = "structural damping K4, of K + i K4"},
        {CLI_LIST(&asked.lists.load), .name = "geometric-stiffness",
         .argument = "F@LOAD", .help = "geometric stiffness of a unit load"},
        {CLI_TEXT(&asked.request.bulk), .name = "bulk", .argument = "F",
         .help = "NASTRAN bulk data: grids, frames, sets"},
        {CLI_TEXT(&asked.request.dofs), .name = "dofs", .argument = "F",
         .help = "what each row is: GRID COMP a line, COMP 0 a scalar point"},
        {CLI_LIST(&asked.lists.port), .name = "port",
         .argument = "NAME=GRIDS[:COMPS]",
         .help = "dofs by which other bodies hold this one"},
        {CLI_LIST(&asked.lists.rigid), .name = "rigid-port",
         .argument = "NAME=GRIDS[:COMPS]",
         .help = "port of a new grid amid these, which they follow rigidly"},
        {CLI_LIST(&asked.lists.averaged), .name = "averaged-port",
         .argument = "NAME=GRIDS[:COMPS]",
         .help = "port of a new grid that is the average of these"},
        {CLI_LIST(&asked.lists.input), .name = "input",
         .argument = "NAME=GRID:COMP[*SCALE]",
         .help = "force (COMP 1-3) or moment (4-6)"},
        {CLI_LIST(&asked.lists.output), .name = "output-at",
         .argument = "NAME=GRID:COMP[/vel|/acc][@LIMIT]",
         .help = "displacement, velocity or acceleration that matters"},
        {CLI_LIST(&asked.lists.damper), .name = "damper",
         .argument = "NAME=GRID:COMP[,GRID:COMP]*C[*K]",
         .help = "damper C, and spring K, from a dof to another or to ground"},
        {CLI_TEXT(&asked.space.matrices), .name = "state-space",
         .argument = "A=F,B=F,C=F[,D=F][,E=F]",
         .help = "E x' = A x + B u, y = C x + D u instead; or a file of them"},
        {CLI_TEXT(&asked.space.inputs), .name = "input-names",
         .argument = "NAME[,NAME]", .help = "of a state space [u1,u2,...]"},
        {CLI_TEXT(&asked.space.outputs), .name = "output-names",
         .argument = "NAME[@LIMIT][,NAME]", .help = "the same [y1,y2,...]"},
        {CLI_TEXT(&asked.request.units), .name = "units", .argument = "LABELS",
         .help = "\"kg m s\": kept and shown, nothing is converted"},
        {CLI_FLAG(&asked.request.symmetrise), .name = "symmetrise",
         .help = "average away any asymmetry, not only up to 1e-6"},
        {0},
    };

    return serve(options, argc, argv, &asked);
}
