#include "linear/general.h"

#include "base/alloc.h"

#include <float.h>
#include <lapacke.h>
#include <stdlib.h>

ritz_status ritz_general_solve(const ritz_dense *A, bool transposed,
                               ritz_dense *X)
{
    int n = (int)A->nrow;
    RITZ_OWN(ritz_dense) LU = {0};
    RITZ_OWN_ARRAY lapack_int *pivot = NULL;
    double norm = 0.0;
    double rcond = 0.0;

    RITZ_REFUSE_IF(A->nrow != A->ncol || X->nrow != A->nrow, RITZ_ERR_ARGUMENT,
                   "a system of equations is not square");
    if (n == 0 || X->ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(A, &LU));
    RITZ_CHECK_NEW(pivot, n);
    norm = LAPACKE_dlange(LAPACK_COL_MAJOR, '1', n, n, LU.val, n);
    if (LAPACKE_dgetrf(LAPACK_COL_MAJOR, n, n, LU.val, n, pivot) == 0)
        (void)LAPACKE_dgecon(LAPACK_COL_MAJOR, '1', n, LU.val, n, norm, &rcond);
    RITZ_REFUSE_IF(!(rcond > DBL_EPSILON), RITZ_ERR_SINGULAR,
                   "a matrix is singular to working accuracy");
    (void)LAPACKE_dgetrs(LAPACK_COL_MAJOR, transposed ? 'T' : 'N', n,
                         (int)X->ncol, LU.val, n, pivot, X->val, n);
    return RITZ_OK;
}

double ritz_general_size(const ritz_dense *A)
{
    return LAPACKE_dlange(LAPACK_COL_MAJOR, 'F', (int)A->nrow, (int)A->ncol,
                          A->val, (int)A->nrow);
}

ritz_status ritz_general_symmetric(const ritz_dense *A, ritz_pairs *out)
{
    RITZ_OWN(ritz_dense) unit = {0};

    RITZ_CHECK(ritz_dense_new(A->nrow, A->nrow, &unit));
    for (int64_t k = 0; k < A->nrow; k++)
        ritz_dense_col(&unit, k)[k] = 1.0;
    return ritz_eigen_dense(A, &unit, out);
}

void ritz_general_place(double sign, const ritz_dense *A, bool transposed,
                        int64_t row, int64_t col, ritz_dense *to)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            *(transposed ? &ritz_dense_col(to, col + i)[row + j]
                         : &ritz_dense_col(to, col + j)[row + i]) =
                sign * ritz_dense_col(A, j)[i];
}

ritz_status ritz_general_transpose(const ritz_dense *A, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(A->ncol, A->nrow, out));
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(out, i)[j] = ritz_dense_col(A, j)[i];
    return RITZ_OK;
}

ritz_status ritz_general_svd(const ritz_dense *A, ritz_dense *U, double **s,
                             ritz_dense *V)
{
    int m = (int)A->nrow;
    int n = (int)A->ncol;
    int p = m < n ? m : n;
    RITZ_OWN(ritz_dense) copy = {0}, left = {0}, right = {0};
    RITZ_OWN_ARRAY double *values = NULL;
    int info = 0;

    RITZ_CHECK_NEW(values, p);
    RITZ_CHECK(ritz_dense_copy(A, &copy));
    RITZ_CHECK(ritz_dense_new(m, V ? m : p, &left));
    RITZ_CHECK(ritz_dense_new(V ? n : p, n, &right));
    if (p > 0)
        info =
            LAPACKE_dgesdd(LAPACK_COL_MAJOR, V ? 'A' : 'S', m, n, copy.val, m,
                           values, left.val, m, right.val, (int)right.nrow);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "singular values did not converge");
    if (V)
        RITZ_CHECK(ritz_general_transpose(&right, V));
    RITZ_MOVE(*U, left);
    RITZ_MOVE(*s, values);
    return RITZ_OK;
}

ritz_status ritz_general_singular(ritz_dense *A, double *sigma)
{
    int info = 0;

    if (A->nrow > 0 && A->ncol > 0)
        info = LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'N', (int)A->nrow, (int)A->ncol,
                              A->val, (int)A->nrow, sigma, NULL, 1, NULL, 1);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "singular values did not converge");
    return RITZ_OK;
}

ritz_status ritz_general_norm(ritz_dense *A, double *out)
{
    int64_t k = A->nrow < A->ncol ? A->nrow : A->ncol;
    RITZ_OWN_ARRAY double *sigma = NULL;

    RITZ_CHECK_NEW(sigma, k);
    RITZ_CHECK(ritz_general_singular(A, sigma));
    *out = k > 0 ? sigma[0] : 0.0;
    return RITZ_OK;
}
