/* The attributes that every container begins with, its temporary name, and
   containers as the source of a scene's models. */
#include "base/alloc.h"
#include "base/draft.h"
#include "container/schema.h"

#include <ritz/base.h>

#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FORMAT = 1 };

/* A short command is a plain attribute. */
static ritz_status write_command(hid_t file, const char *command)
{
    RITZ_OWN_ARRAY char *copy = NULL;
    size_t size = strlen(command) + 1;

    if (size < RITZ_H5_LONG)
        return ritz_h5_set_text(file, "command", command);
    RITZ_CHECK_NEW(copy, (int64_t)size);
    memcpy(copy, command, size);
    return ritz_h5_set_texts(file, "command", 1, &copy);
}

/* The attributes that every container begins with. */
static ritz_status write_head(hid_t file, const char *kind, const char *units,
                              const ritz_stamp *stamp)
{
    const int64_t format = FORMAT;

    RITZ_CHECK(ritz_h5_set_text(file, "ritz_kind", kind));
    RITZ_CHECK(ritz_h5_set(file, "ritz_format", H5T_STD_I64LE, ritz_h5_scalar(),
                           &format));
    RITZ_CHECK(ritz_h5_set_text(file, "ritz_version", ritz_version()));
    RITZ_CHECK(write_command(file, stamp->command));
    RITZ_CHECK(
        ritz_h5_set_texts(file, "inputs", stamp->num_inputs, stamp->input));
    if (stamp->interrupted)
        RITZ_CHECK(ritz_h5_set_text(file, "interrupted", stamp->interrupted));
    return ritz_h5_set_text(file, "units", units);
}

/* A file is written under a name of its own until it is complete. */
static ritz_status write_container(const char *path, const ritz_schema *schema,
                                   const void *object, const ritz_stamp *stamp)
{
    RITZ_OWN(ritz_draft) draft = {0};
    RITZ_OWN(hid_t) file = 0;
    const char *units =
        schema->units > 0 ? (const char *)object + schema->units : "";

    ritz_monitor_step("writing", 0, 0);
    if (schema->check)
        RITZ_CHECK(schema->check(object));
    RITZ_CHECK(ritz_draft_new(path, &draft));
    RITZ_CHECK(ritz_h5_create(draft.name, &file));
    RITZ_CHECK(write_head(file, schema->name, units, stamp));
    RITZ_CHECK(ritz_schema_move(
        &(ritz_place){.at = file, .schema = schema, .object = object}));
    RITZ_CHECK(ritz_h5_finish(&file));
    return stamp->now ? ritz_draft_publish_now(&draft)
                      : ritz_draft_publish(&draft);
}

ritz_status ritz_schema_open(const char *path, char kind[RITZ_NAME_SIZE],
                             hid_t *out)
{
    RITZ_OWN(hid_t) file = 0;
    int64_t format = 0;

    RITZ_CHECK(ritz_h5_open(path, &file));
    RITZ_REFUSE_IF(H5Aexists(file, "ritz_kind") <= 0, RITZ_ERR_FORMAT,
                   "an HDF5 file, but no container: it has no 'ritz_kind'");
    RITZ_CHECK(ritz_h5_get_text(file, "ritz_kind", RITZ_NAME_SIZE, kind));
    RITZ_CHECK(ritz_h5_get(file, "ritz_format", H5T_STD_I64LE, 1, &format));
    RITZ_REFUSE_IF(format != FORMAT, RITZ_ERR_FORMAT,
                   "is of format %" PRId64 ", this release reads %d", format,
                   FORMAT);
    RITZ_CHECK(ritz_h5_refuse_links(file));
    RITZ_MOVE(*out, file);
    return RITZ_OK;
}

ritz_status ritz_schema_read(const char *path, const ritz_schema *schema,
                             void *object)
{
    RITZ_OWN(hid_t) file = 0;
    ritz_name found = "";

    ritz_monitor_step("reading", 0, 0);
    RITZ_CHECK(ritz_schema_open(path, found, &file));
    RITZ_REFUSE_IF(strcmp(found, schema->name) != 0, RITZ_ERR_FORMAT,
                   "holds a %s where a %s is due", found, schema->name);
    if (schema->units > 0)
        RITZ_CHECK(ritz_h5_get_text(file, "units", RITZ_NAME_SIZE,
                                    (char *)object + schema->units));
    RITZ_CHECK(ritz_schema_move(&(ritz_place){
        .at = file, .schema = schema, .object = object, .target = object}));
    return ritz_h5_seen();
}

/* The functions of a kind of container: its pair, declared in the header. */
#define DEFINE_KIND(kind)                                                      \
    ritz_status ritz_container_read_##kind(const char *path, ritz_##kind *out) \
    {                                                                          \
        RITZ_OWN(ritz_##kind) object = {0};                                    \
                                                                               \
        RITZ_CHECK_IN(path,                                                    \
                      ritz_schema_read(path, &ritz_schema_##kind, &object));   \
        RITZ_MOVE(*out, object);                                               \
        return RITZ_OK;                                                        \
    }                                                                          \
                                                                               \
    ritz_status ritz_container_write_##kind(                                   \
        const char *path, const ritz_##kind *object, const ritz_stamp *stamp)  \
    {                                                                          \
        return ritz_context(                                                   \
            write_container(path, &ritz_schema_##kind, object, stamp), path);  \
    }

DEFINE_KIND(component)
DEFINE_KIND(basis)
DEFINE_KIND(reduced)
DEFINE_KIND(state_space)
DEFINE_KIND(system)
DEFINE_KIND(response)
DEFINE_KIND(simulation)
DEFINE_KIND(rankings)
DEFINE_KIND(recovered)

bool ritz_container_seems(const char *path)
{
    static const char mark[] = "\211HDF\r\n\032\n";
    char begins[sizeof mark - 1] = "";
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    const bool read_all =
        file >= 0 && pread(file, begins, sizeof begins, 0) == sizeof begins;

    if (file >= 0)
        close(file);
    return read_all && memcmp(begins, mark, sizeof begins) == 0;
}

ritz_status ritz_container_keep(const char *path)
{
    return ritz_context(ritz_h5_keep(path), path);
}

void ritz_container_release(void)
{
    ritz_h5_release();
}

/* Number of members of the group `KG`; 0 if there is no such group. */
static ritz_status count_loads(hid_t file, int64_t *out)
{
    H5G_info_t group = {0};

    if (!ritz_h5_has(file, "KG"))
        return RITZ_OK;
    RITZ_REFUSE_IF(H5Gget_info_by_name(file, "KG", &group, H5P_DEFAULT) < 0,
                   RITZ_ERR_FORMAT, "'KG' is no group");
    *out = (int64_t)group.nlinks;
    return RITZ_OK;
}

static ritz_status read_head(const char *path, ritz_summary *out)
{
    RITZ_OWN(hid_t) file = 0;
    RITZ_OWN(ritz_summary) summary = {0};
    RITZ_OWN(ritz_texts) command = {0}, inputs = {0};

    RITZ_CHECK(ritz_schema_open(path, summary.kind, &file));
    RITZ_CHECK(ritz_h5_get_text(file, "ritz_version", RITZ_NAME_SIZE,
                                summary.version));
    RITZ_CHECK(ritz_h5_get_text(file, "units", RITZ_NAME_SIZE, summary.units));
    if (H5Aexists(file, "interrupted") > 0)
        RITZ_CHECK(ritz_h5_get_text(file, "interrupted",
                                    sizeof summary.interrupted,
                                    summary.interrupted));
    RITZ_CHECK(ritz_h5_get_texts(file, "command", &command));
    RITZ_REFUSE_IF(command.count != 1, RITZ_ERR_FORMAT,
                   "'command' is not one text");
    RITZ_CHECK(ritz_h5_get_texts(file, "inputs", &inputs));
    RITZ_CHECK(count_loads(file, &summary.num_loads));
    RITZ_CHECK(ritz_h5_seen());
    RITZ_MOVE(summary.command, command.text[0]);
    summary.num_inputs = inputs.count;
    RITZ_MOVE(summary.input, inputs.text);
    RITZ_MOVE(*out, summary);
    return RITZ_OK;
}

ritz_status ritz_container_summary(const char *path, ritz_summary *out)
{
    return ritz_context(read_head(path, out), path);
}

void ritz_summary_free(ritz_summary *summary)
{
    free(summary->command);
    ritz_texts_free(&(ritz_texts){summary->num_inputs, summary->input});
    *summary = (ritz_summary){0};
}

/* Models of a scene, read from the containers that it names. A container is kept
   open from the question of what it holds until it is read. */

static ritz_status name_kind(void *, const char *name,
                             char kind[static RITZ_NAME_SIZE])
{
    RITZ_OWN(ritz_summary) summary = {0};

    RITZ_CHECK(ritz_container_keep(name));
    RITZ_CHECK(ritz_container_summary(name, &summary));
    memcpy(kind, summary.kind, RITZ_NAME_SIZE);
    return RITZ_OK;
}

static ritz_status read_component(void *, const char *name, ritz_component *out)
{
    const ritz_status status = ritz_container_read_component(name, out);

    ritz_container_release();
    return status;
}

static ritz_status read_reduced(void *, const char *name, ritz_reduced *out)
{
    const ritz_status status = ritz_container_read_reduced(name, out);

    ritz_container_release();
    return status;
}

const ritz_source ritz_container_source = {
    .kind = name_kind,
    .component = read_component,
    .reduced = read_reduced,
};
