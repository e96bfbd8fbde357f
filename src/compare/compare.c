/*
 * COMPARE [LeeTsuha1992]. Stage one: each body in its component modes, the
 * system at every configuration, the modes that matter there. Stage two: the
 * composite of those modes over all configurations, augmented by static
 * corrections, projected on each body; the bodies reassembled.
 *
 * A mode Phi_k kept at an angle is a vector of the second system at that angle,
 * for its projections on the bodies fit each other, and Rayleigh-Ritz returns
 * it to rounding; tests/unit/compare/test_compare.c holds the code to it.
 */
#include "assembly/dual.h"
#include "base/alloc.h"
#include "compare/compare_parts.h"

#include <ritz/monitor.h>

#include <stdlib.h>

const ritz_configuration *ritz_rows_first(const ritz_rows *rows, int64_t k)
{
    int64_t listed = rows->listed->num_configurations;

    return k < listed ? &rows->listed->configuration[k]
                      : &rows->between[k - listed];
}

/* The stage-1 system between listed configurations. */
static ritz_status assemble_between(ritz_rows *rows)
{
    int64_t listed = rows->listed->num_configurations;

    RITZ_CHECK_NEW(rows->between, rows->num_rows - listed);
    for (int64_t k = listed; k < rows->num_rows; k++) {
        RITZ_CHECK(ritz_stage_assemble(rows->stage, rows->row[k].setting,
                                       &rows->between[k - listed]));
        rows->num_between++;
    }
    return RITZ_OK;
}

static void free_between(ritz_rows *rows)
{
    for (int64_t k = 0; k < rows->num_between; k++)
        ritz_configuration_free(&rows->between[k]);
    free(rows->between);
    rows->between = NULL;
}

/* Choose the modes that matter, between angles those that would. */
static ritz_status choose(const ritz_rows *rows)
{
    const ritz_scene *scene = rows->stage->scene;
    double least = 0.0;

    RITZ_CHECK(ritz_compare_threshold(scene, rows->listed, &least));
    for (int64_t k = 0; k < rows->num_rows; k++)
        RITZ_CHECK(ritz_compare_select(scene, ritz_rows_first(rows, k), least,
                                       &rows->row[k]));
    return RITZ_OK;
}

/* Errors at every row; between angles the second system is made for it. */
static ritz_status measure(const ritz_rows *rows, ritz_comparison *c)
{
    ritz_status status = RITZ_OK;
    ritz_configuration second = {0};

    for (int64_t k = 0; k < rows->num_rows; k++) {
        ritz_compare_row *row = &rows->row[k];

        ritz_monitor_step("errors", k, rows->num_rows);
        if (!row->listed)
            RITZ_TRY(ritz_stage_assemble(&c->second, row->setting, &second));
        RITZ_TRY(ritz_compare_measure(
            rows->stage, c->V, ritz_rows_first(rows, k),
            row->listed ? &c->second_system.configuration[k] : &second, row));
        ritz_configuration_free(&second);
    }
done:
    ritz_configuration_free(&second);
    return status;
}

/* Stage two as planned, and its place in the result. */
static ritz_status reduce(const ritz_rows *rows, ritz_comparison *c)
{
    ritz_status status = RITZ_OK;
    ritz_plan plan = ritz_compare_plan(rows->stage->scene);
    ritz_trial trial = {0};

    RITZ_TRY_IN("attached dofs",
                ritz_compare_candidates(rows, &plan, &c->num_candidates,
                                        &c->candidate));
    RITZ_TRY(ritz_compare_try(rows, &plan, &trial));
    c->num_bodies = trial.count;
    c->V = trial.V;
    c->composite = trial.vectors;
    c->removed = trial.removed;
    c->second = trial.second;
    c->second_system = trial.system;
    trial = (ritz_trial){0};
done:
    ritz_trial_free(&trial);
    return status;
}

ritz_status ritz_compare(const ritz_stage *stage, ritz_comparison *out)
{
    ritz_status status = RITZ_OK;
    ritz_comparison c = {0};
    ritz_rows rows = {.stage = stage, .listed = &c.first_system};

    RITZ_TRY(ritz_dual_refuse(stage));
    RITZ_TRY(ritz_compare_list(stage->scene, &c.num_rows, &c.row));
    rows.num_rows = c.num_rows;
    rows.row = c.row;
    RITZ_TRY_IN("stage 1", ritz_assemble(stage, NULL, &c.first_system));
    RITZ_TRY_IN("stage 1", assemble_between(&rows));
    RITZ_TRY_IN("selection", choose(&rows));
    RITZ_TRY(reduce(&rows, &c));
    RITZ_TRY_IN("errors", measure(&rows, &c));
    ritz_compare_suggest(&c, &c.suggestion);
    RITZ_TRY(ritz_compare_record(&c));
    *out = c;
    c = (ritz_comparison){0};
done:
    free_between(&rows);
    ritz_comparison_free(&c);
    return status;
}

void ritz_comparison_free(ritz_comparison *comparison)
{
    for (int64_t k = 0; comparison->row && k < comparison->num_rows; k++) {
        free(comparison->row[k].setting);
        free(comparison->row[k].kept);
        free(comparison->row[k].stray);
    }
    for (int64_t k = 0; comparison->V && k < comparison->num_bodies; k++)
        ritz_dense_free(&comparison->V[k]);
    free(comparison->row);
    free(comparison->V);
    ritz_candidates_free(comparison->num_candidates, &comparison->candidate);
    ritz_stage_free(&comparison->second);
    ritz_system_free(&comparison->first_system);
    ritz_system_free(&comparison->second_system);
    *comparison = (ritz_comparison){0};
}
