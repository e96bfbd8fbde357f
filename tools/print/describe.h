/* Contents of objects and files: ritz-info, and the tools that write them. */
#ifndef RITZ_TOOLS_PRINT_DESCRIBE_H
#define RITZ_TOOLS_PRINT_DESCRIBE_H

#include "cli/model.h"

/* Each says it in lines, whose values go to the object that is open. */
void describe_component(cli_run *run, const ritz_component *component);
void describe_basis(cli_run *run, const ritz_basis *basis);
ritz_status describe_reduced(cli_run *run, const ritz_reduced *reduced);
ritz_status describe_system(cli_run *run, const ritz_system *system);
void describe_response(cli_run *run, const ritz_response *response);
void describe_simulation(cli_run *run, const ritz_simulation *simulation);
ritz_status describe_states(cli_run *run, const ritz_state_space *states);

/**
 * A container, a matrix file or a deck, and how it was made.
 *
 * @param[in] members    list what a container holds, too
 * @param[in] directory  names and sizes of matrices alone: no values are read
 */
ritz_status describe_file(cli_run *run, const char *path, bool members,
                          bool directory);

/** Text form of a damping, and of a fit its coefficients and residual. */
void describe_damping(cli_run *run, const char *text);
void describe_dampers(cli_run *run, const ritz_dampers *dampers);

#endif
