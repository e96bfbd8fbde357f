
#include "bases/partition.h"

#include "base/tolerances.h"

#include <ritz/matrix.h>

#include <stdbool.h>
#include <string.h>

/* The number of kept modes: a cluster at the end is kept whole. */
static int64_t count_kept(const ritz_pairs *modes, int64_t wanted)
{
    int64_t all = modes->Phi.ncol;
    int64_t kept = modes->num_rigid + wanted;

    if (wanted >= all - modes->num_rigid)
        return all;
    while (kept > modes->num_rigid && kept < all &&
           modes->lambda[kept] - modes->lambda[kept - 1] <=
               RITZ_CLUSTER_GAP * modes->lambda[kept])
        kept++;
    return kept;
}

/*
 * Modes of the component condensed to its attached dofs,
 *
 *     (T_b'KT_b) Phi = (T_b'MT_b) Phi Lambda,
 *
 * all rigid ones and the lowest request->choice.interface_modes others; a
 * cluster (relative gap below 1e-6) at the end is kept whole.
 *
 * @param[in]  T_b  n x b, [I; Psi]: constraint modes
 * @param[out] out  Phi is b x k
 * @return RITZ_ERR_SINGULAR
 * @cost   O(b^3) beside the condensation
 * @see    [CastanierTanPierre2001]
 */
static ritz_status condense_interface(const ritz_request *request,
                                      const ritz_dense *T_b, ritz_pairs *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense K = {0}, M = {0}, Phi = {0};
    ritz_pairs modes = {0};

    RITZ_TRY(ritz_condense(request->component, T_b, &K, &M));
    RITZ_TRY(ritz_eigen_dense(&K, &M, &modes));
    RITZ_TRY(ritz_dense_columns(
        &modes.Phi, 0, count_kept(&modes, request->choice.interface_modes),
        &Phi));
    ritz_dense_free(&modes.Phi);
    RITZ_MOVE(modes.Phi, Phi);
    RITZ_MOVE(*out, modes);
done:
    ritz_dense_free(&K);
    ritz_dense_free(&M);
    ritz_dense_free(&Phi);
    ritz_pairs_free(&modes);
    return ritz_context(status, "interface modes");
}

/*
 * Craig-Bampton reduction: constraint modes and fixed-interface normal modes.
 *
 * Split the dofs into boundary b, on which other bodies act, and interior i:
 *
 *     | u_b |   | I    0   | | u_b |      K_ii Psi = -K_ib
 *     | u_i | = | Psi  Phi | | q   |      K_ii Phi =  M_ii Phi Lambda
 *
 * Psi is the static response to unit boundary motion, Phi the lowest modes with
 * the boundary clamped, scaled to Phi' M_ii Phi = I. T' K T is then block
 * diagonal, and no eigenvalue of (T' K T, T' M T) lies below its
 * counterpart in (K, M): tests/unit/bases/test_craig_bampton.c tests both.
 *
 * A boundary of many dofs may move in a few characteristic constraint modes
 * instead, u_b = Phi_c q_c [CastanierTanPierre2001].
 *
 * [CraigBampton1968] R. R. Craig and M. C. C. Bampton, Coupling of
 * substructures for dynamic analyses, AIAA Journal 6 (1968) 1313-1319.
 */

/* The requested number of modes, or all up to the requested frequency. */
static ritz_status find_normal_modes(const ritz_request *request,
                                     const ritz_partition *s, ritz_pairs *out)
{
    ritz_status status = RITZ_OK;
    const ritz_span span = {request->modes, request->up_to_hz};

    RITZ_TRY(ritz_eigen_sparse(&s->K_ii, &s->M_ii, &span, out));
    if (out->num_rigid > 0)
        status =
            ritz_mechanism_refuse(s->component, &s->K_ii, &s->M_ii, &s->i, -1);
done:
    return ritz_context(status, "fixed-interface modes");
}

/* [I; Psi]: a column for each boundary dof. */
static ritz_status find_boundary(const ritz_partition *s, ritz_basis *out)
{
    const ritz_dofs *b = s->b;
    RITZ_OWN(ritz_factor) *L = NULL;
    RITZ_OWN(ritz_dense) Psi = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(ritz_partition_factor(s, &L));
    RITZ_CHECK(ritz_partition_constraint_modes(s, L, &Psi));
    RITZ_CHECK(ritz_basis_new(s->component->num_dofs, b->count, &basis));
    ritz_partition_scatter(&Psi, &s->i, 0, &basis.T);
    for (int64_t j = 0; j < b->count; j++) {
        ritz_dense_col(&basis.T, j)[b->at[j]] = 1.0;
        basis.columns.kind[j] = RITZ_COLUMN_CONSTRAINT;
        basis.columns.dof[j] = b->at[j];
    }
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

/* [I; Psi] Phi_c instead, with the characteristic constraint modes Phi_c. */
static ritz_status reduce_boundary(const ritz_request *request,
                                   ritz_basis *boundary)
{
    RITZ_OWN(ritz_pairs) modes = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(condense_interface(request, &boundary->T, &modes));
    RITZ_CHECK(ritz_columns_new(modes.Phi.ncol, &basis.columns));
    RITZ_CHECK(ritz_dense_mul(&boundary->T, &modes.Phi, &basis.T));
    for (int64_t j = 0; j < modes.Phi.ncol; j++) {
        bool rigid = j < modes.num_rigid;

        basis.columns.kind[j] =
            rigid ? RITZ_COLUMN_RIGID : RITZ_COLUMN_INTERFACE;
        basis.columns.hertz[j] =
            rigid ? 0.0 : ritz_eigen_hertz(modes.lambda[j]);
        basis.columns.residual[j] = modes.residual[j];
    }
    ritz_basis_free(boundary);
    RITZ_MOVE(*boundary, basis);
    return RITZ_OK;
}

/* The boundary's columns first, then [0; Phi]. */
static ritz_status join_columns(const ritz_partition *s,
                                const ritz_basis *boundary,
                                const ritz_pairs *modes, ritz_basis *out)
{
    const ritz_columns *first = &boundary->columns;
    const ritz_dense *T_b = &boundary->T;
    int64_t r = first->count;
    ritz_columns *columns = &out->columns;

    RITZ_CHECK(
        ritz_basis_new(s->component->num_dofs, r + modes->Phi.ncol, out));
    for (int64_t j = 0; j < r; j++) {
        columns->kind[j] = first->kind[j];
        columns->dof[j] = first->dof[j];
        columns->hertz[j] = first->hertz[j];
        columns->residual[j] = first->residual[j];
        memcpy(ritz_dense_col(&out->T, j), ritz_dense_col(T_b, j),
               (size_t)T_b->nrow * sizeof *T_b->val);
    }
    ritz_partition_scatter(&modes->Phi, &s->i, r, &out->T);
    for (int64_t j = 0; j < modes->Phi.ncol; j++) {
        columns->kind[r + j] = RITZ_COLUMN_NORMAL;
        columns->hertz[r + j] = ritz_eigen_hertz(modes->lambda[j]);
        columns->residual[r + j] = modes->residual[j];
    }
    memcpy(out->origin.engine, modes->engine, sizeof out->origin.engine);
    return RITZ_OK;
}

static ritz_status make_craig_bampton(const ritz_request *request,
                                      ritz_basis *out)
{
    RITZ_OWN(ritz_partition) s = {0};
    RITZ_OWN(ritz_basis) boundary = {0};
    RITZ_OWN(ritz_pairs) modes = {0};

    RITZ_CHECK(ritz_partition_new(request, &s));
    RITZ_CHECK(find_boundary(&s, &boundary));
    if (request->choice.interface_modes > 0 && s.b->count > 0)
        RITZ_CHECK(reduce_boundary(request, &boundary));
    if (request->modes != 0)
        RITZ_CHECK(find_normal_modes(request, &s, &modes));
    return join_columns(&s, &boundary, &modes, out);
}

const ritz_method ritz_method_craig_bampton = {
    .name = "craig-bampton",
    .summary = "constraint modes and fixed-interface normal modes",
    .reference = "CraigBampton1968",
    .when = "components held by their neighbours; wide and stiff interfaces",
    .cost = "a factor of the interior, a solve an attached dof, two a mode",
    .holds = "statics of the interface, rigid motion; frequencies from above",
    .fails = "an interior that moves with the interface held; loads within it",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_INTERFACE,
    .make = make_craig_bampton,
};
