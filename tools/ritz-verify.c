/* ritz-verify - full against reduced: every error, pass or fail. */
#include "print/print.h"

enum { OWN_OPTIONS = 5 };

/* "--limit-gain": one option for each measure that takes a limit. */
static void add_limits(ritz_verify_request *request,
                       char (*name)[RITZ_NAME_SIZE], cli_option *options)
{
    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];

        if (!kind->word)
            continue;
        snprintf(name[k], sizeof name[k], "limit-%s", kind->word);
        *options++ =
            (cli_option)CLI_REAL(name[k], &request->limit[k], "X", 0.0,
                                 kind->large_is_good ? 1.0 : 1e9, kind->help);
    }
}

int main(int argc, char **argv)
{
    verify_options given = {.verify = RITZ_VERIFY_NONE};
    char name[RITZ_MEASURES][RITZ_NAME_SIZE];
    cli_option options[OWN_OPTIONS + RITZ_MEASURES + 1] = {
        CLI_PAIR("band-hz", given.verify.band_hz, "F,F",
                 "band in Hz of all measures [the scene's; else up to half the "
                 "highest reduced frequency]"),
        MODEL_OPTIONS(&given.model),
    };
    const cli_program program = {
        .name = "ritz-verify",
        .operands = {{"FULL",
                      "the full component (ritz-assemble --full of a "
                      "system) or state space; or a reduced component or "
                      "system that was reduced further",
                      false},
                     {"REDUCED", "the reduced component, system or state space",
                      false}},
        .summary = "Measure every error of a reduced model against the full "
                   "one. The output is REDUCED\nwith the errors, their limits "
                   "and verdicts added; it is written even where a limit is\n"
                   "not met (status 1), so that the file says so.",
        .example = "ritz-verify blade.h5 blade-reduced.h5 --limit-frequency "
                   "1e-3 -o blade-verified.h5",
        .output = "REDUCED with its errors",
        .threads = true,
    };
    cli_run run;

    add_limits(&given.verify, name, options + OWN_OPTIONS);
    cli_parse(&program, options, argc, argv, &run);
    return cli_finish(&run, verify_run(&run, &given));
}
