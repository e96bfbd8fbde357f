#include "base/crowd.h"

#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

/* The fourth number of this file: threads that are runnable now, with the one
   that reads it. 0 if there is none. */
static int64_t count_runnable(void)
{
    FILE *file = fopen("/proc/loadavg", "r");
    int64_t count = 0;

    if (!file)
        return 0;
    if (fscanf(file, "%*s %*s %*s %" SCNd64, &count) != 1) /* NOLINT: or none */
        count = 0;
    fclose(file);
    return count;
}

bool ritz_cores_crowded(int more)
{
    const int64_t runnable = count_runnable();

    return runnable > 0 && runnable + more > sysconf(_SC_NPROCESSORS_ONLN);
}
