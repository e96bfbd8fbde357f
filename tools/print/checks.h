/* Tables of checks, as ritz-check and ritz-export show them. */
#ifndef RITZ_TOOLS_PRINT_CHECKS_H
#define RITZ_TOOLS_PRINT_CHECKS_H

#include "cli/model.h"

#include <ritz/audit.h>

/** The table and the sum of its verdicts. */
void checks_say(const cli_run *run, const ritz_audit *audit);

/** The same as array, with `name`, `value`, `limit`, `verdict`, `where`, `says`. */
json_t *checks_json(const ritz_audit *audit);

/** The first check that fails; NULL if none does. */
const ritz_check *checks_first(const ritz_audit *audit);

/** How many have this verdict. */
int64_t checks_count(const ritz_audit *audit, ritz_verdict verdict);

#endif
