/* The report of ritz-compare. */
#ifndef RITZ_TOOLS_COMPARISON_H
#define RITZ_TOOLS_COMPARISON_H

#include "model.h"

#include <ritz/compare.h>

/** Orders, errors at every configuration, frequencies; the same as JSON. */
ritz_status comparison_say(cli_run *run, const ritz_stage *first,
                           const ritz_comparison *comparison);

#endif
