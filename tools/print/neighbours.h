/* --neighbour of ritz-basis: bodies that hang on a component's ports. */
#ifndef RITZ_TOOLS_PRINT_NEIGHBOURS_H
#define RITZ_TOOLS_PRINT_NEIGHBOURS_H

#include "cli/model.h"

#include <ritz/synthesis.h>

/**
 * Take "PORT=FILE:PORT" of each neighbour, joined as by a fixed joint.
 *
 * @param[in]  component,attached  what they hang on
 * @param[out] out                 attached x attached
 */
ritz_status neighbours_read(cli_run *run, const cli_list *given,
                            const ritz_component *component,
                            const ritz_dofs *attached, ritz_neighbour *out);

#endif
