#include "print/simulation.h"

#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"

#include <inttypes.h>

/* Read words of the command line, and refuse those that no model can have. */
static void take_options(const cli_run *run, simulation_options *given)
{
    const cli_program *program = run->program;

    given->integrator =
        cli_choose(program, "integrator", given->method, ritz_integrators);
    given->hold_zero = strcmp(given->hold, "zero") == 0;
    if (!run->output && !given->cost)
        cli_refuse(program, "nothing to do: give -o, or --cost");
    if (run->output && given->seconds == 0.0)
        cli_refuse(program, "how long? give --seconds");
    if (given->step > 0.0 && given->accuracy > 0.0)
        cli_refuse(program, "--step or --accuracy, one of them");
    if (given->checkpoint && !(given->step > 0.0))
        cli_refuse(program, "--checkpoint needs --step");
    if (given->checkpoint && !run->output)
        cli_refuse(program, "--checkpoint needs -o");
    simulation_check_switched(program, given);
    if (given->accuracy == 0.0)
        given->accuracy = 1e-3;
}

static ritz_status take_input(cli_run *run, const char *text,
                              simulation_task *d)
{
    const char *equals = strchr(text, '=');
    size_t length = equals ? (size_t)(equals - text) : 0;
    const ritz_names names = {"input", d->io.num_inputs, *d->io.input,
                              RITZ_NAME_SIZE};
    char word[RITZ_NAME_SIZE] = "";
    int64_t j = 0;

    RITZ_REFUSE_IF(!equals || length == 0 || length >= sizeof word,
                   RITZ_ERR_ARGUMENT, "'%s' is not NAME=SIGNAL", text);
    memcpy(word, text, length);
    RITZ_CHECK(ritz_words_find(&names, word, &j));
    RITZ_REFUSE_IF(d->signal[j].kind != RITZ_SIGNAL_ZERO, RITZ_ERR_ARGUMENT,
                   "input '%s' is given twice", word);
    RITZ_CHECK(ritz_signal_parse(equals + 1, &d->signal[j]));
    if (ritz_signal_is_file(equals + 1))
        RITZ_CHECK(cli_input(run, equals + 1));
    return RITZ_OK;
}

static ritz_status take_inputs(cli_run *run, const cli_list *texts,
                               simulation_task *d)
{
    RITZ_CHECK_NEW(d->signal, d->io.num_inputs + 1);
    for (int k = 0; k < texts->count; k++)
        RITZ_CHECK_IN("--input", take_input(run, texts->text[k], d));
    return RITZ_OK;
}

/* "K" or "K*A" */
static ritz_status parse_mode(const char *text, int64_t *mode, double *amount)
{
    char word[RITZ_NAME_SIZE];
    char *star = NULL;

    *amount = 1.0;
    RITZ_REFUSE_IF(strlen(text) >= sizeof word, RITZ_ERR_ARGUMENT,
                   "'%s' is no mode", text);
    (void)snprintf(word, sizeof word, "%s", text);
    star = strchr(word, '*');
    if (star)
        *star = '\0';
    RITZ_REFUSE_IF(!ritz_text_whole(word, mode) || *mode < 1 ||
                       (star && !ritz_text_real(star + 1, amount)),
                   RITZ_ERR_ARGUMENT,
                   "'mode:%s' is not a mode and an amplitude, as mode:7*0.1",
                   text);
    return RITZ_OK;
}

static ritz_status take_mode(const char *text, simulation_task *d)
{
    const ritz_model *s = &d->subject;
    RITZ_OWN(ritz_pairs) pairs = {0};
    int64_t mode = 0;
    double amount = 1.0;

    RITZ_REFUSE_IF(s->kind == RITZ_MODEL_STATES, RITZ_ERR_ARGUMENT,
                   "a state space has no modes: give a file");
    RITZ_CHECK(parse_mode(text, &mode, &amount));
    if (s->kind == RITZ_MODEL_COMPONENT) {
        const ritz_span span = {.modes = mode};

        RITZ_CHECK(ritz_eigen_sparse(&s->component->K, &s->component->M, &span,
                                     &pairs));
    } else {
        RITZ_CHECK(ritz_eigen_dense(s->dense.K, s->dense.M, &pairs));
    }
    RITZ_REFUSE_IF(mode > pairs.Phi.ncol, RITZ_ERR_ARGUMENT,
                   "there are %" PRId64 " modes, not %" PRId64, pairs.Phi.ncol,
                   mode);
    for (int64_t k = 0; k < pairs.Phi.nrow; k++)
        d->x0[k] = amount * ritz_dense_col(&pairs.Phi, mode - 1)[k];
    return RITZ_OK;
}

/* A value, and its rate if there is one, a row. */
static ritz_status take_values(const char *path, int64_t n, simulation_task *d)
{
    static const char blank[] = " \t\r,;\n";
    RITZ_OWN_ARRAY char *text = NULL;
    int64_t row = 0;

    RITZ_CHECK(ritz_text_read(path, &text));
    for (char *line = text; line;) {
        char *end = strchr(line, '\n');
        char *place = NULL;
        char *word = NULL;

        if (end)
            *end = '\0';
        word = strtok_r(line, blank, &place);
        line = end ? end + 1 : NULL;
        if (!word || word[0] == '#')
            continue;
        RITZ_REFUSE_IF(row == n || !ritz_text_real(word, &d->x0[row]),
                       RITZ_ERR_FORMAT, "row %ld is not a value of %ld in all",
                       row + 1, n);
        word = strtok_r(NULL, blank, &place);
        RITZ_REFUSE_IF(word && !ritz_text_real(word, &d->v0[row]),
                       RITZ_ERR_FORMAT, "row %ld: '%s' is no rate", row + 1,
                       word);
        row++;
    }
    RITZ_REFUSE_IF(row != n, RITZ_ERR_FORMAT, "%ld rows for %ld coordinates",
                   row, n);
    return RITZ_OK;
}

static ritz_status take_initial(cli_run *run, const char *text, int64_t n,
                                simulation_task *d)
{
    static const char mode[] = "mode:";

    if (!text)
        return RITZ_OK;
    RITZ_CHECK_NEW(d->x0, n + 1);
    RITZ_CHECK_NEW(d->v0, n + 1);
    if (strncmp(text, mode, sizeof mode - 1) == 0)
        return take_mode(text + sizeof mode - 1, d);
    RITZ_CHECK(cli_input(run, text));
    return ritz_context(take_values(text, n, d), text);
}

static void simulation_task_free(simulation_task *d)
{
    RITZ_FREE_EACH(ritz_signal, d->io.num_inputs, d->signal);
    RITZ_FREE(d->x0, d->v0, d->setting);
    RITZ_FREE_EACH(ritz_dense, d->num_libraries, d->library);
    model_free(&d->m);
    model_free(&d->controller);
    ritz_loop_free(&d->loop);
    ritz_stage_free(&d->stage);
    ritz_scene_free(&d->scene);
}

static void warn_of_rounding(cli_run *run, double accuracy,
                             const ritz_accuracy *reached,
                             const ritz_simulation *s)
{
    char more[32] = "";

    if (reached->num_left == 0)
        return;
    if (reached->num_left > 1)
        (void)snprintf(more, sizeof more, ", and %ld more",
                       reached->num_left - 1);
    cli_warn(run,
             "output '%s' is rounding or next to it: accurate to %.1e of what "
             "the motion could show by it, not to %g of its own largest%s",
             s->output[reached->left], reached->rounding, accuracy, more);
}

/*
 * A component is simulated in its modes alone. The effect of D on the modes
 * above is measured on frequency responses, up to a third of the last mode's
 * frequency.
 */
static ritz_status warn_of_damping(cli_run *run, ritz_model subject,
                                   const ritz_simulation_request *request)
{
    const ritz_response_request asked = {.model = subject,
                                         .to_hz = request->up_to_hz / 3.0,
                                         .up_to_hz = request->up_to_hz};
    RITZ_OWN(ritz_responder) *r = NULL;

    if (subject.kind != RITZ_MODEL_COMPONENT ||
        request->integrator != &ritz_integrator_modal)
        return RITZ_OK;
    RITZ_CHECK(ritz_responder_new(&ritz_response_engine_modal, &asked, &r));
    if (ritz_responder_remark(r)[0])
        cli_warn(run, "%s, up to %g Hz", ritz_responder_remark(r), asked.to_hz);
    return RITZ_OK;
}

/* A run of one linear model, with the given step or that of --accuracy. */
static ritz_status simulate_model(simulation_task *d,
                                  const ritz_simulation_request *request,
                                  ritz_simulation *out)
{
    const simulation_options *given = d->given;

    if (given->step == 0.0) {
        RITZ_CHECK(ritz_simulate_accurate(d->subject, request, given->accuracy,
                                          &d->reached, out));
        cli_record_error(d->run, "integration", d->reached.error);
        warn_of_rounding(d->run, given->accuracy, &d->reached, out);
    } else {
        RITZ_CHECK(ritz_simulate(d->subject, request, out));
    }
    return warn_of_damping(d->run, d->subject, request);
}

/* A scene whose rate of spin changes has a run of its own. */
static ritz_status check_spin(const cli_run *run,
                              const simulation_options *given,
                              const simulation_kind *kind)
{
    char sentence[512] = "";

    RITZ_REFUSE_IF(kind, RITZ_ERR_ARGUMENT,
                   "the rate of spin of this scene changes, which %s does not "
                   "take",
                   kind->option);
    RITZ_REFUSE_IF(given->step == 0.0, RITZ_ERR_ARGUMENT,
                   "a rate of spin that changes needs --step: no step is "
                   "chosen by an accuracy");
    RITZ_REFUSE_IF(
        simulation_misuses(run, SIMULATION_SPIN, sizeof sentence, sentence),
        RITZ_ERR_ARGUMENT, "%s", sentence);
    return RITZ_OK;
}

static ritz_status simulate_response(simulation_task *d)
{
    cli_run *run = d->run;
    const simulation_options *given = d->given;
    ritz_simulation_request request = {
        .integrator = given->integrator,
        .seconds = given->seconds,
        .step = given->step,
        .hold = given->hold_zero ? RITZ_HOLD_ZERO : RITZ_HOLD_FIRST,
        .rho = given->rho,
        .up_to_hz = given->up_to_hz,
        .every = given->every,
        .signal = d->signal,
        .x0 = d->x0,
        .v0 = d->v0,
        .coordinates = given->coordinates,
    };
    RITZ_OWN(model) made = {.kind = MODEL_SIMULATION};
    ritz_simulation *s = &made.simulation;
    const simulation_kind *kind = NULL;

    RITZ_REFUSE_IF(given->input.count == 0 && !given->initial &&
                       !simulation_spins(d),
                   RITZ_ERR_ARGUMENT,
                   "nothing moves it: give --input NAME=SIGNAL or --initial");
    RITZ_CHECK(simulation_find_kind(given, &kind));
    RITZ_REFUSE_IF(cli_given(run, "up-to-hz") && !given->sweep &&
                       d->subject.kind != RITZ_MODEL_COMPONENT,
                   RITZ_ERR_ARGUMENT,
                   "--up-to-hz is for components, whose modes are computed; "
                   "all coordinates of this model are used");
    RITZ_REFUSE_IF(kind && given->step == 0.0, RITZ_ERR_ARGUMENT,
                   "%s needs --step: no step is chosen by an accuracy",
                   kind->option);
    if (kind && kind->prepare)
        RITZ_CHECK_IN(kind->option, kind->prepare(d));
    if (simulation_spins(d))
        RITZ_CHECK(check_spin(run, given, kind));
    RITZ_CHECK(simulation_long_run(d, &request,
                                   kind                  ? kind->simulate
                                   : simulation_spins(d) ? simulation_spin
                                                         : simulate_model,
                                   s));
    RITZ_CHECK(simulation_name_checkpoint(d, describe_output(run, &made)));
    if (given->step == 0.0)
        sink_field(run, "accurate to", "error",
                   "%.1e of each output's largest, by half the step",
                   d->reached.error);
    cli_record(run, s->integrator, s->order);
    return RITZ_OK;
}

/* Warn of spurious motions that grow as e^(2 pi f t). */
static void warn_of_forces(cli_run *run, const model *m)
{
    double first_hz = 0.0;
    int64_t count = model_negative_squares(m->at, &first_hz);

    if (count > 0)
        cli_warn(run,
                 "%ld negative squares of the forces that join bodies of "
                 "dual-craig-bampton grow without bound, from %.3g/s on: no "
                 "motion of the bodies; macneal-rubin has the same columns",
                 count, 2.0 * RITZ_PI * first_hz);
}

/* The bodies of a scene, and its system at the settings of --at. */
static ritz_status read_scene(simulation_task *d)
{
    const char *at = d->given->model.at ? d->given->model.at : "";
    const char *path = d->run->operand[0];

    RITZ_CHECK(model_scene(d->run, path, &d->scene));
    RITZ_CHECK(simulation_sweep_check(d));
    RITZ_CHECK_NEW(d->setting, d->scene.num_sweeps);
    RITZ_CHECK_IN("--at", ritz_scene_settings(&d->scene, at, d->setting));
    RITZ_CHECK(ritz_stage_new(&d->scene, &d->stage));
    RITZ_CHECK(ritz_assemble(&d->stage, at, &d->m.system));
    d->m.kind = MODEL_SYSTEM;
    settings_say(d->run, &d->scene, d->m.system.units, d->setting);
    RITZ_CHECK(axes_say(d->run, &d->stage, 1, d->setting));
    return spin_say(d->run, &d->stage, &d->m.system.configuration[0]);
}

static ritz_status read_subject(simulation_task *d)
{
    const char *path = d->run->operand[0];

    if (ritz_container_seems(path))
        RITZ_CHECK(model_read(d->run, path, MODEL_DYNAMIC, &d->m));
    else
        RITZ_CHECK(read_scene(d));
    RITZ_CHECK(model_settle(&d->m, path, &d->given->model));
    warn_of_forces(d->run, &d->m);
    d->subject = model_reference(&d->m);
    d->io = ritz_model_io(d->subject);
    return RITZ_OK;
}

ritz_status simulation_run(cli_run *run, simulation_options *given)
{
    const char *path = run->operand[0];
    const double *band_hz = given->band_hz;
    RITZ_OWN(simulation_task)
    d = {.run = run, .given = given, .reached = {.left = -1}};
    ritz_cost cost = {0};

    simulation_check_options(run, given);
    RITZ_CHECK_IN("--sweep", simulation_sweep_prepare(run, given));
    take_options(run, given);
    RITZ_CHECK(read_subject(&d));
    if (d.m.kind == MODEL_SYSTEM && !(band_hz[1] > 0.0))
        band_hz = d.m.system.band_hz;
    RITZ_CHECK_IN(path, take_inputs(run, &given->input, &d));
    RITZ_CHECK_IN(path, take_initial(run, given->initial,
                                     ritz_model_order(d.subject), &d));
    if (run->output)
        RITZ_CHECK_IN(path, simulate_response(&d));
    if (given->cost)
        return ritz_context(simulation_say_costs(&d, band_hz), path);
    if (run->record && d.subject.kind == RITZ_MODEL_DENSE)
        return simulation_record_cost(run, d.subject, band_hz, &cost);
    return RITZ_OK;
}
