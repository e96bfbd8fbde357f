/* ritz-simulate - time responses, and what a simulated second costs. */
#include "print/print.h"

static void list_integrators(void)
{
    for (const ritz_integrator *const *i = ritz_integrators; *i; i++)
        printf("%s\n    %s\n    accuracy:    %s\n    stable:      %s\n"
               "    dissipation: %s\n    fails:       %s\n    [%s]\n",
               (*i)->name, (*i)->summary, (*i)->accuracy, (*i)->stability,
               (*i)->dissipation, (*i)->fails, (*i)->reference);
}

static void print_stabilisation(const ritz_stabilisation *s)
{
    printf("%s\n    %s\n    accuracy:    %s\n    needs:       %s\n"
           "    stable:      %s\n    highest Hz:  %s\n    fails:       %s\n",
           s->name, s->summary, s->accuracy, s->needs, s->stability,
           s->frequency, s->fails);
    for (int k = 0; k < RITZ_MOST_GAINS && s->gain[k].name; k++)
        printf("    %s%s%s: %s\n", s->gain[k].name,
               *s->gain[k].unit ? ", " : "", s->gain[k].unit,
               s->gain[k].summary);
    printf("    [%s]\n", s->reference);
}

static void list_all(void)
{
    list_integrators();
    printf("\n--constraints, of scenes:\n\n");
    for (const ritz_stabilisation *const *s = ritz_stabilisations; *s; s++)
        print_stabilisation(*s);
}

static const cli_program program = {
    .name = "ritz-simulate",
    .operands = {{"FILE",
                  "a component, reduced component, system or state space, or "
                  "a scene, whose system at --at is simulated",
                  false}},
    .summary = "Time response to inputs and initial values, with its "
               "energies, and what a\nsimulated second costs.\n"
               "After SIGINT or SIGTERM, write what is done to "
               "OUTPUT.interrupted; the same command\nremoves it when it "
               "completes.",
    .example = "ritz-simulate reduced.h5 --seconds 10 --input torque=step "
               "-o run.h5",
    .output = "the time response",
    .output_optional = true,
    .threads = true,
};

/* Options of every run. */
#define RUN_OPTIONS(it)                                                        \
    CLI_TEXT("method", &(it)->method, "NAME", "integrator, one of --list"),    \
        CLI_REAL("seconds", &(it)->seconds, "T", 1e-12, 1e12,                  \
                 "duration of the simulation, seconds"),                       \
        CLI_REAL("step", &(it)->step, "H", 1e-15, 1e12,                        \
                 "time step in seconds [chosen by --accuracy]"),               \
        CLI_FLAG("any-step", &(it)->any_step,                                  \
                 "accept a step at which constraints or a split loop are not " \
                 "stable, to see it fail"),                                    \
        CLI_REAL("accuracy", &(it)->accuracy, "X", 1e-12, 1.0,                 \
                 "halve the step until the error of outputs is below X of "    \
                 "their largest value [1e-3]"),                                \
        CLI_LIST("input", &(it)->input, "NAME=SIGNAL",                         \
                 "step, impulse, sine:F or chirp:F,F, each with "              \
                 "*AMPLITUDE if not 1, or a file of times and values"),        \
        CLI_TEXT("initial", &(it)->initial, "TEXT",                            \
                 "mode:K or mode:K*AMPLITUDE, or a file with a value and "     \
                 "its rate on each row"),                                      \
        CLI_WORD("hold", &(it)->hold, "first|zero",                            \
                 "inputs within a step: linear, or constant as at its "        \
                 "start"),                                                     \
        CLI_REAL("rho", &(it)->rho, "R", 0.0, 1.0,                             \
                 "spectral radius of generalised-alpha at high frequency"),    \
        CLI_INT("every", &(it)->every, "N", 1, 1e9,                            \
                "with --step, write every N-th step"),                         \
        CLI_REAL("up-to-hz", &(it)->up_to_hz, "F", 1e-9, 1e9,                  \
                 "with --method modal, highest mode of a component"),          \
        CLI_FLAG(                                                              \
            "coordinates", &(it)->coordinates,                                 \
            "store the coordinates of a reduced component or system too, or "  \
            "of each body of a scene with --constraints or --sweep, for "      \
            "ritz-recover")

/* A controller with which the model forms a closed loop. */
#define LOOP_OPTIONS_IN_TIME(it)                                               \
    CLI_TEXT("controller", &(it)->loops.controller, "FILE",                    \
             "close a loop with this state space"),                            \
        CLI_LIST("connect", &(it)->loops.connect, "OUT=IN",                    \
                 "join signals of plant and controller by these names"),       \
        CLI_WORD("feedback", &(it)->loops.feedback, "negative|positive",       \
                 "sign with which the loop is closed [negative]"),             \
        CLI_WORD("loop", &(it)->way, "split|exact",                            \
                 "propagate plant and controller separately over a step, or "  \
                 "together by one exponential [split]"),                       \
        CLI_REAL("sample", &(it)->sample, "T", 1e-12, 1e12,                    \
                 "seconds between samples of the controller [continuous]"),    \
        CLI_REAL("delay", &(it)->delay, "T", 0.0, 1e12,                        \
                 "seconds from a sample until the controller acts"),           \
        CLI_FLAG("discrete", &(it)->discrete,                                  \
                 "the controller is a discrete system, sample to sample"),     \
        CLI_FLAG("force", &(it)->loops.force,                                  \
                 "simulate a loop that is itself unstable")

/* Joints of a scene that are enforced during the run. */
#define CONSTRAINT_OPTIONS(it)                                                 \
    CLI_TEXT("constraints", &(it)->constraints, "METHOD[:NAME=VALUE,...]",     \
             "enforce the joints of a scene during the run instead of "        \
             "eliminating them; one of --list"),                               \
        CLI_INT("start-digits", &(it)->start_digits, "N", 1, 17,               \
                "with --constraints, round the bodies' initial values to N "   \
                "digits, as a file has them")

/* Reduced models that are switched in time. */
#define SWITCHING_OPTIONS(it)                                                  \
    CLI_TEXT("switched", &(it)->switched, "LIBRARY[,LIBRARY]",                 \
             "switch reduced models in time, with vectors of bases, of "       \
             "matrices in any foreign file, or modes[:K]"),                    \
        CLI_REAL("switch-interval", &(it)->switch_interval, "T", 1e-12, 1e12,  \
                 "seconds from switch to switch, a multiple of the step"),     \
        CLI_REAL("indicator", &(it)->indicator, "E", 1e-6, 1.0 - 1e-9,         \
                 "vectors are added until their share of the residual is "     \
                 "above E, at most 1 - 1e-9 [0.99]"),                          \
        CLI_WORD("share-of", &(it)->share_of, "model|library",                 \
                 "--indicator is relative to the whole residual, or to its "   \
                 "part in the library [model]"),                               \
        CLI_FLAG(                                                              \
            "look-ahead", &(it)->look_ahead,                                   \
            "choose vectors for the inputs at the end of a switch interval "   \
            "too"),                                                            \
        CLI_WORD("inner", &(it)->inner, "mass|euclidean",                      \
                 "inner product in which vectors are orthogonal and "          \
                 "shares are measured [mass]"),                                \
        CLI_WORD("jump", &(it)->jump, "offset|project",                        \
                 "at a switch, keep the part of the state outside the set "    \
                 "constant, or remove it [offset]"),                           \
        CLI_REAL("hysteresis", &(it)->hysteresis, "H", 0.0, 0.99,              \
                 "multiply shares of the present vectors by 1 + H [0]"),       \
        CLI_REAL("dwell", &(it)->dwell, "T", 0.0, 1e12,                        \
                 "shortest time for which a set is kept, s; 0: one interval"), \
        CLI_FLAG("redundant", &(it)->redundant,                                \
                 "vectors of the library may be linearly dependent")

/* A joint of a scene that moves during the run. */
#define SWEEP_OPTIONS(it)                                                      \
    CLI_LIST("sweep", &(it)->sweeps, "JOINT=FROM:TO:TIME[s][:smooth]",         \
             "turn a joint of a scene during the run, in degrees and "         \
             "seconds, or as a file of times and settings says"),              \
        CLI_WORD("sweep-basis", &(it)->sweep_basis,                            \
                 "switched|without-terms|one|full",                            \
                 "modes at each setting, with the terms of their change or "   \
                 "without; one basis of COMPARE for all; or all modes"),       \
        CLI_INT("sweep-modes", &(it)->sweep_modes, "N", 1, 1e6,                \
                "modes at each setting [those up to --up-to-hz or in the "     \
                "scene's band]"),                                              \
        CLI_WORD("sweep-against", &(it)->sweep_against,                        \
                 "switched|without-terms|one|full",                            \
                 "compare with the run in another basis")

int main(int argc, char **argv)
{
    simulation_options given = {.method = "modal",
                                .hold = "first",
                                .rho = 0.8,
                                .every = 1,
                                .hysteresis = -1.0, /* not given */
                                .dwell = -1.0,
                                .sweep_basis = "switched"};
    const cli_option options[] = {
        RUN_OPTIONS(&given),
        LOOP_OPTIONS_IN_TIME(&given),
        CONSTRAINT_OPTIONS(&given),
        SWITCHING_OPTIONS(&given),
        SWEEP_OPTIONS(&given),
        CLI_TEXT("checkpoint", &given.checkpoint, "FILE",
                 "write a checkpoint to FILE about every half minute; the same "
                 "command continues from it"),
        CLI_FLAG("cost", &given.cost,
                 "report what a simulated second costs, by each integrator, "
                 "and of a closed loop"),
        CLI_PAIR("band-hz", given.band_hz, "F,F",
                 "band that --cost resolves [that of a system; else all "
                 "frequencies]"),
        MODEL_OPTIONS(&given.model),
        CLI_ACTION("list", list_all,
                   "list integrators and methods for constraints, with their "
                   "accuracy and where they fail"),
        {0},
    };
    cli_run run;
    int status = 0;

    cli_parse(&program, options, argc, argv, &run);
    status = cli_finish(&run, simulation_run(&run, &given));
    if (status == 0)
        simulation_remove_leftovers(&run, &given);
    return status;
}
