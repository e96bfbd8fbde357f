/* Between sparse and dense. */
#include <ritz/dense.h>
#include <ritz/sparse.h>

ritz_status ritz_sparse_dense(const ritz_sparse *A, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(A->nrow, A->ncol, out));
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            ritz_dense_col(out, j)[A->rowind[p]] = A->val[p];
    return RITZ_OK;
}

ritz_status ritz_sparse_from_dense(const ritz_dense *A, ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    ritz_sparse made = {0};
    int64_t count = 0;

    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        count += A->val[k] != 0.0;
    RITZ_TRY(ritz_sparse_new(A->nrow, A->ncol, count, &made));
    count = 0;
    for (int64_t j = 0; j < A->ncol; j++) {
        for (int64_t i = 0; i < A->nrow; i++)
            if (ritz_dense_col(A, j)[i] != 0.0) {
                made.rowind[count] = i;
                made.val[count++] = ritz_dense_col(A, j)[i];
            }
        made.colptr[j + 1] = count;
    }
    *out = made;
    made = (ritz_sparse){0};
done:
    ritz_sparse_free(&made);
    return status;
}
