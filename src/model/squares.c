#include "model/squares.h"

#include "base/alloc.h"

#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool ritz_configuration_is_square(const ritz_configuration *configuration,
                                  int64_t k)
{
    const ritz_configuration *c = configuration;

    return k >= c->num_rigid && c->lambda[k] < 0.0 &&
           ritz_measures_find(&c->errors, RITZ_NEGATIVE_SQUARES);
}

/* Reorder values: value[j] becomes value[order[j]]. */
static ritz_status order_values(int64_t count, const int64_t *order,
                                double *value)
{
    RITZ_OWN_ARRAY double *copy = NULL;

    RITZ_CHECK_COPY(copy, value, count);
    for (int64_t j = 0; j < count; j++)
        value[j] = copy[order[j]];
    return RITZ_OK;
}

ritz_status ritz_pairs_by_size(ritz_pairs *pairs)
{
    const int64_t e = pairs->Phi.ncol;
    RITZ_OWN(ritz_dense) Phi = {0};
    RITZ_OWN_ARRAY int64_t *order = NULL;
    RITZ_OWN_ARRAY double *size = NULL;

    RITZ_CHECK_NEW(order, e);
    RITZ_CHECK_NEW(size, e);
    for (int64_t j = 0; j < e; j++) {
        int64_t k = j;

        for (; k > 0 && size[k - 1] > fabs(pairs->lambda[j]); k--) {
            size[k] = size[k - 1];
            order[k] = order[k - 1];
        }
        size[k] = fabs(pairs->lambda[j]);
        order[k] = j;
    }
    RITZ_CHECK(ritz_dense_pick(&pairs->Phi, e, order, &Phi));
    RITZ_CHECK(order_values(e, order, pairs->lambda));
    RITZ_CHECK(order_values(e, order, pairs->residual));
    pairs->num_rigid = ritz_eigen_rigid(e, size, e > 0 ? size[e - 1] : 0.0);
    ritz_dense_replace(&pairs->Phi, &Phi);
    return RITZ_OK;
}
