#include "base/aside.h"

#include "base/team.h"

#include <signal.h>

static void *do_work(void *argument)
{
    const ritz_aside *aside = argument;

    aside->work(aside->task);
    return NULL;
}

/* Start a thread that leaves all signals to the others. */
static bool start_thread(ritz_aside *aside)
{
    sigset_t all, before;
    bool started = false;

    sigfillset(&all);
    if (pthread_sigmask(SIG_SETMASK, &all, &before) != 0)
        return false;
    started = pthread_create(&aside->thread, NULL, do_work, aside) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return started;
}

void ritz_aside_begin(void (*work)(void *task), void *task, bool large,
                      ritz_aside *out)
{
    *out = (ritz_aside){.work = work, .task = task};
    out->apart = large && ritz_team_ready(2) > 1 && start_thread(out);
    if (!out->apart)
        work(task);
}

void ritz_aside_end(ritz_aside *aside)
{
    if (aside->apart)
        pthread_join(aside->thread, NULL);
    aside->apart = false;
}
