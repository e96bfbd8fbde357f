/*
 * What free-interface methods share: with the lowest modes of (K, M), rigid
 * ones first, and residual modes of loads F (residual.c),
 *
 *     K Phi = M Phi Lambda,   Phi' M Phi = I,
 *     K Psi = (I - M Phi Phi') F,   Phi' M Psi = 0,   T = [Phi, Psi]
 *
 * so that T'KT and T'MT are block diagonal, and the flexible static answer to F
 * where F acts is exact.
 */
#include "bases/free_modes.h"

#include "base/alloc.h"
#include "bases/loads.h"
#include "bases/residual.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ritz_status find_modes(const ritz_request *request, ritz_pairs *out)
{
    const ritz_component *component = request->component;
    const ritz_span span = {request->modes, request->up_to_hz};

    RITZ_CHECK_IN("free-interface modes",
                  ritz_eigen_sparse(&component->K, &component->M, &span, out));
    RITZ_REFUSE_IF(out->Phi.ncol > 0 && out->num_rigid == 0 &&
                       out->lambda[0] <= 0.0,
                   RITZ_ERR_SINGULAR,
                   "K is not positive semidefinite: an eigenvalue is %.3g",
                   out->lambda[0]);
    return RITZ_OK;
}

ritz_status ritz_free_set_find(const ritz_request *request, int loads,
                               ritz_free_set *out)
{
    ritz_status status = RITZ_OK;
    ritz_free_set set = {.loads = loads};
    ritz_dofs rest = {0};

    /* refuses attached dofs that are out of range or repeated */
    RITZ_TRY(ritz_dofs_complement(&request->attached,
                                  request->component->num_dofs, &rest));
    RITZ_TRY(find_modes(request, &set.modes));
    if (ritz_loads_count(request, loads) > 0) {
        RITZ_TRY(ritz_loads_collect(request, loads, &set.F, &set.dof));
        RITZ_NEW(set.keep, set.F.ncol);
        RITZ_TRY(ritz_residual_modes(request, &set.modes, &set.F, &set.Psi,
                                     set.keep));
    }
    *out = set;
    set = (ritz_free_set){0};
done:
    ritz_dofs_free(&rest);
    ritz_free_set_free(&set);
    return status;
}

int64_t ritz_free_set_kept(const ritz_free_set *set)
{
    int64_t kept = 0;

    for (int64_t j = 0; j < set->Psi.ncol; j++)
        kept += set->keep[j];
    return kept;
}

static void remark(const ritz_request *request, const ritz_free_set *set,
                   ritz_column_kind kind, ritz_basis *basis)
{
    char name[RITZ_LOADS_NAME_SIZE] = "";
    int64_t left_out = 0;

    for (int64_t j = 0; j < set->Psi.ncol; j++)
        if (!set->keep[j] && left_out++ == 0)
            ritz_loads_name(request, set->loads, j, name);
    if (left_out > 0)
        snprintf(basis->remark, sizeof basis->remark,
                 "%" PRId64 " %s mode(s) left out, the first of %s: "
                 "dependent, or nothing beside the kept modes",
                 left_out, ritz_column_name(kind), name);
}

ritz_status ritz_free_set_join(const ritz_request *request,
                               const ritz_free_set *set, ritz_column_kind kind,
                               ritz_basis *out)
{
    const ritz_pairs *modes = &set->modes;
    size_t column = (size_t)modes->Phi.nrow * sizeof *modes->Phi.val;
    ritz_columns *columns = &out->columns;
    int64_t k = modes->Phi.ncol;

    RITZ_CHECK(ritz_basis_new(request->component->num_dofs,
                              k + ritz_free_set_kept(set), out));
    for (int64_t j = 0; j < k; j++) {
        bool rigid = j < modes->num_rigid;

        columns->kind[j] = rigid ? RITZ_COLUMN_RIGID : RITZ_COLUMN_NORMAL;
        columns->hertz[j] = rigid ? 0.0 : ritz_eigen_hertz(modes->lambda[j]);
        columns->residual[j] = modes->residual[j];
        memcpy(ritz_dense_col(&out->T, j), ritz_dense_col(&modes->Phi, j),
               column);
    }
    for (int64_t j = 0; j < set->Psi.ncol; j++) {
        if (!set->keep[j])
            continue;
        columns->kind[k] = kind;
        columns->dof[k] = set->dof[j];
        memcpy(ritz_dense_col(&out->T, k++), ritz_dense_col(&set->Psi, j),
               column);
    }
    memcpy(out->origin.engine, modes->engine, sizeof out->origin.engine);
    remark(request, set, kind, out);
    return RITZ_OK;
}

ritz_status ritz_free_basis(const ritz_request *request, int loads,
                            ritz_column_kind kind, ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    ritz_free_set set = {0};

    RITZ_TRY(ritz_free_set_find(request, loads, &set));
    RITZ_TRY(ritz_free_set_join(request, &set, kind, out));
done:
    ritz_free_set_free(&set);
    return status;
}

void ritz_free_set_free(ritz_free_set *set)
{
    ritz_pairs_free(&set->modes);
    ritz_dense_free(&set->F);
    ritz_dense_free(&set->Psi);
    free(set->dof);
    free(set->keep);
    *set = (ritz_free_set){0};
}
