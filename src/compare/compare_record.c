/* What was measured, into the files of stage two. */
#include "compare/compare_parts.h"

#include <math.h>

/* A measure that was taken; NaN stands for none. */
static ritz_status add(ritz_measures *errors, const char *name, double value,
                       double limit, const char *where)
{
    return isnan(value) ? RITZ_OK
                        : ritz_measures_add(errors, name, value, limit, where);
}

/* Of one configuration. */
static ritz_status record_row(const ritz_compare_row *row,
                              ritz_measures *errors)
{
    static const char against[] = "kept modes against the stage-1 system";

    RITZ_CHECK(add(errors, "stage1-frequency-relative", row->frequency_error,
                   row->allowed, against));
    RITZ_CHECK(add(errors, "stage1-mac", row->mac, nan(""), against));
    RITZ_CHECK(
        add(errors, "stage1-rigid-hertz", row->rigid_error, nan(""), ""));
    RITZ_CHECK(add(errors, "stage1-static-gain-relative", row->gain_error,
                   nan(""), ""));
    RITZ_CHECK(
        add(errors, "stage1-moments-relative", row->moment_error, nan(""), ""));
    return add(errors, "stage1-response-relative", row->response_error, nan(""),
               "");
}

/*
 * The worst of all listed configurations, into the file of every body. What no
 * configuration measured is NaN, and stays so: fmax passes NaN over.
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

        RITZ_CHECK(add(errors, "stage1-frequency-relative", frequency, nan(""),
                       worst));
        RITZ_CHECK(
            add(errors, "stage1-static-gain-relative", gain, nan(""), worst));
        RITZ_CHECK(
            add(errors, "stage1-response-relative", response, nan(""), worst));
    }
    return RITZ_OK;
}

ritz_status ritz_compare_record(ritz_comparison *comparison)
{
    for (int64_t k = 0; k < comparison->second_system.num_configurations; k++)
        RITZ_CHECK(
            record_row(&comparison->row[k],
                       &comparison->second_system.configuration[k].errors));
    return record_bodies(comparison);
}
