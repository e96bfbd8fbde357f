#include "print/print.h"

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

void responses_check(const cli_program *program, const response_options *given)
{
    enum { MOST = 16 };
    const char *names[MOST + 1] = {"auto"};
    int64_t count = 1;

    if (given->points_of && !isnan(given->tolerance))
        cli_refuse(program, "--points-of gives the points, --tolerance "
                            "chooses them: one of the two");
    for (int k = 0; ritz_response_engines[k] && count <= MOST; k++)
        names[count++] = ritz_response_engines[k]->name;
    for (int64_t k = 0; k < count; k++)
        if (strcmp(given->method, names[k]) == 0)
            return;
    cli_refuse_name(program, "no method", given->method, count, names);
}

/* The engine that is asked for, if it is for such a model. */
static ritz_status choose_engine(cli_run *run, const char *method,
                                 const ritz_response_request *request,
                                 const ritz_response_engine **out)
{
    const char *why = NULL;
    int kind = (int)request->model.kind;

    *out = strcmp(method, "auto") == 0
               ? ritz_response_engine_choose(request, &why)
               : ritz_response_engine_find(method);
    RITZ_REFUSE_IF(!((*out)->takes & kind) && kind == (int)RITZ_MODEL_COMPONENT,
                   RITZ_ERR_ARGUMENT,
                   "'%s' is a component: --method %s is not for it",
                   run->operand[0], method);
    RITZ_REFUSE_IF(!((*out)->takes & kind), RITZ_ERR_ARGUMENT,
                   "'%s' is small and dense: --method %s is for components",
                   run->operand[0], method);
    if (why && kind == (int)RITZ_MODEL_COMPONENT)
        cli_say(run, "method %s: %s", (*out)->name, why);
    return RITZ_OK;
}

/* Make a model ready for the range of a grid. */
static ritz_status new_responder(cli_run *run, const model *m,
                                 const response_options *given,
                                 const ritz_grid *grid, ritz_responder **out)
{
    const ritz_response_engine *engine = NULL;
    const char *why = NULL; /* said before */
    ritz_response_request request = {
        .model = model_reference(m),
        .up_to_hz = isnan(given->up_to_hz) ? 0.0 : given->up_to_hz,
        .tolerance =
            isnan(given->tolerance) ? 0.0 : engine_share * given->tolerance,
        .from_hz = grid->hertz ? grid->hertz[0] : grid->from_hz,
        .to_hz = grid->hertz ? grid->hertz[grid->count - 1] : grid->to_hz};

    RITZ_CHECK(choose_engine(run, given->method, &request, &engine));
    if (m->kind == MODEL_COMPONENT && strcmp(given->method, "modal") == 0 &&
        (m->component.D.colptr || m->component.K4.colptr))
        cli_warn(run,
                 "the damping matrices of '%s' act on the modes that are "
                 "summed alone, --method krylov leaves out nothing",
                 run->operand[0]);
    if (strcmp(given->method, "auto") == 0)
        RITZ_CHECK(ritz_responder_auto(&request, &why, out));
    else
        RITZ_CHECK(ritz_responder_new(engine, &request, out));
    if (ritz_responder_remark(*out)[0])
        sink_say(run, "note", "  %s", ritz_responder_remark(*out));
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

    if (isnan(to) && m->kind == MODEL_SYSTEM && m->system.band_hz[1] > 0.0)
        to = m->system.band_hz[1];
    RITZ_REFUSE_IF(isnan(to), RITZ_ERR_ARGUMENT,
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
                       .count = given->points > 0         ? given->points
                                : isnan(given->tolerance) ? usual_points
                                                          : first_points,
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
    const double *limit = model_io(m).limit;
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
    sink_list(run, "zeros");
    for (int64_t k = 0; k < count; k++) {
        double re = creal(zero[k]), im = cimag(zero[k]);
        double hertz = cabs(zero[k]) / (2.0 * RITZ_PI);

        sink_set(run, "re,im,hz", "%g %g %g", re, im, hertz);
        if (k > 0 && zero[k] == conj(zero[k - 1]) && im != 0.0)
            continue; /* said with the other of the pair */
        cli_say(run, "  %14.7g Hz  %12.5g %s %.7g i rad/s", hertz, re,
                im != 0.0 ? "+-" : "+", fabs(im));
    }
    sink_end(run);
    if (count == 0)
        cli_say(run, "  none is finite");
}

/* One channel; one that has no transfer function says so. */
static ritz_status find_zeros(cli_run *run, const model *m, int64_t output,
                              int64_t input)
{
    const ritz_io io = model_io(m);
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
    const ritz_io io = model_io(m);

    RITZ_REFUSE_IF(
        m->kind == MODEL_COMPONENT && !model_has_states(m), RITZ_ERR_ARGUMENT,
        "--zeros: of a component with structural damping, or of more "
        "than %d dofs, there are none to be had: reduce it",
        MODEL_MOST_DOFS);
    sink_list(run, "zeros");
    for (int64_t i = 0; i < io.num_outputs; i++)
        for (int64_t j = 0; j < io.num_inputs; j++)
            RITZ_CHECK(find_zeros(run, m, i, j));
    sink_end(run);
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

/* The model, or the loop that is closed around it, at the points. */
static ritz_status find_response(cli_run *run, const model *m,
                                 const response_options *given,
                                 const ritz_grid *grid, loop_run *loop,
                                 ritz_response *out)
{
    const double range[2] = {grid->from_hz, grid->to_hz};
    ritz_responder *whole = NULL;

    RITZ_CHECK(new_responder(run, m, given, grid, &loop->plant));
    RITZ_CHECK(loops_close(run, &given->loops, m, range, loop));
    whole = loop->closed ? loop->closed : loop->plant;
    RITZ_CHECK(isnan(given->tolerance)
                   ? ritz_responder_sample(whole, grid, out)
                   : ritz_responder_follow(whole, grid, given->tolerance, out));
    RITZ_CHECK(loops_report(run, loop, out));
    say_peaks(run, out);
    if (given->singular)
        RITZ_CHECK(find_singular(run, given, m, whole, out));
    return given->zeros ? find_all_zeros(run, m) : RITZ_OK;
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

    RITZ_CHECK(model_read(run, path, MODEL_DYNAMIC, &m));
    RITZ_CHECK(loops_read(run, &given->loops, &loop));
    RITZ_CHECK(model_settle(&m, path, &given->model));
    if (given->points_of)
        RITZ_CHECK(borrow_points(run, given, &other, &grid));
    else
        RITZ_CHECK_IN(path, place_points(&m, given, &grid));
    ends = model_io(&m);
    RITZ_REFUSE_IF(ends.num_inputs == 0 || ends.num_outputs == 0,
                   RITZ_ERR_ARGUMENT, "'%s' has no %s, it responds to nothing",
                   path, ends.num_inputs == 0 ? "inputs" : "outputs");
    RITZ_CHECK_IN(path, find_response(run, &m, given, &grid, &loop, &response));
    return ritz_container_write_response(run->output, &response,
                                         cli_stamp(run));
}
