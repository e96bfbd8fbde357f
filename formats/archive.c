/*
 * Writes zip archives. Entries have no times, the owner 0 and fixed modes, so
 * that the same files always give the same bytes. The archive is built in
 * memory, as libarchive 3.6 does not free its compressor if a write fails.
 */
#include "base/alloc.h"
#include "formats/fmu.h"
#include "formats/sink.h"

#include <archive.h>
#include <archive_entry.h>
#include <errno.h>
#include <stdlib.h>

typedef struct archive *zip_writer;
typedef struct archive_entry *zip_entry;

static void zip_writer_free(zip_writer *a)
{
    if (*a)
        archive_write_free(*a);
    *a = NULL;
}

static void zip_entry_free(zip_entry *e)
{
    if (*e)
        archive_entry_free(*e);
    *e = NULL;
}

static ritz_status fail_archive(zip_writer a, const char *path)
{
    const char *why = archive_error_string(a);

    return ritz_fail(RITZ_ERR_FILE, "'%s' cannot be written to its end: %s",
                     path, why ? why : "no memory");
}

static ritz_status put_file(zip_writer a, const char *path,
                            const ritz_zip_file *from)
{
    enum { FILE_MODE = 0644, PROGRAM_MODE = 0755 };
    RITZ_OWN(zip_entry) head = archive_entry_new();

    RITZ_REFUSE_IF(!head, RITZ_ERR_MEMORY, "no memory for an archive");
    archive_entry_set_pathname(head, from->path);
    archive_entry_set_filetype(head, AE_IFREG);
    archive_entry_set_perm(head, from->runs ? PROGRAM_MODE : FILE_MODE);
    archive_entry_set_size(head, from->size);
    if (archive_write_header(a, head) != ARCHIVE_OK)
        return fail_archive(a, path);
    if (archive_write_data(a, from->bytes, (size_t)from->size) != from->size)
        return fail_archive(a, path);
    return RITZ_OK;
}

static la_ssize_t append_bytes(struct archive *a, void *to, const void *bytes,
                               size_t size)
{
    if (fwrite(bytes, 1, size, to) == size)
        return (la_ssize_t)size;
    archive_set_error(a, ENOMEM, "no memory");
    return -1;
}

typedef struct named_files {
    const char *path; /* of the archive */
    const ritz_zip_files *files;
} named_files;

static ritz_status put_files(FILE *to, const void *what)
{
    const named_files *all = what;
    const ritz_zip_files *files = all->files;
    const char *path = all->path;
    RITZ_OWN(zip_writer) a = archive_write_new();

    RITZ_REFUSE_IF(!a, RITZ_ERR_MEMORY, "no memory for an archive");
    if (archive_write_set_format_zip(a) != ARCHIVE_OK ||
        archive_write_set_options(a, "zip:compression=deflate") != ARCHIVE_OK ||
        archive_write_set_bytes_in_last_block(a, 1) != ARCHIVE_OK ||
        archive_write_open(a, to, NULL, append_bytes, NULL) != ARCHIVE_OK)
        return fail_archive(a, path);
    for (int64_t k = 0; k < files->count; k++)
        RITZ_CHECK(put_file(a, path, &files->at[k]));
    if (archive_write_close(a) != ARCHIVE_OK)
        return fail_archive(a, path);
    return RITZ_OK;
}

typedef struct held_zip {
    const char *bytes;
    int64_t size;
} held_zip;

static ritz_status copy_bytes(FILE *file, const void *what)
{
    const held_zip *zip = what;

    fwrite(zip->bytes, 1, (size_t)zip->size, file);
    return RITZ_OK;
}

ritz_status ritz_archive_write(const char *path, const ritz_zip_files *files)
{
    const named_files all = {path, files};
    RITZ_OWN_ARRAY char *bytes = NULL;
    held_zip zip = {0};

    RITZ_CHECK(
        ritz_sink_hold(put_files, &all, "an archive", &bytes, &zip.size));
    zip.bytes = bytes;
    return ritz_sink_write(path, copy_bytes, &zip);
}
