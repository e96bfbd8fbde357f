#include "base/memory.h"

#include "base/group.h"

#include <inttypes.h>
#include <malloc.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static _Atomic int64_t given; /* by ritz_set_memory(); 0: nothing */
static _Atomic int64_t
    standing;                  /* what stands in its place, once it is known */
static _Atomic int64_t mapped; /* bytes that are not of malloc() */

static _Thread_local ritz_foresight foreseen;

enum {
    SMALL_PART = 64,   /* ritz_memory_admit(): what is below this part of the
                        limit is admitted */
    ARRAY_PART = 1024, /* ritz_memory_admit_array(): the same */
    LEAST_ARRAY = 1 << 20, /* smaller ones are always admitted  [bytes] */
    PROGRAM = 24 << 20, /* pages of files that count, at most: the program and
                           its libraries take less. The system can take away
                           those of input files that are mapped [bytes] */
    OTHER = 2 << 20,    /* stacks, and buffers of the BLAS  [bytes] */
    SLACK_PART = 100,   /* the memory named in a refusal is larger by this part,
                           and by 1 MiB, as what is in use varies */
};

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

/* Pages of the process; all 0 if they are not known. */
typedef struct pages {
    int64_t resident; /* in memory */
    int64_t files;    /* of these, of mapped files */
    int64_t writable; /* that could be in memory, without those of files */
} pages;

static pages count_pages(void)
{
    FILE *file = fopen("/proc/self/statm", "r");
    pages p = {0};

    if (!file)
        return p;
    if (fscanf(file, /* NOLINT: as above */
               "%*s %" SCNd64 " %" SCNd64 " %*s %*s %" SCNd64, &p.resident,
               &p.files, &p.writable) != 3)
        p = (pages){0};
    fclose(file);
    return p;
}

/* Bytes that malloc() has given out, whether they were written or not. */
static int64_t bytes_given_out(void)
{
    const struct mallinfo2 heap = mallinfo2();

    return (int64_t)(heap.uordblks + heap.hblkhd);
}

static int64_t larger(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

/* Memory that the process holds now, or will hold once all arrays that it has
   are written. */
static int64_t memory_in_use(void)
{
    const int64_t page = sysconf(_SC_PAGESIZE);
    const pages p = count_pages();

    return lesser(p.files * page, PROGRAM) +
           larger((p.resident - p.files) * page,
                  bytes_given_out() + atomic_load(&mapped) + OTHER);
}

/* Whether so many bytes fit even if every page was written that could be. Most
   do, and then the heap need not be looked through. */
static bool fits_surely(int64_t bytes, int64_t limit)
{
    const int64_t page = sysconf(_SC_PAGESIZE);
    const pages p = count_pages();

    return p.resident > 0 &&
           bytes <= limit - PROGRAM - OTHER - p.writable * page;
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

/* The same rounded up: as an argument of --memory it is enough. */
static const char *name_enough(int64_t bytes, char out[32])
{
    const double size = (double)bytes * (1.0 + 1.0 / SLACK_PART);
    const double mib = ceil(size / 1048576.0) + 1.0;

    if (mib < 1024.0)
        snprintf(out, 32, "%.0f MiB", mib);
    else
        snprintf(out, 32, "%.1f GiB", ceil(mib / 102.4) / 10.0);
    return out;
}

void ritz_memory_return(void)
{
    (void)malloc_trim(0);
}

void ritz_memory_count_mapped(int64_t bytes)
{
    atomic_fetch_add(&mapped, bytes);
}

int64_t ritz_memory_left(void)
{
    return ritz_memory_limit() - memory_in_use();
}

static bool fits_beside(int64_t bytes)
{
    if (fits_surely(bytes, ritz_memory_limit()) || bytes <= ritz_memory_left())
        return true;
    ritz_memory_return();
    return bytes <= ritz_memory_left();
}

bool ritz_memory_fits(int64_t bytes)
{
    return bytes < ritz_memory_limit() / SMALL_PART || fits_beside(bytes);
}

static ritz_status refuse(const char *what, int64_t bytes)
{
    const int64_t used = memory_in_use();
    char need[32], use[32], all[32], allowed[32];

    return ritz_fail(RITZ_ERR_MEMORY,
                     "%s needs %s of memory beside %s in use, %s in all: %s "
                     "are allowed (--memory)",
                     what, name_size(bytes, need), name_size(used, use),
                     name_enough(used + bytes, all),
                     name_size(ritz_memory_limit(), allowed));
}

ritz_status ritz_memory_admit(const char *what, int64_t bytes)
{
    return ritz_memory_fits(bytes) ? RITZ_OK : refuse(what, bytes);
}

static ritz_status refuse_array(int64_t bytes)
{
    const char *step = ritz_monitor_last();
    char what[80] = "an array";

    if (step)
        snprintf(what, sizeof what, "an array (last step: %s)", step);
    return refuse(what, bytes);
}

ritz_status ritz_memory_admit_array(int64_t bytes)
{
    if (bytes < LEAST_ARRAY || bytes < ritz_memory_limit() / ARRAY_PART ||
        fits_beside(bytes))
        return RITZ_OK;
    return refuse_array(bytes);
}

ritz_foresight ritz_memory_foresee(ritz_foresight later)
{
    const ritz_foresight before = foreseen;

    foreseen = later;
    return before;
}

ritz_status ritz_memory_admit_factor(int64_t making, int64_t kept)
{
    const ritz_foresight f = foreseen;
    const int64_t later = larger(kept + f.beside, f.after);

    if (later <= making)
        return ritz_memory_admit("the factor", making);
    return ritz_memory_admit("the factor, with what follows,", later);
}
