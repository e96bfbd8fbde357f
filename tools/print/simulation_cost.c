/* What a simulated second costs, by each integrator. */
#include "print/simulation.h"

#include "base/tolerances.h"

/* Explicit steps at which costs are measured, relative to their limit. */
static const double margin = 0.95;
/* Number of steps over which costs are measured, if no time is given. */
static const double default_steps = 1000.0;

/* Largest relative difference from a run by the modal integrator. */
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

/* Cost of a simulator that forms and factors its mass matrix at each step. */
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
            "periods at the band's end are accurate to 1e-3 up to %.4g s "
            "(trapezoidal)\n",
            cost->step_accurate);
    cli_say(run, "%-20s %12s %14s %12s", "integrator", "step, s", "s a second",
            "error");
}

/* If no input is given, all inputs sweep from 0 Hz to the end of the band. */
static void sweep_inputs(const ritz_cost *cost, const double band_hz[2],
                         simulation_task *d)
{
    double end = band_hz[1] > 0.0 ? band_hz[1] : fmax(cost->highest_hz, 1.0);

    for (int64_t j = 0; j < d->io.num_inputs; j++)
        d->signal[j] = (ritz_signal){
            .kind = RITZ_SIGNAL_CHIRP, .amplitude = 1.0, .hertz = {0.0, end}};
}

/* The cost of a model, in the line of --record. */
ritz_status simulation_record_cost(cli_run *run, ritz_model subject,
                                   const double band_hz[2], ritz_cost *cost)
{
    RITZ_CHECK(ritz_simulate_cost(subject, band_hz, cost));
    sink_open(run, run->line);
    model_set_cost(run, cost);
    sink_end(run);
    return RITZ_OK;
}

/* Print the cost of a second and the error against modal, for each integrator
   at the step that it needs. */
ritz_status simulation_say_costs(simulation_task *d, const double band_hz[2])
{
    cli_run *run = d->run;
    const simulation_options *given = d->given;
    const model *m = &d->m;
    ritz_cost cost = {0};
    ritz_simulation_request request = RITZ_SIMULATION_NONE;

    RITZ_REFUSE_IF(d->subject.kind != RITZ_MODEL_DENSE, RITZ_ERR_ARGUMENT,
                   "--cost is of reduced components and systems");
    RITZ_CHECK(simulation_record_cost(run, d->subject, band_hz, &cost));
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
    if (simulation_is_controlled(given))
        RITZ_CHECK(simulation_say_loop_costs(d, cost.step_accurate));
    RITZ_CHECK(say_refactored(run, &cost));
    cli_record(run, m->kind == MODEL_REDUCED ? m->reduced.origin.method : "",
               ritz_model_order(model_reference(m)));
    return RITZ_OK;
}
