#include "bases/condense.h"

#include <float.h>
#include <math.h>

ritz_status ritz_condense(const ritz_component *component,
                          const ritz_dense *T_b, ritz_dense *K, ritz_dense *M)
{
    /* sums of a few dozen terms in each of two products */
    const double rounding = 64.0 * DBL_EPSILON;
    ritz_status status = RITZ_OK;
    ritz_dense stiffness = {0}, mass = {0}, most = {0};

    RITZ_TRY(ritz_sparse_condense(&component->K, T_b, &stiffness));
    RITZ_TRY(ritz_sparse_condense(&component->M, T_b, &mass));
    RITZ_TRY(ritz_sparse_terms(&component->K, T_b, &most));
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
