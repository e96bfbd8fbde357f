/* ritz-fit - the smallest model that meets a tolerance. */
#include "print/print.h"

enum { NUM_OWN = 14 };

/* "frequency, mac (least), missing (modes)" */
static const char *tolerance_help(void)
{
    static char help[1024];

    help[0] = '\0';
    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];

        if (kind->word && kind->of_modes)
            sink_append(help, sizeof help, "%s%s%s%s%s%s", *help ? ", " : "",
                        kind->word, kind->large_is_good ? " (least)" : "",
                        kind->unit[0] ? " (" : "", kind->unit,
                        kind->unit[0] ? ")" : "");
    }
    sink_append(help, sizeof help,
                "; a number alone is for flexible and frequency");
    return help;
}

int main(int argc, char **argv)
{
    fit_options given = {.request = RITZ_FIT_NONE, .seed = 1};
    ritz_fit_request *r = &given.request;
    choice_words choice = {0};
    cli_option options[NUM_OWN + WORDS_MOST + 1] = {
        CLI_TEXT("tolerance", &given.tolerance, "[MEASURE=]X[,MEASURE=X]",
                 tolerance_help()),
        CLI_PAIR("band-hz", r->tolerance.band_hz, "F,F",
                 "band in which the tolerance must hold [the scene's]"),
        DAMPERS_OPTION(&given.damper),
        CLI_TEXT("methods", &given.methods, "M[,M]",
                 "methods to try, or all; for a scene compare too [those "
                 "of second order with a number of modes; of a component "
                 "with ports those that keep its interface]"),
        CLI_TEXT("attach", &r->attach, "PORT[,PORT]",
                 "for a component: keep the dofs of these ports [all]"),
        CLI_INT("largest", &r->largest, "N", 1, 100000,
                "try no order above [what the band suggests]"),
        CLI_INT("confirm", &r->num_random, "N", 0, 1000000,
                "confirm the result at N random frequencies"),
        CLI_INT("between", &r->num_between, "N", 0, 1000,
                "confirm the result at N random configurations"),
        CLI_INT("seed", &given.seed, "N", 0, 1e15,
                "seed of these random numbers"),
        CLI_FLAG("all", &given.all,
                 "compare all methods at equal error and at equal order"),
        CLI_INT("order", &given.order, "N", 1, 100000,
                "order of that comparison [that of the result]"),
        CLI_TEXT("components", &given.prefix, "PREFIX",
                 "for a scene: also write the reduced components, as "
                 "PREFIXname.h5"),
        CLI_OUTPUT("report", &given.report, "FILE",
                   "also write the report to this file"),
        DAMPING_OPTION(&given.damping),
    };
    const cli_program program = {
        .name = "ritz-fit",
        .operands = {{"INPUT", "a scene (YAML) or a component", false}},
        .summary = "Find the smallest model, over methods and orders, that "
                   "meets a tolerance in a band;\nconfirm it at random "
                   "frequencies and configurations; say why it is that one.\n"
                   "After SIGINT or SIGTERM, write the best so far to "
                   "OUTPUT.interrupted.",
        .example = "ritz-fit blade.h5 --tolerance response=1e-2,frequency=1e-3 "
                   "--band-hz 0,50 -o small.h5",
        .output = "the nested reduced component, or the system of a scene",
        .output_optional = true,
        .threads = true,
    };
    cli_run run;

    words_add(&choice, RITZ_USES_DAMPING | RITZ_USES_BAND, options + NUM_OWN);
    cli_parse(&program, options, argc, argv, &run);
    words_take(&program, &choice, &r->choice);
    return cli_finish(&run, fit_search(&run, &given));
}
