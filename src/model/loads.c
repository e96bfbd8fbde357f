/* Geometric stiffness of unit loads in other coordinates, u = T q: T'KG T. */
#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/model.h>

#include <stdlib.h>
#include <string.h>

RITZ_ARRAY_OF(ritz_reduced_load);

ritz_status ritz_loads_reduce(int64_t count, const ritz_load *load,
                              const ritz_dense *T, ritz_reduced_load **out)
{
    RITZ_OWN(ritz_reduced_load_array) made = {.count = count};

    if (count == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(made.at, count);
    for (int64_t k = 0; k < count; k++) {
        memcpy(made.at[k].name, load[k].name, sizeof load[k].name);
        RITZ_CHECK_IN(load[k].name,
                      ritz_sparse_project(&load[k].KG, T, &made.at[k].KG));
    }
    RITZ_MOVE(*out, made.at);
    return RITZ_OK;
}

ritz_status ritz_loads_project(int64_t count, const ritz_reduced_load *load,
                               const ritz_dense *V, ritz_reduced_load **out)
{
    RITZ_OWN(ritz_reduced_load_array) made = {.count = count};

    if (count == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(made.at, count);
    for (int64_t k = 0; k < count; k++) {
        memcpy(made.at[k].name, load[k].name, sizeof load[k].name);
        RITZ_CHECK(V ? ritz_dense_congruence(&load[k].KG, V, &made.at[k].KG)
                     : ritz_dense_copy(&load[k].KG, &made.at[k].KG));
    }
    RITZ_MOVE(*out, made.at);
    return RITZ_OK;
}

ritz_status ritz_reduced_load_settle(ritz_reduced_load *load)
{
    const double asymmetry = ritz_dense_asymmetry(&load->KG);

    RITZ_REFUSE_IF(asymmetry > RITZ_SYMMETRIC_SOURCE, RITZ_ERR_FORMAT,
                   "geometric stiffness is unsymmetric by %.1e of its largest "
                   "entry, %.0e is let pass",
                   asymmetry, RITZ_SYMMETRIC_SOURCE);
    if (asymmetry > 0.0)
        ritz_dense_symmetrise(&load->KG);
    return RITZ_OK;
}

void ritz_reduced_load_free(ritz_reduced_load *load)
{
    ritz_dense_free(&load->KG);
    *load = (ritz_reduced_load){0};
}
