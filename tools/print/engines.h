/* The engines of ritz-frf: which one, and responses by it. */
#ifndef RITZ_TOOLS_PRINT_ENGINES_H
#define RITZ_TOOLS_PRINT_ENGINES_H

#include "cli/model.h"

typedef struct engines_wish {
    const char *method; /* "auto", or a name of the table */
    double up_to_hz;    /* NaN: not said */
    double tolerance;   /* between points; NaN: a grid is enough */
} engines_wish;

/* Rows of the option table. */
#define ENGINES_OPTIONS(wish)                                                  \
    {CLI_TEXT(&(wish)->method), .name = "method", .argument = "NAME",          \
     .help = "one of those that --list shows"},                                \
        {CLI_REAL(&(wish)->tolerance),                                         \
         .name = "tolerance",                                                  \
         .argument = "X",                                                      \
         .min = 1e-9,                                                          \
         .max = 0.5,                                                           \
         .help =                                                               \
             "as many points as keep it between them, of the largest |H|"},    \
        {CLI_REAL(&(wish)->up_to_hz),                                          \
         .name = "up-to-hz",                                                   \
         .argument = "F",                                                      \
         .min = 1e-9,                                                          \
         .max = 1e9,                                                           \
         .help = "modes of a component up to this one [three times the end]"}, \
    {                                                                          \
        CLI_ACTION(engines_list), .name = "list",                              \
                                  .help = "list methods and what each is for"  \
    }

/** Print the table. */
void engines_list(void);

/** End the program if there is no such method. */
void engines_check(const cli_program *program, const engines_wish *asked);

/**
 * Make a model ready for the range of a grid.
 *
 * @param[in] damping  as it was asked for beside; borrowed as @p view is
 */
ritz_status engines_start(cli_run *run, const model *m,
                          const engines_wish *asked,
                          const ritz_damping *damping, const ritz_grid *grid,
                          const ritz_second_order *view, ritz_responder **out);

/** The points of the grid, or those that keep the tolerance. */
ritz_status engines_respond(ritz_responder *responder,
                            const engines_wish *asked, const ritz_grid *grid,
                            ritz_response *out);

#endif
