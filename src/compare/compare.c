/*
 * COMPARE [LeeTsuha1992]. Stage one: each body in its component modes, the
 * system at every configuration, the modes that matter there. Stage two: the
 * composite of those modes over all configurations, augmented by static
 * corrections, projected on each body; the bodies reassembled.
 *
 * A mode Phi_k kept at an angle is in the space of the second system at that
 * angle, for its projections on the bodies are compatible, so that
 * Rayleigh-Ritz returns it up to rounding; tests/unit/compare/test_compare.c
 * holds the code to it.
 */
#include "compare/compare.h"

#include "assembly/assembly.h"
#include "base/alloc.h"
#include "base/team.h"
#include "base/tolerances.h"
#include "linear/blas_threads.h"
#include "model/squares.h"

#include <ritz/base.h>

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The sweep in which alone two configurations differ, -1 if there is none. */
static int64_t find_sweep(int64_t sweeps, const double *a, const double *b)
{
    int64_t one = -1;

    for (int64_t k = 0; k < sweeps; k++)
        if (a[k] != b[k]) {
            if (one >= 0)
                return -1;
            one = k;
        }
    return one;
}

/* Append a row at these settings. */
static ritz_status add_row(const ritz_scene *scene, const double *setting,
                           bool listed, ritz_comparison *c)
{
    ritz_compare_row *row = &c->row[c->num_rows++];

    row->listed = listed;
    RITZ_CHECK_COPY(row->setting, setting, scene->num_sweeps);
    return RITZ_OK;
}

/* Append a row half way between two settings of one sweep. */
static ritz_status add_between(const ritz_scene *scene, const double *from,
                               int64_t sweep, double to, ritz_comparison *c)
{
    RITZ_CHECK(add_row(scene, from, false, c));
    c->row[c->num_rows - 1].setting[sweep] = 0.5 * (from[sweep] + to);
    return RITZ_OK;
}

/*
 * Rows half way between neighbours of the list. Where a joint turns on by the
 * same step round the full circle, also between its last and first angle.
 */
static ritz_status list_halfway(const ritz_scene *scene, ritz_comparison *c)
{
    int64_t h = scene->num_sweeps;
    int64_t count = scene->num_configurations;
    const double *first = scene->setting;
    const double *last = scene->setting + (count - 1) * h;
    int64_t sweep = -1;

    for (int64_t k = 0; k + 1 < count; k++) {
        const double *a = scene->setting + k * h;

        sweep = find_sweep(h, a, a + h);
        if (sweep >= 0)
            RITZ_CHECK(add_between(scene, a, sweep, a[h + sweep], c));
    }
    sweep = count > 2 ? find_sweep(h, first, last) : -1;
    if (sweep >= 0 && scene->sweep[sweep].turns) {
        double step = first[h + sweep] - first[sweep];

        if (fabs(last[sweep] + step - first[sweep] - 360.0) < RITZ_SAME)
            RITZ_CHECK(add_between(scene, last, sweep, last[sweep] + step, c));
    }
    return RITZ_OK;
}

/* Listed configurations, then those half way between neighbours. */
static ritz_status list_rows(const ritz_scene *scene, ritz_comparison *c)
{
    RITZ_REFUSE_IF(scene->num_configurations < 1, RITZ_ERR_ARGUMENT,
                   "the scene has no configuration");
    RITZ_CHECK_NEW(c->row, 2 * scene->num_configurations);
    for (int64_t k = 0; k < scene->num_configurations; k++)
        RITZ_CHECK(
            add_row(scene, scene->setting + k * scene->num_sweeps, true, c));
    return list_halfway(scene, c);
}

/* Errors of a configuration, as the files of stage two record them. */
static const struct {
    const char *name;
    size_t offset; /* in ritz_compare_row */
    const char *where;
    bool of_bodies; /* the largest is recorded with every body too */
} errors[] = {
    {"stage1-frequency-relative", offsetof(ritz_compare_row, frequency_error),
     "kept modes against the stage-1 system", true},
    {"stage1-mac", offsetof(ritz_compare_row, mac),
     "kept modes against the stage-1 system", false},
    {"stage1-rigid-hertz", offsetof(ritz_compare_row, rigid_error), "", false},
    {"stage1-static-gain-relative", offsetof(ritz_compare_row, gain_error), "",
     true},
    {"stage1-moments-relative", offsetof(ritz_compare_row, moment_error), "",
     false},
    {"stage1-response-relative", offsetof(ritz_compare_row, response_error), "",
     true},
    {"stage1-damping-relative", offsetof(ritz_compare_row, damping_error),
     "kept modes against the stage-1 system", true},
};

enum { NUM_ERRORS = sizeof errors / sizeof *errors };

static double read_error(const ritz_compare_row *row, size_t offset)
{
    return *(const double *)((const char *)row + offset);
}

/* Append an error, unless it is NaN, which means that it was not computed. */
static ritz_status add_error(ritz_measures *to, int k, double value,
                             double limit, const char *where)
{
    return isnan(value)
               ? RITZ_OK
               : ritz_measures_add(to, errors[k].name, value, limit, where);
}

/* Record the errors of one configuration. */
static ritz_status record_row(const ritz_compare_row *row, ritz_measures *to)
{
    for (int k = 0; k < NUM_ERRORS; k++)
        RITZ_CHECK(add_error(to, k, read_error(row, errors[k].offset),
                             k == 0 ? row->allowed : nan(""), errors[k].where));
    return RITZ_OK;
}

/* Record the largest error over all listed configurations for every body. */
static ritz_status record_bodies(int k, ritz_comparison *out)
{
    double largest = nan(""); /* fmax ignores NaN */

    for (int64_t i = 0; i < out->num_rows; i++)
        if (out->row[i].listed)
            largest = fmax(largest, read_error(&out->row[i], errors[k].offset));
    for (int64_t c = 0; c < out->second.count; c++)
        RITZ_CHECK(add_error(&out->second.body[c].errors, k, largest, nan(""),
                             "worst listed angle, against stage 1"));
    return RITZ_OK;
}

/* Record errors with the second system and with every body. */
static ritz_status record_comparison(ritz_comparison *comparison)
{
    for (int64_t k = 0; k < comparison->second_system.num_configurations; k++)
        RITZ_CHECK(
            record_row(&comparison->row[k],
                       &comparison->second_system.configuration[k].errors));
    for (int k = 0; k < NUM_ERRORS; k++)
        if (errors[k].of_bodies)
            RITZ_CHECK(record_bodies(k, comparison));
    return RITZ_OK;
}

/* Stage two by one plan, and by each composite tolerance in turn. */

/* Forces of a scene, and the indices of those that stage two is built with. */
typedef struct planning {
    ritz_unit_forces forces;
    int64_t *force;
    ritz_plan plan;
} planning;

static void planning_free(planning *p)
{
    ritz_unit_forces_free(&p->forces);
    free(p->force);
}

/* The plan that the scene states; with `auto`, the set is still to be
   chosen. */
static ritz_status make_plan(const ritz_stage *stage, planning *out)
{
    static const int implied[] = {
        [RITZ_AUGMENT_NONE] = 0,
        [RITZ_AUGMENT_SYSTEM] = RITZ_ATTACHED_INPUTS,
        [RITZ_AUGMENT_COMPONENT] =
            RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_INTERFACE,
    };
    const ritz_scene *scene = stage->scene;
    bool stated = scene->attached != 0 || scene->num_attached_forces > 0;
    int dampers =
        scene->augment != RITZ_AUGMENT_NONE && ritz_stage_is_damped(stage)
            ? RITZ_ATTACHED_DAMPERS
            : 0;

    out->plan = (ritz_plan){.tolerance = scene->composite_tolerance,
                            .augment = scene->augment,
                            .sets = stated ? scene->attached
                                           : implied[scene->augment] | dampers,
                            .forces = &out->forces};
    RITZ_CHECK(ritz_unit_forces_new(stage, &out->forces));
    RITZ_CHECK(ritz_unit_forces_select(&out->forces, out->plan.sets, true,
                                       &out->plan.count, &out->force));
    out->plan.force = out->force;
    return RITZ_OK;
}

/* Build stage two by a plan: bodies reduced by their V, compacted if the scene
   says so, and the second system at listed configurations. */
static ritz_status try_plan(ritz_rows *rows, const ritz_plan *plan,
                            ritz_comparison *out)
{
    RITZ_OWN(ritz_subspaces) subspaces = {0};

    RITZ_CHECK_IN("composite modes",
                  ritz_compare_composite(rows, plan, &subspaces));
    if (rows->stage->scene->extraneous == RITZ_EXTRANEOUS_COMPACT)
        RITZ_CHECK_IN("compact", ritz_compact(rows, &subspaces, out));
    RITZ_CHECK_IN("stage 2",
                  ritz_compare_project(rows->stage, &subspaces, out));
    return ritz_context(ritz_assemble(&out->second, NULL, &out->second_system),
                        "stage 2");
}

/* Stage two at one tolerance, and its largest errors at all rows. */
static ritz_status try_tolerance(ritz_rows *rows, const ritz_plan *plan,
                                 ritz_tolerance_row *out)
{
    RITZ_OWN(ritz_comparison) trial = {0};

    out->tolerance = plan->tolerance;
    out->frequency_error = out->gain_error = nan("");
    out->response_error = out->damping_error = nan("");
    RITZ_CHECK(try_plan(rows, plan, &trial));
    RITZ_CHECK(ritz_compare_orders(&trial, &out->order, &out->total));
    out->removed = trial.removed;
    for (int64_t k = 0; k < rows->num_rows; k++) {
        ritz_compare_row row = {0};
        ritz_status status = ritz_rows_measure(
            rows, k, trial.V, &trial.second_system.configuration[k], &row);

        free(row.stray);
        RITZ_CHECK(status);
        out->largest = row.order > out->largest ? row.order : out->largest;
        out->frequency_error = fmax(out->frequency_error, row.frequency_error);
        out->gain_error = fmax(out->gain_error, row.gain_error);
        out->response_error = fmax(out->response_error, row.response_error);
        out->damping_error = fmax(out->damping_error, row.damping_error);
    }
    return RITZ_OK;
}

static ritz_status try_tolerances(const ritz_stage *stage,
                                  const ritz_comparison *comparison,
                                  int64_t count, const double *tolerance,
                                  ritz_tolerance_row *out)
{
    RITZ_OWN(planning) p = {0};
    RITZ_OWN(ritz_rows)
    rows = {
        .stage = stage,
        .listed = &comparison->first_system,
        .num_rows = comparison->first_system.num_configurations,
        .row = comparison->row,
    };

    RITZ_CHECK(ritz_rows_respond(&rows));
    RITZ_CHECK(make_plan(stage, &p));
    for (int64_t k = 0; k < comparison->num_candidates; k++)
        if (comparison->candidate[k].chosen) {
            p.plan.count = comparison->candidate[k].num_forces;
            p.plan.force = comparison->candidate[k].force;
        }
    for (int64_t k = 0; k < count; k++) {
        RITZ_REFUSE_IF(
            !(tolerance[k] > 0.0 && tolerance[k] < 1.0), RITZ_ERR_ARGUMENT,
            "the composite tolerance %g is not between 0 and 1", tolerance[k]);
        ritz_monitor_step("tolerances", k, count);
        p.plan.tolerance = tolerance[k];
        RITZ_CHECK(try_tolerance(&rows, &p.plan, &out[k]));
    }
    return RITZ_OK;
}

ritz_status ritz_compare_tolerances(const ritz_stage *stage,
                                    const ritz_comparison *comparison,
                                    int64_t count, const double *tolerance,
                                    ritz_tolerance_row **out)
{
    [[maybe_unused]] RITZ_OWN(ritz_blas_single) single = ritz_blas_single_new();
    ritz_tolerance_row *made = NULL;
    ritz_status status = RITZ_OK;

    RITZ_CHECK_NEW(made, count);
    status = try_tolerances(stage, comparison, count, tolerance, made);
    if (status == RITZ_OK)
        RITZ_MOVE(*out, made);
    ritz_tolerances_free(count, &made);
    return status;
}

void ritz_tolerances_free(int64_t count, ritz_tolerance_row **rows)
{
    for (int64_t k = 0; *rows && k < count; k++)
        free((*rows)[k].order);
    free(*rows);
    *rows = NULL;
}

/* Both stages. */

/* Drop the last rows, so that @p count are left. */
static void drop_rows(int64_t count, ritz_comparison *c)
{
    for (int64_t k = count; k < c->num_rows; k++)
        RITZ_FREE(c->row[k].setting, c->row[k].kept, c->row[k].stray);
    c->num_rows = count < c->num_rows ? count : c->num_rows;
}

/* Drop the last configurations of a system, so that @p count are left. */
static void drop_configurations(int64_t count, ritz_system *system)
{
    for (int64_t k = count; k < system->num_configurations; k++)
        ritz_configuration_free(&system->configuration[k]);
    if (count < system->num_configurations)
        system->num_configurations = count;
}

/* Rows that are worked on in rounds, some at once. */
typedef struct rounds {
    const char *step;
    const ritz_stop *stop;
    int64_t first, to; /* all rows */
    int64_t from;      /* first row of the next round */
    int64_t most;      /* rows of a round */
    bool stopped;
} rounds;

/* Show the step of each row of a round, which ends before a row at which a stop
   is asked for. @return the row behind the round */
static int64_t begin_round(rounds *r)
{
    int64_t k = r->from;

    for (; k < r->to && k < r->from + r->most; k++) {
        r->stopped = k > 0 && ritz_stop_asked(r->stop);
        if (r->stopped)
            break;
        ritz_monitor_step(r->step, k - r->first, r->to - r->first);
    }
    return k;
}

/* Assemble the stage-1 system half way between listed configurations. If that
   is stopped, rows of those that are not assembled are dropped. */
static ritz_status assemble_between(const ritz_stop *stop, ritz_rows *rows,
                                    ritz_comparison *c)
{
    const int64_t listed = rows->listed->num_configurations;
    const int64_t most = ritz_stage_round(rows->stage);
    ritz_system *between = &rows->between;
    RITZ_OWN_ARRAY const double **setting = NULL;
    rounds r = {.step = "configuration between",
                .stop = stop,
                .first = listed,
                .to = rows->num_rows,
                .most = most};

    RITZ_CHECK_NEW(setting, most);
    RITZ_CHECK_NEW(between->configuration, rows->num_rows - listed);
    for (int64_t k = listed; k < rows->num_rows;) {
        const int64_t first = k;

        r.from = first;
        k = begin_round(&r);
        for (int64_t i = first; i < k; i++)
            setting[i - first] = rows->row[i].setting;
        between->num_configurations = k - listed;
        RITZ_CHECK(
            ritz_stage_assemble_some(rows->stage, k - first, setting,
                                     &between->configuration[first - listed]));
        if (r.stopped) {
            c->interrupted = true;
            drop_rows(k, c);
            rows->num_rows = k;
        }
    }
    return RITZ_OK;
}

/* Modes that are chosen at rows. */
typedef struct choosing {
    const ritz_rows *rows;
    double least;
} choosing;

static ritz_status choose_item(int64_t k, void *task)
{
    const choosing *c = task;

    return ritz_compare_select(c->rows->stage->scene,
                               ritz_rows_first(c->rows, k), c->least,
                               &c->rows->row[k]);
}

/*
 * Choose the modes that matter; between listed angles those that would be
 * chosen there.
 */
static ritz_status choose_modes(const ritz_rows *rows)
{
    choosing c = {rows, 0.0};

    RITZ_CHECK(ritz_compare_threshold(rows->stage, rows->listed, &c.least));
    return ritz_team_try(ritz_stage_threads(rows->stage, rows->num_rows),
                         rows->num_rows, choose_item, &c);
}

/* Rows of a round that are measured. */
typedef struct measuring {
    const ritz_rows *rows;
    ritz_comparison *c;
    int64_t from; /* the first of them */
} measuring;

/* The errors of a row, by one of the threads. */
static ritz_status measure_item(int64_t k, void *task)
{
    const measuring *m = task;
    const ritz_rows *rows = m->rows;
    ritz_comparison *c = m->c;
    const int64_t i = m->from + k;
    ritz_compare_row *row = &rows->row[i];
    RITZ_OWN(ritz_configuration) second = {0};

    if (!row->listed)
        RITZ_CHECK(ritz_stage_assemble(&c->second, row->setting, &second));
    return ritz_compare_measure(
        rows->stage, c->V, ritz_rows_first(rows, i),
        row->listed && rows->response ? &rows->response[i] : NULL,
        row->listed ? &c->second_system.configuration[i] : &second, row);
}

/*
 * Measure the errors of every row; between angles the second system is
 * assembled for it. If that is stopped, configurations whose errors are not
 * measured are dropped, from both systems too.
 */
static ritz_status measure_rows(const ritz_rows *rows, const ritz_stop *stop,
                                ritz_comparison *c)
{
    rounds r = {.step = "errors",
                .stop = stop,
                .to = rows->num_rows,
                .most = ritz_stage_round(rows->stage)};

    while (r.from < rows->num_rows && !r.stopped) {
        const int64_t k = begin_round(&r);
        measuring m = {rows, c, r.from};

        RITZ_CHECK(ritz_team_try(ritz_stage_threads(rows->stage, k - r.from),
                                 k - r.from, measure_item, &m));
        r.from = k;
    }
    if (!r.stopped)
        return RITZ_OK;
    c->interrupted = true;
    drop_rows(r.from, c);
    drop_configurations(r.from, &c->first_system);
    drop_configurations(r.from, &c->second_system);
    return RITZ_OK;
}

/* Build stage two as planned and move it into the result. */
static ritz_status reduce_bodies(ritz_rows *rows, ritz_comparison *c)
{
    RITZ_OWN(planning) p = {0};
    RITZ_OWN_ARRAY int64_t *chosen = NULL;

    RITZ_CHECK(make_plan(rows->stage, &p));
    RITZ_CHECK_IN("attached dofs",
                  ritz_attached_choose(rows, &p.plan, c, &chosen));
    return try_plan(rows, &p.plan, c);
}

/* Refuse bodies that are joined by interface forces, with the number of
   negative squares that these leave at the first configuration: such systems
   have no modes to choose from. */
static ritz_status refuse_forces(const ritz_stage *stage)
{
    RITZ_OWN(ritz_system) system = {0};
    const ritz_measure *negative = NULL;
    char count[2 * RITZ_NAME_SIZE + 64];

    if (!ritz_dual_is_due(stage))
        return RITZ_OK;
    RITZ_CHECK_IN("stage 1", ritz_assemble(stage, NULL, &system));
    negative = ritz_measures_find(&system.configuration[0].errors,
                                  RITZ_NEGATIVE_SQUARES);
    (void)snprintf(
        count, sizeof count, "%.0f negative squares of interface forces, %s",
        negative ? negative->value : 0.0, negative ? negative->where : "");
    return ritz_context(ritz_dual_refuse(stage), count);
}

/* A stage with only the first configurations of its scene. All but `reference`
   is borrowed. */
typedef struct beginning {
    ritz_scene scene;
    ritz_stage stage;
    int64_t *reference; /* reference configurations among the first */
} beginning;

static void beginning_free(beginning *b)
{
    free(b->reference);
}

/* If none of the scene's reference configurations is among the first `count`,
   all of these are reference configurations. */
static ritz_status take_beginning(const ritz_stage *stage, int64_t count,
                                  beginning *b)
{
    const ritz_scene *scene = stage->scene;

    b->scene = *scene;
    b->stage = *stage;
    b->stage.scene = &b->scene;
    b->scene.num_configurations = count;
    b->scene.num_reference = 0;
    RITZ_CHECK_NEW(b->reference, scene->num_reference);
    for (int64_t k = 0; k < scene->num_reference; k++)
        if (scene->reference[k] < count)
            b->reference[b->scene.num_reference++] = scene->reference[k];
    b->scene.reference = b->reference;
    return RITZ_OK;
}

/* Stage two and the errors, at the configurations that stage one assembled. */
static ritz_status compare_stages(const ritz_stage *stage,
                                  const ritz_stop *stop, ritz_comparison *c)
{
    RITZ_OWN(ritz_rows)
    rows = {.stage = stage,
            .listed = &c->first_system,
            .num_rows = c->num_rows,
            .row = c->row};

    RITZ_CHECK_IN("stage 1", assemble_between(stop, &rows, c));
    RITZ_CHECK_IN("selection", choose_modes(&rows));
    RITZ_CHECK(reduce_bodies(&rows, c));
    /* after a stop in stage one, all of its errors are measured */
    RITZ_CHECK_IN("errors",
                  measure_rows(&rows, c->interrupted ? NULL : stop, c));
    ritz_compare_suggest(c, &c->suggestion);
    return record_comparison(c);
}

ritz_status ritz_compare_until(const ritz_stage *stage, const ritz_stop *stop,
                               ritz_comparison *out)
{
    [[maybe_unused]] RITZ_OWN(ritz_blas_single) single = ritz_blas_single_new();
    RITZ_OWN(beginning) b = {0};
    RITZ_OWN(ritz_comparison) c = {.next_drop = nan("")};

    RITZ_CHECK(refuse_forces(stage));
    RITZ_CHECK(ritz_spin_refuse(stage->scene));
    RITZ_CHECK(list_rows(stage->scene, &c));
    RITZ_CHECK_IN("stage 1", ritz_assemble_until(stage, stop, &c.first_system));
    c.num_composed = c.first_system.num_configurations;
    RITZ_CHECK(take_beginning(stage, c.num_composed, &b));
    if (c.num_composed < stage->scene->num_configurations) {
        c.interrupted = true;
        drop_rows(c.num_composed, &c);
        stop = NULL;
    }
    RITZ_CHECK(compare_stages(&b.stage, stop, &c));
    c.second.scene = stage->scene;
    RITZ_MOVE(*out, c);
    return RITZ_OK;
}

ritz_status ritz_compare(const ritz_stage *stage, ritz_comparison *out)
{
    return ritz_compare_until(stage, NULL, out);
}

void ritz_comparison_free(ritz_comparison *comparison)
{
    for (int64_t k = 0; comparison->row && k < comparison->num_rows; k++)
        RITZ_FREE(comparison->row[k].setting, comparison->row[k].kept,
                  comparison->row[k].stray);
    RITZ_FREE_EACH(ritz_dense, comparison->num_bodies, comparison->V);
    RITZ_FREE_EACH(ritz_candidate, comparison->num_candidates,
                   comparison->candidate);
    free(comparison->row);
    ritz_stage_free(&comparison->second);
    ritz_system_free(&comparison->first_system);
    ritz_system_free(&comparison->second_system);
    *comparison = (ritz_comparison){0};
}
