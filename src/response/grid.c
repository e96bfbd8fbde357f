/*
 * The frequencies at which a response is computed. A resonance of ratio zeta at
 * frequency f is 2 zeta f wide at half its power: an even grid steps over it as
 * soon as its own step is wider. With `refine` each gets its peak and points on
 * both sides that lie 1/4 to 8 widths away.
 */
#include "base/search.h"
#include "poles/poles.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* In half-power widths. */
static const double beside[] = {0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
enum { BESIDE = sizeof beside / sizeof *beside, AROUND = 2 * BESIDE + 1 };
static const int64_t most_points = 100000000;

/* Given points must ascend, and none may be negative. */
static ritz_status check_points(const ritz_grid *grid)
{
    RITZ_REFUSE_IF(grid->count < 1, RITZ_ERR_ARGUMENT,
                   "a response needs at least one frequency");
    for (int64_t k = 0; k < grid->count; k++)
        RITZ_REFUSE_IF(!isfinite(grid->hertz[k]) || grid->hertz[k] < 0.0 ||
                           (k > 0 && grid->hertz[k] <= grid->hertz[k - 1]),
                       RITZ_ERR_ARGUMENT,
                       "frequencies do not ascend from 0 Hz at %g",
                       grid->hertz[k]);
    return RITZ_OK;
}

ritz_status ritz_grid_check(const ritz_grid *grid)
{
    if (grid->hertz)
        return check_points(grid);
    RITZ_REFUSE_IF(!isfinite(grid->from_hz) || !isfinite(grid->to_hz) ||
                       grid->from_hz < 0.0 || grid->from_hz >= grid->to_hz,
                   RITZ_ERR_ARGUMENT,
                   "a response from %g to %g Hz has no range", grid->from_hz,
                   grid->to_hz);
    RITZ_REFUSE_IF(grid->count < 2, RITZ_ERR_ARGUMENT,
                   "a response needs at least two frequencies");
    RITZ_REFUSE_IF(grid->count > most_points, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " frequencies are too many", grid->count);
    RITZ_REFUSE_IF(grid->log && !(grid->from_hz > 0.0), RITZ_ERR_ARGUMENT,
                   "a logarithmic grid cannot begin at 0 Hz");
    return RITZ_OK;
}

static double place_even(const ritz_grid *grid, int64_t k)
{
    double t = (double)k / (double)(grid->count - 1);

    if (grid->hertz)
        return grid->hertz[k];
    if (k == 0)
        return grid->from_hz;
    if (k == grid->count - 1)
        return grid->to_hz;
    return grid->log ? grid->from_hz * pow(grid->to_hz / grid->from_hz, t)
                     : grid->from_hz + t * (grid->to_hz - grid->from_hz);
}

/* Peak of 1/|w^2 - x^2 + 2 i zeta w x|, then the points on both sides of it. */
static void place_around(double omega, double zeta, double out[static AROUND])
{
    double f = omega / (2.0 * RITZ_PI);
    double peak = zeta < sqrt(0.5) ? f * sqrt(1.0 - 2.0 * zeta * zeta) : f;

    out[0] = peak;
    for (int k = 0; k < BESIDE; k++) {
        out[1 + 2 * k] = peak - beside[k] * 2.0 * zeta * f;
        out[2 + 2 * k] = peak + beside[k] * 2.0 * zeta * f;
    }
}

static int64_t remove_equal(int64_t count, double *f)
{
    int64_t kept = 0;

    qsort(f, (size_t)count, sizeof *f, ritz_ascending);
    for (int64_t k = 0; k < count; k++)
        if (kept == 0 || f[k] - f[kept - 1] > RITZ_SAME_POINT * f[k])
            f[kept++] = f[k];
    return kept;
}

ritz_status ritz_grid_points(const ritz_grid *grid, int64_t num_modes,
                             const double *omega, const double *zeta,
                             int64_t *count, double **out)
{
    int64_t n = 0;
    RITZ_OWN_ARRAY double *f = NULL;
    double extra[AROUND];

    RITZ_CHECK(ritz_grid_check(grid));
    RITZ_CHECK_NEW(f, grid->count + (grid->refine ? num_modes * AROUND : 0));
    for (n = 0; n < grid->count; n++)
        f[n] = place_even(grid, n);
    for (int64_t k = 0; grid->refine && !grid->hertz && k < num_modes; k++) {
        if (!(omega[k] > 0.0 && zeta[k] > 0.0)) /* no width to resolve */
            continue;
        place_around(omega[k], zeta[k], extra);
        for (int a = 0; a < AROUND; a++)
            if (extra[a] >= grid->from_hz && extra[a] <= grid->to_hz)
                f[n++] = extra[a];
    }
    *count = grid->hertz ? n : remove_equal(n, f);
    RITZ_MOVE(*out, f);
    return RITZ_OK;
}
