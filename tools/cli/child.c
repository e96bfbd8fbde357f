#include "cli/child.h"

#include <errno.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

/* Signals that are ignored stay so: a write beyond a limit (SIGXFSZ) still
   fails. */
static void reset_signals(void)
{
    struct sigaction now;

    for (int k = 1; k < SIGRTMIN; k++)
        if (sigaction(k, NULL, &now) == 0 && now.sa_handler != SIG_IGN)
            signal(k, SIG_DFL);
    signal(SIGPIPE, SIG_DFL);
}

static void follow_parent(pid_t parent, int number)
{
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, number);
#else
    (void)number;
#endif
    if (getppid() != parent)
        _exit(CHILD_NO_PROGRAM);
}

pid_t child_start(int number)
{
    const pid_t parent = getpid();
    sigset_t all, before;
    pid_t child = -1;

    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &before);
    child = fork();
    if (child == 0)
        reset_signals();
    sigprocmask(SIG_SETMASK, &before, NULL);
    if (child == 0)
        follow_parent(parent, number);
    return child;
}

int child_wait(pid_t child, int *outcome)
{
    pid_t ended = -1;

    do
        ended = waitpid(child, outcome, 0);
    while (ended < 0 && errno == EINTR);
    return ended == child ? 0 : -1;
}
