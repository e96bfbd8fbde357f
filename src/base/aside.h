/* One piece of work beside other work. */
#ifndef RITZ_BASE_ASIDE_H
#define RITZ_BASE_ASIDE_H

#include <pthread.h>
#include <stdbool.h>

typedef struct ritz_aside {
    void (*work)(void *task);
    void *task;
    bool apart; /* it runs in a thread */
    pthread_t thread;
} ritz_aside;

/**
 * Begin the work: in a thread of its own if it is large and ritz_set_threads()
 * allows more than one, at once otherwise. The work must not fail.
 *
 * @param[out] out  must stay where it is until ritz_aside_end(), which must
 *                  follow
 */
void ritz_aside_begin(void (*work)(void *task), void *task, bool large,
                      ritz_aside *out);

/** Wait until the work is done. */
void ritz_aside_end(ritz_aside *aside);

#endif
