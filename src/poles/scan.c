/*
 * One mode is followed while c and k of dampers change, along one axis or over
 * a grid of several. The last axis varies fastest. The pole at a point is
 * extrapolated along the fastest axis on which the point is not the first.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "poles/poles.h"

#include <ritz/poles.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const int64_t most_points = 100000;

/* Number of undamped modes of the space: a fixed part, and a part for each mode
   up to the one that is followed. */
enum { LEAST_MODES = 20, EACH_MODE = 2 };

static ritz_status check_axis(const ritz_scan_axis *axis, int64_t *count)
{
    double steps = (axis->to - axis->from) / axis->step;

    RITZ_REFUSE_IF(
        (!axis->of_k && !(axis->from >= 0.0)) || !(axis->to > axis->from) ||
            !(axis->step > 0.0) || !isfinite(axis->to) || !isfinite(axis->from),
        RITZ_ERR_ARGUMENT, "a scan from %g to %g in steps of %g has no range",
        axis->from, axis->to, axis->step);
    RITZ_REFUSE_IF(!(steps < (double)most_points), RITZ_ERR_ARGUMENT,
                   "%.0f steps of a scan are too many", steps);
    /* an end that rounding puts just beyond the last step counts as a point */
    *count =
        (int64_t)floor(steps * (1.0 + RITZ_RANGE_ROUNDING) + RITZ_RANGE_STEPS) +
        1;
    return RITZ_OK;
}

/* Whether an earlier axis scans the same parameter. */
static bool is_scanned(const ritz_scan_request *request, int64_t before,
                       bool of_k, int64_t damper)
{
    for (int64_t a = 0; a < before; a++)
        for (int64_t j = 0; j < request->axis[a].count; j++)
            if (request->axis[a].of_k == of_k &&
                request->axis[a].damper[j] == damper)
                return true;
    return false;
}

/* Number of points of each axis, and the values at each point of the grid. */
static ritz_status fill_points(const ritz_scan_request *request,
                               const ritz_dampers *dampers, ritz_scan *scan)
{
    double total = 1.0;
    int64_t stride = 1;

    scan->num_axes = request->count;
    RITZ_REFUSE_IF(request->count == 0, RITZ_ERR_ARGUMENT,
                   "a scan has no values to go through");
    RITZ_CHECK_NEW(scan->size, request->count);
    for (int64_t a = 0; a < request->count; a++) {
        const ritz_scan_axis *axis = &request->axis[a];

        RITZ_CHECK(check_axis(axis, &scan->size[a]));
        for (int64_t j = 0; j < axis->count; j++)
            RITZ_REFUSE_IF(
                is_scanned(request, a, axis->of_k, axis->damper[j]),
                RITZ_ERR_ARGUMENT, "%s of damper '%s' is scanned twice",
                axis->of_k ? "k" : "c", dampers->name[axis->damper[j]]);
        total *= (double)scan->size[a];
    }
    RITZ_REFUSE_IF(!(total <= (double)most_points), RITZ_ERR_ARGUMENT,
                   "%.0f points of a scan are too many", total);
    scan->count = (int64_t)total;
    RITZ_CHECK_NEW(scan->value, scan->count * request->count);
    RITZ_CHECK_NEW(scan->s, scan->count);
    for (int64_t a = request->count - 1; a >= 0; a--) {
        for (int64_t k = 0; k < scan->count; k++)
            scan->value[k * request->count + a] =
                request->axis[a].from +
                (double)(k / stride % scan->size[a]) * request->axis[a].step;
        stride *= scan->size[a];
    }
    return RITZ_OK;
}

/* The oscillating pole of number @p mode at the first point. */
static ritz_status begin_scan(const ritz_spectrum *spectrum, int64_t mode,
                              double _Complex *out)
{
    int64_t seen = 0;
    bool found = false;

    for (int64_t j = 0; j < spectrum->count && !found; j++) {
        if (!(cimag(spectrum->s[j]) > 0.0))
            continue;
        found = seen == mode;
        *out = spectrum->s[j];
        seen++;
    }
    RITZ_REFUSE_IF(!found, RITZ_ERR_ARGUMENT,
                   "there is no mode %" PRId64 ", %" PRId64
                   " poles oscillate where the scan begins",
                   mode + 1, seen);
    return RITZ_OK;
}

/* The pole expected at point k > 0, by extrapolation. */
static double _Complex expect_pole(const ritz_scan *scan, int64_t k)
{
    int64_t stride = 1;
    int64_t a = scan->num_axes - 1;

    while (k / stride % scan->size[a] == 0)
        stride *= scan->size[a--];
    if (k / stride % scan->size[a] == 1)
        return scan->s[k - stride];
    return 2.0 * scan->s[k - stride] - scan->s[k - 2 * stride];
}

static void set_point(const ritz_scan_request *request, const ritz_scan *scan,
                      int64_t k, ritz_dampers *dampers)
{
    for (int64_t a = 0; a < request->count; a++) {
        const ritz_scan_axis *axis = &request->axis[a];
        double *values = axis->of_k ? dampers->k : dampers->c;

        for (int64_t j = 0; j < axis->count; j++)
            values[axis->damper[j]] = scan->value[k * request->count + a];
    }
}

/* Scan a dense model; K, D and the dampers are copied. */
static ritz_status scan_dense(ritz_model model,
                              const ritz_scan_request *request, ritz_scan *out)
{
    RITZ_OWN(ritz_scan) scan = {0};
    RITZ_OWN(ritz_spectrum) spectrum = {0};
    RITZ_OWN(ritz_dampers) dampers = {0};
    RITZ_OWN(ritz_dense) K = {0}, D = {0};

    RITZ_CHECK(fill_points(request, model.dampers, &scan));
    RITZ_CHECK(ritz_dense_copy(model.dense.K, &K));
    if (model.dense.D && model.dense.D->val)
        RITZ_CHECK(ritz_dense_copy(model.dense.D, &D));
    RITZ_CHECK(ritz_dampers_copy(model.dampers, &dampers));
    model.dense.K = &K;
    model.dense.D = &D;
    for (int64_t k = 0; k < scan.count; k++) {
        set_point(request, &scan, k, &dampers);
        RITZ_CHECK(ritz_dampers_install(&dampers, &K, &D));
        RITZ_CHECK(ritz_spectrum_dense(&model.dense, model.damping, &spectrum));
        if (k == 0)
            RITZ_CHECK(begin_scan(&spectrum, request->mode, &scan.s[0]));
        else
            scan.s[k] = ritz_nearest_pole(spectrum.count, spectrum.s, false,
                                          expect_pole(&scan, k));
        if (ritz_spectrum_ratio(scan.s[k]) >
            ritz_spectrum_ratio(scan.s[scan.best]))
            scan.best = k;
        ritz_spectrum_free(&spectrum);
    }
    RITZ_MOVE(*out, scan);
    return RITZ_OK;
}

ritz_status ritz_scan_of(ritz_model model, const ritz_scan_request *request,
                         ritz_scan *out)
{
    const ritz_component *c = model.component;
    RITZ_OWN(ritz_reduced) small = {0};
    ritz_span span = {.modes = EACH_MODE * (request->mode + 1) + LEAST_MODES};
    ritz_model scanned = model;

    RITZ_REFUSE_IF(model.kind == RITZ_MODEL_STATES || !model.dampers,
                   RITZ_ERR_ARGUMENT, "the model has no dampers to scan");
    if (model.kind == RITZ_MODEL_COMPONENT) {
        if (c->num_dofs > RITZ_WHOLE_DOFS)
            RITZ_CHECK(ritz_spectrum_space(c, &span, &small));
        else
            RITZ_CHECK(ritz_whole_new(c, &small));
        scanned = ritz_model_of_reduced(&small, model.damping);
        if (c->num_dofs <= RITZ_WHOLE_DOFS)
            scanned.dampers = &c->dampers;
    }
    return scan_dense(scanned, request, out);
}

void ritz_scan_free(ritz_scan *scan)
{
    RITZ_FREE(scan->size, scan->value, scan->s);
    *scan = (ritz_scan){0};
}
