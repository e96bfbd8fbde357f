/* What ritz-frf says of a response beside its channels: singular values, zeros. */
#ifndef RITZ_TOOLS_PRINT_RESPONSES_H
#define RITZ_TOOLS_PRINT_RESPONSES_H

#include "cli/model.h"

#include <ritz/singular.h>

typedef struct responses_wish {
    bool singular, over_limits, zeros;
    cli_list input_size;
} responses_wish;

/* Rows of the option table. */
#define RESPONSES_OPTIONS(wish)                                                \
    {CLI_FLAG(&(wish)->singular), .name = "singular-values",                   \
     .help = "of H at each point too, and the largest between points"},        \
        {CLI_FLAG(&(wish)->over_limits), .name = "over-limits",                \
         .help = "singular values of outputs divided by their limits"},        \
        {CLI_LIST(&(wish)->input_size), .name = "input-size",                  \
         .argument = "NAME=X",                                                 \
         .help = "singular values of this input multiplied by X"},             \
    {                                                                          \
        CLI_FLAG(&(wish)->zeros), .name = "zeros",                             \
                                  .help = "list the zeros of every channel"    \
    }

/** Singular values into the response, and the largest said; nothing if they are
 * not asked for. */
ritz_status responses_singular(cli_run *run, const responses_wish *asked,
                               const model *m, ritz_responder *responder,
                               ritz_response *response);

/** The zeros of every channel of a model, if they are asked for. */
ritz_status responses_zeros(cli_run *run, const responses_wish *asked,
                            const model *m, const ritz_damping *damping);

/**
 * The model as states: of a state space itself, borrowed; of others made, and
 * to be freed.
 *
 * @param[out] known  false if it has none: structural damping, or a component
 *                    of too many dofs
 */
ritz_status responses_states(const model *m, const ritz_damping *damping,
                             ritz_state_space *made,
                             const ritz_state_space **out);

#endif
