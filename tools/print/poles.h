/* Damped poles and scans of dampers, as ritz-poles prints them. */
#ifndef RITZ_TOOLS_PRINT_POLES_H
#define RITZ_TOOLS_PRINT_POLES_H

#include "cli/model.h"

#include <ritz/spectrum.h>

/** Table and key `poles`; a warning for each that is unstable or not exact. */
void poles_say(cli_run *run, const ritz_spectrum *spectrum, bool tsv);

/** Table, what was found best, and keys `scan` and `best`. */
void poles_say_scan(cli_run *run, const ritz_scan *scan, bool tsv);

/* "NAME[,NAME]=FROM:TO:STEP" as a request; free `damper`. */
typedef struct poles_scan {
    ritz_scan_request request;
    int64_t *damper;
} poles_scan;

/** @return RITZ_ERR_ARGUMENT if it is of another form, or a name unknown */
ritz_status poles_scan_parse(const char *text, const ritz_dampers *dampers,
                             poles_scan *out);

#endif
