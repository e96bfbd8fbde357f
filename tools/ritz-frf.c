/* ritz-frf - frequency response from inputs to outputs. */
#include "print/dampers.h"
#include "print/engines.h"
#include "print/loops.h"
#include "print/nested.h"
#include "print/responses.h"

#include <complex.h>
#include <math.h>

/* Even ones, where nothing is said; with a tolerance, to begin with. */
static const int64_t usual_points = 400;
static const int64_t first_points = 20;

/* What the command line asks for; NaN or NULL where it says nothing. */
typedef struct wish {
    double from_hz, to_hz;
    int64_t points;
    int64_t order; /* columns of a nested component; 0: all */
    bool log, no_refine;
    const char *damping, *at, *points_of;
    engines_wish engine;
    cli_list damper;
    responses_wish more;
    loops_wish loops;
} wish;

/*
 * From the band of the system where nothing is said. A band that starts at 0
 * starts a thousandth up instead: a free body has no static response.
 */
static ritz_status place(const model *m, const wish *asked, ritz_grid *out)
{
    double from = asked->from_hz;
    double to = asked->to_hz;

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
    RITZ_REFUSE_IF(asked->log && !(from > 0.0), RITZ_ERR_ARGUMENT,
                   "--log needs --from-hz above 0");
    *out = (ritz_grid){.from_hz = from,
                       .to_hz = to,
                       .count = asked->points > 0                ? asked->points
                                : isnan(asked->engine.tolerance) ? usual_points
                                                                 : first_points,
                       .log = asked->log,
                       .refine = !asked->no_refine};
    return RITZ_OK;
}

/* The points of another response, which can then be subtracted. */
static ritz_status borrow(cli_run *run, const wish *asked, model *other,
                          ritz_grid *out)
{
    const ritz_response *r = &other->response;

    RITZ_CHECK(model_read(run, asked->points_of, MODEL_RESPONSE, other));
    RITZ_REFUSE_IF(r->count < 1, RITZ_ERR_ARGUMENT, "'%s' has no points",
                   asked->points_of);
    *out = (ritz_grid){.from_hz = r->hertz[0],
                       .to_hz = r->hertz[r->count - 1],
                       .count = r->count,
                       .hertz = r->hertz};
    return RITZ_OK;
}

/* The highest point of each response, and where it is. */
static void report(cli_run *run, const ritz_response *r)
{
    json_t *measures = json_array();

    cli_say(run, "%s: %s response, %lld points from %g to %g Hz", run->output,
            r->method, (long long)r->count, r->hertz[0],
            r->hertz[r->count - 1]);
    cli_say(run, "%-20s %-20s %14s %14s", "output", "input", "peak |H|",
            "at Hz");
    for (int64_t i = 0; i < r->num_outputs; i++) {
        for (int64_t j = 0; j < r->num_inputs; j++) {
            char name[2 * RITZ_NAME_SIZE + 16];
            int64_t best = 0;
            double peak = -1.0;
            json_t *item = json_object();

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
            json_object_set_new(item, "name", cli_string(name));
            json_object_set_new(item, "value", cli_real(peak));
            json_object_set_new(item, "at_hz", cli_real(r->hertz[best]));
            json_object_set_new(item, "limit", json_null());
            json_object_set_new(item, "verdict", json_string("pass"));
            json_array_append_new(measures, item);
        }
    }
    json_object_set_new(run->report, "measures", measures);
    cli_report_text(run, "method", r->method);
    cli_report_text(run, "damping", r->damping);
    cli_report_int(run, "points", r->count);
    cli_record(run, r->method, r->count);
}

/* The model, or the loop that is closed around it, at the points. */
static ritz_status respond(cli_run *run, const model *m, const wish *asked,
                           const ritz_damping *damping, const ritz_grid *grid,
                           loop_run *loop, ritz_response *out)
{
    ritz_status status = RITZ_OK;
    const double range[2] = {grid->from_hz, grid->to_hz};
    ritz_second_order view = {0};
    ritz_responder *plant = NULL, *asked_of = NULL;

    if (m->kind == MODEL_REDUCED || m->kind == MODEL_SYSTEM)
        view = model_look(m).matrices;
    RITZ_TRY(
        engines_start(run, m, &asked->engine, damping, grid, &view, &plant));
    RITZ_TRY(loops_close(run, &asked->loops, m, damping, plant, range, loop));
    asked_of = loop->closed ? loop->closed : plant;
    RITZ_TRY(engines_respond(asked_of, &asked->engine, grid, out));
    RITZ_TRY(loops_report(run, loop, plant, out));
    report(run, out);
    RITZ_TRY(responses_singular(run, &asked->more, m, asked_of, out));
    RITZ_TRY(responses_zeros(run, &asked->more, m, damping));
done:
    ritz_responder_free(&loop->closed); /* it borrows the plant */
    ritz_responder_free(&plant);
    return status;
}

/* What drives it and is seen of it; of states the numbers alone. */
static ritz_io io_of(const model *m)
{
    if (m->kind == MODEL_STATES)
        return (ritz_io){.num_inputs = m->states.num_inputs,
                         .num_outputs = m->states.num_outputs};
    return m->kind == MODEL_COMPONENT ? m->component.io
                                      : *model_look(m).matrices.io;
}

static ritz_status frf(cli_run *run, const wish *asked)
{
    ritz_status status = RITZ_OK;
    const char *path = run->operand[0];
    model m = {0};
    model other = {0};
    ritz_damping damping = {0};
    ritz_grid grid = {0};
    ritz_response response = {0};
    loop_run loop = {0};
    ritz_stamp stamp = {0};
    ritz_io ends; /* borrowed */

    RITZ_TRY(model_read(
        run, path,
        MODEL_COMPONENT | MODEL_REDUCED | MODEL_SYSTEM | MODEL_STATES, &m));
    RITZ_TRY(loops_read(run, &asked->loops, &loop));
    RITZ_TRY(nested_take(path, asked->order, &m));
    RITZ_TRY(model_at(&m, path, asked->at));
    RITZ_FAIL_IF(m.kind == MODEL_STATES && asked->damping, RITZ_ERR_ARGUMENT,
                 "a state space is damped as it was made: --damping is for "
                 "ritz-basis");
    RITZ_TRY_IN(path, dampers_install(&m, &asked->damper));
    RITZ_TRY(model_damping(&m, asked->damping, &damping));
    if (asked->points_of)
        RITZ_TRY(borrow(run, asked, &other, &grid));
    else
        RITZ_TRY_IN(path, place(&m, asked, &grid));
    ends = io_of(&m);
    RITZ_FAIL_IF(ends.num_inputs == 0 || ends.num_outputs == 0,
                 RITZ_ERR_ARGUMENT, "'%s' has no %s, it responds to nothing",
                 path, ends.num_inputs == 0 ? "inputs" : "outputs");
    RITZ_TRY_IN(path,
                respond(run, &m, asked, &damping, &grid, &loop, &response));
    stamp = cli_stamp(run);
    RITZ_TRY(ritz_container_write_response(run->output, &response, &stamp));
done:
    ritz_response_free(&response);
    loop_run_free(&loop);
    model_free(&m);
    model_free(&other);
    return status;
}

int main(int argc, char **argv)
{
    wish asked = {.from_hz = (double)NAN,
                  .to_hz = (double)NAN,
                  .engine = {.method = "auto",
                             .up_to_hz = (double)NAN,
                             .tolerance = (double)NAN}};
    const cli_option options[] = {
        {CLI_REAL(&asked.from_hz), .name = "from-hz", .argument = "F",
         .min = 0.0, .max = 1e9,
         .help = "start [the band's, or a thousandth "
                 "of the end]"},
        {CLI_REAL(&asked.to_hz), .name = "to-hz", .argument = "F", .min = 1e-9,
         .max = 1e9, .help = "end [the band's of a system]"},
        {CLI_INT(&asked.points), .name = "points", .argument = "N", .min = 2,
         .max = 1000000,
         .help = "how many evenly spaced points [400; with --tolerance 20]"},
        {CLI_FLAG(&asked.log), .name = "log",
         .help = "evenly spaced in the logarithm of frequency"},
        {CLI_FLAG(&asked.no_refine), .name = "no-refine",
         .help = "add no points at and around resonances"},
        {CLI_TEXT(&asked.points_of), .name = "points-of", .argument = "FILE",
         .help = "the points of another response instead"},
        ENGINES_OPTIONS(&asked.engine),
        ORDER_OPTION(&asked.order),
        DAMPING_OPTION(&asked.damping),
        DAMPERS_OPTION(&asked.damper),
        {CLI_TEXT(&asked.at), .name = "at",
         .argument = "JOINT=SETTING[,JOINT=SETTING]",
         .help = "which configuration of a system, degrees and lengths"},
        RESPONSES_OPTIONS(&asked.more),
        LOOPS_OPTIONS(&asked.loops),
        {0},
    };
    const cli_program program = {
        .name = "ritz-frf",
        .operands = {{"FILE",
                      "a component, reduced component, system or state space",
                      false}},
        .summary = "Frequency response from every input to every output.",
        .example = "ritz-frf system.h5 --at clock=60,cone=0 --to-hz 10 "
                   "-o response.h5",
        .options = options,
        .output = "the response",
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, argc, argv, &run);
    loops_check(&program, &asked.loops);
    engines_check(&program, &asked.engine);
    if (asked.points_of && !isnan(asked.engine.tolerance))
        cli_refuse(&program, "--points-of gives the points, --tolerance "
                             "chooses them: one of the two");
    return cli_finish(&run, frf(&run, &asked));
}
