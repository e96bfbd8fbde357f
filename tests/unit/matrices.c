#include "matrices.h"

#include "testing.h"

#include <ritz/eigen.h>

double entry(const ritz_sparse *A, int64_t i, int64_t j)
{
    for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
        if (A->rowind[p] == i)
            return A->val[p];
    return 0.0;
}

double norm_2(const ritz_dense *A)
{
    ritz_dense square = {0}, one = {0};
    ritz_pairs pairs = {0};
    double largest = 0.0;

    assert_ok(ritz_dense_mul_tn(A, A, &square));
    assert_ok(ritz_dense_new(A->ncol, A->ncol, &one));
    for (int64_t k = 0; k < A->ncol; k++)
        ritz_dense_col(&one, k)[k] = 1.0;
    assert_ok(ritz_eigen_dense(&square, &one, &pairs));
    largest = sqrt(pairs.lambda[pairs.Phi.ncol - 1]);
    ritz_pairs_free(&pairs);
    ritz_dense_free(&square);
    ritz_dense_free(&one);
    return largest;
}

double outside(const ritz_sparse *K, const ritz_dense *V, const ritz_dense *X)
{
    ritz_dense KX = {0}, H = {0}, part = {0};
    double worst = 0.0;

    assert_ok(ritz_sparse_mul(K, X, &KX));
    assert_ok(ritz_dense_mul_tn(V, &KX, &H));
    assert_ok(ritz_dense_mul(V, &H, &part));
    for (int64_t k = 0; k < X->nrow * X->ncol; k++)
        worst = fmax(worst, fabs(X->val[k] - part.val[k]));
    ritz_dense_free(&KX);
    ritz_dense_free(&H);
    ritz_dense_free(&part);
    return worst / ritz_dense_max(X);
}
