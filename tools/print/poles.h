/* Damped poles and scans of dampers, as ritz-poles prints them. */
#ifndef RITZ_TOOLS_PRINT_POLES_H
#define RITZ_TOOLS_PRINT_POLES_H

#include "cli/model.h"

typedef struct poles_wish {
    int64_t modes, mode; /* the lowest, 0: all; the one that a scan follows */
    double up_to_hz;     /* NaN: not said */
    const char *scan;    /* "NAME[,NAME]=FROM:TO:STEP"; NULL: none */
    model_wish model;
    bool tsv;
} poles_wish;

/** Poles of a model, or one of them through a range of dampers. */
ritz_status poles_report(cli_run *run, const poles_wish *asked);

#endif
