/* ritz-poles - damped poles, and what dampers make of them. */
#include "print/print.h"

int main(int argc, char **argv)
{
    poles_options given = {.mode = 1};
    const cli_option options[] = {
        CLI_INT("modes", &given.modes, "N", 1, 1e6,
                "list the lowest N [all, of a component 20]"),
        CLI_REAL("up-to-hz", &given.up_to_hz, "F", 1e-9, 1e9,
                 "list those with |s|/2pi up to this instead"),
        MODEL_OPTIONS(&given.model),
        CLI_TEXT("scan", &given.scan, "NAME[,NAME]=FROM:TO:STEP",
                 "vary the constant c of these dampers, all alike"),
        CLI_INT("mode", &given.mode, "K", 1, 1e6,
                "mode that a scan follows, by its number at FROM"),
        CLI_FLAG("tsv", &given.tsv,
                 "print columns separated by tabs, damping ratios not in "
                 "percent"),
        {0},
    };
    const cli_program program = {
        .name = "ritz-poles",
        .operands = {{"FILE",
                      "a component, reduced component, system or state space",
                      false}},
        .summary = "Damped poles: frequency |s|/2pi and damping ratio of each, "
                   "and the best c of dampers.",
        .example = "ritz-poles chain.h5 --damper top=150*-200 --scan "
                   "top,middle=0:1000:10 --mode 2",
        .output = "write the text there too",
        .output_optional = true,
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    if (given.modes > 0 && given.up_to_hz > 0.0)
        cli_refuse(&program, "--modes and --up-to-hz are two ways to say the "
                             "same");
    return cli_finish(&run, poles_report(&run, &given));
}
