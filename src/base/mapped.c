#define _DEFAULT_SOURCE /* NOLINT: declares MAP_ANONYMOUS */

#include "base/mapped.h"

#include "base/alloc.h"

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
    int file;
    struct stat about; /* when it was mapped */
    char *bytes;
    size_t size;
    atomic_bool torn; /* a part was gone when it was read */
};

/* The maps that exist, for the handler, which has no argument. */
static _Atomic(ritz_mapped *) maps[MOST];
static atomic_bool allowed;
static struct sigaction before;

/* Zeros in place of what follows the fault: the file has become shorter. The
   calls are those of the system, which a handler may use. */
static bool mend_map(ritz_mapped *mapped, const char *fault)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    const size_t from = (size_t)(fault - mapped->bytes) / page * page;

    atomic_store(&mapped->torn, true);
    return mmap(mapped->bytes + from, mapped->size + 1 - from, PROT_READ,
                MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) != MAP_FAILED;
}

static void handle_fault(int number, siginfo_t *info, void *context)
{
    const char *fault = info->si_addr;

    for (int k = 0; k < MOST; k++) {
        ritz_mapped *mapped = atomic_load(&maps[k]);

        if (mapped && fault >= mapped->bytes &&
            fault <= mapped->bytes + mapped->size && mend_map(mapped, fault))
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

/* Enter a map where the handler finds it. @return false if there are too many */
static bool enter_map(ritz_mapped *mapped)
{
    for (int k = 0; k < MOST; k++) {
        ritz_mapped *none = NULL;

        if (atomic_compare_exchange_strong(&maps[k], &none, mapped))
            return true;
    }
    return false;
}

static void strike_map(ritz_mapped *mapped)
{
    for (int k = 0; k < MOST; k++) {
        ritz_mapped *expected = mapped;

        if (atomic_compare_exchange_strong(&maps[k], &expected, NULL))
            return;
    }
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
    mapped->bytes = bytes;
    return enter_map(mapped);
}

ritz_status ritz_mapped_new(const char *path, ritz_mapped **out)
{
    struct stat there = {0};
    ritz_mapped *mapped = NULL;

    *out = NULL;
    /* not even opened: who writes to a pipe must not lose its reader */
    if (!atomic_load(&allowed) || stat(path, &there) != 0 ||
        !S_ISREG(there.st_mode) || there.st_size < SMALLEST)
        return RITZ_OK;
    RITZ_CHECK_NEW(mapped, 1);
    mapped->file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (mapped->file >= 0 && map_file(mapped)) {
        *out = mapped;
        return RITZ_OK;
    }
    ritz_mapped_free(&mapped);
    return RITZ_OK;
}

const char *ritz_mapped_bytes(const ritz_mapped *mapped, int64_t *size)
{
    *size = (int64_t)mapped->size;
    return mapped->bytes;
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

    if (!old)
        return;
    if (old->bytes) {
        strike_map(old);
        munmap(old->bytes, old->size);
    }
    if (old->file >= 0)
        close(old->file);
    free(old);
    *mapped = NULL;
}
