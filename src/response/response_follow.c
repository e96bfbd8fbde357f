/*
 * Points chosen until the cubics between them keep a tolerance. Where poles are
 * is known, so that none is passed over: each adds its peak and points beside
 * it, and from there intervals are halved,
 *
 *     |H - cubic| <= half the tolerance x the channel's largest |H|
 *
 * at their middle and at a quarter of them.
 */
#include "response/mesh.h"

#include "base/alloc.h"

#include <ritz/monitor.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROUNDS = 60 };
/* Of its frequency: an interval this short is not halved. */
static const double shortest = 4e-9;
/* An undamped pole is a point, at which the responder says what is wrong. */
static const double least_ratio = 1e-15;
/* What is measured at a few places is held to this part. */
static const double margin = 0.5;
static const double quarter = 0.25;

/* The points of a grid, of all peaks and beside them. */
static ritz_status begin(const ritz_responder *responder, const ritz_grid *grid,
                         int64_t *count, double **out)
{
    ritz_status status = RITZ_OK;
    int64_t n = 0, num_modes = 0;
    double _Complex *s = NULL;
    double *omega = NULL, *zeta = NULL;
    ritz_grid wide = *grid;

    wide.refine = true;
    RITZ_TRY(ritz_responder_poles(responder, &n, &s));
    RITZ_NEW(omega, n);
    RITZ_NEW(zeta, n);
    for (int64_t k = 0; k < n; k++) {
        double size = cabs(s[k]);

        if (!(size > 0.0) || !(cimag(s[k]) > 0.0))
            continue;
        omega[num_modes] = size;
        zeta[num_modes++] = fmax(-creal(s[k]) / size, least_ratio);
    }
    RITZ_TRY(ritz_grid_points(&wide, num_modes, omega, zeta, count, out));
done:
    free(s);
    free(omega);
    free(zeta);
    return status;
}

/* Whether the cubics of interval k say what mesh->row is. */
static bool agrees(ritz_mesh *mesh, int64_t k, double hertz, double allowed)
{
    double weight[4];
    int64_t first = 0;
    int points = ritz_cubic(mesh->count, mesh->hertz, k, hertz, &first, weight);

    ritz_cubic_mix(points, weight, mesh->values, mesh->H + first * mesh->values,
                   mesh->between);
    for (int64_t v = 0; v < mesh->values; v++)
        if (!(cabs(mesh->between[v] - mesh->row[v]) <=
              allowed * mesh->scale[v]))
            return false;
    return true;
}

/* Interval k: its middle in hertz and H, and whether that is needed. */
static ritz_status test(ritz_mesh *mesh, int64_t k, double allowed,
                        double *hertz, double _Complex *H, bool *needed)
{
    double low = mesh->hertz[k];
    double step = mesh->hertz[k + 1] - low;

    *hertz = low + 0.5 * step;
    RITZ_CHECK(ritz_mesh_ask(mesh, *hertz));
    memcpy(H, mesh->row, (size_t)mesh->values * sizeof *H);
    *needed = !agrees(mesh, k, *hertz, allowed);
    if (!*needed) {
        RITZ_CHECK(ritz_mesh_ask(mesh, low + quarter * step));
        *needed = !agrees(mesh, k, low + quarter * step, allowed);
    }
    RITZ_REFUSE_IF(*needed && step <= shortest * mesh->hertz[k + 1],
                   RITZ_ERR_CONVERGENCE,
                   "the response does not settle at %.9g Hz: is there a mode "
                   "without damping, or a tolerance beneath its rounding",
                   *hertz);
    return RITZ_OK;
}

/* Halve what is open and does not hold; *added how many. */
static ritz_status halve(ritz_mesh *mesh, double allowed, int64_t *added)
{
    ritz_status status = RITZ_OK;
    double *hertz = NULL;
    double _Complex *H = NULL;
    int64_t last = mesh->count - 1, num_open = 0, n = 0;

    for (int64_t k = 0; k < last; k++)
        num_open += mesh->open[k];
    RITZ_NEW(hertz, num_open);
    RITZ_NEW(H, num_open * mesh->values);
    for (int64_t k = 0; k < last; k++) {
        bool needed = false;

        if (!mesh->open[k])
            continue;
        RITZ_TRY(
            test(mesh, k, allowed, &hertz[n], H + n * mesh->values, &needed));
        mesh->open[k] = needed;
        n += needed;
        ritz_monitor_step("points", mesh->count + n, 0);
    }
    RITZ_TRY(ritz_mesh_insert(mesh, n, hertz, H));
    *added = n;
done:
    free(hertz);
    free(H);
    return status;
}

/* A response of no points, then those of the mesh. */
static ritz_status hand_over(ritz_mesh *mesh, const ritz_grid *grid,
                             double tolerance, ritz_response *out)
{
    const ritz_responder *responder = mesh->responder;
    const ritz_grid ends = {
        .from_hz = grid->from_hz, .to_hz = grid->to_hz, .count = 2};
    ritz_response r = {0};

    RITZ_CHECK(ritz_response_new(&ends, responder->poles,
                                 responder->engine->name, NULL, &r));
    free(r.hertz);
    free(r.H);
    r.count = mesh->count;
    r.hertz = mesh->hertz;
    r.H = mesh->H;
    mesh->hertz = NULL;
    mesh->H = NULL;
    memcpy(r.damping, responder->damping, sizeof r.damping);
    (void)snprintf(r.interpolation, sizeof r.interpolation, "cubic");
    r.tolerance = tolerance;
    *out = r;
    return RITZ_OK;
}

ritz_status ritz_responder_follow(ritz_responder *responder,
                                  const ritz_grid *grid, double tolerance,
                                  ritz_response *out)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = &responder->poles->io;
    double *hertz = NULL;
    int64_t count = 0, added = 1;
    ritz_mesh mesh = {0};

    RITZ_FAIL_IF(!(tolerance > 0.0) || !(tolerance < 1.0), RITZ_ERR_ARGUMENT,
                 "a tolerance of %g is not between 0 and 1", tolerance);
    RITZ_FAIL_IF(grid->hertz, RITZ_ERR_ARGUMENT,
                 "points that are given cannot be chosen by a tolerance");
    RITZ_TRY(begin(responder, grid, &count, &hertz));
    RITZ_TRY(ritz_mesh_new(responder, count, hertz, &mesh));
    for (int round = 0; round < MOST_ROUNDS && added > 0; round++) {
        ritz_noise_scales(io->num_outputs, io->num_inputs, margin * tolerance,
                          mesh.peak, mesh.level, mesh.scale);
        RITZ_TRY(halve(&mesh, margin * tolerance, &added));
    }
    RITZ_TRY(ritz_mesh_add_dips(&mesh));
    RITZ_TRY(hand_over(&mesh, grid, tolerance, out));
done:
    free(hertz);
    ritz_mesh_free(&mesh);
    return status;
}
