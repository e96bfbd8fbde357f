/* The command line of ritz-reduce, which is also that of
   libexec/ritz-reduce-slepc.c. */
#include "print/print.h"

int reduce_main(int argc, char **argv,
                ritz_status (*make)(cli_run *run, reduce_options *given))
{
    reduce_options given = {0};
    const cli_option options[] = {
        CLI_PAIR("band-hz", given.estimate.band_hz, "F,F",
                 "band of the error estimates [up to half the highest "
                 "frequency of the basis]"),
        CLI_WORD("estimates", &given.estimates, "all|frequency|none",
                 "which errors to estimate: of frequencies and responses, of "
                 "frequencies only, or none [all]"),
        AT_OPTION(&given.model.at),
        ORDER_OPTION(&given.model.order),
        DAMPING_OPTION(&given.model.damping),
        CLI_WORD("engine", &given.engine, "auto|slepc",
                 "what projects: this process, or those of mpirun (see "
                 "docs/parallel.md) [auto]"),
        CLI_WORD("recovery", &given.recovery, "displacement|acceleration",
                 "rows of quantities by modes alone, or by mode acceleration "
                 "too, which factors K [displacement]"),
        CLI_TEXT("recovery-ports", &given.recovery_ports, "PORT[,PORT]",
                 "with acceleration: ports on which forces act that are no "
                 "inputs, '' for none [all]"),
        CLI_FLAG("without-basis", &given.without_basis,
                 "leave out T and the full mesh, for a smaller file"),
        {0},
    };
    const cli_program program = {
        .name = "ritz-reduce",
        .operands = {{"COMPONENT",
                      "the full component or state space, or a reduced "
                      "component or system for which the basis was made",
                      false},
                     {"BASIS", "what ritz-basis made of it", false}},
        .summary = "Project a component on a basis; estimate the errors; "
                   "state its mass properties.",
        .example = "ritz-reduce blade.h5 basis.h5 -o blade-reduced.h5",
        .output = "the reduced component; the state space, of states or of "
                  "vectors on two sides",
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    return cli_finish(&run, make(&run, &given));
}
