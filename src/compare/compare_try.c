/* Stage two by one plan, and by one composite tolerance after the other. */
#include "base/alloc.h"
#include "compare/compare_parts.h"

#include <ritz/monitor.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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

/* Rows and columns of A are zero that rounding alone keeps from it. */
static void clear(ritz_range range, ritz_dense *A)
{
    for (int64_t j = range.first; j < range.last && A->val; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] = ritz_dense_col(A, i)[j] = 0.0;
}

/* Columns of V that are motions without mass have none, and no damping. */
static void settle(ritz_range massless, ritz_reduced *body)
{
    clear(massless, &body->M);
    clear(massless, &body->D);
    for (int64_t j = massless.first; j < massless.last; j++)
        body->columns.kind[j] = RITZ_COLUMN_MASSLESS;
}

/* The bodies in the subspaces V. */
static ritz_status project(const ritz_stage *stage, const ritz_range *massless,
                           ritz_trial *out)
{
    ritz_status status = RITZ_OK;
    ritz_reduced *body = NULL;

    RITZ_NEW(body, stage->count);
    for (int64_t c = 0; c < stage->count; c++) {
        ritz_origin *origin = &body[c].origin;

        RITZ_TRY(ritz_reduced_project(&stage->body[c], &out->V[c], &body[c]));
        settle(massless[c], &body[c]);
        snprintf(origin->method, sizeof origin->method, "compare");
        snprintf(origin->reference, sizeof origin->reference, "LeeTsuha1992");
        out->removed = out->removed || out->V[c].ncol < out->V[c].nrow;
    }
    RITZ_TRY(ritz_stage_from(stage->scene, body, &out->second));
done:
    for (int64_t c = 0; body && c < stage->count; c++)
        ritz_reduced_free(&body[c]);
    free(body);
    return status;
}

ritz_status ritz_compare_try(const ritz_rows *rows, const ritz_plan *plan,
                             ritz_trial *out)
{
    ritz_status status = RITZ_OK;
    ritz_trial trial = {.count = rows->stage->count};
    ritz_range *massless = NULL;

    RITZ_NEW(massless, trial.count);
    RITZ_NEW(trial.V, trial.count);
    RITZ_TRY_IN(
        "composite modes",
        ritz_compare_composite(rows, plan, trial.V, massless, &trial.vectors));
    RITZ_TRY_IN("stage 2", project(rows->stage, massless, &trial));
    RITZ_TRY_IN("stage 2", ritz_assemble(&trial.second, NULL, &trial.system));
    *out = trial;
    trial = (ritz_trial){0};
done:
    free(massless);
    ritz_trial_free(&trial);
    return status;
}

void ritz_trial_free(ritz_trial *trial)
{
    for (int64_t c = 0; trial->V && c < trial->count; c++)
        ritz_dense_free(&trial->V[c]);
    free(trial->V);
    ritz_stage_free(&trial->second);
    ritz_system_free(&trial->system);
    *trial = (ritz_trial){0};
}

/* Orders of a trial, and its worst errors at listed configurations. */
static ritz_status sum_up(const ritz_rows *rows, ritz_trial *trial,
                          ritz_tolerance_row *out)
{
    ritz_status status = RITZ_OK;
    ritz_compare_row row = {0};

    RITZ_NEW(out->order, trial->count);
    for (int64_t c = 0; c < trial->count; c++)
        out->total += out->order[c] = trial->V[c].ncol;
    out->removed = trial->removed;
    out->frequency_error = out->gain_error = out->response_error = nan("");
    for (int64_t k = 0; k < rows->num_rows; k++) {
        ritz_configuration *second = &trial->system.configuration[k];

        row = rows->row[k]; /* its own strays; the rest is borrowed */
        row.num_strays = 0;
        row.stray = NULL;
        RITZ_TRY(ritz_compare_measure(rows->stage, trial->V,
                                      ritz_rows_first(rows, k), second, &row));
        out->largest = row.order > out->largest ? row.order : out->largest;
        out->frequency_error = fmax(out->frequency_error, row.frequency_error);
        out->gain_error = fmax(out->gain_error, row.gain_error);
        out->response_error = fmax(out->response_error, row.response_error);
        free(row.stray);
        row.stray = NULL;
    }
done:
    free(row.stray);
    return status;
}

/* What the scene plans, with the attached dofs that were chosen. */
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
    ritz_trial trial = {0};

    RITZ_NEW(made, count);
    for (int64_t k = 0; k < count; k++) {
        RITZ_FAIL_IF(
            !(tolerance[k] > 0.0 && tolerance[k] < 1.0), RITZ_ERR_ARGUMENT,
            "the composite tolerance %g is not between 0 and 1", tolerance[k]);
        ritz_monitor_step("tolerances", k, count);
        made[k].tolerance = plan.tolerance = tolerance[k];
        RITZ_TRY(ritz_compare_try(&rows, &plan, &trial));
        RITZ_TRY(sum_up(&rows, &trial, &made[k]));
        ritz_trial_free(&trial);
    }
    *out = made;
    made = NULL;
done:
    ritz_trial_free(&trial);
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
