/* ritz-import - matrices and geometry of an FE code become a component. */
#include "print/print.h"

static const cli_program program = {
    .name = "ritz-import",
    .summary = "Matrices and geometry of a finite-element code become a "
               "component.",
    .example = "ritz-import --stiffness blade.op4:KGG --mass "
               "blade.op4:MGG --bulk blade.bdf \\\n"
               "      --port root=1-4:123 --units \"kg m s\" -o blade.h5",
    .output = "the component or state space",
};

/* Inputs and outputs that are given as matrices. */
#define MATRIX_OPTIONS(it)                                                     \
    CLI_TEXT("input-matrix", &(it)->input_matrix, "F",                         \
             "B of the forces B f on the rows, n x inputs"),                   \
        CLI_TEXT("output-matrix", &(it)->output_matrix, "F",                   \
                 "C of y = C u + Cv u' + Ca u'', outputs x n"),                \
        CLI_TEXT("velocity-matrix", &(it)->velocity_matrix, "F",               \
                 "Cv, likewise"),                                              \
        CLI_TEXT("acceleration-matrix", &(it)->acceleration_matrix, "F",       \
                 "Ca, likewise"),                                              \
        CLI_TEXT("input-names", &(it)->input_names, "NAME[,NAME]",             \
                 "of inputs of a matrix or state space [u1,u2,...]"),          \
        CLI_TEXT("output-names", &(it)->output_names, "NAME[@LIMIT][,NAME]",   \
                 "of outputs of matrices or a state space [y1,y2,...]")

int main(int argc, char **argv)
{
    import_options given = {0};
    ritz_import_request *const it = &given.request;
    const cli_option options[] = {
        CLI_TEXT("stiffness", &it->stiffness, "F",
                 "K, F being FILE[:NAME[#K]]; complex: K + i K4 [none: rigid]"),
        CLI_TEXT("mass", &it->mass, "F", "matrix M"),
        CLI_TEXT("damping", &it->damping, "F", "viscous damping D"),
        CLI_TEXT("structural-damping", &it->structural_damping, "F",
                 "structural damping K4, of K + i K4"),
        CLI_LIST("geometric-stiffness", &given.load, "F@LOAD",
                 "K_g for a unit of LOAD, tension positive"),
        CLI_LIST("preload", &given.preload, "LOAD=X",
                 "X times LOAD acts always: the stiffness is K + X KG [none]"),
        CLI_TEXT("superelement", &given.superelement, "F.op4",
                 "all of these of NASTRAN's EXTSEOUT, rows by F.pch or F.asm"),
        CLI_TEXT("bulk", &it->bulk, "F",
                 "deck of NASTRAN, Abaqus, ANSYS, CalculiX: grids, frames"),
        CLI_TEXT("dofs", &it->dofs, "F",
                 "names of rows: GRID COMP or GRID.COMP a line, 0: a point"),
        CLI_TEXT("rows", &it->rows, "COMPS",
                 "rows at grids 1, 2, ..., as 126; 0: scalar points [123456]"),
        CLI_TEXT("frequencies", &it->frequencies, "F",
                 "instead of matrices: frequencies in Hz of a modal form"),
        CLI_TEXT("ratios", &it->ratios, "F|ZETA",
                 "damping ratios of the modal form [none]"),
        CLI_LIST("port", &given.port, "NAME=GRIDS[:COMPS]",
                 "dofs by which this body is joined to others"),
        CLI_LIST("rigid-port", &given.rigid, "NAME=GRIDS[:COMPS]",
                 "port of a new grid amid GRIDS, moving rigidly with it"),
        CLI_LIST("averaged-port", &given.averaged, "NAME=GRIDS[:COMPS]",
                 "port of a new grid that moves as the average of GRIDS"),
        CLI_LIST("input", &given.input, "NAME=GRID:COMP[*SCALE][,...]",
                 "force (COMP 1-3) or moment (4-6) on grids; terms are added"),
        CLI_LIST("output-at", &given.output,
                 "NAME=GRID:COMP[*SCALE][,...][/vel|/acc][@LIMIT]",
                 "displacement, velocity or acceleration of grids"),
        MATRIX_OPTIONS(it),
        CLI_LIST("recovery", &given.recovery, "NAME=F[,KIND]",
                 "rows S of y = S u: stress, force, displacement, ..."),
        CLI_LIST("recovery-rows", &given.recovery_rows, "NAME=FILE",
                 "element and component of these rows, a line as '12 sx' for "
                 "each, or a .pch with TES1, TEF1, TUG1"),
        CLI_LIST("damper", &given.damper, "NAME=GRID:COMP[,GRID:COMP]*C[*K]",
                 "damper C, and spring K, between two dofs or to ground"),
        CLI_TEXT(
            "state-space", &given.space.matrices, "A=F,B=F,C=F[,D=F][,E=F]",
            "E x' = A x + B u, y = C x + D u, or one file F with all of these"),
        CLI_TEXT("units", &it->units, "LABELS",
                 "\"kg m s\": kept and shown, nothing is converted"),
        CLI_FLAG("symmetrise", &it->symmetrise,
                 "average away any asymmetry, not only up to 1e-6"),
        {0},
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    return cli_finish(&run, import_run(&run, &given));
}
