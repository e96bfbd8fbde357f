/* Matrices: dense ones turned from columns to rows, sparse ones as groups. */
#include "container/h5.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A rectangle of a matrix, and the space it takes in the file. */
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

/* Do the same with each chunk of a matrix, none of which is touched twice. */
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

static int64_t count_bytes(const ritz_dense *A)
{
    return A->nrow * A->ncol * (int64_t)sizeof *A->val;
}

ritz_status ritz_h5_write_dense(hid_t at, const char *name, const ritz_dense *A)
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape chunk = {0};
    hid_t set = 0;

    RITZ_TRY(ritz_h5_create_set(at, name, H5T_IEEE_F64LE,
                                ritz_h5_table(A->nrow, A->ncol), &chunk, &set));
    RITZ_TRY_IN(name, each_block(set, &chunk, A, write_block));
    RITZ_TRY(ritz_h5_seal(set, name, count_bytes(A), A->val));
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
    RITZ_FAIL_IF((nrow >= 0 && nrow != n) || (ncol >= 0 && ncol != m),
                 RITZ_ERR_FORMAT,
                 "'%s' is %" PRId64 " x %" PRId64 " where %" PRId64
                 " x %" PRId64 " is due",
                 name, n, m, nrow < 0 ? n : nrow, ncol < 0 ? m : ncol);
    on_file = H5Dget_type(set);
    RITZ_TRY(ritz_h5_match(name, on_file, H5T_IEEE_F64LE, &memory));
    RITZ_TRY(ritz_dense_new(n, m, &A));
    chunk = ritz_h5_pieces(set, &shape);
    status = each_block(set, &chunk, &A, read_block);
    RITZ_FAIL_IF(status == RITZ_ERR_FILE, RITZ_ERR_FORMAT, "'%s' is damaged",
                 name);
    RITZ_TRY(status);
    RITZ_TRY(ritz_h5_verify(set, name, count_bytes(&A), A.val));
    RITZ_TRY_IN(name, check_dense(&A));
    *out = A;
    A = (ritz_dense){0};
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
    RITZ_TRY(ritz_h5_count(group, "data", &nnz));
    RITZ_TRY(ritz_h5_count(group, "indptr", &pointers));
    RITZ_FAIL_IF(pointers < 1 || shape[0] < 0 || shape[1] != pointers - 1,
                 RITZ_ERR_FORMAT, "shape and column pointers disagree");
    RITZ_TRY(ritz_sparse_new(shape[0], shape[1], nnz, &A));
    RITZ_TRY(read_columns(group, nnz, &A));
    *out = A;
    A = (ritz_sparse){0};
done:
    ritz_sparse_free(&A);
    ritz_h5_close(group);
    return ritz_context(status, name);
}
