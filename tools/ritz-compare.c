/* ritz-compare - two-stage reduction of a scene over all configurations. */
#include "print/print.h"

#include <ritz/base.h>

/* "1e-12,1e-6" */
static void read_tolerances(const cli_program *program, const char *list,
                            comparison_options *given)
{
    char word[RITZ_NAME_SIZE];

    while (cli_next(&list, word)) {
        double *into = &given->tolerance[given->num_tolerances];

        if (given->num_tolerances == COMPARISON_MOST_TOLERANCES)
            cli_refuse(program, "--tolerances takes %d numbers, not more",
                       (int)COMPARISON_MOST_TOLERANCES);
        if (!ritz_text_real(word, into) || !(*into > 0.0 && *into < 1.0))
            cli_refuse(program,
                       "--tolerances takes numbers between 0 and 1, not '%s'",
                       word);
        given->num_tolerances++;
    }
}

int main(int argc, char **argv)
{
    comparison_options given = {0};
    const char *tolerances = NULL;
    const cli_option options[] = {
        CLI_TEXT("components", &given.prefix, "PREFIX",
                 "also write the reduced components, as PREFIXname.h5"),
        CLI_OUTPUT("report", &given.report, "FILE",
                   "also write the report to this file"),
        CLI_TEXT("extraneous", &given.extraneous, "WORD",
                 "system modes that match no kept mode: keep, remove, "
                 "out-of-band, or compact: drop the vectors of components "
                 "that make them [the scene's]"),
        CLI_OUTPUT("tracks", &given.tracks, "FILE",
                   "write which mode of stage 1 is which at each "
                   "configuration, as a table with tabs"),
        CLI_TEXT("tolerances", &tolerances, "X[,X]",
                 "tabulate orders and errors against composite tolerances"),
        CLI_OUTPUT("tolerance-table", &given.tolerance_table, "FILE",
                   "write that table to a file, with tabs [tolerances 1e-12 "
                   "to 1e-2]"),
        {0},
    };
    const cli_program program = {
        .name = "ritz-compare",
        .operands = {{"SCENE", "scene file (YAML)", false}},
        .summary = "Reduce the components of an articulated system in two "
                   "stages so that the important\nsystem modes are kept at "
                   "every configuration of the scene [LeeTsuha1992]; report "
                   "what\nwas reduced, how far, and how wrong it is.\n"
                   "After SIGINT or SIGTERM, write the configurations that are "
                   "done to OUTPUT.interrupted.",
        .example = "ritz-compare scene.yaml --components small- --report "
                   "report.txt -o system.h5",
        .output = "the system of the second stage",
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    if (given.tolerance_table && !tolerances)
        tolerances = "1e-12,1e-10,1e-8,1e-6,1e-5,1e-4,1e-3,1e-2";
    if (tolerances)
        read_tolerances(&program, tolerances, &given);
    return cli_finish(&run, comparison_run(&run, &given));
}
