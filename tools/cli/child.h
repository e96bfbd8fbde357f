/* Processes that a tool starts. */
#ifndef RITZ_TOOLS_CLI_CHILD_H
#define RITZ_TOOLS_CLI_CHILD_H

#include <sys/types.h>

/* What a child ends with that could not start its program, as of a shell. */
enum { CHILD_NO_PROGRAM = 127 };

/**
 * fork. The child gets the signal @p number when the tool ends, however that
 * ends, where the system can do so. No handler of the tool runs in it, which
 * would remove the files of the tool.
 */
pid_t child_start(int number);

/** Wait for its end. @return 0, or -1 with errno */
int child_wait(pid_t child, int *outcome);

#endif
