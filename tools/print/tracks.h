/* Modes followed over configurations, as tools report them. */
#ifndef RITZ_TOOLS_PRINT_TRACKS_H
#define RITZ_TOOLS_PRINT_TRACKS_H

#include "cli/sink.h"

#include <ritz/assembly.h>

/**
 * Follow the modes of a system, say what happened to them up to the end of the
 * scene's band, set keys of the report, and write all of it to @p path, if
 * there is one, as a table with tabs. A single configuration has nothing to
 * say.
 */
ritz_status tracks_report(cli_run *run, const ritz_stage *stage,
                          const ritz_system *system, const char *path);

#endif
