#include "bases/condense.h"

#include <float.h>
#include <math.h>

ritz_status ritz_condense_one(const ritz_sparse *A, const ritz_dense *T,
                              ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense AT = {0};

    RITZ_TRY(ritz_sparse_mul(A, T, &AT));
    RITZ_TRY(ritz_dense_mul_tn(T, &AT, out));
    ritz_dense_symmetrise(out);
done:
    ritz_dense_free(&AT);
    return status;
}

/* |T|'|K||T|, entries taken by their size. */
static ritz_status measure(const ritz_sparse *K, const ritz_dense *T,
                           ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_sparse size = {0};
    ritz_dense most = {0};

    RITZ_TRY(ritz_sparse_copy(K, &size));
    RITZ_TRY(ritz_dense_copy(T, &most));
    for (int64_t k = 0; k < size.colptr[size.ncol]; k++)
        size.val[k] = fabs(size.val[k]);
    for (int64_t k = 0; k < most.nrow * most.ncol; k++)
        most.val[k] = fabs(most.val[k]);
    RITZ_TRY(ritz_condense_one(&size, &most, out));
done:
    ritz_sparse_free(&size);
    ritz_dense_free(&most);
    return status;
}

ritz_status ritz_condense(const ritz_component *component,
                          const ritz_dense *T_b, ritz_dense *K, ritz_dense *M)
{
    /* sums of a few dozen terms in each of two products */
    const double rounding = 64.0 * DBL_EPSILON;
    ritz_status status = RITZ_OK;
    ritz_dense stiffness = {0}, mass = {0}, most = {0};

    RITZ_TRY(ritz_condense_one(&component->K, T_b, &stiffness));
    RITZ_TRY(ritz_condense_one(&component->M, T_b, &mass));
    RITZ_TRY(measure(&component->K, T_b, &most));
    for (int64_t k = 0; k < most.nrow * most.ncol; k++)
        if (fabs(stiffness.val[k]) <= rounding * most.val[k])
            stiffness.val[k] = 0.0;
    *K = stiffness;
    *M = mass;
    stiffness = mass = (ritz_dense){0};
done:
    ritz_dense_free(&stiffness);
    ritz_dense_free(&mass);
    ritz_dense_free(&most);
    return status;
}
