/* What a second of a model costs by each integrator, and how far off it is. */
#include "print/simulation.h"

#include <math.h>
#include <string.h>

/* Below a limit, so that rounding does not cross it. */
static const double margin = 0.95;
static const double default_steps = 1000.0;

static ritz_status difference(const ritz_simulated *subject,
                              ritz_simulation_request request, double *out)
{
    ritz_status status = RITZ_OK;
    ritz_simulation made = {0}, exact = {0};

    RITZ_TRY(ritz_simulate(subject, &request, &made));
    request.integrator = &ritz_integrator_modal;
    RITZ_TRY(ritz_simulate(subject, &request, &exact));
    RITZ_TRY(ritz_simulation_difference(&exact, &made, out));
done:
    ritz_simulation_free(&made);
    ritz_simulation_free(&exact);
    return status;
}

static ritz_status say_row(cli_run *run, const ritz_simulated *subject,
                           ritz_simulation_request request, json_t *rows)
{
    const ritz_integrator *integrator = request.integrator;
    json_t *item = json_object();
    double spent = 0.0, error = 0.0;

    json_array_append_new(rows, item);
    RITZ_CHECK(ritz_simulate_step_cost(subject->model, subject->damping,
                                       integrator, request.step, &spent));
    RITZ_CHECK(difference(subject, request, &error));
    cli_say(run, "%-20s %12.4g %14.3g %12.2e", integrator->name, request.step,
            spent / request.step, error);
    json_object_set_new(item, "name", cli_string(integrator->name));
    json_object_set_new(item, "step", cli_real(request.step));
    json_object_set_new(item, "seconds_per_second",
                        cli_real(spent / request.step));
    json_object_set_new(item, "error", cli_real(error));
    return RITZ_OK;
}

/* A simulator that makes and factors its mass matrix at each step. */
static ritz_status say_anew(cli_run *run, const ritz_cost *cost)
{
    double factor = 0.0, total = 0.0;

    if (cost->order < 1)
        return RITZ_OK;
    RITZ_CHECK(ritz_simulate_refactor_cost(cost->order, &factor));
    total = cost->seconds_per_second + factor / cost->step;
    cli_say(run,
            "\na simulator that factors the mass matrix anew at each such step "
            "of %s:\nabout %.3g s a second (an estimate: r^3/3 flops a step at "
            "the rate of one factor)",
            cost->integrator, total);
    json_object_set_new(run->report, "seconds_per_second_refactored_estimate",
                        cli_real(total));
    return RITZ_OK;
}

static void say_head(const cli_run *run, const ritz_cost *cost)
{
    cli_say(run, "order %lld, highest frequency %.6g Hz",
            (long long)cost->order, cost->highest_hz);
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
static void sweep(const ritz_cost *cost, const double band_hz[2],
                  simulation_drive *drive)
{
    double end = band_hz[1] > 0.0 ? band_hz[1] : fmax(cost->highest_hz, 1.0);

    for (int64_t j = 0; j < drive->count; j++)
        drive->signal[j] = (ritz_signal){
            .kind = RITZ_SIGNAL_CHIRP, .amplitude = 1.0, .hertz = {0.0, end}};
}

ritz_status simulation_costs(cli_run *run, const ritz_simulated *subject,
                             simulation_drive *drive, bool driven,
                             const double band_hz[2], double seconds)
{
    ritz_cost cost = {0};
    json_t *rows = json_array();
    ritz_simulation_request request = RITZ_SIMULATION_NONE;

    json_object_set_new(run->report, "integrators", rows);
    RITZ_CHECK(
        ritz_simulate_cost(subject->model, subject->damping, band_hz, &cost));
    json_object_set_new(run->report, "cost", model_cost_json(&cost));
    json_object_set_new(run->line, "cost", model_cost_json(&cost));
    say_head(run, &cost);
    if (!driven)
        sweep(&cost, band_hz, drive);
    request.signal = drive->signal;
    request.x0 = drive->x0;
    request.v0 = drive->v0;
    request.seconds =
        seconds > 0.0 ? seconds : default_steps * cost.step_accurate;
    for (const ritz_integrator *const *i = ritz_integrators; *i; i++) {
        request.integrator = *i;
        request.step = cost.step_accurate;
        if ((*i)->is_explicit)
            request.step = fmin(request.step, margin * cost.step_explicit);
        RITZ_CHECK_IN((*i)->name, say_row(run, subject, request, rows));
    }
    return say_anew(run, &cost);
}

ritz_status simulation_record_cost(cli_run *run, const ritz_simulated *subject,
                                   const double band_hz[2])
{
    ritz_cost cost = {0};

    if (!run->record || !subject->model)
        return RITZ_OK;
    RITZ_CHECK(
        ritz_simulate_cost(subject->model, subject->damping, band_hz, &cost));
    json_object_set_new(run->line, "cost", model_cost_json(&cost));
    return RITZ_OK;
}
