/* How many columns of a nested reduced component a tool takes. */
#ifndef RITZ_TOOLS_PRINT_NESTED_H
#define RITZ_TOOLS_PRINT_NESTED_H

#include "cli/model.h"

/* --order N, in the option table of a tool that reads a reduced component. */
#define ORDER_OPTION(place)                                                    \
    {                                                                          \
        CLI_INT(place),                                                        \
            .name = "order", .argument = "N", .min = 1, .max = 1e6,            \
            .help = "the first N columns of a nested reduced component [all]"  \
    }

/**
 * Take the first @p order columns of what was read, before anything is made of
 * it; 0: all.
 *
 * @return RITZ_ERR_ARGUMENT if it is no reduced component, or has no such
 *         prefix
 */
ritz_status nested_take(const char *path, int64_t order, model *m);

/** What prefixes there are, with what is known of each; nothing if none. */
void nested_describe(cli_run *run, const ritz_nested *nested, int64_t columns);

#endif
