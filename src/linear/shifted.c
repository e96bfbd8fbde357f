#include "linear/shifted.h"
#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* X := X Q. */
static ritz_status rotate_vectors(const ritz_dense *Q, ritz_dense *X)
{
    ritz_dense XQ = {0};

    RITZ_CHECK(ritz_dense_mul(X, Q, &XQ));
    ritz_dense_free(X);
    *X = XQ;
    return RITZ_OK;
}

/* A_r := (A_r + A_r') / 2, with unit diagonal of M_r: Y_j / |Y_j|_M. */
static void balance_projection(ritz_dense *A_r, ritz_dense *M_r, ritz_dense *Y)
{
    int64_t k = Y->ncol;

    for (int64_t j = 0; j < k; j++) {
        double size = sqrt(ritz_dense_col(M_r, j)[j]);

        if (!(size > 0.0))
            continue;
        for (int64_t i = 0; i < k; i++) {
            A_r->val[i + j * k] /= size;
            M_r->val[i + j * k] /= size;
            A_r->val[j + i * k] /= size;
            M_r->val[j + i * k] /= size;
        }
        for (int64_t i = 0; i < Y->nrow; i++)
            ritz_dense_col(Y, j)[i] /= size;
    }
    ritz_dense_symmetrise(A_r);
}

/*
 * theta = q' A_r q of each column: nearly diagonal, so even the lowest comes
 * without the rounding of the highest that the small eigenproblem leaves.
 */
static ritz_status find_quotients(const ritz_dense *A_r, const ritz_dense *Q,
                                  double *theta)
{
    RITZ_OWN(ritz_dense) AQ = {0};

    RITZ_CHECK(ritz_dense_mul(A_r, Q, &AQ));
    for (int64_t j = 0; j < Q->ncol; j++) {
        theta[j] = 0.0;
        for (int64_t i = 0; i < Q->nrow; i++)
            theta[j] += ritz_dense_col(Q, j)[i] * ritz_dense_col(&AQ, j)[i];
    }
    return RITZ_OK;
}

/*
 *     A Y = M X,   A_r = Y' (M X),   M_r = Y' M Y,   A_r q = theta M_r q
 *
 * A Y is known without a product by A: with one, x' A x would lose all digits
 * of a soft mode, x' |A| |x| being that much larger.
 */
ritz_status ritz_shifted_polish(const ritz_shifted *S, ritz_dense *X,
                                double *lambda)
{
    RITZ_OWN(ritz_dense) MX = {0}, MY = {0}, A_r = {0}, M_r = {0};
    RITZ_OWN(ritz_pairs) small = {0};

    RITZ_CHECK(ritz_sparse_mul(S->M, X, &MX));
    memcpy(X->val, MX.val, (size_t)(X->nrow * X->ncol) * sizeof *X->val);
    RITZ_CHECK(ritz_factor_solve(S->A, X)); /* X is Y now */
    RITZ_CHECK(ritz_dense_mul_tn(X, &MX, &A_r));
    RITZ_CHECK(ritz_sparse_mul(S->M, X, &MY));
    RITZ_CHECK(ritz_dense_mul_tn(X, &MY, &M_r));
    balance_projection(&A_r, &M_r, X);
    RITZ_CHECK(ritz_eigen_dense(&A_r, &M_r, &small));
    RITZ_REFUSE_IF(small.Phi.ncol < X->ncol, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " eigenvectors depend on each other",
                   X->ncol - small.Phi.ncol);
    RITZ_CHECK(rotate_vectors(&small.Phi, X));
    RITZ_CHECK(find_quotients(&A_r, &small.Phi, lambda));
    for (int64_t j = 0; j < X->ncol; j++)
        lambda[j] += S->sigma;
    return RITZ_OK;
}
