/* Whether other programs need the cores. */
#ifndef RITZ_BASE_CROWD_H
#define RITZ_BASE_CROWD_H

#include <stdbool.h>

/**
 * Whether threads of all programs that run, or could run if a core were free,
 * are more than the machine has cores, once @p more threads are started. It
 * changes from one moment to the next, so that no result may depend on it.
 *
 * @return false also if the system does not say
 * @cost  some 20 microseconds
 */
bool ritz_cores_crowded(int more);

#endif
