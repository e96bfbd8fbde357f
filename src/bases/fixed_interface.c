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
 * The same constraint modes begin the bases of irs and krylov-cms-fixed below.
 *
 * [CraigBampton1968] R. R. Craig and M. C. C. Bampton, Coupling of
 * substructures for dynamic analyses, AIAA Journal 6 (1968) 1313-1319.
 */
#include "base/alloc.h"
#include "base/search.h"
#include "base/team.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "bases/krylov.h"
#include "linear/eigen_sparse.h"
#include "linear/inertia.h"

#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Boundary b, on which other bodies act, and interior i. */
typedef struct partition {
    const ritz_component *component; /* borrowed */
    const ritz_dofs *b;              /* borrowed */
    ritz_dofs i;
    ritz_sparse K_ii, K_ib, M_ii, M_ib;
    ritz_factor *L;  /* of K_ii; NULL where there is no interior */
    ritz_dense Psi;  /* -K_ii^-1 K_ib: constraint modes */
    ritz_basis held; /* the columns [I; Psi], and as its T, where whole vectors
                        are needed, the vectors; Psi is then {0} */
} partition;

static void partition_free(partition *s)
{
    ritz_dofs_free(&s->i);
    ritz_sparse_free(&s->K_ii);
    ritz_sparse_free(&s->K_ib);
    ritz_sparse_free(&s->M_ii);
    ritz_sparse_free(&s->M_ib);
    ritz_factor_free(&s->L);
    ritz_dense_free(&s->Psi);
    ritz_basis_free(&s->held);
}

/* Median of K_jj / M_jj of the interior, 0 if no row has mass. */
static ritz_status typical_value(const partition *s, double *out)
{
    RITZ_OWN_ARRAY double *ratio = NULL;
    int64_t count = 0;

    RITZ_CHECK_NEW(ratio, s->i.count);
    for (int64_t j = 0; j < s->i.count; j++) {
        const double m = ritz_sparse_diagonal(&s->M_ii, j);

        if (m > 0.0)
            ratio[count++] = fabs(ritz_sparse_diagonal(&s->K_ii, j)) / m;
    }
    qsort(ratio, (size_t)count, sizeof *ratio, ritz_ascending);
    *out = count > 0 ? ratio[count / 2] : 0.0;
    return RITZ_OK;
}

/* The number of negative eigenvalues, beyond what ten digits of K_ii leave of
   zeros; 0 if they cannot be counted. */
static ritz_status count_negative(const partition *s, int64_t *out)
{
    RITZ_OWN(ritz_counter) *C = NULL;
    ritz_status status = RITZ_OK;
    double typical = 0.0;

    *out = 0;
    RITZ_CHECK(typical_value(s, &typical));
    if (typical == 0.0)
        return RITZ_OK;
    RITZ_CHECK(ritz_counter_new(&s->K_ii, &s->M_ii, NULL, &C));
    status = ritz_counter_below(C, -RITZ_RIGID_DIGITS * typical, out);
    return status == RITZ_ERR_SINGULAR ? RITZ_OK : status;
}

/*
 * A sentence that names the dofs which move freely while the boundary is held,
 * or whose motion has negative energy.
 *
 * @param[in] weak  row of K_ii that gave way, -1 if not known
 */
static ritz_status refuse_mechanism(const partition *s, int64_t weak)
{
    const ritz_span lowest = {.modes = 1};
    RITZ_OWN(ritz_pairs) pairs = {0};
    ritz_status status = ritz_eigen_sparse(&s->K_ii, &s->M_ii, &lowest, &pairs);
    int64_t negative = 0;

    if (status == RITZ_ERR_MEMORY)
        return status;
    RITZ_CHECK(count_negative(s, &negative));
    return ritz_refuse_mechanism(
        s->component, &s->i, status == RITZ_OK ? &pairs : NULL, weak, negative);
}

/*
 * T_b'KT_b and T_b'MT_b, exactly symmetric. For motions that store no energy
 * the first is rounding of |T_b|'|K||T_b|, and is set to zero.
 */
static ritz_status condense_boundary(const ritz_component *component,
                                     const ritz_dense *T_b, ritz_dense *K,
                                     ritz_dense *M)
{
    /* sums of a few dozen terms in each of two products */
    const double rounding = 64.0 * DBL_EPSILON;
    RITZ_OWN(ritz_dense) stiffness = {0}, mass = {0}, most = {0};

    RITZ_CHECK(ritz_sparse_condense(&component->K, T_b, &stiffness));
    RITZ_CHECK(ritz_sparse_condense(&component->M, T_b, &mass));
    RITZ_CHECK(ritz_sparse_terms(&component->K, T_b, T_b->ncol, NULL, &most));
    for (int64_t k = 0; k < most.nrow * most.ncol; k++)
        if (fabs(stiffness.val[k]) <= rounding * most.val[k])
            stiffness.val[k] = 0.0;
    RITZ_MOVE(*K, stiffness);
    RITZ_MOVE(*M, mass);
    return RITZ_OK;
}

/* Rows of X, and the rows of T that they become. */
typedef struct scattering {
    const ritz_dense *X;
    const ritz_dofs *to;
    int64_t first; /* column of T */
    ritz_dense *T;
} scattering;

static void scatter_columns(int thread, int64_t from, int64_t to, void *task)
{
    const scattering *s = task;

    (void)thread;
    for (int64_t j = from; j < to; j++) {
        const double *x = ritz_dense_col(s->X, j);
        double *t = ritz_dense_col(s->T, s->first + j);

        for (int64_t k = 0; k < s->X->nrow; k++)
            t[s->to->at[k]] = x[k];
    }
}

/* Rows of X become the rows `to` of T, in columns from `first` on. */
static void scatter_rows(const ritz_dense *X, const ritz_dofs *to,
                         int64_t first, ritz_dense *T)
{
    enum { WORTHWHILE = 5000 }; /* rows from which several threads copy */

    ritz_team_over(ritz_team_ready(X->nrow < WORTHWHILE ? 1 : X->ncol), X->ncol,
                   scatter_columns, &(scattering){X, to, first, T});
}

static ritz_status factor_interior(partition *s)
{
    int64_t weak = -1;
    ritz_status status = RITZ_OK;

    if (s->i.count > 0)
        status = ritz_factor_spd_weak(&s->K_ii, &s->L, &weak);
    if (status == RITZ_ERR_SINGULAR)
        status = refuse_mechanism(s, weak);
    return ritz_context(status, "interior stiffness");
}

/* @param[in] L  the factor of K_ii; NULL: there is no interior */
static ritz_status find_constraint_modes(partition *s, ritz_factor *L)
{
    const ritz_sparse *K_ib = &s->K_ib;
    const ritz_dofs *b = s->b;
    RITZ_OWN(ritz_dense) Psi = {0};

    ritz_monitor_step("constraint modes", 0, 0);
    RITZ_CHECK(ritz_dense_new(s->i.count, b->count, &Psi));
    for (int64_t j = 0; j < b->count; j++)
        for (int64_t p = K_ib->colptr[j]; p < K_ib->colptr[j + 1]; p++)
            ritz_dense_col(&Psi, j)[K_ib->rowind[p]] = -K_ib->val[p];
    if (L)
        RITZ_CHECK(ritz_factor_solve(L, &Psi));
    RITZ_MOVE(s->Psi, Psi);
    RITZ_CHECK(ritz_columns_new(b->count, &s->held.columns));
    ritz_columns_label_dofs(b->count, b->at, 0, &s->held.columns);
    return RITZ_OK;
}

/* The columns of T from the first on become [I; Psi]. */
static void scatter_constraint_modes(const partition *s, ritz_dense *T)
{
    scatter_rows(&s->Psi, &s->i, 0, T);
    for (int64_t j = 0; j < s->b->count; j++)
        ritz_dense_col(T, j)[s->b->at[j]] = 1.0;
}

/* held.T := [I; Psi] */
static ritz_status expand_constraint_modes(partition *s)
{
    RITZ_CHECK(ritz_dense_new(s->component->num_dofs, s->b->count, &s->held.T));
    scatter_constraint_modes(s, &s->held.T);
    ritz_dense_free(&s->Psi);
    return RITZ_OK;
}

/* Whether the partition may take K and M of the component for its parts of them.
   Characteristic constraint modes and a test of the damping matrix still need
   the whole matrices. */
static bool may_take_matrices(const ritz_request *request)
{
    const ritz_component *owned = request->owned;

    return owned && request->choice.interface_modes == 0 && !owned->D.colptr;
}

/* A_ii := A(i, i), a copy; or A itself, cut to the interior, where `owned` is
   not NULL. */
static ritz_status take_interior(const ritz_dofs *i, const ritz_sparse *A,
                                 ritz_sparse *owned, ritz_sparse *A_ii)
{
    if (!owned)
        return ritz_sparse_extract(A, i->count, i->at, i->count, i->at, A_ii);
    RITZ_MOVE(*A_ii, *owned);
    return ritz_sparse_keep(A_ii, i->count, i->at);
}

/* The matrices of a partition, which takes those of the component if `take`. */
static ritz_status split_matrices(const ritz_request *request, bool take,
                                  partition *out)
{
    const ritz_sparse *K = &request->component->K;
    const ritz_sparse *M = &request->component->M;
    const ritz_dofs *b = &request->attached;
    RITZ_OWN(partition) s = {.component = request->component, .b = b};
    const ritz_dofs *i = &s.i;

    RITZ_CHECK(ritz_dofs_complement(b, s.component->num_dofs, &s.i));
    RITZ_CHECK(
        ritz_sparse_extract(K, i->count, i->at, b->count, b->at, &s.K_ib));
    RITZ_CHECK(
        ritz_sparse_extract(M, i->count, i->at, b->count, b->at, &s.M_ib));
    RITZ_CHECK(take_interior(i, K, take ? &request->owned->K : NULL, &s.K_ii));
    RITZ_CHECK(take_interior(i, M, take ? &request->owned->M : NULL, &s.M_ii));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

/* Matrices, the factor and the constraint modes. @param[in] take  as for
   split_matrices() */
static ritz_status hold_boundary(const ritz_request *request, bool take,
                                 partition *out)
{
    RITZ_OWN(partition) s = {0};

    RITZ_CHECK(split_matrices(request, take, &s));
    RITZ_CHECK(factor_interior(&s));
    RITZ_CHECK(find_constraint_modes(&s, s.L));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

/*
 * The columns of the boundary, and then [0; X]; labels of the latter are the
 * caller's to set.
 */
static ritz_status join_interior(const partition *s, const ritz_dense *X,
                                 ritz_basis *out)
{
    const ritz_columns *from = &s->held.columns;

    RITZ_CHECK(
        ritz_basis_new(s->component->num_dofs, from->count + X->ncol, out));
    for (int64_t j = 0; j < from->count; j++) {
        out->columns.kind[j] = from->kind[j];
        out->columns.dof[j] = from->dof[j];
        out->columns.hertz[j] = from->hertz[j];
        out->columns.residual[j] = from->residual[j];
    }
    if (s->held.T.val)
        ritz_dense_put(&s->held.T, 0, 0, &out->T);
    else
        scatter_constraint_modes(s, &out->T);
    scatter_rows(X, &s->i, from->count, &out->T);
    return RITZ_OK;
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

    RITZ_CHECK(condense_boundary(request->component, &boundary->T, &K, &M));
    RITZ_CHECK(ritz_eigen_dense(&K, &M, &modes));
    modes.Phi.ncol = count_kept(&modes, request->choice.interface_modes);
    RITZ_CHECK(ritz_columns_new(modes.Phi.ncol, &basis.columns));
    RITZ_CHECK(ritz_dense_mul(&boundary->T, &modes.Phi, &basis.T));
    ritz_columns_label(&modes, RITZ_COLUMN_INTERFACE, 0, &basis.columns);
    ritz_basis_free(boundary);
    RITZ_MOVE(*boundary, basis);
    return RITZ_OK;
}

/*
 * Static vectors of other loads, mainly of dampers [ChuMilman1992]: the
 * response of the interior with a fixed boundary, without its part in the
 * modes,
 *
 *     X = K_ii^-1 F_i,   X := X - Phi Phi'M_ii X
 *
 * [0; X] is K-orthogonal to the constraint modes and the normal modes. Together
 * they contain the static response to F for any motion of the boundary.
 */
typedef struct interior_statics {
    int loads;       /* sum of RITZ_LOADS_... */
    ritz_dense F, X; /* interior rows; {0}: no load */
    double *least;   /* F_j'X_j, the energy of response j, below which it is
                        rounding */
    bool *keep;
    int64_t kept;
} interior_statics;

static void interior_statics_free(interior_statics *a)
{
    ritz_dense_free(&a->F);
    ritz_dense_free(&a->X);
    RITZ_FREE(a->least, a->keep);
}

static ritz_status collect_forces(const ritz_request *request,
                                  const partition *s, int usual,
                                  interior_statics *out)
{
    RITZ_OWN(ritz_dense) F = {0};
    RITZ_OWN_ARRAY int64_t *dof = NULL;

    RITZ_CHECK(ritz_loads_beside(request, usual, &out->loads));
    if (ritz_loads_count(request, out->loads) == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_loads_collect(request, out->loads, &F, &dof));
    return ritz_dense_rows(&F, s->i.count, s->i.at, &out->F);
}

/* X before its part in the modes is removed. @param[in] L  the factor of K_ii;
   NULL: there is no interior */
static ritz_status respond_interior(const ritz_request *request, ritz_factor *L,
                                    interior_statics *a)
{
    const double part = fmax(request->tolerance, RITZ_FORCE_RELIEVED);

    if (a->F.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(&a->F, &a->X));
    if (L)
        RITZ_CHECK(ritz_factor_solve(L, &a->X));
    RITZ_CHECK_NEW(a->least, a->F.ncol);
    RITZ_CHECK_NEW(a->keep, a->F.ncol);
    for (int64_t j = 0; j < a->F.ncol; j++)
        a->least[j] = part * ritz_dense_dot(&a->F, j, &a->X, j);
    return RITZ_OK;
}

/* [Phi, X]: the modes, and the independent columns of X without their part in
   the modes. */
static ritz_status join_statics(const partition *s, double tolerance,
                                const ritz_dense *Phi, interior_statics *a,
                                ritz_dense *out)
{
    RITZ_OWN(ritz_dense) MPhi = {0}, X = {0};
    RITZ_OWN_ARRAY int64_t *at = NULL;
    int64_t count = 0;

    RITZ_CHECK(ritz_sparse_mul(&s->M_ii, Phi, &MPhi));
    for (int pass = 0; pass < 2 && Phi->ncol > 0; pass++)
        RITZ_CHECK(ritz_dense_take_out(Phi, &MPhi, &a->X));
    RITZ_CHECK(ritz_statics_choose(&a->F, &a->X, a->least, tolerance, a->keep,
                                   &a->kept));
    RITZ_CHECK_NEW(at, a->kept);
    for (int64_t j = 0; j < a->X.ncol; j++)
        if (a->keep[j])
            at[count++] = j;
    RITZ_CHECK(ritz_dense_pick(&a->X, count, at, &X));
    return ritz_dense_beside(Phi, &X, out);
}

/* Basis of boundary columns, Phi and labelled static vectors. */
static ritz_status join_columns(const ritz_request *request, const partition *s,
                                const ritz_dense *Phi, interior_statics *a,
                                ritz_basis *out)
{
    RITZ_OWN(ritz_dense) X = {0};

    if (a->F.ncol > 0)
        RITZ_CHECK(join_statics(s, request->tolerance, Phi, a, &X));
    RITZ_CHECK(join_interior(s, a->F.ncol > 0 ? &X : Phi, out));
    for (int64_t j = out->T.ncol - a->kept; j < out->T.ncol; j++)
        out->columns.kind[j] = RITZ_COLUMN_STATIC;
    ritz_remark_left_out(request, a->loads, 0, a->F.ncol, a->keep,
                         RITZ_COLUMN_STATIC, out);
    ritz_remark_dampers(request, a->loads, out);
    return RITZ_OK;
}

/* All that the factor of K_ii is needed for beside the modes. */
typedef struct static_task {
    const ritz_request *request;
    partition *s;
    interior_statics statics;
    bool done;
} static_task;

static void static_task_free(static_task *t)
{
    interior_statics_free(&t->statics);
}

/* Constraint modes and static vectors. */
static ritz_status find_statics(static_task *t, ritz_factor *L)
{
    RITZ_CHECK(find_constraint_modes(t->s, L));
    RITZ_CHECK_IN("static vectors",
                  respond_interior(t->request, L, &t->statics));
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

/* Whether the search still has the factor when it has found the modes. */
static bool keeps_factor(const ritz_request *request)
{
    const ritz_span span = ritz_request_span(request);

    return span.engine != RITZ_EIGEN_SLICES && span.engine != RITZ_EIGEN_AMLS;
}

/* The requested number of modes, or all up to the requested frequency. */
static ritz_status find_normal_modes(static_task *t, ritz_pairs *out)
{
    const ritz_span span = ritz_request_span(t->request);
    const ritz_factor_use use = {borrow_factor, t};
    partition *s = t->s;

    RITZ_CHECK(
        ritz_eigen_factored(&s->K_ii, &s->M_ii, &s->L, &span, &use, out));
    return out->num_rigid > 0 ? refuse_mechanism(s, -1) : RITZ_OK;
}

/*
 * The modes, and then the statics: while the modes are found, memory has no
 * constraint modes to hold. The factor is made again only if the search moved
 * its shift away from zero.
 */
static ritz_status find_interior(static_task *t, ritz_pairs *modes)
{
    partition *s = t->s;

    if (t->request->modes == 0 || !keeps_factor(t->request))
        RITZ_CHECK(find_statics(t, s->L));
    if (t->request->modes == 0)
        return ritz_dense_new(s->i.count, 0, &modes->Phi);
    RITZ_CHECK_IN("fixed-interface modes", find_normal_modes(t, modes));
    if (t->done)
        return RITZ_OK;
    if (!s->L)
        RITZ_CHECK(factor_interior(s));
    return find_statics(t, s->L);
}

/* @param[in] usual  kinds of loads with static vectors, if none are
   requested */
static ritz_status make_fixed(const ritz_request *request, int usual,
                              ritz_basis *out)
{
    RITZ_OWN(partition) s = {0};
    RITZ_OWN(static_task) t = {.request = request, .s = &s};
    RITZ_OWN(ritz_pairs) modes = {0};

    RITZ_CHECK(split_matrices(request, may_take_matrices(request), &s));
    RITZ_CHECK(factor_interior(&s));
    RITZ_CHECK_IN("static vectors",
                  collect_forces(request, &s, usual, &t.statics));
    RITZ_CHECK(find_interior(&t, &modes));
    if (request->choice.interface_modes > 0 && s.b->count > 0) {
        RITZ_CHECK(expand_constraint_modes(&s));
        RITZ_CHECK_IN("interface modes", reduce_boundary(request, &s.held));
    }
    RITZ_CHECK(join_columns(request, &s, &modes.Phi, &t.statics, out));
    ritz_columns_label(&modes, RITZ_COLUMN_NORMAL, s.held.columns.count,
                       &out->columns);
    memcpy(out->origin.engine, modes.engine, sizeof out->origin.engine);
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

/*
 * Improved reduced system: Guyan's transformation, corrected by the static
 * response to the inertia forces of its own motion. With attached (measured)
 * dofs b,
 *
 *     u_i = Psi u_b + K_ii^-1 (M_ib + M_ii Psi) (-u_b''),
 *     -u_b'' = M_R^-1 K_R u_b,    K_R = T_G'KT_G,  M_R = T_G'MT_G
 *
 *     T = T_G + [0; K_ii^-1 (M T_G)_i] M_R^-1 K_R,    T_G = [I; Psi]
 *
 * [OCallahan1989]. T is right to first order in lambda / lambda_i, lambda_i the
 * eigenvalues with b clamped, where T_G is right to order zero; frequencies
 * follow to the third and first power: tests/unit/bases/test_irs.c holds it to
 * both.
 */
static ritz_status refuse_mass(const partition *s, int64_t j)
{
    char name[RITZ_DOF_NAME_SIZE];

    return ritz_fail(RITZ_ERR_SINGULAR,
                     "the condensed mass is singular: %s has none of its own "
                     "beside the other attached dofs, leave it out",
                     ritz_dof_name(s->component->dof[s->b->at[j]], name));
}

/*
 * B(k,:) = d[p[k]] A(p[k],:), or back: B(p[k],:) = d[p[k]] A(k,:). LAPACK
 * counts pivots from 1.
 */
static void permute_rows(const ritz_dense *A, const int *p, const double *d,
                         bool back, ritz_dense *B)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t k = 0; k < A->nrow; k++) {
            int64_t at = p[k] - 1;

            ritz_dense_col(B, j)[back ? at : k] =
                d[at] * ritz_dense_col(A, j)[back ? k : at];
        }
}

/*
 * X := M_R^-1 K_R by Cholesky with pivots, in coordinates that give M_R a unit
 * diagonal, so that pivots are small relative to 1.
 */
static ritz_status solve_mass(const partition *s, double tolerance,
                              ritz_dense *M_R, ritz_dense *X)
{
    int64_t a = M_R->ncol;
    int n = (int)a;
    int rank = 0;
    RITZ_OWN(ritz_dense) Y = {0};
    RITZ_OWN_ARRAY double *d = NULL;
    RITZ_OWN_ARRAY int *pivot = NULL;

    RITZ_CHECK_NEW(d, a);
    RITZ_CHECK_NEW(pivot, a);
    RITZ_CHECK(ritz_dense_new(a, a, &Y));
    for (int64_t j = 0; j < a; j++) {
        double own = ritz_dense_col(M_R, j)[j];

        if (!(own > 0.0))
            return refuse_mass(s, j);
        d[j] = 1.0 / sqrt(own);
    }
    for (int64_t k = 0; k < a * a; k++)
        M_R->val[k] *= d[k % a] * d[k / a];
    if (LAPACKE_dpstrf(LAPACK_COL_MAJOR, 'L', n, M_R->val, n, pivot, &rank,
                       tolerance) != 0)
        return refuse_mass(s, pivot[rank] - 1);
    permute_rows(X, pivot, d, false, &Y);
    RITZ_REFUSE_IF(
        LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', n, n, M_R->val, n, Y.val, n) != 0,
        RITZ_ERR_MEMORY, "no memory for the condensed mass");
    permute_rows(&Y, pivot, d, true, X);
    return RITZ_OK;
}

/* T_i += K_ii^-1 (M T)_i X. */
static ritz_status add_inertia(const partition *s, const ritz_dense *X,
                               ritz_dense *T)
{
    RITZ_OWN(ritz_dense) MT = {0}, force = {0}, move = {0};

    RITZ_CHECK(ritz_sparse_mul(&s->component->M, T, &MT));
    RITZ_CHECK(ritz_dense_mul(&MT, X, &force));
    RITZ_CHECK(ritz_dense_rows(&force, s->i.count, s->i.at, &move));
    RITZ_CHECK(ritz_factor_solve(s->L, &move));
    for (int64_t j = 0; j < T->ncol; j++)
        for (int64_t k = 0; k < s->i.count; k++)
            ritz_dense_col(T, j)[s->i.at[k]] += ritz_dense_col(&move, j)[k];
    return RITZ_OK;
}

static ritz_status make_irs(const ritz_request *request, ritz_basis *out)
{
    RITZ_OWN(partition) s = {0};
    RITZ_OWN(interior_statics) statics = {0};
    RITZ_OWN(ritz_dense) K_R = {0}, M_R = {0}, none = {0};

    RITZ_CHECK(ritz_refuse_unattached(request, "nothing would be kept"));
    RITZ_CHECK(hold_boundary(request, false, &s));
    if (s.i.count > 0) {
        RITZ_CHECK(expand_constraint_modes(&s));
        RITZ_CHECK(condense_boundary(s.component, &s.held.T, &K_R, &M_R));
        RITZ_CHECK(solve_mass(&s, request->tolerance, &M_R, &K_R));
        RITZ_CHECK(add_inertia(&s, &K_R, &s.held.T));
    }
    RITZ_CHECK(collect_forces(request, &s, 0, &statics));
    RITZ_CHECK(respond_interior(request, s.L, &statics));
    RITZ_CHECK(ritz_dense_new(s.i.count, 0, &none));
    RITZ_CHECK(join_columns(request, &s, &none, &statics, out));
    snprintf(out->origin.engine, sizeof out->origin.engine, "CHOLMOD");
    return RITZ_OK;
}

const ritz_method ritz_method_irs = {
    .name = "irs",
    .summary = "static condensation improved by inertia (test-analysis models)",
    .reference = "OCallahan1989",
    .when = "test-analysis models on measured dofs, mass well covered",
    .cost = "as guyan, and a second solve",
    .holds = "rigid motion; shapes to first order; frequencies from above",
    .fails = "statics, which guyan has exact; attached dofs without mass",
    .uses = RITZ_USES_ATTACHED | RITZ_USES_LOADS,
    .keeps_interface = true,
    .make = make_irs,
};

/*
 * Fixed-interface Krylov component modes: constraint modes and block Krylov
 * vectors of the interior, started by the inertia forces of boundary motion
 * [CraigSuKim1992, sec. 4, eq. 24 and 25],
 *
 *     | u_b |   | I    0 | | u_b |   K_ii Psi = -K_ib
 *     | u_i | = | Psi  V | | q   |   span V = (A_ii^-1 M_ii)^j A_ii^-1 F_i
 *
 *     F_i = [M_ib + M_ii Psi, interior rows of other loads]
 *
 * with A = K - sigma M. Psi and V are K-orthogonal, so that T'KT is block
 * diagonal as it is with normal modes; forces on the boundary, and the other
 * loads, have their first moments kept, above all the static response.
 */

/* M_ib + M_ii Psi. */
static ritz_status find_coupling(const partition *s, const ritz_dense *Psi,
                                 ritz_dense *out)
{
    const ritz_sparse *M_ib = &s->M_ib;

    RITZ_CHECK(ritz_sparse_mul(&s->M_ii, Psi, out));
    for (int64_t j = 0; j < M_ib->ncol; j++)
        for (int64_t p = M_ib->colptr[j]; p < M_ib->colptr[j + 1]; p++)
            ritz_dense_col(out, j)[M_ib->rowind[p]] += M_ib->val[p];
    return RITZ_OK;
}

/* F_i: the coupling columns first, if the attached dofs are among the loads. */
static ritz_status find_loads(const ritz_request *request, const partition *s,
                              ritz_dense *out)
{
    int loads = ritz_krylov_loads(request, true);
    int others = loads & ~RITZ_LOADS_ATTACHED;
    int64_t more = ritz_loads_count(request, others);
    bool attached = loads & RITZ_LOADS_ATTACHED && s->Psi.ncol > 0;
    RITZ_OWN(ritz_dense) coupling = {0}, F = {0}, F_i = {0};
    RITZ_OWN_ARRAY int64_t *dof = NULL;

    if (more > 0 || !attached) { /* refuses none */
        RITZ_CHECK(
            ritz_loads_collect(request, more > 0 ? others : loads, &F, &dof));
        RITZ_CHECK(ritz_dense_rows(&F, s->i.count, s->i.at, &F_i));
    }
    F_i.ncol = more > 0 ? F_i.ncol : 0;
    if (attached)
        RITZ_CHECK(find_coupling(s, &s->Psi, more > 0 ? &coupling : out));
    if (more > 0 || !attached)
        return ritz_dense_beside(&coupling, &F_i, out);
    return RITZ_OK;
}

/* [I; Psi] and Krylov vectors, labelled and signed. What is not needed any more
   is freed before T is allocated. */
static ritz_status join_krylov(const ritz_request *request, const partition *s,
                               ritz_krylov *S, ritz_basis *out)
{
    const ritz_dense V = ritz_dense_part(&S->set.V, 0, S->set.count);
    RITZ_OWN(ritz_basis) signature = {0};

    RITZ_CHECK(ritz_krylov_sign(S, request->modes, &signature));
    ritz_dense_free(&S->set.WV);
    RITZ_CHECK(join_interior(s, &V, out));
    for (int64_t j = s->b->count; j < out->T.ncol; j++)
        out->columns.kind[j] = RITZ_COLUMN_KRYLOV;
    memcpy(out->remark, signature.remark, sizeof out->remark);
    memcpy(out->origin.engine, signature.origin.engine,
           sizeof out->origin.engine);
    return RITZ_OK;
}

static ritz_status make_krylov_fixed(const ritz_request *request,
                                     ritz_basis *out)
{
    RITZ_OWN(partition) s = {0};
    RITZ_OWN(ritz_dense) F = {0};
    RITZ_OWN(ritz_elastic) interior = {0};
    RITZ_OWN(ritz_krylov) S = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(hold_boundary(request, may_take_matrices(request), &s));
    RITZ_CHECK(find_loads(request, &s, &F));
    interior = (ritz_elastic){.K = &s.K_ii, .M = &s.M_ii};
    RITZ_MOVE(interior.L, s.L);
    RITZ_CHECK(ritz_krylov_new(&interior, request, &S));
    RITZ_CHECK(ritz_krylov_run(&S, &F, 0));
    ritz_dense_free(&F);
    RITZ_REFUSE_IF(s.b->count + S.set.count == 0, RITZ_ERR_ARGUMENT,
                   "the basis would have no vectors");
    ritz_factor_free(&interior.L);
    RITZ_CHECK(join_krylov(request, &s, &S, &basis));
    ritz_remark_dampers(request, ritz_krylov_loads(request, true), &basis);
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

const ritz_method ritz_method_krylov_cms_fixed = {
    .name = "krylov-cms-fixed",
    .summary = "constraint modes and fixed-interface block Krylov vectors",
    .reference = "CraigSuKim1992",
    .when = "as craig-bampton, without an eigenvalue problem",
    .cost = "a factor of the interior, one solve a vector",
    .holds = "statics and inertia of the interface; frequencies from above",
    .fails = "upper modes of the band: less exact than with normal modes",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_SHIFTS |
            RITZ_USES_LOADS | RITZ_USES_INNER,
    .keeps_interface = true,
    .nested = true,
    .make = make_krylov_fixed,
};
