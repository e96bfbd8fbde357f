#define _XOPEN_SOURCE 700 /* NOLINT: realpath is declared only so */

#include "base/draft.h"

#include "base/alloc.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/*
 * Names of the files that a signal must not leave behind. A handler has no
 * argument, so this is the one place where the library keeps state.
 */
static _Atomic(const char *) unfinished[RITZ_MAX_DRAFTS];

static bool enlist_name(const char *name)
{
    for (int k = 0; k < RITZ_MAX_DRAFTS; k++) {
        const char *none = NULL;

        if (atomic_compare_exchange_strong(&unfinished[k], &none, name))
            return true;
    }
    return false;
}

static void strike_name(const char *name)
{
    for (int k = 0; k < RITZ_MAX_DRAFTS; k++) {
        const char *expected = name;

        if (atomic_compare_exchange_strong(&unfinished[k], &expected, NULL))
            return;
    }
}

/*
 * Create and enlist with signals held back: enlisted before it exists, a name
 * that turns out to be another process' would be removed by our handler.
 */
static int create_file(const char *name, bool *enlisted)
{
    sigset_t all;
    sigset_t before;
    int file = -1;
    int error = 0;

    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &before);
    file = open(name, O_WRONLY | O_CREAT | O_EXCL, 0666);
    error = errno;
    *enlisted = file >= 0 && enlist_name(name);
    if (file >= 0 && !*enlisted)
        unlink(name);
    sigprocmask(SIG_SETMASK, &before, NULL);
    errno = error;
    return file;
}

/* Where a link leads, so that it stays one; else the path itself. */
static ritz_status follow_link(const char *path, char **out)
{
    RITZ_OWN_ARRAY char *real = realpath(path, NULL);
    const char *target = real ? real : path;
    char *copy = NULL;

    RITZ_CHECK_NEW(copy, (int64_t)strlen(target) + 1);
    memcpy(copy, target, strlen(target) + 1);
    *out = copy;
    return RITZ_OK;
}

ritz_status ritz_draft_new(const char *path, ritz_draft *out)
{
    size_t size = sizeof ".4294967295-999999.part";
    RITZ_OWN_ARRAY char *target = NULL, *name = NULL;
    struct stat there;
    bool enlisted = false;
    int file = -1;

    RITZ_REFUSE_IF(stat(path, &there) == 0 && !S_ISREG(there.st_mode),
                   RITZ_ERR_FILE, "not a regular file");
    RITZ_CHECK(follow_link(path, &target));
    size += strlen(target);
    RITZ_CHECK_NEW(name, (int64_t)size);
    for (int k = 0; file < 0; k++) {
        snprintf(name, size, "%s.%ld-%d.part", target, (long)getpid(), k);
        file = create_file(name, &enlisted);
        RITZ_REFUSE_IF(file < 0 && (errno != EEXIST || k == 999999),
                       RITZ_ERR_FILE, "cannot create '%s': %s", path,
                       strerror(errno));
    }
    close(file);
    RITZ_REFUSE_IF(!enlisted, RITZ_ERR_ARGUMENT,
                   "more than %d files are being written", RITZ_MAX_DRAFTS);
    RITZ_MOVE(out->path, target);
    RITZ_MOVE(out->name, name);
    return RITZ_OK;
}

ritz_status ritz_draft_publish(ritz_draft *draft)
{
    RITZ_REFUSE_IF(rename(draft->name, draft->path) != 0, RITZ_ERR_FILE,
                   "cannot replace '%s': %s", draft->path, strerror(errno));
    strike_name(draft->name);
    RITZ_FREE(draft->name, draft->path);
    *draft = (ritz_draft){0};
    return RITZ_OK;
}

void ritz_draft_free(ritz_draft *draft)
{
    if (draft->name) {
        remove(draft->name);
        strike_name(draft->name);
    }
    RITZ_FREE(draft->name, draft->path);
    *draft = (ritz_draft){0};
}

void ritz_draft_discard_all(void)
{
    for (int k = 0; k < RITZ_MAX_DRAFTS; k++) {
        const char *name = atomic_load(&unfinished[k]);

        if (name)
            unlink(name);
    }
}
