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
 * partition.c finds Psi. The bases of irs.c and krylov_fixed.c begin with the
 * same constraint modes.
 *
 * [CraigBampton1968] R. R. Craig and M. C. C. Bampton, Coupling of
 * substructures for dynamic analyses, AIAA Journal 6 (1968) 1313-1319.
 */
#include "base/alloc.h"
#include "base/memory.h"
#include "base/tolerances.h"
#include "bases/interior_statics.h"
#include "linear/engine_choice.h"

#include <stdio.h>
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

    RITZ_CHECK(
        ritz_condense_boundary(request->component, &boundary->T, &K, &M));
    RITZ_CHECK(ritz_eigen_dense(&K, &M, &modes));
    modes.Phi.ncol = count_kept(&modes, request->choice.interface_modes);
    RITZ_CHECK(ritz_columns_new(modes.Phi.ncol, &basis.columns));
    RITZ_CHECK(ritz_dense_mul(&boundary->T, &modes.Phi, &basis.T));
    ritz_columns_label(&modes, RITZ_COLUMN_INTERFACE, 0, &basis.columns);
    ritz_basis_free(boundary);
    RITZ_MOVE(*boundary, basis);
    return RITZ_OK;
}

/* All that the factor of K_ii is needed for beside the modes. */
typedef struct static_task {
    const ritz_request *request;
    ritz_partition *s;
    ritz_interior_statics statics;
    bool done;
} static_task;

static void static_task_free(static_task *t)
{
    ritz_interior_statics_free(&t->statics);
}

/* Constraint modes and static vectors. */
static ritz_status find_statics(static_task *t, ritz_factor *L)
{
    RITZ_CHECK(ritz_constraint_modes_find(t->s, L));
    RITZ_CHECK_IN("static vectors",
                  ritz_interior_statics_respond(t->request, L, &t->statics));
    t->done = true;
    return RITZ_OK;
}

/* A ritz_factor_use, for the first call with a factor of K_ii itself. */
static ritz_status borrow_factor(void *of, const ritz_pairs *found,
                                 int64_t count, ritz_factor *A, double sigma)
{
    static_task *t = of;

    (void)found;
    (void)count;
    return A && sigma == 0.0 && !t->done ? find_statics(t, A) : RITZ_OK;
}

static bool gives_up_factor(ritz_eigen_engine engine)
{
    return engine == RITZ_EIGEN_SLICES || engine == RITZ_EIGEN_AMLS;
}

/* Whether the search still has the factor when it has found the modes. For modes
   up to a frequency, whose number is not known yet, block Lanczos is assumed. */
static bool keeps_factor(const ritz_request *request, const ritz_partition *s)
{
    const ritz_span span = ritz_request_span(request);

    if (!s->L || request->modes <= 0)
        return !gives_up_factor(span.engine);
    return !gives_up_factor(
        ritz_engine_of(&span, s->L, s->K_ii.nrow, request->modes));
}

/* The requested number of modes, or all up to the requested frequency. */
static ritz_status find_normal_modes(static_task *t, ritz_pairs *out)
{
    const ritz_span span = ritz_request_span(t->request);
    const ritz_factor_use use = {borrow_factor, t};
    ritz_partition *s = t->s;

    RITZ_CHECK(
        ritz_eigen_factored(&s->K_ii, &s->M_ii, &s->L, &span, &use, out));
    return out->num_rigid > 0 ? ritz_partition_refuse(s, -1) : RITZ_OK;
}

/*
 * The modes, and then the statics: while the modes are found, memory has no
 * constraint modes to hold. The factor is made again only if the search moved
 * its shift away from zero, or gave it up for another engine.
 */
static ritz_status find_interior(static_task *t, ritz_pairs *modes)
{
    ritz_partition *s = t->s;

    if (t->request->modes == 0 || !keeps_factor(t->request, s))
        RITZ_CHECK(find_statics(t, s->L));
    if (t->request->modes == 0)
        return ritz_dense_new(s->i.count, 0, &modes->Phi);
    RITZ_CHECK_IN("fixed-interface modes", find_normal_modes(t, modes));
    if (t->done)
        return RITZ_OK;
    if (!s->L)
        RITZ_CHECK(ritz_partition_factor(s));
    return find_statics(t, s->L);
}

/* What the factor of K_ii is followed by: the search for modes, as far as their
   number is known, or the columns of both kinds, and then the basis without the
   factor. Static vectors are left out. */
static ritz_foresight foresee_basis(const ritz_request *request,
                                    const ritz_partition *s)
{
    const int64_t size = (int64_t)sizeof(double);
    const int64_t b = s->b->count;
    const int64_t modes = request->modes > 0 ? request->modes : 0;
    const int64_t Psi = size * s->i.count * b;
    const int64_t Phi = size * s->i.count * modes;
    const ritz_span span = ritz_request_span(request);
    int64_t search = 0;

    if (modes > 0)
        search = ritz_eigen_factored_needs(&s->K_ii, &s->M_ii, &span) +
                 (keeps_factor(request, s) ? 0 : Psi);
    return (ritz_foresight){
        .beside = Psi + Phi > search ? Psi + Phi : search,
        .after = Psi + Phi + size * s->component->num_dofs * (b + modes)};
}

static ritz_status factor_interior(const ritz_request *request,
                                   ritz_partition *s)
{
    const ritz_foresight before =
        ritz_memory_foresee(foresee_basis(request, s));
    const ritz_status status = ritz_partition_factor(s);

    (void)ritz_memory_foresee(before);
    return status;
}

/* @param[in] usual  kinds of loads with static vectors, if none are
   requested */
static ritz_status make_fixed(const ritz_request *request, int usual,
                              ritz_basis *out)
{
    RITZ_OWN(ritz_partition) s = {0};
    RITZ_OWN(static_task) t = {.request = request, .s = &s};
    RITZ_OWN(ritz_pairs) modes = {0};

    RITZ_CHECK(
        ritz_partition_split(request, ritz_partition_may_take(request), &s));
    RITZ_CHECK(factor_interior(request, &s));
    RITZ_CHECK_IN("static vectors", ritz_interior_statics_collect(
                                        request, &s, usual, &t.statics));
    RITZ_CHECK(find_interior(&t, &modes));
    if (request->choice.interface_modes > 0 && s.b->count > 0) {
        RITZ_CHECK(ritz_constraint_modes_expand(&s));
        RITZ_CHECK_IN("interface modes", reduce_boundary(request, &s.held));
    }
    RITZ_CHECK(
        ritz_interior_statics_join(request, &s, &modes.Phi, &t.statics, out));
    ritz_columns_label(&modes, RITZ_COLUMN_NORMAL, s.held.columns.count,
                       &out->columns);
    ritz_origin_name_engine(&modes, &out->origin);
    return RITZ_OK;
}

static ritz_status make_craig_bampton(const ritz_request *request,
                                      ritz_basis *out)
{
    return make_fixed(request, RITZ_LOADS_DAMPERS, out);
}

const ritz_method ritz_method_craig_bampton = {
    .name = "craig-bampton",
    .summary = "constraint modes and fixed-interface normal modes",
    .reference = "CraigBampton1968",
    .when = "components held by their neighbours; wide and stiff interfaces",
    .cost = "a factor of the interior, a solve an attached dof, two a mode",
    .holds = "statics of the interface, rigid motion; frequencies from above",
    .fails = "an interior that moves with the interface held; loads within it",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_INTERFACE |
            RITZ_USES_LOADS | RITZ_USES_EIGEN,
    .keeps_interface = true,
    .nested = true,
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

    RITZ_CHECK(ritz_refuse_unattached(request, "nothing would be kept"));
    without_modes.modes = 0;
    RITZ_CHECK(make_fixed(&without_modes, 0, out));
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
    .uses = RITZ_USES_ATTACHED | RITZ_USES_INTERFACE | RITZ_USES_LOADS,
    .keeps_interface = true,
    .make = make_guyan,
};
