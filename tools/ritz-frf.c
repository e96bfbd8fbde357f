/* ritz-frf - frequency response from inputs to outputs. */
#include "print/print.h"

#include <math.h>

static const cli_program program = {
    .name = "ritz-frf",
    .operands = {{"FILE",
                  "a component, reduced component, system or state space, or a "
                  "measured response, as a container or columns of text",
                  false}},
    .summary = "Frequency response from every input to every output.",
    .example = "ritz-frf system.h5 --at clock=60,cone=0 --to-hz 10 "
               "-o response.h5",
    .output = "the response",
    .threads = true,
};

int main(int argc, char **argv)
{
    response_options given = {.from_hz = (double)NAN, .method = "auto"};
    loop_options *loops = &given.loops;
    const cli_option options[] = {
        CLI_REAL("from-hz", &given.from_hz, "F", 0.0, 1e9,
                 "lowest frequency [the band's, or the highest / 1000, but not "
                 "below "
                 "the rounding of rigid motion]"),
        CLI_REAL("to-hz", &given.to_hz, "F", 1e-9, 1e9,
                 "highest frequency [that of the band of a system]"),
        CLI_INT("points", &given.points, "N", 2, 1000000,
                "number of evenly spaced points [400; with --tolerance 20]"),
        CLI_FLAG("log", &given.log,
                 "space points evenly in the logarithm of frequency"),
        CLI_FLAG("no-refine", &given.no_refine,
                 "add no points at and around resonances"),
        CLI_TEXT("points-of", &given.points_of, "FILE",
                 "use the points of another response instead"),
        CLI_TEXT("method", &given.method, "NAME",
                 "how to compute it: one of --list"),
        CLI_REAL("tolerance", &given.tolerance, "X", 1e-9, 0.5,
                 "add points until interpolation is within X of each "
                 "channel's largest |H|"),
        CLI_REAL("up-to-hz", &given.up_to_hz, "F", 1e-9, 1e9,
                 "modes of a component up to here [three times the "
                 "highest frequency]"),
        CLI_ACTION("list", responses_list, "list methods and what each is for"),
        MODEL_OPTIONS(&given.model),
        CLI_FLAG("singular-values", &given.singular,
                 "also singular values of H, and their peaks between points"),
        CLI_FLAG("over-limits", &given.over_limits,
                 "divide outputs by their limits before singular values"),
        CLI_LIST("input-size", &given.input_size, "NAME=X",
                 "multiply this input by X before taking singular values"),
        CLI_FLAG("zeros", &given.zeros,
                 "list the transmission zeros of every channel"),
        CLI_TEXT("controller", &loops->controller, "FILE",
                 "close a loop with this state space, or with a response that "
                 "was measured: a container, or columns of text"),
        CLI_LIST("connect", &loops->connect, "OUT=IN",
                 "join signals of plant and controller by these names"),
        CLI_WORD("feedback", &loops->feedback, "negative|positive",
                 "sign with which the loop is closed [negative]"),
        CLI_OUTPUT("closed-loop", &loops->states, "FILE",
                   "write the closed loop as a state space"),
        CLI_FLAG("force", &loops->force,
                 "compute the response even if the loop is unstable"),
        {0},
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    return cli_finish(&run, responses_run(&run, &given));
}
