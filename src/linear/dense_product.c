/* Products of dense matrices, and what is made of two of them. */
#include <ritz/dense.h>

#include <cblas.h>
#include <inttypes.h>

/* C = op(A) op(B), m x q with p summed over. */
static ritz_status multiply(CBLAS_TRANSPOSE left, const ritz_dense *A,
                            CBLAS_TRANSPOSE right, const ritz_dense *B,
                            ritz_dense *C)
{
    int64_t m = left == CblasTrans ? A->ncol : A->nrow;
    int64_t p = left == CblasTrans ? A->nrow : A->ncol;
    int64_t rows = right == CblasTrans ? B->ncol : B->nrow;
    int64_t q = right == CblasTrans ? B->nrow : B->ncol;

    RITZ_REFUSE_IF(p != rows, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " columns meet %" PRId64 " rows", p, rows);
    RITZ_CHECK(ritz_dense_new(m, q, C));
    if (m > 0 && p > 0 && q > 0)
        cblas_dgemm(CblasColMajor, left, right, (int)m, (int)q, (int)p, 1.0,
                    A->val, (int)A->nrow, B->val, (int)B->nrow, 0.0, C->val,
                    (int)m);
    return RITZ_OK;
}

ritz_status ritz_dense_mul(const ritz_dense *A, const ritz_dense *B,
                           ritz_dense *C)
{
    return multiply(CblasNoTrans, A, CblasNoTrans, B, C);
}

ritz_status ritz_dense_mul_tn(const ritz_dense *A, const ritz_dense *B,
                              ritz_dense *C)
{
    return multiply(CblasTrans, A, CblasNoTrans, B, C);
}

ritz_status ritz_dense_mul_nt(const ritz_dense *A, const ritz_dense *B,
                              ritz_dense *C)
{
    return multiply(CblasNoTrans, A, CblasTrans, B, C);
}

double ritz_dense_dot(const ritz_dense *A, int64_t i, const ritz_dense *B,
                      int64_t j)
{
    const double *a = ritz_dense_col(A, i);
    const double *b = ritz_dense_col(B, j);
    double sum = 0.0;

    for (int64_t k = 0; k < A->nrow; k++)
        sum += a[k] * b[k];
    return sum;
}

ritz_status ritz_dense_take_out(const ritz_dense *left, const ritz_dense *right,
                                ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    ritz_dense part = {0}, gone = {0};

    RITZ_TRY(ritz_dense_mul_tn(right, X, &part));
    RITZ_TRY(ritz_dense_mul(left, &part, &gone));
    for (int64_t k = 0; k < X->nrow * X->ncol; k++)
        X->val[k] -= gone.val[k];
done:
    ritz_dense_free(&part);
    ritz_dense_free(&gone);
    return status;
}

ritz_status ritz_dense_congruence(const ritz_dense *A, const ritz_dense *B,
                                  ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense AB = {0};

    RITZ_TRY(ritz_dense_mul(A, B, &AB));
    RITZ_TRY(ritz_dense_mul_tn(B, &AB, out));
    ritz_dense_symmetrise(out);
done:
    ritz_dense_free(&AB);
    return status;
}

ritz_status ritz_dense_project(const ritz_dense *A, const ritz_dense *B,
                               ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense AB = {0};

    RITZ_TRY(ritz_dense_mul(A, B, &AB));
    RITZ_TRY(ritz_dense_mul_tn(B, &AB, out));
    if (ritz_dense_asymmetry(A) == 0.0)
        ritz_dense_symmetrise(out);
done:
    ritz_dense_free(&AB);
    return status;
}

ritz_status ritz_dense_terms(const ritz_dense *A, const ritz_dense *B,
                             ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense size = {0}, columns = {0};

    RITZ_TRY(ritz_dense_abs(A, &size));
    RITZ_TRY(ritz_dense_abs(B, &columns));
    RITZ_TRY(ritz_dense_project(&size, &columns, out));
done:
    ritz_dense_free(&size);
    ritz_dense_free(&columns);
    return status;
}
