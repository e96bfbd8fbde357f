/*
 * Data sets: how they are cut into chunks, how they are checked before they are
 * read, their values, and matrices; lists of texts.
 *
 * The checksum of a chunked data set: over 64-bit words w of the values as they
 * lie in memory (a dense matrix column by column, a last part of a word filled
 * with zeros),
 *
 *     h := (h xor w) p,   h := h xor (h >> 32),   modulo 2^64
 *
 * from h = 14695981039346656037 with p = 1099511628211, the numbers of FNV-1a.
 * Each step can be undone, so that no change of a single word goes unseen.
 */
#include "container/h5.h"

#include "base/alloc.h"
#include "base/aside.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SMALL = 64,         /* most values that are stored in the object header */
    SMALL_BYTES = 8192, /* most bytes of them */
    CHUNK = 65536,      /* values, half of HDF5's chunk cache */
    CHUNK_BYTES = 524288,
    LARGE = 4 << 20,       /* bytes that another thread sums up */
    ACROSS = 16,           /* columns in a chunk of a tall matrix */
    FEW_CHUNKS = 1024,     /* chunks that any data set may have */
    SMALLEST_CHUNK = 4096, /* mean values of a chunk where there are more */
};

ritz_h5_shape ritz_h5_vector(int64_t n)
{
    return (ritz_h5_shape){1, {(hsize_t)n}};
}

ritz_h5_shape ritz_h5_table(int64_t n, int64_t m)
{
    return (ritz_h5_shape){2, {(hsize_t)n, (hsize_t)m}};
}

static hsize_t smaller_of(hsize_t a, hsize_t b)
{
    return a < b ? a : b;
}

/* Size of the pieces if n is cut into the fewest of at most `most` each. */
static hsize_t size_piece(hsize_t n, hsize_t most)
{
    hsize_t pieces = (n + most - 1) / most;

    return (n + pieces - 1) / pieces;
}

/*
 * Chunks of up to `most` values. Those of a tall matrix are 16 columns wide, so
 * that reading one row or one column reads little else; those of a wide matrix
 * have as many columns as fit. Further dimensions are not cut.
 */
static ritz_h5_shape cut_chunks(const ritz_h5_shape *shape, hsize_t most)
{
    ritz_h5_shape chunk = *shape;
    hsize_t across = shape->rank == 2 ? smaller_of(shape->dims[1], ACROSS) : 1;

    if (shape->rank == 3)
        across = shape->dims[1] * shape->dims[2];
    chunk.dims[0] =
        size_piece(shape->dims[0], most > across ? most / across : 1);
    if (shape->rank == 2) {
        most = most > chunk.dims[0] ? most / chunk.dims[0] : 1;
        chunk.dims[1] = size_piece(shape->dims[1], most);
    }
    return chunk;
}

static ritz_status create_set(hid_t at, const char *name, hid_t type,
                              ritz_h5_shape shape, hid_t *out)
{
    hsize_t size = H5Tget_size(type);
    hsize_t count = ritz_h5_volume(&shape, INT64_MAX);
    RITZ_OWN(hid_t)
    space = H5Screate_simple(shape.rank, shape.dims, NULL);
    RITZ_OWN(hid_t) plan = H5Pcreate(H5P_DATASET_CREATE);
    bool planned = H5Pset_obj_track_times(plan, false) >= 0;

    if (count <= SMALL && count * size <= SMALL_BYTES) {
        planned = H5Pset_layout(plan, H5D_COMPACT) >= 0 && planned;
    } else {
        const ritz_h5_shape chunk =
            cut_chunks(&shape, smaller_of(CHUNK, CHUNK_BYTES / size + 1));

        planned = H5Pset_chunk(plan, shape.rank, chunk.dims) >= 0 &&
                  H5Pset_fletcher32(plan) >= 0 && planned;
    }
    RITZ_REFUSE_IF(!planned, RITZ_ERR_MEMORY, "no memory to create '%s'", name);
    *out = H5Dcreate2(at, name, type, space, H5P_DEFAULT, plan, H5P_DEFAULT);
    RITZ_REFUSE_IF(*out < 0, RITZ_ERR_FILE, "cannot create '%s'", name);
    return RITZ_OK;
}

/* Go on to the next chunk, the last dimension first; false after the last. */
static bool advance_chunk(const ritz_h5_shape *shape,
                          const ritz_h5_shape *chunk, hsize_t at[RITZ_H5_RANK])
{
    for (int k = shape->rank - 1; k >= 0; k--) {
        at[k] += chunk->dims[k];
        if (at[k] < shape->dims[k])
            return true;
        at[k] = 0;
    }
    return false;
}

/*
 * Whether each chunk is stored, with its checksum. The index of chunks has no
 * checksum, and a chunk that is missing from it would be read as zeros. HDF5
 * 1.10 finds a chunk by a linear search, so their number is limited.
 */
static bool is_whole(hid_t set, const ritz_h5_shape *shape,
                     const ritz_h5_shape *chunk)
{
    hsize_t count = ritz_h5_volume(shape, INT64_MAX);
    hsize_t chunks = 1;
    hsize_t at[RITZ_H5_RANK] = {0};
    bool whole = true;

    for (int k = 0; k < shape->rank; k++)
        chunks *= (shape->dims[k] + chunk->dims[k] - 1) / chunk->dims[k];
    whole = chunks <= FEW_CHUNKS + count / SMALLEST_CHUNK;
    while (whole) {
        unsigned skipped = 0;
        haddr_t place = HADDR_UNDEF;
        hsize_t size = 0;

        H5Dget_chunk_info_by_coord(set, at, &skipped, &place, &size);
        whole = place != HADDR_UNDEF && skipped == 0;
        if (!advance_chunk(shape, chunk, at))
            break;
    }
    return whole;
}

/* The only filter that is accepted is the checksum, and no external file. */
static bool is_plain(hid_t plan)
{
    bool plain = true;

    for (int k = 0; k < H5Pget_nfilters(plan); k++) {
        size_t none = 0;
        unsigned flags = 0;

        plain = plain && H5Pget_filter2(plan, (unsigned)k, &flags, &none, NULL,
                                        0, NULL, NULL) == H5Z_FILTER_FLETCHER32;
    }
    return plain && H5Pget_external_count(plan) <= 0;
}

/* Whether the file holds as many values as the data set and chunks declare. */
static bool is_borne_out(hid_t set, hid_t plan, const ritz_h5_shape *shape)
{
    RITZ_OWN(hid_t) type = H5Dget_type(set);
    RITZ_OWN(hid_t) file = H5Iget_file_id(set);
    hsize_t stored = H5Dget_storage_size(set);
    hsize_t size = H5Tget_size(type);
    hsize_t present = 0;
    H5D_layout_t layout = H5Pget_layout(plan);
    ritz_h5_shape chunk = *shape;
    bool held = false;

    H5Fget_filesize(file, &present);
    if (ritz_h5_volume(shape, 1) == 0)
        return true;
    held = size > 0 && stored <= present &&
           ritz_h5_volume(shape, stored / size) <= stored / size;
    if (layout != H5D_CHUNKED)
        return held && (layout == H5D_COMPACT || layout == H5D_CONTIGUOUS);
    return held && H5Pget_chunk(plan, shape->rank, chunk.dims) == shape->rank &&
           ritz_h5_volume(&chunk, 1) > 0 &&
           ritz_h5_volume(&chunk, stored / size) <= stored / size &&
           is_whole(set, shape, &chunk);
}

/* Bytes of memory for the values: numbers become at least double, texts at
   least RITZ_NAME_SIZE. */
static hsize_t measure_values(hid_t set, const ritz_h5_shape *shape)
{
    RITZ_OWN(hid_t) type = H5Dget_type(set);
    const hsize_t size = H5Tget_size(type);
    const hsize_t least =
        H5Tget_class(type) == H5T_STRING ? RITZ_NAME_SIZE : sizeof(double);

    return ritz_h5_volume(shape, INT64_MAX / RITZ_NAME_SIZE) *
           (size > least ? size : least);
}

/* Open a data set of @p rank, once the file holds as much as it declares. */
static ritz_status open_set(hid_t at, const char *name, int rank,
                            ritz_h5_shape *shape, hid_t *out)
{
    RITZ_OWN(hid_t) set = 0, space = 0, plan = 0;

    if (ritz_h5_has(at, name))
        set = H5Dopen2(at, name, H5P_DEFAULT);
    if (set > 0) {
        space = H5Dget_space(set);
        plan = H5Dget_create_plist(set);
    }
    RITZ_REFUSE_IF(space <= 0 || plan <= 0 ||
                       H5Sget_simple_extent_ndims(space) != rank,
                   RITZ_ERR_FORMAT, "no data set '%s' of %d dimension%s", name,
                   rank, rank == 1 ? "" : "s");
    shape->rank = rank;
    H5Sget_simple_extent_dims(space, shape->dims, NULL);
    RITZ_REFUSE_IF(!is_plain(plan), RITZ_ERR_FORMAT,
                   "'%s' is compressed, or lies in another file", name);
    RITZ_REFUSE_IF(!is_borne_out(set, plan, shape), RITZ_ERR_FORMAT,
                   "'%s' declares more values than the file holds", name);
    RITZ_CHECK(ritz_h5_take(set, name, measure_values(set, shape), false));
    RITZ_MOVE(*out, set);
    return RITZ_OK;
}

ritz_status ritz_h5_shape_of(hid_t at, const char *name, int rank,
                             ritz_h5_shape *out)
{
    RITZ_OWN(hid_t) set = 0;

    return open_set(at, name, rank, out, &set);
}

static int64_t sum_words(int64_t bytes, const void *values)
{
    return ritz_h5_sum_end(ritz_h5_sum(bytes, values, RITZ_H5_SUM));
}

/* A checksum of a dense matrix, computed while HDF5 writes it. */
typedef struct sealing {
    int64_t bytes;
    const void *values;
    int64_t checksum;
    ritz_aside aside;
} sealing;

static void sum_values(void *task)
{
    sealing *seal = task;

    seal->checksum = sum_words(seal->bytes, seal->values);
}

/* Store the checksum of a chunked data set, once it is computed. */
static ritz_status write_seal(hid_t set, const char *name, int64_t checksum)
{
    RITZ_OWN(hid_t) plan = H5Dget_create_plist(set);
    const H5D_layout_t layout = H5Pget_layout(plan);

    RITZ_REFUSE_IF(layout < 0, RITZ_ERR_MEMORY, "no memory for '%s'", name);
    if (layout != H5D_CHUNKED)
        return RITZ_OK;
    return ritz_context(ritz_h5_set(set, "checksum", H5T_STD_I64LE,
                                    ritz_h5_scalar(), &checksum),
                        name);
}

/* A data set that a script wrote has no checksum, and is not checked. */
static ritz_status verify_sum(hid_t set, const char *name, int64_t found)
{
    int64_t checksum = 0;

    if (!ritz_h5_has_attribute(set, "checksum"))
        return RITZ_OK;
    RITZ_CHECK_IN(name,
                  ritz_h5_get(set, "checksum", H5T_STD_I64LE, 1, &checksum));
    RITZ_REFUSE_IF(checksum != found, RITZ_ERR_FORMAT,
                   "'%s' is damaged: its checksum does not fit", name);
    return RITZ_OK;
}

/* Write buffered values now: if HDF5 failed to write them when it closes the
   data set, the error would be lost. */
static ritz_status flush_set(hid_t set, const char *name)
{
    RITZ_REFUSE_IF(H5Dflush(set) < 0, RITZ_ERR_FILE,
                   "cannot write '%s', is the disk full?", name);
    return RITZ_OK;
}

static int64_t count_bytes(const ritz_h5_shape *shape, hid_t memory)
{
    return (int64_t)(ritz_h5_volume(shape, INT64_MAX) * H5Tget_size(memory));
}

/* Write all values of a set, and compute their checksum. */
static ritz_status write_values(hid_t set, const char *name, hid_t memory,
                                const ritz_h5_shape *shape, const void *values,
                                int64_t *checksum)
{
    const hsize_t count = ritz_h5_volume(shape, INT64_MAX);
    const hsize_t chunk = ritz_h5_chunk(set, memory, shape);
    uint64_t sum = RITZ_H5_SUM;
    herr_t result = 0;

    if (chunk > 0 && count > 0) {
        RITZ_CHECK(ritz_h5_write_chunks(set, name, chunk, count, values, &sum));
        *checksum = ritz_h5_sum_end(sum);
        return RITZ_OK;
    }
    if (count > 0)
        result = H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    *checksum = sum_words(count_bytes(shape, memory), values);
    RITZ_REFUSE_IF(result < 0, RITZ_ERR_FILE,
                   "cannot write '%s', is the disk full?", name);
    return RITZ_OK;
}

ritz_status ritz_h5_write(hid_t at, const char *name, hid_t type,
                          ritz_h5_shape shape, const void *values)
{
    RITZ_OWN(hid_t) memory = H5Tget_native_type(type, H5T_DIR_ASCEND);
    RITZ_OWN(hid_t) set = 0;
    int64_t checksum = 0;

    RITZ_CHECK(create_set(at, name, type, shape, &set));
    RITZ_CHECK(write_values(set, name, memory, &shape, values, &checksum));
    RITZ_CHECK(write_seal(set, name, checksum));
    return flush_set(set, name);
}

/* "3 x 4" */
static const char *print_shape(const ritz_h5_shape *shape, char text[80])
{
    int used = 0;

    text[0] = '\0';
    for (int k = 0; k < shape->rank; k++)
        used += snprintf(text + used, 80 - (size_t)used, "%s%" PRIuHSIZE,
                         k > 0 ? " x " : "", shape->dims[k]);
    return text;
}

/* Open a data set that must have the shape that is due. */
static ritz_status open_due(hid_t at, const char *name,
                            const ritz_h5_shape *due, hid_t *out)
{
    RITZ_OWN(hid_t) set = 0;
    ritz_h5_shape found = {0};
    char have[80];
    char want[80];

    RITZ_CHECK(open_set(at, name, due->rank, &found, &set));
    for (int k = 0; k < due->rank; k++)
        RITZ_REFUSE_IF(found.dims[k] != due->dims[k], RITZ_ERR_FORMAT,
                       "'%s' is of %s values where %s are due", name,
                       print_shape(&found, have), print_shape(due, want));
    RITZ_MOVE(*out, set);
    return RITZ_OK;
}

ritz_status ritz_h5_expect(hid_t at, const char *name, ritz_h5_shape shape)
{
    RITZ_OWN(hid_t) set = 0;

    return open_due(at, name, &shape, &set);
}

/* Read all values of a set, and compare their checksum. */
static ritz_status read_values(hid_t set, const char *name, hid_t memory,
                               const ritz_h5_shape *shape, void *values)
{
    const hsize_t count = ritz_h5_volume(shape, INT64_MAX);
    const hsize_t chunk = ritz_h5_chunk(set, memory, shape);
    uint64_t sum = RITZ_H5_SUM;
    herr_t result = 0;

    if (chunk > 0 && count > 0 && ritz_h5_chunks_usual(set, chunk, count)) {
        RITZ_CHECK(ritz_h5_read_chunks(set, name, chunk, count, values, &sum));
        return verify_sum(set, name, ritz_h5_sum_end(sum));
    }
    if (count > 0)
        result = H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    RITZ_REFUSE_IF(result < 0, RITZ_ERR_FORMAT, "'%s' is damaged", name);
    return verify_sum(set, name, sum_words(count_bytes(shape, memory), values));
}

ritz_status ritz_h5_read(hid_t at, const char *name, hid_t type,
                         ritz_h5_shape shape, void *values)
{
    RITZ_OWN(hid_t) set = 0, on_file = 0, memory = 0;

    RITZ_CHECK(open_due(at, name, &shape, &set));
    on_file = H5Dget_type(set);
    RITZ_CHECK(ritz_h5_match(name, on_file, type, &memory));
    RITZ_CHECK(ritz_h5_take(set, name, measure_values(set, &shape), true));
    return read_values(set, name, memory, &shape, values);
}

/*
 * Reads or writes the piece of a matrix from (i, j) on. HDF5 is row-major, Ritz
 * is not: rows[r * columns + c] = A(i + r, j + c).
 */
static herr_t move_piece(hid_t set, const ritz_h5_shape *piece, bool reads,
                         hsize_t i, hsize_t j, const ritz_dense *A,
                         double *rows)
{
    const hsize_t all[2] = {(hsize_t)A->nrow, (hsize_t)A->ncol};
    const hsize_t start[2] = {i, j};
    const hsize_t count[2] = {smaller_of(piece->dims[0], all[0] - i),
                              smaller_of(piece->dims[1], all[1] - j)};
    RITZ_OWN(hid_t) space = H5Screate_simple(2, all, NULL);
    /* Two dimensions, as on file: HDF5 then copies whole rows. To and from a
       memory space of one dimension it copies entry by entry. */
    RITZ_OWN(hid_t) memory = H5Screate_simple(2, count, NULL);

    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL);
    if (reads &&
        H5Dread(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, rows) < 0)
        return -1;
    for (hsize_t c = 0; c < count[1]; c++) {
        double *a = ritz_dense_col(A, (int64_t)(j + c)) + i;

        for (hsize_t r = 0; reads && r < count[0]; r++)
            a[r] = rows[r * count[1] + c];
        for (hsize_t r = 0; !reads && r < count[0]; r++)
            rows[r * count[1] + c] = a[r];
    }
    return reads ? 0
                 : H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT,
                            rows);
}

/*
 * Reads or writes a matrix by its chunks, so that each is decoded once, or by
 * whole rows where it has none.
 */
static ritz_status move_pieces(hid_t set, bool reads, const ritz_dense *A)
{
    RITZ_OWN(hid_t) plan = H5Dget_create_plist(set);
    const ritz_h5_shape shape = ritz_h5_table(A->nrow, A->ncol);
    ritz_h5_shape piece = shape;
    RITZ_OWN_ARRAY double *rows = NULL;

    if (A->nrow == 0 || A->ncol == 0)
        return RITZ_OK;
    if (H5Pget_layout(plan) == H5D_CHUNKED)
        H5Pget_chunk(plan, shape.rank, piece.dims);
    else if (ritz_h5_volume(&shape, CHUNK) > CHUNK)
        piece.dims[0] = size_piece(
            shape.dims[0], shape.dims[1] < CHUNK ? CHUNK / shape.dims[1] : 1);
    for (int k = 0; k < shape.rank; k++)
        piece.dims[k] = smaller_of(piece.dims[k], shape.dims[k]);
    RITZ_CHECK_NEW(rows, (int64_t)(piece.dims[0] * piece.dims[1]));
    for (hsize_t i = 0; i < shape.dims[0]; i += piece.dims[0])
        for (hsize_t j = 0; j < shape.dims[1]; j += piece.dims[1])
            if (move_piece(set, &piece, reads, i, j, A, rows) < 0)
                return RITZ_ERR_FILE;
    return RITZ_OK;
}

static int64_t matrix_bytes(const ritz_dense *A)
{
    return A->nrow * A->ncol * (int64_t)sizeof *A->val;
}

ritz_status ritz_h5_write_dense(hid_t at, const char *name, const ritz_dense *A)
{
    RITZ_OWN(hid_t) set = 0;
    ritz_status status = RITZ_OK;
    sealing seal = {.bytes = matrix_bytes(A), .values = A->val};

    RITZ_CHECK(create_set(at, name, H5T_IEEE_F64LE,
                          ritz_h5_table(A->nrow, A->ncol), &set));
    ritz_aside_begin(sum_values, &seal, seal.bytes >= LARGE, &seal.aside);
    status = move_pieces(set, false, A);
    ritz_aside_end(&seal.aside);
    RITZ_REFUSE_IF(status == RITZ_ERR_FILE, RITZ_ERR_FILE,
                   "cannot write '%s', is the disk full?", name);
    RITZ_CHECK(status);
    RITZ_CHECK(write_seal(set, name, seal.checksum));
    return flush_set(set, name);
}

static ritz_status check_dense(const ritz_dense *A)
{
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        RITZ_REFUSE_IF(!isfinite(A->val[k]), RITZ_ERR_FORMAT,
                       "entry (%" PRId64 ", %" PRId64 ") is not finite",
                       k % A->nrow + 1, k / A->nrow + 1);
    return RITZ_OK;
}

ritz_status ritz_h5_read_dense(hid_t at, const char *name, int64_t nrow,
                               int64_t ncol, ritz_dense *out)
{
    ritz_h5_shape shape = {0};
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN(hid_t) set = 0, on_file = 0, memory = 0;
    ritz_status status = RITZ_OK;
    int64_t n = 0, m = 0;

    RITZ_CHECK(open_set(at, name, 2, &shape, &set));
    RITZ_REFUSE_IF(shape.dims[0] > INT_MAX || shape.dims[1] > INT_MAX,
                   RITZ_ERR_FORMAT, "'%s' is too large", name);
    n = (int64_t)shape.dims[0];
    m = (int64_t)shape.dims[1];
    RITZ_REFUSE_IF(nrow == ncol && n != m, RITZ_ERR_FORMAT,
                   "'%s' is not square", name);
    RITZ_REFUSE_IF(nrow != n || ncol != m, RITZ_ERR_FORMAT,
                   "'%s' is %" PRId64 " x %" PRId64 " where %" PRId64
                   " x %" PRId64 " is due",
                   name, n, m, nrow, ncol);
    on_file = H5Dget_type(set);
    RITZ_CHECK(ritz_h5_match(name, on_file, H5T_IEEE_F64LE, &memory));
    RITZ_CHECK(ritz_h5_take(set, name, measure_values(set, &shape), true));
    RITZ_CHECK(ritz_dense_new(nrow, ncol, &A));
    status = move_pieces(set, true, &A);
    RITZ_REFUSE_IF(status == RITZ_ERR_FILE, RITZ_ERR_FORMAT, "'%s' is damaged",
                   name);
    RITZ_CHECK(status);
    RITZ_CHECK(verify_sum(set, name, sum_words(matrix_bytes(&A), A.val)));
    RITZ_CHECK_IN(name, check_dense(&A));
    RITZ_MOVE(*out, A);
    return RITZ_OK;
}

/* The parts of a sparse matrix; each is written, or read. */
static ritz_status write_columns(hid_t group, const ritz_sparse *A)
{
    int64_t shape[] = {A->nrow, A->ncol};
    ritz_h5_shape nnz = ritz_h5_vector(A->colptr[A->ncol]);

    RITZ_CHECK(ritz_h5_set_text(group, "format", "csc"));
    RITZ_CHECK(
        ritz_h5_set(group, "shape", H5T_STD_I64LE, ritz_h5_vector(2), shape));
    RITZ_CHECK(ritz_h5_write(group, "data", H5T_IEEE_F64LE, nnz, A->val));
    RITZ_CHECK(ritz_h5_write(group, "indices", H5T_STD_I64LE, nnz, A->rowind));
    return ritz_h5_write(group, "indptr", H5T_STD_I64LE,
                         ritz_h5_vector(A->ncol + 1), A->colptr);
}

static ritz_status read_columns(hid_t group, ritz_sparse *A)
{
    char format[RITZ_NAME_SIZE] = "";
    int64_t shape[2] = {0};
    ritz_h5_shape nnz = {0}, pointers = {0};

    RITZ_CHECK(ritz_h5_get_text(group, "format", sizeof format, format));
    RITZ_REFUSE_IF(strcmp(format, "csc") != 0, RITZ_ERR_FORMAT,
                   "is not in compressed columns");
    RITZ_CHECK(ritz_h5_get(group, "shape", H5T_STD_I64LE, 2, shape));
    RITZ_CHECK(ritz_h5_shape_of(group, "data", 1, &nnz));
    RITZ_CHECK(ritz_h5_shape_of(group, "indptr", 1, &pointers));
    RITZ_REFUSE_IF(pointers.dims[0] < 1 || shape[0] < 0 ||
                       shape[1] != (int64_t)pointers.dims[0] - 1,
                   RITZ_ERR_FORMAT, "shape and column pointers disagree");
    RITZ_CHECK(ritz_sparse_new(shape[0], shape[1], (int64_t)nnz.dims[0], A));
    RITZ_CHECK(ritz_h5_read(group, "data", H5T_IEEE_F64LE, nnz, A->val));
    RITZ_CHECK(ritz_h5_read(group, "indices", H5T_STD_I64LE, nnz, A->rowind));
    RITZ_CHECK(
        ritz_h5_read(group, "indptr", H5T_STD_I64LE, pointers, A->colptr));
    return ritz_sparse_check(A, (int64_t)nnz.dims[0]);
}

ritz_status ritz_h5_write_sparse(hid_t at, const char *name,
                                 const ritz_sparse *A)
{
    RITZ_OWN(hid_t) group = 0;

    RITZ_CHECK_IN(name, ritz_h5_group(at, name, &group));
    return ritz_context(write_columns(group, A), name);
}

ritz_status ritz_h5_read_sparse(hid_t at, const char *name, ritz_sparse *out)
{
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(hid_t) group = 0;

    RITZ_CHECK_IN(name, ritz_h5_enter(at, name, &group));
    RITZ_CHECK_IN(name, read_columns(group, &A));
    RITZ_MOVE(*out, A);
    return RITZ_OK;
}

/* Lists of texts of any length, as attributes or, where they are long, sets. */

/* A data set `inputs` would clash with the group, hence "long_inputs". */
typedef char long_name[RITZ_NAME_SIZE];

static const char *name_long(const char *name, long_name out)
{
    snprintf(out, sizeof(long_name), "long_%s", name);
    return out;
}

ritz_status ritz_h5_set_texts(hid_t at, const char *name, int64_t count,
                              char *const *text)
{
    RITZ_OWN(hid_t) type = 0;
    RITZ_OWN_ARRAY char *block = NULL; /* of texts padded to the longest */
    long_name other;
    int64_t size = 1;

    for (int64_t k = 0; k < count; k++)
        if ((int64_t)strlen(text[k]) >= size)
            size = (int64_t)strlen(text[k]) + 1;
    RITZ_CHECK_NEW(block, count * size);
    for (int64_t k = 0; k < count; k++)
        memcpy(block + k * size, text[k], strlen(text[k]));
    type = ritz_h5_string((size_t)size);
    if (count * size < RITZ_H5_LONG)
        return ritz_h5_set(at, name, type, ritz_h5_vector(count), block);
    return ritz_h5_write(at, name_long(name, other), type,
                         ritz_h5_vector(count), block);
}

/* Number of texts and bytes of each, in an attribute or a data set. */
static ritz_status measure_texts(hid_t at, const char *name, int64_t *count,
                                 size_t *size)
{
    bool short_ones = ritz_h5_has_attribute(at, name);
    RITZ_OWN(hid_t) texts = 0, space = 0, type = 0, file = 0;
    hsize_t present = 0;
    ritz_h5_shape shape = {0};
    long_name other;

    if (short_ones)
        texts = H5Aopen(at, name, H5P_DEFAULT);
    else
        RITZ_CHECK(open_set(at, name_long(name, other), 1, &shape, &texts));
    space = short_ones ? H5Aget_space(texts) : H5Dget_space(texts);
    type = short_ones ? H5Aget_type(texts) : H5Dget_type(texts);
    file = H5Iget_file_id(at);
    H5Fget_filesize(file, &present);
    RITZ_REFUSE_IF(H5Tget_class(type) != H5T_STRING ||
                       H5Tis_variable_str(type) != 0,
                   RITZ_ERR_FORMAT, "'%s' is not text of fixed length", name);
    *count = H5Sget_simple_extent_npoints(space);
    *size = H5Tget_size(type);
    RITZ_REFUSE_IF(*count < 0 || *size < 1 || *size > present ||
                       (hsize_t)*count > present / *size,
                   RITZ_ERR_FORMAT, "'%s' declares more than the file holds",
                   name);
    return RITZ_OK;
}

/* Copy each of the padded texts of a block. */
static ritz_status cut_texts(const char *block, size_t size, int64_t count,
                             ritz_texts *out)
{
    RITZ_OWN(ritz_texts) texts = {.count = count};

    RITZ_CHECK_NEW(texts.text, count);
    for (int64_t k = 0; k < count; k++) {
        const char *from = block + (size_t)k * size;
        size_t length = strnlen(from, size);

        RITZ_CHECK_NEW(texts.text[k], (int64_t)length + 1);
        memcpy(texts.text[k], from, length);
    }
    RITZ_MOVE(*out, texts);
    return RITZ_OK;
}

ritz_status ritz_h5_get_texts(hid_t at, const char *name, ritz_texts *out)
{
    RITZ_OWN_ARRAY char *block = NULL;
    RITZ_OWN(hid_t) type = 0;
    int64_t count = 0;
    size_t size = 0;
    long_name other;

    RITZ_CHECK(measure_texts(at, name, &count, &size));
    RITZ_CHECK_NEW(block, count * (int64_t)size);
    type = ritz_h5_string(size);
    /* the longest text may fill its room, without a NUL */
    RITZ_REFUSE_IF(H5Tset_strpad(type, H5T_STR_NULLPAD) < 0, RITZ_ERR_MEMORY,
                   "no memory for '%s'", name);
    if (ritz_h5_has_attribute(at, name))
        RITZ_CHECK(ritz_h5_get(at, name, type, count, block));
    else
        RITZ_CHECK(ritz_h5_read(at, name_long(name, other), type,
                                ritz_h5_vector(count), block));
    return cut_texts(block, size, count, out);
}

void ritz_texts_free(ritz_texts *texts)
{
    for (int64_t k = 0; k < texts->count && texts->text; k++)
        free(texts->text[k]);
    free(texts->text);
    *texts = (ritz_texts){0};
}
