/* Stage two by one plan, and by each composite tolerance in turn. */
#include "base/alloc.h"

#include "compare/compare.h"

#include <ritz/base.h>

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ritz_plan ritz_compare_plan(const ritz_scene *scene)
{
    static const int implied[] = {
        [RITZ_AUGMENT_NONE] = 0,
        [RITZ_AUGMENT_SYSTEM] = RITZ_ATTACHED_INPUTS,
        [RITZ_AUGMENT_COMPONENT] =
            RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_INTERFACE,
    };
    bool stated = scene->attached != 0 || scene->num_attached_inputs > 0;

    return (ritz_plan){
        .tolerance = scene->composite_tolerance,
        .augment = scene->augment,
        .attached = stated ? scene->attached : implied[scene->augment],
        .inputs_too = scene->num_attached_inputs > 0,
    };
}

/* Motions without mass have neither mass nor damping, but for rounding. */
static void zero_entries(ritz_range range, ritz_dense *A)
{
    for (int64_t j = range.first; j < range.last && A->val; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] = ritz_dense_col(A, i)[j] = 0.0;
}

/* Project the bodies on the subspaces V. */
static ritz_status project_bodies(const ritz_stage *stage,
                                  const ritz_range *massless,
                                  ritz_comparison *out)
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
        for (int64_t j = massless[c].first; j < massless[c].last; j++)
            made.body[c].columns.kind[j] = RITZ_COLUMN_MASSLESS;
        snprintf(origin->method, sizeof origin->method, "compare");
        snprintf(origin->reference, sizeof origin->reference, "LeeTsuha1992");
        out->removed = out->removed || out->V[c].ncol < out->V[c].nrow;
    }
    return ritz_stage_from(stage->scene, made.body, &out->second);
}

ritz_status ritz_compare_try(const ritz_rows *rows, const ritz_plan *plan,
                             ritz_comparison *out)
{
    RITZ_OWN_ARRAY ritz_range *massless = NULL;

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
    out->frequency_error = out->gain_error = out->response_error = nan("");
    RITZ_CHECK(ritz_compare_try(rows, plan, &trial));
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
    }
    return RITZ_OK;
}

/* The scene's plan, with the attached dofs that were chosen. */
static ritz_plan chosen_plan(const ritz_stage *stage,
                             const ritz_comparison *comparison)
{
    ritz_plan plan = ritz_compare_plan(stage->scene);

    for (int64_t k = 0; k < comparison->num_candidates; k++)
        if (comparison->candidate[k].chosen) {
            plan.augment = comparison->candidate[k].level;
            plan.attached = comparison->candidate[k].attached;
            plan.inputs_too = comparison->candidate[k].inputs_too;
        }
    return plan;
}

ritz_status ritz_compare_tolerances(const ritz_stage *stage,
                                    const ritz_comparison *comparison,
                                    int64_t count, const double *tolerance,
                                    ritz_tolerance_row **out)
{
    ritz_status status = RITZ_OK;
    const ritz_rows rows = {
        .stage = stage,
        .listed = &comparison->first_system,
        .num_rows = comparison->first_system.num_configurations,
        .row = comparison->row,
    };
    ritz_plan plan = chosen_plan(stage, comparison);
    ritz_tolerance_row *made = NULL;

    RITZ_NEW(made, count);
    for (int64_t k = 0; k < count; k++) {
        RITZ_FAIL_IF(
            !(tolerance[k] > 0.0 && tolerance[k] < 1.0), RITZ_ERR_ARGUMENT,
            "the composite tolerance %g is not between 0 and 1", tolerance[k]);
        ritz_monitor_step("tolerances", k, count);
        plan.tolerance = tolerance[k];
        RITZ_TRY(try_tolerance(&rows, &plan, &made[k]));
    }
    RITZ_MOVE(*out, made);
done:
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

/* The sets that are tried, fewest forces first. */
static const int of_system[] = {0, RITZ_ATTACHED_INPUTS,
                                RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_OUTPUTS};

static const int of_components[] = {
    0,
    RITZ_ATTACHED_INPUTS,
    RITZ_ATTACHED_INTERFACE,
    RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_INTERFACE,
    RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_INTERFACE | RITZ_ATTACHED_OUTPUTS,
};

enum { MOST_SETS = sizeof of_components / sizeof *of_components + 1 };

/* "inputs, interface" */
static void name_set(const ritz_scene *scene, ritz_candidate *candidate)
{
    static const char *const words[] = {"inputs", "interface", "outputs"};
    char *out = candidate->name;
    size_t size = sizeof candidate->name;
    size_t used = 0;

    for (int k = 0; k < 3; k++)
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
    RITZ_CHECK(ritz_compare_try(rows, plan, &trial));
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
static int64_t list_sets(const ritz_plan *plan, ritz_plan sets[MOST_SETS],
                         int64_t *requested)
{
    bool system = plan->augment == RITZ_AUGMENT_SYSTEM;
    const int *of = system ? of_system : of_components;
    int64_t count =
        (int64_t)(system ? sizeof of_system : sizeof of_components) /
        (int64_t)sizeof *of;

    *requested = plan->attached == RITZ_ATTACHED_AUTO ? 0 : count;
    for (int64_t k = 0; k < count; k++) {
        sets[k] = *plan;
        sets[k].attached = of[k];
        sets[k].inputs_too = false;
        if (!plan->inputs_too && plan->attached == of[k])
            *requested = k;
    }
    if (*requested == count)
        sets[count++] = *plan;
    return count;
}

ritz_status ritz_compare_candidates(const ritz_rows *rows, ritz_plan *plan,
                                    int64_t *count, ritz_candidate **out)
{
    const ritz_scene *scene = rows->stage->scene;
    bool open = plan->attached == RITZ_ATTACHED_AUTO;
    ritz_plan sets[MOST_SETS];
    int64_t chosen = 0;
    int64_t most = list_sets(plan, sets, &chosen);

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

void ritz_candidates_free(int64_t count, ritz_candidate **candidates)
{
    for (int64_t k = 0; *candidates && k < count; k++)
        free((*candidates)[k].order);
    free(*candidates);
    *candidates = NULL;
}
