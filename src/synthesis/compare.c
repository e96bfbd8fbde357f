/*
 * COMPARE [LeeTsuha1992]. Stage one: each body in its component modes, the
 * system at every configuration, the modes that matter there. Stage two: the
 * composite of those modes over all configurations, augmented by static
 * corrections, projected on each body; the bodies reassembled.
 *
 * A mode Phi_k kept at an angle is a vector of the second system at that angle,
 * for its projections on the bodies fit each other, and Rayleigh-Ritz returns
 * it to rounding; tests/unit/test_compare.c holds the code to it.
 */
#include "base/alloc.h"
#include "synthesis/compare_parts.h"

#include <ritz/monitor.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The hinge by which two configurations differ, -1 if not by one alone. */
static int64_t differs_by(int64_t hinges, const double *a, const double *b)
{
    int64_t one = -1;

    for (int64_t k = 0; k < hinges; k++)
        if (a[k] != b[k]) {
            if (one >= 0)
                return -1;
            one = k;
        }
    return one;
}

/* Append a row half way between two configurations. */
static ritz_status add_between(const ritz_scene *scene, const double *from,
                               int64_t hinge, double to, ritz_comparison *out)
{
    ritz_status status = RITZ_OK;
    ritz_compare_row *row = &out->row[out->num_rows];

    out->num_rows++;
    RITZ_NEW(row->setting, scene->num_sweeps);
    memcpy(row->setting, from,
           (size_t)scene->num_sweeps * sizeof *row->setting);
    row->setting[hinge] = 0.5 * (from[hinge] + to);
done:
    return status;
}

/*
 * Rows between neighbours of the list, and, where the sweep of one hinge goes
 * on round the circle by the same step, between its last and its first.
 */
static ritz_status list_between(const ritz_scene *scene, ritz_comparison *out)
{
    ritz_status status = RITZ_OK;
    int64_t h = scene->num_sweeps;
    int64_t count = scene->num_configurations;
    const double *first = scene->setting;
    const double *last = scene->setting + (count - 1) * h;
    int64_t hinge = -1;

    for (int64_t k = 0; k + 1 < count; k++) {
        const double *a = scene->setting + k * h;

        hinge = differs_by(h, a, a + h);
        if (hinge >= 0)
            RITZ_TRY(add_between(scene, a, hinge, a[h + hinge], out));
    }
    hinge = count > 2 ? differs_by(h, first, last) : -1;
    if (hinge >= 0) {
        double step = first[h + hinge] - first[hinge];

        if (fabs(last[hinge] + step - first[hinge] - 360.0) < 1e-9)
            RITZ_TRY(add_between(scene, last, hinge, last[hinge] + step, out));
    }
done:
    return status;
}

static ritz_status list_rows(const ritz_scene *scene, ritz_comparison *out)
{
    ritz_status status = RITZ_OK;
    int64_t h = scene->num_sweeps;

    RITZ_NEW(out->row, 2 * scene->num_configurations);
    for (int64_t k = 0; k < scene->num_configurations; k++) {
        ritz_compare_row *row = &out->row[out->num_rows++];

        row->listed = true;
        RITZ_NEW(row->setting, h);
        if (h > 0)
            memcpy(row->setting, scene->setting + k * h,
                   (size_t)h * sizeof *row->setting);
    }
    RITZ_TRY(list_between(scene, out));
done:
    return status;
}

/* The bodies in the subspaces V: the second stage. */
static ritz_status project(const ritz_stage *stage, ritz_comparison *out)
{
    ritz_status status = RITZ_OK;
    ritz_reduced *body = NULL;

    RITZ_NEW(body, stage->count);
    for (int64_t c = 0; c < stage->count; c++) {
        ritz_origin *origin = &body[c].origin;

        RITZ_TRY(ritz_reduced_project(&stage->body[c], &out->V[c], &body[c]));
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

/* Choose the modes that matter at every listed configuration. */
static ritz_status choose(const ritz_stage *stage, double *least,
                          ritz_comparison *out)
{
    ritz_status status = RITZ_OK;
    const ritz_system *system = &out->first_system;

    RITZ_TRY(ritz_compare_threshold(stage->scene, system, least));
    for (int64_t k = 0; k < system->num_configurations; k++)
        RITZ_TRY(ritz_compare_select(stage->scene, &system->configuration[k],
                                     *least, &out->row[k]));
done:
    return status;
}

/*
 * Errors at a row. Between angles both systems are made for it, and the modes
 * that would have been chosen there are compared.
 */
static ritz_status measure(const ritz_stage *stage, int64_t k, double least,
                           ritz_comparison *out)
{
    ritz_status status = RITZ_OK;
    ritz_compare_row *row = &out->row[k];
    ritz_configuration one = {0}, two = {0};

    if (row->listed) {
        status = ritz_compare_measure(
            stage, out->V, &out->first_system.configuration[k],
            &out->second_system.configuration[k], row);
        goto done;
    }
    RITZ_TRY(ritz_stage_assemble(stage, row->setting, &one));
    RITZ_TRY(ritz_stage_assemble(&out->second, row->setting, &two));
    RITZ_TRY(ritz_compare_select(stage->scene, &one, least, row));
    RITZ_TRY(ritz_compare_measure(stage, out->V, &one, &two, row));
done:
    ritz_configuration_free(&one);
    ritz_configuration_free(&two);
    return status;
}

/* What was measured, into the file of the second system. */
static ritz_status record(ritz_comparison *out)
{
    ritz_status status = RITZ_OK;

    for (int64_t k = 0; k < out->second_system.num_configurations; k++) {
        const ritz_compare_row *row = &out->row[k];
        ritz_measures *errors = &out->second_system.configuration[k].errors;
        const char *against = "kept modes against the stage-1 system";

        RITZ_TRY(ritz_measures_add(errors, "stage1-frequency-relative",
                                   row->frequency_error, row->allowed,
                                   against));
        RITZ_TRY(ritz_measures_add(errors, "stage1-mac", row->mac, (double)NAN,
                                   against));
        RITZ_TRY(ritz_measures_add(errors, "stage1-rigid-hertz",
                                   row->rigid_error, (double)NAN, ""));
        if (!isnan(row->gain_error))
            RITZ_TRY(ritz_measures_add(errors, "stage1-static-gain-relative",
                                       row->gain_error, (double)NAN, ""));
        if (!isnan(row->response_error))
            RITZ_TRY(ritz_measures_add(errors, "stage1-response-relative",
                                       row->response_error, (double)NAN, ""));
    }
done:
    return status;
}

/* Add the worst of a measure, if any configuration had it. */
static ritz_status record_worst(const char *name, double worst,
                                ritz_measures *errors)
{
    if (isnan(worst))
        return RITZ_OK;
    return ritz_measures_add(errors, name, worst, (double)NAN,
                             "worst listed angle, against stage 1");
}

/*
 * The worst of all listed configurations, into the file of every body. What no
 * configuration measured is NaN, and stays so: fmax passes NaN over.
 */
static ritz_status record_bodies(ritz_comparison *out)
{
    ritz_status status = RITZ_OK;
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

        RITZ_TRY(record_worst("stage1-frequency-relative", frequency, errors));
        RITZ_TRY(record_worst("stage1-static-gain-relative", gain, errors));
        RITZ_TRY(record_worst("stage1-response-relative", response, errors));
    }
done:
    return status;
}

ritz_status ritz_compare(const ritz_stage *stage, ritz_comparison *out)
{
    ritz_status status = RITZ_OK;
    ritz_comparison c = {0};
    double least = 0.0;

    RITZ_FAIL_IF(stage->scene->num_configurations < 1, RITZ_ERR_ARGUMENT,
                 "the scene has no configuration");
    RITZ_TRY(list_rows(stage->scene, &c));
    RITZ_TRY_IN("stage 1", ritz_assemble(stage, NULL, &c.first_system));
    RITZ_TRY_IN("selection", choose(stage, &least, &c));
    c.num_bodies = stage->count;
    RITZ_NEW(c.V, stage->count);
    RITZ_TRY_IN("composite modes",
                ritz_compare_composite(stage, &c.first_system, c.row, c.V,
                                       &c.composite));
    RITZ_TRY_IN("stage 2", project(stage, &c));
    RITZ_TRY_IN("stage 2", ritz_assemble(&c.second, NULL, &c.second_system));
    for (int64_t k = 0; k < c.num_rows; k++) {
        ritz_monitor_step("errors", k, c.num_rows);
        RITZ_TRY_IN("errors", measure(stage, k, least, &c));
    }
    RITZ_TRY(record(&c));
    RITZ_TRY(record_bodies(&c));
    *out = c;
    c = (ritz_comparison){0};
done:
    ritz_comparison_free(&c);
    return status;
}

void ritz_comparison_free(ritz_comparison *comparison)
{
    for (int64_t k = 0; comparison->row && k < comparison->num_rows; k++) {
        free(comparison->row[k].setting);
        free(comparison->row[k].kept);
    }
    for (int64_t k = 0; comparison->V && k < comparison->num_bodies; k++)
        ritz_dense_free(&comparison->V[k]);
    free(comparison->row);
    free(comparison->V);
    ritz_stage_free(&comparison->second);
    ritz_system_free(&comparison->first_system);
    ritz_system_free(&comparison->second_system);
    *comparison = (ritz_comparison){0};
}
