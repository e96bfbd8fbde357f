#include "print/print.h"

#include <inttypes.h>

/* "craig-bampton,rubin", or "all" there are. */
static void read_methods(const cli_program *program, fit_options *given)
{
    ritz_fit_request *request = &given->request;
    const char *list = given->methods;
    char word[RITZ_NAME_SIZE];

    request->methods = given->method;
    if (strcmp(list, "all") == 0) {
        for (int k = 0; ritz_methods[k]; k++)
            given->method[request->num_methods++] = ritz_methods[k];
        given->method[request->num_methods++] = &ritz_fit_compare;
        return;
    }
    while (cli_next(&list, word)) {
        const ritz_method *found = ritz_fit_method_find(word);

        if (!found)
            cli_refuse(program, "%s", ritz_error_message());
        if (request->num_methods == FIT_MOST_METHODS)
            cli_refuse(program, "--methods takes %d methods, not more",
                       (int)FIT_MOST_METHODS);
        given->method[request->num_methods++] = found;
    }
}

/* Take words of the command line into the request, or end the program. */
static void take_options(const cli_program *program, fit_options *given)
{
    ritz_verify_request *tolerance = &given->request.tolerance;

    if (!given->tolerance)
        cli_refuse(program, "--tolerance says what is to hold");
    if (ritz_tolerance_take(given->tolerance, tolerance) != RITZ_OK)
        cli_refuse(program, "--tolerance: %s", ritz_error_message());
    if (given->methods)
        read_methods(program, given);
    given->request.seed = (uint64_t)given->seed;
}

/* Measures by name, in an object of their own. */
static void set_values(cli_run *run, const char *key,
                       const ritz_measures *measures)
{
    sink_object(run, key);
    for (int64_t k = 0; k < measures->count; k++)
        sink_set(run, measures->item[k].name, "%g", measures->item[k].value);
    sink_end(run);
}

/* Report the causes of bounds that are far above the known errors. */
static void set_causes(cli_run *run, const ritz_measures *measures)
{
    sink_object(run, "causes");
    for (int64_t k = 0; k < measures->count; k++)
        if (measures->item[k].cause[0])
            sink_set(run, measures->item[k].name, "%s",
                     measures->item[k].cause);
    sink_end(run);
}

/* "response-relative": 0.01 of each measure that has a tolerance. */
static void set_tolerance(cli_run *run, const ritz_verify_request *limits)
{
    sink_object(run, "tolerance");
    for (int k = 0; k < RITZ_MEASURES; k++)
        if (!isnan(limits->limit[k]))
            sink_set(run, ritz_measure_table[k].name, "%g", limits->limit[k]);
    sink_end(run);
}

/* Modes of each body; null where there is no number to choose. */
static void set_modes(cli_run *run, const ritz_fit_candidate *c)
{
    SINK_EACH(run, "modes", k, c->num_bodies)
        if (c->modes[k] < 0)
            sink_add(run, "%g", (double)NAN);
        else
            sink_add(run, "%ld", c->modes[k]);
}

/* An order, or null of what was refused. */
static void set_order(cli_run *run, int64_t order)
{
    if (order > 0)
        sink_set(run, "order", "%ld", order);
    else
        sink_set(run, "order", "%g", (double)NAN);
}

static void set_candidate(cli_run *run, const ritz_fit_candidate *c)
{
    sink_set(run, "method,columns,left_out,screened,caught,feasible",
             "%s %ld %ld %d %d %d", c->method->name, c->columns, c->left_out,
             c->ruled_out, c->unconfirmed, c->feasible);
    set_order(run, c->order);
    set_modes(run, c);
    sink_object(run, "seconds");
    sink_set(run, "wall,cpu", "%g %g", c->making.wall, c->making.cpu);
    sink_end(run);
    set_values(run, "errors", &c->errors);
    set_values(run, "estimates", &c->estimates);
    set_causes(run, &c->estimates);
    if (c->cost.order > 0)
        model_set_cost(run, &c->cost);
    if (c->refusal[0])
        sink_set(run, "refused", "%s", c->refusal);
}

/* A run of ritz-fit, for the observer that records candidates. */
typedef struct fit_run {
    cli_run *run;
    const fit_options *given;
    const ritz_scene *scene; /* NULL: a component is fitted */
    char subject[RITZ_NAME_SIZE];
    const ritz_verify_request *limits; /* NULL: not known yet */
    ritz_status recorded;              /* the first failure to append */
} fit_run;

/* Append a candidate to the file of --record. */
static void record_candidate(fit_run *fit, const ritz_fit_candidate *c,
                             bool chosen, bool runner_up, const char *why)
{
    cli_run *run = fit->run;
    json_t *line = json_object();
    ritz_status status = RITZ_OK;

    sink_open(run, line);
    set_candidate(run, c);
    sink_set(run, "ok,subject,chosen,runner_up", "%d %s %d %d", !c->refusal[0],
             fit->subject, chosen, runner_up);
    if (fit->limits) {
        set_tolerance(run, fit->limits);
        sink_reals(run, "band_hz", 2, fit->limits->band_hz);
    }
    if (why)
        sink_set(run, "why", "%s", why);
    sink_end(run);
    status = cli_record_line(run, line);
    if (fit->recorded == RITZ_OK)
        fit->recorded = status;
}

static void observe_candidate(const ritz_fit_candidate *candidate,
                              void *context)
{
    record_candidate(context, candidate, false, false, NULL);
}

/* "1.2e-03" of the measure that decides, or what stood in the way. */
static void say_candidate(const cli_run *run, const ritz_fit_candidate *c,
                          const char *name)
{
    char modes[64] = "";
    char error[32];

    if (!c) {
        cli_say(run, "%-18s not tried", name);
        return;
    }
    for (int64_t k = 0; k < c->num_bodies && c->modes[0] >= 0; k++)
        if (strlen(modes) < sizeof modes - 8)
            sink_append(modes, sizeof modes, "%s%ld", k > 0 ? "+" : "",
                        c->modes[k]);
    if (c->refusal[0]) {
        const char *why = c->refusal;
        const size_t length = strlen(name);

        if (strncmp(why, name, length) == 0 &&
            strncmp(why + length, ": ", 2) == 0)
            why += length + 2; /* the row begins with it */
        cli_say(run, "%-18s refused: %s", name, why);
        return;
    }
    snprintf(error, sizeof error, "%s%.2g", c->ruled_out ? ">" : "", c->ratio);
    cli_say(run, "%-18s %6ld %8s  %8s %-10s %8.2g %9.2g  %s", c->method->name,
            c->order, *modes ? modes : "-", error,
            c->ruled_out   ? "frequency"
            : c->worst < 0 ? ""
                           : ritz_tolerance_word(c->errors.item[c->worst].name),
            c->making.cpu,
            c->cost.order > 0 ? c->cost.seconds_per_second : (double)NAN,
            c->feasible ? "" : "not met");
}

static void say_head(const cli_run *run)
{
    cli_say(run, "%-18s %6s %8s  %8s %-10s %8s %9s", "method", "order", "modes",
            "error", "of", "made, s", "cost, s/s");
}

/* Why the first candidate of a method was refused. */
static const ritz_fit_candidate *find_first(const ritz_fit *fit, int64_t method)
{
    for (int64_t k = 0; k < fit->count; k++)
        if (fit->candidate[k].method == fit->method[method])
            return &fit->candidate[k];
    return NULL;
}

static const ritz_fit_candidate *find_best(const ritz_fit *fit, int64_t m)
{
    if (fit->best[m] >= 0)
        return &fit->candidate[fit->best[m]];
    if (fit->reached[m] >= 0)
        return &fit->candidate[fit->reached[m]];
    return find_first(fit, m);
}

/* The line, and an item of the list if there is a candidate. */
static void say_item(cli_run *run, const ritz_fit_candidate *c,
                     const char *name)
{
    say_candidate(run, c, name);
    if (!c)
        return;
    sink_object(run, NULL);
    set_candidate(run, c);
    sink_end(run);
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
    model_set_cost(run, cost);
}

/* How wrong it can be, where that is known; modes one by one are in the
   file. */
static void say_bounds(const cli_run *run, const ritz_measures *estimates)
{
    for (int64_t k = 0; k < estimates->count; k++) {
        const ritz_measure *m = &estimates->item[k];

        if (strncmp(m->name, "mode-", 5) != 0)
            cli_say(run, "%-28s %12.4e %12s  %-9s  %s%s%s", m->name, m->value,
                    "-", "estimated", m->where,
                    m->where[0] && m->cause[0] ? ": " : "", m->cause);
    }
}

/* Print the worst measure that has a tolerance and, next to it, measures
   without a tolerance that are far worse. */
static void say_worst(cli_run *run, const ritz_fit_candidate *c)
{
    const ritz_measure *worst = NULL;

    if (c->worst < 0)
        return;
    worst = &c->errors.item[c->worst];
    sink_object(run, "worst");
    sink_set(run, "name", "%s", worst->name);
    sink_say(run, ",value,limit,where",
             "Worst of what was asked for: %s %.3g, allowed %g (%s)",
             ritz_tolerance_word(worst->name), worst->value, worst->limit,
             worst->where);
    sink_end(run);
    sink_list(run, "not_asked_for");
    for (int64_t k = 0; k < c->errors.count; k++) {
        const ritz_measure *m = &c->errors.item[k];

        if (!isnan(m->limit) ||
            !ritz_measure_is_beside(m->name, m->value, worst))
            continue;
        sink_object(run, NULL);
        sink_set(run, "name", "%s", m->name);
        sink_say(run, ",value,where",
                 "Not asked for, and more than ten times that: %s %.3g (%s)",
                 ritz_tolerance_word(m->name), m->value, m->where);
        sink_end(run);
    }
    sink_end(run);
}

static void say_result(cli_run *run, const ritz_fitter *fitter,
                       const ritz_fit *fit)
{
    const ritz_fit_candidate *c = &fit->candidate[fit->chosen];
    const ritz_fit_candidate *second =
        fit->runner_up >= 0 ? &fit->candidate[fit->runner_up] : NULL;

    cli_say(run, "\nSmallest: %s, order %ld", c->method->name, c->order);
    for (int64_t k = 0; k < c->num_bodies && *ritz_fitter_body(fitter, k); k++)
        if (c->modes[k] >= 0) /* there is a number to choose */
            cli_say(run, "  %-20s %ld mode%s", ritz_fitter_body(fitter, k),
                    c->modes[k], c->modes[k] == 1 ? "" : "s");
    say_worst(run, c);
    model_say_measures(run, SINK_LINE, "measures", &c->errors, "measured");
    say_bounds(run, &c->estimates);
    say_cost(run, fitter, &c->cost);
    sink_set(run, "method,order,columns,error", "%s %ld %ld %g",
             c->method->name, c->order, c->columns, c->ratio);
    set_modes(run, c);
    model_say_measures(run, SINK_NONE, "estimates", &c->estimates, "estimated");
    if (!second) {
        sink_set(run, "runner_up", "%g", (double)NAN);
        return;
    }
    sink_object(run, "runner_up");
    set_candidate(run, second);
    sink_end(run);
}

/* The search: tolerance, table of methods, result, reason. */
static void say_fit(cli_run *run, const ritz_fitter *fitter,
                    const ritz_fit *fit)
{
    const ritz_verify_request *limits = ritz_fitter_tolerance(fitter);
    char what[256];
    char tolerance[256];

    ritz_fitter_describe(fitter, sizeof what, what);
    ritz_tolerance_print(limits, sizeof tolerance, tolerance);
    set_tolerance(run, limits);
    sink_say(run, ",,,reference",
             "Fitted to %s from %g to %g Hz, against %s:", tolerance,
             limits->band_hz[0], limits->band_hz[1], what);
    sink_say(run, "candidates",
             "%ld candidates of %ld method%s; errors in parts of their "
             "tolerance, > at least.\n",
             fit->count, fit->num_methods, fit->num_methods == 1 ? "" : "s");
    say_head(run);
    SINK_EACH(run, "methods", m, fit->num_methods)
        say_item(run, find_best(fit, m), fit->method[m]->name);
    if (fit->chosen >= 0)
        say_result(run, fitter, fit);
    sink_say(run, "why", "\nWhy: %s.", fit->why);
}

/* Every method at one number of columns, or as few as it has. */
static void say_equal(cli_run *run, const ritz_fit *fit, int64_t order,
                      const int64_t *equal)
{
    cli_say(run, "\nThe same at equal order, %ld or the nearest below:\n",
            order);
    say_head(run);
    SINK_EACH(run, "equal_order", m, fit->num_methods) {
        const ritz_fit_candidate *c =
            equal[m] >= 0 ? &fit->candidate[equal[m]] : find_first(fit, m);

        if (equal[m] < 0 && c && !c->refusal[0])
            cli_say(run, "%-18s has no fewer than %ld", fit->method[m]->name,
                    c->order);
        else
            say_item(run, c, fit->method[m]->name);
    }
}

/* Orders and errors of the result with its bodies cut to first columns. */
static void set_step(cli_run *run, const ritz_fitter *fitter,
                     const ritz_fit_candidate *row)
{
    sink_object(run, "orders");
    for (int64_t k = 0; k < ritz_fitter_bodies(fitter); k++)
        sink_set(run, ritz_fitter_body(fitter, k), "%ld", row->modes[k]);
    sink_end(run);
    sink_set(run, "columns,error,feasible", "%ld %g %d", row->columns,
             row->ratio, row->feasible);
    set_order(run, row->order);
    set_values(run, "errors", &row->errors);
    if (row->refusal[0])
        sink_set(run, "refused", "%s", row->refusal);
}

/* "        26        20        46     42      0.47 frequency" */
static void say_step(const cli_run *run, const ritz_fit_candidate *row)
{
    const char *word =
        row->worst < 0 ? ""
                       : ritz_tolerance_word(row->errors.item[row->worst].name);

    for (int64_t k = 0; k < row->num_bodies; k++)
        sink_part(run, " %9ld", row->modes[k]);
    if (row->refusal[0])
        cli_say(run, "  %8ld refused: %s", row->columns, row->refusal);
    else
        cli_say(run, "  %8ld %6ld  %8.2g %s%s", row->columns, row->order,
                row->ratio, word, row->feasible ? "" : ", not met");
}

/* The fewest columns that do, if they are not all. */
static void say_enough(cli_run *run, const ritz_fitter *fitter,
                       const ritz_fit_path *path)
{
    int64_t last = 0;

    for (int64_t k = 0; k < path->count; k++)
        last = path->row[k].feasible ? k : last;
    if (last == 0)
        return;
    sink_part(run, "\nThe tolerance holds down to order %ld: cut ",
              path->row[last].order);
    for (int64_t k = 0; k < path->num_bodies; k++)
        sink_part(run, "%s%s to %ld", k > 0 ? ", " : "",
                  ritz_fitter_body(fitter, k), path->row[last].modes[k]);
    cli_say(run, ".");
}

static void say_path(cli_run *run, const ritz_fitter *fitter,
                     const ritz_fit_path *path)
{
    /* some twenty lines, the first and the last among them */
    const int64_t step = (path->count + 19) / 20;

    cli_say(run, "\nWith the first columns alone ('order: N' of a body's file "
                 "in a scene):\n");
    for (int64_t k = 0; k < path->num_bodies; k++)
        sink_part(run, " %9.9s", ritz_fitter_body(fitter, k));
    cli_say(run, "  %8s %6s  %8s of", "columns", "order", "error");
    SINK_ITEMS(run, "path", k, path->count) {
        set_step(run, fitter, &path->row[k]);
        if (k % step == 0 || k == path->count - 1)
            say_step(run, &path->row[k]);
    }
    say_enough(run, fitter, path);
}

/* Its bodies as PREFIXname.h5 if there is a prefix, and its system to the
   output if there is one. */
static ritz_status write_scene(const fit_run *f, ritz_fitter *fitter,
                               const ritz_fit_candidate *chosen)
{
    cli_run *run = f->run;
    RITZ_OWN(ritz_system) system = {0};
    RITZ_OWN(ritz_fit_path) path = {0};
    RITZ_OWN(ritz_bodies) body = {0};

    RITZ_CHECK(ritz_fitter_system(fitter, chosen, &body, &path, &system));
    describe_remarks(run, f->scene, body.item);
    say_path(run, fitter, &path);
    RITZ_CHECK(model_write_bodies(run, f->given->prefix, f->scene, body.item));
    if (!run->output)
        return RITZ_OK;
    return ritz_container_write_system(run->output, &system, cli_stamp(run));
}

/* Equal order: all methods once more, at one number of columns. */
static ritz_status compare_methods(cli_run *run, const fit_options *a,
                                   ritz_fitter *fitter, ritz_fit *fit)
{
    int64_t order = a->order;
    RITZ_OWN_ARRAY int64_t *equal = NULL;

    if (!a->all)
        return RITZ_OK;
    RITZ_REFUSE_IF(order == 0 && fit->chosen < 0, RITZ_ERR_ARGUMENT,
                   "%s: say at which --order methods are to be compared",
                   fit->why);
    if (order == 0)
        order = fit->candidate[fit->chosen].order;
    RITZ_CHECK_NEW(equal, fit->num_methods + 1);
    RITZ_CHECK(ritz_fitter_equal(fitter, order, fit, equal));
    say_equal(run, fit, order, equal);
    return RITZ_OK;
}

/* Warn if the method keeps no interface of a component with ports: the
   tolerance was measured from inputs to outputs, and forces and motions at
   ports were not compared. */
static void warn_of_ports(cli_run *run, const ritz_component *component,
                          const ritz_fit_candidate *chosen)
{
    if (component->num_ports == 0 || chosen->method->keeps_interface)
        return;
    cli_warn(run,
             "%s keeps nothing for port '%s': the tolerance was held against "
             "inputs and outputs alone. Where other bodies are joined to it, "
             "fit their scene, or leave out --methods, which keeps interfaces",
             chosen->method->name, component->port[0].name);
}

/* Write the output files. A signal may stop this while columns are put in
   order, which is before any file is written. */
static ritz_status write_result(fit_run *f, ritz_fitter *fitter,
                                const ritz_fit_candidate *chosen)
{
    cli_run *run = f->run;
    RITZ_OWN(ritz_reduced) reduced = {0};

    if (f->scene && (run->output || f->given->prefix))
        return write_scene(f, fitter, chosen);
    if (!run->output)
        return RITZ_OK;
    RITZ_CHECK(ritz_fitter_reduced(fitter, chosen, &reduced));
    return ritz_container_write_reduced(run->output, &reduced, cli_stamp(run));
}

/* After a signal: write the best candidate so far to OUTPUT.interrupted, and
   fail. Report and components are not written. */
static ritz_status keep_best(fit_run *f, ritz_fitter *fitter,
                             const ritz_fit *fit)
{
    cli_run *run = f->run;
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_system) system = {0};
    RITZ_OWN(ritz_fit_path) path = {0};
    RITZ_OWN(ritz_bodies) body = {0};
    const ritz_fit_candidate *chosen = NULL;
    char what[2 * RITZ_NAME_SIZE];

    RITZ_REFUSE_IF(fit->chosen < 0 || !run->output, RITZ_ERR_CONVERGENCE, "%s",
                   fit->why);
    chosen = &fit->candidate[fit->chosen];
    (void)snprintf(what, sizeof what,
                   "the search, after %" PRId64 " candidates of %" PRId64
                   " methods: others may be smaller",
                   fit->count, fit->num_methods);
    RITZ_CHECK(cli_divert(run, what));
    if (f->scene) {
        RITZ_CHECK(ritz_fitter_system(fitter, chosen, &body, &path, &system));
        RITZ_CHECK(
            ritz_container_write_system(run->output, &system, cli_stamp(run)));
    } else {
        RITZ_CHECK(ritz_fitter_reduced(fitter, chosen, &reduced));
        RITZ_CHECK(ritz_container_write_reduced(run->output, &reduced,
                                                cli_stamp(run)));
    }
    return ritz_fail(RITZ_ERR_CONVERGENCE,
                     "interrupted: the best so far, of order %" PRId64
                     ", is in '%s'",
                     chosen->order, run->output);
}

/* After a complete search: compare methods, record the result and write it. */
static ritz_status conclude_search(fit_run *f, const model *full,
                                   ritz_fitter *fitter, ritz_fit *fit)
{
    cli_run *run = f->run;
    const ritz_fit_candidate *chosen = NULL;

    RITZ_CHECK(compare_methods(run, f->given, fitter, fit));
    RITZ_REFUSE_IF(fit->chosen < 0, RITZ_ERR_CONVERGENCE, "%s", fit->why);
    chosen = &fit->candidate[fit->chosen];
    if (fit->runner_up >= 0)
        record_candidate(f, &fit->candidate[fit->runner_up], false, true, NULL);
    record_candidate(f, chosen, true, false, fit->why);
    RITZ_CHECK(f->recorded);
    if (full)
        warn_of_ports(run, &full->component, chosen);
    RITZ_CHECK(write_result(f, fitter, chosen));
    return f->given->report ? cli_table_save(&run->said, f->given->report)
                            : RITZ_OK;
}

/* Search, print and record the result, and write it; if a signal ends that,
   write the best so far. Nothing is written if nothing meets the tolerance. */
static ritz_status find_smallest(fit_run *f, const model *full,
                                 ritz_fitter *fitter)
{
    RITZ_OWN(ritz_fit) fit = {0};
    ritz_status status = RITZ_OK;

    f->limits = ritz_fitter_tolerance(fitter);
    cli_interruptible();
    RITZ_CHECK(ritz_fitter_search(fitter, &fit));
    say_fit(f->run, fitter, &fit);
    if (!fit.interrupted)
        status = conclude_search(f, full, fitter, &fit);
    /* the best candidate is kept if the signal stopped the search or the
       ordering of columns, but not after another failure, such as a full
       disk */
    if (fit.interrupted ||
        (status == RITZ_ERR_CONVERGENCE && cli_interrupted()))
        return keep_best(f, fitter, &fit);
    return status;
}

/* Read a component or, into @p scene, a scene, and prepare the search. */
static ritz_status fit_input(fit_run *f, ritz_scene *scene)
{
    const char *path = f->run->operand[0];
    const fit_options *given = f->given;
    const bool component = ritz_container_seems(path);
    RITZ_OWN(ritz_fitter) *fitter = NULL;
    RITZ_OWN(model) full = {0};

    if (component) {
        RITZ_REFUSE_IF(given->prefix, RITZ_ERR_ARGUMENT,
                       "'%s' is a component: --components is for scenes", path);
        RITZ_CHECK(model_read(f->run, path, MODEL_COMPONENT, &full));
        RITZ_CHECK_IN(path, model_tune(&full, &given->damper));
    } else {
        RITZ_REFUSE_IF(
            given->damper.count > 0 || given->request.attach, RITZ_ERR_ARGUMENT,
            "'%s' is a scene: --damper and --attach are for components", path);
        RITZ_CHECK(model_scene(f->run, path, scene));
        f->scene = scene;
        RITZ_CHECK(model_foresee_bodies(given->prefix, scene));
    }
    if (*scene->name)
        snprintf(f->subject, sizeof f->subject, "%s", scene->name);
    RITZ_CHECK_IN(
        path, component
                  ? ritz_fitter_new(&full.component, &given->request, &fitter)
                  : ritz_fitter_scene(scene, &given->request, &fitter));
    return find_smallest(f, component ? &full : NULL, fitter);
}

ritz_status fit_search(cli_run *run, fit_options *given)
{
    RITZ_OWN(ritz_scene) scene = {0};
    fit_run f = {.run = run, .given = given};
    const char *slash = strrchr(*run->operand, '/');

    take_options(run->program, given);
    if (run->record) /* otherwise fewer costs need to be measured */
        given->request.observe = observe_candidate;
    given->request.stop = cli_stop;
    given->request.thorough = given->all;
    given->request.context = &f;
    /* charts call it by its file, without folder and ending */
    snprintf(f.subject, sizeof f.subject, "%s",
             slash ? slash + 1 : *run->operand);
    if (strrchr(f.subject, '.'))
        *strrchr(f.subject, '.') = '\0';
    if (given->damping)
        RITZ_CHECK_IN("--damping",
                      ritz_damping_parse(given->damping,
                                         &given->request.tolerance.damping));
    return fit_input(&f, &scene);
}
