/* Points of a response, chosen so that cubics between them are near. */
#include "response/responder.h"

#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"

#include <ritz/base.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A response while its points are being chosen. */

typedef struct ritz_mesh {
    ritz_responder *responder; /* borrowed */
    int64_t values;            /* a point: outputs x inputs */
    int64_t count;
    double *hertz;      /* count, ascending */
    double _Complex *H; /* count x values */
    bool *open;         /* count: from this point to the next is not settled */
    double *peak;       /* values, largest |H| that was met */
    double *level;      /* values, of ritz_noise_heed */
    double *scale;      /* values, of ritz_noise_scales */
    double _Complex *row; /* values, to work in */
} ritz_mesh;

/* H of more values than this is a mistake in the request. */
static const int64_t most_values = INT64_C(1) << 28;

/* Evaluate H into mesh->row and raise the peaks and levels to it. */
static ritz_status evaluate_mesh(ritz_mesh *mesh, double hertz)
{
    RITZ_CHECK(ritz_responder_at(mesh->responder, hertz, mesh->row));
    for (int64_t v = 0; v < mesh->values; v++)
        mesh->peak[v] = fmax(mesh->peak[v], cabs(mesh->row[v]));
    ritz_noise_heed(&mesh->responder->noise, hertz, mesh->row, mesh->level);
    return RITZ_OK;
}

static void ritz_mesh_free(ritz_mesh *mesh)
{
    RITZ_FREE(mesh->hertz, mesh->H, mesh->open, mesh->peak, mesh->level,
              mesh->scale, mesh->row);
}

/*
 * Insert points into the mesh, except those that repeat another, or differ from
 * it by rounding alone.
 *
 * @param[in] hertz  ascending
 * @param[in] H      count x values
 */
static ritz_status insert_points(ritz_mesh *mesh, int64_t count,
                                 const double *hertz, const double _Complex *H)
{
    RITZ_OWN(ritz_mesh) all = {0};
    int64_t n = mesh->values, last = mesh->count + count;
    int64_t old = 0, new = 0, to = -1;

    RITZ_REFUSE_IF(last > most_values / (n > 0 ? n : 1), RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " points do not keep the tolerance: ask for "
                   "less, or for a shorter range",
                   mesh->count);
    RITZ_CHECK_NEW(all.hertz, last);
    RITZ_CHECK_NEW(all.H, last * n);
    RITZ_CHECK_NEW(all.open, last);
    while (old + new < last) {
        bool own = new == count ||
                   (old < mesh->count && mesh->hertz[old] <= hertz[new]);
        double f = own ? mesh->hertz[old] : hertz[new];
        bool open = own ? mesh->open[old] : old == 0 || mesh->open[old - 1];

        if (to >= 0 && f - all.hertz[to] <= RITZ_SAME_KNOT * f) {
            all.open[to] = all.open[to] || open;
        } else {
            to++;
            all.hertz[to] = f;
            all.open[to] = open;
            memcpy(all.H + to * n, own ? mesh->H + old * n : H + new *n,
                   (size_t)n * sizeof *H);
        }
        old += own;
        new += !own;
    }
    ritz_array_free(&mesh->hertz);
    ritz_array_free(&mesh->H);
    ritz_array_free(&mesh->open);
    RITZ_MOVE(mesh->hertz, all.hertz);
    RITZ_MOVE(mesh->H, all.H);
    RITZ_MOVE(mesh->open, all.open);
    mesh->count = to + 1;
    return RITZ_OK;
}

/* Evaluate H at points, which ascend, and insert them. */
static ritz_status evaluate_points(ritz_mesh *mesh, int64_t count,
                                   const double *hertz)
{
    int64_t n = mesh->values;
    RITZ_OWN_ARRAY double _Complex *H = NULL;

    RITZ_CHECK_NEW(H, count * n);
    for (int64_t k = 0; k < count; k++) {
        RITZ_CHECK(evaluate_mesh(mesh, hertz[k]));
        memcpy(H + k * n, mesh->row, (size_t)n * sizeof *H);
    }
    return insert_points(mesh, count, hertz, H);
}

/* Interpolation of a response between its points, as in ritz_response_at. */

enum { CUBIC = 4 };

/* An interpolating cubic at one frequency: its points, and the weight of the
   value at each. */
typedef struct cubic {
    int64_t first, points;
    double weight[CUBIC];
} cubic;

/* The cubic at a frequency in the interval that begins at point k. */
static cubic find_cubic(int64_t count, const double *x, int64_t k, double hertz)
{
    cubic c = {.first = k - 1, .points = count < CUBIC ? count : CUBIC};

    if (c.first > count - c.points)
        c.first = count - c.points;
    if (c.first < 0)
        c.first = 0;
    x += c.first;
    for (int64_t i = 0; i < c.points; i++) {
        c.weight[i] = 1.0;
        for (int64_t j = 0; j < c.points; j++)
            if (j != i)
                c.weight[i] *= (hertz - x[j]) / (x[i] - x[j]);
    }
    return c;
}

/* Interpolated value of channel v; H has `values` channels at each point. */
static double _Complex interpolate_channel(const cubic *c, int64_t values,
                                           const double _Complex *H, int64_t v)
{
    double _Complex sum = 0.0;

    for (int64_t i = 0; i < c->points; i++)
        sum += c->weight[i] * H[(c->first + i) * values + v];
    return sum;
}

ritz_status ritz_response_at(const ritz_response *response, double hertz,
                             double _Complex *out)
{
    const ritz_response *r = response;
    int64_t values = r->num_outputs * r->num_inputs;
    double beside = 0.0;
    cubic c;

    RITZ_REFUSE_IF(r->count < 1, RITZ_ERR_ARGUMENT,
                   "the response has no points");
    beside = RITZ_RANGE_ROUNDING * r->hertz[r->count - 1];
    RITZ_REFUSE_IF(!(hertz >= r->hertz[0] - beside) ||
                       !(hertz <= r->hertz[r->count - 1] + beside),
                   RITZ_ERR_ARGUMENT,
                   "%g Hz is outside the response, which is from %g to %g Hz",
                   hertz, r->hertz[0], r->hertz[r->count - 1]);
    c = find_cubic(r->count, r->hertz,
                   ritz_upper_bound(r->count, r->hertz, hertz) - 1, hertz);
    for (int64_t i = 0; i < c.points; i++)
        RITZ_REFUSE_IF(!isfinite(c.weight[i]), RITZ_ERR_ARGUMENT,
                       "the response has %g Hz twice", hertz);
    for (int64_t v = 0; v < values; v++)
        out[v] = interpolate_channel(&c, values, r->H, v);
    return RITZ_OK;
}

/*
 * Zeros of each channel that are close enough to the axis for |H| to dip there.
 */

enum { PARTS = 8, MOST_STEPS = 5 };

/* The frequencies where they were found. */
typedef struct dips {
    int64_t count, room;
    double *hertz;
} dips;

static void dips_free(dips *f)
{
    free(f->hertz);
}

/*
 * Newton's method from a dip in (low, high): where H is a (w - z), one step is
 * at Re z. A zero that is farther from the axis than the dip is wide leads to
 * none.
 */
static ritz_status pursue_zero(ritz_mesh *mesh, int64_t v, double low,
                               double high, double _Complex slope, dips *f)
{
    double w = 0.5 * (low + high);
    double before = 0.0;
    double _Complex H = 0.0, z = 0.0;
    bool still = false;

    for (int t = 0; t < MOST_STEPS && !still; t++) {
        double _Complex last = H;

        RITZ_CHECK(evaluate_mesh(mesh, w));
        H = mesh->row[v];
        if (t > 0 && w != before)
            slope = (H - last) / (w - before);
        if (!(cabs(slope) > 0.0))
            return RITZ_OK;
        z = w - H / slope;
        before = w;
        still = H == 0.0 || fabs(creal(z) - w) <= RITZ_PEAK_PLACED * w;
        if (!still)
            w = creal(z);
        if (!(w > low && w < high))
            return RITZ_OK;
    }
    if (fabs(cimag(z)) <= high - low) {
        RITZ_CHECK_ROOM(f->hertz, f->count, f->room);
        f->hertz[f->count++] = w;
    }
    return RITZ_OK;
}

/*
 * Find the dips of one channel: where its cubics are smaller than at the
 * neighbours.
 */
static ritz_status find_channel_dips(ritz_mesh *mesh, int64_t v, dips *f)
{
    double w[3] = {0.0, 0.0, 0.0};
    double size[3] = {0.0, 0.0, 0.0};
    double _Complex H[3] = {0.0, 0.0, 0.0};
    int64_t n = 0;
    cubic c;

    for (int64_t k = 0; k + 1 < mesh->count; k++) {
        double step = (mesh->hertz[k + 1] - mesh->hertz[k]) / PARTS;

        for (int part = 0; part < PARTS; part++, n++) {
            w[0] = w[1], H[0] = H[1], size[0] = size[1];
            w[1] = w[2], H[1] = H[2], size[1] = size[2];
            w[2] = mesh->hertz[k] + part * step;
            c = find_cubic(mesh->count, mesh->hertz, k, w[2]);
            H[2] = interpolate_channel(&c, mesh->values, mesh->H, v);
            size[2] = cabs(H[2]);
            if (n < 2 || size[1] > size[0] || size[1] > size[2])
                continue;
            RITZ_CHECK(pursue_zero(mesh, v, w[0], w[2],
                                   (H[2] - H[0]) / (w[2] - w[0]), f));
        }
    }
    return RITZ_OK;
}

/*
 * Add the points where a channel has a zero near the axis: the search begins
 * where the cubics dip and iterates w := Re(w - H / H'), each step costing one
 * response.
 */
static ritz_status add_dips(ritz_mesh *mesh)
{
    RITZ_OWN(dips) f = {0};

    for (int64_t v = 0; v < mesh->values; v++)
        if (mesh->peak[v] > RITZ_CHANNEL_HEARD * mesh->scale[v])
            RITZ_CHECK(find_channel_dips(mesh, v, &f));
    if (f.count > 0)
        qsort(f.hertz, (size_t)f.count, sizeof *f.hertz, ritz_ascending);
    return evaluate_points(mesh, f.count, f.hertz);
}

/*
 * Points are added until the cubics between them are within a tolerance. As the
 * poles are known, no resonance is missed: each adds its peak and points on
 * both sides of it, and from there intervals are halved until
 *
 *     |H - cubic| <= half the tolerance x the channel's largest |H|
 *
 * holds at the middle of each interval and at a quarter of it.
 */

enum { MOST_ROUNDS = 60 };

/* The points of a grid refined around all peaks. */
static ritz_status begin_mesh(const ritz_responder *responder,
                              const ritz_grid *grid, int64_t *count,
                              double **out)
{
    int64_t n = 0, num_modes = 0;
    RITZ_OWN_ARRAY double _Complex *s = NULL;
    RITZ_OWN_ARRAY double *omega = NULL, *zeta = NULL;
    ritz_grid wide = *grid;

    wide.refine = true;
    RITZ_CHECK(ritz_responder_poles(responder, &n, &s));
    RITZ_CHECK_NEW(omega, n);
    RITZ_CHECK_NEW(zeta, n);
    for (int64_t k = 0; k < n; k++) {
        double size = cabs(s[k]);

        if (!(size > 0.0) || !(cimag(s[k]) > 0.0))
            continue;
        omega[num_modes] = size;
        zeta[num_modes++] = fmax(-creal(s[k]) / size, RITZ_LEAST_RATIO);
    }
    return ritz_grid_points(&wide, num_modes, omega, zeta, count, out);
}

/* Whether the cubics of interval k agree with H in mesh->row. */
static bool is_within(const ritz_mesh *mesh, int64_t k, double hertz,
                      double allowed)
{
    cubic c = find_cubic(mesh->count, mesh->hertz, k, hertz);

    for (int64_t v = 0; v < mesh->values; v++) {
        double _Complex at = interpolate_channel(&c, mesh->values, mesh->H, v);

        if (!(cabs(at - mesh->row[v]) <= allowed * mesh->scale[v]))
            return false;
    }
    return true;
}

/*
 * Evaluate H at the middle of interval k and decide whether that point is
 * needed.
 */
static ritz_status test_interval(ritz_mesh *mesh, int64_t k, double allowed,
                                 double *hertz, double _Complex *H,
                                 bool *needed)
{
    double low = mesh->hertz[k];
    double step = mesh->hertz[k + 1] - low;

    *hertz = low + 0.5 * step;
    RITZ_CHECK(evaluate_mesh(mesh, *hertz));
    memcpy(H, mesh->row, (size_t)mesh->values * sizeof *H);
    *needed = !is_within(mesh, k, *hertz, allowed);
    if (!*needed) {
        RITZ_CHECK(evaluate_mesh(mesh, low + RITZ_SAMPLED_AT * step));
        *needed = !is_within(mesh, k, low + RITZ_SAMPLED_AT * step, allowed);
    }
    RITZ_REFUSE_IF(*needed &&
                       step <= RITZ_SHORTEST_INTERVAL * mesh->hertz[k + 1],
                   RITZ_ERR_CONVERGENCE,
                   "the response does not settle at %.9g Hz: is there a mode "
                   "without damping, or a tolerance beneath its rounding",
                   *hertz);
    return RITZ_OK;
}

/*
 * Halve each open interval whose cubics are not within the tolerance; *added
 * counts the new points.
 */
static ritz_status halve_open(ritz_mesh *mesh, double allowed, int64_t *added)
{
    RITZ_OWN_ARRAY double *hertz = NULL;
    RITZ_OWN_ARRAY double _Complex *H = NULL;
    int64_t last = mesh->count - 1, num_open = 0, n = 0;

    for (int64_t k = 0; k < last; k++)
        num_open += mesh->open[k];
    RITZ_CHECK_NEW(hertz, num_open);
    RITZ_CHECK_NEW(H, num_open * mesh->values);
    for (int64_t k = 0; k < last; k++) {
        bool needed = false;

        if (!mesh->open[k])
            continue;
        RITZ_CHECK(test_interval(mesh, k, allowed, &hertz[n],
                                 H + n * mesh->values, &needed));
        mesh->open[k] = needed;
        n += needed;
        ritz_monitor_step("points", mesh->count + n, 0);
    }
    RITZ_CHECK(insert_points(mesh, n, hertz, H));
    *added = n;
    return RITZ_OK;
}

/*
 * Build the response: names and poles without points, then the points of the
 * mesh.
 */
static ritz_status build_response(ritz_mesh *mesh, const ritz_grid *grid,
                                  double tolerance, ritz_response *out)
{
    const ritz_responder *responder = mesh->responder;
    const ritz_grid ends = {
        .from_hz = grid->from_hz, .to_hz = grid->to_hz, .count = 2};
    ritz_response r = {0};

    RITZ_CHECK(ritz_response_new(&ends, responder->poles, &r));
    ritz_responder_sign(responder, &r);
    RITZ_FREE(r.hertz, r.H);
    r.count = mesh->count;
    RITZ_MOVE(r.hertz, mesh->hertz);
    RITZ_MOVE(r.H, mesh->H);
    (void)snprintf(r.interpolation, sizeof r.interpolation, "cubic");
    r.tolerance = tolerance;
    *out = r;
    return RITZ_OK;
}

ritz_status ritz_responder_follow(ritz_responder *responder,
                                  const ritz_grid *grid, double tolerance,
                                  ritz_response *out)
{
    const ritz_io *io = &responder->poles->io;
    RITZ_OWN_ARRAY double *hertz = NULL;
    int64_t count = 0, added = 1, values = io->num_outputs * io->num_inputs;
    RITZ_OWN(ritz_mesh) mesh = {.responder = responder, .values = values};

    RITZ_REFUSE_IF(!(tolerance > 0.0) || !(tolerance < 1.0), RITZ_ERR_ARGUMENT,
                   "a tolerance of %g is not between 0 and 1", tolerance);
    RITZ_REFUSE_IF(grid->hertz, RITZ_ERR_ARGUMENT,
                   "points that are given cannot be chosen by a tolerance");
    RITZ_CHECK(begin_mesh(responder, grid, &count, &hertz));
    RITZ_CHECK_NEW(mesh.peak, values);
    RITZ_CHECK_NEW(mesh.level, values);
    RITZ_CHECK_NEW(mesh.scale, values);
    RITZ_CHECK_NEW(mesh.row, values);
    RITZ_CHECK(evaluate_points(&mesh, count, hertz));
    for (int round = 0; round < MOST_ROUNDS && added > 0; round++) {
        ritz_noise_scales(io->num_outputs, io->num_inputs,
                          RITZ_SAMPLED_MARGIN * tolerance, mesh.peak,
                          mesh.level, mesh.scale);
        RITZ_CHECK(halve_open(&mesh, RITZ_SAMPLED_MARGIN * tolerance, &added));
    }
    RITZ_CHECK(add_dips(&mesh));
    return build_response(&mesh, grid, tolerance, out);
}
