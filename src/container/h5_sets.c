/*
 * Data sets: how they are cut into chunks, what is believed of them, their
 * values, and matrices.
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

static ritz_status create_set(hid_t at, const char *name, hid_t type,
                              ritz_h5_shape shape, ritz_h5_shape *chunk,
                              hid_t *out)
{
    ritz_status status = RITZ_OK;
    hsize_t size = H5Tget_size(type);
    hsize_t count = ritz_h5_volume(&shape, INT64_MAX);
    hid_t space = H5Screate_simple(shape.rank, shape.dims, NULL);
    hid_t plan = H5Pcreate(H5P_DATASET_CREATE);

    H5Pset_obj_track_times(plan, false);
    *chunk = shape;
    if (count <= SMALL && count * size <= SMALL_BYTES) {
        H5Pset_layout(plan, H5D_COMPACT);
    } else {
        *chunk = cut_chunks(&shape, smaller_of(CHUNK, CHUNK_BYTES / size + 1));
        H5Pset_chunk(plan, shape.rank, chunk->dims);
        H5Pset_fletcher32(plan);
    }
    *out = H5Dcreate2(at, name, type, space, H5P_DEFAULT, plan, H5P_DEFAULT);
    RITZ_FAIL_IF(*out < 0, RITZ_ERR_FILE, "cannot create '%s'", name);
done:
    ritz_h5_close(plan);
    ritz_h5_close(space);
    return status;
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
    hid_t type = H5Dget_type(set);
    hid_t file = H5Iget_file_id(set);
    hsize_t stored = H5Dget_storage_size(set);
    hsize_t size = H5Tget_size(type);
    hsize_t present = 0;
    H5D_layout_t layout = H5Pget_layout(plan);
    ritz_h5_shape chunk = *shape;
    bool held = false;

    H5Fget_filesize(file, &present);
    ritz_h5_close(file);
    ritz_h5_close(type);
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

ritz_status ritz_h5_open_set(hid_t at, const char *name, int rank,
                             ritz_h5_shape *shape, hid_t *out)
{
    ritz_status status = RITZ_OK;
    hid_t set = ritz_h5_has(at, name) ? H5Dopen2(at, name, H5P_DEFAULT) : -1;
    hid_t space = set < 0 ? -1 : H5Dget_space(set);
    hid_t plan = set < 0 ? -1 : H5Dget_create_plist(set);

    RITZ_FAIL_IF(space < 0 || plan < 0 ||
                     H5Sget_simple_extent_ndims(space) != rank,
                 RITZ_ERR_FORMAT, "no data set '%s' of %d dimension%s", name,
                 rank, rank == 1 ? "" : "s");
    shape->rank = rank;
    H5Sget_simple_extent_dims(space, shape->dims, NULL);
    RITZ_FAIL_IF(!is_plain(plan), RITZ_ERR_FORMAT,
                 "'%s' is compressed, or lies in another file", name);
    RITZ_FAIL_IF(!is_borne_out(set, plan, shape), RITZ_ERR_FORMAT,
                 "'%s' declares more values than the file holds", name);
    *out = set;
    set = 0;
done:
    ritz_h5_close(plan);
    ritz_h5_close(space);
    ritz_h5_close(set);
    return status;
}

static ritz_h5_shape pieces_of(hid_t set, const ritz_h5_shape *shape)
{
    hid_t plan = H5Dget_create_plist(set);
    ritz_h5_shape chunk = *shape;

    if (H5Pget_layout(plan) == H5D_CHUNKED)
        H5Pget_chunk(plan, shape->rank, chunk.dims);
    else if (ritz_h5_volume(shape, CHUNK) > CHUNK)
        chunk.dims[0] = /* whole rows, which lie side by side */
            size_piece(shape->dims[0],
                       shape->dims[1] < CHUNK ? CHUNK / shape->dims[1] : 1);
    for (int k = 0; k < shape->rank; k++)
        chunk.dims[k] = smaller_of(chunk.dims[k], shape->dims[k]);
    ritz_h5_close(plan);
    return chunk;
}

ritz_status ritz_h5_shape_of(hid_t at, const char *name, int rank,
                             ritz_h5_shape *out)
{
    hid_t set = 0;
    ritz_status status = ritz_h5_open_set(at, name, rank, out, &set);

    ritz_h5_close(set);
    return status;
}

static ritz_status count_of(hid_t at, const char *name, int64_t *out)
{
    ritz_h5_shape shape = {0};
    ritz_status status = ritz_h5_shape_of(at, name, 1, &shape);

    if (status == RITZ_OK)
        *out = (int64_t)shape.dims[0];
    return status;
}

static int64_t sum_words(int64_t bytes, const void *values)
{
    const unsigned char *at = values;
    uint64_t h = 14695981039346656037U;

    for (int64_t k = 0; k < bytes; k += 8) {
        uint64_t w = 0;

        memcpy(&w, at + k, bytes - k < 8 ? (size_t)(bytes - k) : 8);
        h = (h ^ w) * 1099511628211U;
        h ^= h >> 32;
    }
    return (int64_t)(h >> 1); /* a positive number for every reader */
}

static bool is_chunked(hid_t set)
{
    hid_t plan = H5Dget_create_plist(set);
    bool is = H5Pget_layout(plan) == H5D_CHUNKED;

    ritz_h5_close(plan);
    return is;
}

static ritz_status seal_values(hid_t set, const char *name, int64_t bytes,
                               const void *values)
{
    int64_t checksum = 0;

    if (!is_chunked(set))
        return RITZ_OK;
    checksum = sum_words(bytes, values);
    RITZ_CHECK_IN(name, ritz_h5_set(set, "checksum", H5T_STD_I64LE,
                                    ritz_h5_scalar(), &checksum));
    return RITZ_OK;
}

/* A data set that a script wrote has no checksum, and is not checked. */
static ritz_status verify_values(hid_t set, const char *name, int64_t bytes,
                                 const void *values)
{
    int64_t checksum = 0;

    if (H5Aexists(set, "checksum") <= 0)
        return RITZ_OK;
    RITZ_CHECK_IN(name,
                  ritz_h5_get(set, "checksum", H5T_STD_I64LE, 1, &checksum));
    RITZ_REFUSE_IF(checksum != sum_words(bytes, values), RITZ_ERR_FORMAT,
                   "'%s' is damaged: its checksum does not fit", name);
    return RITZ_OK;
}

static hsize_t count_bytes(const ritz_h5_shape *shape, hid_t memory)
{
    return ritz_h5_volume(shape, INT64_MAX) * H5Tget_size(memory);
}

ritz_status ritz_h5_write(hid_t at, const char *name, hid_t type,
                          ritz_h5_shape shape, const void *values)
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape chunk = {0};
    hid_t memory = H5Tget_native_type(type, H5T_DIR_ASCEND);
    hid_t set = 0;
    herr_t result = 0;

    RITZ_TRY(create_set(at, name, type, shape, &chunk, &set));
    if (ritz_h5_volume(&shape, 1) > 0)
        result = H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    RITZ_FAIL_IF(result < 0, RITZ_ERR_FILE, "cannot write '%s'", name);
    RITZ_TRY(
        seal_values(set, name, (int64_t)count_bytes(&shape, memory), values));
done:
    ritz_h5_close(set);
    ritz_h5_close(memory);
    return status;
}

static bool is_same(const ritz_h5_shape *a, const ritz_h5_shape *b)
{
    bool same = a->rank == b->rank;

    for (int k = 0; k < a->rank; k++)
        same = same && a->dims[k] == b->dims[k];
    return same;
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

static ritz_status check_shape(const char *name, const ritz_h5_shape *found,
                               const ritz_h5_shape *due)
{
    char have[80];
    char want[80];

    RITZ_REFUSE_IF(!is_same(found, due), RITZ_ERR_FORMAT,
                   "'%s' is of %s values where %s are due", name,
                   print_shape(found, have), print_shape(due, want));
    return RITZ_OK;
}

ritz_status ritz_h5_expect(hid_t at, const char *name, ritz_h5_shape shape)
{
    ritz_h5_shape found = {0};

    RITZ_CHECK(ritz_h5_shape_of(at, name, shape.rank, &found));
    return check_shape(name, &found, &shape);
}

ritz_status ritz_h5_read(hid_t at, const char *name, hid_t type,
                         ritz_h5_shape shape, void *values)
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape found = {0};
    hid_t set = 0;
    hid_t on_file = 0;
    hid_t memory = 0;
    herr_t result = 0;

    RITZ_TRY(ritz_h5_open_set(at, name, shape.rank, &found, &set));
    RITZ_TRY(check_shape(name, &found, &shape));
    on_file = H5Dget_type(set);
    RITZ_TRY(ritz_h5_match(name, on_file, type, &memory));
    if (ritz_h5_volume(&shape, 1) > 0)
        result = H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    RITZ_FAIL_IF(result < 0, RITZ_ERR_FORMAT, "'%s' is damaged", name);
    RITZ_TRY(
        verify_values(set, name, (int64_t)count_bytes(&shape, memory), values));
done:
    ritz_h5_close(memory);
    ritz_h5_close(on_file);
    ritz_h5_close(set);
    return status;
}

/* A rectangle of a matrix, and its selection in the file. */
typedef struct block {
    hsize_t start[2], count[2];
    hid_t space;
} block;

static void cut_block(const ritz_h5_shape *shape, const ritz_h5_shape *chunk,
                      block *b)
{
    for (int k = 0; k < 2; k++) {
        hsize_t rest = shape->dims[k] - b->start[k];

        b->count[k] = rest < chunk->dims[k] ? rest : chunk->dims[k];
    }
    H5Sselect_hyperslab(b->space, H5S_SELECT_SET, b->start, NULL, b->count,
                        NULL);
}

/* HDF5 is row-major, Ritz is not: rows[i * columns + j] = A(i, j). */
static herr_t write_block(hid_t set, const block *b, const ritz_dense *A,
                          double *rows)
{
    hsize_t count = b->count[0] * b->count[1];
    hid_t memory = H5Screate_simple(1, &count, NULL);
    herr_t result = 0;

    for (hsize_t j = 0; j < b->count[1]; j++) {
        const double *a = ritz_dense_col(A, (int64_t)(b->start[1] + j));

        for (hsize_t i = 0; i < b->count[0]; i++)
            rows[i * b->count[1] + j] = a[b->start[0] + i];
    }
    result =
        H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, b->space, H5P_DEFAULT, rows);
    ritz_h5_close(memory);
    return result;
}

static herr_t read_block(hid_t set, const block *b, const ritz_dense *A,
                         double *rows)
{
    hsize_t count = b->count[0] * b->count[1];
    hid_t memory = H5Screate_simple(1, &count, NULL);
    herr_t result =
        H5Dread(set, H5T_NATIVE_DOUBLE, memory, b->space, H5P_DEFAULT, rows);

    for (hsize_t j = 0; j < b->count[1] && result >= 0; j++) {
        double *a = ritz_dense_col(A, (int64_t)(b->start[1] + j));

        for (hsize_t i = 0; i < b->count[0]; i++)
            a[b->start[0] + i] = rows[i * b->count[1] + j];
    }
    ritz_h5_close(memory);
    return result;
}

/* Read or write a matrix chunk by chunk, so that each is decoded once. */
static ritz_status
each_block(hid_t set, const ritz_h5_shape *chunk, const ritz_dense *A,
           herr_t (*move)(hid_t, const block *, const ritz_dense *, double *))
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape shape = ritz_h5_table(A->nrow, A->ncol);
    block b = {.space = H5Screate_simple(2, shape.dims, NULL)};
    double *rows = NULL;

    if (A->nrow == 0 || A->ncol == 0)
        goto done;
    RITZ_NEW(rows, (int64_t)(chunk->dims[0] * chunk->dims[1]));
    for (hsize_t i = 0; i < shape.dims[0]; i += chunk->dims[0])
        for (hsize_t j = 0; j < shape.dims[1]; j += chunk->dims[1]) {
            b.start[0] = i;
            b.start[1] = j;
            cut_block(&shape, chunk, &b);
            RITZ_FAIL_IF(move(set, &b, A, rows) < 0, RITZ_ERR_FILE,
                         "damaged, or the disk is full");
        }
done:
    free(rows);
    ritz_h5_close(b.space);
    return status;
}

static int64_t matrix_bytes(const ritz_dense *A)
{
    return A->nrow * A->ncol * (int64_t)sizeof *A->val;
}

ritz_status ritz_h5_write_dense(hid_t at, const char *name, const ritz_dense *A)
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape chunk = {0};
    hid_t set = 0;

    RITZ_TRY(create_set(at, name, H5T_IEEE_F64LE,
                        ritz_h5_table(A->nrow, A->ncol), &chunk, &set));
    RITZ_TRY_IN(name, each_block(set, &chunk, A, write_block));
    RITZ_TRY(seal_values(set, name, matrix_bytes(A), A->val));
done:
    ritz_h5_close(set);
    return status;
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
    ritz_status status = RITZ_OK;
    ritz_h5_shape shape = {0};
    ritz_h5_shape chunk = {0};
    ritz_dense A = {0};
    hid_t set = 0;
    hid_t on_file = 0;
    hid_t memory = 0;
    int64_t n = 0;
    int64_t m = 0;

    RITZ_TRY(ritz_h5_open_set(at, name, 2, &shape, &set));
    RITZ_FAIL_IF(shape.dims[0] > INT_MAX || shape.dims[1] > INT_MAX,
                 RITZ_ERR_FORMAT, "'%s' is too large", name);
    n = (int64_t)shape.dims[0];
    m = (int64_t)shape.dims[1];
    RITZ_FAIL_IF(nrow >= 0 && nrow == ncol && n != m, RITZ_ERR_FORMAT,
                 "'%s' is not square", name);
    RITZ_FAIL_IF((nrow >= 0 && nrow != n) || (ncol >= 0 && ncol != m),
                 RITZ_ERR_FORMAT,
                 "'%s' is %" PRId64 " x %" PRId64 " where %" PRId64
                 " x %" PRId64 " is due",
                 name, n, m, nrow < 0 ? n : nrow, ncol < 0 ? m : ncol);
    on_file = H5Dget_type(set);
    RITZ_TRY(ritz_h5_match(name, on_file, H5T_IEEE_F64LE, &memory));
    RITZ_TRY(ritz_dense_new(n, m, &A));
    chunk = pieces_of(set, &shape);
    status = each_block(set, &chunk, &A, read_block);
    RITZ_FAIL_IF(status == RITZ_ERR_FILE, RITZ_ERR_FORMAT, "'%s' is damaged",
                 name);
    RITZ_TRY(status);
    RITZ_TRY(verify_values(set, name, matrix_bytes(&A), A.val));
    RITZ_TRY_IN(name, check_dense(&A));
    RITZ_MOVE(*out, A);
done:
    ritz_dense_free(&A);
    ritz_h5_close(memory);
    ritz_h5_close(on_file);
    ritz_h5_close(set);
    return status;
}

ritz_status ritz_h5_write_sparse(hid_t at, const char *name,
                                 const ritz_sparse *A)
{
    ritz_status status = RITZ_OK;
    int64_t shape[] = {A->nrow, A->ncol};
    ritz_h5_shape nnz = ritz_h5_vector(A->colptr[A->ncol]);
    hid_t group = 0;

    RITZ_TRY(ritz_h5_group(at, name, &group));
    RITZ_TRY(ritz_h5_set_text(group, "format", "csc"));
    RITZ_TRY(
        ritz_h5_set(group, "shape", H5T_STD_I64LE, ritz_h5_vector(2), shape));
    RITZ_TRY(ritz_h5_write(group, "data", H5T_IEEE_F64LE, nnz, A->val));
    RITZ_TRY(ritz_h5_write(group, "indices", H5T_STD_I64LE, nnz, A->rowind));
    RITZ_TRY(ritz_h5_write(group, "indptr", H5T_STD_I64LE,
                           ritz_h5_vector(A->ncol + 1), A->colptr));
done:
    ritz_h5_close(group);
    return ritz_context(status, name);
}

static ritz_status read_columns(hid_t group, int64_t nnz, ritz_sparse *A)
{
    ritz_h5_shape entries = ritz_h5_vector(nnz);

    RITZ_CHECK(ritz_h5_read(group, "data", H5T_IEEE_F64LE, entries, A->val));
    RITZ_CHECK(
        ritz_h5_read(group, "indices", H5T_STD_I64LE, entries, A->rowind));
    RITZ_CHECK(ritz_h5_read(group, "indptr", H5T_STD_I64LE,
                            ritz_h5_vector(A->ncol + 1), A->colptr));
    return ritz_sparse_check(A, nnz);
}

ritz_status ritz_h5_read_sparse(hid_t at, const char *name, ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    ritz_sparse A = {0};
    char format[RITZ_NAME_SIZE] = "";
    int64_t shape[2] = {0};
    int64_t nnz = 0;
    int64_t pointers = 0;
    hid_t group = 0;

    RITZ_TRY(ritz_h5_enter(at, name, &group));
    RITZ_TRY(ritz_h5_get_text(group, "format", sizeof format, format));
    RITZ_FAIL_IF(strcmp(format, "csc") != 0, RITZ_ERR_FORMAT,
                 "is not in compressed columns");
    RITZ_TRY(ritz_h5_get(group, "shape", H5T_STD_I64LE, 2, shape));
    RITZ_TRY(count_of(group, "data", &nnz));
    RITZ_TRY(count_of(group, "indptr", &pointers));
    RITZ_FAIL_IF(pointers < 1 || shape[0] < 0 || shape[1] != pointers - 1,
                 RITZ_ERR_FORMAT, "shape and column pointers disagree");
    RITZ_TRY(ritz_sparse_new(shape[0], shape[1], nnz, &A));
    RITZ_TRY(read_columns(group, nnz, &A));
    RITZ_MOVE(*out, A);
done:
    ritz_sparse_free(&A);
    ritz_h5_close(group);
    return ritz_context(status, name);
}
