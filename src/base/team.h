/*
 * A team of threads that work on one task together, even on tasks as short as a
 * triangular solve of 100 microseconds.
 *
 * A thread of the team is started when a task first needs it. Between tasks it
 * spins for 200 microseconds and then sleeps; it sleeps at once while other
 * programs need the cores (base/crowd.h). The team does not use OpenMP,
 * so that it behaves alike with every compiler and every BLAS. In its threads
 * OpenMP, and a BLAS that uses it, start no further threads. The caller of a
 * task that calls the BLAS must see to that for itself (linear/blas_threads.h).
 */
#ifndef RITZ_BASE_TEAM_H
#define RITZ_BASE_TEAM_H

#include <ritz/base.h>

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

enum { RITZ_TEAM_SHARES = 64 }; /* most that ritz_team_shares() returns */

/** What each thread of a task does; threads are numbered from 0. */
typedef void ritz_team_work(int thread, int threads, void *task);

/** What one thread does with its items [from, to), which may be none. */
typedef void ritz_team_range(int thread, int64_t from, int64_t to, void *task);

/** What is done with item @p k. */
typedef void ritz_team_item(int64_t k, void *task);

/** What is done with item @p k, if it can fail. */
typedef ritz_status ritz_team_step(int64_t k, void *task);

/**
 * Run @p work once in each of @p threads threads, and return when all have
 * ended. The caller is thread 0. If several threads of a program call this
 * function, their tasks run one after the other.
 *
 * @p work must not call this function or one of those that are built on it with
 * more threads than ritz_team_ready() allows there, which is one.
 *
 * @param[in] threads  at most what ritz_team_ready() returned; with 1, @p work
 *                     runs in the calling thread and no lock is taken
 */
void ritz_team_run(int threads, ritz_team_work *work, void *task);

/**
 * Divide @p count items into one contiguous range for each thread, equal but
 * for one item, and run @p work on all of them. Which items belong to which
 * thread depends on @p count and @p threads only, so that sums over the items
 * of a thread have the same bits in every run.
 */
void ritz_team_over(int threads, int64_t count, ritz_team_range *work,
                    void *task);

/**
 * Run @p work on each of @p count items. A thread that is free takes the next
 * item, in ascending order: for items that take unequal times. Which thread
 * works on an item changes from run to run.
 */
void ritz_team_each(int threads, int64_t count, ritz_team_item *work,
                    void *task);

/**
 * ritz_team_each() for items that can fail. All items before the first one that
 * fails are worked on; of those behind it, some.
 *
 * @return the status of the first item, by number, that fails, with its
 *         sentence, whichever thread worked on it
 */
ritz_status ritz_team_try(int threads, int64_t count, ritz_team_step *work,
                          void *task);

/** Called by each of the @p threads threads of a task: wait for the others. */
void ritz_team_meet(int threads);

/**
 * How many threads a task is to use, at least 1: @p gain, unless
 * ritz_set_threads() allows fewer or the system refuses to start so many.
 * Starts those that are missing. In a task of the team it is 1.
 *
 * @param[in] gain  threads from which the task gains, by its size; any number
 */
int ritz_team_ready(int64_t gain);

/**
 * Into how many shares to cut a file for ritz_team_each(): four for each
 * thread, because some take longer to read than others, at most
 * RITZ_TEAM_SHARES.
 */
int64_t ritz_team_shares(int threads);

/**
 * Start a thread outside the team that blocks all signals but SIGBUS, so that
 * they are handled by the threads of the program that uses this library.
 *
 * @param[out] out  to be joined or detached; undefined if false is returned
 * @return false if the system starts no more threads
 */
bool ritz_team_start(void *(*run)(void *argument), void *argument,
                     pthread_t *out);

/** Let a BLAS that the calling thread uses start no threads. Called first in
 * each thread that ritz_team_start() starts. */
void ritz_team_member(void);

/** The items [*from, *to) of part @p part, from 0, of @p count items in @p
 * parts contiguous parts that are equal but for one item. */
static inline void ritz_team_part(int64_t count, int64_t part, int64_t parts,
                                  int64_t *from, int64_t *to)
{
    *from = count * part / parts;
    *to = count * (part + 1) / parts;
}

#endif
