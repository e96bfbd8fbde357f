/*
 * Free-interface modes beside inertia-relief attachment modes: what the body
 * answers to unit forces F at its attached dofs while its rigid motion is
 * carried by its own inertia,
 *
 *     X = P' S P F,    P = I - M Phi_r Phi_r'    [CraigChang1977]
 *
 * which is Psi of macneal_rubin.c and the share of the kept flexible modes,
 *
 *     X = Psi + Phi_f Lambda_f^-1 Phi_f' F,
 *
 * so that both span the same. A column of which Psi is nothing is left out.
 */
#include "bases/free_modes.h"

/* Psi := X; columns of T come to be as large as what is exchanged for them. */
static ritz_status add_modes(ritz_free_set *set)
{
    ritz_status status = RITZ_OK;
    const ritz_pairs *modes = &set->modes;
    ritz_dense share = {0}, part = {0};

    RITZ_TRY(ritz_dense_mul_tn(&modes->Phi, &set->F, &share));
    for (int64_t j = 0; j < share.ncol; j++)
        for (int64_t k = 0; k < share.nrow; k++)
            ritz_dense_col(&share, j)[k] *=
                k < modes->num_rigid ? 0.0 : 1.0 / modes->lambda[k];
    RITZ_TRY(ritz_dense_mul(&modes->Phi, &share, &part));
    for (int64_t k = 0; k < part.nrow * part.ncol; k++)
        set->Psi.val[k] += part.val[k];
done:
    ritz_dense_free(&share);
    ritz_dense_free(&part);
    return status;
}

static ritz_status make(const ritz_request *request, ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    ritz_free_set set = {0};

    RITZ_TRY(ritz_free_set_find(request, RITZ_LOADS_ATTACHED, &set));
    if (set.Psi.ncol > 0)
        RITZ_TRY(add_modes(&set));
    RITZ_TRY(ritz_free_set_join(request, &set, RITZ_COLUMN_ATTACHMENT, out));
done:
    ritz_free_set_free(&set);
    return status;
}

const ritz_method ritz_method_inertia_relief = {
    .name = "inertia-relief",
    .summary = "rigid, free-interface and inertia-relief attachment modes",
    .reference = "CraigChang1977",
    .when = "as macneal-rubin, columns as older papers have them",
    .cost = "as macneal-rubin",
    .holds = "spans what macneal-rubin spans",
    .fails = "columns that are nearly parallel once many modes are kept",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED,
    .make = make,
};
