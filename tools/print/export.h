/* Checks of a model before ritz-export writes it for others, and the writing. */
#ifndef RITZ_TOOLS_PRINT_EXPORT_H
#define RITZ_TOOLS_PRINT_EXPORT_H

#include "cli/model.h"

#include <ritz/export.h>

typedef struct export_wish {
    const ritz_exporter *exporter;
    ritz_export_request request;
    int64_t order;         /* columns of a nested component; 0: all */
    const char *component; /* that a basis is of; NULL: not given */
    cli_list damper;
    bool force;
} export_wish;

/**
 * Write the operand in the format that is asked for, and say what is known of
 * its errors and its stability.
 *
 * @return RITZ_ERR_ARGUMENT if nothing is known of its errors, or it is not
 *         stable, without `force`
 */
ritz_status export_run(cli_run *run, const export_wish *asked);

#endif
