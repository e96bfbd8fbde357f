#include "project.h"

#include "testing.h"

#include <ritz/eigen.h>

ritz_dense project(const ritz_sparse *A, const ritz_dense *T)
{
    ritz_dense AT = {0}, Ar = {0};

    assert_ok(ritz_sparse_mul(A, T, &AT));
    assert_ok(ritz_dense_mul_tn(T, &AT, &Ar));
    ritz_dense_free(&AT);
    return Ar;
}

void assert_hertz(const ritz_dense *K, const ritz_dense *M, int count,
                  const double *expected, double bound)
{
    ritz_pairs pairs = {0};

    assert_ok(ritz_eigen_dense(K, M, &pairs));
    assert_int_equal(pairs.Phi.ncol, count);
    for (int k = 0; k < count; k++)
        assert_near(fabs(ritz_eigen_hertz(pairs.lambda[k])), expected[k],
                    bound);
    ritz_pairs_free(&pairs);
}

const ritz_measure *find_measure(const ritz_measures *measures,
                                 const char *name)
{
    const ritz_measure *found = ritz_measures_find(measures, name);

    if (!found)
        fail_msg("there is no measure '%s'", name);
    return found;
}
