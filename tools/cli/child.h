/* Processes that a tool starts. */
#ifndef RITZ_TOOLS_CLI_CHILD_H
#define RITZ_TOOLS_CLI_CHILD_H

#include <sys/types.h>

/* Exit status of a child that could not start its program, as in a shell. */
enum { CHILD_NO_PROGRAM = 127 };

/**
 * fork. The child gets the signal @p number when the tool ends for any reason,
 * if the system supports this. The tool's signal handlers, which remove its
 * files, do not run in the child.
 */
pid_t child_start(int number);

/** Wait until the child ends. @return 0, or -1 with errno */
int child_wait(pid_t child, int *outcome);

#endif
