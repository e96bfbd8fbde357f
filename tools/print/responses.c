#include "print/measured.h"

#include "base/tolerances.h"

#include <complex.h>

/* Even points, where nothing is said; with a tolerance, to begin with. */
static const int64_t usual_points = 400;
static const int64_t first_points = 20;

/* An engine may take this part of the tolerance between points. */
static const double engine_share = 0.1;

void responses_list(void)
{
    printf("%-12s %s\n", "auto",
           "the one that the model asks for, and says why");
    for (const ritz_response_engine *const *e = ritz_response_engines; *e;
         e++) {
        printf("\n%-12s %s", (*e)->name, (*e)->summary);
        printf((*e)->reference ? " [%s]\n" : "\n", (*e)->reference);
        cli_list_advice((*e)->when, (*e)->cost, (*e)->holds, (*e)->fails);
    }
}

/* End the program if options exclude each other, or there is no such method. */
static void check_options(const cli_program *program,
                          const response_options *given)
{
    enum { MOST = 16 };
    const loop_options *loop = &given->loops;
    const char *names[MOST + 1] = {"auto"};
    int64_t count = 1;

    if (!loop->controller && (loop->connect.count > 0 || loop->feedback ||
                              loop->states || loop->force))
        cli_refuse(program, "--connect, --feedback, --closed-loop and --force "
                            "say how a loop is closed: give its --controller");
    if (given->points_of && given->tolerance > 0.0)
        cli_refuse(program, "--points-of gives the points, --tolerance "
                            "chooses them: one of the two");
    for (int k = 0; ritz_response_engines[k] && count <= MOST; k++)
        names[count++] = ritz_response_engines[k]->name;
    for (int64_t k = 0; k < count; k++)
        if (strcmp(given->method, names[k]) == 0)
            return;
    cli_refuse_name(program, "no method", given->method, count, names);
}

/* Names of the engines that take a kind of model, as "auto, modal". */
static void list_engines(int kind, size_t size, char *out)
{
    snprintf(out, size, "auto");
    for (int k = 0; ritz_response_engines[k]; k++)
        if (ritz_response_engines[k]->takes & kind)
            sink_append(out, size, ", %s", ritz_response_engines[k]->name);
}

/* The engine that is asked for, if it takes such a model. */
static ritz_status choose_engine(cli_run *run, const char *method,
                                 const ritz_response_request *request,
                                 const ritz_response_engine **out)
{
    const char *why = NULL;
    int kind = (int)request->model.kind;
    bool states = kind == (int)RITZ_MODEL_STATES;
    char names[128];

    list_engines(kind, sizeof names, names);
    *out = strcmp(method, "auto") == 0
               ? ritz_response_engine_choose(request, &why)
               : ritz_response_engine_find(method);
    RITZ_REFUSE_IF(
        !((*out)->takes & kind) && kind == (int)RITZ_MODEL_COMPONENT,
        RITZ_ERR_ARGUMENT,
        "'%s' is a component: --method %s is not for it, here are %s",
        run->operand[0], method, names);
    RITZ_REFUSE_IF(!((*out)->takes & kind), RITZ_ERR_ARGUMENT,
                   "'%s' is %s: --method %s is for components, here are %s",
                   run->operand[0], states ? "a state space" : "dense", method,
                   names);
    if (why && kind == (int)RITZ_MODEL_COMPONENT)
        cli_say(run, "method %s: %s", (*out)->name, why);
    return RITZ_OK;
}

/* Report the stated uncertainty of components whose modes are too many to
   find. */
static void say_uncertainty(cli_run *run, const ritz_responder *r)
{
    const double uncertain = ritz_responder_uncertainty(r);

    if (uncertain > 0.0)
        sink_field(run, "ratios above", "ratios_uncertain",
                   "known to %.1e of the largest |H|", uncertain);
    if (uncertain > RITZ_RATIO_UNCERTAIN)
        cli_warn(run,
                 "the effect of damping ratios on the modes above is known "
                 "only to %.1e of the largest |H|: raise --up-to-hz",
                 uncertain);
}

/* Make a model ready for the range of a grid. */
static ritz_status new_responder(cli_run *run, const model *m,
                                 const response_options *given,
                                 const ritz_grid *grid, ritz_responder **out)
{
    const bool modal = strcmp(given->method, "modal") == 0;
    const ritz_response_engine *engine = NULL;
    const char *remark = NULL;
    ritz_response_request request = {
        .up_to_hz = given->up_to_hz,
        .tolerance = engine_share * given->tolerance,
        .from_hz = grid->hertz ? grid->hertz[0] : grid->from_hz,
        .to_hz = grid->hertz ? grid->hertz[grid->count - 1] : grid->to_hz};

    if (measured_is(m))
        return ritz_measured_responder(&m->response, out);
    request.model = model_reference(m);
    RITZ_CHECK(choose_engine(run, given->method, &request, &engine));
    if (strcmp(given->method, "auto") == 0 || modal)
        RITZ_CHECK(ritz_responder_or_direct(engine, &request, out));
    else
        RITZ_CHECK(ritz_responder_new(engine, &request, out));
    remark = ritz_responder_remark(*out);
    if (remark[0] && modal && given->tolerance == 0.0)
        cli_warn(run, "%s; --method krylov leaves nothing out", remark);
    else if (remark[0])
        sink_say(run, "note", "  %s", remark);
    say_uncertainty(run, *out);
    return RITZ_OK;
}

/*
 * From the band of the system where nothing is said. A band that starts at 0
 * starts a thousandth up instead: a free body has no static response.
 */
static ritz_status place_points(const model *m, const response_options *given,
                                ritz_grid *out)
{
    double from = given->from_hz;
    double to = given->to_hz;

    if (to == 0.0 && m->kind == MODEL_SYSTEM && m->system.band_hz[1] > 0.0)
        to = m->system.band_hz[1];
    RITZ_REFUSE_IF(to == 0.0, RITZ_ERR_ARGUMENT,
                   "the model states no band: give --to-hz");
    if (isnan(from) && m->kind == MODEL_SYSTEM && m->system.band_hz[0] > 0.0 &&
        m->system.band_hz[0] < to)
        from = m->system.band_hz[0];
    if (isnan(from))
        from = to / 1000.0;
    RITZ_REFUSE_IF(!(from < to), RITZ_ERR_ARGUMENT,
                   "no band from %g to %g Hz: --from-hz lies above --to-hz",
                   from, to);
    RITZ_REFUSE_IF(given->log && !(from > 0.0), RITZ_ERR_ARGUMENT,
                   "--log needs --from-hz above 0");
    *out = (ritz_grid){.from_hz = from,
                       .to_hz = to,
                       .count = given->points > 0        ? given->points
                                : given->tolerance > 0.0 ? first_points
                                                         : usual_points,
                       .log = given->log,
                       .refine = !given->no_refine};
    return RITZ_OK;
}

/* The points of another response, which can then be subtracted. */
static ritz_status borrow_points(cli_run *run, const response_options *given,
                                 model *other, ritz_grid *out)
{
    const ritz_response *r = &other->response;

    RITZ_CHECK(model_read(run, given->points_of, MODEL_RESPONSE, other));
    RITZ_REFUSE_IF(r->count < 1, RITZ_ERR_ARGUMENT, "'%s' has no points",
                   given->points_of);
    *out = (ritz_grid){.from_hz = r->hertz[0],
                       .to_hz = r->hertz[r->count - 1],
                       .count = r->count,
                       .hertz = r->hertz};
    return RITZ_OK;
}

/* "NAME=X" of --input-size. */
static ritz_status take_size(const ritz_response *r, const char *text,
                             double *size)
{
    const char *equals = strrchr(text, '=');
    double value = 0.0;
    int64_t found = -1;

    RITZ_REFUSE_IF(
        !equals || !ritz_text_real(equals + 1, &value) || !(value > 0.0),
        RITZ_ERR_ARGUMENT,
        "--input-size: '%s' is not of the form NAME=X with X above 0", text);
    for (int64_t j = 0; j < r->num_inputs; j++)
        if (strlen(r->input[j]) == (size_t)(equals - text) &&
            strncmp(r->input[j], text, (size_t)(equals - text)) == 0)
            found = j;
    RITZ_REFUSE_IF(found < 0, RITZ_ERR_ARGUMENT,
                   "--input-size: there is no input '%.*s'",
                   (int)(equals - text), text);
    size[found] = value;
    return RITZ_OK;
}

static ritz_status find_scales(const response_options *given, const model *m,
                               const ritz_response *r, double *size,
                               ritz_scales *out)
{
    const double *limit = measured_ends(m).limit;
    bool any = false;

    for (int64_t j = 0; j < r->num_inputs; j++)
        size[j] = 1.0;
    for (int k = 0; k < given->input_size.count; k++)
        RITZ_CHECK(take_size(r, given->input_size.text[k], size));
    for (int64_t i = 0; given->over_limits && limit && i < r->num_outputs; i++)
        any = any || !isnan(limit[i]);
    RITZ_REFUSE_IF(given->over_limits && !any, RITZ_ERR_ARGUMENT,
                   "--over-limits: no output of the model has a limit");
    *out = (ritz_scales){.output = given->over_limits ? limit : NULL,
                         .input = size};
    return RITZ_OK;
}

/* A value that is told as a measure without a limit. */
static void set_measure(cli_run *run, const char *name, double value,
                        double hertz)
{
    sink_list(run, "measures");
    sink_set(run, "name,value,at_hz,limit,verdict", "%s %g %g %g %s", name,
             value, hertz, (double)NAN, "pass");
    sink_end(run);
}

/* Singular values into the response, and the largest of them. */
static ritz_status find_singular(cli_run *run, const response_options *given,
                                 const model *m, ritz_responder *responder,
                                 ritz_response *response)
{
    ritz_scales scales = {0};
    RITZ_OWN_ARRAY double *size = NULL;
    double hertz = 0.0, value = 0.0;

    RITZ_CHECK_NEW(size, response->num_inputs + 1);
    RITZ_CHECK(find_scales(given, m, response, size, &scales));
    RITZ_CHECK(ritz_singular_of(&scales, response));
    RITZ_CHECK(
        ritz_singular_peak(response, &scales, responder, &hertz, &value));
    response->singular_peak[0] = hertz;
    response->singular_peak[1] = value;
    cli_say(run, "%-41s %14.6e %14.7g", "largest singular value", value, hertz);
    if (isinf(value))
        cli_warn(run, "it is infinite: a pole at %.7g Hz is not damped", hertz);
    set_measure(run, "largest singular value", value, hertz);
    return RITZ_OK;
}

static void say_zeros(cli_run *run, int64_t count, const double _Complex *zero)
{
    SINK_EACH(run, "zeros", k, count) {
        double re = creal(zero[k]), im = cimag(zero[k]);
        double hertz = cabs(zero[k]) / (2.0 * RITZ_PI);

        sink_set(run, "re,im,hz", "%g %g %g", re, im, hertz);
        if (k > 0 && zero[k] == conj(zero[k - 1]) && im != 0.0)
            continue; /* said with the other of the pair */
        cli_say(run, "  %14.7g Hz  %12.5g %s %.7g i rad/s", hertz, re,
                im != 0.0 ? "+-" : "+", fabs(im));
    }
    if (count == 0)
        cli_say(run, "  none is finite");
}

/* One channel; one that has no transfer function says so. */
static ritz_status find_zeros(cli_run *run, const model *m, int64_t output,
                              int64_t input)
{
    const ritz_io io = ritz_model_io(model_reference(m));
    RITZ_OWN_ARRAY double _Complex *zero = NULL;
    int64_t count = 0;
    ritz_status status =
        ritz_zeros_of(model_reference(m), output, input, &count, &zero);

    sink_object(run, NULL);
    sink_say(run, "output,input", "zeros of %s / %s:", io.output[output],
             io.input[input]);
    if (status == RITZ_OK)
        say_zeros(run, count, zero);
    else if (status == RITZ_ERR_SINGULAR)
        cli_say(run, "  %s", ritz_error_message());
    sink_end(run);
    return status == RITZ_ERR_SINGULAR ? RITZ_OK : status;
}

static ritz_status find_all_zeros(cli_run *run, const model *m)
{
    const ritz_io io = ritz_model_io(model_reference(m));

    RITZ_REFUSE_IF(
        m->kind == MODEL_COMPONENT && !model_has_states(m), RITZ_ERR_ARGUMENT,
        "--zeros: of a component with structural damping, or of more "
        "than %d dofs, there are none to be had: reduce it",
        MODEL_MOST_DOFS);
    SINK_EACH(run, "zeros", i, io.num_outputs)
        for (int64_t j = 0; j < io.num_inputs; j++)
            RITZ_CHECK(find_zeros(run, m, i, j));
    return RITZ_OK;
}

/* The highest point of each channel, and where it is. */
static void say_peaks(cli_run *run, const ritz_response *r)
{
    cli_say(run, "%s: %s response, %ld points from %g to %g Hz", run->output,
            r->method, r->count, r->hertz[0], r->hertz[r->count - 1]);
    cli_say(run, "%-20s %-20s %14s %14s", "output", "input", "peak |H|",
            "at Hz");
    for (int64_t i = 0; i < r->num_outputs; i++) {
        for (int64_t j = 0; j < r->num_inputs; j++) {
            char name[2 * RITZ_NAME_SIZE + 16];
            int64_t best = 0;
            double peak = -1.0;

            for (int64_t k = 0; k < r->count; k++) {
                double h =
                    cabs(r->H[(k * r->num_outputs + i) * r->num_inputs + j]);

                best = h > peak ? k : best;
                peak = h > peak ? h : peak;
            }
            cli_say(run, "%-20s %-20s %14.6e %14.7g", r->output[i], r->input[j],
                    peak, r->hertz[best]);
            snprintf(name, sizeof name, "peak %s / %s", r->output[i],
                     r->input[j]);
            set_measure(run, name, peak, r->hertz[best]);
        }
    }
    sink_set(run, "method,damping,points", "%s %s %ld", r->method, r->damping,
             r->count);
    cli_record(run, r->method, r->count);
}

/* --- the loop that is closed around a model ------------------------------- */

/* A model made ready to respond, and the loop. */
typedef struct loop_run {
    ritz_responder *plant;
    model controller;
    ritz_loop loop;
    ritz_responder *inner;  /* of the controller */
    ritz_responder *closed; /* of both; NULL: there is no controller */
} loop_run;

static void loop_run_free(loop_run *loop)
{
    ritz_responder_free(&loop->closed);
    ritz_responder_free(&loop->inner);
    ritz_responder_free(&loop->plant);
    ritz_loop_free(&loop->loop);
    model_free(&loop->controller);
    *loop = (loop_run){0};
}

static ritz_status join_signals(cli_run *run, const loop_options *given,
                                const model *m, loop_run *out)
{
    const ritz_io plant = measured_ends(m),
                  inner = measured_ends(&out->controller);

    return loop_join(run, given, &plant, &inner, &out->loop);
}

/* An unstable loop has no steady response. */
static ritz_status say_stability(cli_run *run, const ritz_state_space *closed,
                                 bool force)
{
    ritz_probe probe = {0};
    char text[2 * RITZ_NAME_SIZE];

    RITZ_CHECK(ritz_probe_states(closed, &probe));
    ritz_probe_print(&probe, text);
    loop_say_stability(run, &probe);
    RITZ_REFUSE_IF(
        probe.verdict == RITZ_UNSTABLE && !force, RITZ_ERR_ARGUMENT,
        "the loop is unstable, %s: it has no steady response; compute "
        "it all the same with --force",
        text);
    if (probe.verdict == RITZ_UNSTABLE)
        cli_warn(
            run,
            "the loop is unstable, %s: what is written is no steady response",
            text);
    return RITZ_OK;
}

/* Poles of a loop with a measured part are not known. */
static ritz_status leave_stability(cli_run *run)
{
    cli_warn(run,
             "whether the loop is stable is not known: a measured response "
             "has no states; its margins alone, in what was measured, say "
             "how near it comes to -1");
    sink_set(run, "stability", "%s", "unknown");
    return RITZ_OK;
}

/* Poles of the closed loop, if its plant has states. */
static ritz_status find_poles(cli_run *run, const loop_options *given,
                              const model *m, const loop_run *loop,
                              int64_t *count, double _Complex **pole)
{
    RITZ_OWN(ritz_state_space) made = {0}, closed = {0};
    const ritz_state_space *plant = NULL;
    bool known = false;

    if (measured_is(m) || measured_is(&loop->controller))
        return leave_stability(run);
    known = model_has_states(m);
    RITZ_REFUSE_IF(!known && given->states, RITZ_ERR_ARGUMENT,
                   "--closed-loop: the plant is too large for states, or has "
                   "structural damping: reduce it");
    if (!known) {
        cli_warn(run, "whether the loop is stable is not known: the plant is "
                      "too large for that, or has structural damping; reduce "
                      "it");
        sink_set(run, "stability", "%s", "unknown");
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_model_states(model_reference(m), &made, &plant));
    RITZ_CHECK(ritz_closed_loop(plant, &loop->controller.states, &loop->loop,
                                &closed));
    RITZ_CHECK(say_stability(run, &closed, given->force));
    RITZ_CHECK(ritz_state_space_poles(&closed, count, pole));
    if (given->states) {
        RITZ_CHECK(ritz_container_write_state_space(given->states, &closed,
                                                    cli_stamp(run)));
        cli_say(run, "%s: the closed loop, %ld states", given->states,
                closed.A.nrow);
    }
    return RITZ_OK;
}

/*
 * Close the loop around a plant that is ready for a range, say whether it is
 * stable, and refuse an unstable one without --force; nothing if there is no
 * controller.
 */
static ritz_status close_loop(cli_run *run, const loop_options *given,
                              const model *m, const double range_hz[2],
                              loop_run *out)
{
    RITZ_OWN_ARRAY double _Complex *pole = NULL;
    int64_t count = 0;
    const ritz_response_request request = {
        .model = ritz_model_of_states(&out->controller.states),
        .from_hz = range_hz[0],
        .to_hz = range_hz[1]};
    ritz_status status = RITZ_OK;

    if (!given->controller)
        return RITZ_OK;
    RITZ_CHECK(join_signals(run, given, m, out));
    RITZ_CHECK(find_poles(run, given, m, out, &count, &pole));
    status =
        measured_is(&out->controller)
            ? ritz_measured_responder(&out->controller.response, &out->inner)
            : ritz_responder_new(ritz_response_engine_find("states"), &request,
                                 &out->inner);
    RITZ_CHECK_IN(given->controller, status);
    return ritz_loop_responder(&out->loop, out->plant, out->inner, count, pole,
                               &out->closed);
}

/* One of the margins, and where it is. */
static void say_margin(cli_run *run, const char *key, const char *text,
                       double value, double hertz)
{
    sink_object(run, key);
    if (isnan(value))
        sink_set(run, "value,at_hz", "%g %g", value, hertz);
    else
        sink_say(run, ",value,at_hz", "  %-39s %14.6g %14.7g", text, value,
                 hertz);
    sink_end(run);
}

/* Margins of a loop at the points of a response. */
static ritz_status say_margins(cli_run *run, const loop_run *loop,
                               const ritz_response *response)
{
    ritz_margins m = {0};

    if (!loop->closed)
        return RITZ_OK;
    RITZ_CHECK(ritz_loop_margins(&loop->loop, loop->plant, loop->inner,
                                 response->count, response->hertz, &m));
    sink_object(run, "loop");
    cli_say(run, "loop, in this range: %38s", "at Hz");
    say_margin(run, "gain", "largest gain of the open loop", m.gain, m.gain_hz);
    say_margin(run, "sensitivity", "largest sensitivity |(I + F G)^-1|",
               m.sensitivity, m.sensitivity_hz);
    say_margin(run, "gain_up", "gain margin, a factor of", m.gain_up,
               m.gain_up_hz);
    say_margin(run, "gain_down", "gain margin downwards, a factor of",
               m.gain_down, m.gain_down_hz);
    say_margin(run, "phase", "phase margin, degrees", m.phase, m.phase_hz);
    sink_end(run);
    return RITZ_OK;
}

/* --- the response --------------------------------------------------------- */

/*
 * A range that is not given begins above the frequency below which rounding of
 * a free body's stiffness dominates: there it is a thousandth of flexible
 * responses, and within the tolerance of the largest response.
 */
static void heed_rounding(cli_run *run, const response_options *given,
                          const ritz_responder *plant, ritz_grid *grid)
{
    const ritz_rounded rounded = ritz_responder_rounded(plant);
    const double rigid = rounded.rigid_hz;
    double begin = grid->hertz ? grid->hertz[0] : grid->from_hz;
    double ends = ritz_rounded_ends(&rounded, RITZ_START_ROUNDING);

    if (given->tolerance > 0.0)
        ends = fmax(ends, rigid / sqrt(given->tolerance));
    if (rounded.motions == 0 || ends <= begin)
        return;
    sink_object(run, "rounding");
    sink_set(run, "rigid_hz,to_hz", "%g %g", rigid, ends);
    sink_end(run);
    if (isnan(given->from_hz) && !grid->hertz && ends < grid->to_hz) {
        grid->from_hz = ends;
        cli_say(
            run,
            "begins at %.4g Hz: below, rigid eigenvalues of rounded K rule, "
            "at %.3g Hz",
            ends, rigid);
    } else {
        cli_warn(run,
                 "up to %.4g Hz the response is one of rigid eigenvalues of "
                 "rounded K, at %.3g Hz, and not of the body",
                 ends, rigid);
    }
}

/* The model, or the loop that is closed around it, at the points. */
static ritz_status find_response(cli_run *run, const model *m,
                                 const response_options *given,
                                 const ritz_grid *points, loop_run *loop,
                                 ritz_response *out)
{
    const double range[2] = {points->from_hz, points->to_hz};
    ritz_responder *whole = NULL;
    ritz_grid own = *points, *grid = &own;

    RITZ_CHECK(new_responder(run, m, given, grid, &loop->plant));
    heed_rounding(run, given, loop->plant, grid);
    RITZ_CHECK(close_loop(run, &given->loops, m, range, loop));
    whole = loop->closed ? loop->closed : loop->plant;
    RITZ_CHECK(given->tolerance > 0.0
                   ? ritz_responder_follow(whole, grid, given->tolerance, out)
                   : ritz_responder_sample(whole, grid, out));
    RITZ_CHECK(say_margins(run, loop, out));
    say_peaks(run, out);
    if (given->singular)
        RITZ_CHECK(find_singular(run, given, m, whole, out));
    return given->zeros ? find_all_zeros(run, m) : RITZ_OK;
}

/* Read the model and its controller, as the options say. */
static ritz_status read_parts(cli_run *run, const response_options *given,
                              model *m, model *controller)
{
    const char *path = run->operand[0];
    const char *other = given->loops.controller;

    RITZ_CHECK(measured_read(run, path, MODEL_DYNAMIC, m));
    if (other)
        RITZ_CHECK(measured_read(run, other, MODEL_STATES, controller));
    RITZ_REFUSE_IF((measured_is(m) || measured_is(controller)) &&
                       given->tolerance > 0.0,
                   RITZ_ERR_ARGUMENT,
                   "--tolerance: '%s' was measured, no points can be added",
                   measured_is(m) ? path : other);
    RITZ_REFUSE_IF(
        (measured_is(m) || measured_is(controller)) && given->loops.states,
        RITZ_ERR_ARGUMENT,
        "%s: --closed-loop: a measured response has no states to write",
        measured_is(m) ? path : other);
    if (measured_is(m))
        return measured_refuse(given, path);
    RITZ_CHECK(model_settle(m, path, &given->model));
    return model_refuse_forces(m, path);
}

static ritz_status find_points(cli_run *run, const response_options *given,
                               const model *m, const model *controller,
                               model *other, ritz_grid *out)
{
    if (given->points_of)
        return borrow_points(run, given, other, out);
    return ritz_context(measured_is(m) || measured_is(controller)
                            ? measured_place(given, m, controller, out)
                            : place_points(m, given, out),
                        measured_is(controller) && !measured_is(m)
                            ? given->loops.controller
                            : run->operand[0]);
}

ritz_status responses_run(cli_run *run, const response_options *given)
{
    const char *path = run->operand[0];
    RITZ_OWN(model) m = {0};
    RITZ_OWN(model) other = {0};
    ritz_grid grid = {0};
    RITZ_OWN(ritz_response) response = {0};
    RITZ_OWN(loop_run) loop = {0};
    ritz_io ends; /* borrowed */

    check_options(run->program, given);
    RITZ_CHECK(read_parts(run, given, &m, &loop.controller));
    RITZ_CHECK(find_points(run, given, &m, &loop.controller, &other, &grid));
    ends = measured_ends(&m);
    RITZ_REFUSE_IF(ends.num_inputs == 0 || ends.num_outputs == 0,
                   RITZ_ERR_ARGUMENT, "'%s' has no %s, it responds to nothing",
                   path, ends.num_inputs == 0 ? "inputs" : "outputs");
    RITZ_CHECK_IN(path, find_response(run, &m, given, &grid, &loop, &response));
    return ritz_container_write_response(run->output, &response,
                                         cli_stamp(run));
}
