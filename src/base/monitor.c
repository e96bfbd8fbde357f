#include <ritz/base.h>

#include <stddef.h>

static _Thread_local ritz_observer *observing;

void ritz_monitor_observe(ritz_observer *observer)
{
    observing = observer;
}

void ritz_monitor_step(const char *what, int64_t done, int64_t total)
{
    if (observing)
        observing(what, done, total);
}
