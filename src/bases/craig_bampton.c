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

#include "base/tolerances.h"
#include "bases/columns.h"
#include "bases/partition.h"

#include <stdio.h>
#include <string.h>

/* The requested number of modes, or all up to the requested frequency. */
static ritz_status find_normal_modes(const ritz_request *request,
                                     const ritz_partition *s, ritz_pairs *out)
{
    const ritz_span span = {request->modes, request->up_to_hz};

    RITZ_CHECK(ritz_eigen_sparse(&s->K_ii, &s->M_ii, &span, out));
    return out->num_rigid > 0 ? ritz_mechanism_refuse(s, -1) : RITZ_OK;
}

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
 * [I; Psi] Phi_c instead of T_b = [I; Psi], with the modes of the component
 * condensed to its attached dofs,
 *
 *     (T_b'KT_b) Phi_c = (T_b'MT_b) Phi_c Lambda,
 *
 * all rigid ones and the lowest request->choice.interface_modes others.
 */
static ritz_status reduce_boundary(const ritz_request *request,
                                   ritz_basis *boundary)
{
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) modes = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(ritz_condense(request->component, &boundary->T, &K, &M));
    RITZ_CHECK(ritz_eigen_dense(&K, &M, &modes));
    modes.Phi.ncol = count_kept(&modes, request->choice.interface_modes);
    RITZ_CHECK(ritz_columns_new(modes.Phi.ncol, &basis.columns));
    RITZ_CHECK(ritz_dense_mul(&boundary->T, &modes.Phi, &basis.T));
    ritz_columns_label(&modes, RITZ_COLUMN_INTERFACE, 0, &basis.columns);
    ritz_basis_free(boundary);
    RITZ_MOVE(*boundary, basis);
    return RITZ_OK;
}

static ritz_status make_craig_bampton(const ritz_request *request,
                                      ritz_basis *out)
{
    RITZ_OWN(ritz_partition) s = {0};
    RITZ_OWN(ritz_factor) *L = NULL;
    RITZ_OWN(ritz_basis) boundary = {0};
    RITZ_OWN(ritz_pairs) modes = {0};

    RITZ_CHECK(ritz_partition_new(request, &s));
    RITZ_CHECK(ritz_partition_factor(&s, &L));
    RITZ_CHECK(ritz_partition_boundary(&s, L, &boundary));
    ritz_factor_free(&L);
    if (request->choice.interface_modes > 0 && s.b->count > 0)
        RITZ_CHECK_IN("interface modes", reduce_boundary(request, &boundary));
    if (request->modes != 0)
        RITZ_CHECK_IN("fixed-interface modes",
                      find_normal_modes(request, &s, &modes));
    RITZ_CHECK(ritz_partition_join(&s, &boundary, &modes.Phi, out));
    ritz_columns_label(&modes, RITZ_COLUMN_NORMAL, boundary.T.ncol,
                       &out->columns);
    memcpy(out->origin.engine, modes.engine, sizeof out->origin.engine);
    return RITZ_OK;
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

/*
 * Guyan (static) reduction: Craig-Bampton without modes.
 *
 * [Guyan1965] R. J. Guyan, Reduction of stiffness and mass matrices,
 * AIAA Journal 3 (1965) 380.
 */
static ritz_status make_guyan(const ritz_request *request, ritz_basis *out)
{
    ritz_request without_modes = *request;

    RITZ_REFUSE_IF(
        request->attached.count == 0, RITZ_ERR_ARGUMENT,
        "nothing is attached, so nothing would be kept: name a port");
    without_modes.modes = 0;
    RITZ_CHECK(make_craig_bampton(&without_modes, out));
    snprintf(out->origin.engine, sizeof out->origin.engine, "CHOLMOD");
    return RITZ_OK;
}

const ritz_method ritz_method_guyan = {
    .name = "guyan",
    .summary = "constraint modes only: static condensation",
    .reference = "Guyan1965",
    .when = "a first look; stiff components of little mass of their own",
    .cost = "a factor of the interior, a solve an attached dof",
    .holds = "statics of the interface, rigid motion; frequencies from above",
    .fails = "modes of the interior, which are not there",
    .uses = RITZ_USES_ATTACHED | RITZ_USES_INTERFACE,
    .make = make_guyan,
};
