/* The table of runs that are not those of one linear model, and the options
   that each kind of run uses. A new kind needs a file with its functions, and a
   row here. */
#include "print/simulation.h"

const simulation_kind simulation_kinds[] = {
    {.option = "--constraints",
     .use = SIMULATION_CONSTRAINTS,
     .asked = simulation_is_constrained,
     .simulate = simulation_constrained},
    {.option = "--switched",
     .use = SIMULATION_SWITCHED,
     .asked = simulation_switched_asked,
     .simulate = simulation_switched,
     .prepare = simulation_switched_prepare},
    {.option = "--controller",
     .use = SIMULATION_CONTROLLER,
     .asked = simulation_is_controlled,
     .simulate = simulation_controlled,
     .prepare = simulation_prepare_loop},
    {.option = "--sweep",
     .use = SIMULATION_SWEEP,
     .asked = simulation_sweep_asked,
     .simulate = simulation_sweep},
    {0},
};

ritz_status simulation_find_kind(const simulation_options *given,
                                 const simulation_kind **out)
{
    *out = NULL;
    for (const simulation_kind *k = simulation_kinds; k->option; k++) {
        if (!k->asked(given))
            continue;
        RITZ_REFUSE_IF(*out, RITZ_ERR_ARGUMENT, "give %s or %s, not both",
                       (*out)->option, k->option);
        *out = k;
    }
    return RITZ_OK;
}

/* Names of the uses in messages, in the order of their bits. */
static const char *const use_names[] = {
    "a run of one linear model",
    "--constraints",
    "--switched",
    "--controller",
    "--sweep",
    "a rate of spin that changes",
    "--cost",
};
enum { USES = sizeof use_names / sizeof *use_names };

/* Options that only some runs use. Every run uses the others. */
static const struct {
    const char *option;
    unsigned uses;
} options[] = {
    {"method", SIMULATION_RUN},
    {"step", SIMULATION_RUN},
    {"any-step", SIMULATION_CONSTRAINTS | SIMULATION_CONTROLLER},
    {"accuracy", SIMULATION_LINEAR},
    {"hold", SIMULATION_RUN},
    {"rho", SIMULATION_LINEAR | SIMULATION_CONSTRAINTS | SIMULATION_CONTROLLER},
    {"every", SIMULATION_RUN},
    {"up-to-hz", SIMULATION_LINEAR | SIMULATION_CONTROLLER | SIMULATION_SWEEP},
    {"coordinates", SIMULATION_RUN},
    {"connect", SIMULATION_CONTROLLER},
    {"feedback", SIMULATION_CONTROLLER},
    {"loop", SIMULATION_CONTROLLER},
    {"sample", SIMULATION_CONTROLLER},
    {"delay", SIMULATION_CONTROLLER},
    {"discrete", SIMULATION_CONTROLLER},
    {"force", SIMULATION_CONTROLLER},
    {"start-digits", SIMULATION_CONSTRAINTS},
    {"switch-interval", SIMULATION_SWITCHED},
    {"indicator", SIMULATION_SWITCHED},
    {"share-of", SIMULATION_SWITCHED},
    {"look-ahead", SIMULATION_SWITCHED},
    {"inner", SIMULATION_SWITCHED},
    {"jump", SIMULATION_SWITCHED},
    {"hysteresis", SIMULATION_SWITCHED},
    {"dwell", SIMULATION_SWITCHED},
    {"redundant", SIMULATION_SWITCHED},
    {"sweep-basis", SIMULATION_SWEEP},
    {"sweep-modes", SIMULATION_SWEEP},
    {"sweep-against", SIMULATION_SWEEP},
    {"checkpoint", SIMULATION_RUN},
    {"damper", SIMULATION_LINEAR | SIMULATION_SWITCHED | SIMULATION_CONTROLLER |
                   SIMULATION_SPIN | SIMULATION_COST},
};

/* "--constraints or --controller" */
static const char *name_uses(unsigned uses, char *text, size_t size)
{
    int length = 0;

    if (uses == SIMULATION_RUN)
        return "a run that -o writes";
    for (int k = 0; k < USES; k++) {
        if (!(uses >> k & 1U))
            continue;
        uses &= ~(1U << k);
        length += snprintf(text + length, size - (size_t)length, "%s%s",
                           length == 0 ? ""
                           : uses      ? ", "
                                       : " or ",
                           use_names[k]);
    }
    return text;
}

bool simulation_misuses(const cli_run *run, unsigned use, size_t size,
                        char *out)
{
    char belongs[256] = "", asked[64] = "";

    for (size_t k = 0; k < sizeof options / sizeof *options; k++) {
        if (options[k].uses & use || !cli_given(run, options[k].option))
            continue;
        (void)snprintf(out, size, "--%s is for %s, not for %s",
                       options[k].option,
                       name_uses(options[k].uses, belongs, sizeof belongs),
                       name_uses(use, asked, sizeof asked));
        return true;
    }
    return false;
}

/* Refuse options that have no effect with the value of another option. */
static void check_values(const cli_run *run, const simulation_options *given,
                         unsigned use)
{
    const bool alpha = strcmp(given->method, "generalised-alpha") == 0;
    const bool modal = strcmp(given->method, "modal") == 0;

    if (cli_given(run, "rho") && !alpha && use != SIMULATION_CONSTRAINTS)
        cli_refuse(run->program,
                   "--rho is for --method generalised-alpha, not for %s",
                   given->method);
    if (cli_given(run, "up-to-hz") && !modal && use != SIMULATION_SWEEP)
        cli_refuse(run->program,
                   "--up-to-hz is for --method modal, not for %s, which takes "
                   "the whole model",
                   given->method);
    if (cli_given(run, "up-to-hz") && given->sweep_modes > 0)
        cli_refuse(run->program, "give --sweep-modes or --up-to-hz, not both");
    if (cli_given(run, "every") && !cli_given(run, "step"))
        cli_refuse(run->program, "--every is for --step, not for --accuracy, "
                                 "which chooses the times");
    if (cli_given(run, "start-digits") && !given->initial)
        cli_refuse(run->program, "--start-digits rounds initial values, and "
                                 "there are none: give --initial");
    if (cli_given(run, "band-hz") && !given->cost && !run->record)
        cli_refuse(run->program, "--band-hz is for --cost and --record");
}

void simulation_check_options(const cli_run *run,
                              const simulation_options *given)
{
    unsigned use = run->output ? SIMULATION_LINEAR : SIMULATION_COST;
    char sentence[512] = "";
    int kinds = 0;

    if (!run->output && !given->cost) /* refused by the caller */
        return;
    for (const simulation_kind *k = simulation_kinds; k->option; k++)
        if (k->asked(given)) {
            if (!run->output && k->use != SIMULATION_CONTROLLER)
                cli_refuse(run->program,
                           "%s is for a run that -o writes, not for --cost",
                           k->option);
            use = run->output ? k->use : SIMULATION_COST | k->use;
            kinds++;
        }
    if (kinds > 1) /* refused by find_kind */
        return;
    if (simulation_misuses(run, use, sizeof sentence, sentence))
        cli_refuse(run->program, "%s", sentence);
    check_values(run, given, use);
}
