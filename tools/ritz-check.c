/* ritz-check - audit a component before it is reduced, or probe a small
   model. */
#include "print/print.h"

int main(int argc, char **argv)
{
    model_options given = {0};
    cli_list loads = {0};
    const cli_option options[] = {
        CLI_LIST("load", &loads, "NAME=X",
                 "check that the model is far enough from buckling under X "
                 "times a load of which it has geometric stiffness"),
        AT_OPTION(&given.at),
        ORDER_OPTION(&given.order),
        {0},
    };
    const cli_program program = {
        .name = "ritz-check",
        .operands = {{"MODEL",
                      "a component to audit, or a reduced component, system "
                      "or state space to probe",
                      false}},
        .summary = "Audit a component before it is reduced: symmetry, "
                   "definiteness, rigid-body modes,\ngrounding, mass "
                   "properties, massless and unconnected dofs, digits, ports, "
                   "buckling factors of\nloads. Probe a small model for "
                   "stability: definiteness, poles, "
                   "energy growth, passivity, its interface locked\nand on "
                   "springs. Status 1 if one check fails; warnings do not "
                   "fail.",
        .example = "ritz-check blade.h5",
        .output = "write the table there too",
        .output_optional = true,
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    return cli_finish(&run, checks_run(&run, &given, &loads));
}
