/* A text that a tool writes in addition to its output, whole or not at all. */
#ifndef RITZ_TOOLS_CLI_CLI_TABLE_H
#define RITZ_TOOLS_CLI_CLI_TABLE_H

#include <ritz/base.h>

#include <stddef.h>
#include <stdio.h>

typedef struct cli_table {
    FILE *file; /* to write to, in memory */
    char *text;
    size_t size;
} cli_table;

ritz_status cli_table_new(cli_table *out);

/** Write it under a name of its own, then give it this one. */
ritz_status cli_table_save(cli_table *table, const char *path);

/** Write it into a file that is the caller's own, such as a draft. */
ritz_status cli_table_write(cli_table *table, const char *path);

void cli_table_free(cli_table *table);

#endif
