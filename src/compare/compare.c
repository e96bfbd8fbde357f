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
#include "base/tolerances.h"

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

/* The plan that the scene requests; `attached` may still be AUTO. */
static ritz_plan make_plan(const ritz_stage *stage)
{
    static const int implied[] = {
        [RITZ_AUGMENT_NONE] = 0,
        [RITZ_AUGMENT_SYSTEM] = RITZ_ATTACHED_INPUTS,
        [RITZ_AUGMENT_COMPONENT] =
            RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_INTERFACE,
    };
    const ritz_scene *scene = stage->scene;
    bool stated = scene->attached != 0 || scene->num_attached_inputs > 0;
    int dampers =
        scene->augment != RITZ_AUGMENT_NONE && ritz_stage_is_damped(stage)
            ? RITZ_ATTACHED_DAMPERS
            : 0;

    return (ritz_plan){
        .tolerance = scene->composite_tolerance,
        .augment = scene->augment,
        .attached =
            stated ? scene->attached : implied[scene->augment] | dampers,
        .inputs_too = scene->num_attached_inputs > 0,
    };
}

/* Motions without mass have neither mass nor damping, but for rounding. */
static void zero_entries(int64_t massless, ritz_dense *A)
{
    for (int64_t j = 0; j < massless && A->val; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] = ritz_dense_col(A, i)[j] = 0.0;
}

/* Project the bodies on the subspaces V. */
static ritz_status project_bodies(const ritz_stage *stage,
                                  const int64_t *massless, ritz_comparison *out)
{
    RITZ_OWN(ritz_stage) made = {0};

    RITZ_CHECK_NEW(made.body, stage->count);
    made.count = stage->count;
    for (int64_t c = 0; c < stage->count; c++) {
        ritz_origin *origin = &made.body[c].origin;

        RITZ_CHECK(
            ritz_reduced_project(&stage->body[c], &out->V[c], &made.body[c]));
        zero_entries(massless[c], &made.body[c].M);
        zero_entries(massless[c], &made.body[c].D);
        for (int64_t j = 0; j < massless[c]; j++)
            made.body[c].columns.kind[j] = RITZ_COLUMN_MASSLESS;
        snprintf(origin->method, sizeof origin->method, "compare");
        snprintf(origin->reference, sizeof origin->reference, "LeeTsuha1992");
        out->removed = out->removed || out->V[c].ncol < out->V[c].nrow;
    }
    return ritz_stage_from(stage->scene, made.body, &out->second);
}

/* Stage two by a plan: bodies with their V, and the second system at listed
   configurations, of which @p out has none yet. */
static ritz_status try_plan(const ritz_rows *rows, const ritz_plan *plan,
                            ritz_comparison *out)
{
    RITZ_OWN_ARRAY int64_t *massless = NULL;

    out->num_bodies = rows->stage->count;
    RITZ_CHECK_NEW(massless, out->num_bodies);
    RITZ_CHECK_NEW(out->V, out->num_bodies);
    RITZ_CHECK_IN(
        "composite modes",
        ritz_compare_composite(rows, plan, out->V, massless, &out->composite));
    RITZ_CHECK_IN("stage 2", project_bodies(rows->stage, massless, out));
    return ritz_context(ritz_assemble(&out->second, NULL, &out->second_system),
                        "stage 2");
}

/* Orders of the bodies of a trial, and their sum. */
static ritz_status list_orders(const ritz_comparison *trial, int64_t **order,
                               int64_t *total)
{
    RITZ_CHECK_NEW(*order, trial->num_bodies);
    for (int64_t c = 0; c < trial->num_bodies; c++)
        *total += (*order)[c] = trial->V[c].ncol;
    return RITZ_OK;
}

/* Stage two at one tolerance, and its largest errors at all rows. */
static ritz_status try_tolerance(const ritz_rows *rows, const ritz_plan *plan,
                                 ritz_tolerance_row *out)
{
    RITZ_OWN(ritz_comparison) trial = {0};

    out->tolerance = plan->tolerance;
    out->frequency_error = out->gain_error = nan("");
    out->response_error = out->damping_error = nan("");
    RITZ_CHECK(try_plan(rows, plan, &trial));
    RITZ_CHECK(list_orders(&trial, &out->order, &out->total));
    out->removed = trial.removed;
    for (int64_t k = 0; k < rows->num_rows; k++) {
        ritz_compare_row row = rows->row[k]; /* borrowed but for its strays */
        ritz_status status = RITZ_OK;

        row.num_strays = 0;
        row.stray = NULL;
        status =
            ritz_compare_measure(rows->stage, trial.V, ritz_rows_first(rows, k),
                                 &trial.second_system.configuration[k], &row);
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

/* The scene's plan, with the attached dofs that were chosen. */
static ritz_plan chosen_plan(const ritz_stage *stage,
                             const ritz_comparison *comparison)
{
    ritz_plan plan = make_plan(stage);

    for (int64_t k = 0; k < comparison->num_candidates; k++)
        if (comparison->candidate[k].chosen) {
            plan.augment = comparison->candidate[k].level;
            plan.attached = comparison->candidate[k].attached;
            plan.inputs_too = comparison->candidate[k].inputs_too;
        }
    return plan;
}

static ritz_status try_tolerances(const ritz_stage *stage,
                                  const ritz_comparison *comparison,
                                  int64_t count, const double *tolerance,
                                  ritz_tolerance_row *out)
{
    const ritz_rows rows = {
        .stage = stage,
        .listed = &comparison->first_system,
        .num_rows = comparison->first_system.num_configurations,
        .row = comparison->row,
    };
    ritz_plan plan = chosen_plan(stage, comparison);

    for (int64_t k = 0; k < count; k++) {
        RITZ_REFUSE_IF(
            !(tolerance[k] > 0.0 && tolerance[k] < 1.0), RITZ_ERR_ARGUMENT,
            "the composite tolerance %g is not between 0 and 1", tolerance[k]);
        ritz_monitor_step("tolerances", k, count);
        plan.tolerance = tolerance[k];
        RITZ_CHECK(try_tolerance(&rows, &plan, &out[k]));
    }
    return RITZ_OK;
}

ritz_status ritz_compare_tolerances(const ritz_stage *stage,
                                    const ritz_comparison *comparison,
                                    int64_t count, const double *tolerance,
                                    ritz_tolerance_row **out)
{
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

/*
 * Which dofs to attach [McDaniel2000, sec. 3.2.2]: stage two is built with the
 * static corrections of each set of forces in turn. Each is compared with stage
 * one by the static gain, at listed angles and between them, and by the largest
 * singular value of the frequency response over the band.
 */

/* The sets that are tried, fewest forces first; where there are dampers, then
   the same with them. */
static const int of_system[] = {0, RITZ_ATTACHED_INPUTS,
                                RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_OUTPUTS};

static const int of_components[] = {
    0,
    RITZ_ATTACHED_INPUTS,
    RITZ_ATTACHED_INTERFACE,
    RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_INTERFACE,
    RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_INTERFACE | RITZ_ATTACHED_OUTPUTS,
};

enum { MOST_SETS = 2 * (sizeof of_components / sizeof *of_components) + 1 };

/* "inputs, interface" */
static void name_set(const ritz_scene *scene, ritz_candidate *candidate)
{
    static const char *const words[] = {"inputs", "interface", "outputs",
                                        "dampers"};
    char *out = candidate->name;
    size_t size = sizeof candidate->name;
    size_t used = 0;

    for (int k = 0; k < 4; k++)
        if (candidate->attached & (1 << k))
            used += (size_t)snprintf(out + used, size - used, "%s%s",
                                     used ? ", " : "", words[k]);
    for (int64_t k = 0;
         candidate->inputs_too && k < scene->num_attached_inputs && used < size;
         k++)
        used +=
            (size_t)snprintf(out + used, size - used, "%s%s", used ? ", " : "",
                             scene->input[scene->attached_input[k]].name);
    if (used == 0)
        snprintf(out, size, "nothing");
}

static ritz_status measure_deviation(const ritz_scene *scene,
                                     const ritz_configuration *first,
                                     const ritz_configuration *second,
                                     ritz_candidate *out)
{
    RITZ_OWN(ritz_response) one = {0}, two = {0};
    double deviation = 0.0, hertz = 0.0;

    RITZ_CHECK(ritz_compare_respond(scene, first, second, &one, &two));
    RITZ_CHECK(ritz_compare_bode(&one, &two, &deviation, &hertz));
    if (isnan(out->deviation) || deviation > out->deviation) {
        out->deviation = deviation;
        out->hertz = hertz;
        memcpy(out->at, first->at, sizeof out->at);
    }
    return RITZ_OK;
}

/* Errors at listed configurations, and of the static gain between them. */
static ritz_status measure_set(const ritz_rows *rows,
                               const ritz_comparison *trial,
                               ritz_candidate *out)
{
    const ritz_scene *scene = rows->stage->scene;
    bool driven = scene->num_inputs > 0 && scene->num_outputs > 0;
    int64_t listed = trial->second_system.num_configurations;

    for (int64_t k = 0; k < (driven ? rows->num_rows : listed); k++) {
        const ritz_configuration *first = ritz_rows_first(rows, k);
        RITZ_OWN(ritz_configuration) between = {0};
        const ritz_configuration *second =
            k < listed ? &trial->second_system.configuration[k] : &between;
        double *gain = k < listed ? &out->gain_listed : &out->gain_between;
        double error = nan("");

        if (k >= listed)
            RITZ_CHECK(ritz_stage_assemble(&trial->second, rows->row[k].setting,
                                           &between));
        else if (second->K.ncol > out->largest)
            out->largest = second->K.ncol;
        if (driven)
            RITZ_CHECK(ritz_compare_gain(first, second, &error));
        *gain = fmax(*gain, error);
        if (k < listed && ritz_compare_responds(scene))
            RITZ_CHECK(measure_deviation(scene, first, second, out));
    }
    return RITZ_OK;
}

static ritz_status try_set(const ritz_rows *rows, const ritz_plan *plan,
                           ritz_candidate *out)
{
    RITZ_OWN(ritz_comparison) trial = {0};

    out->level = plan->augment;
    out->attached = plan->attached;
    out->inputs_too = plan->inputs_too;
    out->gain_listed = out->gain_between = out->deviation = nan("");
    name_set(rows->stage->scene, out);
    RITZ_CHECK(try_plan(rows, plan, &trial));
    RITZ_CHECK(list_orders(&trial, &out->order, &out->total));
    return measure_set(rows, &trial, out);
}

/*
 * The smallest set within the tolerance, or else the one with the smallest
 * error. Of equal sizes the first is chosen, which has fewer forces;
 * differences within rounding do not count.
 */
static int64_t choose_set(const ritz_scene *scene, int64_t count,
                          const ritz_candidate *candidate)
{
    const double nearer = 0.9;
    int64_t best = 0;

    for (int64_t k = 1; k < count; k++) {
        const ritz_candidate *a = &candidate[best];
        const ritz_candidate *b = &candidate[k];
        bool a_fits = a->deviation <= scene->attached_tolerance;
        bool b_fits = b->deviation <= scene->attached_tolerance;

        if (a_fits != b_fits ? b_fits
                             : (b_fits ? b->total < a->total
                                       : b->deviation < nearer * a->deviation))
            best = k;
    }
    return best;
}

/*
 * The sets to try: those of the level, and the requested one if it is another;
 * its index.
 */
static int64_t list_sets(const ritz_stage *stage, const ritz_plan *plan,
                         ritz_plan sets[MOST_SETS], int64_t *requested)
{
    bool system = plan->augment == RITZ_AUGMENT_SYSTEM;
    const int *of = system ? of_system : of_components;
    int64_t alone =
        (int64_t)(system ? sizeof of_system : sizeof of_components) /
        (int64_t)sizeof *of;
    int64_t count = ritz_stage_is_damped(stage) ? 2 * alone : alone;

    *requested = plan->attached == RITZ_ATTACHED_AUTO ? 0 : count;
    for (int64_t k = 0; k < count; k++) {
        sets[k] = *plan;
        sets[k].attached =
            of[k % alone] | (k < alone ? 0 : RITZ_ATTACHED_DAMPERS);
        sets[k].inputs_too = false;
        if (!plan->inputs_too && plan->attached == sets[k].attached)
            *requested = k;
    }
    if (*requested == count)
        sets[count++] = *plan;
    return count;
}

/* Errors for each set of attached dofs, where the scene augments components or
   leaves the set open; plan->attached becomes the chosen set. */
static ritz_status try_sets(const ritz_rows *rows, ritz_plan *plan,
                            int64_t *count, ritz_candidate **out)
{
    const ritz_scene *scene = rows->stage->scene;
    bool open = plan->attached == RITZ_ATTACHED_AUTO;
    ritz_plan sets[MOST_SETS];
    int64_t chosen = 0;
    int64_t most = list_sets(rows->stage, plan, sets, &chosen);

    if (plan->augment != RITZ_AUGMENT_COMPONENT && !open)
        return RITZ_OK;
    RITZ_REFUSE_IF(open && !ritz_compare_responds(scene), RITZ_ERR_ARGUMENT,
                   "they are chosen by frequency responses, which need inputs, "
                   "outputs, a band and a damping of the scene");
    RITZ_CHECK_NEW(*out, most);
    *count = most;
    for (int64_t k = 0; k < most; k++) {
        ritz_monitor_step("attached dofs", k, most);
        RITZ_CHECK_IN((*out)[k].name, try_set(rows, &sets[k], &(*out)[k]));
    }
    if (open)
        chosen = choose_set(scene, most, *out);
    (*out)[chosen].chosen = true;
    *plan = sets[chosen];
    return RITZ_OK;
}

/* Both stages. */

/* Assemble the stage-1 system between listed configurations. */
static ritz_status assemble_between(ritz_rows *rows)
{
    int64_t listed = rows->listed->num_configurations;
    ritz_system *between = &rows->between;

    RITZ_CHECK_NEW(between->configuration, rows->num_rows - listed);
    for (int64_t k = listed; k < rows->num_rows; k++) {
        RITZ_CHECK(ritz_stage_assemble(rows->stage, rows->row[k].setting,
                                       &between->configuration[k - listed]));
        between->num_configurations++;
    }
    return RITZ_OK;
}

static void ritz_rows_free(ritz_rows *rows)
{
    ritz_system_free(&rows->between);
}

/*
 * Choose the modes that matter; between listed angles those that would be
 * chosen there.
 */
static ritz_status choose_modes(const ritz_rows *rows)
{
    const ritz_scene *scene = rows->stage->scene;
    double least = 0.0;

    RITZ_CHECK(ritz_compare_threshold(scene, rows->listed, &least));
    for (int64_t k = 0; k < rows->num_rows; k++)
        RITZ_CHECK(ritz_compare_select(scene, ritz_rows_first(rows, k), least,
                                       &rows->row[k]));
    return RITZ_OK;
}

/*
 * Measure the errors of every row; between angles the second system is
 * assembled for it.
 */
static ritz_status measure_rows(const ritz_rows *rows, ritz_comparison *c)
{
    for (int64_t k = 0; k < rows->num_rows; k++) {
        ritz_compare_row *row = &rows->row[k];
        RITZ_OWN(ritz_configuration) second = {0};

        ritz_monitor_step("errors", k, rows->num_rows);
        if (!row->listed)
            RITZ_CHECK(ritz_stage_assemble(&c->second, row->setting, &second));
        RITZ_CHECK(ritz_compare_measure(
            rows->stage, c->V, ritz_rows_first(rows, k),
            row->listed ? &c->second_system.configuration[k] : &second, row));
    }
    return RITZ_OK;
}

/* Build stage two as planned and move it into the result. */
static ritz_status reduce_bodies(const ritz_rows *rows, ritz_comparison *c)
{
    ritz_plan plan = make_plan(rows->stage);

    RITZ_CHECK_IN("attached dofs",
                  try_sets(rows, &plan, &c->num_candidates, &c->candidate));
    return try_plan(rows, &plan, c);
}

ritz_status ritz_compare(const ritz_stage *stage, ritz_comparison *out)
{
    RITZ_OWN(ritz_comparison) c = {0};
    RITZ_OWN(ritz_rows) rows = {.stage = stage, .listed = &c.first_system};

    RITZ_CHECK(ritz_dual_refuse(stage));
    RITZ_CHECK(list_rows(stage->scene, &c));
    rows.num_rows = c.num_rows;
    rows.row = c.row;
    RITZ_CHECK_IN("stage 1", ritz_assemble(stage, NULL, &c.first_system));
    RITZ_CHECK_IN("stage 1", assemble_between(&rows));
    RITZ_CHECK_IN("selection", choose_modes(&rows));
    RITZ_CHECK(reduce_bodies(&rows, &c));
    RITZ_CHECK_IN("errors", measure_rows(&rows, &c));
    ritz_compare_suggest(&c, &c.suggestion);
    RITZ_CHECK(record_comparison(&c));
    RITZ_MOVE(*out, c);
    return RITZ_OK;
}

void ritz_comparison_free(ritz_comparison *comparison)
{
    for (int64_t k = 0; comparison->row && k < comparison->num_rows; k++)
        RITZ_FREE(comparison->row[k].setting, comparison->row[k].kept,
                  comparison->row[k].stray);
    RITZ_FREE_EACH(ritz_dense, comparison->num_bodies, comparison->V);
    for (int64_t k = 0; comparison->candidate && k < comparison->num_candidates;
         k++)
        free(comparison->candidate[k].order);
    RITZ_FREE(comparison->row, comparison->candidate);
    ritz_stage_free(&comparison->second);
    ritz_system_free(&comparison->first_system);
    ritz_system_free(&comparison->second_system);
    *comparison = (ritz_comparison){0};
}
