/* Shapes of whatever has some: what ritz-export writes for viewers. */
#ifndef RITZ_TOOLS_PRINT_SHAPES_H
#define RITZ_TOOLS_PRINT_SHAPES_H

#include "cli/model.h"

#include <ritz/export.h>

/**
 * Modes of a reduced component or of a component, or columns of a basis.
 *
 * @param[in] component  file that a basis is of; NULL: not given
 */
ritz_status shapes_export(cli_run *run, const model *m, const char *component,
                          const ritz_exporter *exporter,
                          const ritz_export_request *request,
                          ritz_export_report *done);

#endif
