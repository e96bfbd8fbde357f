/* Programs of the folder libexec/ritz, which are installed with the tools. */
#ifndef RITZ_TOOLS_CLI_LIBEXEC_H
#define RITZ_TOOLS_CLI_LIBEXEC_H

#include <ritz/base.h>

#include <limits.h>
#include <stdbool.h>

/**
 * Find a program relative to the tool, as both were installed or built; neither
 * the environment nor the working folder has an influence.
 *
 * @return RITZ_ERR_FILE if it is not there or cannot be run
 */
ritz_status libexec_find(const char *name, char out[PATH_MAX]);

/** Whether a command line that is not parsed yet has `option value` or
 * `option=value`. */
bool libexec_is_asked(char **argv, const char *option, const char *value);

/**
 * Replace this process by a program of libexec with the same command line
 * (execv). It may use as many threads as its share of the cores, unless the
 * environment sets their number. If it cannot be run, a message says so; of
 * several MPI processes only that of rank 0 prints it.
 *
 * @param[in] tool      name in the message
 * @param[in] option    that the program is needed for
 * @param[in] packages  of Debian that it is built with
 * @return only on failure: the exit status of the tool
 */
int libexec_become(const char *program, char **argv, const char *tool,
                   const char *option, const char *packages);

#endif
