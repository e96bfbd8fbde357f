#include "base/alloc.h"

#include <ritz/dampers.h>

#include <stdlib.h>
#include <string.h>

ritz_status ritz_dampers_new(int64_t n, int64_t count, ritz_dampers *out)
{
    ritz_status status = RITZ_OK;
    ritz_dampers dampers = {.count = count};

    RITZ_NEW(dampers.name, count);
    RITZ_NEW(dampers.c, count);
    RITZ_NEW(dampers.k, count);
    RITZ_TRY(ritz_dense_new(n, count, &dampers.B));
    *out = dampers;
    dampers = (ritz_dampers){0};
done:
    ritz_dampers_free(&dampers);
    return status;
}

ritz_status ritz_dampers_project(const ritz_dampers *dampers,
                                 const ritz_dense *T, ritz_dampers *out)
{
    ritz_status status = RITZ_OK;
    ritz_dampers projected = {0};
    size_t count = (size_t)dampers->count;

    if (count == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_dampers_new(0, dampers->count, &projected));
    memcpy(projected.name, dampers->name, count * sizeof *projected.name);
    memcpy(projected.c, dampers->c, count * sizeof *projected.c);
    memcpy(projected.k, dampers->k, count * sizeof *projected.k);
    ritz_dense_free(&projected.B);
    RITZ_TRY(ritz_dense_mul_tn(T, &dampers->B, &projected.B));
    *out = projected;
    projected = (ritz_dampers){0};
done:
    ritz_dampers_free(&projected);
    return status;
}

void ritz_dampers_free(ritz_dampers *dampers)
{
    free(dampers->name);
    free(dampers->c);
    free(dampers->k);
    ritz_dense_free(&dampers->B);
    *dampers = (ritz_dampers){0};
}
