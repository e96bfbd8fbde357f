/*
 * Progress of long work: the library reports steps, a tool shows them.
 *
 * One observer a thread; without one, steps cost a test of a pointer.
 */
#ifndef RITZ_MONITOR_H
#define RITZ_MONITOR_H

#include <stdint.h>

#pragma GCC visibility push(default)

/** What is being done, and how far: step @p done of @p total (0: unknown). */
typedef void ritz_observer(const char *what, int64_t done, int64_t total);

/** Send this thread's steps to @p observer, NULL to nobody. */
void ritz_monitor_observe(ritz_observer *observer);

/** Report a step. */
void ritz_monitor_step(const char *what, int64_t done, int64_t total);

#pragma GCC visibility pop

#endif
