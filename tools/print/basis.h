/* Bases, and components in them: ritz-basis and ritz-reduce. */
#ifndef RITZ_TOOLS_PRINT_BASIS_H
#define RITZ_TOOLS_PRINT_BASIS_H

#include "cli/model.h"

#include <ritz/basis.h>
#include <ritz/verify.h>

typedef struct basis_wish {
    const ritz_method *method;
    const char *ports;    /* "PORT[,PORT]"; NULL: all */
    cli_list neighbours;  /* "PORT=FILE:PORT" */
    ritz_request request; /* the component is taken from the operand */
} basis_wish;

ritz_status basis_run(cli_run *run, basis_wish *asked);

typedef struct reduce_wish {
    bool without_basis;
    const char *damping; /* NULL: the model's own */
    ritz_estimate_request estimate;
} reduce_wish;

ritz_status reduce_run(cli_run *run, reduce_wish *asked);

#endif
