#include "print/fit.h"

#include <math.h>
#include <string.h>

json_t *fit_values_json(const ritz_measures *measures)
{
    json_t *object = json_object();

    for (int64_t k = 0; k < measures->count; k++)
        json_object_set_new(object, measures->item[k].name,
                            cli_real(measures->item[k].value));
    return object;
}

/* "response-relative": 0.01 of each measure that has a tolerance. */
static json_t *tolerance_json(const ritz_verify_request *limits)
{
    json_t *object = json_object();

    for (int k = 0; k < RITZ_MEASURES; k++)
        if (!isnan(limits->limit[k]))
            json_object_set_new(object, ritz_measure_table[k].name,
                                cli_real(limits->limit[k]));
    return object;
}

static json_t *modes_json(const ritz_fit_candidate *c)
{
    json_t *array = json_array();

    for (int64_t k = 0; k < c->num_bodies; k++)
        json_array_append_new(
            array, c->modes[k] < 0 ? json_null() : json_integer(c->modes[k]));
    return array;
}

static json_t *candidate_json(const ritz_fit_candidate *c)
{
    json_t *object = json_object();

    json_object_set_new(object, "method", cli_string(c->method->name));
    json_object_set_new(object, "order",
                        c->order > 0 ? json_integer(c->order) : json_null());
    json_object_set_new(object, "columns", json_integer(c->columns));
    json_object_set_new(object, "modes", modes_json(c));
    json_object_set_new(
        object, "seconds",
        json_pack("{s:f, s:f}", "wall", c->making.wall, "cpu", c->making.cpu));
    json_object_set_new(object, "errors", fit_values_json(&c->errors));
    json_object_set_new(object, "estimates", fit_values_json(&c->estimates));
    if (c->cost.order > 0)
        json_object_set_new(object, "cost", model_cost_json(&c->cost));
    json_object_set_new(object, "left_out", json_integer(c->left_out));
    json_object_set_new(object, "screened", json_boolean(c->ruled_out));
    json_object_set_new(object, "held", json_boolean(c->bounded));
    json_object_set_new(object, "caught", json_boolean(c->unconfirmed));
    json_object_set_new(object, "feasible", json_boolean(c->feasible));
    if (c->refusal[0])
        json_object_set_new(object, "refused", cli_string(c->refusal));
    return object;
}

void fit_record(fit_run *fit, const ritz_fit_candidate *c, fit_mark mark)
{
    ritz_status status = RITZ_OK;
    json_t *line = candidate_json(c);

    json_object_set_new(line, "ok", json_boolean(!c->refusal[0]));
    json_object_set_new(line, "subject", cli_string(fit->subject));
    json_object_set_new(line, "chosen", json_boolean(mark.chosen));
    json_object_set_new(line, "runner_up", json_boolean(mark.runner_up));
    if (fit->limits) {
        json_object_set_new(line, "tolerance", tolerance_json(fit->limits));
        json_object_set_new(line, "band_hz",
                            model_reals_json(2, fit->limits->band_hz));
    }
    if (mark.why)
        json_object_set_new(line, "why", cli_string(mark.why));
    status = cli_record_line(fit->run, line);
    if (fit->recorded == RITZ_OK)
        fit->recorded = status;
}

void fit_observe(const ritz_fit_candidate *candidate, void *context)
{
    fit_record(context, candidate, (fit_mark){0});
}

/* "1.2e-03" of the measure that decides, or what stood in the way. */
static void say_row(const cli_run *run, const ritz_fit_candidate *c,
                    const char *name)
{
    char modes[64] = "-";
    char cost[32] = "-"; /* of what is not met it is not measured */
    char error[32];
    size_t used = 0;

    if (!c) {
        cli_say(run, "%-18s refused", name);
        return;
    }
    for (int64_t k = 0; k < c->num_bodies && c->modes[0] >= 0; k++)
        if (used < sizeof modes - 8)
            used +=
                (size_t)snprintf(modes + used, sizeof modes - used, "%s%lld",
                                 k > 0 ? "+" : "", (long long)c->modes[k]);
    if (c->refusal[0]) {
        const char *why = c->refusal;
        const size_t length = strlen(name);

        if (strncmp(why, name, length) == 0 &&
            strncmp(why + length, ": ", 2) == 0)
            why += length + 2; /* the row begins with it */
        cli_say(run, "%-18s refused: %s", name, why);
        return;
    }
    if (c->cost.order > 0)
        snprintf(cost, sizeof cost, "%.2g", c->cost.seconds_per_second);
    snprintf(error, sizeof error, "%s%.2g", c->ruled_out ? ">" : "", c->ratio);
    cli_say(run, "%-18s %6lld %8s  %8s %-10s %8.2g %9s  %s", c->method->name,
            (long long)c->order, modes, error,
            c->ruled_out   ? "frequency"
            : c->worst < 0 ? ""
                           : ritz_tolerance_word(c->errors.item[c->worst].name),
            c->making.cpu, cost, c->feasible ? "" : "not met");
}

static void say_head(const cli_run *run)
{
    cli_say(run, "%-18s %6s %8s  %8s %-10s %8s %9s", "method", "order", "modes",
            "error", "of", "made, s", "cost, s/s");
}

/* Why the first candidate of a method was refused. */
static const ritz_fit_candidate *first_of(const ritz_fit *fit, int64_t method)
{
    for (int64_t k = 0; k < fit->count; k++)
        if (fit->candidate[k].method == fit->method[method])
            return &fit->candidate[k];
    return NULL;
}

static const ritz_fit_candidate *of_method(const ritz_fit *fit, int64_t m)
{
    if (fit->best[m] >= 0)
        return &fit->candidate[fit->best[m]];
    if (fit->reached[m] >= 0)
        return &fit->candidate[fit->reached[m]];
    return first_of(fit, m);
}

static json_t *methods_json(const ritz_fit *fit)
{
    json_t *array = json_array();

    for (int64_t m = 0; m < fit->num_methods; m++) {
        const ritz_fit_candidate *c = of_method(fit, m);

        if (c)
            json_array_append_new(array, candidate_json(c));
    }
    return array;
}

static void say_cost(cli_run *run, const ritz_fitter *fitter,
                     const ritz_cost *cost)
{
    const double *band = ritz_fitter_tolerance(fitter)->band_hz;

    if (cost->order == 0)
        return;
    if (isfinite(cost->step_explicit))
        cli_say(run,
                "Highest frequency %.4g Hz: an explicit integrator is stable "
                "up to steps of %.3g s.",
                cost->highest_hz, cost->step_explicit);
    else
        cli_say(run, "Nothing oscillates: an explicit integrator is stable "
                     "with any step.");
    cli_say(run,
            "Suggested step %.3g s, which resolves the band to %g Hz: %.3g s "
            "of processor a second simulated (%s, measured).",
            cost->step, band[1], cost->seconds_per_second, cost->integrator);
    json_object_set_new(run->report, "cost", model_cost_json(cost));
}

/* How wrong it can be, where that is known; modes one by one are in the file. */
static void say_bounds(const cli_run *run, const ritz_measures *estimates)
{
    for (int64_t k = 0; k < estimates->count; k++) {
        const ritz_measure *m = &estimates->item[k];

        if (strncmp(m->name, "mode-", 5) != 0)
            cli_say(run, "%-28s %12.4e %12s  %-9s  %s", m->name, m->value, "-",
                    "estimated", m->where);
    }
}

static void say_answer(cli_run *run, const ritz_fitter *fitter,
                       const ritz_fit *fit)
{
    const ritz_fit_candidate *c = &fit->candidate[fit->chosen];
    const ritz_fit_candidate *second =
        fit->runner_up >= 0 ? &fit->candidate[fit->runner_up] : NULL;

    cli_say(run, "\nSmallest: %s, order %lld", c->method->name,
            (long long)c->order);
    for (int64_t k = 0; k < c->num_bodies && *ritz_fitter_body(fitter, k); k++)
        if (c->modes[k] >= 0) /* there is a number to choose */
            cli_say(run, "  %-20s %lld mode%s", ritz_fitter_body(fitter, k),
                    (long long)c->modes[k], c->modes[k] == 1 ? "" : "s");
    model_say_measures(run, "measures", &c->errors, "measured");
    say_bounds(run, &c->estimates);
    say_cost(run, fitter, &c->cost);
    cli_report_text(run, "method", c->method->name);
    cli_report_int(run, "order", c->order);
    cli_report_int(run, "columns", c->columns);
    json_object_set_new(run->report, "modes", modes_json(c));
    json_object_set_new(run->report, "error", cli_real(c->ratio));
    json_object_set_new(run->report, "measures",
                        model_measures_json(&c->errors, "measured"));
    json_object_set_new(run->report, "estimates",
                        model_measures_json(&c->estimates, "estimated"));
    json_object_set_new(run->report, "runner_up",
                        second ? candidate_json(second) : json_null());
}

void fit_say(cli_run *run, const ritz_fitter *fitter, const ritz_fit *fit)
{
    const ritz_verify_request *limits = ritz_fitter_tolerance(fitter);
    char what[256];
    char tolerance[256];

    ritz_fitter_describe(fitter, sizeof what, what);
    ritz_tolerance_print(limits, sizeof tolerance, tolerance);
    cli_say(run, "Fitted to %s from %g to %g Hz, against %s:", tolerance,
            limits->band_hz[0], limits->band_hz[1], what);
    cli_say(run,
            "%lld candidates of %lld method%s; errors in parts of their "
            "tolerance, > at least.\n",
            (long long)fit->count, (long long)fit->num_methods,
            fit->num_methods == 1 ? "" : "s");
    say_head(run);
    for (int64_t m = 0; m < fit->num_methods; m++)
        say_row(run, of_method(fit, m), fit->method[m]->name);
    if (fit->chosen >= 0)
        say_answer(run, fitter, fit);
    cli_say(run, "\nWhy: %s.", fit->why);
    cli_report_text(run, "reference", what);
    json_object_set_new(run->report, "tolerance", tolerance_json(limits));
    json_object_set_new(run->report, "methods", methods_json(fit));
    cli_report_text(run, "why", fit->why);
    cli_report_int(run, "candidates", fit->count);
}

void fit_say_all(cli_run *run, const ritz_fit *fit, int64_t equal_order,
                 const int64_t *equal)
{
    json_t *array = json_array();

    cli_say(run, "\nThe same at equal order, %lld or the nearest below:\n",
            (long long)equal_order);
    say_head(run);
    for (int64_t m = 0; m < fit->num_methods; m++) {
        const ritz_fit_candidate *c =
            equal[m] >= 0 ? &fit->candidate[equal[m]] : first_of(fit, m);

        if (equal[m] < 0 && c && !c->refusal[0]) {
            cli_say(run, "%-18s has no fewer than %lld", fit->method[m]->name,
                    (long long)c->order);
            continue;
        }
        say_row(run, c, fit->method[m]->name);
        if (c)
            json_array_append_new(array, candidate_json(c));
    }
    json_object_set_new(run->report, "equal_order", array);
}
