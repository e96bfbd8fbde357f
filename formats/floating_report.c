#include "formats/floating_report.h"

#include "base/tolerances.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static ritz_status say_frame(const ritz_floating *body,
                             ritz_export_report *report)
{
    const double *o = body->origin;
    const double *c = body->inertia.centre;
    const double *rigid = body->invariants.rigid;
    const double m = body->inertia.mass;
    char at[40] = "the basic origin";

    if (body->grid >= 0)
        snprintf(at, sizeof at, "grid %" PRId64, body->grid);
    else if (o[0] != 0.0 || o[1] != 0.0 || o[2] != 0.0)
        snprintf(at, sizeof at, "the centre of mass");
    RITZ_CHECK(ritz_export_say(report,
                               "frame at %s, (%.9g, %.9g, %.9g) in basic "
                               "coordinates, along basic axes",
                               at, o[0], o[1], o[2]));
    RITZ_CHECK(ritz_export_say(report,
                               "mass %.9g, its centre at (%.9g, %.9g, %.9g) "
                               "from the frame",
                               m, c[0], c[1], c[2]));
    if (fabs(rigid[0] - m) + fabs(rigid[7] - m) + fabs(rigid[14] - m) >
        RITZ_MASS_AGREES * m)
        RITZ_CHECK(ritz_export_say(report,
                                   "mass differs by direction, %.6g %.6g %.6g: "
                                   "are dofs fixed? Their mean is taken",
                                   rigid[0], rigid[7], rigid[14]));
    return RITZ_OK;
}

static ritz_status say_modes(const ritz_floating *body,
                             ritz_export_report *report)
{
    static const char *const conditions[] = {
        [RITZ_REFERENCE_NONE] = "as the basis has them",
        [RITZ_REFERENCE_MEAN_AXIS] =
            "referred to mean axes (they have no momentum)",
        [RITZ_REFERENCE_TANGENT] =
            "tangent to the frame (its node stays where it is)",
    };

    RITZ_CHECK(ritz_export_say(
        report,
        "%" PRId64 " flexible modes, %.6g to %.6g Hz, at %" PRId64 " nodes",
        body->V.ncol, body->lowest_hz, body->highest_hz, body->count));
    RITZ_CHECK(ritz_export_say(
        report, "%" PRId64 " rigid %s left to the moving frame%s",
        body->num_rigid, body->kept ? "columns" : "motions",
        body->kept ? "" : ", the modes are eigenvectors of the others"));
    return ritz_export_say(report, "reference %s: modes are %s",
                           ritz_frame_condition_name(body->reference),
                           conditions[body->reference]);
}

ritz_status ritz_floating_say(const ritz_floating *body,
                              ritz_export_report *report)
{
    RITZ_CHECK(say_frame(body, report));
    RITZ_CHECK(say_modes(body, report));
    if (body->approximate > RITZ_ENERGY_LOST)
        RITZ_CHECK(ritz_export_say(report,
                                   "invariants are approximate: mode %" PRId64
                                   " loses %.2g of its kinetic energy",
                                   body->approximate_mode + 1,
                                   body->approximate));
    return RITZ_OK;
}

ritz_status ritz_floating_say_damping(const ritz_reduced *reduced,
                                      const ritz_floating *body,
                                      ritz_export_report *report)
{
    if (reduced->damping[0])
        RITZ_CHECK(
            ritz_export_say(report, "damping '%s' is in D", reduced->damping));
    if (body->structural)
        RITZ_CHECK(ritz_export_say(
            report,
            "structural damping left out: the file has no place for it"));
    return RITZ_OK;
}
