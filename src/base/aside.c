#include "base/aside.h"

#include "base/team.h"

static void *do_work(void *argument)
{
    const ritz_aside *aside = argument;

    ritz_team_member();
    aside->work(aside->task);
    return NULL;
}

void ritz_aside_begin(void (*work)(void *task), void *task, bool large,
                      ritz_aside *out)
{
    *out = (ritz_aside){.work = work, .task = task};
    out->apart = large && ritz_team_ready(2) > 1 &&
                 ritz_team_start(do_work, out, &out->thread);
    if (!out->apart)
        work(task);
}

void ritz_aside_end(ritz_aside *aside)
{
    if (aside->apart)
        pthread_join(aside->thread, NULL);
    aside->apart = false;
}
