/* ritz-poles - damped poles, and what dampers make of them. */
#include "print/print.h"

#include <math.h>

int main(int argc, char **argv)
{
    poles_options given = {.mode = 1, .up_to_hz = (double)NAN};
    const cli_option options[] = {
        CLI_INT("modes", &given.modes, "N", 1, 1e6,
                "the lowest N [all, 20 of a component]"),
        CLI_REAL("up-to-hz", &given.up_to_hz, "F", 1e-9, 1e9,
                 "those of |s| up to this instead"),
        MODEL_OPTIONS(&given.model),
        CLI_TEXT("scan", &given.scan, "NAME[,NAME]=FROM:TO:STEP",
                 "give these dampers one c, through a range"),
        CLI_INT("mode", &given.mode, "K", 1, 1e6,
                "follow this one in a scan, counted where it begins"),
        CLI_FLAG("tsv", &given.tsv,
                 "columns divided by tabs, ratios as numbers"),
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
        .options = options,
        .output = "write the text there too",
        .output_optional = true,
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, argc, argv, &run);
    if (given.modes > 0 && !isnan(given.up_to_hz))
        cli_refuse(&program, "--modes and --up-to-hz are two ways to say the "
                             "same");
    return cli_finish(&run, poles_report(&run, &given));
}
