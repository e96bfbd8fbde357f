/*
 * Rubin's reduction [Rubin1975]: free-interface modes and residual flexibility
 * with its inertia, in coordinates that include the attached displacements u_b.
 * With Psi and Phi of macneal_rubin.c and Psi_bb = F'Psi
 *
 *     u = Phi q + Psi p,   u_b = Phi_b q + Psi_bb p
 *     T = [G, Phi - G Phi_b],   G = Psi Psi_bb^-1,   u = T [u_b; q]
 *
 * It spans the same space as macneal-rubin. The columns of q vanish at b, so
 * that those of rigid modes store energy: they are of kind normal like the
 * others.
 *
 * Psi_bb has an inverse on independent columns only; the dofs of columns that
 * free_modes.c removes are no coordinates, and the remark names them.
 */
#include "base/alloc.h"
#include "bases/columns.h"
#include "bases/free_modes.h"
#include "bases/loads.h"

#include <cblas.h>
#include <lapacke.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAMED = 3 };

/* The columns of Psi that stay, and the rows they attach. */
static ritz_status pick_columns(const ritz_free_set *set, ritz_dense *Psi,
                                int64_t *b)
{
    int64_t k = 0;

    RITZ_CHECK(ritz_dense_new(set->Psi.nrow, set->kept, Psi));
    for (int64_t j = 0; j < set->Psi.ncol; j++) {
        const ritz_dense column = ritz_dense_part(&set->Psi, j, 1);

        if (!set->keep[j])
            continue;
        b[k] = set->dof[j];
        ritz_dense_put(&column, 0, k++, Psi);
    }
    return RITZ_OK;
}

/* G = Psi Psi_bb^-1, Psi_bb = S L L' S with a unit diagonal within. */
static ritz_status divide_residual(const int64_t *b, ritz_dense *Psi)
{
    RITZ_OWN(ritz_dense) F = {0};
    RITZ_OWN_ARRAY double *scale = NULL;
    int n = (int)Psi->nrow;
    int p = (int)Psi->ncol;

    RITZ_CHECK_NEW(scale, p);
    RITZ_CHECK(ritz_dense_rows(Psi, p, b, &F));
    ritz_dense_symmetrise(&F);
    for (int64_t j = 0; j < p; j++)
        scale[j] = 1.0 / sqrt(ritz_dense_col(&F, j)[j]);
    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(&F, j)[i] *= scale[i] * scale[j];
    RITZ_REFUSE_IF(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', p, F.val, p) != 0,
                   RITZ_ERR_SINGULAR,
                   "residual flexibility of the attached dofs is singular: "
                   "keep fewer modes, or a larger --tolerance");
    for (int64_t j = 0; j < p; j++)
        cblas_dscal(n, scale[j], ritz_dense_col(Psi, j), 1);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit,
                n, p, 1.0, F.val, p, Psi->val, n);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasNoTrans,
                CblasNonUnit, n, p, 1.0, F.val, p, Psi->val, n);
    for (int64_t j = 0; j < p; j++)
        cblas_dscal(n, scale[j], ritz_dense_col(Psi, j), 1);
    return RITZ_OK;
}

/*
 * T = [G, Phi - G Phi_b]. The rows of G are those of I, and those of
 * Phi - G Phi_b zero, where they are so exactly.
 */
static ritz_status fill_basis(const ritz_dense *Phi, const int64_t *b,
                              ritz_dense *G, ritz_dense *T)
{
    RITZ_OWN(ritz_dense) Phi_b = {0};
    int64_t n = G->nrow;
    int64_t p = G->ncol;

    RITZ_CHECK(ritz_dense_rows(Phi, p, b, &Phi_b));
    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(G, j)[b[i]] = i == j ? 1.0 : 0.0;
    ritz_dense_put(G, 0, 0, T);
    ritz_dense_put(Phi, 0, p, T);
    if (Phi->ncol > 0)
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, (int)n,
                    (int)Phi->ncol, (int)p, -1.0, G->val, (int)n, Phi_b.val,
                    (int)p, 1.0, ritz_dense_col(T, p), (int)n);
    for (int64_t j = p; j < T->ncol; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(T, j)[b[i]] = 0.0;
    return RITZ_OK;
}

/* Name the dofs that are no coordinates: "grid 3 T1, grid 7 T1". */
static void add_remark(const ritz_request *request, const ritz_free_set *set,
                       ritz_basis *basis)
{
    char text[NAMED * (RITZ_LOADS_NAME_SIZE + 2)] = "";
    char name[RITZ_LOADS_NAME_SIZE];
    size_t used = 0;
    int64_t count = 0;

    for (int64_t j = 0; j < set->Psi.ncol; j++)
        if (!set->keep[j] && count++ < NAMED)
            used += (size_t)snprintf(
                text + used, sizeof text - used, "%s%s", used > 0 ? ", " : "",
                ritz_loads_name(request, set->loads, j, name));
    if (count > 0)
        snprintf(basis->remark, sizeof basis->remark,
                 "%" PRId64
                 " attached dof(s) are no coordinates, %.80s%s: their "
                 "residual flexibility depends on others, or is negligible "
                 "relative to the kept modes",
                 count, text, count > NAMED ? ", ..." : "");
}

static ritz_status make_rubin(const ritz_request *request, ritz_basis *out)
{
    RITZ_OWN(ritz_free_set) set = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_dense) G = {0};
    RITZ_OWN_ARRAY int64_t *b = NULL;
    const ritz_pairs *modes = &set.modes;

    RITZ_CHECK(ritz_free_set_find(request, RITZ_LOADS_ATTACHED, &set));
    if (set.kept == 0) { /* then the modes are all there is */
        RITZ_CHECK(
            ritz_free_set_join(request, &set, RITZ_COLUMN_RESIDUAL, out));
        add_remark(request, &set, out);
        return RITZ_OK;
    }
    RITZ_CHECK_NEW(b, set.Psi.ncol);
    RITZ_CHECK(pick_columns(&set, &G, b));
    RITZ_CHECK(divide_residual(b, &G));
    RITZ_CHECK(ritz_basis_new(G.nrow, G.ncol + modes->Phi.ncol, &basis));
    RITZ_CHECK(fill_basis(&modes->Phi, b, &G, &basis.T));
    ritz_columns_label_dofs(G.ncol, b, 0, &basis.columns);
    ritz_columns_label(modes, RITZ_COLUMN_NORMAL, G.ncol, &basis.columns);
    for (int64_t j = G.ncol; j < G.ncol + modes->num_rigid; j++) {
        basis.columns.kind[j] = RITZ_COLUMN_NORMAL; /* and no longer rigid */
        basis.columns.hertz[j] = nan("");
    }
    memcpy(basis.origin.engine, modes->engine, sizeof basis.origin.engine);
    add_remark(request, &set, &basis);
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

const ritz_method ritz_method_rubin = {
    .name = "rubin",
    .summary = "attached dofs themselves, free-interface modes within",
    .reference = "Rubin1975",
    .when = "as macneal-rubin, for codes that want attached dofs as "
            "coordinates",
    .cost = "as macneal-rubin",
    .holds = "spans what macneal-rubin spans",
    .fails = "nearly all modes kept: what is left at the interface is rounding",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED,
    .make = make_rubin,
};
