/*
 * HDF5 in the few forms that containers use.
 *
 * Files are written with bounds v1.8 to v1.10 and without times, so that two
 * identical runs give identical bytes. All values are protected by checksums:
 * data sets of more than 64 values are chunked with Fletcher-32; smaller ones
 * and attributes are stored in object headers, which HDF5 itself checks.
 * Strings have a fixed length, as the heap that holds others has no checksum.
 * The index of chunks has none either, and the Fletcher-32 of zeros is 0, so
 * that a damaged index could pass zeros off as values: therefore each chunked
 * data set has an attribute `checksum` of all its values.
 *
 * `type` is the type on file, H5T_IEEE_F64LE, H5T_STD_I64LE or a string; values
 * in memory are of the native one. An id of 0 is nothing, as a failed one is.
 * A `name` is one link of `at`, never a path, and only hard links are followed:
 * a file cannot send its reader into other files.
 */
#ifndef RITZ_CONTAINER_H5_H
#define RITZ_CONTAINER_H5_H

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <hdf5.h>
#include <stdbool.h>

enum {
    RITZ_H5_RANK = 3,     /* most dimensions that anything has */
    RITZ_H5_LONG = 16384, /* bytes from which text is a data set: HDF5 moves an
                             attribute of 64 KiB to a heap without checksum */
};

/* Sizes, the last running fastest; rank 0 is a single value. */
typedef struct ritz_h5_shape {
    int rank;
    hsize_t dims[RITZ_H5_RANK];
} ritz_h5_shape;

ritz_h5_shape ritz_h5_scalar(void);
ritz_h5_shape ritz_h5_vector(int64_t n);
ritz_h5_shape ritz_h5_table(int64_t n, int64_t m);

/** Number of values, @p most + 1 if it is larger. */
hsize_t ritz_h5_volume(const ritz_h5_shape *shape, hsize_t most);

/** Initialise HDF5 and turn off its messages and its exit handler; call it
 * before anything else of HDF5.
 * @return RITZ_ERR_MEMORY if it does not start */
[[nodiscard]] ritz_status ritz_h5_begin(void);

/** Have the guard of ritz_container_guard, if there is one, examine an open
 * file. */
ritz_status ritz_h5_admit(int file);

/** Initialise HDF5 and open a file to read, if the guard admits it. The file of
 * ritz_container_keep is not opened again. */
ritz_status ritz_h5_open(const char *path, hid_t *out);

/**
 * Check that values of an open file take no more memory than its size justifies
 * and, if @p read, add their bytes to those read so far.
 *
 * @return RITZ_ERR_FORMAT if the values read so far and these take far more
 *         memory than a file of this size holds, as with many links to one data
 *         set, or with long texts
 */
ritz_status ritz_h5_take(hid_t at, const char *name, hsize_t bytes, bool read);

/** Keep a file open for each ritz_h5_open of that path, until
 * ritz_h5_release. */
ritz_status ritz_h5_keep(const char *path);
void ritz_h5_release(void);

/** Initialise HDF5 and create or empty a file to write. Only one file at a time
 * in each thread. */
ritz_status ritz_h5_create(const char *path, hid_t *out);

/**
 * Write what HDF5 has buffered of a created file, and close it even if that
 * fails; @p file becomes 0.
 *
 * @return RITZ_ERR_FILE if writing fails, or if any object since the file was
 *         created could not be closed
 */
ritz_status ritz_h5_finish(hid_t *file);

/** Create a group. */
ritz_status ritz_h5_group(hid_t at, const char *name, hid_t *out);

/**
 * Refuse a group that has a link to another object or file among its members.
 * Such a member would not be read, and must not pass for absent.
 */
ritz_status ritz_h5_refuse_links(hid_t group);

/** Open a group to read; refuses such links. */
ritz_status ritz_h5_enter(hid_t at, const char *name, hid_t *out);

/** Whether a group or data set of that name, or such an attribute, exists. A
 * name that is a link, or that HDF5 cannot look up, counts as absent, and
 * ritz_h5_seen reports it. */
bool ritz_h5_has(hid_t at, const char *name);
bool ritz_h5_has_attribute(hid_t at, const char *name);

/** Call it after a file has been read.
 * @return RITZ_ERR_FORMAT if a name since ritz_h5_open wrongly counted as
 *         absent in this thread */
ritz_status ritz_h5_seen(void);

/**
 * Names of all members of a group: in the order of their attributes `index`,
 * which are 0, 1, 2, ..., or by name if no member has one.
 *
 * @return RITZ_ERR_FORMAT if one cannot be a name, or an index is wrong
 */
ritz_status ritz_h5_list(hid_t group, int64_t *count,
                         char (**out)[RITZ_NAME_SIZE]);

/** Type of strings that take @p size bytes with their NUL. */
hid_t ritz_h5_string(size_t size);

/** Close any object of these functions; does nothing for 0 or less. A failure
 * is reported by ritz_h5_finish(). */
void ritz_h5_close(hid_t id);

/** The same for RITZ_OWN(hid_t). */
static inline void hid_t_free(const hid_t *id)
{
    ritz_h5_close(*id);
}

/** Attributes. To read, the number of values must agree, not the shape. */
ritz_status ritz_h5_set(hid_t at, const char *name, hid_t type,
                        ritz_h5_shape shape, const void *values);
ritz_status ritz_h5_get(hid_t at, const char *name, hid_t type, int64_t count,
                        void *values);

/** Text as an attribute, of at most @p size bytes with its NUL to read. */
ritz_status ritz_h5_set_text(hid_t at, const char *name, const char *text);
ritz_status ritz_h5_get_text(hid_t at, const char *name, size_t size,
                             char *out);

typedef struct ritz_texts {
    int64_t count;
    char **text;
} ritz_texts;

/**
 * Texts of any length and number: an attribute, or a data set `long_NAME` if
 * they are too long for an object header. The caller frees what is read.
 */
ritz_status ritz_h5_set_texts(hid_t at, const char *name, int64_t count,
                              char *const *text);
ritz_status ritz_h5_get_texts(hid_t at, const char *name, ritz_texts *out);
void ritz_texts_free(ritz_texts *texts);

/** Type in memory for values of @p type that the file holds as @p on_file. */
ritz_status ritz_h5_match(const char *name, hid_t on_file, hid_t type,
                          hid_t *memory);

/** The shape of such a data set, or whether it has the shape that is due. */
ritz_status ritz_h5_shape_of(hid_t at, const char *name, int rank,
                             ritz_h5_shape *out);
ritz_status ritz_h5_expect(hid_t at, const char *name, ritz_h5_shape shape);

/** All values of a data set. */
ritz_status ritz_h5_write(hid_t at, const char *name, hid_t type,
                          ritz_h5_shape shape, const void *values);
ritz_status ritz_h5_read(hid_t at, const char *name, hid_t type,
                         ritz_h5_shape shape, void *values);

/**
 * Continue the checksum of a data set by the next @p bytes of its values. The
 * first call gets RITZ_H5_SUM, each later one the result of the call before;
 * all but the last have a multiple of 8 bytes. ritz_h5_sum_end makes the last
 * result the value of the attribute `checksum`.
 */
#define RITZ_H5_SUM 14695981039346656037U
uint64_t ritz_h5_sum(int64_t bytes, const void *values, uint64_t sum);
static inline uint64_t ritz_h5_sum_word(uint64_t sum, uint64_t word)
{
    const uint64_t h = (sum ^ word) * UINT64_C(1099511628211);

    return h ^ h >> 32;
}
int64_t ritz_h5_sum_end(uint64_t sum);

/**
 * Fletcher-32 of @p bytes, a multiple of 8, on a little-endian processor: the
 * checksum that HDF5 appends to a chunk.
 */
uint32_t ritz_h5_fletcher32(int64_t bytes, const void *values);

/**
 * Values of a chunk of a vector that the two functions below can write and read:
 * its chunks have a checksum and no other filter, and its values are numbers of
 * 8 bytes as they lie in memory, of type @p memory.
 *
 * @return 0 if HDF5 itself must write or read it
 */
hsize_t ritz_h5_chunk(hid_t set, hid_t memory, const ritz_h5_shape *shape);

/**
 * Write all @p count values, at least 1, of a set that is still empty, whose
 * chunks are of @p chunk values. The file has the bytes that H5Dwrite() would
 * give it.
 *
 * @param[out] sum  of all values, as ritz_h5_sum() from RITZ_H5_SUM on
 */
ritz_status ritz_h5_write_chunks(hid_t set, const char *name, hsize_t chunk,
                                 hsize_t count, const void *values,
                                 uint64_t *sum);

/** Whether all chunks are stored as ritz_h5_write_chunks() does. Other programs
 * may leave chunks out, or the filter of the last one: HDF5 reads these. */
bool ritz_h5_chunks_usual(hid_t set, hsize_t chunk, hsize_t count);

/** Read them. @return RITZ_ERR_FORMAT if the checksum of a chunk does not fit,
 * or a chunk has another size */
ritz_status ritz_h5_read_chunks(hid_t set, const char *name, hsize_t chunk,
                                hsize_t count, void *values, uint64_t *sum);

/** A dense matrix, which h5py shows as shape (nrow, ncol). */
ritz_status ritz_h5_write_dense(hid_t at, const char *name,
                                const ritz_dense *A);

/** Read one of the expected size, all finite. */
ritz_status ritz_h5_read_dense(hid_t at, const char *name, int64_t nrow,
                               int64_t ncol, ritz_dense *out);

/** A group for scipy.sparse.csc_matrix((data, indices, indptr), shape). */
ritz_status ritz_h5_write_sparse(hid_t at, const char *name,
                                 const ritz_sparse *A);
ritz_status ritz_h5_read_sparse(hid_t at, const char *name, ritz_sparse *out);

#endif
