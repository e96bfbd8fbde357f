/*
 * The folder in which commands run, and the level of nested claims files.
 *
 * The folder is removed after all processes that use it have ended, even by
 * SIGKILL: a separate process waits at a pipe, whose other end this program and
 * its commands hold open, and removes the folder when that end is closed.
 */
#include "claims/claims.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <inttypes.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static int remove_one(const char *path, const struct stat *, int, struct FTW *)
{
    return remove(path);
}

static void remove_folder(const char *path)
{
    nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

/* The caller has blocked all signals, and setsid keeps those of the terminal
   away. */
static _Noreturn void wait_and_remove(const char *folder, const int ends[2])
{
    const int nothing = open("/dev/null", O_RDWR);
    char letter = '\0';

    setsid();
    for (int k = 0; k <= STDERR_FILENO && nothing >= 0; k++)
        /* readers of our output must not wait for this process */
        dup2(nothing, k);
    close(ends[1]);
    while (read(ends[0], &letter, 1) < 0 && errno == EINTR)
        ;
    remove_folder(folder);
    _exit(EXIT_SUCCESS);
}

/* Start the process that removes the folder, before a signal could leave it. */
static ritz_status start_keeper(claims_state *state)
{
    int ends[2] = {-1, -1};

    RITZ_REFUSE_IF(pipe(ends) != 0, RITZ_ERR_FILE, "cannot make a pipe: %s",
                   strerror(errno));
    state->keeper = fork();
    if (state->keeper == 0)
        wait_and_remove(state->folder, ends);
    close(ends[0]);
    state->held = ends[1];
    RITZ_REFUSE_IF(state->keeper < 0, RITZ_ERR_FILE,
                   "cannot start a process: %s", strerror(errno));
    return RITZ_OK;
}

static ritz_status make_folder(claims_state *state)
{
    const char *parent = getenv("TMPDIR");

    snprintf(state->folder, sizeof state->folder, "%s/ritz-claims-XXXXXX",
             parent && *parent ? parent : "/tmp");
    if (mkdtemp(state->folder))
        return RITZ_OK;
    ritz_record("cannot make a folder '%s': %s", state->folder,
                strerror(errno));
    state->folder[0] = '\0';
    return RITZ_ERR_FILE;
}

ritz_status claims_folder_new(claims_state *state)
{
    sigset_t all, before;
    ritz_status status = RITZ_OK;

    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &before);
    status = make_folder(state);
    if (status == RITZ_OK)
        status = start_keeper(state);
    sigprocmask(SIG_SETMASK, &before, NULL);
    return status;
}

void claims_folder_free(claims_state *state)
{
    if (!state->folder[0])
        return;
    close(state->held);
    if (state->keeper > 0)
        while (waitpid(state->keeper, NULL, 0) < 0 && errno == EINTR)
            ;
    else
        remove_folder(state->folder);
    state->folder[0] = '\0';
}

/* An environment variable passes the number of levels to commands. */
ritz_status claims_level(void)
{
    static const char name[] = "RITZ_CLAIMS_LEVEL";
    const char *text = getenv(name);
    char next[24];
    int64_t level = 0;

    RITZ_REFUSE_IF(text && (!ritz_text_whole(text, &level) || level < 0 ||
                            level >= CLAIMS_MOST_LEVELS),
                   RITZ_ERR_FORMAT,
                   "claims that run ritz-claims may not be run by claims");
    snprintf(next, sizeof next, "%" PRId64, level + 1);
    RITZ_REFUSE_IF(setenv(name, next, 1) != 0, RITZ_ERR_MEMORY,
                   "no memory for the environment");
    return RITZ_OK;
}
