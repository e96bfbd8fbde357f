/* Dofs that follow from those of a model: u_m = G u. */
#include "base/alloc.h"

#include <ritz/model.h>

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Dofs of rows, then recovered dofs. */
static ritz_status join_names(const ritz_recovery *recovery, int64_t n,
                              const ritz_dof *dof, ritz_dof **out)
{
    ritz_dof *all = NULL;

    RITZ_CHECK_NEW(all, n + recovery->count);
    if (n > 0)
        memcpy(all, dof, (size_t)n * sizeof *all);
    if (recovery->count > 0)
        memcpy(all + n, recovery->dof, (size_t)recovery->count * sizeof *all);
    *out = all;
    return RITZ_OK;
}

static ritz_status check_names(const ritz_recovery *recovery, int64_t n,
                               const ritz_dof *dof)
{
    RITZ_OWN_ARRAY ritz_dof *all = NULL;
    int64_t count = n + recovery->count;
    char name[RITZ_DOF_NAME_SIZE];

    RITZ_REFUSE_IF(n > 0 && !dof, RITZ_ERR_FORMAT,
                   "dofs are recovered from others that have no names");
    for (int64_t k = 0; k < recovery->count; k++)
        RITZ_REFUSE_IF(recovery->dof[k].component < 0 ||
                           recovery->dof[k].component > 6,
                       RITZ_ERR_FORMAT,
                       "a recovered dof has direction %" PRId64
                       ", which is not among 0 to 6",
                       recovery->dof[k].component);
    RITZ_CHECK(join_names(recovery, n, dof, &all));
    qsort(all, (size_t)count, sizeof *all, ritz_dof_compare);
    for (int64_t k = 1; k < count; k++)
        RITZ_REFUSE_IF(ritz_dof_compare(&all[k - 1], &all[k]) == 0,
                       RITZ_ERR_FORMAT,
                       "'%s' is recovered and has a row, or is recovered twice",
                       ritz_dof_name(all[k], name));
    return RITZ_OK;
}

ritz_status ritz_recovery_check(const ritz_recovery *recovery, int64_t n,
                                const ritz_dof *dof)
{
    const ritz_sparse *G = &recovery->G;

    if (recovery->count == 0)
        return RITZ_OK;
    RITZ_REFUSE_IF(!G->colptr || G->nrow != recovery->count || G->ncol != n,
                   RITZ_ERR_FORMAT,
                   "recovered dofs are of another size: %" PRId64 " x %" PRId64
                   " where %" PRId64 " x %" PRId64 " is due",
                   G->nrow, G->ncol, recovery->count, n);
    RITZ_CHECK(ritz_sparse_check(G, G->colptr[n]));
    return check_names(recovery, n, dof);
}

ritz_status ritz_recovery_copy(const ritz_recovery *recovery,
                               ritz_recovery *out)
{
    RITZ_OWN(ritz_recovery) copy = {.count = recovery->count};

    if (recovery->count == 0)
        return RITZ_OK;
    RITZ_CHECK_COPY(copy.dof, recovery->dof, recovery->count);
    RITZ_CHECK(ritz_sparse_copy(&recovery->G, &copy.G));
    RITZ_MOVE(*out, copy);
    return RITZ_OK;
}

ritz_status ritz_recovery_extend(const ritz_recovery *recovery, int64_t n,
                                 const ritz_dof *dof, const ritz_dense *T,
                                 ritz_dof **names, ritz_dense *shape)
{
    RITZ_OWN_ARRAY ritz_dof *all = NULL;
    RITZ_OWN(ritz_dense) GT = {0};

    RITZ_CHECK(join_names(recovery, n, dof, &all));
    if (shape && recovery->count > 0)
        RITZ_CHECK(ritz_sparse_mul(&recovery->G, T, &GT));
    if (shape) {
        RITZ_CHECK(ritz_dense_new(n + recovery->count, T->ncol, shape));
        ritz_dense_put(T, 0, 0, shape);
        ritz_dense_put(&GT, n, 0, shape);
    }
    RITZ_MOVE(*names, all);
    return RITZ_OK;
}

void ritz_recovery_free(ritz_recovery *recovery)
{
    free(recovery->dof);
    ritz_sparse_free(&recovery->G);
    *recovery = (ritz_recovery){0};
}
