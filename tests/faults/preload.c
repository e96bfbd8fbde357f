/*
 * A library that is loaded before the C library and makes one call of a tool
 * fail. RITZ_FAULT is "KIND:K", for the K-th call of a kind, counted from 1:
 *
 *     memory   malloc, calloc, realloc: no memory
 *     write    write, pwrite, ftruncate, fsync, rename, fwrite's own: no room
 *     kill     the process is killed at the K-th call that writes
 *
 * The file RITZ_FAULT_LOG gets lines: "calls N", the number of calls; "failed
 * OBJECT+OFFSET", the program or library whose call failed, and the offset of
 * the call in it, hexadecimal; "signal OBJECT+OFFSET", the same of the code
 * that received a signal.
 */
#define _GNU_SOURCE /* NOLINT: dladdr, and where a signal struck */
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

enum fault_kind { FAULT_NONE, FAULT_MEMORY, FAULT_WRITE, FAULT_KILL };

static enum fault_kind kind;
static long wanted; /* number of the call that fails; 0: none */
static atomic_long calls;
static bool ready;

void *__libc_malloc(size_t size);               /* NOLINT: glibc's own */
void *__libc_calloc(size_t count, size_t size); /* NOLINT */
void *__libc_realloc(void *block, size_t size); /* NOLINT */

/* Append a line to the log, without the C library's streams, which allocate. */
static void put_line(const char *what, const char *more)
{
    char line[512];
    const char *path = getenv("RITZ_FAULT_LOG");
    int file = -1;
    size_t length = 0;

    if (!path)
        return;
    file = (int)syscall(SYS_open, path, O_WRONLY | O_CREAT | O_APPEND, 0600);
    if (file < 0)
        return;
    length = (size_t)snprintf(line, sizeof line, "%s %s\n", what, more);
    (void)syscall(SYS_write, file, line,
                  length < sizeof line ? length : sizeof line - 1);
    (void)syscall(SYS_close, file);
}

/* Log the program or library that contains this code, and its offset there. */
static void put_object(const char *what, const void *code)
{
    Dl_info info = {0};
    char place[480];
    const bool found = dladdr(code, &info) != 0 && info.dli_fname;

    (void)snprintf(
        place, sizeof place, "%.400s+%tx", found ? info.dli_fname : "unknown",
        found ? (const char *)code - (const char *)info.dli_fbase : 0);
    put_line(what, place);
}

/* The C library often calls on behalf of others: the first of its callers in
   another object. */
static const void *find_asker(const void *from)
{
    enum { MOST = 24 };
    void *frames[MOST] = {NULL};
    Dl_info here = {0}, info = {0};
    int count = 0, k = 0;

    if (dladdr(from, &info) == 0 || !info.dli_fname ||
        !strstr(info.dli_fname, "/libc.so"))
        return from;
    count = backtrace(frames, MOST);
    dladdr((const void *)frames[0], &here);
    for (k = 0; k < count; k++)
        if (dladdr(frames[k], &info) != 0 && info.dli_fbase != here.dli_fbase &&
            !strstr(info.dli_fname, "/libc.so"))
            return frames[k];
    return from;
}

/* Whether this call is to fail; `from` is its caller. */
static bool is_to_fail(enum fault_kind asked, const void *from)
{
    if (!ready || kind != asked || atomic_fetch_add(&calls, 1) + 1 != wanted)
        return false;
    ready = false; /* the report itself must not fail */
    put_object("failed", find_asker(from));
    ready = true;
    return true;
}

static void note_signal(int number, siginfo_t *info, void *context)
{
    const ucontext_t *at = context;
    const void *code =
        (const void *)at->uc_mcontext.gregs[REG_RIP]; /* NOLINT */
    char text[24];

    (void)info;
    ready = false;
    (void)snprintf(text, sizeof text, "%d", number);
    put_line("number", text);
    put_object("signal", find_asker(code));
    signal(number, SIG_DFL);
    raise(number);
}

[[gnu::constructor]] static void begin_faults(void)
{
    static const int numbers[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
    static const char *const words[] = {[FAULT_MEMORY] = "memory:",
                                        [FAULT_WRITE] = "write:",
                                        [FAULT_KILL] = "kill:"};
    /* a stack for the handler, as an overflow of the stack is a signal too */
    static char room[65536];
    const stack_t other = {.ss_sp = room, .ss_size = sizeof room};
    struct sigaction action = {
        .sa_sigaction = note_signal,
        .sa_flags = (int)(SA_SIGINFO | SA_RESETHAND | SA_ONSTACK)};
    /* ritz-walk, which reads HDF5 files first, is not under test */
    const bool other_program =
        strcmp(program_invocation_short_name, "ritz-walk") == 0;
    const char *text = other_program ? NULL : getenv("RITZ_FAULT");
    void *first = NULL;

    for (int k = FAULT_MEMORY; text && k <= FAULT_KILL; k++)
        if (strncmp(text, words[k], strlen(words[k])) == 0) {
            kind = (enum fault_kind)k;
            wanted = strtol(text + strlen(words[k]), NULL, 10);
        }
    sigaltstack(&other, NULL);
    (void)backtrace(&first, 1); /* its first call allocates */
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        sigaction(numbers[k], &action, NULL);
    ready = kind != FAULT_NONE;
}

[[gnu::destructor]] static void end_faults(void)
{
    char text[24];

    if (!ready)
        return;
    ready = false;
    (void)snprintf(text, sizeof text, "%ld", atomic_load(&calls));
    put_line("calls", text);
}

/* NOLINTBEGIN(readability-inconsistent-declaration-parameter-name): glibc's */

/* --- memory --------------------------------------------------------------- */

void *malloc(size_t size)
{
    if (is_to_fail(FAULT_MEMORY, __builtin_return_address(0))) {
        errno = ENOMEM;
        return NULL;
    }
    return __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    if (is_to_fail(FAULT_MEMORY, __builtin_return_address(0))) {
        errno = ENOMEM;
        return NULL;
    }
    return __libc_calloc(count, size);
}

void *realloc(void *block, size_t size)
{
    if (is_to_fail(FAULT_MEMORY, __builtin_return_address(0))) {
        errno = ENOMEM;
        return NULL;
    }
    return __libc_realloc(block, size);
}

/* --- writes --------------------------------------------------------------- */

/* Only files fail: standard output and standard error are the user's. */
static bool is_file(int file)
{
    struct stat there;

    return fstat(file, &there) == 0 && S_ISREG(there.st_mode);
}

static bool writes_fail(bool counts, const void *from)
{
    if (!counts)
        return false;
    if (is_to_fail(FAULT_KILL, from))
        kill(getpid(), SIGKILL);
    if (!is_to_fail(FAULT_WRITE, from))
        return false;
    errno = ENOSPC;
    return true;
}

ssize_t write(int file, const void *bytes, size_t size)
{
    if (writes_fail(ready && is_file(file), __builtin_return_address(0)))
        return -1;
    return syscall(SYS_write, file, bytes, size);
}

ssize_t pwrite(int file, const void *bytes, size_t size, off_t at)
{
    if (writes_fail(ready && is_file(file), __builtin_return_address(0)))
        return -1;
    return syscall(SYS_pwrite64, file, bytes, size, at);
}

ssize_t pwrite64(int file, const void *bytes, size_t size, off_t at)
{
    return pwrite(file, bytes, size, at);
}

int ftruncate(int file, off_t size)
{
    if (writes_fail(true, __builtin_return_address(0)))
        return -1;
    return (int)syscall(SYS_ftruncate, file, size);
}

int fsync(int file)
{
    if (writes_fail(true, __builtin_return_address(0)))
        return -1;
    return (int)syscall(SYS_fsync, file);
}

int rename(const char *from, const char *to)
{
    if (writes_fail(true, __builtin_return_address(0)))
        return -1;
    return (int)syscall(SYS_rename, from, to);
}

/* NOLINTEND(readability-inconsistent-declaration-parameter-name) */
