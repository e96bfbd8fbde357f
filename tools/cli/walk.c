/* The process that reads an HDF5 file before the tool does. */
#define _DEFAULT_SOURCE /* NOLINT: declares syscall */

#include "cli/walk.h"

#include "base/alloc.h"
#include "cli/child.h"
#include "cli/libexec.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

/* --- files that were read before ------------------------------------------ */

enum { REMEMBERED = 64 };

/* A tool opens a file more than once. A change of the file changes its device,
   inode, size or times. */
static struct stat sound[REMEMBERED];
static int64_t num_sound;

static bool same_time(const struct timespec *a, const struct timespec *b)
{
    return a->tv_sec == b->tv_sec && a->tv_nsec == b->tv_nsec;
}

static bool are_same(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino &&
           a->st_size == b->st_size && same_time(&a->st_mtim, &b->st_mtim) &&
           same_time(&a->st_ctim, &b->st_ctim);
}

static bool is_remembered(const struct stat *file)
{
    for (int64_t k = 0; k < num_sound && k < REMEMBERED; k++)
        if (are_same(&sound[k], file))
            return true;
    return false;
}

/* --- the process ---------------------------------------------------------- */

/* Set a limit, never above the present one. Beyond the soft limit the process
   gets a signal, beyond the hard limit, `above` higher, it is killed. */
static bool limit_use(int what, rlim_t most, rlim_t above)
{
    struct rlimit limit = {0};

    if (getrlimit(what, &limit) != 0)
        return false;
    if (limit.rlim_max > most + above)
        limit.rlim_max = most + above;
    if (limit.rlim_cur > most)
        limit.rlim_cur = most;
    return setrlimit(what, &limit) == 0;
}

static rlim_t count_seconds(off_t size)
{
    const rlim_t most = WALK_SECONDS + (rlim_t)size / WALK_BYTES_A_SECOND;
    struct rlimit limit = {0};

    if (getrlimit(RLIMIT_CPU, &limit) != 0 || limit.rlim_cur > most)
        return most;
    return limit.rlim_cur;
}

/* In the child: keep the file open as WALK_FILE, and nothing else. */
static bool pass_file(int file)
{
    const int copy = fcntl(file, F_DUPFD_CLOEXEC, WALK_FILE + 1);
    const int nothing = open("/dev/null", O_RDWR);

    for (int k = 0; k < WALK_FILE; k++)
        if (dup2(nothing, k) < 0)
            return false;
    if (dup2(copy, WALK_FILE) < 0)
        return false;
    (void)syscall(SYS_close_range, WALK_FILE + 1, ~0U, 0); /* since Linux 5.9 */
    return true;
}

/* Limit processor time, memory, and time by the clock: ten times as much, as a
   slow disk delays a sound file. */
static bool set_limits(off_t size)
{
    const rlim_t seconds = count_seconds(size);
    sigset_t none;

    sigemptyset(&none);
    signal(SIGXCPU, SIG_DFL); /* even if the tool ignores it */
    signal(SIGALRM, SIG_DFL);
    sigprocmask(SIG_SETMASK, &none, NULL);
    alarm((unsigned)(seconds < 100000 ? 10 * seconds : 1000000));
    return limit_use(RLIMIT_CPU, seconds, 1) &&
           limit_use(RLIMIT_DATA, WALK_BYTES, 0) &&
           limit_use(RLIMIT_FSIZE, 0, 0) && limit_use(RLIMIT_CORE, 0, 0);
}

static _Noreturn void become_walker(const char *program, int file, off_t size)
{
    static char name[] = "ritz-walk";
    char *const argv[] = {name, NULL};

    if (pass_file(file) && set_limits(size))
        execv(program, argv);
    _exit(CHILD_NO_PROGRAM);
}

/* --- how it ended --------------------------------------------------------- */

static ritz_status explain_signal(int number, off_t size)
{
    if (number == SIGXCPU || number == SIGALRM)
        return ritz_fail(RITZ_ERR_FORMAT,
                         "damaged, or made to take long: HDF5 has not read its "
                         "%" PRId64 " bytes after %" PRId64 " s",
                         (int64_t)size, (int64_t)count_seconds(size));
    return ritz_fail(RITZ_ERR_FORMAT,
                     "damaged: HDF5 ends by '%s' as it reads the file",
                     strsignal(number));
}

static ritz_status explain_end(int outcome, off_t size)
{
    const int end = WIFEXITED(outcome) ? WEXITSTATUS(outcome) : -1;

    if (WIFSIGNALED(outcome))
        return explain_signal(WTERMSIG(outcome), size);
    RITZ_REFUSE_IF(end == WALK_UNOPENED, RITZ_ERR_FORMAT,
                   "not an HDF5 file, or damaged");
    RITZ_REFUSE_IF(end == WALK_MEMORY, RITZ_ERR_FORMAT,
                   "damaged, or made to take memory: HDF5 asks for more than "
                   "%d MiB to read its %" PRId64 " bytes",
                   WALK_BYTES >> 20, (int64_t)size);
    RITZ_REFUSE_IF(end == CHILD_NO_PROGRAM, RITZ_ERR_FILE,
                   "cannot be checked: ritz-walk cannot be started");
    RITZ_REFUSE_IF(end != WALK_WHOLE, RITZ_ERR_FORMAT,
                   "damaged: HDF5 ends with status %d as it reads the file",
                   end);
    return RITZ_OK;
}

static ritz_status start_walker(int file, const struct stat *before, pid_t *out)
{
    char program[PATH_MAX];
    pid_t child = -1;

    RITZ_CHECK_IN("cannot be checked", libexec_find("ritz-walk", program));
    /* if it were ignored, no outcome would be reported */
    signal(SIGCHLD, SIG_DFL);
    child = child_start(SIGKILL);
    if (child == 0)
        become_walker(program, file, before->st_size);
    RITZ_REFUSE_IF(child < 0, RITZ_ERR_FILE,
                   "cannot be checked by a process of its own: %s",
                   strerror(errno));
    *out = child;
    return RITZ_OK;
}

/* --- files that will be read soon ----------------------------------------- */

enum { MOST_AHEAD = 8 };

/* Processes that were started before their file is opened; child 0: none. */
static struct walker {
    struct stat file;
    pid_t child;
} ahead[MOST_AHEAD];

/* The entry of a file; NULL: there is none. An empty one, if @p file is NULL. */
static struct walker *find_ahead(const struct stat *file)
{
    for (int k = 0; k < MOST_AHEAD; k++)
        if (file ? ahead[k].child > 0 && are_same(&ahead[k].file, file)
                 : ahead[k].child == 0)
            return &ahead[k];
    return NULL;
}

/* Whether a file begins as HDF5 files do. */
static bool has_signature(int file)
{
    static const char signature[] = "\211HDF\r\n\032\n";
    char begin[sizeof signature - 1] = {0};

    return pread(file, begin, sizeof begin, 0) == (ssize_t)sizeof begin &&
           memcmp(begin, signature, sizeof begin) == 0;
}

void walk_ahead(const char *path)
{
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    struct walker *free_one = find_ahead(NULL);
    struct stat before = {0};

    if (file >= 0 && free_one && fstat(file, &before) == 0 &&
        S_ISREG(before.st_mode) && has_signature(file) &&
        !is_remembered(&before) && !find_ahead(&before) &&
        start_walker(file, &before, &free_one->child) == RITZ_OK)
        free_one->file = before;
    if (file >= 0)
        close(file);
}

ritz_status walk_file(int file)
{
    struct stat before = {0};
    struct walker *early = NULL;
    pid_t child = -1;
    int outcome = 0;

    RITZ_REFUSE_IF(fstat(file, &before) != 0, RITZ_ERR_FILE, "%s",
                   strerror(errno));
    if (is_remembered(&before))
        return RITZ_OK;
    early = find_ahead(&before);
    if (early) {
        child = early->child;
        early->child = 0;
    } else {
        RITZ_CHECK(start_walker(file, &before, &child));
    }
    RITZ_REFUSE_IF(child_wait(child, &outcome) != 0, RITZ_ERR_FILE,
                   "cannot be checked by a process of its own: %s",
                   strerror(errno));
    RITZ_CHECK(explain_end(outcome, before.st_size));
    sound[num_sound++ % REMEMBERED] = before;
    return RITZ_OK;
}
