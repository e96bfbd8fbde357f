#define _GNU_SOURCE /* NOLINT: declares realpath and F_OFD_SETLK */

#include "base/draft.h"

#include "base/alloc.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/* --- names to be removed on a signal -------------------------------------- */

/*
 * Names of the drafts that exist, for the signal handler. The list is global
 * because a handler has no argument, and writers in the library do not know the
 * program around them. A place is reused and never freed, since a handler may
 * be reading it.
 */
typedef struct place {
    _Atomic(const char *) name; /* NULL: place is free; "": reserved for a file
                                   that is about to be created */
    struct place *next;
} place;

static _Atomic(place *) places;

static ritz_status take_place(place **out)
{
    place *made = NULL;

    for (place *p = atomic_load(&places); p; p = p->next) {
        const char *none = NULL;

        *out = p;
        if (atomic_compare_exchange_strong(&p->name, &none, ""))
            return RITZ_OK;
    }
    RITZ_CHECK_NEW(made, 1);
    atomic_init(&made->name, "");
    made->next = atomic_load(&places);
    while (!atomic_compare_exchange_weak(&places, &made->next, made))
        ;
    *out = made;
    return RITZ_OK;
}

static void strike_name(const char *name)
{
    for (place *p = atomic_load(&places); p; p = p->next) {
        const char *expected = name;

        if (atomic_compare_exchange_strong(&p->name, &expected, NULL))
            return;
    }
}

/* Whether files that belong together are being renamed: a signal meanwhile
   would leave some of them. It may come to a thread that does not hold signals
   back, as of a BLAS library; this one then waits. */
static atomic_bool naming;

void ritz_draft_discard_all(void)
{
    while (atomic_load(&naming))
        poll(NULL, 0, 1);
    for (place *p = atomic_load(&places); p; p = p->next) {
        const char *name = atomic_load(&p->name);

        if (name && *name)
            unlink(name);
    }
}

/*
 * Create and enlist with signals held back: enlisted before it exists, a name
 * that turns out to be another process' would be removed by our handler.
 */
static int create_file(const char *name, mode_t mode, place *at)
{
    sigset_t all;
    sigset_t before;
    int file = -1;
    int error = 0;

    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &before);
    file = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    error = errno;
    if (file >= 0)
        atomic_store(&at->name, name);
    sigprocmask(SIG_SETMASK, &before, NULL);
    errno = error;
    return file;
}

/* --- which file a path names ---------------------------------------------- */

enum { MOST_LINKS = 40 };

/* Replace a path by the target of its symbolic link; false if it is none. */
static bool follow_link(char path[PATH_MAX])
{
    char to[PATH_MAX];
    const ssize_t length = readlink(path, to, sizeof to - 1);
    char *slash = strrchr(path, '/');
    size_t folder = 0;

    if (length <= 0)
        return false;
    to[length] = '\0';
    folder = slash && *to != '/' ? (size_t)(slash - path) + 1 : 0;
    if (folder + (size_t)length >= PATH_MAX)
        return false;
    memcpy(path + folder, to, (size_t)length + 1);
    return true;
}

/* Resolve symbolic links, also those whose target does not exist yet, so that a
   link is kept and its target is replaced. */
static void follow_links(const char *path, char out[PATH_MAX])
{
    if (realpath(path, out))
        return;
    snprintf(out, PATH_MAX, "%s", path);
    for (int k = 0; k < MOST_LINKS && follow_link(out); k++)
        ;
}

/*
 * Whether a path leads to an open file of a process, as /dev/stdout and
 * /dev/fd/3 do. A rename onto it would put a new file in the place of that
 * file, and the process that has it open would never see the output.
 */
static bool is_descriptor(const char *path)
{
    char at[PATH_MAX], folder[PATH_MAX], real[PATH_MAX];
    int links = 0;

    snprintf(at, sizeof at, "%s", path);
    do {
        const char *slash = strrchr(at, '/');

        snprintf(folder, sizeof folder, "%.*s",
                 slash ? (int)(slash - at) + 1 : 1, slash ? at : ".");
        if (realpath(folder, real) && strncmp(real, "/proc/", 6) == 0)
            return true;
    } while (links++ < MOST_LINKS && follow_link(at));
    return false;
}

static bool same_file(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/* Split a path into the name, which is returned, and the status of the
   folder. */
static const char *split_path(char path[PATH_MAX], struct stat *folder)
{
    char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    int outcome = 0;

    if (slash)
        *slash = '\0';
    outcome = stat(!slash ? "." : slash == path ? "/" : path, folder);
    return outcome == 0 ? name : NULL;
}

bool ritz_draft_same(const char *path, const char *other)
{
    char to[PATH_MAX], to_other[PATH_MAX];
    struct stat here, there;
    const bool is = stat(path, &here) == 0;
    const char *name = NULL, *name_of_other = NULL;

    if (is != (stat(other, &there) == 0))
        return false;
    if (is)
        return same_file(&here, &there);
    follow_links(path, to);
    follow_links(other, to_other);
    name = split_path(to, &here);
    name_of_other = split_path(to_other, &there);
    return name && name_of_other && same_file(&here, &there) &&
           strcmp(name, name_of_other) == 0;
}

/* --- drafts and inputs that a program has registered ---------------------- */

typedef struct input {
    struct stat file;
    char *path;
} input;

static struct {
    bool active;
    int64_t count, room;
    ritz_draft *draft;
    int64_t num_inputs, inputs_room;
    input *input;
} held;

void ritz_draft_hold(void)
{
    struct rlimit files;

    held.active = true;
    if (getrlimit(RLIMIT_NOFILE, &files) == 0) {
        files.rlim_cur = files.rlim_max; /* drafts stay open, to keep their
                                            locks */
        (void)setrlimit(RLIMIT_NOFILE, &files);
    }
}

/* Add an input unless it is known. */
static ritz_status add_input(const char *path, input *file)
{
    for (int64_t k = 0; k < held.num_inputs; k++)
        if (same_file(&file->file, &held.input[k].file))
            return RITZ_OK;
    RITZ_CHECK_ROOM(held.input, held.num_inputs, held.inputs_room);
    RITZ_CHECK_COPY(file->path, path, (int64_t)strlen(path) + 1);
    held.input[held.num_inputs++] = *file;
    return RITZ_OK;
}

/* Several threads may read files. */
static pthread_mutex_t inputs_lock = PTHREAD_MUTEX_INITIALIZER;

ritz_status ritz_draft_protect(const char *path)
{
    input file = {0};
    ritz_status status = RITZ_OK;

    if (!held.active || stat(path, &file.file) != 0 ||
        !S_ISREG(file.file.st_mode))
        return RITZ_OK;
    pthread_mutex_lock(&inputs_lock);
    status = add_input(path, &file);
    pthread_mutex_unlock(&inputs_lock);
    return status;
}

void ritz_draft_unprotect(const char *path)
{
    struct stat there = {0};

    if (stat(path, &there) != 0)
        return;
    pthread_mutex_lock(&inputs_lock);
    for (int64_t k = 0; k < held.num_inputs; k++)
        if (same_file(&there, &held.input[k].file)) {
            free(held.input[k].path);
            held.input[k] = held.input[--held.num_inputs];
            break;
        }
    pthread_mutex_unlock(&inputs_lock);
}

ritz_status ritz_draft_check(const char *path)
{
    struct stat there;
    const bool is = stat(path, &there) == 0;

    for (int64_t k = 0; is && k < held.num_inputs; k++)
        RITZ_REFUSE_IF(same_file(&there, &held.input[k].file),
                       RITZ_ERR_ARGUMENT,
                       "this would overwrite the input '%s': give the output "
                       "another name",
                       held.input[k].path);
    for (int64_t k = 0; k < held.count; k++)
        RITZ_REFUSE_IF(ritz_draft_same(path, held.draft[k].path),
                       RITZ_ERR_ARGUMENT,
                       "this file is written twice: give each output a name "
                       "of its own");
    return RITZ_OK;
}

/* Whether a file is the standard output or error of the program. Replacing such
   a file would send what the program prints to a file without a name. */
static bool is_spoken_to(const struct stat *file)
{
    struct stat there;

    for (int k = STDOUT_FILENO; k <= STDERR_FILENO && held.active; k++)
        if (fstat(k, &there) == 0 && same_file(file, &there))
            return true;
    return false;
}

/* --- drafts that killed writers left behind ------------------------------- */

/*
 * A draft is locked as long as its writer lives, by an open file description
 * lock. Such a lock is not lost when another descriptor of the file is closed,
 * as a lock of the process would be, and does not conflict with HDF5, which
 * uses flock. On a file system without locks no draft is removed.
 */
static bool lock_file(int file)
{
    struct flock all = {.l_type = F_WRLCK, .l_whence = SEEK_SET};

    return fcntl(file, F_OFD_SETLK, &all) == 0;
}

/* Whether the name refers to the file that is open. */
static bool is_named(const char *name, int file)
{
    struct stat open_one = {0}, there = {0};

    return fstat(file, &open_one) == 0 && lstat(name, &there) == 0 &&
           same_file(&open_one, &there);
}

/*
 * Lock a new draft; false if another writer, removing old drafts, has locked or
 * removed it in the meantime.
 */
static bool claim_file(const char *name, int file)
{
    struct stat there = {0};

    if (!lock_file(file) && (errno == EAGAIN || errno == EACCES))
        return false;
    return lstat(name, &there) == 0;
}

static const char *skip_digits(const char *at)
{
    while (isdigit((unsigned char)*at))
        at++;
    return at;
}

/* Whether a name is that of a draft of @p target: "TARGET.PID-K.part". */
static bool is_draft_of(const char *target, const char *name)
{
    size_t length = strlen(target);
    const char *pid = name + length + 1;
    const char *end = NULL;

    if (strncmp(name, target, length) != 0 || name[length] != '.')
        return false;
    end = skip_digits(pid);
    if (end == pid || *end != '-' || !isdigit((unsigned char)end[1]))
        return false;
    return strcmp(skip_digits(end + 1), ".part") == 0;
}

/* Remove a draft of this user unless a living writer has locked it. */
static void sweep_file(const char *name)
{
    struct stat there = {0};
    int file = -1;

    if (lstat(name, &there) != 0 || !S_ISREG(there.st_mode) ||
        there.st_uid != geteuid())
        return;
    file = open(name, O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0)
        return;
    if (lock_file(file) && is_named(name, file))
        unlink(name);
    close(file);
}

/* Remove the drafts of @p target that killed writers left in its folder. */
static void sweep_folder(const char *target)
{
    const char *slash = strrchr(target, '/');
    const char *base = slash ? slash + 1 : target;
    const int folder = (int)(base - target); /* length of the folder's name with
                                                the slash */
    char name[PATH_MAX];
    DIR *listing = NULL;

    snprintf(name, sizeof name, "%.*s", folder, target);
    listing = opendir(*name ? name : ".");
    for (struct dirent *entry = listing ? readdir(listing) : NULL; entry;
         entry = readdir(listing)) {
        const int length = snprintf(name, sizeof name, "%.*s%s", folder, target,
                                    entry->d_name);

        if (is_draft_of(base, entry->d_name) && length < PATH_MAX)
            sweep_file(name);
    }
    if (listing)
        closedir(listing);
}

/* --- drafts --------------------------------------------------------------- */

/* Create an empty, locked file under a name that no other writer uses, and list
   it for the signal handler. */
static ritz_status create_draft(const char *path, place *at, ritz_draft *draft)
{
    enum { MOST = 999999 };
    const size_t size = strlen(draft->path) + sizeof ".4294967295-999999.part";
    const mode_t mode = draft->mode < 0 ? 0666 : 0600;

    RITZ_CHECK_NEW(draft->name, (int64_t)size);
    for (int k = 0; k <= MOST; k++) {
        snprintf(draft->name, size, "%s.%ld-%d.part", draft->path,
                 (long)getpid(), k);
        draft->file = create_file(draft->name, mode, at);
        RITZ_REFUSE_IF(draft->file < 0 && errno != EEXIST, RITZ_ERR_FILE,
                       "cannot create '%s': %s", path, strerror(errno));
        if (draft->file < 0)
            continue;
        if (claim_file(draft->name, draft->file))
            return RITZ_OK;
        atomic_store(&at->name, ""); /* another writer is removing the file */
        close(draft->file);
    }
    return ritz_fail(RITZ_ERR_FILE, "cannot create '%s': no name is free",
                     path);
}

ritz_status ritz_draft_new(const char *path, ritz_draft *out)
{
    ritz_draft draft = {.mode = -1};
    ritz_status status = RITZ_OK;
    struct stat there;
    place *at = NULL;
    char target[PATH_MAX];

    RITZ_REFUSE_IF(
        is_descriptor(path), RITZ_ERR_FILE,
        "an open file, such as standard output: an output is written "
        "under a name of its own");
    if (stat(path, &there) == 0) {
        RITZ_REFUSE_IF(!S_ISREG(there.st_mode), RITZ_ERR_FILE,
                       "not a regular file");
        RITZ_REFUSE_IF(is_spoken_to(&there), RITZ_ERR_FILE,
                       "standard output or error goes there already: an output "
                       "is written under a name of its own");
        draft.mode = (int)(there.st_mode & 0777);
    } else {
        RITZ_REFUSE_IF(errno != ENOENT, RITZ_ERR_FILE, "cannot create '%s': %s",
                       path, strerror(errno));
    }
    RITZ_CHECK(ritz_draft_check(path));
    follow_links(path, target);
    sweep_folder(target);
    RITZ_CHECK_COPY(draft.path, target, (int64_t)strlen(target) + 1);
    status = take_place(&at);
    if (status == RITZ_OK)
        status = create_draft(path, at, &draft);
    if (status != RITZ_OK) {
        if (at)
            atomic_store(&at->name, NULL);
        RITZ_FREE(draft.name, draft.path);
        return status;
    }
    *out = draft;
    return RITZ_OK;
}

static bool is_synced(void)
{
    const char *text = getenv("RITZ_SYNC");

    return !text || strcmp(text, "0") != 0;
}

/* fsync of a path that is opened with the flags @p how; returns errno, or 0. */
static int sync_path(const char *path, int how)
{
    int file = open(path, how | O_CLOEXEC);
    int error = 0;

    if (file < 0)
        return errno;
    while (fsync(file) != 0) {
        error = errno;
        if (error != EINTR)
            break;
        error = 0;
    }
    close(file); /* errors of close do not matter: nothing was written through
                    this descriptor */
    return error;
}

/* Write the contents of a draft to the disk before the draft is renamed. */
static ritz_status sync_bytes(const ritz_draft *draft)
{
    int error = is_synced() ? sync_path(draft->name, O_WRONLY) : 0;

    RITZ_REFUSE_IF(error != 0, RITZ_ERR_FILE,
                   "'%s' cannot be written to the disk: %s", draft->path,
                   strerror(error));
    return RITZ_OK;
}

/*
 * Write the name of a file to the disk, which is an fsync of its folder. A
 * folder without read permission cannot be opened, and file systems without
 * this call return EINVAL or EOPNOTSUPP: neither is a failure.
 */
static ritz_status sync_name(const ritz_draft *draft)
{
    const char *slash = strrchr(draft->path, '/');
    int length = slash ? (int)(slash - draft->path) + 1 : 0;
    RITZ_OWN_ARRAY char *folder = NULL;
    int error = 0;

    if (!is_synced())
        return RITZ_OK;
    RITZ_CHECK_NEW(folder, length + 2);
    snprintf(folder, (size_t)length + 2, "%.*s.", length, draft->path);
    error = sync_path(folder, O_RDONLY | O_DIRECTORY);
    RITZ_REFUSE_IF(
        error != 0 && error != EACCES && error != EINVAL && error != EOPNOTSUPP,
        RITZ_ERR_FILE, "the name of '%s' cannot be written to the disk: %s",
        draft->path, strerror(error));
    return RITZ_OK;
}

/* Forget a draft that has been renamed or removed. */
static void forget_name(ritz_draft *draft)
{
    strike_name(draft->name);
    close(draft->file); /* also releases the lock */
    free(draft->name);
    draft->name = NULL;
}

/* Rename a draft to its path; `path` is kept so that the file can be removed
   again. */
static ritz_status name_draft(ritz_draft *draft)
{
    RITZ_REFUSE_IF(draft->mode >= 0 &&
                       chmod(draft->name, (mode_t)draft->mode) != 0,
                   RITZ_ERR_FILE, "cannot keep the permissions of '%s': %s",
                   draft->path, strerror(errno));
    RITZ_REFUSE_IF(rename(draft->name, draft->path) != 0, RITZ_ERR_FILE,
                   "cannot replace '%s': %s", draft->path, strerror(errno));
    forget_name(draft);
    return RITZ_OK;
}

/* Rename drafts up to the first that fails; a signal is held back until all
   have their names. */
static ritz_status rename_each(int64_t count, ritz_draft *draft, int64_t *named)
{
    sigset_t all, before;
    ritz_status status = RITZ_OK;

    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    atomic_store(&naming, true);
    for (; *named < count && status == RITZ_OK; *named += status == RITZ_OK)
        status = name_draft(&draft[*named]);
    atomic_store(&naming, false);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return status;
}

/*
 * Rename either all drafts or none, after the contents of all are on the disk.
 * If a rename fails, or a name cannot be written to the disk, the new files are
 * removed again, because a power cut could lose them as well.
 */
static ritz_status name_all(int64_t count, ritz_draft *draft)
{
    ritz_status status = RITZ_OK;
    int64_t named = 0;

    for (int64_t k = 0; k < count; k++)
        RITZ_CHECK(sync_bytes(&draft[k]));
    status = rename_each(count, draft, &named);
    for (int64_t k = 0; k < count && status == RITZ_OK; k++)
        status = sync_name(&draft[k]);
    for (int64_t k = 0; k < named && status != RITZ_OK; k++)
        remove(draft[k].path);
    return status;
}

ritz_status ritz_draft_publish_now(ritz_draft *draft)
{
    RITZ_CHECK(name_all(1, draft));
    ritz_draft_free(draft);
    return RITZ_OK;
}

ritz_status ritz_draft_publish(ritz_draft *draft)
{
    if (!held.active)
        return ritz_draft_publish_now(draft);
    RITZ_CHECK(ritz_draft_check(draft->path));
    RITZ_CHECK_ROOM(held.draft, held.count, held.room);
    held.draft[held.count++] = *draft;
    *draft = (ritz_draft){0};
    return RITZ_OK;
}

ritz_status ritz_draft_publish_all(int64_t count, ritz_draft *const *draft)
{
    ritz_draft *all = NULL;
    ritz_status status = RITZ_OK;

    if (held.active) {
        for (int64_t k = 0; k < count; k++)
            RITZ_CHECK(ritz_draft_publish(draft[k]));
        return RITZ_OK;
    }
    RITZ_CHECK_NEW(all, count);
    for (int64_t k = 0; k < count; k++)
        RITZ_MOVE(all[k], *draft[k]);
    status = name_all(count, all);
    RITZ_FREE_EACH(ritz_draft, count, all);
    return status;
}

void ritz_draft_free(ritz_draft *draft)
{
    if (draft->name) {
        remove(draft->name);
        forget_name(draft);
    }
    free(draft->path);
    *draft = (ritz_draft){0};
}

ritz_status ritz_draft_settle(bool keep)
{
    const ritz_status status =
        keep ? name_all(held.count, held.draft) : RITZ_OK;

    RITZ_FREE_EACH(ritz_draft, held.count, held.draft);
    for (int64_t k = 0; k < held.num_inputs; k++)
        free(held.input[k].path);
    free(held.input);
    memset(&held, 0, sizeof held);
    return status;
}
