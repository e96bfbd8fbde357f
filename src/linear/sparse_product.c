/* Products of sparse matrices, and of theirs with few dense columns. */
#include "base/alloc.h"

#include <ritz/sparse.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

ritz_status ritz_sparse_transpose(const ritz_sparse *A, ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    int64_t nnz = A->colptr[A->ncol];
    ritz_sparse B = {0};
    int64_t *next = NULL;

    RITZ_TRY(ritz_sparse_new(A->ncol, A->nrow, nnz, &B));
    RITZ_NEW(next, A->nrow);
    for (int64_t p = 0; p < nnz; p++)
        B.colptr[A->rowind[p] + 1]++;
    for (int64_t i = 0; i < A->nrow; i++) {
        B.colptr[i + 1] += B.colptr[i];
        next[i] = B.colptr[i];
    }
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            int64_t q = next[A->rowind[p]]++;

            B.rowind[q] = j;
            B.val[q] = A->val[p];
        }
    *out = B;
    B = (ritz_sparse){0};
done:
    free(next);
    ritz_sparse_free(&B);
    return status;
}

/* Entries of A B, each place of a column counted once. */
static int64_t count_product(const ritz_sparse *A, const ritz_sparse *B,
                             int64_t *mark)
{
    int64_t count = 0;

    for (int64_t j = 0; j < B->ncol; j++)
        for (int64_t q = B->colptr[j]; q < B->colptr[j + 1]; q++) {
            int64_t k = B->rowind[q];

            for (int64_t p = A->colptr[k]; p < A->colptr[k + 1]; p++)
                if (mark[A->rowind[p]] != j + 1) {
                    mark[A->rowind[p]] = j + 1;
                    count++;
                }
        }
    return count;
}

/* Column j of A B, as it comes: rows are put in order by transposing twice. */
static void multiply_column(const ritz_sparse *A, const ritz_sparse *B,
                            int64_t j, int64_t *place, ritz_sparse *C)
{
    int64_t first = C->colptr[j];
    int64_t at = first;

    for (int64_t q = B->colptr[j]; q < B->colptr[j + 1]; q++) {
        int64_t k = B->rowind[q];

        for (int64_t p = A->colptr[k]; p < A->colptr[k + 1]; p++) {
            int64_t i = A->rowind[p];

            if (place[i] <= first) { /* one more than where it lies */
                C->rowind[at] = i;
                C->val[at] = 0.0;
                place[i] = ++at;
            }
            C->val[place[i] - 1] += A->val[p] * B->val[q];
        }
    }
    C->colptr[j + 1] = at;
}

ritz_status ritz_sparse_product(const ritz_sparse *A, const ritz_sparse *B,
                                ritz_sparse *C)
{
    ritz_status status = RITZ_OK;
    ritz_sparse raw = {0}, turned = {0};
    int64_t *mark = NULL;
    int64_t *place = NULL;

    RITZ_FAIL_IF(A->ncol != B->nrow, RITZ_ERR_ARGUMENT,
                 "%" PRId64 " columns meet %" PRId64 " rows", A->ncol, B->nrow);
    RITZ_NEW(mark, A->nrow);
    RITZ_NEW(place, A->nrow);
    RITZ_TRY(
        ritz_sparse_new(A->nrow, B->ncol, count_product(A, B, mark), &raw));
    for (int64_t j = 0; j < B->ncol; j++)
        multiply_column(A, B, j, place, &raw);
    RITZ_TRY(ritz_sparse_transpose(&raw, &turned));
    RITZ_TRY(ritz_sparse_transpose(&turned, C));
done:
    free(mark);
    free(place);
    ritz_sparse_free(&raw);
    ritz_sparse_free(&turned);
    return status;
}

ritz_status ritz_sparse_congruence(const ritz_sparse *A, const ritz_sparse *T,
                                   ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    ritz_sparse AT = {0}, turned = {0}, C = {0};

    RITZ_TRY(ritz_sparse_product(A, T, &AT));
    RITZ_TRY(ritz_sparse_transpose(T, &turned));
    RITZ_TRY(ritz_sparse_product(&turned, &AT, &C));
    if (ritz_sparse_asymmetry(A) == 0.0)
        RITZ_TRY(ritz_sparse_symmetrise(&C));
    *out = C;
    C = (ritz_sparse){0};
done:
    ritz_sparse_free(&AT);
    ritz_sparse_free(&turned);
    ritz_sparse_free(&C);
    return status;
}

/* T'AT as it comes. */
static ritz_status condense(const ritz_sparse *A, const ritz_dense *T,
                            ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense AT = {0};

    RITZ_TRY(ritz_sparse_mul(A, T, &AT));
    RITZ_TRY(ritz_dense_mul_tn(T, &AT, out));
done:
    ritz_dense_free(&AT);
    return status;
}

ritz_status ritz_sparse_condense(const ritz_sparse *A, const ritz_dense *T,
                                 ritz_dense *out)
{
    RITZ_CHECK(condense(A, T, out));
    ritz_dense_symmetrise(out);
    return RITZ_OK;
}

ritz_status ritz_sparse_project(const ritz_sparse *A, const ritz_dense *T,
                                ritz_dense *out)
{
    if (!A->colptr)
        return RITZ_OK;
    RITZ_CHECK(condense(A, T, out));
    if (ritz_sparse_asymmetry(A) == 0.0)
        ritz_dense_symmetrise(out);
    return RITZ_OK;
}

ritz_status ritz_sparse_terms(const ritz_sparse *A, const ritz_dense *T,
                              ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_sparse size = {0};
    ritz_dense columns = {0};

    RITZ_TRY(ritz_sparse_copy(A, &size));
    for (int64_t k = 0; k < size.colptr[size.ncol]; k++)
        size.val[k] = fabs(size.val[k]);
    RITZ_TRY(ritz_dense_abs(T, &columns));
    RITZ_TRY(ritz_sparse_condense(&size, &columns, out));
done:
    ritz_sparse_free(&size);
    ritz_dense_free(&columns);
    return status;
}
