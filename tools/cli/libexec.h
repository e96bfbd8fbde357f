/* Programs of the folder libexec, which are installed with the tools. */
#ifndef RITZ_TOOLS_CLI_LIBEXEC_H
#define RITZ_TOOLS_CLI_LIBEXEC_H

#include <ritz/base.h>

#include <limits.h>
#include <stdbool.h>

/**
 * Find a program relative to the tool, as both were installed or built; neither
 * the environment nor the working folder has an influence.
 *
 * @return RITZ_ERR_FILE if it is not there
 */
ritz_status libexec_find(const char *name, char out[PATH_MAX]);

/** Whether a command line gives an option this value, before it is parsed. */
bool libexec_is_asked(char **argv, const char *option, const char *value);

/**
 * Become another program, with the same command line. Each process of MPI gets
 * as many threads as it has cores to itself, unless the environment says how
 * many. Only one of several processes complains of a failure.
 *
 * @param[in] tool      for the complaint
 * @param[in] option    that the program is needed for
 * @param[in] packages  of Debian that it is built with
 * @return the exit status of a tool that has failed: there is no such program
 */
int libexec_become(const char *program, char **argv, const char *tool,
                   const char *option, const char *packages);

#endif
