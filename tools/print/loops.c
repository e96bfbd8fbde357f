#include "print/print.h"

void loops_check(const cli_program *program, const loop_options *given)
{
    if (!given->controller && (given->connect.count > 0 || given->feedback ||
                               given->states || given->force))
        cli_refuse(program, "--connect, --feedback, --closed-loop and --force "
                            "say how a loop is closed: give its --controller");
}

ritz_status loops_read(cli_run *run, const loop_options *given, loop_run *out)
{
    return given->controller ? model_read(run, given->controller, MODEL_STATES,
                                          &out->controller)
                             : RITZ_OK;
}

static ritz_status join_signals(cli_run *run, const loop_options *given,
                                const model *m, loop_run *out)
{
    const ritz_io plant = model_io(m), inner = model_io(&out->controller);

    RITZ_CHECK_IN(given->controller,
                  ritz_loop_match(&plant, &inner, given->connect.count,
                                  given->connect.text, &out->loop));
    out->loop.positive =
        given->feedback && strcmp(given->feedback, "positive") == 0;
    cli_say(run, "loop with '%s', %s feedback:", given->controller,
            out->loop.positive ? "positive" : "negative");
    for (int64_t k = 0; k < out->loop.num_measured; k++)
        cli_say(run, "  %s -> controller %s",
                plant.output[out->loop.measured[k]], inner.input[k]);
    for (int64_t k = 0; k < out->loop.num_driven; k++)
        cli_say(run, "  controller %s -> %s", inner.output[k],
                plant.input[out->loop.driven[k]]);
    return RITZ_OK;
}

/* An unstable loop has no steady response. */
static ritz_status say_stability(cli_run *run, const ritz_state_space *closed,
                                 bool force)
{
    ritz_probe probe = {0};
    char text[2 * RITZ_NAME_SIZE];
    const char *verdict = NULL;

    RITZ_CHECK(ritz_probe_states(closed, &probe));
    ritz_probe_print(&probe, text);
    verdict = ritz_stability_name(probe.verdict);
    sink_say(run, "stability", "the loop is %s: %s", verdict, text);
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

/* Poles of the closed loop, if its plant has states. */
static ritz_status find_poles(cli_run *run, const loop_options *given,
                              const model *m, const loop_run *loop,
                              int64_t *count, double _Complex **pole)
{
    RITZ_OWN(ritz_state_space) made = {0}, closed = {0};
    const ritz_state_space *plant = NULL;
    bool known = model_has_states(m);

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

ritz_status loops_close(cli_run *run, const loop_options *given, const model *m,
                        const double range_hz[2], loop_run *out)
{
    RITZ_OWN_ARRAY double _Complex *pole = NULL;
    int64_t count = 0;
    const ritz_response_request request = {
        .model = ritz_model_of_states(&out->controller.states),
        .from_hz = range_hz[0],
        .to_hz = range_hz[1]};

    if (!given->controller)
        return RITZ_OK;
    RITZ_CHECK(join_signals(run, given, m, out));
    RITZ_CHECK(find_poles(run, given, m, out, &count, &pole));
    RITZ_CHECK_IN(given->controller,
                  ritz_responder_new(ritz_response_engine_find("states"),
                                     &request, &out->inner));
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

ritz_status loops_report(cli_run *run, const loop_run *loop,
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

void loop_run_free(loop_run *loop)
{
    ritz_responder_free(&loop->closed);
    ritz_responder_free(&loop->inner);
    ritz_responder_free(&loop->plant);
    ritz_loop_free(&loop->loop);
    model_free(&loop->controller);
    *loop = (loop_run){0};
}
