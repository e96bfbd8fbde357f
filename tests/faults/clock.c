/*
 * A library that is loaded before the C library and makes the monotonic clock
 * run a thousand times as fast, for tests of what is done every half minute.
 */
#define _GNU_SOURCE /* NOLINT: syscall */
#include <stdint.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

enum { FASTER = 1000, NANO = 1000000000 };

/* NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name) */
int clock_gettime(clockid_t which, struct timespec *out)
{
    static int64_t first;
    const int failed = (int)syscall(SYS_clock_gettime, which, out);
    int64_t now = 0;

    if (failed || which != CLOCK_MONOTONIC)
        return failed;
    now = (int64_t)out->tv_sec * NANO + out->tv_nsec;
    first = first ? first : now; /* the product is of what has passed */
    now = first + (now - first) * FASTER;
    *out = (struct timespec){.tv_sec = now / NANO, .tv_nsec = now % NANO};
    return 0;
}
