#include "cli/cli.h"

#include "base/draft.h"

#include <ritz/base.h>

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

/* Neither a handler nor an observer has an argument: state is kept here. */
static volatile sig_atomic_t shown; /* a line of progress stands there */
static struct timespec last;        /* when it was written */

static const char erase[] = "\r\033[K";

/* The signal is raised again with its own effect, so that whoever started the
 * program sees what ended it; held back here, it comes on return. */
static void end_program(int number)
{
    ritz_draft_discard_all();
    if (shown && write(STDERR_FILENO, erase, sizeof erase - 1) < 0)
        shown = 0;
    signal(number, SIG_DFL);
    raise(number);
}

void cli_watch_signals(void)
{
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction before;
    struct sigaction action = {.sa_handler = end_program};

    sigemptyset(&action.sa_mask);
    signal(SIGXFSZ, SIG_IGN); /* a write past a limit fails, and is reported */
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        if (sigaction(numbers[k], NULL, &before) == 0 &&
            before.sa_handler != SIG_IGN) /* as nohup leaves it */
            sigaction(numbers[k], &action, NULL);
}

/* At most ten times a second, and not before a tenth has passed. */
static void show_progress(const char *what, int64_t done, int64_t total)
{
    char line[80];
    struct timespec now = {0};
    int length = 0;

    clock_gettime(CLOCK_MONOTONIC, &now);
    if ((double)(now.tv_sec - last.tv_sec) +
            1e-9 * (double)(now.tv_nsec - last.tv_nsec) <
        0.1)
        return;
    last = now;
    if (total > 0)
        length = snprintf(line, sizeof line, "%s: %" PRId64 " of %" PRId64,
                          what, done, total);
    else
        length = snprintf(line, sizeof line, "%s: %" PRId64, what, done);
    if (length > 0) {
        shown = 1;
        fprintf(stderr, "%s%s", erase, line);
        fflush(stderr);
    }
}

void cli_watch_progress(bool quiet)
{
    if (quiet || !isatty(STDERR_FILENO))
        return;
    clock_gettime(CLOCK_MONOTONIC, &last);
    ritz_monitor_observe(show_progress);
}

void cli_watch_clear(void)
{
    if (shown)
        fputs(erase, stderr);
    shown = 0;
}
