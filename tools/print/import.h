/* Components and state spaces from files, and their report: ritz-import. */
#ifndef RITZ_TOOLS_PRINT_IMPORT_H
#define RITZ_TOOLS_PRINT_IMPORT_H

#include "cli/sink.h"

#include <ritz/import.h>

/* All that the options answer; lists are taken into the request. */
typedef struct import_wish {
    cli_list load, port, rigid, averaged, input, output, damper;
    ritz_import_request request;
    ritz_import_space_request space;
} import_wish;

/** Matrices and geometry become a component. */
ritz_status import_component(cli_run *run, import_wish *asked);

/** Matrices of a first-order model become a state space. */
ritz_status import_states(cli_run *run, ritz_import_space_request *request);

#endif
