/*
 * The rows of a comparison: listed configurations, and those half way between.
 */
#include "base/alloc.h"
#include "base/tolerances.h"

#include "assembly/dual.h"
#include "compare/compare.h"

#include <ritz/base.h>

#include <math.h>
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

/* Append a row half way between two configurations. */
static ritz_status add_between(const ritz_scene *scene, const double *from,
                               int64_t sweep, double to, int64_t *count,
                               ritz_compare_row *rows)
{
    ritz_compare_row *row = &rows[*count];

    *count += 1;
    RITZ_CHECK_NEW(row->setting, scene->num_sweeps);
    memcpy(row->setting, from,
           (size_t)scene->num_sweeps * sizeof *row->setting);
    row->setting[sweep] = 0.5 * (from[sweep] + to);
    return RITZ_OK;
}

/*
 * Rows half way between neighbours of the list. Where a joint turns on by the
 * same step round the full circle, also between its last and first angle.
 */
static ritz_status list_halfway(const ritz_scene *scene, int64_t *rows,
                                ritz_compare_row *row)
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
            RITZ_CHECK(add_between(scene, a, sweep, a[h + sweep], rows, row));
    }
    sweep = count > 2 ? find_sweep(h, first, last) : -1;
    if (sweep >= 0 && scene->sweep[sweep].turns) {
        double step = first[h + sweep] - first[sweep];

        if (fabs(last[sweep] + step - first[sweep] - 360.0) < RITZ_SAME)
            RITZ_CHECK(
                add_between(scene, last, sweep, last[sweep] + step, rows, row));
    }
    return RITZ_OK;
}

/* Listed configurations, then those half way between neighbours. */
static ritz_status list_rows(const ritz_scene *scene, int64_t *count,
                             ritz_compare_row **out)
{
    int64_t h = scene->num_sweeps;

    RITZ_REFUSE_IF(scene->num_configurations < 1, RITZ_ERR_ARGUMENT,
                   "the scene has no configuration");
    RITZ_CHECK_NEW(*out, 2 * scene->num_configurations);
    for (int64_t k = 0; k < scene->num_configurations; k++) {
        ritz_compare_row *row = &(*out)[(*count)++];

        row->listed = true;
        RITZ_CHECK_NEW(row->setting, h);
        if (h > 0)
            memcpy(row->setting, scene->setting + k * h,
                   (size_t)h * sizeof *row->setting);
    }
    return list_halfway(scene, count, *out);
}

/* Errors, recorded in the files of stage two. */

/* Append a measure, unless it is NaN, which means that it was not computed. */
static ritz_status add_measure(ritz_measures *errors, const char *name,
                               double value, double limit, const char *where)
{
    return isnan(value) ? RITZ_OK
                        : ritz_measures_add(errors, name, value, limit, where);
}

/* Record the errors of one configuration. */
static ritz_status record_row(const ritz_compare_row *row,
                              ritz_measures *errors)
{
    static const char against[] = "kept modes against the stage-1 system";

    RITZ_CHECK(add_measure(errors, "stage1-frequency-relative",
                           row->frequency_error, row->allowed, against));
    RITZ_CHECK(add_measure(errors, "stage1-mac", row->mac, nan(""), against));
    RITZ_CHECK(add_measure(errors, "stage1-rigid-hertz", row->rigid_error,
                           nan(""), ""));
    RITZ_CHECK(add_measure(errors, "stage1-static-gain-relative",
                           row->gain_error, nan(""), ""));
    RITZ_CHECK(add_measure(errors, "stage1-moments-relative", row->moment_error,
                           nan(""), ""));
    return add_measure(errors, "stage1-response-relative", row->response_error,
                       nan(""), "");
}

/*
 * Record the largest errors over all listed configurations for every body. A
 * measure that no configuration has is NaN and stays NaN: fmax ignores NaN.
 */
static ritz_status record_bodies(ritz_comparison *out)
{
    static const char worst[] = "worst listed angle, against stage 1";
    double frequency = nan(""), gain = nan(""), response = nan("");

    for (int64_t k = 0; k < out->num_rows; k++) {
        const ritz_compare_row *row = &out->row[k];

        if (!row->listed)
            continue;
        frequency = fmax(frequency, row->frequency_error);
        gain = fmax(gain, row->gain_error);
        response = fmax(response, row->response_error);
    }
    for (int64_t c = 0; c < out->second.count; c++) {
        ritz_measures *errors = &out->second.body[c].errors;

        RITZ_CHECK(add_measure(errors, "stage1-frequency-relative", frequency,
                               nan(""), worst));
        RITZ_CHECK(add_measure(errors, "stage1-static-gain-relative", gain,
                               nan(""), worst));
        RITZ_CHECK(add_measure(errors, "stage1-response-relative", response,
                               nan(""), worst));
    }
    return RITZ_OK;
}

/* Record errors with the second system and with every body. */
static ritz_status record_comparison(ritz_comparison *comparison)
{
    for (int64_t k = 0; k < comparison->second_system.num_configurations; k++)
        RITZ_CHECK(
            record_row(&comparison->row[k],
                       &comparison->second_system.configuration[k].errors));
    return record_bodies(comparison);
}

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

/* Assemble the stage-1 system between listed configurations. */
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
    RITZ_OWN(ritz_configuration) second = {0};

    for (int64_t k = 0; k < rows->num_rows; k++) {
        ritz_compare_row *row = &rows->row[k];

        ritz_monitor_step("errors", k, rows->num_rows);
        if (!row->listed)
            RITZ_CHECK(ritz_stage_assemble(&c->second, row->setting, &second));
        RITZ_CHECK(ritz_compare_measure(
            rows->stage, c->V, ritz_rows_first(rows, k),
            row->listed ? &c->second_system.configuration[k] : &second, row));
        ritz_configuration_free(&second);
    }
    return RITZ_OK;
}

/* Build stage two as planned and move it into the result. */
static ritz_status reduce_bodies(const ritz_rows *rows, ritz_comparison *c)
{
    ritz_plan plan = ritz_compare_plan(rows->stage->scene);
    RITZ_OWN(ritz_trial) trial = {0};

    RITZ_CHECK_IN("attached dofs",
                  ritz_compare_candidates(rows, &plan, &c->num_candidates,
                                          &c->candidate));
    RITZ_CHECK(ritz_compare_try(rows, &plan, &trial));
    c->num_bodies = trial.count;
    c->V = trial.V;
    c->composite = trial.vectors;
    c->removed = trial.removed;
    c->second = trial.second;
    c->second_system = trial.system;
    memset(&trial, 0, sizeof trial);
    return RITZ_OK;
}

ritz_status ritz_compare(const ritz_stage *stage, ritz_comparison *out)
{
    ritz_status status = RITZ_OK;
    ritz_comparison c = {0};
    ritz_rows rows = {.stage = stage, .listed = &c.first_system};

    RITZ_TRY(ritz_dual_refuse(stage));
    RITZ_TRY(list_rows(stage->scene, &c.num_rows, &c.row));
    rows.num_rows = c.num_rows;
    rows.row = c.row;
    RITZ_TRY_IN("stage 1", ritz_assemble(stage, NULL, &c.first_system));
    RITZ_TRY_IN("stage 1", assemble_between(&rows));
    RITZ_TRY_IN("selection", choose_modes(&rows));
    RITZ_TRY(reduce_bodies(&rows, &c));
    RITZ_TRY_IN("errors", measure_rows(&rows, &c));
    ritz_compare_suggest(&c, &c.suggestion);
    RITZ_TRY(record_comparison(&c));
    RITZ_MOVE(*out, c);
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
