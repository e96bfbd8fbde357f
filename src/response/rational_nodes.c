/* Where nodes may be, which comes next, and when there are enough. */
#include "response/rational.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/monitor.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { EVEN = 1000, BETWEEN = 16, MOST_NODES = 300, OFFSETS = 3 };

/* Of its frequency: nodes begin so far beside an undamped pole, and keep so far
   off all poles and zeros. */
static const double beside = 1e-4;
static const double clear = 1e-6;
/* Beside a pole, in half-power widths. */
static const double offset[OFFSETS] = {1.0, 4.0, 16.0};

/* Whether s is on, or by rounding beside, one of some points. */
static bool is_on(double _Complex s, int64_t count, const double _Complex *at,
                  double unit)
{
    for (int64_t k = 0; k < count; k++)
        if (cabs(s - at[k] * unit) <= clear * cabs(s))
            return true;
    return false;
}

/* A frequency where a node may be: on no pole and on no zero. */
static void add_candidate(ritz_nodes *s, double hertz, double low, double high)
{
    const double _Complex at = ritz_complex(0.0, 2.0 * RITZ_PI * hertz);
    bool on = !(hertz >= low && hertz <= high) ||
              is_on(at, s->num_poles, s->pole, 1.0);

    for (int64_t v = 0; v < s->values; v++)
        on = on ||
             is_on(at, s->both.num_zeros[v], s->both.zero[v], s->both.unit);
    if (!on)
        s->hertz[s->count++] = hertz;
}

static int ascending(const void *left, const void *right)
{
    const double *a = left;
    const double *b = right;

    return (*a > *b) - (*a < *b);
}

/* Beside resonances, between them, and so many towards both ends that among
 * them are Leja points, which gather there. */
ritz_status ritz_nodes_place(ritz_nodes *s, double low, double high)
{
    ritz_status status = RITZ_OK;
    double *at = NULL;
    int64_t n = 0;

    RITZ_NEW(at, s->num_poles + 2);
    RITZ_NEW(s->hertz, EVEN + (s->num_poles + 2) * (BETWEEN + 1 + 2 * OFFSETS));
    for (int k = 1; k < EVEN; k++)
        add_candidate(
            s, 0.5 * (low + high - (high - low) * cos(RITZ_PI * k / EVEN)), low,
            high);
    at[n++] = low;
    at[n++] = high;
    for (int64_t k = 0; k < s->num_poles; k++) {
        double hertz = cimag(s->pole[k]) / (2.0 * RITZ_PI);
        double width = -creal(s->pole[k]) / (2.0 * RITZ_PI);

        if (hertz <= low || hertz >= high)
            continue;
        at[n++] = hertz;
        width = fmax(width, beside * hertz);
        for (int o = 0; o < OFFSETS; o++) {
            add_candidate(s, hertz - offset[o] * width, low, high);
            add_candidate(s, hertz + offset[o] * width, low, high);
        }
    }
    qsort(at, (size_t)n, sizeof *at, ascending);
    for (int64_t k = 0; k + 1 < n; k++)
        for (int part = 0; part <= BETWEEN; part++)
            if (part < BETWEEN || k + 2 == n)
                add_candidate(s, at[k] + (at[k + 1] - at[k]) * part / BETWEEN,
                              low, high);
    RITZ_NEW(s->used, s->count);
done:
    free(at);
    return status;
}

/* The candidate that helps most, -1 if none is left. */
static int64_t next(const ritz_nodes *s)
{
    double most = -HUGE_VAL;
    int64_t best = -1;

    for (int64_t k = 0; k < s->count; k++) {
        double w = 2.0 * RITZ_PI * s->hertz[k];
        double need =
            s->used[k] ? -HUGE_VAL
                       : ritz_interpolant_need(&s->poles, ritz_complex(0.0, w));

        if (need > most) {
            most = need;
            best = k;
        }
    }
    return best;
}

static ritz_status add_node(ritz_nodes *s, double hertz)
{
    const double _Complex at = ritz_complex(0.0, 2.0 * RITZ_PI * hertz);

    RITZ_CHECK(ritz_interpolant_add(&s->poles, at, s->H));
    RITZ_CHECK(ritz_interpolant_add(&s->both, at, s->H));
    s->nodes++;
    if (!s->mirror || hertz == 0.0)
        return RITZ_OK;
    for (int64_t v = 0; v < s->values; v++)
        s->H[v] = conj(s->H[v]);
    RITZ_CHECK(ritz_interpolant_add(&s->poles, -at, s->H));
    return ritz_interpolant_add(&s->both, -at, s->H);
}

/* What either interpolant missed at a new node; whether one did not. */
static bool judge(ritz_nodes *s, double hertz, double tolerance)
{
    const double _Complex at = ritz_complex(0.0, 2.0 * RITZ_PI * hertz);
    const ritz_io *io = &s->full.component->io;
    double *miss = s->miss + s->nodes % RITZ_RATIONAL_ENOUGH * 2 * s->values;
    bool near = s->nodes >= RITZ_RATIONAL_ENOUGH;

    ritz_interpolant_at(&s->poles, at, s->guess);
    ritz_interpolant_at(&s->both, at, s->other);
    for (int64_t v = 0; v < s->values; v++)
        s->peak[v] = fmax(s->peak[v], cabs(s->H[v]));
    ritz_noise_heed(s->noise, hertz, s->H, s->level);
    ritz_noise_scales(io->num_outputs, io->num_inputs, tolerance, s->peak,
                      s->level, s->scale);
    for (int64_t v = 0; v < s->values; v++) {
        miss[v] = cabs(s->guess[v] - s->H[v]);
        miss[s->values + v] = cabs(s->other[v] - s->H[v]);
    }
    for (int64_t k = 0; k < 2 * s->values; k++) {
        s->missed[k] = 0.0;
        for (int64_t t = 0; t < RITZ_RATIONAL_ENOUGH; t++)
            s->missed[k] = fmax(s->missed[k], s->miss[t * 2 * s->values + k]);
    }
    for (int64_t v = 0; v < s->values; v++) {
        s->with_zeros[v] = s->missed[s->values + v] < s->missed[v];
        near = near && fmin(s->missed[v], s->missed[s->values + v]) <=
                           tolerance * s->scale[v];
    }
    return near;
}

ritz_status ritz_nodes_converge(ritz_nodes *s, double tolerance)
{
    bool near = false;

    while (!near) {
        int64_t k = next(s);

        RITZ_REFUSE_IF(k < 0 || s->nodes >= MOST_NODES, RITZ_ERR_CONVERGENCE,
                       "%" PRId64 " nodes do not interpolate to %.1e of the "
                       "largest response: krylov may",
                       s->nodes, tolerance);
        s->used[k] = true;
        memset(s->H, 0, (size_t)s->values * sizeof *s->H);
        RITZ_CHECK(ritz_direct_at(&s->full, s->hertz[k], s->H));
        near = judge(s, s->hertz[k], tolerance);
        RITZ_CHECK(add_node(s, s->hertz[k]));
        ritz_monitor_step("nodes", s->nodes, 0);
    }
    return RITZ_OK;
}
