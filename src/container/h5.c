/* HDF5 files, groups and attributes. */
#include "container/h5.h"

#include "base/alloc.h"
#include "base/draft.h"
#include "base/text.h"
#include "container/descriptor.h"

#include <ritz/container.h>

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MANY_ATTRIBUTES = 64 }; /* that an object header holds */

/*
 * Whether an object of the file that is being written could not be closed, so
 * that some of it is lost. RITZ_OWN closes objects without returning a status;
 * ritz_h5_finish() reports this.
 */
static _Thread_local bool lost;

/* The first name since a file was opened that was treated as absent although it
   is a link or could not be looked up. */
static _Thread_local char unseen[RITZ_NAME_SIZE];

/*
 * A file that could not be closed, as where the disk is full, stays open inside
 * HDF5, which would try again on exit and crash. All others are closed by us.
 */
ritz_status ritz_h5_begin(void)
{
    (void)H5dont_atexit();
    RITZ_REFUSE_IF(H5open() < 0 || H5Eset_auto2(H5E_DEFAULT, NULL, NULL) < 0,
                   RITZ_ERR_MEMORY, "no memory to start HDF5");
    return RITZ_OK;
}

/* --- files that are read -------------------------------------------------- */

static _Atomic(ritz_guard) asked;

/* Bytes of memory for values read since the file was opened. */
static _Thread_local hsize_t taken;

/* The file that ritz_container_keep holds open. */
static _Thread_local struct {
    char *path;
    hid_t file;
} kept;

void ritz_container_guard(ritz_guard guard)
{
    atomic_store(&asked, guard);
}

ritz_status ritz_h5_admit(int file)
{
    const ritz_guard guard = atomic_load(&asked);

    return guard ? guard(file) : RITZ_OK;
}

/* Have the guard examine an open file, and open the same file by its
   descriptor. */
static ritz_status open_admitted(int file, hid_t *out)
{
    struct stat there = {0};

    RITZ_REFUSE_IF(fstat(file, &there) != 0, RITZ_ERR_FILE, "%s",
                   strerror(errno));
    RITZ_REFUSE_IF(!S_ISREG(there.st_mode), RITZ_ERR_FILE,
                   "not a regular file");
    RITZ_CHECK(ritz_h5_admit(file));
    *out = ritz_descriptor_open(file);
    RITZ_REFUSE_IF(*out < 0, RITZ_ERR_FORMAT, "not an HDF5 file, or damaged");
    return RITZ_OK;
}

ritz_status ritz_h5_open(const char *path, hid_t *out)
{
    ritz_status status = RITZ_OK;
    int file = -1;

    RITZ_CHECK(ritz_h5_begin());
    unseen[0] = '\0';
    taken = 0;
    if (kept.path && strcmp(kept.path, path) == 0) {
        RITZ_REFUSE_IF(H5Iinc_ref(kept.file) < 0, RITZ_ERR_FILE,
                       "cannot be opened again");
        *out = kept.file;
        return RITZ_OK;
    }
    /* O_NONBLOCK: a pipe must not block, since it is refused below */
    file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    RITZ_REFUSE_IF(file < 0, RITZ_ERR_FILE, "%s", strerror(errno));
    status = open_admitted(file, out);
    close(file);
    RITZ_CHECK(status);
    return ritz_draft_protect(path);
}

/* The limit allows eight bytes of memory for each byte of the file, since a
   stored byte may become a double. A name takes 64 bytes, but names are few. */
ritz_status ritz_h5_take(hid_t at, const char *name, hsize_t bytes, bool read)
{
    enum { WIDEST = 8, MEBI = 1 << 20, SPARE = 64 };
    RITZ_OWN(hid_t) file = H5Iget_file_id(at);
    hsize_t present = 0, most = 0;

    H5Fget_filesize(file, &present);
    most = WIDEST * present + (hsize_t)SPARE * MEBI;
    RITZ_REFUSE_IF(bytes > most || taken > most - bytes, RITZ_ERR_FORMAT,
                   "'%s' takes %" PRIuHSIZE " MiB of memory, in all more than "
                   "a file of %" PRIuHSIZE " bytes may",
                   name, bytes / MEBI, present);
    taken += read ? bytes : 0;
    return RITZ_OK;
}

ritz_status ritz_h5_keep(const char *path)
{
    RITZ_OWN(hid_t) file = 0;
    RITZ_OWN_ARRAY char *copy = NULL;

    ritz_h5_release();
    RITZ_CHECK(ritz_h5_open(path, &file));
    RITZ_CHECK_COPY(copy, path, (int64_t)strlen(path) + 1);
    RITZ_MOVE(kept.path, copy);
    RITZ_MOVE(kept.file, file);
    return RITZ_OK;
}

void ritz_h5_release(void)
{
    if (kept.file > 0)
        ritz_h5_close(kept.file);
    free(kept.path);
    memset(&kept, 0, sizeof kept);
}

/* --- files that are written, groups --------------------------------------- */

/* If an object has more than 8 attributes, HDF5 moves some to a heap, which has
   no checksum of its own, so the limit is raised. */
static hid_t plan_object(hid_t kind)
{
    hid_t plan = H5Pcreate(kind);

    if (H5Pset_obj_track_times(plan, false) >= 0 &&
        H5Pset_attr_phase_change(plan, MANY_ATTRIBUTES, 0) >= 0)
        return plan;
    ritz_h5_close(plan); /* with only some of the properties set, files would
                            differ */
    return -1;
}

ritz_status ritz_h5_create(const char *path, hid_t *out)
{
    RITZ_OWN(hid_t) plan = 0, bounds = 0;

    RITZ_CHECK(ritz_h5_begin());
    plan = plan_object(H5P_FILE_CREATE);
    bounds = H5Pcreate(H5P_FILE_ACCESS);
    RITZ_REFUSE_IF(
        H5Pset_libver_bounds(bounds, H5F_LIBVER_V18, H5F_LIBVER_V110) < 0,
        RITZ_ERR_MEMORY, "no memory to create '%s'", path);
    /* the writer has locked its draft already, and on NFS the lock that HDF5
       takes would conflict with that one */
    H5Pset_file_locking(bounds, false, true);
    *out = H5Fcreate(path, H5F_ACC_TRUNC, plan, bounds);
    RITZ_REFUSE_IF(*out < 0, RITZ_ERR_FILE, "cannot create '%s'", path);
    lost = false;
    return RITZ_OK;
}

ritz_status ritz_h5_finish(hid_t *file)
{
    bool whole = H5Fflush(*file, H5F_SCOPE_GLOBAL) >= 0 && !lost;

    whole = H5Fclose(*file) >= 0 && whole;
    *file = 0;
    RITZ_REFUSE_IF(!whole, RITZ_ERR_FILE,
                   "cannot be written to its end, is the disk full?");
    return RITZ_OK;
}

ritz_status ritz_h5_group(hid_t at, const char *name, hid_t *out)
{
    RITZ_OWN(hid_t) plan = plan_object(H5P_GROUP_CREATE);

    *out = H5Gcreate2(at, name, H5P_DEFAULT, plan, H5P_DEFAULT);
    RITZ_REFUSE_IF(*out < 0, RITZ_ERR_FILE, "cannot create group '%s'", name);
    return RITZ_OK;
}

static void note_unseen(const char *name)
{
    if (!*unseen)
        snprintf(unseen, sizeof unseen, "%s", name);
}

bool ritz_h5_has(hid_t at, const char *name)
{
    H5L_info_t info = {0};
    const htri_t there = H5Lexists(at, name, H5P_DEFAULT);
    const bool hard = there > 0 &&
                      H5Lget_info(at, name, &info, H5P_DEFAULT) >= 0 &&
                      info.type == H5L_TYPE_HARD;

    if (there != 0 && !hard)
        note_unseen(name);
    return hard;
}

bool ritz_h5_has_attribute(hid_t at, const char *name)
{
    const htri_t there = H5Aexists(at, name);

    if (there < 0)
        note_unseen(name);
    return there > 0;
}

ritz_status ritz_h5_seen(void)
{
    RITZ_REFUSE_IF(*unseen, RITZ_ERR_FORMAT,
                   "'%s' is a link to elsewhere, or cannot be looked up",
                   unseen);
    return RITZ_OK;
}

/* Stop at the first link to elsewhere, and write the start of its name to @p
   data. */
static herr_t find_link(hid_t, const char *name, const H5L_info_t *info,
                        void *data)
{
    if (info->type != H5L_TYPE_HARD)
        (void)ritz_text_short(name, data);
    return info->type != H5L_TYPE_HARD;
}

ritz_status ritz_h5_refuse_links(hid_t group)
{
    char name[RITZ_SHORT_SIZE] = "";
    herr_t result =
        H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, find_link, name);

    RITZ_REFUSE_IF(result < 0, RITZ_ERR_FORMAT, "list of members is damaged");
    RITZ_REFUSE_IF(result > 0, RITZ_ERR_FORMAT, "'%s' is a link to elsewhere",
                   name);
    return RITZ_OK;
}

ritz_status ritz_h5_enter(hid_t at, const char *name, hid_t *out)
{
    RITZ_OWN(hid_t) group = 0;

    if (ritz_h5_has(at, name))
        group = H5Gopen2(at, name, H5P_DEFAULT);
    RITZ_REFUSE_IF(group <= 0, RITZ_ERR_FORMAT,
                   "no group '%s', or it is damaged", name);
    RITZ_CHECK_IN(name, ritz_h5_refuse_links(group));
    RITZ_MOVE(*out, group);
    return RITZ_OK;
}

/* Names of the links of a group, collected while HDF5 iterates. */
typedef struct listing {
    ritz_status status; /* of the link at which the iteration stopped */
    int64_t count, room;
    char (*name)[RITZ_NAME_SIZE];
} listing;

static void listing_free(listing *list)
{
    free(list->name);
}

static ritz_status append_name(listing *list, const char *name)
{
    RITZ_CHECK_ROOM(list->name, list->count, list->room);
    RITZ_REFUSE_IF(ritz_name_copy(name, list->name[list->count]) != RITZ_OK,
                   RITZ_ERR_FORMAT, "a member has no proper name");
    list->count++;
    return RITZ_OK;
}

static herr_t take_link(hid_t, const char *name, const H5L_info_t *, void *data)
{
    listing *list = data;

    list->status = append_name(list, name);
    return list->status == RITZ_OK ? 0 : -1;
}

/* Attribute `index` of a member; *out is unchanged if it has none. */
static ritz_status read_index(hid_t group, const char *name, int64_t *out)
{
    RITZ_OWN(hid_t) member = 0;

    RITZ_REFUSE_IF(!ritz_h5_has(group, name), RITZ_ERR_FORMAT,
                   "'%s' is a link to elsewhere", name);
    member = H5Oopen(group, name, H5P_DEFAULT);
    RITZ_REFUSE_IF(member < 0, RITZ_ERR_FORMAT, "'%s' is damaged", name);
    if (ritz_h5_has_attribute(member, "index"))
        RITZ_CHECK_IN(name,
                      ritz_h5_get(member, "index", H5T_STD_I64LE, 1, out));
    return RITZ_OK;
}

ritz_status ritz_h5_list(hid_t group, int64_t *count,
                         char (**out)[RITZ_NAME_SIZE])
{
    RITZ_OWN(listing) list = {0};
    RITZ_OWN_ARRAY char(*sorted)[RITZ_NAME_SIZE] = NULL;
    int64_t indexed = 0;
    herr_t result =
        H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, take_link, &list);

    RITZ_CHECK(list.status);
    RITZ_REFUSE_IF(result < 0, RITZ_ERR_FORMAT, "list of members is damaged");
    RITZ_CHECK_NEW(sorted, list.count);
    for (int64_t k = 0; k < list.count; k++) {
        int64_t at = -1;

        RITZ_CHECK(read_index(group, list.name[k], &at));
        if (at == -1)
            continue;
        RITZ_REFUSE_IF(at < 0 || at >= list.count || sorted[at][0],
                       RITZ_ERR_FORMAT,
                       "index %" PRId64 " of '%s' is taken, or out of range",
                       at, list.name[k]);
        memcpy(sorted[at], list.name[k], RITZ_NAME_SIZE);
        indexed++;
    }
    RITZ_REFUSE_IF(indexed != 0 && indexed != list.count, RITZ_ERR_FORMAT,
                   "some members have an 'index', some do not");
    *count = list.count;
    if (indexed || list.count == 0)
        RITZ_MOVE(*out, sorted);
    else
        RITZ_MOVE(*out, list.name);
    return RITZ_OK;
}

hid_t ritz_h5_string(size_t size)
{
    hid_t type = H5Tcopy(H5T_C_S1);

    if (H5Tset_size(type, size) >= 0 && H5Tset_cset(type, H5T_CSET_UTF8) >= 0)
        return type;
    ritz_h5_close(type);
    return -1;
}

/*
 * H5Dclose, H5Gclose and H5Aclose free the id even if they fail; H5Idec_ref
 * would keep an id of freed memory.
 */
static herr_t close_object(hid_t id)
{
    switch (H5Iget_type(id)) {
    case H5I_DATASET:
        return H5Dclose(id);
    case H5I_GROUP:
        return H5Gclose(id);
    case H5I_ATTR:
        return H5Aclose(id);
    default:
        return H5Idec_ref(id);
    }
}

void ritz_h5_close(hid_t id)
{
    if (id > 0 && close_object(id) < 0)
        lost = true;
}

ritz_status ritz_h5_match(const char *name, hid_t on_file, hid_t type,
                          hid_t *memory)
{
    H5T_class_t kind = H5Tget_class(type);

    RITZ_REFUSE_IF(H5Tget_class(on_file) != kind, RITZ_ERR_FORMAT,
                   "'%s' holds values of another type", name);
    if (kind != H5T_STRING) {
        RITZ_REFUSE_IF(H5Tget_size(on_file) > H5Tget_size(type),
                       RITZ_ERR_FORMAT,
                       "'%s' holds values of more than %zu bytes", name,
                       H5Tget_size(type));
        *memory = H5Tget_native_type(type, H5T_DIR_ASCEND);
        return RITZ_OK;
    }
    RITZ_REFUSE_IF(H5Tis_variable_str(on_file) != 0 ||
                       H5Tget_size(on_file) > H5Tget_size(type),
                   RITZ_ERR_FORMAT, "'%s' is not text of fixed length, or long",
                   name);
    *memory = H5Tcopy(on_file); /* its character set is not converted */
    RITZ_REFUSE_IF(H5Tset_size(*memory, H5Tget_size(type)) < 0 ||
                       H5Tset_strpad(*memory, H5Tget_strpad(type)) < 0,
                   RITZ_ERR_MEMORY, "no memory for '%s'", name);
    return RITZ_OK;
}

ritz_status ritz_h5_set(hid_t at, const char *name, hid_t type,
                        ritz_h5_shape shape, const void *values)
{
    RITZ_OWN(hid_t) memory = H5Tget_native_type(type, H5T_DIR_ASCEND);
    RITZ_OWN(hid_t)
    space = H5Screate_simple(shape.rank, shape.dims, NULL);
    RITZ_OWN(hid_t)
    attribute = H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT);

    RITZ_REFUSE_IF(attribute < 0 || H5Awrite(attribute, memory, values) < 0,
                   RITZ_ERR_FILE, "cannot write attribute '%s'", name);
    return RITZ_OK;
}

ritz_status ritz_h5_get(hid_t at, const char *name, hid_t type, int64_t count,
                        void *values)
{
    RITZ_OWN(hid_t) attribute = H5Aopen(at, name, H5P_DEFAULT);
    RITZ_OWN(hid_t) space = 0, on_file = 0, memory = 0;

    if (attribute >= 0) {
        space = H5Aget_space(attribute);
        on_file = H5Aget_type(attribute);
    }
    RITZ_REFUSE_IF(space <= 0 || on_file <= 0, RITZ_ERR_FORMAT,
                   "no attribute '%s'", name);
    RITZ_REFUSE_IF(H5Sget_simple_extent_npoints(space) != count,
                   RITZ_ERR_FORMAT,
                   "attribute '%s' is not of %" PRId64 " values", name, count);
    RITZ_CHECK(ritz_h5_match(name, on_file, type, &memory));
    RITZ_REFUSE_IF(H5Aread(attribute, memory, values) < 0, RITZ_ERR_FORMAT,
                   "cannot read attribute '%s'", name);
    return RITZ_OK;
}

ritz_h5_shape ritz_h5_scalar(void)
{
    return (ritz_h5_shape){0, {1}};
}

ritz_status ritz_h5_set_text(hid_t at, const char *name, const char *text)
{
    RITZ_OWN(hid_t) type = ritz_h5_string(strlen(text) + 1);

    return ritz_h5_set(at, name, type, ritz_h5_scalar(), text);
}

ritz_status ritz_h5_get_text(hid_t at, const char *name, size_t size, char *out)
{
    RITZ_OWN(hid_t) type = ritz_h5_string(size);

    return ritz_h5_get(at, name, type, 1, out);
}

hsize_t ritz_h5_volume(const ritz_h5_shape *shape, hsize_t most)
{
    hsize_t count = 1;

    for (int k = 0; k < shape->rank; k++)
        if (shape->dims[k] == 0)
            return 0;
    for (int k = 0; k < shape->rank; k++) {
        if (shape->dims[k] > most / count)
            return most + 1;
        count *= shape->dims[k];
    }
    return count;
}

/* --- checksums, as the head of h5_sets.c defines them --------------------- */

uint64_t ritz_h5_sum(int64_t bytes, const void *values, uint64_t sum)
{
    const unsigned char *at = values;
    uint64_t h = sum;

    for (int64_t k = 0; k < bytes; k += 8) {
        uint64_t w = 0;

        if (bytes - k >= 8) /* a constant size: compilers make it one load */
            memcpy(&w, at + k, 8);
        else
            memcpy(&w, at + k, (size_t)(bytes - k));
        h = ritz_h5_sum_word(h, w);
    }
    return h;
}

int64_t ritz_h5_sum_end(uint64_t sum)
{
    return (int64_t)(sum >> 1); /* a positive number for every reader */
}
