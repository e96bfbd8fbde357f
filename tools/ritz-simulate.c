/* ritz-simulate - time responses, and what a simulated second costs. */
#include "print/dampers.h"
#include "print/describe.h"
#include "print/nested.h"
#include "print/simulation.h"

#include <math.h>
#include <string.h>

typedef struct wish {
    const char *method, *hold, *initial, *at, *damping, *band;
    double seconds, step, accuracy, rho, up_to_hz;
    int64_t every, order;
    cli_list input, damper;
    bool cost;
    const ritz_integrator *integrator;
    double band_hz[2]; /* of --band-hz; 0, 0: not given */
} wish;

static void list_integrators(void)
{
    for (const ritz_integrator *const *i = ritz_integrators; *i; i++)
        printf("%s\n    %s\n    accuracy:    %s\n    stable:      %s\n"
               "    dissipation: %s\n    fails:       %s\n    [%s]\n",
               (*i)->name, (*i)->summary, (*i)->accuracy, (*i)->stability,
               (*i)->dissipation, (*i)->fails, (*i)->reference);
}

static const ritz_integrator *find(const cli_program *program, const char *word)
{
    const char *names[16];
    int64_t count = 0;

    for (; ritz_integrators[count] && count < 16; count++) {
        names[count] = ritz_integrators[count]->name;
        if (strcmp(names[count], word) == 0)
            return ritz_integrators[count];
    }
    cli_refuse_name(program, "no integrator", word, count, names);
}

/* Where it is not asked for: of a system what the scene says. */
static void find_band(const model *m, const wish *asked, double out[2])
{
    out[0] = asked->band_hz[0];
    out[1] = asked->band_hz[1];
    if (!asked->band && m->kind == MODEL_SYSTEM) {
        out[0] = m->system.band_hz[0];
        out[1] = m->system.band_hz[1];
    }
}

static ritz_simulation_request request_of(const wish *asked,
                                          const simulation_drive *drive)
{
    return (ritz_simulation_request){
        .integrator = asked->integrator,
        .seconds = asked->seconds,
        .step = isnan(asked->step) ? 0.0 : asked->step,
        .hold =
            strcmp(asked->hold, "zero") == 0 ? RITZ_HOLD_ZERO : RITZ_HOLD_FIRST,
        .rho = asked->rho,
        .up_to_hz = isnan(asked->up_to_hz) ? 0.0 : asked->up_to_hz,
        .every = asked->every,
        .signal = drive->signal,
        .x0 = drive->x0,
        .v0 = drive->v0,
    };
}

static void warn_of_rounding(cli_run *run, double accuracy,
                             const ritz_accuracy *reached,
                             const ritz_simulation *s)
{
    char more[32] = "";

    if (reached->num_left == 0)
        return;
    if (reached->num_left > 1)
        (void)snprintf(more, sizeof more, ", and %lld more",
                       (long long)reached->num_left - 1);
    cli_warn(run,
             "output '%s' is rounding or next to it: accurate to %.1e of what "
             "the motion could show by it, not to %g of its own largest%s",
             s->output[reached->left], reached->rounding, accuracy, more);
}

static ritz_status run_it(cli_run *run, const wish *asked,
                          const ritz_simulated *subject,
                          const simulation_drive *drive)
{
    ritz_status status = RITZ_OK;
    ritz_simulation_request request = request_of(asked, drive);
    ritz_simulation s = {0};
    ritz_stamp stamp = {0};
    ritz_accuracy reached = {.left = -1};

    RITZ_FAIL_IF(asked->input.count == 0 && !asked->initial, RITZ_ERR_ARGUMENT,
                 "nothing moves it: give --input NAME=SIGNAL or --initial");
    if (isnan(asked->step)) {
        RITZ_TRY(ritz_simulate_accurate(subject, &request, asked->accuracy,
                                        &reached, &s));
        cli_record_error(run, "integration", reached.error);
        json_object_set_new(run->report, "error", cli_real(reached.error));
        warn_of_rounding(run, asked->accuracy, &reached, &s);
    } else {
        RITZ_TRY(ritz_simulate(subject, &request, &s));
    }
    stamp = cli_stamp(run);
    RITZ_TRY(ritz_container_write_simulation(run->output, &s, &stamp));
    cli_say(run, "%s:", run->output);
    describe_simulation(run, &s);
    if (isnan(asked->step))
        cli_say(run, "  %-14s %.1e of each output's largest, by half the step",
                "accurate to", reached.error);
    cli_record(run, s.integrator, s.order);
done:
    ritz_simulation_free(&s);
    return status;
}

static ritz_status cost_it(cli_run *run, const wish *asked, const model *m,
                           const ritz_simulated *subject,
                           simulation_drive *drive)
{
    double band_hz[2];

    RITZ_REFUSE_IF(!subject->model, RITZ_ERR_ARGUMENT,
                   "--cost is of reduced components and systems");
    find_band(m, asked, band_hz);
    RITZ_CHECK(simulation_costs(
        run, subject, drive, asked->input.count > 0 || asked->initial, band_hz,
        isnan(asked->seconds) ? 0.0 : asked->seconds));
    cli_record(run, m->kind == MODEL_REDUCED ? m->reduced.origin.method : "",
               subject->model->K->nrow);
    return RITZ_OK;
}

static ritz_status simulate(cli_run *run, const wish *asked)
{
    ritz_status status = RITZ_OK;
    const char *path = run->operand[0];
    model m = {0};
    ritz_second_order view = {0};
    ritz_damping damping = {0};
    ritz_simulated subject = {0};
    simulation_drive drive = {0};
    double band_hz[2];

    RITZ_TRY(model_read(
        run, path,
        MODEL_COMPONENT | MODEL_REDUCED | MODEL_SYSTEM | MODEL_STATES, &m));
    RITZ_TRY(nested_take(path, asked->order, &m));
    RITZ_TRY(model_at(&m, path, asked->at));
    RITZ_TRY_IN(path, dampers_install(&m, &asked->damper));
    RITZ_FAIL_IF(m.kind == MODEL_STATES && asked->damping, RITZ_ERR_ARGUMENT,
                 "a state space is damped as it was made: --damping is for "
                 "ritz-basis");
    if (m.kind != MODEL_STATES)
        RITZ_TRY(model_damping(&m, asked->damping, &damping));
    view = model_look(&m).matrices;
    subject = simulation_subject(&m, &view, &damping);
    find_band(&m, asked, band_hz);
    RITZ_TRY_IN(path, simulation_inputs(run, &subject, &asked->input, &drive));
    RITZ_TRY_IN(path,
                simulation_initial(run, &subject, asked->initial, &drive));
    if (run->output)
        RITZ_TRY_IN(path, run_it(run, asked, &subject, &drive));
    if (asked->cost)
        RITZ_TRY_IN(path, cost_it(run, asked, &m, &subject, &drive));
    else
        RITZ_TRY(simulation_record_cost(run, &subject, band_hz));
done:
    simulation_free(&drive);
    model_free(&m);
    return status;
}

/* What no model is needed for to see that it makes no sense. */
static void check(const cli_program *program, const cli_run *run, wish *asked)
{
    asked->integrator = find(program, asked->method);
    if (strcmp(asked->hold, "first") != 0 && strcmp(asked->hold, "zero") != 0)
        cli_refuse(program, "--hold is first or zero, not '%s'", asked->hold);
    if (asked->band)
        cli_pair(program, "--band-hz", asked->band, asked->band_hz);
    if (!run->output && !asked->cost)
        cli_refuse(program, "nothing to do: give -o, or --cost");
    if (run->output && isnan(asked->seconds))
        cli_refuse(program, "how long? give --seconds");
    if (!isnan(asked->step) && !isnan(asked->accuracy))
        cli_refuse(program, "--step or --accuracy, one of them");
    if (isnan(asked->accuracy))
        asked->accuracy = 1e-3;
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
    wish asked = {.method = "modal",
                  .hold = "first",
                  .seconds = (double)NAN,
                  .step = (double)NAN,
                  .accuracy = (double)NAN,
                  .up_to_hz = (double)NAN,
                  .rho = 0.8,
                  .every = 1};
    const cli_option options[] = {
        {CLI_TEXT(&asked.method), .name = "method", .argument = "NAME",
         .help = "the integrator, one of --list"},
        {CLI_REAL(&asked.seconds), .name = "seconds", .argument = "T",
         .min = 1e-12, .max = 1e12, .help = "how long"},
        {CLI_REAL(&asked.step), .name = "step", .argument = "H", .min = 1e-15,
         .max = 1e12, .help = "of time, seconds [as --accuracy says]"},
        {CLI_REAL(&asked.accuracy), .name = "accuracy", .argument = "X",
         .min = 1e-12, .max = 1.0,
         .help = "halve the step until outputs are within X of their largest "
                 "[1e-3]"},
        {CLI_LIST(&asked.input), .name = "input", .argument = "NAME=SIGNAL",
         .help = "step, impulse, sine:F or chirp:F,F (*A behind), or a file of "
                 "times and values"},
        {CLI_TEXT(&asked.initial), .name = "initial", .argument = "TEXT",
         .help = "mode:K or mode:K*A, or a file, a value and its rate a row"},
        {CLI_TEXT(&asked.hold), .name = "hold", .argument = "first|zero",
         .help = "inputs in a step: linear, or as at its start"},
        {CLI_REAL(&asked.rho), .name = "rho", .argument = "R", .min = 0.0,
         .max = 1.0,
         .help = "generalised-alpha: what a step leaves of high frequency"},
        {CLI_INT(&asked.every), .name = "every", .argument = "N", .min = 1,
         .max = 1e9, .help = "write each N-th step, with --step"},
        {CLI_REAL(&asked.up_to_hz), .name = "up-to-hz", .argument = "F",
         .min = 1e-9, .max = 1e9, .help = "modes of a component, for modal"},
        {CLI_FLAG(&asked.cost), .name = "cost",
         .help = "what a simulated second costs, by each integrator"},
        {CLI_TEXT(&asked.band), .name = "band-hz", .argument = "F,F",
         .help = "whose end --cost resolves [of a system its own, or all]"},
        DAMPING_OPTION(&asked.damping),
        DAMPERS_OPTION(&asked.damper),
        {CLI_TEXT(&asked.at), .name = "at",
         .argument = "JOINT=SETTING[,JOINT=SETTING]",
         .help = "which configuration of a system, degrees and lengths"},
        ORDER_OPTION(&asked.order),
        {CLI_ACTION(list_integrators), .name = "list",
         .help = "list the integrators, with what they hold and where they "
                 "fail"},
        {0},
    };
    cli_program program = about;
    cli_run run;

    program.options = options;
    cli_parse(&program, argc, argv, &run);
    check(&program, &run, &asked);
    return cli_finish(&run, simulate(&run, &asked));
}
