#define _DEFAULT_SOURCE /* NOLINT: declares madvise and mkostemp */
#define _GNU_SOURCE     /* NOLINT: the same */
#include "base/spill.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/vfs.h>
#include <unistd.h>

enum {
    CHUNK = 64 << 20,      /* bytes of one call of write() or read() */
    IN_MEMORY = 0x1021994, /* f_type of tmpfs, see statfs(2) */
};

static _Atomic int64_t most; /* bytes of the largest file so far */

int64_t ritz_disk_used(void)
{
    return atomic_load(&most);
}

const char *ritz_disk_folder(void)
{
    const char *folder = getenv("TMPDIR");

    return folder && *folder ? folder : "/var/tmp";
}

/* Open a new file and delete its name at once. */
static ritz_status open_nameless(const char *what, int *out)
{
    const char *folder = ritz_disk_folder();
    struct statfs system = {0};
    char name[4096];
    int file = -1;

    snprintf(name, sizeof name, "%s/ritz-XXXXXX", folder);
    file = mkostemp(name, O_CLOEXEC);
    RITZ_REFUSE_IF(file < 0, RITZ_ERR_FILE,
                   "%s cannot be written to '%s' (TMPDIR): %s", what, folder,
                   strerror(errno)); /* NOLINT: one thread writes files */
    unlink(name);
    if (fstatfs(file, &system) == 0 && system.f_type == IN_MEMORY) {
        close(file);
        return ritz_fail(RITZ_ERR_FILE,
                         "%s does not fit into memory, and files in '%s' are "
                         "in memory, too: set TMPDIR to a folder on a disk",
                         what, folder);
    }
    *out = file;
    return RITZ_OK;
}

/* How many of the bytes from `at` on the next call writes or reads. */
static size_t size_of_chunk(size_t at, size_t bytes)
{
    return bytes - at < CHUNK ? bytes - at : CHUNK;
}

/* Write all bytes; returns errno, or 0. */
static int write_pages(int file, const char *pages, size_t bytes)
{
    size_t at = 0;

    /* a full disk is noticed before anything is written */
    const int error = posix_fallocate(file, 0, (off_t)bytes);

    if (error != 0)
        return error;
    while (at < bytes) {
        const ssize_t written =
            pwrite(file, pages + at, size_of_chunk(at, bytes), (off_t)at);

        if (written < 0 && errno != EINTR)
            return errno;
        at += written > 0 ? (size_t)written : 0;
    }
    return 0;
}

ritz_status ritz_spill_put(const char *what, void *pages, size_t bytes,
                           ritz_spill *out)
{
    int file = -1;
    int error = 0;

    RITZ_CHECK(open_nameless(what, &file));
    error = write_pages(file, pages, bytes);
    if (error != 0) {
        close(file);
        return ritz_fail(RITZ_ERR_FILE,
                         "%s needs %.3g GiB in '%s' (TMPDIR): %s", what,
                         (double)bytes / 0x1p30, ritz_disk_folder(),
                         strerror(error)); /* NOLINT: as above */
    }
    (void)madvise(pages, bytes, MADV_DONTNEED);
    if (atomic_load(&most) < (int64_t)bytes)
        atomic_store(&most, (int64_t)bytes);
    *out = (ritz_spill){bytes, file};
    return RITZ_OK;
}

ritz_status ritz_spill_fetch(ritz_spill *spill, void *pages)
{
    size_t at = 0;

    while (at < spill->bytes) {
        const size_t size = size_of_chunk(at, spill->bytes);
        const ssize_t count =
            pread(spill->file, (char *)pages + at, size, (off_t)at);

        RITZ_REFUSE_IF(count == 0 || (count < 0 && errno != EINTR),
                       RITZ_ERR_FILE, "a file in '%s' cannot be read back: %s",
                       ritz_disk_folder(),
                       count == 0 ? "it is too short"
                                  : strerror(errno)); /* NOLINT: as above */
        if (count < 0)
            continue;
        /* the system need not keep a copy of the file in memory */
        (void)posix_fadvise(spill->file, (off_t)at, count, POSIX_FADV_DONTNEED);
        at += (size_t)count;
    }
    ritz_spill_free(spill);
    return RITZ_OK;
}

void ritz_spill_free(ritz_spill *spill)
{
    if (spill->bytes > 0)
        close(spill->file);
    *spill = (ritz_spill){0};
}
