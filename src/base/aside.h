/* Work that runs in a thread of its own while its caller goes on. */
#ifndef RITZ_BASE_ASIDE_H
#define RITZ_BASE_ASIDE_H

#include <pthread.h>
#include <stdbool.h>

typedef struct ritz_aside {
    void (*work)(void *task);
    void *task;
    bool apart;       /* the work runs in the thread below */
    pthread_t thread; /* undefined unless `apart` */
} ritz_aside;

/**
 * Start work(task) in a thread of its own and return, if @p large and if
 * ritz_set_threads() allows two threads; otherwise, or if the system refuses a
 * thread, run it before this function returns.
 *
 * @param[in]  work   cannot report a failure
 * @param[in]  task   valid until ritz_aside_end()
 * @param[out] out    passed to ritz_aside_end() in any case, and not copied,
 *                    moved or freed before that
 */
void ritz_aside_begin(void (*work)(void *task), void *task, bool large,
                      ritz_aside *out);

/** Wait until the work has ended. A second call does nothing. */
void ritz_aside_end(ritz_aside *aside);

#endif
