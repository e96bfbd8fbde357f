/* Runs of closed loops: the joined signals, the stability of the loop, and the
   step. */
#include "base/tolerances.h"
#include "print/measured.h"
#include "print/simulation.h"

#include <ritz/controlled.h>

bool simulation_is_controlled(const simulation_options *given)
{
    return given->loops.controller != NULL;
}

/* What is said of this step, and the least unstable one that was found. */
static void say_split(cli_run *run, bool sampled,
                      const ritz_loop_stability *stability)
{
    sink_field(run, sampled ? "one sample" : "one step", "spectral_radius",
               "spectral radius %.8g%s", stability->radius,
               stability->estimated ? ", by the growth of a vector" : "");
    if (isnan(stability->limit))
        return;
    if (isinf(stability->limit))
        cli_say(run,
                "stable as it is split: at all steps that were tried, from "
                "%.5g s up to the whole run",
                stability->from);
    else if (stability->limit > 0.0)
        sink_field(run, "unstable from", "step_limit",
                   "a step of %.5g s, the least found of those tried from "
                   "%.5g s up",
                   stability->limit, stability->from);
    else
        cli_say(run,
                "unstable as it is split: at the least step that was tried, "
                "%.5g s",
                stability->from);
}

/* The verdict if poles of a continuous loop are not known. A sampled loop is
   stable if its map is; a delayed loop can only be found unstable. */
static void say_map(cli_run *run, const ritz_controlled *controlled,
                    const ritz_loop_stability *stability)
{
    const bool sampled = controlled->sample > 0.0;
    const ritz_stability verdict = stability->grows     ? RITZ_UNSTABLE
                                   : stability->neutral ? RITZ_MARGINAL
                                                        : RITZ_STABLE;

    if (sampled) {
        sink_say(run, "stability", "the sampled loop is %s",
                 ritz_stability_name(verdict));
        return;
    }
    cli_say(run, "the poles of the loop are not known, because the plant is "
                 "too large or the controller has a delay");
    sink_set(run, "stability", "%s",
             stability->unstable_by_delay ? ritz_stability_name(RITZ_UNSTABLE)
                                          : "unknown");
}

static void warn_of_growth(cli_run *run, double step,
                           const ritz_loop_stability *stability)
{
    char text[2 * RITZ_NAME_SIZE];
    const bool unstable =
        stability->known && stability->loop.verdict == RITZ_UNSTABLE;

    if (unstable)
        ritz_probe_print(&stability->loop, text);
    if (stability->hides_instability)
        cli_warn(
            run,
            "the loop is unstable, %s, but not as it is propagated: a step "
            "of %g s hides it (spectral radius %.8g), and what is written "
            "is not the loop's motion",
            text, step, stability->radius);
    else if (unstable)
        cli_warn(run, "the loop is unstable, %s: it grows without bound", text);
    else if (stability->unstable_by_delay)
        cli_warn(run,
                 "the loop is unstable with its delay, at finer steps too: it "
                 "grows by %.8g from one step to the next",
                 stability->radius);
    else if (stability->grows)
        cli_warn(run, "it grows by %.8g from one step or sample to the next",
                 stability->radius);
}

/* Print the stability of the loop once for each run, and refuse an unstable
   one. */
static ritz_status examine(simulation_task *d,
                           const ritz_simulation_request *request,
                           const ritz_controlled *controlled)
{
    cli_run *run = d->run;
    ritz_loop_stability stability = {0};

    RITZ_CHECK(
        ritz_controlled_examine(d->subject, request, controlled, &stability));
    if (stability.known)
        loop_say_stability(run, &stability.loop);
    else
        say_map(run, controlled, &stability);
    if (!controlled->exact)
        say_split(run, controlled->sample > 0.0, &stability);
    RITZ_CHECK(ritz_controlled_refuse(request, controlled, &stability));
    warn_of_growth(run, request->step, &stability);
    return RITZ_OK;
}

/* The step, and the delay as it is used: of whole steps. */
static void say_step(cli_run *run, const ritz_controlled *controlled,
                     double asked, double step)
{
    const double steps = round(controlled->delay / step);
    const double used = steps * step;

    if (step < asked)
        cli_say(run,
                "a step of %.8g s, of which sample and delay are multiples",
                step);
    if (fabs(used - controlled->delay) > RITZ_DELAY_ROUNDING * used)
        cli_say(run,
                "a delay of %.13g s is used for the %.13g s given: %.0f steps",
                used, controlled->delay, steps);
}

ritz_status simulation_prepare_loop(simulation_task *task)
{
    const loop_options *given = &task->given->loops;
    ritz_io inner = {0}; /* borrowed */

    RITZ_CHECK(measured_read(task->run, given->controller, MODEL_STATES,
                             &task->controller));
    RITZ_REFUSE_IF(measured_is(&task->controller), RITZ_ERR_ARGUMENT,
                   "%s: a measured response has no states for a run in time: "
                   "give a state space",
                   given->controller);
    inner = ritz_model_io(model_reference(&task->controller));
    return loop_join(task->run, given, &task->io, &inner, &task->loop);
}

/* The controller that the options describe. */
static ritz_controlled take_controlled(const simulation_task *d)
{
    const simulation_options *given = d->given;

    return (ritz_controlled){.controller = &d->controller.states,
                             .loop = &d->loop,
                             .exact =
                                 given->way && strcmp(given->way, "exact") == 0,
                             .discrete = given->discrete,
                             .sample = given->sample,
                             .delay = given->delay,
                             .any_step = given->any_step,
                             .force = given->loops.force};
}

static ritz_status say_loop_cost(const simulation_task *d,
                                 const ritz_controlled *controlled,
                                 const ritz_simulation_request *request)
{
    const char *way = controlled->exact          ? "exact"
                      : controlled->sample > 0.0 ? "sampled"
                                                 : "split";
    char name[RITZ_NAME_SIZE];
    double spent = 0.0;

    RITZ_CHECK_IN(way, ritz_controlled_step_cost(d->subject, request,
                                                 controlled, &spent));
    (void)snprintf(name, sizeof name, "loop, %s", way);
    sink_say(d->run, "name,step,seconds_per_second", "%-20s %12.4g %14.3g",
             name, request->step, spent / request->step);
    return RITZ_OK;
}

ritz_status simulation_say_loop_costs(simulation_task *d, double step)
{
    const simulation_options *given = d->given;
    const ritz_simulation_request request = {
        .integrator = given->integrator,
        .seconds = 1.0,
        .step = given->step > 0.0 ? given->step : step,
        .rho = given->rho};
    ritz_simulation_request asked = request;
    ritz_controlled way = {0};
    bool both = false;

    if (!d->controller.kind)
        RITZ_CHECK_IN("--controller", simulation_prepare_loop(d));
    way = take_controlled(d);
    RITZ_CHECK(ritz_controlled_step(&way, request.step, &asked.step));
    both = !way.exact && given->integrator == &ritz_integrator_modal &&
           !(way.sample > 0.0) && !(way.delay > 0.0) &&
           2 * ritz_model_order(d->subject) + d->controller.states.A.nrow <=
               RITZ_LOOP_EXACT;
    sink_list(d->run, "loops");
    RITZ_CHECK(say_loop_cost(d, &way, &asked));
    way.exact |= both;
    if (both)
        RITZ_CHECK(say_loop_cost(d, &way, &asked));
    sink_end(d->run);
    return RITZ_OK;
}

ritz_status simulation_controlled(simulation_task *d,
                                  const ritz_simulation_request *request,
                                  ritz_simulation *out)
{
    static const ritz_loop_stability examined = {0};
    ritz_simulation_request asked = *request;
    const ritz_controlled controlled = take_controlled(d);

    RITZ_CHECK(ritz_controlled_step(&controlled, request->step, &asked.step));
    if (!d->told)
        say_step(d->run, &controlled, request->step, asked.step);
    if (!d->told)
        RITZ_CHECK(examine(d, &asked, &controlled));
    d->told = true;
    return ritz_simulate_controlled(d->subject, &asked, &controlled, &examined,
                                    out);
}
