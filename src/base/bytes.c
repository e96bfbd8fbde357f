/*
 * Whole files read into memory, and the SHA-256 (by nettle) that names what was
 * read.
 *
 * Several threads read a large file, each its own pieces, straight into the
 * buffer that is returned. Where a file need not be copied: base/mapped.h.
 */
#define _XOPEN_SOURCE 700 /* NOLINT: declares pread */

#include "base/bytes.h"

#include "base/alloc.h"
#include "base/aside.h"
#include "base/draft.h"
#include "base/team.h"

#include <errno.h>
#include <nettle/sha2.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PIECE = 4 << 20 }; /* bytes that a thread reads at once */

/* A file that is read. */
typedef struct input_file {
    FILE *file;
} input_file;

static void input_file_free(input_file *from)
{
    if (from->file)
        fclose(from->file);
}

static ritz_status open_file(const char *path, input_file *out)
{
    out->file = fopen(path, "rb");
    RITZ_REFUSE_IF(!out->file, RITZ_ERR_FILE, "cannot open '%s': %s", path,
                   strerror(errno));
    return ritz_draft_protect(path);
}

static ritz_status check_file(const char *path, const input_file *from)
{
    RITZ_REFUSE_IF(ferror(from->file), RITZ_ERR_FILE, "cannot read '%s': %s",
                   path, strerror(errno));
    return RITZ_OK;
}

/* Size of a regular file; 0 for a pipe, or if the system does not tell. */
static int64_t stated_size(FILE *file)
{
    struct stat about;

    if (fstat(fileno(file), &about) != 0 || !S_ISREG(about.st_mode))
        return 0;
    return about.st_size < INT64_MAX / 4 ? about.st_size : INT64_MAX / 4;
}

/* ---- pieces by several threads ------------------------------------------ */

typedef struct piecewise {
    int file;
    char *bytes;
    int64_t size;
    atomic_bool failed; /* a piece ended early or could not be read */
} piecewise;

static void read_piece(int64_t k, void *task)
{
    piecewise *all = task;
    int64_t from = PIECE * k;
    const int64_t to = all->size - from < PIECE ? all->size : from + PIECE;

    while (from < to) {
        ssize_t got =
            pread(all->file, all->bytes + from, (size_t)(to - from), from);

        if (got <= 0) {
            atomic_store(&all->failed, true);
            return;
        }
        from += got;
    }
}

/* Read the pieces of a large file by several threads, up to its size as the
   system tells it. @return bytes read; 0: one thread is to read the file */
static int64_t read_pieces(FILE *file, piecewise *all)
{
    const int threads = ritz_team_ready(all->size / PIECE);

    if (threads < 2)
        return 0;
    ritz_team_each(threads, (all->size + PIECE - 1) / PIECE, read_piece, all);
    return atomic_load(&all->failed) || fseeko(file, all->size, SEEK_SET) != 0
               ? 0
               : all->size;
}

/*
 * The size that the system tells is a first guess: the file may have become
 * longer, or be a pipe. So a byte more is requested, and while more bytes come
 * the buffer is doubled.
 */
ritz_status ritz_bytes_read(const char *path, int64_t *size, char **out)
{
    enum { SMALLEST = 4096 };
    RITZ_OWN(input_file) from = {0};
    RITZ_OWN_ARRAY char *bytes = NULL;
    int64_t used = 0, room = 0;
    piecewise all;

    RITZ_CHECK(open_file(path, &from));
    room = stated_size(from.file) + 2; /* one byte more, and a NUL */
    room = room < SMALLEST ? SMALLEST : room;
    RITZ_CHECK_NEW(bytes, room);
    all = (piecewise){fileno(from.file), bytes, room - 2, false};
    used = read_pieces(from.file, &all);
    do {
        RITZ_CHECK_ROOM(bytes, used + 1, room);
        used += (int64_t)fread(bytes + used, 1, (size_t)(room - 1 - used),
                               from.file);
    } while (used == room - 1); /* full: there may be more */
    RITZ_CHECK(check_file(path, &from));
    bytes[used] = '\0'; /* behind it are old pieces if the file was shortened */
    *size = used;
    RITZ_MOVE(*out, bytes);
    return RITZ_OK;
}

/* ---- SHA-256 ------------------------------------------------------------ */

static void write_digest(struct sha256_ctx *sum, char out[RITZ_DIGEST_SIZE])
{
    uint8_t digest[SHA256_DIGEST_SIZE];

    sha256_digest(sum, sizeof digest, digest);
    for (size_t k = 0; k < sizeof digest; k++)
        snprintf(out + 2 * k, 3, "%02x", (unsigned)digest[k]);
}

void ritz_digest_bytes(const void *bytes, size_t size,
                       char out[RITZ_DIGEST_SIZE])
{
    struct sha256_ctx sum;

    sha256_init(&sum);
    sha256_update(&sum, size, bytes);
    write_digest(&sum, out);
}

ritz_status ritz_digest_file(const char *path, char out[RITZ_DIGEST_SIZE])
{
    RITZ_OWN(input_file) from = {0};
    struct sha256_ctx sum;
    uint8_t block[1 << 16];
    size_t size = 0;

    RITZ_CHECK(open_file(path, &from));
    sha256_init(&sum);
    while ((size = fread(block, 1, sizeof block, from.file)) > 0)
        sha256_update(&sum, size, block);
    RITZ_CHECK(check_file(path, &from));
    write_digest(&sum, out);
    return RITZ_OK;
}

struct ritz_digest_work {
    const void *bytes;
    size_t size;
    char digest[RITZ_DIGEST_SIZE];
    ritz_aside aside;
};

static void sum_up(void *task)
{
    ritz_digest_work *work = task;

    ritz_digest_bytes(work->bytes, work->size, work->digest);
}

ritz_status ritz_digest_begin(const void *bytes, int64_t size,
                              ritz_digest_work **out)
{
    ritz_digest_work *work = NULL;

    RITZ_CHECK_NEW(work, 1);
    work->bytes = bytes;
    work->size = (size_t)size;
    ritz_aside_begin(sum_up, work, size >= PIECE, &work->aside);
    *out = work;
    return RITZ_OK;
}

void ritz_digest_end(ritz_digest_work **work, char digest[RITZ_DIGEST_SIZE])
{
    if (!*work)
        return;
    ritz_aside_end(&(*work)->aside);
    if (digest)
        memcpy(digest, (*work)->digest, RITZ_DIGEST_SIZE);
    free(*work);
    *work = NULL;
}
