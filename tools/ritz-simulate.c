/* ritz-simulate - time responses, and what a simulated second costs. */
#include "cli/options.h"
#include "print/simulation.h"

#include <math.h>

static void list_integrators(void)
{
    for (const ritz_integrator *const *i = ritz_integrators; *i; i++)
        printf("%s\n    %s\n    accuracy:    %s\n    stable:      %s\n"
               "    dissipation: %s\n    fails:       %s\n    [%s]\n",
               (*i)->name, (*i)->summary, (*i)->accuracy, (*i)->stability,
               (*i)->dissipation, (*i)->fails, (*i)->reference);
}

static const cli_program about = {
    .name = "ritz-simulate",
    .operands = {{"FILE",
                  "a component, reduced component, system or state space",
                  false}},
    .summary = "Time response to inputs and initial values, with its "
               "energies, and what a\nsimulated second costs.",
    .example = "ritz-simulate reduced.h5 --seconds 10 --input torque=step "
               "-o run.h5",
    .output = "the time response",
    .output_optional = true,
    .threads = true,
};

int main(int argc, char **argv)
{
    simulation_wish asked = {.method = "modal",
                             .hold = "first",
                             .seconds = (double)NAN,
                             .step = (double)NAN,
                             .accuracy = (double)NAN,
                             .up_to_hz = (double)NAN,
                             .rho = 0.8,
                             .every = 1};
    const cli_option options[] = {
        CLI_TEXT("method", &asked.method, "NAME",
                 "the integrator, one of --list"),
        CLI_REAL("seconds", &asked.seconds, "T", 1e-12, 1e12, "how long"),
        CLI_REAL("step", &asked.step, "H", 1e-15, 1e12,
                 "of time, seconds [as --accuracy says]"),
        CLI_REAL("accuracy", &asked.accuracy, "X", 1e-12, 1.0,
                 "halve the step until outputs are within X of their largest "
                 "[1e-3]"),
        CLI_LIST("input", &asked.input, "NAME=SIGNAL",
                 "step, impulse, sine:F or chirp:F,F (*A behind), or a file of "
                 "times and values"),
        CLI_TEXT("initial", &asked.initial, "TEXT",
                 "mode:K or mode:K*A, or a file, a value and its rate a row"),
        CLI_TEXT("hold", &asked.hold, "first|zero",
                 "inputs in a step: linear, or as at its start"),
        CLI_REAL("rho", &asked.rho, "R", 0.0, 1.0,
                 "generalised-alpha: what a step leaves of high frequency"),
        CLI_INT("every", &asked.every, "N", 1, 1e9,
                "write each N-th step, with --step"),
        CLI_REAL("up-to-hz", &asked.up_to_hz, "F", 1e-9, 1e9,
                 "modes of a component, for modal"),
        CLI_FLAG("cost", &asked.cost,
                 "what a simulated second costs, by each integrator"),
        CLI_TEXT("band-hz", &asked.band, "F,F",
                 "whose end --cost resolves [of a system its own, or all]"),
        MODEL_OPTIONS(&asked.model),
        CLI_ACTION("list", list_integrators,
                   "list the integrators, with what they hold and where they "
                   "fail"),
        {0},
    };
    cli_program program = about;

    cli_run run;

    program.options = options;
    cli_parse(&program, argc, argv, &run);
    simulation_take(&run, &asked);
    return cli_finish(&run, simulation_run(&run, &asked));
}
