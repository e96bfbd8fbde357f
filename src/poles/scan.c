/* One mode followed while dampers change. */
#include <ritz/spectrum.h>

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const int64_t most_points = 100000;

static ritz_status check_range(const ritz_scan_request *request, int64_t *count)
{
    double steps = (request->to - request->from) / request->step;

    RITZ_REFUSE_IF(!(request->from >= 0.0) || !(request->to > request->from) ||
                       !(request->step > 0.0) || !isfinite(request->to),
                   RITZ_ERR_ARGUMENT,
                   "a scan from %g to %g in steps of %g has no range",
                   request->from, request->to, request->step);
    RITZ_REFUSE_IF(!(steps < (double)most_points), RITZ_ERR_ARGUMENT,
                   "%.0f steps of a scan are too many", steps);
    /* an end that rounding puts a hair beyond the last step belongs to it */
    *count = (int64_t)floor(steps * (1.0 + 1e-12) + 1e-9) + 1;
    return RITZ_OK;
}

/* The mode-th oscillating pole. */
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

static double _Complex nearest_pole(const ritz_spectrum *spectrum,
                                    double _Complex s)
{
    double _Complex best = nan("");
    double least = HUGE_VAL;

    for (int64_t j = 0; j < spectrum->count; j++)
        if (cabs(spectrum->s[j] - s) < least) {
            least = cabs(spectrum->s[j] - s);
            best = spectrum->s[j];
        }
    return best;
}

/* The model that is scanned: copies of K, D and the dampers. */
typedef struct bench {
    ritz_dense K, D;
    ritz_dampers dampers;
    ritz_second_order model;
} bench;

static void bench_free(bench *b)
{
    ritz_dense_free(&b->K);
    ritz_dense_free(&b->D);
    ritz_dampers_free(&b->dampers);
}

static ritz_status bench_new(const ritz_second_order *model,
                             const ritz_dampers *dampers, bench *b)
{
    RITZ_CHECK(ritz_dense_copy(model->K, &b->K));
    if (model->D && model->D->val)
        RITZ_CHECK(ritz_dense_copy(model->D, &b->D));
    RITZ_CHECK(ritz_dampers_copy(dampers, &b->dampers));
    b->model = *model;
    b->model.K = &b->K;
    b->model.D = &b->D;
    return RITZ_OK;
}

static ritz_status poles_at(bench *b, const ritz_scan_request *request,
                            const ritz_damping *damping, double c,
                            ritz_spectrum *out)
{
    for (int64_t j = 0; j < request->count; j++)
        b->dampers.c[request->damper[j]] = c;
    RITZ_CHECK(ritz_dampers_install(&b->dampers, &b->K, &b->D));
    return ritz_spectrum_dense(&b->model, damping, out);
}

ritz_status ritz_scan_dampers(const ritz_second_order *model,
                              const ritz_dampers *dampers,
                              const ritz_damping *damping,
                              const ritz_scan_request *request, ritz_scan *out)
{
    ritz_status status = RITZ_OK;
    ritz_scan scan = {0};
    ritz_spectrum spectrum = {0};
    bench b = {0};

    RITZ_TRY(check_range(request, &scan.count));
    RITZ_TRY(bench_new(model, dampers, &b));
    RITZ_NEW(scan.c, scan.count);
    RITZ_NEW(scan.s, scan.count);
    for (int64_t k = 0; k < scan.count; k++) {
        scan.c[k] = request->from + (double)k * request->step;
        RITZ_TRY(poles_at(&b, request, damping, scan.c[k], &spectrum));
        if (k == 0)
            RITZ_TRY(begin_scan(&spectrum, request->mode, &scan.s[0]));
        else
            scan.s[k] = nearest_pole(&spectrum, k == 1 ? scan.s[0]
                                                       : 2.0 * scan.s[k - 1] -
                                                             scan.s[k - 2]);
        if (ritz_spectrum_ratio(scan.s[k]) >
            ritz_spectrum_ratio(scan.s[scan.best]))
            scan.best = k;
        ritz_spectrum_free(&spectrum);
    }
    *out = scan;
    scan = (ritz_scan){0};
done:
    ritz_spectrum_free(&spectrum);
    ritz_scan_free(&scan);
    bench_free(&b);
    return status;
}

void ritz_scan_free(ritz_scan *scan)
{
    free(scan->c);
    free(scan->s);
    *scan = (ritz_scan){0};
}
