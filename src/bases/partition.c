/*
 * Boundary and interior of a component: the parts of its matrices, the factor of
 * K_ii, and the constraint modes
 *
 *     Psi = -K_ii^-1 K_ib,
 *
 * the static response of the interior to unit boundary motion [CraigBampton1968].
 * A K_ii that is not positive definite is refused by the names of the dofs that
 * move.
 */
#include "bases/partition.h"
#include "base/alloc.h"
#include "base/search.h"
#include "base/team.h"
#include "base/tolerances.h"
#include "linear/inertia.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

void ritz_partition_free(ritz_partition *s)
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
static ritz_status typical_value(const ritz_partition *s, double *out)
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
static ritz_status count_negative(const ritz_partition *s, int64_t *out)
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

ritz_status ritz_partition_refuse(const ritz_partition *s, int64_t weak)
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

ritz_status ritz_condense_boundary(const ritz_component *component,
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

ritz_status ritz_partition_factor(ritz_partition *s)
{
    int64_t weak = -1;
    ritz_status status = RITZ_OK;

    if (s->i.count > 0)
        status = ritz_factor_spd_weak(&s->K_ii, &s->L, &weak);
    if (status == RITZ_ERR_SINGULAR)
        status = ritz_partition_refuse(s, weak);
    return ritz_context(status, "interior stiffness");
}

ritz_status ritz_constraint_modes_find(ritz_partition *s, ritz_factor *L)
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
static void scatter_constraint_modes(const ritz_partition *s, ritz_dense *T)
{
    scatter_rows(&s->Psi, &s->i, 0, T);
    for (int64_t j = 0; j < s->b->count; j++)
        ritz_dense_col(T, j)[s->b->at[j]] = 1.0;
}

ritz_status ritz_constraint_modes_expand(ritz_partition *s)
{
    RITZ_CHECK(ritz_dense_new(s->component->num_dofs, s->b->count, &s->held.T));
    scatter_constraint_modes(s, &s->held.T);
    ritz_dense_free(&s->Psi);
    return RITZ_OK;
}

bool ritz_partition_may_take(const ritz_request *request)
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

ritz_status ritz_partition_split(const ritz_request *request, bool take,
                                 ritz_partition *out)
{
    const ritz_sparse *K = &request->component->K;
    const ritz_sparse *M = &request->component->M;
    const ritz_dofs *b = &request->attached;
    RITZ_OWN(ritz_partition) s = {.component = request->component, .b = b};
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

ritz_status ritz_partition_hold(const ritz_request *request, bool take,
                                ritz_partition *out)
{
    RITZ_OWN(ritz_partition) s = {0};

    RITZ_CHECK(ritz_partition_split(request, take, &s));
    RITZ_CHECK(ritz_partition_factor(&s));
    RITZ_CHECK(ritz_constraint_modes_find(&s, s.L));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

ritz_status ritz_partition_join(const ritz_partition *s, const ritz_dense *X,
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
