/* The attributes that every container begins with, and its temporary name. */
#include "base/alloc.h"
#include "base/draft.h"
#include "container/schema.h"

#include <ritz/base.h>

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { FORMAT = 1 };

/* A container being written, under a name of its own until it is complete. */
typedef struct container_writer {
    hid_t file;
    ritz_draft draft;
} container_writer;

/* A short command is a plain attribute. */
static ritz_status set_command(hid_t file, const char *command)
{
    RITZ_OWN_ARRAY char *copy = NULL;
    size_t size = strlen(command) + 1;

    if (size < RITZ_H5_LONG)
        return ritz_h5_set_text(file, "command", command);
    RITZ_CHECK_NEW(copy, (int64_t)size);
    memcpy(copy, command, size);
    return ritz_h5_set_texts(file, "command", 1, &copy);
}

static void free_writer(container_writer *writer)
{
    ritz_h5_close(writer->file);
    ritz_draft_free(&writer->draft);
    *writer = (container_writer){0};
}

static ritz_status new_writer(const char *path, const char *kind,
                              const char *units, const ritz_stamp *stamp,
                              container_writer *out)
{
    ritz_status status = RITZ_OK;
    container_writer writer = {0};
    const int64_t format = FORMAT;

    RITZ_TRY(ritz_draft_new(path, &writer.draft));
    RITZ_TRY(ritz_h5_create(writer.draft.name, &writer.file));
    RITZ_TRY(ritz_h5_set_text(writer.file, "ritz_kind", kind));
    RITZ_TRY(ritz_h5_set(writer.file, "ritz_format", H5T_STD_I64LE,
                         ritz_h5_scalar(), &format));
    RITZ_TRY(ritz_h5_set_text(writer.file, "ritz_version", ritz_version()));
    RITZ_TRY(set_command(writer.file, stamp->command));
    RITZ_TRY(ritz_h5_set_texts(writer.file, "inputs", stamp->num_inputs,
                               stamp->input));
    RITZ_TRY(ritz_h5_set_text(writer.file, "units", units));
    RITZ_MOVE(*out, writer);
done:
    free_writer(&writer);
    return status;
}

/* HDF5 writes what it has buffered: on a full disk closing fails. */
static ritz_status finish_writer(container_writer *writer)
{
    herr_t closed = H5Fclose(writer->file);

    writer->file = 0;
    RITZ_REFUSE_IF(closed < 0, RITZ_ERR_FILE,
                   "cannot be written to its end, is the disk full?");
    return ritz_draft_publish(&writer->draft);
}

/* Open a container of any kind that this release reads. */
static ritz_status open_any(const char *path, char kind[RITZ_NAME_SIZE],
                            hid_t *out)
{
    ritz_status status = RITZ_OK;
    int64_t format = 0;
    hid_t file = 0;

    RITZ_TRY(ritz_h5_open(path, &file));
    RITZ_FAIL_IF(H5Aexists(file, "ritz_kind") <= 0, RITZ_ERR_FORMAT,
                 "an HDF5 file, but no container: it has no 'ritz_kind'");
    RITZ_TRY(ritz_h5_get_text(file, "ritz_kind", RITZ_NAME_SIZE, kind));
    RITZ_TRY(ritz_h5_get(file, "ritz_format", H5T_STD_I64LE, 1, &format));
    RITZ_FAIL_IF(format != FORMAT, RITZ_ERR_FORMAT,
                 "is of format %" PRId64 ", this release reads %d", format,
                 FORMAT);
    *out = file;
    file = 0;
done:
    ritz_h5_close(file);
    return status;
}

ritz_status ritz_schema_write(const char *path, const ritz_schema *schema,
                              const void *object, const char *units,
                              const ritz_stamp *stamp)
{
    ritz_status status = RITZ_OK;
    container_writer writer = {0};
    ritz_place place = {.schema = schema, .object = object};

    RITZ_TRY(new_writer(path, schema->name, units, stamp, &writer));
    place.at = writer.file;
    RITZ_TRY(ritz_schema_move(&place));
    RITZ_TRY(finish_writer(&writer));
done:
    free_writer(&writer);
    return ritz_context(status, path);
}

ritz_status ritz_schema_read(const char *path, const ritz_schema *schema,
                             void *object, char *units)
{
    ritz_status status = RITZ_OK;
    ritz_place place = {.schema = schema, .object = object, .target = object};
    ritz_name found = "";

    RITZ_TRY(open_any(path, found, &place.at));
    RITZ_FAIL_IF(strcmp(found, schema->name) != 0, RITZ_ERR_FORMAT,
                 "holds a %s where a %s is due", found, schema->name);
    if (units)
        RITZ_TRY(ritz_h5_get_text(place.at, "units", RITZ_NAME_SIZE, units));
    RITZ_TRY(ritz_schema_move(&place));
done:
    ritz_h5_close(place.at);
    return ritz_context(status, path);
}

bool ritz_container_is(const char *path)
{
    struct stat there;
    hid_t file = -1;
    bool is = false;

    ritz_h5_begin();
    if (stat(path, &there) == 0 && S_ISREG(there.st_mode))
        file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    is = file >= 0 && H5Aexists(file, "ritz_kind") > 0;
    ritz_h5_close(file);
    return is;
}

ritz_status ritz_container_summary(const char *path, ritz_summary *out)
{
    ritz_status status = RITZ_OK;
    ritz_summary summary = {0};
    char **command = NULL;
    int64_t count = 0;
    hid_t file = 0;

    RITZ_TRY(open_any(path, summary.kind, &file));
    RITZ_TRY(ritz_h5_get_text(file, "ritz_version", RITZ_NAME_SIZE,
                              summary.version));
    RITZ_TRY(ritz_h5_get_text(file, "units", RITZ_NAME_SIZE, summary.units));
    RITZ_TRY(ritz_h5_get_texts(file, "command", &count, &command));
    RITZ_FAIL_IF(count != 1, RITZ_ERR_FORMAT, "'command' is not one text");
    summary.command = command[0];
    command[0] = NULL;
    RITZ_TRY(
        ritz_h5_get_texts(file, "inputs", &summary.num_inputs, &summary.input));
    RITZ_MOVE(*out, summary);
done:
    ritz_h5_free_texts(count, command);
    ritz_summary_free(&summary);
    ritz_h5_close(file);
    return ritz_context(status, path);
}

void ritz_summary_free(ritz_summary *summary)
{
    free(summary->command);
    ritz_h5_free_texts(summary->num_inputs, summary->input);
    *summary = (ritz_summary){0};
}
