/* ritz-export - a reduced model or a response as a file of others. */
#include "print/print.h"

/* Three letters for what an exporter takes in addition to reduced
 * components. */
static const char *marks_of(const ritz_exporter *e, char text[4])
{
    const bool states = (e->takes & RITZ_EXPORT_STATES) != 0;
    const bool shapes = (e->takes & RITZ_EXPORT_SHAPES) != 0;
    const bool ports = (e->takes & RITZ_EXPORT_PORTS) != 0;

    snprintf(text, 4, "%s%s%s", states || shapes || ports ? "a" : "",
             shapes || ports ? "c" : "", states ? "s" : "");
    return text;
}

static void list_formats(void)
{
    char marks[4];

    for (const ritz_exporter *const *e = ritz_exporters; *e; e++)
        printf("%-16s %-9s %-3s %-52s [%s]\n", (*e)->name, (*e)->kind,
               marks_of(*e, marks), (*e)->summary, (*e)->reference);
    printf("\nreduced: a reduced component; shapes: modes of a component or of "
           "a reduced component and,\nbut for uff, columns of a basis.\n"
           "a  also a system at a configuration (--at)\n"
           "c  whose bodies --component names\n"
           "s  also a state space, as --states makes of the others\n");
}

static const cli_program program = {
    .name = "ritz-export",
    .operands = {{"FILE",
                  "a reduced component, system, state space, response "
                  "over hertz or seconds; for shapes also a component or a "
                  "basis",
                  false}},
    .summary = "Write a reduced component for a simulator, or a response "
               "as a table, and say what\nis known of its errors and "
               "whether it is stable.",
    .example = "ritz-export blade-verified.h5 --to exudyn -o blade.hdf5",
    .output = "the file in that format",
};

/* Choose the exporter, and refuse options that it does not take. */
static void settle_options(const char *to, export_options *given)
{
    const ritz_export_request *request = &given->request;

    if (!to)
        cli_refuse(&program, "no format, name it with --to; --list shows all");
    given->exporter = cli_choose(&program, "format", to, ritz_exporters);
    if (ritz_export_check(given->exporter, request) != RITZ_OK)
        cli_refuse(&program, "%s", ritz_error_message());
    if (given->component.count > 0 &&
        !(given->exporter->takes & (RITZ_EXPORT_SHAPES | RITZ_EXPORT_PORTS)))
        cli_refuse(&program,
                   "--component is for shapes of a basis, and for shapes and "
                   "ports of a system");
    if (given->states && !(given->exporter->takes & RITZ_EXPORT_STATES))
        cli_refuse(&program, "%s takes no state space, --states is not for it",
                   to);
}

int main(int argc, char **argv)
{
    const char *to = NULL;
    export_options given = {0};
    ritz_export_request *request = &given.request;
    const cli_option options[] = {
        CLI_TEXT("to", &to, "FORMAT", "file format, one of --list"),
        CLI_TEXT("matrix", &request->matrices, "NAME[,NAME]",
                 "write these matrices only, rows to recover by their "
                 "names [K,M,D,K4 or A to E; matlab: inputs and outputs too]"),
        CLI_FLAG("text", &request->text,
                 "write text instead of binary (output4, superelement)"),
        CLI_FLAG("dense", &request->dense,
                 "write every entry, zeros too (output4, superelement)"),
        CLI_INT("digits", &request->digits, "N", 1, 17,
                "significant digits of text [17]"),
        CLI_FLAG("numbered", &request->numbered,
                 "as NASTRAN-95 wants it: marked continuations, both "
                 "triangles, exponents with a D (dmig)"),
        CLI_INT("id", &request->id, "N", 1, 99999999,
                "number of a superelement, and unit of its file "
                "(superelement) [101]"),
        CLI_TEXT("port", &request->ports, "NAME[,NAME]",
                 "ports whose grids are the interface (basilisk, chrono, "
                 "openfast, openfast-4, simscape) [those attached]"),
        CLI_TEXT(
            "frame", &request->frame, "basic|centre|GRID",
            "where the moving frame of a body is [basic; 42, fxbody: centre]"),
        CLI_TEXT("reference", &request->reference, "none|mean-axis|tangent",
                 "what its modes are measured from [none; 42, fxbody, sid: by "
                 "frame]"),
        CLI_TEXT("stiffening", &request->stiffening, "TERM[=LOAD][,...]",
                 "geometric stiffness of these loads as terms spin_xx to "
                 "spin_xz, turn_x, accel_x, force_x@GRID, moment_x@GRID "
                 "(mbdyn, sid) [none]"),
        CLI_INT("fmi", &request->fmi, "N", 2, 3, "version of FMI (fmu) [3]"),
        MODEL_OPTIONS(&given.model),
        CLI_FLAG("states", &given.states,
                 "write the states x' = A x + B u, y = C x + D u, with damping "
                 "in A"),
        CLI_FLAG("force", &given.force,
                 "export even a model that is unstable or of unknown errors"),
        CLI_TEXT("modes", &request->modes, "LIST",
                 "shapes of these modes or columns, as 1-6,9 (uff, vtu, "
                 "xdmf) [all; 10 of a component]"),
        CLI_LIST("component", &given.component, "[BODY=]FILE",
                 "component to which a basis belongs; reduced component of a "
                 "body of a system (simscape, uff, vtu, xdmf, openfast)"),
        CLI_ACTION("list", list_formats, "list formats and what they take"),
        {0},
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    settle_options(to, &given);
    request->output = run.output;
    return cli_finish(&run, export_run(&run, &given));
}
