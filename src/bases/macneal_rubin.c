/*
 * MacNeal-Rubin reduction: free-interface modes and residual attachment modes.
 *
 * Keep the rigid modes Phi_r and the lowest flexible ones Phi_f of (K, M), and
 * add what the modes that are left out answer to unit forces F at the attached
 * dofs [LeeTsuha1992, eq. 6]:
 *
 *     Psi = (P' S P - Phi_f Lambda_f^-1 Phi_f') F,    P = I - M Phi_r Phi_r'
 *
 * S is the pseudo-flexibility of any determinate support, of which Psi is
 * independent: residual.c finds it without one. Psi is M- and K-orthogonal to
 * the kept modes, so that T'KT and T'MT are block diagonal, and the flexible
 * static gain at the attached dofs is exact. tests/unit/test_macneal_rubin.c
 * holds the code to the printed formula with three supports.
 */
#include "base/alloc.h"
#include "bases/residual.h"

#include <ritz/eigen.h>
#include <ritz/method.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void remark(const ritz_request *request, const bool *keep,
                   ritz_basis *basis)
{
    char name[RITZ_DOF_NAME_SIZE] = "";
    int64_t left_out = 0;

    for (int64_t j = 0; j < request->attached.count; j++)
        if (!keep[j] && left_out++ == 0)
            ritz_dof_name(request->component->dof[request->attached.at[j]],
                          name);
    if (left_out > 0)
        snprintf(basis->remark, sizeof basis->remark,
                 "%" PRId64 " residual mode(s) left out, the first of %s: "
                 "dependent, or nothing beside the kept modes",
                 left_out, name);
}

/* Rigid, normal, residual. */
static ritz_status join(const ritz_request *request, const ritz_pairs *modes,
                        const ritz_dense *Psi, const bool *keep,
                        ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    int64_t n = request->component->num_dofs;
    int64_t k = modes->Phi.ncol;
    int64_t r = k;
    ritz_columns *columns = &out->columns;

    for (int64_t j = 0; j < request->attached.count; j++)
        r += keep[j];
    RITZ_TRY(ritz_basis_new(n, r, out));
    for (int64_t j = 0; j < k; j++) {
        bool rigid = j < modes->num_rigid;

        columns->kind[j] = rigid ? RITZ_COLUMN_RIGID : RITZ_COLUMN_NORMAL;
        columns->hertz[j] = rigid ? 0.0 : ritz_eigen_hertz(modes->lambda[j]);
        columns->residual[j] = modes->residual[j];
        memcpy(ritz_dense_col(&out->T, j), ritz_dense_col(&modes->Phi, j),
               (size_t)n * sizeof *out->T.val);
    }
    for (int64_t j = 0; j < request->attached.count; j++) {
        if (!keep[j])
            continue;
        columns->kind[k] = RITZ_COLUMN_RESIDUAL;
        columns->dof[k] = request->attached.at[j];
        memcpy(ritz_dense_col(&out->T, k++), ritz_dense_col(Psi, j),
               (size_t)n * sizeof *out->T.val);
    }
    memcpy(out->origin.engine, modes->engine, sizeof out->origin.engine);
    remark(request, keep, out);
done:
    return status;
}

static ritz_status make(const ritz_request *request, ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    const ritz_component *component = request->component;
    const ritz_span span = {request->modes, request->up_to_hz};
    ritz_pairs modes = {0};
    ritz_dense Psi = {0};
    ritz_dofs rest = {0};
    bool *keep = NULL;

    /* refuses attached dofs that are out of range or repeated */
    RITZ_TRY(
        ritz_dofs_complement(&request->attached, component->num_dofs, &rest));
    RITZ_NEW(keep, request->attached.count);
    RITZ_TRY_IN("free-interface modes",
                ritz_eigen_sparse(&component->K, &component->M, &span, &modes));
    RITZ_FAIL_IF(modes.Phi.ncol > 0 && modes.num_rigid == 0 &&
                     modes.lambda[0] <= 0.0,
                 RITZ_ERR_SINGULAR,
                 "K is not positive semidefinite: an eigenvalue is %.3g",
                 modes.lambda[0]);
    if (request->attached.count > 0)
        RITZ_TRY(ritz_residual_modes(request, &modes, &Psi, keep));
    RITZ_TRY(join(request, &modes, &Psi, keep, out));
done:
    ritz_pairs_free(&modes);
    ritz_dense_free(&Psi);
    ritz_dofs_free(&rest);
    free(keep);
    return status;
}

const ritz_method ritz_method_macneal_rubin = {
    .name = "macneal-rubin",
    .summary = "rigid, free-interface and residual attachment modes",
    .reference = "LeeTsuha1992",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED,
    .make = make,
};
