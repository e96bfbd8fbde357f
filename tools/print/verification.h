/* Full against reduced: ritz-verify. */
#ifndef RITZ_TOOLS_PRINT_VERIFICATION_H
#define RITZ_TOOLS_PRINT_VERIFICATION_H

#include "cli/model.h"

typedef struct verify_wish {
    ritz_verify_request verify;
    model_wish model; /* the reduced one; dampers are of both */
} verify_wish;

/**
 * Measure all errors and write the reduced model with them.
 *
 * @return RITZ_ERR_CONVERGENCE naming the first limit that is not met
 */
ritz_status verify_run(cli_run *run, verify_wish *asked);

#endif
