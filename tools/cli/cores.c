/* How many cores a process may use. */
#define _GNU_SOURCE /* NOLINT: declares sched_getaffinity */

#include "cli/cores.h"

#include "base/group.h"

#include <inttypes.h>
#include <sched.h>
#include <stdio.h>
#include <unistd.h>

/* "150000 100000": microseconds of processor time in a period of so many; two
   cores are needed to use them up. "max 100000": no limit. */
static int64_t read_quota(const char *path)
{
    FILE *file = fopen(path, "r");
    int64_t quota = 0, period = 0, cores = INT64_MAX;

    if (!file)
        return INT64_MAX;
    if (fscanf(file, "%" SCNd64 " %" SCNd64, &quota, /* NOLINT: or "max" */
               &period) == 2 &&
        quota > 0 && period > 0)
        cores = (quota - 1) / period + 1;
    fclose(file);
    return cores;
}

int64_t cli_cores(void)
{
    int64_t cores = sysconf(_SC_NPROCESSORS_ONLN);
    const int64_t quota = ritz_group_least("cpu.max", read_quota);
    cpu_set_t bound;

    if (sched_getaffinity(0, sizeof bound, &bound) == 0 &&
        CPU_COUNT(&bound) < cores)
        cores = CPU_COUNT(&bound);
    cores = quota < cores ? quota : cores;
    return cores > 1 ? cores : 1;
}
