#define _DEFAULT_SOURCE /* NOLINT: declares madvise and mkostemp */
#define _GNU_SOURCE     /* NOLINT: the same */
#include "base/spill.h"

#include "base/memory.h"

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

/* Write all bytes from `at` on; returns errno, or 0. */
static int write_bytes(int file, const char *from, size_t bytes, int64_t at)
{
    size_t done = 0;

    while (done < bytes) {
        const ssize_t written =
            pwrite(file, from + done, size_of_chunk(done, bytes),
                   (off_t)(at + (int64_t)done));

        if (written < 0 && errno != EINTR)
            return errno;
        done += written > 0 ? (size_t)written : 0;
    }
    return 0;
}

/* Open a nameless file of a size, for which the folder must have room: a full
   disk is noticed before anything is written. */
static ritz_status open_sized(const char *what, size_t bytes, int *out)
{
    int file = -1;
    int error = 0;

    RITZ_CHECK(open_nameless(what, &file));
    error = posix_fallocate(file, 0, (off_t)bytes);
    if (error != 0) {
        close(file);
        return ritz_fail(RITZ_ERR_FILE,
                         "%s needs %.3g GiB in '%s' (TMPDIR): %s", what,
                         (double)bytes / 0x1p30, ritz_disk_folder(),
                         strerror(error)); /* NOLINT: as above */
    }
    if (atomic_load(&most) < (int64_t)bytes)
        atomic_store(&most, (int64_t)bytes);
    *out = file;
    return RITZ_OK;
}

static ritz_status refuse_write(const char *what, int error)
{
    return ritz_fail(RITZ_ERR_FILE, "%s cannot be written to '%s': %s", what,
                     ritz_disk_folder(),
                     strerror(error)); /* NOLINT: as above */
}

ritz_status ritz_spill_put(const char *what, void *pages, size_t bytes,
                           ritz_spill *out)
{
    int file = -1;
    int error = 0;

    RITZ_CHECK(open_sized(what, bytes, &file));
    error = write_bytes(file, pages, bytes, 0);
    if (error != 0) {
        close(file);
        return refuse_write(what, error);
    }
    (void)madvise(pages, bytes, MADV_DONTNEED);
    ritz_memory_count_mapped(-(int64_t)bytes);
    *out = (ritz_spill){bytes, file};
    return RITZ_OK;
}

/* Read bytes from `at` on. What `once` is read for is not kept in the system's
   own memory. */
static ritz_status read_bytes(int file, int64_t at, size_t bytes, bool once,
                              char *to)
{
    size_t done = 0;

    while (done < bytes) {
        const off_t from = (off_t)(at + (int64_t)done);
        const ssize_t count =
            pread(file, to + done, size_of_chunk(done, bytes), from);

        RITZ_REFUSE_IF(count == 0 || (count < 0 && errno != EINTR),
                       RITZ_ERR_FILE, "a file in '%s' cannot be read back: %s",
                       ritz_disk_folder(),
                       count == 0 ? "it is too short"
                                  : strerror(errno)); /* NOLINT: as above */
        if (count < 0)
            continue;
        if (once)
            (void)posix_fadvise(file, from, count, POSIX_FADV_DONTNEED);
        done += (size_t)count;
    }
    return RITZ_OK;
}

ritz_status ritz_spill_fetch(ritz_spill *spill, void *pages)
{
    if (spill->bytes == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_memory_admit("the factor", (int64_t)spill->bytes));
    RITZ_CHECK(read_bytes(spill->file, 0, spill->bytes, true, pages));
    ritz_memory_count_mapped((int64_t)spill->bytes);
    ritz_spill_free(spill);
    return RITZ_OK;
}

void ritz_spill_free(ritz_spill *spill)
{
    if (spill->bytes > 0)
        close(spill->file);
    *spill = (ritz_spill){0};
}

ritz_status ritz_spill_open(const char *what, size_t bytes, ritz_spill *out)
{
    int file = -1;

    RITZ_CHECK(open_sized(what, bytes, &file));
    *out = (ritz_spill){bytes, file};
    return RITZ_OK;
}

ritz_status ritz_spill_write(const ritz_spill *spill, int64_t at, size_t bytes,
                             const void *from)
{
    const int error = write_bytes(spill->file, from, bytes, at);

    return error == 0 ? RITZ_OK : refuse_write("a part of a matrix", error);
}

ritz_status ritz_spill_read(const ritz_spill *spill, int64_t at, size_t bytes,
                            void *to)
{
    return read_bytes(spill->file, at, bytes, false, to);
}
