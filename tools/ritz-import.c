/* ritz-import - matrices and geometry of an FE code become a component. */
#include "print/import.h"

#include <string.h>

/* A state space has neither rows with names nor ports. */
static void refuse_others(const cli_program *program)
{
    static const char *const own[] = {"state-space", "input-names",
                                      "output-names", "units"};

    for (const cli_option *o = program->options; o->kind != CLI_KIND_END; o++) {
        bool other = cli_given(o);

        for (size_t k = 0; k < sizeof own / sizeof *own; k++)
            other = other && strcmp(o->name, own[k]) != 0;
        if (other)
            cli_refuse(program,
                       "--state-space is a whole model, --%s is not for it",
                       o->name);
    }
}

/* The options stand in main, which has room for nothing else. */
static int import_files(const cli_option *options, int argc, char **argv,
                        import_wish *asked)
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
        refuse_others(&program);
        asked->space.units = asked->request.units;
        return cli_finish(&run, import_states(&run, &asked->space));
    }
    if (asked->space.inputs || asked->space.outputs)
        cli_refuse(&program, "--input-names and --output-names are for "
                             "--state-space");
    if (!asked->request.stiffness && !asked->request.mass)
        cli_refuse(&program, "nothing to import: name --stiffness, --mass or "
                             "both, or --state-space");
    return cli_finish(&run, import_component(&run, asked));
}

int main(int argc, char **argv)
{
    import_wish asked = {0};
    const cli_option options[] = {
        CLI_TEXT("stiffness", &asked.request.stiffness, "F",
                 "matrix K, F being FILE[:NAME[#K]]; absent: a rigid body"),
        CLI_TEXT("mass", &asked.request.mass, "F", "matrix M"),
        CLI_TEXT("damping", &asked.request.damping, "F", "viscous damping D"),
        CLI_TEXT("structural-damping", &asked.request.structural_damping, "F",
                 "structural damping K4, of K + i K4"),
        CLI_LIST("geometric-stiffness", &asked.load, "F@LOAD",
                 "geometric stiffness of a unit load"),
        CLI_TEXT("bulk", &asked.request.bulk, "F",
                 "NASTRAN bulk data: grids, frames, sets"),
        CLI_TEXT("dofs", &asked.request.dofs, "F",
                 "what each row is: GRID COMP a line, COMP 0 a scalar point"),
        CLI_LIST("port", &asked.port, "NAME=GRIDS[:COMPS]",
                 "dofs by which other bodies hold this one"),
        CLI_LIST("rigid-port", &asked.rigid, "NAME=GRIDS[:COMPS]",
                 "port of a new grid amid these, which they follow rigidly"),
        CLI_LIST("averaged-port", &asked.averaged, "NAME=GRIDS[:COMPS]",
                 "port of a new grid that is the average of these"),
        CLI_LIST("input", &asked.input, "NAME=GRID:COMP[*SCALE]",
                 "force (COMP 1-3) or moment (4-6)"),
        CLI_LIST("output-at", &asked.output,
                 "NAME=GRID:COMP[/vel|/acc][@LIMIT]",
                 "displacement, velocity or acceleration that matters"),
        CLI_LIST("damper", &asked.damper, "NAME=GRID:COMP[,GRID:COMP]*C[*K]",
                 "damper C, and spring K, from a dof to another or to ground"),
        CLI_TEXT("state-space", &asked.space.matrices,
                 "A=F,B=F,C=F[,D=F][,E=F]",
                 "E x' = A x + B u, y = C x + D u instead; or a file of them"),
        CLI_TEXT("input-names", &asked.space.inputs, "NAME[,NAME]",
                 "of a state space [u1,u2,...]"),
        CLI_TEXT("output-names", &asked.space.outputs, "NAME[@LIMIT][,NAME]",
                 "the same [y1,y2,...]"),
        CLI_TEXT("units", &asked.request.units, "LABELS",
                 "\"kg m s\": kept and shown, nothing is converted"),
        CLI_FLAG("symmetrise", &asked.request.symmetrise,
                 "average away any asymmetry, not only up to 1e-6"),
        {0},
    };

    return import_files(options, argc, argv, &asked);
}
