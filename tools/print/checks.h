/* Checks of a model: ritz-check, and before ritz-export hands it on. */
#ifndef RITZ_TOOLS_PRINT_CHECKS_H
#define RITZ_TOOLS_PRINT_CHECKS_H

#include "cli/model.h"

/** A table, the sum of its verdicts, and a list. */
void checks_say(cli_run *run, const char *key, const ritz_audit *audit);

/** The first check that fails; NULL if none does. */
const ritz_check *checks_first(const ritz_audit *audit);

/**
 * Audit a component, or probe a small model.
 *
 * @return RITZ_ERR_FORMAT naming the first check that fails
 */
ritz_status checks_run(cli_run *run);

#endif
