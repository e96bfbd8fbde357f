/*
 * ritz-walk - read a whole HDF5 file, as descriptor 3, in a process of its own,
 * so that a file that crashes or stalls HDF5 does no harm to the tool that
 * started this process (tools/cli/walk.h). The exit status is the only output.
 *
 * Files are read as the tools read them: through hard links, with the same
 * conversions of attributes and values, filters and storage layouts. What the
 * tools refuse is skipped: other links, external files, other filters, more
 * values than the file can hold. Errors that HDF5 reports are ignored, since
 * the tool will get the same ones.
 */
#define _GNU_SOURCE /* NOLINT: declares tdestroy */

#include "cli/walk.h"
#include "container/descriptor.h"

#include <hdf5.h>

#include <search.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { RANK = H5S_MAX_RANK, PIECE = 1 << 20, NAME = 64 };

/* State of the walk: groups that are still to be read, and all objects that
   were found so far. */
static struct {
    hsize_t bytes; /* of the file */
    haddr_t *group;
    size_t count, room;
    void *met;   /* addresses of these objects, a tree of tsearch */
    bool scanty; /* memory was not sufficient */
} course;

/* --- memory --------------------------------------------------------------- */

static void *take_memory(size_t size)
{
    void *block = malloc(size > 0 ? size : 1);

    course.scanty = course.scanty || !block;
    return block;
}

static herr_t look_for_memory(unsigned, const H5E_error2_t *error, void *)
{
    course.scanty = course.scanty || error->maj_num == H5E_RESOURCE;
    return 0;
}

/* Called by HDF5 for each error: notes whether memory was not sufficient. */
static herr_t note_error(hid_t stack, void *)
{
    return H5Ewalk2(stack, H5E_WALK_UPWARD, look_for_memory, NULL);
}

/* --- values --------------------------------------------------------------- */

/* The type in memory to which a tool would convert; -1 if none. */
static hid_t find_memory_type(hid_t on_file)
{
    hid_t type = -1;
    const char *part = "real";

    switch (H5Tget_class(on_file)) {
    case H5T_INTEGER:
    case H5T_FLOAT:
        return H5Tcopy(H5T_NATIVE_DOUBLE);
    case H5T_STRING:
        if (H5Tis_variable_str(on_file) != 0)
            return -1;
        type = H5Tcopy(on_file);
        if (H5Tget_size(type) < NAME)
            H5Tset_size(type, NAME);
        H5Tset_strpad(type, H5T_STR_NULLTERM);
        return type;
    case H5T_COMPOUND:
        if (H5Tget_member_index(on_file, part) < 0 ||
            H5Tget_member_index(on_file, "imag") < 0)
            return -1;
        type = H5Tcreate(H5T_COMPOUND, 2 * sizeof(double));
        H5Tinsert(type, part, 0, H5T_NATIVE_DOUBLE);
        H5Tinsert(type, "imag", sizeof(double), H5T_NATIVE_DOUBLE);
        return type;
    default:
        return -1;
    }
}

/* Number of values; @p most + 1 if there are more than @p most. */
static hsize_t count_values(int rank, const hsize_t *dims, hsize_t most)
{
    hsize_t count = 1;

    for (int k = 0; k < rank; k++)
        if (dims[k] == 0)
            return 0;
    for (int k = 0; k < rank; k++) {
        if (dims[k] > most / count)
            return most + 1;
        count *= dims[k];
    }
    return count;
}

static herr_t read_attribute(hid_t at, const char *name, const H5A_info_t *,
                             void *)
{
    const hid_t id = H5Aopen(at, name, H5P_DEFAULT);
    const hid_t space = H5Aget_space(id), on_file = H5Aget_type(id);
    const hid_t memory = find_memory_type(on_file);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    const size_t size = memory < 0 ? 0 : H5Tget_size(memory);
    void *values = NULL;

    /* no more values than the header of an object, or the heap of the file, can
       hold */
    if (size > 0 && count > 0 && H5Tget_size(on_file) > 0 &&
        (hsize_t)count <= course.bytes / H5Tget_size(on_file) + 1)
        values = take_memory((size_t)count * size);
    if (values && H5Aread(id, memory, values) >= 0 &&
        H5Tget_class(on_file) == H5T_INTEGER)
        H5Aread(id, H5T_NATIVE_INT64, values);
    free(values);
    H5Tclose(memory);
    H5Tclose(on_file);
    H5Sclose(space);
    H5Aclose(id);
    return 0;
}

/* --- data sets ------------------------------------------------------------ */

typedef struct data_set {
    hid_t id, plan, space, on_file, memory;
    int rank;
    hsize_t dims[RANK], piece[RANK]; /* part that is read at once */
    bool chunked;
} data_set;

/* Whether tools accept the storage layout and the filters. */
static bool is_accepted(const data_set *s)
{
    const H5D_layout_t layout = H5Pget_layout(s->plan);
    const int filters = H5Pget_nfilters(s->plan);
    bool accepted = (layout == H5D_COMPACT || layout == H5D_CONTIGUOUS ||
                     layout == H5D_CHUNKED) &&
                    H5Pget_external_count(s->plan) == 0;
    int inflating = 0;

    for (int k = 0; k < filters && accepted; k++) {
        unsigned flags = 0;
        size_t none = 0;
        const H5Z_filter_t is = H5Pget_filter2(s->plan, (unsigned)k, &flags,
                                               &none, NULL, 0, NULL, NULL);

        inflating += is == H5Z_FILTER_DEFLATE;
        accepted = inflating <= 1 &&
                   (is == H5Z_FILTER_DEFLATE || is == H5Z_FILTER_SHUFFLE ||
                    is == H5Z_FILTER_FLETCHER32);
    }
    return accepted;
}

/* Whether the file is large enough for the declared values, and for those of a
   chunk, at the highest compression ratio of deflate. */
static bool is_borne_out(data_set *s)
{
    const hsize_t size = H5Tget_size(s->on_file);
    hsize_t most = H5Dget_storage_size(s->id);

    most =
        (most < course.bytes ? most : course.bytes) * WALK_RATIO + WALK_SPARE;
    s->chunked = H5Pget_layout(s->plan) == H5D_CHUNKED;
    if (s->chunked && H5Pget_chunk(s->plan, s->rank, s->piece) != s->rank)
        return false;
    return size > 0 &&
           count_values(s->rank, s->dims, most / size) <= most / size &&
           (!s->chunked ||
            count_values(s->rank, s->piece, most / size) <= most / size);
}

/* Look up the first and the last chunk, which searches the whole index. */
static void look_up_chunks(const data_set *s)
{
    hsize_t first[RANK] = {0}, last[RANK] = {0};
    unsigned skipped = 0;
    haddr_t place = HADDR_UNDEF;
    hsize_t size = 0;

    for (int k = 0; k < s->rank; k++)
        last[k] = (s->dims[k] - 1) / s->piece[k] * s->piece[k];
    H5Dget_chunk_info_by_coord(s->id, first, &skipped, &place, &size);
    H5Dget_chunk_info_by_coord(s->id, last, &skipped, &place, &size);
}

/* Pieces of whole chunks; each takes up to a megabyte of memory, or is one
   chunk. */
static hsize_t choose_piece(data_set *s)
{
    const hsize_t size = H5Tget_size(s->memory);
    hsize_t count = 1;

    for (int k = 0; k < s->rank && !s->chunked; k++)
        s->piece[k] = 1;
    for (int k = 0; k < s->rank; k++)
        count *= s->piece[k];
    for (int k = s->rank - 1; k >= 0; k--)
        while (s->piece[k] < s->dims[k] && 2 * count * size <= PIECE) {
            s->piece[k] *= 2;
            count *= 2;
        }
    return count;
}

/* Read the piece that begins at @p start; false where HDF5 reports an error. */
static bool read_piece(const data_set *s, const hsize_t *start, hid_t type,
                       void *values)
{
    hsize_t count[RANK];
    hid_t memory = -1;
    bool read = false;

    for (int k = 0; k < s->rank; k++)
        count[k] = s->piece[k] < s->dims[k] - start[k] ? s->piece[k]
                                                       : s->dims[k] - start[k];
    if (s->rank > 0)
        H5Sselect_hyperslab(s->space, H5S_SELECT_SET, start, NULL, count, NULL);
    memory = s->rank > 0 ? H5Screate_simple(s->rank, count, NULL)
                         : H5Screate(H5S_SCALAR);
    read = H5Dread(s->id, type, memory, s->space, H5P_DEFAULT, values) >= 0;
    H5Sclose(memory);
    return read;
}

/* Advance to the next piece, last dimension first; false after the last
   piece. */
static bool advance_piece(const data_set *s, hsize_t *start)
{
    for (int k = s->rank - 1; k >= 0; k--) {
        start[k] += s->piece[k];
        if (start[k] < s->dims[k])
            return true;
        start[k] = 0;
    }
    return false;
}

static void read_pieces(data_set *s)
{
    const hsize_t count = choose_piece(s);
    hsize_t start[RANK] = {0};
    void *values = take_memory(count * H5Tget_size(s->memory));

    if (values && H5Tget_class(s->on_file) == H5T_INTEGER)
        read_piece(s, start, H5T_NATIVE_INT64, values);
    while (values && read_piece(s, start, s->memory, values) &&
           advance_piece(s, start))
        ;
    free(values);
}

static void read_set(hid_t id)
{
    data_set s = {.id = id,
                  .plan = H5Dget_create_plist(id),
                  .space = H5Dget_space(id),
                  .on_file = H5Dget_type(id)};

    s.memory = find_memory_type(s.on_file);
    s.rank = H5Sget_simple_extent_ndims(s.space);
    if (s.memory >= 0 && s.rank >= 0 && s.rank <= RANK &&
        H5Sget_simple_extent_dims(s.space, s.dims, NULL) >= 0 &&
        count_values(s.rank, s.dims, 1) > 0 && is_accepted(&s) &&
        is_borne_out(&s)) {
        if (s.chunked)
            look_up_chunks(&s);
        read_pieces(&s);
    }
    H5Tclose(s.memory);
    H5Tclose(s.on_file);
    H5Sclose(s.space);
    H5Pclose(s.plan);
}

/* --- objects -------------------------------------------------------------- */

static int compare_addresses(const void *a, const void *b)
{
    const haddr_t x = *(const haddr_t *)a, y = *(const haddr_t *)b;

    return (x > y) - (x < y);
}

/* Whether this object is found for the first time. */
static bool is_new(haddr_t at)
{
    haddr_t *key = take_memory(sizeof *key);
    haddr_t **found = NULL;

    if (!key)
        return false;
    *key = at;
    found = tsearch(key, &course.met, compare_addresses);
    course.scanty = course.scanty || !found;
    if (found && *found == key)
        return true;
    free(key);
    return false;
}

static void push_group(haddr_t at)
{
    const size_t room = course.room > 0 ? 2 * course.room : 64;
    haddr_t *group = NULL;

    if (course.count == course.room) {
        group = realloc(course.group, room * sizeof *group);
        course.scanty = course.scanty || !group;
        if (!group)
            return;
        course.group = group;
        course.room = room;
    }
    course.group[course.count++] = at;
}

static void meet_object(hid_t id)
{
    H5O_info_t info = {0};
    const H5I_type_t kind = H5Iget_type(id);

    if (id < 0 || H5Oget_info(id, &info) < 0 || !is_new(info.addr))
        return;
    H5Aiterate2(id, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, read_attribute, NULL);
    if (kind == H5I_DATASET)
        read_set(id);
    if (kind == H5I_GROUP)
        push_group(info.addr);
}

static herr_t meet_link(hid_t in, const char *name, const H5L_info_t *info,
                        void *)
{
    H5L_info_t again = {0};
    hid_t id = -1;

    if (info->type != H5L_TYPE_HARD || H5Lexists(in, name, H5P_DEFAULT) <= 0 ||
        H5Lget_info(in, name, &again, H5P_DEFAULT) < 0 ||
        again.type != H5L_TYPE_HARD)
        return 0;
    id = H5Oopen(in, name, H5P_DEFAULT);
    meet_object(id);
    H5Oclose(id);
    return 0;
}

static void walk_group(hid_t file, haddr_t at)
{
    const hid_t group = H5Oopen_by_addr(file, at);
    H5G_info_t info = {0};

    H5Gget_info(group, &info);
    H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, meet_link, NULL);
    H5Oclose(group);
}

static int walk_file_of_tool(void)
{
    hid_t file = -1, root = -1;

    if (H5dont_atexit() < 0 || H5open() < 0)
        return WALK_MEMORY;
    H5Eset_auto2(H5E_DEFAULT, note_error, NULL);
    H5PLset_loading_state(0); /* no plugins: filters of third parties are not
                                 loaded */
    file = ritz_descriptor_open(WALK_FILE);
    if (file < 0)
        return course.scanty ? WALK_MEMORY : WALK_UNOPENED;
    H5Fget_filesize(file, &course.bytes);
    root = H5Gopen2(file, "/", H5P_DEFAULT);
    meet_object(root);
    H5Gclose(root);
    while (course.count > 0 && !course.scanty)
        walk_group(file, course.group[--course.count]);
    H5Fclose(file);
    H5close();
    tdestroy(course.met, free);
    free(course.group);
    return course.scanty ? WALK_MEMORY : WALK_WHOLE;
}

int main(void)
{
    return walk_file_of_tool();
}
