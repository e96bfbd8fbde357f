#include "print/print.h"

#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"

#include <inttypes.h>

/* Costs are told at explicit steps so far below their limit. */
static const double margin = 0.95;
/* Steps of the band over which costs are told, where no time is given. */
static const double default_steps = 1000.0;

/* Take words of the command line, and refuse what makes no sense whatever the
   model is. */
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
    if (given->accuracy == 0.0)
        given->accuracy = 1e-3;
}

/* The model that is simulated, with its inputs and initial values. */
typedef struct drive {
    ritz_io io; /* borrowed */
    ritz_model subject;
    ritz_signal *signal; /* of each input */
    double *x0, *v0;     /* NULL: at rest */
} drive;

static ritz_status take_input(cli_run *run, const char *text, drive *d)
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

static ritz_status take_inputs(cli_run *run, const cli_list *texts, drive *d)
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

static ritz_status take_mode(const char *text, drive *d)
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
static ritz_status take_values(const char *path, int64_t n, drive *d)
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
                                drive *d)
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

static void drive_free(drive *d)
{
    RITZ_FREE_EACH(ritz_signal, d->io.num_inputs, d->signal);
    RITZ_FREE(d->x0, d->v0);
}

/* Largest relative difference from the same by the modal integrator. */
static ritz_status measure_difference(ritz_model subject,
                                      ritz_simulation_request request,
                                      double *out)
{
    RITZ_OWN(ritz_simulation) made = {0}, exact = {0};

    RITZ_CHECK(ritz_simulate(subject, &request, &made));
    request.integrator = &ritz_integrator_modal;
    RITZ_CHECK(ritz_simulate(subject, &request, &exact));
    return ritz_simulation_difference(&exact, &made, out);
}

static ritz_status say_integrator(cli_run *run, ritz_model subject,
                                  ritz_simulation_request request)
{
    const ritz_integrator *integrator = request.integrator;
    double spent = 0.0, error = 0.0;

    RITZ_CHECK(
        ritz_simulate_step_cost(subject, integrator, request.step, &spent));
    RITZ_CHECK(measure_difference(subject, request, &error));
    sink_say(run, "name,step,seconds_per_second,error",
             "%-20s %12.4g %14.3g %12.2e", integrator->name, request.step,
             spent / request.step, error);
    return RITZ_OK;
}

/* A simulator that makes and factors its mass matrix at each step. */
static ritz_status say_refactored(cli_run *run, const ritz_cost *cost)
{
    double factor = 0.0, total = 0.0;

    if (cost->order < 1)
        return RITZ_OK;
    RITZ_CHECK(ritz_simulate_refactor_cost(cost->order, &factor));
    total = cost->seconds_per_second + factor / cost->step;
    sink_say(
        run, ",seconds_per_second_refactored_estimate",
        "\na simulator that factors the mass matrix anew at each such step "
        "of %s:\nabout %.3g s a second (an estimate: r^3/3 flops a step at "
        "the rate of one factor)",
        cost->integrator, total);
    return RITZ_OK;
}

static void say_cost_head(const cli_run *run, const ritz_cost *cost)
{
    cli_say(run, "order %ld, highest frequency %.6g Hz", cost->order,
            cost->highest_hz);
    cli_say(run,
            "explicit steps are stable up to %.4g s (damping half a step "
            "old)",
            cost->step_explicit);
    cli_say(run,
            "periods at the band's end come out right to 1e-3 up to "
            "%.4g s (trapezoidal)\n",
            cost->step_accurate);
    cli_say(run, "%-20s %12s %14s %12s", "integrator", "step, s", "s a second",
            "error");
}

/* Where nothing is asked for: all inputs sweep from 0 Hz to the band's end. */
static void sweep_inputs(const ritz_cost *cost, const double band_hz[2],
                         drive *d)
{
    double end = band_hz[1] > 0.0 ? band_hz[1] : fmax(cost->highest_hz, 1.0);

    for (int64_t j = 0; j < d->io.num_inputs; j++)
        d->signal[j] = (ritz_signal){
            .kind = RITZ_SIGNAL_CHIRP, .amplitude = 1.0, .hertz = {0.0, end}};
}

/* The cost of a model, in the line of --record. */
static ritz_status record_cost(cli_run *run, ritz_model subject,
                               const double band_hz[2], ritz_cost *cost)
{
    RITZ_CHECK(ritz_simulate_cost(subject, band_hz, cost));
    sink_open(run, run->line);
    model_set_cost(run, cost);
    sink_end(run);
    return RITZ_OK;
}

/* All integrators at the step that each needs: cost of a second, and error
   against modal. */
static ritz_status say_costs(cli_run *run, const simulation_options *given,
                             const model *m, const double band_hz[2], drive *d)
{
    ritz_cost cost = {0};
    ritz_simulation_request request = RITZ_SIMULATION_NONE;

    RITZ_REFUSE_IF(d->subject.kind != RITZ_MODEL_DENSE, RITZ_ERR_ARGUMENT,
                   "--cost is of reduced components and systems");
    RITZ_CHECK(record_cost(run, d->subject, band_hz, &cost));
    model_set_cost(run, &cost);
    say_cost_head(run, &cost);
    if (given->input.count == 0 && !given->initial)
        sweep_inputs(&cost, band_hz, d);
    request.signal = d->signal;
    request.x0 = d->x0;
    request.v0 = d->v0;
    request.seconds = given->seconds > 0.0 ? given->seconds
                                           : default_steps * cost.step_accurate;
    sink_list(run, "integrators");
    for (const ritz_integrator *const *i = ritz_integrators; *i; i++) {
        request.integrator = *i;
        request.step = cost.step_accurate;
        if ((*i)->is_explicit)
            request.step = fmin(request.step, margin * cost.step_explicit);
        RITZ_CHECK_IN((*i)->name, say_integrator(run, d->subject, request));
    }
    sink_end(run);
    RITZ_CHECK(say_refactored(run, &cost));
    cli_record(run, m->kind == MODEL_REDUCED ? m->reduced.origin.method : "",
               ritz_model_order(model_reference(m)));
    return RITZ_OK;
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

static ritz_status
simulate_response(cli_run *run, const simulation_options *given, const drive *d)
{
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
    ritz_accuracy reached = {.left = -1};

    RITZ_REFUSE_IF(given->input.count == 0 && !given->initial,
                   RITZ_ERR_ARGUMENT,
                   "nothing moves it: give --input NAME=SIGNAL or --initial");
    if (given->step == 0.0) {
        RITZ_CHECK(ritz_simulate_accurate(d->subject, &request, given->accuracy,
                                          &reached, s));
        cli_record_error(run, "integration", reached.error);
        warn_of_rounding(run, given->accuracy, &reached, s);
    } else {
        RITZ_CHECK(ritz_simulate(d->subject, &request, s));
    }
    RITZ_CHECK(warn_of_damping(run, d->subject, &request));
    RITZ_CHECK(describe_output(run, &made));
    if (given->step == 0.0)
        sink_field(run, "accurate to", "error",
                   "%.1e of each output's largest, by half the step",
                   reached.error);
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

ritz_status simulation_run(cli_run *run, simulation_options *given)
{
    const char *path = run->operand[0];
    const double *band_hz = given->band_hz;
    RITZ_OWN(model) m = {0};
    RITZ_OWN(drive) d = {0};
    ritz_cost cost = {0};

    take_options(run, given);
    RITZ_CHECK(model_read(run, path, MODEL_DYNAMIC, &m));
    RITZ_CHECK(model_settle(&m, path, &given->model));
    warn_of_forces(run, &m);
    d.io = ritz_model_io(model_reference(&m));
    d.subject = model_reference(&m);
    if (m.kind == MODEL_SYSTEM && !(band_hz[1] > 0.0))
        band_hz = m.system.band_hz;
    RITZ_CHECK_IN(path, take_inputs(run, &given->input, &d));
    RITZ_CHECK_IN(path,
                  take_initial(run, given->initial,
                               ritz_model_order(model_reference(&m)), &d));
    if (run->output)
        RITZ_CHECK_IN(path, simulate_response(run, given, &d));
    if (given->cost)
        return ritz_context(say_costs(run, given, &m, band_hz, &d), path);
    if (run->record && d.subject.kind == RITZ_MODEL_DENSE)
        return record_cost(run, d.subject, band_hz, &cost);
    return RITZ_OK;
}
