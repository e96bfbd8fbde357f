/* How many cores a process may use. */
#ifndef RITZ_CLI_CORES_H
#define RITZ_CLI_CORES_H

#include <stdint.h>

/** Cores that this process is bound to (taskset, mpirun), no more than its
 * control group gives it time for; at least 1. */
int64_t cli_cores(void);

#endif
