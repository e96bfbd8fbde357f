#include "base/memory.h"

#include "base/group.h"

#include <inttypes.h>
#include <malloc.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static _Atomic int64_t given; /* by ritz_set_memory(); 0: nothing */
static _Atomic int64_t
    standing; /* what stands in its place, once it is known */

enum { SMALL_PART = 64 }; /* what is below this part of the limit is admitted */

void ritz_set_memory(int64_t bytes)
{
    atomic_store(&given, bytes > 0 ? bytes : 0);
}

/* The first number of a file; INT64_MAX if there is none, as in "max". */
static int64_t read_number(const char *path)
{
    FILE *file = fopen(path, "r");
    int64_t number = INT64_MAX;

    if (!file)
        return INT64_MAX;
    if (fscanf(file, "%" SCNd64, &number) != 1) /* NOLINT: a number or none */
        number = INT64_MAX;
    fclose(file);
    return number;
}

static int64_t lesser(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* The limit of the process's control group, and of the groups above it; the older
   hierarchy has one file for each kind of resource. */
static int64_t group_limit(void)
{
    return lesser(read_number("/sys/fs/cgroup/memory/memory.limit_in_bytes"),
                  ritz_group_least("memory.max", read_number));
}

/* Four fifths of what the machine, or its control group, has. */
static int64_t usual_limit(void)
{
    int64_t known = atomic_load(&standing);

    if (known == 0) {
        const int64_t pages = sysconf(_SC_PHYS_PAGES);
        const int64_t all = pages * sysconf(_SC_PAGESIZE);

        known = lesser(all > 0 ? all : INT64_MAX, group_limit()) / 5 * 4;
        atomic_store(&standing, known);
    }
    return known;
}

int64_t ritz_memory_limit(void)
{
    const int64_t limit = atomic_load(&given);

    return limit > 0 ? limit : usual_limit();
}

/* Memory that the process holds now; 0 if that is not known. */
static int64_t memory_in_use(void)
{
    FILE *file = fopen("/proc/self/statm", "r");
    int64_t resident = 0;

    if (!file)
        return 0;
    if (fscanf(file, "%*s %" SCNd64, &resident) != 1) /* NOLINT: as above */
        resident = 0;
    fclose(file);
    return resident * sysconf(_SC_PAGESIZE);
}

/* "15.2 GiB", "340 MiB" */
static const char *name_size(int64_t bytes, char out[32])
{
    const double mib = (double)bytes / 1048576.0;

    if (mib < 1024.0)
        snprintf(out, 32, "%.3g MiB", mib);
    else
        snprintf(out, 32, "%.1f GiB", mib / 1024.0);
    return out;
}

void ritz_memory_return(void)
{
    (void)malloc_trim(0);
}

bool ritz_memory_fits(int64_t bytes)
{
    const int64_t limit = ritz_memory_limit();

    if (bytes < limit / SMALL_PART || bytes <= limit - memory_in_use())
        return true;
    ritz_memory_return();
    return bytes <= limit - memory_in_use();
}

ritz_status ritz_memory_admit(const char *what, int64_t bytes)
{
    const int64_t limit = ritz_memory_limit();
    char need[32], used[32], allowed[32];

    if (ritz_memory_fits(bytes))
        return RITZ_OK;
    return ritz_fail(RITZ_ERR_MEMORY,
                     "%s needs %s of memory beside %s in use, %s are allowed "
                     "(--memory)",
                     what, name_size(bytes, need),
                     name_size(memory_in_use(), used),
                     name_size(limit, allowed));
}
