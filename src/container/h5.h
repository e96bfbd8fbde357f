/*
 * HDF5 in the few forms that containers use.
 *
 * Files are written with bounds v1.8 to v1.10 and without times, so that two
 * identical runs give identical bytes. Every value lies under a checksum: data
 * sets of more than 64 values are chunked with Fletcher-32, smaller ones and
 * attributes lie in object headers, which HDF5 itself checks. Strings are of
 * fixed length, for the heap that holds others has no checksum. The index of
 * chunks has none either, and one that sends the reader to zeros would be
 * believed, since their Fletcher-32 is 0: hence each chunked set has an
 * attribute `checksum` of all its values.
 *
 * `type` is the type on file, H5T_IEEE_F64LE, H5T_STD_I64LE or a string; values
 * in memory are of the native one. An id of 0 is nothing, as a failed one is.
 * A `name` is one link of `at`, never a path, and only hard links are followed:
 * a file cannot send its reader into other files.
 */
#ifndef RITZ_CONTAINER_H5_H
#define RITZ_CONTAINER_H5_H

#include <ritz/sparse.h>
#include <ritz/text.h>

#include <hdf5.h>
#include <stdbool.h>

enum {
    RITZ_H5_RANK = 3,     /* most dimensions that anything has */
    RITZ_H5_LONG = 16384, /* bytes of text that no longer are an attribute:
                             HDF5 moves one of 64 KiB to a heap that has no
                             checksum */
};

/* Sizes, the last running fastest; of rank 0 a single value. */
typedef struct ritz_h5_shape {
    int rank;
    hsize_t dims[RITZ_H5_RANK];
} ritz_h5_shape;

ritz_h5_shape ritz_h5_scalar(void);
ritz_h5_shape ritz_h5_vector(int64_t n);
ritz_h5_shape ritz_h5_table(int64_t n, int64_t m);
ritz_h5_shape ritz_h5_stack(int64_t n, int64_t m, int64_t k);

/** Number of values, @p most + 1 if it is larger. */
hsize_t ritz_h5_volume(const ritz_h5_shape *shape, hsize_t most);

/** Before HDF5 is first used: its messages are silenced, and its exit. */
void ritz_h5_begin(void);

/** Open to read. HDF5's own messages are silenced from here on. */
ritz_status ritz_h5_open(const char *path, hid_t *out);

/** Start a file over, to write. The same holds. */
ritz_status ritz_h5_create(const char *path, hid_t *out);

/** Create a group. */
ritz_status ritz_h5_group(hid_t at, const char *name, hid_t *out);

/** Open a group to read. */
ritz_status ritz_h5_enter(hid_t at, const char *name, hid_t *out);

/** Whether there is a group or data set of that name. */
bool ritz_h5_has(hid_t at, const char *name);

/**
 * Names of all members of a group: in the order of their attributes `index`,
 * which are 0, 1, 2, ..., or by name if none has one.
 *
 * @return RITZ_ERR_FORMAT if one cannot be a name, or an index is amiss
 */
ritz_status ritz_h5_list(hid_t group, int64_t *count,
                         char (**out)[RITZ_NAME_SIZE]);

/** Type of strings that take @p size bytes with their NUL. */
hid_t ritz_h5_string(size_t size);

/** Close what these functions opened, or nothing. */
void ritz_h5_close(hid_t id);

/** Attributes. To read, the number of values must agree, not the shape. */
ritz_status ritz_h5_set(hid_t at, const char *name, hid_t type,
                        ritz_h5_shape shape, const void *values);
ritz_status ritz_h5_get(hid_t at, const char *name, hid_t type, int64_t count,
                        void *values);

/** Text as an attribute, of at most @p size bytes with its NUL to read. */
ritz_status ritz_h5_set_text(hid_t at, const char *name, const char *text);
ritz_status ritz_h5_get_text(hid_t at, const char *name, size_t size,
                             char *out);

/**
 * Texts of any length and number: an attribute, or a data set `long_NAME` if
 * they would not fit an object header. Each text read is the caller's to free, and the list.
 */
ritz_status ritz_h5_set_texts(hid_t at, const char *name, int64_t count,
                              char *const *text);
ritz_status ritz_h5_get_texts(hid_t at, const char *name, int64_t *count,
                              char ***out);
void ritz_h5_free_texts(int64_t count, char **text);

/** Type in memory for values of @p type that the file holds as @p on_file. */
ritz_status ritz_h5_match(const char *name, hid_t on_file, hid_t type,
                          hid_t *memory);

/** Data sets: shape, once it is borne out, and values. */
ritz_status ritz_h5_shape_of(hid_t at, const char *name, int rank,
                             ritz_h5_shape *out);
ritz_status ritz_h5_count(hid_t at, const char *name, int64_t *out);
ritz_status ritz_h5_write(hid_t at, const char *name, hid_t type,
                          ritz_h5_shape shape, const void *values);
ritz_status ritz_h5_read(hid_t at, const char *name, hid_t type,
                         ritz_h5_shape shape, void *values);

/** Open a data set of @p rank to read, once its shape is borne out. */
ritz_status ritz_h5_open_set(hid_t at, const char *name, int rank,
                             ritz_h5_shape *shape, hid_t *out);

/** Create a data set; @p chunk is its pieces' shape, all of it if unchunked. */
ritz_status ritz_h5_create_set(hid_t at, const char *name, hid_t type,
                               ritz_h5_shape shape, ritz_h5_shape *chunk,
                               hid_t *out);

/** Give a chunked data set the checksum of its values, or hold them to it. */
ritz_status ritz_h5_seal(hid_t set, const char *name, int64_t bytes,
                         const void *values);
ritz_status ritz_h5_verify(hid_t set, const char *name, int64_t bytes,
                           const void *values);

/** Shape of the pieces in which a data set is best read. */
ritz_h5_shape ritz_h5_pieces(hid_t set, const ritz_h5_shape *shape);

/** The same of finite numbers; @p nan_allowed: NaN stands for none. */
ritz_status ritz_h5_read_real(hid_t at, const char *name, ritz_h5_shape shape,
                              bool nan_allowed, double *values);

/** A dense matrix, which h5py shows as shape (nrow, ncol). */
ritz_status ritz_h5_write_dense(hid_t at, const char *name,
                                const ritz_dense *A);

/** The same back, all finite; an expected size of -1 is any. */
ritz_status ritz_h5_read_dense(hid_t at, const char *name, int64_t nrow,
                               int64_t ncol, ritz_dense *out);

/** A group for scipy.sparse.csc_matrix((data, indices, indptr), shape). */
ritz_status ritz_h5_write_sparse(hid_t at, const char *name,
                                 const ritz_sparse *A);
ritz_status ritz_h5_read_sparse(hid_t at, const char *name, ritz_sparse *out);

#endif
