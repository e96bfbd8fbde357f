/*
 * Threads that work together on one task: a few that wait for each other often,
 * as triangular solves do. They are started once and then wait, first spinning
 * for some microseconds, then asleep. They belong to no OpenMP, so that they
 * are the same under every compiler and every BLAS.
 */
#ifndef RITZ_BASE_TEAM_H
#define RITZ_BASE_TEAM_H

#include <ritz/base.h>

#include <stdint.h>

/** A part of the task, of thread @p thread of @p threads. */
typedef void ritz_team_work(int thread, int threads, void *task);

/**
 * Run @p work once in each of @p threads threads, this one being thread 0, and
 * return when all have ended. Work of a single thread runs here. Tasks of
 * several callers run one after the other.
 *
 * A task starts no other task.
 *
 * @param[in] threads  at most what ritz_team_ready() gave
 */
void ritz_team_run(int threads, ritz_team_work *work, void *task);

/** In work of @p threads threads: wait until all of them have come here. */
void ritz_team_meet(int threads);

/**
 * The number of threads for a task that gains from at most @p most of them: what
 * ritz_set_threads() allows, as far as the system has started them.
 */
int ritz_team_ready(int most);

/** The part [*from, *to) of @p count items that thread @p thread works on. */
static inline void ritz_team_part(int64_t count, int thread, int threads,
                                  int64_t *from, int64_t *to)
{
    *from = count * thread / threads;
    *to = count * (thread + 1) / threads;
}

#endif
