/* What is in an object: ritz-info, and the tools that write one. */
#ifndef RITZ_TOOLS_PRINT_DESCRIBE_H
#define RITZ_TOOLS_PRINT_DESCRIBE_H

#include "cli/model.h"

#include <ritz/deck.h>
#include <ritz/foreign.h>

/* Each says it in lines, whose values go to the object that is open. */
void describe_component(cli_run *run, const ritz_component *component);
void describe_basis(cli_run *run, const ritz_basis *basis);
ritz_status describe_reduced(cli_run *run, const ritz_reduced *reduced);
ritz_status describe_system(cli_run *run, const ritz_system *system);
void describe_response(cli_run *run, const ritz_response *response);
void describe_simulation(cli_run *run, const ritz_simulation *simulation);
ritz_status describe_states(cli_run *run, const ritz_state_space *states);
/** @param[in] directory  names and sizes alone: no values are read */
ritz_status describe_matrices(cli_run *run, const ritz_foreign *file,
                              bool directory);
void describe_deck(cli_run *run, const ritz_deck *deck);

/** Any of them, and rankings, by its kind. */
ritz_status describe_model(cli_run *run, const model *m);

/** Text form of a damping, and of a fit its coefficients and residual. */
void describe_damping(cli_run *run, const char *text);
void describe_dampers(cli_run *run, const ritz_dampers *dampers);

#endif
