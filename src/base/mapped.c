#define _DEFAULT_SOURCE /* NOLINT: declares MAP_ANONYMOUS */

#include "base/mapped.h"

#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    SMALLEST = 4 << 20, /* bytes; smaller files are copied as fast */
    MOST = 8,           /* maps at a time */
};

struct ritz_mapped {
    struct stat about;     /* when it was mapped */
    _Atomic(char *) bytes; /* NULL: nothing is mapped */
    size_t size;
    int file;
    atomic_bool taken;
    atomic_bool torn; /* a part was gone when it was read */
};

/* All maps, for the handler, which has no argument: it may look at one that
   another thread ends at that moment, so that their memory is never freed. */
static ritz_mapped maps[MOST];
static atomic_bool allowed;
static struct sigaction before;

/* Zeros in place of what follows the fault: the file has become shorter. The
   calls are those of the system, which a handler may use. */
static bool mend_map(ritz_mapped *mapped, char *bytes, const char *fault)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    const size_t from = (size_t)(fault - bytes) / page * page;

    atomic_store(&mapped->torn, true);
    return mmap(bytes + from, mapped->size + 1 - from, PROT_READ,
                MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) != MAP_FAILED;
}

static void handle_fault(int number, siginfo_t *info, void *context)
{
    const char *fault = info->si_addr;

    for (int k = 0; k < MOST; k++) {
        char *bytes = atomic_load(&maps[k].bytes);

        if (bytes && fault >= bytes && fault <= bytes + maps[k].size &&
            mend_map(&maps[k], bytes, fault))
            return;
    }
    if (before.sa_flags & SA_SIGINFO)
        before.sa_sigaction(number, info, context);
    else if (before.sa_handler != SIG_DFL && before.sa_handler != SIG_IGN)
        before.sa_handler(number);
    else
        signal(number, SIG_DFL); /* the fault comes again, and ends us */
}

void ritz_map_files(void)
{
    struct sigaction now, action = {.sa_sigaction = handle_fault,
                                    .sa_flags = SA_SIGINFO | SA_ONSTACK};

    sigemptyset(&action.sa_mask);
    if (sigaction(SIGBUS, NULL, &now) != 0 ||
        ((now.sa_flags & SA_SIGINFO) && now.sa_sigaction == handle_fault))
        return;
    before = now;
    if (sigaction(SIGBUS, &action, NULL) == 0)
        atomic_store(&allowed, true);
}

/* A map that is not in use; NULL if there are too many. */
static ritz_mapped *take_map(void)
{
    for (int k = 0; k < MOST; k++)
        if (!atomic_exchange(&maps[k].taken, true))
            return &maps[k];
    return NULL;
}

/* Map an open file, if a NUL follows its bytes: the rest of its last page is
   zero, but a file may end where a page does. */
static bool map_file(ritz_mapped *mapped)
{
    const int64_t page = sysconf(_SC_PAGESIZE);
    void *bytes = NULL;

    if (fstat(mapped->file, &mapped->about) != 0 ||
        !S_ISREG(mapped->about.st_mode) || mapped->about.st_size < SMALLEST ||
        mapped->about.st_size % page == 0)
        return false;
    mapped->size = (size_t)mapped->about.st_size;
    bytes = mmap(NULL, mapped->size, PROT_READ, MAP_PRIVATE, mapped->file, 0);
    if (bytes == MAP_FAILED)
        return false;
    atomic_store(&mapped->torn, false);
    atomic_store(&mapped->bytes, bytes);
    return true;
}

ritz_mapped *ritz_mapped_new(const char *path)
{
    struct stat there = {0};
    ritz_mapped *mapped = NULL;

    /* not even opened: who writes to a pipe must not lose its reader */
    if (!atomic_load(&allowed) || stat(path, &there) != 0 ||
        !S_ISREG(there.st_mode) || there.st_size < SMALLEST)
        return NULL;
    mapped = take_map();
    if (!mapped)
        return NULL;
    mapped->file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (mapped->file < 0 || !map_file(mapped))
        ritz_mapped_free(&mapped);
    return mapped;
}

const char *ritz_mapped_bytes(const ritz_mapped *mapped, int64_t *size)
{
    *size = (int64_t)mapped->size;
    return atomic_load(&mapped->bytes);
}

bool ritz_mapped_changed(const ritz_mapped *mapped)
{
    struct stat now = {0};
    const struct stat *then = &mapped->about;

    return fstat(mapped->file, &now) != 0 || now.st_size != then->st_size ||
           now.st_mtim.tv_sec != then->st_mtim.tv_sec ||
           now.st_mtim.tv_nsec != then->st_mtim.tv_nsec ||
           atomic_load(&mapped->torn);
}

void ritz_mapped_free(ritz_mapped **mapped)
{
    ritz_mapped *old = *mapped;
    char *bytes = NULL;

    if (!old)
        return;
    bytes = atomic_exchange(&old->bytes, NULL);
    if (bytes)
        munmap(bytes, old->size);
    if (old->file >= 0)
        close(old->file);
    atomic_store(&old->taken, false);
    *mapped = NULL;
}
