/* Report lines about a body in a floating frame, shared by exporters. */
#ifndef RITZ_FORMATS_FLOATING_REPORT_H
#define RITZ_FORMATS_FLOATING_REPORT_H

#include "model/floating.h"

#include <ritz/export.h>

/** Report the frame, the mass, the modes, their reference condition, and an
 * approximation of invariants. */
ritz_status ritz_floating_say(const ritz_floating *body,
                              ritz_export_report *report);

/** Report that stated damping is part of D, and that structural damping is left
 * out; for formats that contain D. */
ritz_status ritz_floating_say_damping(const ritz_reduced *reduced,
                                      const ritz_floating *body,
                                      ritz_export_report *report);

/** The frame and the reference condition of an export request. */
static inline ritz_floating_request
ritz_floating_asked(const ritz_export_request *request)
{
    return (ritz_floating_request){request->frame, request->reference};
}

#endif
