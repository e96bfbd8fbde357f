/* Lines of the report about a body in a floating frame, for any format. */
#ifndef RITZ_FORMATS_FLOATING_REPORT_H
#define RITZ_FORMATS_FLOATING_REPORT_H

#include "model/floating.h"

#include <ritz/export.h>

/** Frame, mass, modes and their reference, and what is approximate. */
ritz_status ritz_floating_say(const ritz_floating *body,
                              ritz_export_report *report);

/** Where damping is, and what of it is left out, for formats that hold D. */
ritz_status ritz_floating_say_damping(const ritz_reduced *reduced,
                                      const ritz_floating *body,
                                      ritz_export_report *report);

/** The frame and the reference condition that an exporter is asked for. */
static inline ritz_floating_request
ritz_floating_asked(const ritz_export_request *request)
{
    return (ritz_floating_request){request->frame, request->reference};
}

#endif
