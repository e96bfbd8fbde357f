/*
 * MAT 7.3: HDF5 after a head of 512 bytes. A full matrix is a data set with its
 * dimensions in reverse order, a complex one has pairs {real, imag}; a sparse
 * one is a group of data, ir, jc with its number of rows in the attribute
 * MATLAB_sparse; a struct is a group too. The attribute MATLAB_class says which
 * it is.
 *
 * Links to other objects are refused, and so are filters that are not part of
 * HDF5 and a second deflate filter: a file neither leads to other files nor
 * declares more than it can hold.
 */
#define _GNU_SOURCE /* NOLINT: declares memfd_create */

#include "formats/mat.h"

#include "base/alloc.h"
#include "container/h5.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum {
    BLOCK = 512, /* position of HDF5 */
    MOST_MEMBERS = 65536,
    PIECE = 65536, /* bytes by which an image would grow */
    /* declared size that a chunk may have beyond the file's */
    SPARE = 8 * PIECE,
};

/* A group whose members are still to be listed. */
typedef struct group {
    hid_t id;
    haddr_t at; /* of the file */
    int depth;
    char name[RITZ_NAME_SIZE];
} group;

/* Groups in the order in which they are met, structs behind their group. */
typedef struct hdf5_walk {
    ritz_mat_list *list;
    int64_t members;
    int64_t count, room;
    group *group;
} hdf5_walk;

static void hdf5_walk_free(hdf5_walk *w)
{
    for (int64_t k = 0; k < w->count; k++)
        ritz_h5_close(w->group[k].id);
    free(w->group);
}

bool ritz_mat_is_hdf5(const char *bytes, int64_t size)
{
    static const char mark[] = "\211HDF\r\n\032\n";

    return size > BLOCK + 8 && memcmp(bytes, "MATLAB", 6) == 0 &&
           memcmp(bytes + BLOCK, mark, 8) == 0;
}

/* Write bytes to a file without a name. */
static ritz_status store_bytes(int file, const char *bytes, int64_t size)
{
    for (ssize_t more = 0; size > 0; bytes += more, size -= more) {
        more = write(file, bytes, (size_t)size);
        RITZ_REFUSE_IF(more < 0 && errno != EINTR, RITZ_ERR_MEMORY,
                       "no memory for a copy of the file: %s", strerror(errno));
        more = more < 0 ? 0 : more;
    }
    return RITZ_OK;
}

/* The guard gets a copy of the bytes that were read; the path may name another
   file by now. */
ritz_status ritz_mat_admit_hdf5(const char *bytes, int64_t size)
{
    const int file = memfd_create("mat", MFD_CLOEXEC);
    ritz_status status = RITZ_OK;

    RITZ_REFUSE_IF(file < 0, RITZ_ERR_MEMORY,
                   "no memory for a copy of the file: %s", strerror(errno));
    status = store_bytes(file, bytes, size);
    if (status == RITZ_OK)
        status = ritz_h5_admit(file);
    close(file);
    return status;
}

/* The bytes as a file that is open. */
static ritz_status open_image(const char *bytes, int64_t size, hid_t *out)
{
    RITZ_OWN_ARRAY char *copy = NULL; /* HDF5 wants what it may write to */
    RITZ_OWN(hid_t) plan = 0;

    RITZ_CHECK(ritz_h5_begin());
    RITZ_CHECK_NEW(copy, size);
    memcpy(copy, bytes, (size_t)size);
    plan = H5Pcreate(H5P_FILE_ACCESS);
    RITZ_REFUSE_IF(H5Pset_fapl_core(plan, PIECE, false) < 0 ||
                       H5Pset_file_image(plan, copy, (size_t)size) < 0,
                   RITZ_ERR_MEMORY, "no memory for the file");
    *out = H5Fopen("image", H5F_ACC_RDONLY, plan);
    RITZ_REFUSE_IF(*out < 0, RITZ_ERR_FORMAT, "a damaged file of HDF5");
    return RITZ_OK;
}

/* Whether all filters are known and at most one inflates, which bounds their
 * output. `chunk`: number of values in a chunk, for all of which HDF5 allocates
 * memory; 0: no chunks. */
static bool is_plain(hid_t set, hsize_t *chunk)
{
    static const H5Z_filter_t known[] = {H5Z_FILTER_DEFLATE, H5Z_FILTER_SHUFFLE,
                                         H5Z_FILTER_FLETCHER32};
    RITZ_OWN(hid_t) plan = H5Dget_create_plist(set);
    bool plain = plan >= 0 && H5Pget_external_count(plan) == 0 &&
                 H5Pget_layout(plan) != H5D_VIRTUAL;
    int filters = plan < 0 ? 0 : H5Pget_nfilters(plan);
    int inflating = 0;
    ritz_h5_shape cut = {0};

    for (int k = 0; plain && k < filters; k++) {
        unsigned flags = 0;
        size_t none = 0;
        H5Z_filter_t is = H5Pget_filter2(plan, (unsigned)k, &flags, &none, NULL,
                                         0, NULL, NULL);

        inflating += is == H5Z_FILTER_DEFLATE;
        plain = inflating <= 1 &&
                (is == known[0] || is == known[1] || is == known[2]);
    }
    if (H5Pget_layout(plan) == H5D_CHUNKED)
        cut.rank = H5Pget_chunk(plan, RITZ_H5_RANK, cut.dims);
    *chunk = cut.rank > 0 && cut.rank <= RITZ_H5_RANK
                 ? ritz_h5_volume(&cut, INT64_MAX / 64)
                 : 0;
    return plain;
}

/* Its dimensions, once the storage bears them out. */
static ritz_status take_shape(hid_t set, const char *name, int64_t bytes,
                              ritz_h5_shape *out)
{
    RITZ_OWN(hid_t) space = H5Dget_space(set);
    RITZ_OWN(hid_t) type = H5Dget_type(set);
    const hsize_t size = type < 0 ? 0 : H5Tget_size(type);
    hsize_t most = 0; /* in bytes */
    hsize_t chunk = 0;

    out->rank = H5Sget_simple_extent_ndims(space);
    RITZ_REFUSE_IF(out->rank < 0 || size == 0, RITZ_ERR_FORMAT,
                   "'%s' has no size", name);
    if (out->rank > RITZ_H5_RANK)
        return RITZ_OK; /* refused by its rank */
    H5Sget_simple_extent_dims(space, out->dims, NULL);
    RITZ_REFUSE_IF(!is_plain(set, &chunk), RITZ_ERR_FORMAT,
                   "'%s' is stored in a way that is not known", name);
    RITZ_REFUSE_IF(H5Tget_size(type) == 0, RITZ_ERR_FORMAT,
                   "values of '%s' are of no size", name);
    most = H5Dget_storage_size(set);
    most = most < (hsize_t)bytes ? most : (hsize_t)bytes;
    most *= RITZ_MAT_MOST_RATIO;
    RITZ_REFUSE_IF(ritz_h5_volume(out, most / size) > most / size ||
                       chunk > (most + SPARE) / size,
                   RITZ_ERR_FORMAT, "'%s' declares more than the file holds",
                   name);
    return RITZ_OK;
}

/* Kind of the values: 'r' real, 'c' complex, 0 neither. */
static char kind_of(hid_t set)
{
    RITZ_OWN(hid_t) type = H5Dget_type(set);
    H5T_class_t class = H5Tget_class(type);

    if (class == H5T_INTEGER || class == H5T_FLOAT)
        return 'r';
    return class == H5T_COMPOUND && H5Tget_nmembers(type) == 2 &&
                   H5Tget_member_index(type, "real") >= 0 &&
                   H5Tget_member_index(type, "imag") >= 0
               ? 'c'
               : 0;
}

/* Numbers of a data set; `im` NULL if they are real. */
typedef struct numbers {
    int64_t count;
    double *re, *im;
} numbers;

static void numbers_free(numbers *list)
{
    RITZ_FREE(list->re, list->im);
}

/* @param[in] part  of a pair of doubles; NULL: of one double */
static ritz_status read_part(hid_t set, const char *name, const char *part,
                             int64_t count, double **out)
{
    RITZ_OWN(hid_t)
    type = part ? H5Tcreate(H5T_COMPOUND, sizeof(double))
                : H5Tcopy(H5T_NATIVE_DOUBLE);

    if (part)
        H5Tinsert(type, part, 0, H5T_NATIVE_DOUBLE);
    RITZ_CHECK_NEW(*out, count);
    RITZ_REFUSE_IF(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, *out) < 0,
                   RITZ_ERR_FORMAT, "'%s' is damaged", name);
    return RITZ_OK;
}

/* @param[in] bytes  size of the file */
static ritz_status read_numbers(hid_t set, const char *name, int64_t bytes,
                                int64_t count, numbers *out)
{
    bool real = kind_of(set) == 'r';

    RITZ_CHECK(ritz_mat_fits(bytes, name, count));
    out->count = count;
    RITZ_CHECK(read_part(set, name, real ? NULL : "real", count, &out->re));
    return real ? RITZ_OK : read_part(set, name, "imag", count, &out->im);
}

/* A data set of one dimension, of a sparse matrix; absent: no values. */
static ritz_status read_vector(hid_t at, const char *name, int64_t bytes,
                               numbers *out)
{
    RITZ_OWN(hid_t) set = 0;
    ritz_h5_shape shape = {0};

    if (!ritz_h5_has(at, name))
        return RITZ_OK;
    set = H5Dopen2(at, name, H5P_DEFAULT);
    RITZ_REFUSE_IF(set < 0 || !kind_of(set), RITZ_ERR_FORMAT,
                   "'%s' is no list of numbers", name);
    RITZ_CHECK(take_shape(set, name, bytes, &shape));
    RITZ_REFUSE_IF(shape.rank > RITZ_H5_RANK, RITZ_ERR_FORMAT,
                   "'%s' is no list of numbers", name);
    return read_numbers(set, name, bytes,
                        (int64_t)ritz_h5_volume(&shape, INT64_MAX), out);
}

/* Values as they stand in memory now. */
static ritz_mat_values values_of(const double *values, int64_t count)
{
    return (ritz_mat_values){(const unsigned char *)values, values ? count : 0,
                             RITZ_MAT_DOUBLE,
                             __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__};
}

/* One number of an attribute; -1 if it is not there. */
static double read_attribute(hid_t at, const char *name)
{
    double value = -1.0;
    RITZ_OWN(hid_t)
    id = H5Aexists(at, name) > 0 ? H5Aopen(at, name, H5P_DEFAULT) : -1;
    RITZ_OWN(hid_t) space = id < 0 ? -1 : H5Aget_space(id);

    if (space < 0 || H5Sget_simple_extent_npoints(space) != 1 ||
        H5Aread(id, H5T_NATIVE_DOUBLE, &value) < 0)
        return -1.0;
    return value;
}

static ritz_status add_sparse(hdf5_walk *w, hid_t at, const char *name)
{
    RITZ_OWN(numbers) row = {0}, start = {0}, value = {0};
    double nrow = read_attribute(at, "MATLAB_sparse");
    int64_t bytes = w->list->bytes;

    RITZ_CHECK_IN(name, ritz_h5_refuse_links(at));
    RITZ_CHECK_IN(name, read_vector(at, "ir", bytes, &row));
    RITZ_CHECK_IN(name, read_vector(at, "jc", bytes, &start));
    RITZ_CHECK_IN(name, read_vector(at, "data", bytes, &value));
    RITZ_REFUSE_IF(!(nrow >= 0.0 && nrow < 9e15) || start.count < 1 ||
                       row.count != value.count,
                   RITZ_ERR_FORMAT, "'%s' is no sparse matrix", name);
    return ritz_mat_add(
        w->list, name,
        &(ritz_mat_entries){.nrow = (int64_t)nrow,
                            .ncol = start.count - 1,
                            .count = row.count,
                            .row = values_of(row.re, row.count),
                            .col = values_of(start.re, start.count),
                            .re = values_of(value.re, value.count),
                            .im = values_of(value.im, value.count),
                            .starts = true});
}

/* Why a data set is no matrix, by its class and size; NULL if it is one. */
static const char *why_none(hid_t set, const ritz_h5_shape *shape)
{
    static const struct {
        const char *class, *why;
    } none[] = {{"char", "text"},
                {"cell", "a cell array"},
                {"struct", "an array of structs"},
                {"function_handle", "a function"}};
    char class[RITZ_NAME_SIZE] = "";

    if (H5Aexists(set, "MATLAB_class") > 0)
        (void)ritz_h5_get_text(set, "MATLAB_class", sizeof class, class);
    for (size_t k = 0; k < sizeof none / sizeof *none; k++)
        if (strcmp(class, none[k].class) == 0)
            return none[k].why;
    if (!kind_of(set))
        return "an object";
    if (read_attribute(set, "MATLAB_empty") > 0.0)
        return "empty";
    if (shape->rank != 2)
        return "not an array of two dimensions";
    if (shape->dims[0] == 0 || shape->dims[1] == 0)
        return "empty";
    return NULL;
}

static ritz_status add_set(hdf5_walk *w, hid_t set, const char *name)
{
    RITZ_OWN(numbers) value = {0};
    ritz_h5_shape shape = {0};
    const char *why = NULL;
    int64_t count = 0;

    RITZ_CHECK(take_shape(set, name, w->list->bytes, &shape));
    why = why_none(set, &shape);
    if (why || ritz_mat_passes(w->list))
        return ritz_mat_add_other(w->list, name, why);
    count = (int64_t)(shape.dims[0] * shape.dims[1]);
    RITZ_CHECK(read_numbers(set, name, w->list->bytes, count, &value));
    return ritz_mat_add(w->list, name,
                        &(ritz_mat_entries){.nrow = (int64_t)shape.dims[1],
                                            .ncol = (int64_t)shape.dims[0],
                                            .count = count,
                                            .re = values_of(value.re, count),
                                            .im = values_of(value.im, count)});
}

/* Remember a struct, whose object stays open. A struct that is a member of
   itself or of several structs is listed once; otherwise there would be no
   end. */
static ritz_status add_group(hdf5_walk *w, hid_t object, const char *whole,
                             int depth)
{
    H5O_info_t info = {0};
    group *g = NULL;

    RITZ_REFUSE_IF(H5Oget_info(object, &info) < 0, RITZ_ERR_FORMAT,
                   "'%s' is damaged", *whole ? whole : "/");
    for (int64_t k = 0; k < w->count; k++)
        if (w->group[k].at == info.addr)
            return ritz_mat_add_other(w->list, whole,
                                      "the same struct as under another name");
    RITZ_CHECK_ROOM(w->group, w->count, w->room);
    g = &w->group[w->count++];
    *g = (group){.id = object, .at = info.addr, .depth = depth};
    H5Iinc_ref(object);
    snprintf(g->name, sizeof g->name, "%.*s", (int)sizeof g->name - 1, whole);
    return RITZ_OK;
}

static ritz_status add_member(hdf5_walk *w, const group *in, const char *name)
{
    RITZ_OWN(hid_t) object = H5Oopen(in->id, name, H5P_DEFAULT);
    H5I_type_t kind = object < 0 ? H5I_BADID : H5Iget_type(object);
    char whole[2 * RITZ_NAME_SIZE];

    snprintf(whole, sizeof whole, "%s%s%s", in->name, *in->name ? "." : "",
             name);
    whole[RITZ_NAME_SIZE - 1] = '\0';
    RITZ_REFUSE_IF(kind != H5I_GROUP && kind != H5I_DATASET, RITZ_ERR_FORMAT,
                   "'%s' is damaged", whole);
    if (kind == H5I_DATASET)
        return add_set(w, object, whole);
    if (H5Aexists(object, "MATLAB_sparse") > 0)
        return add_sparse(w, object, whole);
    if (in->depth >= RITZ_MAT_DEPTH)
        return ritz_mat_add_other(w->list, whole,
                                  "a struct, too deep in others");
    return add_group(w, object, whole, in->depth + 1);
}

static ritz_status add_members(hdf5_walk *w, const group *in)
{
    RITZ_OWN_ARRAY char(*names)[RITZ_NAME_SIZE] = NULL;
    int64_t count = 0;

    RITZ_CHECK(ritz_h5_list(in->id, &count, &names));
    for (int64_t k = 0; k < count; k++) {
        if (names[k][0] == '#' || !ritz_h5_has(in->id, names[k]))
            continue; /* what MATLAB keeps for itself, and links */
        RITZ_REFUSE_IF(w->members++ >= MOST_MEMBERS, RITZ_ERR_FORMAT,
                       "holds more than %d members", (int)MOST_MEMBERS);
        RITZ_CHECK(add_member(w, in, names[k]));
    }
    return RITZ_OK;
}

ritz_status ritz_mat_read_hdf5(const char *bytes, int64_t size,
                               ritz_mat_list *list)
{
    RITZ_OWN(hid_t) file = 0;
    RITZ_OWN(hdf5_walk) w = {.list = list};

    RITZ_CHECK(open_image(bytes, size, &file));
    RITZ_CHECK(add_group(&w, file, "", 0));
    for (int64_t k = 0; k < w.count; k++) {
        group turn = w.group[k];

        RITZ_CHECK(add_members(&w, &turn));
    }
    return RITZ_OK;
}
