/* What ritz-export asks of a model before it hands it on. */
#ifndef RITZ_TOOLS_PRINT_STABILITY_H
#define RITZ_TOOLS_PRINT_STABILITY_H

#include "cli/model.h"

#include <ritz/audit.h>
#include <ritz/export.h>

/** The probe of what will be written, rounded to as many digits. */
ritz_status stability_of_reduced(const ritz_reduced *reduced,
                                 const ritz_export_request *request,
                                 ritz_audit *out);
ritz_status stability_of_states(const ritz_state_space *states,
                                const ritz_export_request *request,
                                ritz_audit *out);

/**
 * Say it; no simulator is handed a model that grows by itself or in an
 * assembly, or one of a method that promises nothing, unless it is wanted.
 *
 * @return RITZ_ERR_ARGUMENT naming the check that fails, without @p force
 */
ritz_status stability_check(cli_run *run, const ritz_audit *audit,
                            const char *method, bool force);

#endif
