#include "print/print.h"

#include "base/text.h"
#include "model/floating.h"

#include <inttypes.h>
#include <stdio.h>

/* All that is open while times go by. */
typedef struct recovery {
    cli_run *run;
    const recover_options *given;
    model source; /* a time response of ours; of other histories empty */
    model system;
    model body;
    ritz_dense V; /* q = V x; {0}: the history has q */
    bool floats;  /* x is relative to the rigid motion of a frame */
    bool turned;  /* a joint turned the body during the run */
    ritz_damping damping;
    ritz_recoverer rules;
    ritz_recovered peaks;
    ritz_history history;
    ritz_moving moving;
    ritz_series series;
    double *y; /* rows of the largest quantity */
} recovery;

static void recovery_free(recovery *r)
{
    ritz_series_free(&r->series);
    ritz_moving_free(&r->moving);
    ritz_history_free(&r->history);
    ritz_recovered_free(&r->peaks);
    ritz_recoverer_free(&r->rules);
    ritz_dense_free(&r->V);
    free(r->y);
    model_free(&r->body);
    model_free(&r->system);
    model_free(&r->source);
}

/* ---- what is read ------------------------------------------------------- */

/* Whether the history has the coordinates of the bodies of a scene. */
static bool has_bodies(const recovery *r)
{
    return r->source.kind == MODEL_SIMULATION &&
           r->source.simulation.num_blocks > 0;
}

/* Name what turns the body; mode acceleration leaves out the forces of that
   rotation, which the equations of motion contain. NULL: nothing turns it. */
static const char *find_turning(const recovery *r)
{
    if (r->turned)
        return "the joint of --sweep";
    if (r->source.kind == MODEL_SIMULATION && *r->source.simulation.spin)
        return r->source.simulation.spin;
    return r->system.kind == MODEL_SYSTEM && *r->system.system.spin
               ? r->system.system.spin
               : NULL;
}

static ritz_status find_body(int64_t count, const ritz_block *block,
                             const char *name, int64_t *out)
{
    const ritz_names bodies = {"body", count, (const char *)block,
                               sizeof *block};

    return ritz_words_find(&bodies, name, out);
}

/* A body of a history that has the coordinates of all bodies must be the
   component, and that of the system. */
static ritz_status check_body(recovery *r)
{
    const recover_options *given = r->given;
    const ritz_simulation *s = &r->source.simulation;
    const ritz_system *system = &r->system.system;
    int64_t k = 0, i = 0;

    if (!given->body)
        return RITZ_OK; /* refused when the history is opened */
    RITZ_CHECK_IN(r->run->operand[0],
                  find_body(s->num_blocks, s->block, given->body, &k));
    RITZ_REFUSE_IF(
        s->block[k].order_full != r->body.reduced.num_dofs, RITZ_ERR_ARGUMENT,
        "'%s' has %" PRId64 " dofs in '%s' and %" PRId64 " in its file",
        given->body, s->block[k].order_full, r->run->operand[0],
        r->body.reduced.num_dofs);
    r->turned = s->block[k].turns;
    if (!given->system)
        return RITZ_OK;
    RITZ_CHECK(model_read(r->run, given->system, MODEL_SYSTEM, &r->system));
    RITZ_CHECK_IN(given->system, find_body(system->num_components,
                                           system->component, given->body, &i));
    RITZ_REFUSE_IF(
        system->component[i].order != s->block[k].order, RITZ_ERR_ARGUMENT,
        "'%s' has %" PRId64 " coordinates in '%s' and %" PRId64 " in '%s'",
        given->body, s->block[k].order, r->run->operand[0],
        system->component[i].order, given->system);
    return RITZ_OK;
}

/* The coordinates of a body of a system: q = P x. */
static ritz_status take_system(recovery *r)
{
    const recover_options *given = r->given;
    const ritz_system *system = &r->system.system;
    int64_t k = 0;

    RITZ_CHECK(model_read(r->run, given->system, MODEL_SYSTEM, &r->system));
    RITZ_CHECK(model_at(&r->system, given->system, given->model.at));
    RITZ_CHECK_IN(given->system, find_body(system->num_components,
                                           system->component, given->body, &k));
    RITZ_REFUSE_IF(
        r->system.at->P[k].nrow != r->body.reduced.K.ncol, RITZ_ERR_ARGUMENT,
        "'%s' has %ld coordinates in '%s' and %ld in its file", given->body,
        r->system.at->P[k].nrow, given->system, r->body.reduced.K.ncol);
    return ritz_dense_copy(&r->system.at->P[k], &r->V);
}

/* Modes of the component with the springs of its dampers, as an FMU has
   them. */
static ritz_status take_modes(recovery *r)
{
    const ritz_reduced *reduced = &r->body.reduced;
    RITZ_OWN(ritz_reduced) whole = {0};
    RITZ_OWN(ritz_dense) same = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_dense_identity(reduced->K.ncol, &same));
    RITZ_CHECK(ritz_reduced_project(reduced, &same, &whole));
    RITZ_CHECK(ritz_reduced_install(&whole));
    RITZ_CHECK(ritz_eigen_dense(&whole.K, &whole.M, &pairs));
    RITZ_MOVE(r->V, pairs.Phi);
    return RITZ_OK;
}

/* Modes beside a floating frame, as Exudyn and MBDyn get them. */
static ritz_status take_floating(recovery *r)
{
    const ritz_floating_request request = {r->given->frame,
                                           r->given->reference};
    RITZ_OWN(ritz_floating) body = {0};

    RITZ_CHECK_IN(r->given->component,
                  ritz_floating_of(&r->body.reduced, &request, &body));
    r->floats = body.num_rigid > 0;
    RITZ_MOVE(r->V, body.U);
    return RITZ_OK;
}

static bool is_floating(const recover_options *given)
{
    return given->transform && strcmp(given->transform, "floating") == 0;
}

/* Modes of the component, or a matrix of a file. */
static ritz_status take_transform(recovery *r)
{
    const ritz_reduced *reduced = &r->body.reduced;
    RITZ_OWN(ritz_matrix) matrix = {0};
    RITZ_OWN(ritz_file_sums) sums = {0};
    const ritz_wanted wanted = {r->given->transform, NULL, &matrix};

    if (strcmp(r->given->transform, "modes") == 0)
        return take_modes(r);
    if (is_floating(r->given))
        return take_floating(r);
    RITZ_CHECK_IN("--transform", ritz_foreign_collect(1, &wanted, &sums));
    for (int64_t k = 0; k < sums.count; k++) {
        RITZ_CHECK(cli_input_unread(r->run, sums.sum[k].path));
        cli_input_sum(r->run, sums.sum[k].path, sums.sum[k].digest);
    }
    RITZ_REFUSE_IF(matrix.A.nrow != reduced->K.ncol || matrix.imaginary,
                   RITZ_ERR_ARGUMENT,
                   "--transform '%s' is no real matrix of %ld rows, one for "
                   "each coordinate of the component",
                   r->given->transform, reduced->K.ncol);
    return ritz_sparse_dense(&matrix.A, &r->V);
}

/* The damping that acted: that of the time response, unless another is given.
   Ratios of a system's modes are none of its bodies' modes. */
static ritz_status take_damping(recovery *r)
{
    const char *text = r->given->model.damping;

    if (!text && r->source.kind == MODEL_SIMULATION)
        text = r->source.simulation.damping;
    RITZ_CHECK(model_damping(&r->body, text, &r->damping));
    if (r->given->body && ritz_damping_has_ratios(&r->damping))
        r->damping = (ritz_damping){0};
    return RITZ_OK;
}

static ritz_status read_models(recovery *r)
{
    cli_run *run = r->run;
    const recover_options *given = r->given;
    const char *path = run->operand[0];

    if (ritz_container_seems(path))
        RITZ_CHECK(model_read(run, path, MODEL_SIMULATION, &r->source));
    else
        RITZ_CHECK(cli_input(run, path));
    if (!given->system && given->body && !has_bodies(r))
        cli_refuse(run->program, "--system and --body belong together");
    RITZ_CHECK(model_read(run, given->component, MODEL_REDUCED, &r->body));
    RITZ_CHECK(model_prefix(&r->body, given->component, given->model.order));
    RITZ_CHECK_IN(given->component, model_tune(&r->body, &given->model.damper));
    if (has_bodies(r))
        RITZ_CHECK(check_body(r));
    else if (given->system)
        RITZ_CHECK(take_system(r));
    if (given->transform)
        RITZ_CHECK(take_transform(r));
    return take_damping(r);
}

static ritz_status open_history(recovery *r)
{
    const recover_options *given = r->given;
    const ritz_reduced *reduced = &r->body.reduced;
    const ritz_history_request request = {
        .order = r->V.val ? r->V.ncol : reduced->K.ncol,
        .V = r->V.val ? &r->V : NULL,
        .num_inputs = reduced->io.num_inputs,
        .input = (const char(*)[RITZ_NAME_SIZE])reduced->io.input,
        .q = given->q,
        .v = given->v,
        .a = given->a,
        .f = given->f,
        .unforced = given->body != NULL,
        .floating = is_floating(given),
        .step = given->step,
        .label = given->label,
        .body = has_bodies(r) ? given->body : NULL,
    };

    if (r->source.kind == MODEL_SIMULATION)
        return ritz_context(ritz_history_of_simulation(&r->source.simulation,
                                                       &request, &r->history),
                            r->run->operand[0]);
    return ritz_history_open(r->run->operand[0], &request, &r->history);
}

/* Whether the history and the component allow mode acceleration. Accelerations
   relative to a frame lack those of the frame. */
static bool can_accelerate(const recovery *r)
{
    const ritz_reduced *reduced = &r->body.reduced;
    const ritz_history *h = &r->history;
    bool any = false;

    for (int64_t k = 0; k < reduced->num_quantities; k++)
        any = any || reduced->quantity[k].Q.val;
    return any && !r->floats && !find_turning(r) && h->has_v && h->has_a &&
           (h->has_f || h->unforced || reduced->io.num_inputs == 0);
}

static ritz_status make_rules(recovery *r)
{
    const ritz_reduced *reduced = &r->body.reduced;
    const char *modes = r->given->modes;
    bool acceleration =
        modes ? strcmp(modes, "acceleration") == 0 : can_accelerate(r);
    int64_t rows = 0;

    RITZ_REFUSE_IF(reduced->num_quantities == 0 && !r->run->output,
                   RITZ_ERR_ARGUMENT,
                   "it has no quantities to recover: ritz-import --recovery "
                   "adds them");
    RITZ_REFUSE_IF(acceleration && find_turning(r), RITZ_ERR_ARGUMENT,
                   "mode acceleration leaves out the inertia forces of a body "
                   "that turns, here by %s: give --modes displacement",
                   find_turning(r));
    RITZ_CHECK(
        ritz_recoverer_new(reduced, &r->damping, acceleration, &r->rules));
    RITZ_CHECK(ritz_recovered_new(&r->rules, &r->peaks));
    for (int64_t k = 0; k < reduced->num_quantities; k++)
        if (reduced->quantity[k].count > rows)
            rows = reduced->quantity[k].count;
    RITZ_CHECK_NEW(r->y, rows);
    return RITZ_OK;
}

static ritz_status begin_series(recovery *r)
{
    const ritz_series_format *format = NULL;

    if (!r->run->output)
        return RITZ_OK;
    for (const ritz_series_format *const *f = ritz_series_formats; *f; f++)
        format = strcmp((*f)->name, r->given->to) == 0 ? *f : format;
    RITZ_CHECK_IN(r->given->component,
                  ritz_moving_new(&r->body.reduced, &r->moving));
    return ritz_series_begin(format, r->run->output, &r->moving,
                             cli_stamp(r->run), &r->series);
}

/* ---- time by time ------------------------------------------------------- */

static ritz_status recover_time(recovery *r, const ritz_instant *now)
{
    const bool pictured =
        r->series.format && r->peaks.count % r->given->every == 0;

    RITZ_CHECK_IN(r->run->operand[0], ritz_recoverer_check(&r->rules, now));
    if (pictured)
        ritz_moving_to(&r->moving, now->q);
    for (int64_t k = 0; k < r->rules.count; k++) {
        ritz_recoverer_rows(&r->rules, k, now, r->y);
        RITZ_CHECK_IN(r->run->operand[0],
                      ritz_recovered_note(k, now->seconds, r->y, &r->peaks));
        if (pictured)
            ritz_moving_paint(&r->moving, k, r->y);
    }
    ritz_recovered_step(now->seconds, &r->peaks);
    return pictured
               ? ritz_series_frame(&r->series, now->seconds, &r->moving.frame)
               : RITZ_OK;
}

static ritz_status recover_times(recovery *r)
{
    const int64_t total =
        r->source.kind == MODEL_SIMULATION ? r->source.simulation.count : 0;
    ritz_instant now = {0};
    bool more = true;

    cli_interruptible();
    while (!cli_interrupted()) {
        RITZ_CHECK_IN(r->run->operand[0],
                      ritz_history_next(&r->history, &now, &more));
        if (!more)
            return RITZ_OK;
        RITZ_CHECK(recover_time(r, &now));
        ritz_monitor_step("times", r->peaks.count, total);
    }
    return RITZ_OK;
}

/* ---- results ------------------------------------------------------------ */

/* @param[in] ending  put behind the names of outputs: that of files which a
   signal left incomplete, or "" */
static ritz_status write_results(recovery *r, const char *ending)
{
    const recover_options *given = r->given;
    char path[MODEL_PATH];

    if (given->maxima) {
        snprintf(path, sizeof path, "%s%s", given->maxima, ending);
        RITZ_CHECK(
            ritz_container_write_recovered(path, &r->peaks, cli_stamp(r->run)));
    }
    if (given->table) {
        snprintf(path, sizeof path, "%s%s", given->table, ending);
        RITZ_CHECK(ritz_recovered_write(path, &r->peaks, &r->body.reduced,
                                        cli_stamp(r->run)));
    }
    return r->series.format ? ritz_series_finish(&r->series, r->run->output)
                            : RITZ_OK;
}

ritz_status describe_recovered(cli_run *run, const ritz_recovered *all)
{
    sink_set(run, "begin,end", "%g %g", all->begin, all->end);
    sink_field(run, "kind", "times", "maxima over %ld times to %g s",
               all->count, all->end);
    SINK_ITEMS(run, "quantities", k, all->num_quantities) {
        const ritz_peaks *p = &all->quantity[k];
        char name[RITZ_QUANTITY_NAME_SIZE];
        int64_t most = 0;

        for (int64_t i = 1; i < p->count; i++)
            if (fabs(p->value[i]) > fabs(p->value[most]))
                most = i;
        if (p->count == 0)
            continue;
        sink_set(run, "rows,kind,by", "%ld %s %s", p->count, p->kind, p->by);
        sink_field(run, k > 0 ? "" : "largest", "name,value,where,seconds",
                   "%-20s %13.6e  %s, at %g s, by %s", p->name, p->value[most],
                   ritz_peaks_name(p, most, name), p->seconds[most], p->by);
    }
    return RITZ_OK;
}

static ritz_status say_results(recovery *r)
{
    cli_run *run = r->run;

    RITZ_CHECK(describe_recovered(run, &r->peaks));
    sink_set(run, "history", "%s",
             r->history.format ? r->history.format->name : "ritz-simulate");
    if (r->series.format)
        sink_field(run, "series", "frames,to", "%ld frames of %s",
                   r->series.count, r->series.format->name);
    if (r->series.format && r->moving.num_lost > 0)
        cli_warn(run,
                 "%ld rows are of elements that are no cell of the mesh: no "
                 "picture shows them",
                 r->moving.num_lost);
    cli_record(run, "recover", r->body.reduced.K.ncol);
    return RITZ_OK;
}

/* The times until a signal came. */
static ritz_status keep_done(recovery *r)
{
    cli_run *run = r->run;
    char what[4 * RITZ_NAME_SIZE];

    snprintf(what, sizeof what, "the history, after %" PRId64 " times",
             r->peaks.count);
    RITZ_CHECK(cli_divert(run, what));
    snprintf(run->interrupted, sizeof run->interrupted, "%s", what);
    cli_keep_outputs(run);
    RITZ_CHECK(write_results(r, ".interrupted"));
    return ritz_fail(RITZ_ERR_CONVERGENCE,
                     "interrupted: the first %" PRId64
                     " times are in files that end in .interrupted",
                     r->peaks.count);
}

static void refuse_options(const cli_program *program,
                           const recover_options *given, const cli_run *run)
{
    if (!given->component)
        cli_refuse(program, "of which component? name it by --component");
    if (!run->output && !given->maxima && !given->table)
        cli_refuse(program, "nothing to do: give -o, --maxima or --table");
    if (given->system && !given->body)
        cli_refuse(program, "--system and --body belong together");
    if (given->system && given->transform)
        cli_refuse(program, "--system and --transform, one of them");
    if ((given->frame || given->reference) && !is_floating(given))
        cli_refuse(program,
                   "--frame and --reference belong to --transform floating");
    if (given->model.at && !given->system)
        cli_refuse(program, "--at is of a system, which --system names");
}

ritz_status recover_run(cli_run *run, const recover_options *given)
{
    RITZ_OWN(recovery) r = {.run = run, .given = given};

    refuse_options(run->program, given, run);
    RITZ_CHECK(read_models(&r));
    RITZ_CHECK(open_history(&r));
    RITZ_CHECK_IN(given->component, make_rules(&r));
    RITZ_CHECK(begin_series(&r));
    RITZ_CHECK(recover_times(&r));
    RITZ_REFUSE_IF(r.peaks.count == 0 && !cli_interrupted(), RITZ_ERR_ARGUMENT,
                   "'%s' holds no times", run->operand[0]);
    if (cli_interrupted())
        return keep_done(&r);
    (void)cli_uninterruptible();
    RITZ_CHECK(write_results(&r, ""));
    return say_results(&r);
}
