/*
 * Coordinate systems of bulk data.
 *
 *     A origin, B on the z axis, C in the x-z plane:
 *     e_z = (B - A) / |B - A|,  e_y ~ e_z x (C - A),  e_x = e_y x e_z
 *
 *     coordinates        cylindrical r, theta, z     spherical r, theta, phi
 *     x                  r cos(theta)                r sin(theta) cos(phi)
 *     y                  r sin(theta)                r sin(theta) sin(phi)
 *     z                  z                           r cos(theta)
 *
 * with angles in degrees. Displacements are along the directions in which the
 * coordinates grow. Where these are not defined, on the z axis of either, they
 * are the frame's own axes x, y, z, which is what the public NASTRAN does.
 */
#include "formats/bulk_parts.h"

#include "base/tolerances.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>

static void cross(const double a[static 3], const double b[static 3],
                  double out[static 3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double norm(const double a[static 3])
{
    return hypot(hypot(a[0], a[1]), a[2]);
}

static void divide(double a[static 3], double by)
{
    for (int k = 0; k < 3; k++)
        a[k] /= by;
}

/* sin and cos of an angle in degrees, exact where they are 0 or 1. */
static void turn(double degrees, double *sine, double *cosine)
{
    static const double EXACT[] = {0.0, 1.0, 0.0, -1.0, 0.0};
    double angle = degrees * (RITZ_PI / 180.0);
    double quarters = degrees / 90.0;
    int quarter = 0;

    *sine = sin(angle);
    *cosine = cos(angle);
    if (quarters == floor(quarters) && fabs(quarters) < 1e9) {
        quarter = (int)(((int64_t)quarters % 4 + 4) % 4);
        *sine = EXACT[quarter];
        *cosine = EXACT[quarter + 1];
    }
}

/* Coordinates of a kind of frame as x, y, z along its axes. */
static void straighten(int32_t kind, const double x[static 3],
                       double out[static 3])
{
    double s = 0.0;
    double c = 1.0;
    double s_phi = 0.0;
    double c_phi = 1.0;

    memcpy(out, x, 3 * sizeof *out);
    if (kind == RITZ_RECTANGULAR)
        return;
    turn(x[1], &s, &c);
    if (kind == RITZ_CYLINDRICAL) {
        out[0] = x[0] * c;
        out[1] = x[0] * s;
        return;
    }
    turn(x[2], &s_phi, &c_phi);
    out[0] = x[0] * s * c_phi;
    out[1] = x[0] * s * s_phi;
    out[2] = x[0] * c;
}

void ritz_bulk_position(const ritz_bulk_frame *frame, const double x[static 3],
                        double out[static 3])
{
    double local[3];

    if (!frame) {
        memcpy(out, x, 3 * sizeof *out);
        return;
    }
    straighten(frame->kind, x, local);
    for (int j = 0; j < 3; j++)
        out[j] = frame->origin[j] + local[0] * frame->axes[j] +
                 local[1] * frame->axes[3 + j] + local[2] * frame->axes[6 + j];
}

/* Rows: directions of growing coordinates, along the frame's own axes. */
static void local_axes(int32_t kind, const double p[static 3], double r,
                       double out[static 9])
{
    double radius = norm(p);
    double c_phi = p[0] / r;
    double s_phi = p[1] / r;
    double s = r / radius;
    double c = p[2] / radius;
    const double round[9] = {c_phi, s_phi, 0, -s_phi, c_phi, 0, 0, 0, 1};
    const double sphere[9] = {s * c_phi, s * s_phi, c,     c * c_phi, c * s_phi,
                              -s,        -s_phi,    c_phi, 0.0};

    memcpy(out, kind == RITZ_CYLINDRICAL ? round : sphere, sizeof round);
}

void ritz_bulk_axes(const ritz_bulk_frame *frame,
                    const double position[static 3], double out[static 9])
{
    double p[3] = {0.0, 0.0, 0.0};
    double local[9];
    double scale = norm(position) + norm(frame->origin);
    double r = 0.0;

    memcpy(out, frame->axes, sizeof frame->axes);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            p[i] += frame->axes[3 * i + j] * (position[j] - frame->origin[j]);
    r = hypot(p[0], p[1]);
    /* On the axis up to the rounding of the position: some ten operations on
     * numbers up to the scale. */
    if (frame->kind == RITZ_RECTANGULAR || r <= 16.0 * DBL_EPSILON * scale)
        return;
    local_axes(frame->kind, p, r, local);
    for (int64_t i = 0; i < 3; i++)
        for (int64_t j = 0; j < 3; j++)
            out[3 * i + j] = local[3 * i] * frame->axes[j] +
                             local[3 * i + 1] * frame->axes[3 + j] +
                             local[3 * i + 2] * frame->axes[6 + j];
}

ritz_status ritz_bulk_orient(const ritz_bulk_cards *all,
                             const double A[static 3], const double B[static 3],
                             const double C[static 3], ritz_bulk_frame *frame)
{
    double *e_x = &frame->axes[0];
    double *e_y = &frame->axes[3];
    double *e_z = &frame->axes[6];
    double to_C[3];
    double z = 0.0;
    double y = 0.0;

    for (int k = 0; k < 3; k++) {
        frame->origin[k] = A[k];
        e_z[k] = B[k] - A[k];
        to_C[k] = C[k] - A[k];
    }
    z = norm(e_z);
    if (z > 0.0)
        divide(e_z, z);
    cross(e_z, to_C, e_y);
    y = norm(e_y);
    /* below the root of epsilon, x would keep less than half its digits */
    if (!(z > 0.0 && y > 1.5e-8 * norm(to_C) && isfinite(z) && isfinite(y)))
        RITZ_CHECK(ritz_cards_refuse(&all->cards, frame->line,
                                     "the three points of coordinate system "
                                     "%" PRId64 " lie on a line",
                                     frame->id));
    divide(e_y, y);
    cross(e_y, e_z, e_x);
    return RITZ_OK;
}
