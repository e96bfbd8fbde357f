/* The rows of a comparison: configurations that are listed, and between. */
#include "base/alloc.h"
#include "compare/compare_parts.h"

#include <math.h>
#include <string.h>

/* The sweep in which two configurations differ, -1 if not in one alone. */
static int64_t differs_by(int64_t sweeps, const double *a, const double *b)
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
 * Rows between neighbours of the list, and, where the turning of one joint goes
 * on round the circle by the same step, between its last and its first.
 */
static ritz_status list_between(const ritz_scene *scene, int64_t *rows,
                                ritz_compare_row *row)
{
    int64_t h = scene->num_sweeps;
    int64_t count = scene->num_configurations;
    const double *first = scene->setting;
    const double *last = scene->setting + (count - 1) * h;
    int64_t sweep = -1;

    for (int64_t k = 0; k + 1 < count; k++) {
        const double *a = scene->setting + k * h;

        sweep = differs_by(h, a, a + h);
        if (sweep >= 0)
            RITZ_CHECK(add_between(scene, a, sweep, a[h + sweep], rows, row));
    }
    sweep = count > 2 ? differs_by(h, first, last) : -1;
    if (sweep >= 0 && scene->sweep[sweep].turns) {
        double step = first[h + sweep] - first[sweep];

        if (fabs(last[sweep] + step - first[sweep] - 360.0) < 1e-9)
            RITZ_CHECK(
                add_between(scene, last, sweep, last[sweep] + step, rows, row));
    }
    return RITZ_OK;
}

ritz_status ritz_compare_list(const ritz_scene *scene, int64_t *count,
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
    return list_between(scene, count, *out);
}
