#include "project.h"

#include "testing.h"

ritz_dense project(const ritz_sparse *A, const ritz_dense *T)
{
    ritz_dense AT = {0}, Ar = {0};

    assert_ok(ritz_sparse_mul(A, T, &AT));
    assert_ok(ritz_dense_mul_tn(T, &AT, &Ar));
    ritz_dense_free(&AT);
    return Ar;
}
