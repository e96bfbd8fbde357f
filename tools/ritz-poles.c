/* ritz-poles - damped poles, and what dampers make of them. */
#include "print/print.h"

#include <math.h>

/* End the program if options exclude each other. */
static void check_options(const cli_program *program,
                          const poles_options *given)
{
    if (given->modes > 0 && given->up_to_hz > 0.0)
        cli_refuse(program, "--modes and --up-to-hz are two ways to say the "
                            "same");
    if (given->up_to_hz > 0.0 && !isnan(given->near_hz))
        cli_refuse(program, "--up-to-hz counts from 0, --near-hz from a "
                            "frequency: one of the two");
    if ((given->scan.count > 0) + (given->tune.count > 0) + given->norm > 1)
        cli_refuse(program, "--scan, --tune and --norm: one of the three");
    if (given->places > 0 && given->tune.count == 0)
        cli_refuse(program, "--place chooses among what --tune names");
    if (given->among > 0 && given->places == 0)
        cli_refuse(program, "--among needs --place");
    if (given->low_pass && given->tune.count == 0 && !given->norm)
        cli_refuse(program, "--low-pass needs --norm or --tune");
}

int main(int argc, char **argv)
{
    poles_options given = {.mode = 1, .near_hz = (double)NAN};
    const cli_option options[] = {
        CLI_INT("modes", &given.modes, "N", 1, 1e6,
                "list the lowest N [all; 20 of a component or of sparse "
                "states]; with --tune: modes of the first model that a "
                "component is tuned with [20]"),
        CLI_REAL("up-to-hz", &given.up_to_hz, "F", 1e-9, 1e9,
                 "list the poles with |s|/2pi up to this instead"),
        CLI_REAL("near-hz", &given.near_hz, "F", 0.0, 1e9,
                 "of a state space: list the poles nearest to this frequency "
                 "[the lowest]"),
        MODEL_OPTIONS(&given.model),
        CLI_LIST(
            "scan", &given.scan, "NAME[,NAME]=FROM:TO:STEP[*FROM:TO:STEP]",
            "vary c of these dampers, the same for all, or k after '*', or "
            "both"),
        CLI_INT("mode", &given.mode, "K", 1, 1e6,
                "mode that a scan follows, by its number at FROM"),
        CLI_FLAG("norm", &given.norm,
                 "instead of poles: the H2 norm from noise at the inputs to "
                 "the outputs, which are divided by their limits"),
        CLI_LIST("tune", &given.tune, "NAME[,NAME]=FROM:TO[*FROM:TO]",
                 "find c of these dampers, the same for all, and k after '*', "
                 "with the smallest H2 norm; 'each=...': of every damper by "
                 "itself"),
        CLI_INT(
            "place", &given.places, "N", 1, 1e3,
            "with --tune: use only N of the dampers that it names, those with "
            "the smallest norm"),
        CLI_INT("among", &given.among, "N", 1, 1e6,
                "with --place: combine the N dampers that are best alone [five "
                "more "
                "than places]"),
        CLI_TEXT("low-pass", &given.low_pass, "HZ[:ORDER]",
                 "noise through a Butterworth filter, for --norm and --tune "
                 "[white; order 6]"),
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
        .summary = "Damped poles: frequency |s|/2pi and damping ratio of each; "
                   "the H2 norm; the best c, k and places of dampers.",
        .example = "ritz-poles chain.h5 --damper top=150*-200 --scan "
                   "top,middle=0:1000:10 --mode 2",
        .output = "write the text there too",
        .output_optional = true,
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    check_options(&program, &given);
    return cli_finish(&run, poles_report(&run, &given));
}
