#include "bases/partition.h"

#include "base/tolerances.h"
#include "bases/columns.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

enum { NAMED = 3 };

/* The largest entry of x that was not named before, the first of equals. */
static int64_t largest_unnamed(int64_t n, const double *x, int64_t count,
                               const int64_t *before)
{
    int64_t best = -1;

    for (int64_t k = 0; k < n; k++) {
        bool taken = false;

        for (int64_t j = 0; j < count; j++)
            taken = taken || before[j] == k;
        if (!taken && (best < 0 || fabs(x[k]) > fabs(x[best]) * RITZ_TIE))
            best = k;
    }
    return best;
}

/* "grid 3 R1, grid 7 R1": the dofs where a motion is largest. */
static void name_dofs(const ritz_component *component, const ritz_dofs *i,
                      const double *x, char text[static 160])
{
    int64_t named[NAMED];
    size_t used = 0;

    text[0] = '\0';
    for (int64_t k = 0; k < NAMED && k < i->count; k++) {
        char name[RITZ_DOF_NAME_SIZE];

        named[k] = largest_unnamed(i->count, x, k, named);
        if (fabs(x[named[k]]) <= RITZ_NULL_VECTOR_SHARE * fabs(x[named[0]]))
            break;
        used += (size_t)snprintf(
            text + used, 160 - used, "%s%s", k > 0 ? ", " : "",
            ritz_dof_name(component->dof[i->at[named[k]]], name));
    }
}

ritz_status ritz_mechanism_refuse(const ritz_partition *s, int64_t weak)
{
    const ritz_span rigid_only = {.modes = 0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    char text[160] = "";
    char name[RITZ_DOF_NAME_SIZE];
    ritz_status status =
        ritz_eigen_sparse(&s->K_ii, &s->M_ii, &rigid_only, &pairs);

    if (status == RITZ_ERR_MEMORY)
        return status;
    if (status == RITZ_OK && pairs.num_rigid > 0)
        name_dofs(s->component, &s->i, ritz_dense_col(&pairs.Phi, 0), text);
    else if (weak >= 0)
        snprintf(text, sizeof text, "%s",
                 ritz_dof_name(s->component->dof[s->i.at[weak]], name));
    RITZ_REFUSE_IF(status == RITZ_OK && pairs.num_rigid == 0 &&
                       pairs.Phi.ncol > 0 && pairs.lambda[0] < 0.0,
                   RITZ_ERR_SINGULAR,
                   "not positive definite: an eigenvalue is %.3g",
                   pairs.lambda[0]);
    return ritz_fail(
        RITZ_ERR_SINGULAR,
        "singular, is a rigid-body motion or mechanism left free? with "
        "the attached dofs held, %" PRId64 " motion(s) cost no energy; "
        "largest at %s",
        pairs.num_rigid > 0 ? pairs.num_rigid : 1,
        text[0] ? text : "no dof in particular");
}

ritz_status ritz_condense(const ritz_component *component,
                          const ritz_dense *T_b, ritz_dense *K, ritz_dense *M)
{
    /* sums of a few dozen terms in each of two products */
    const double rounding = 64.0 * DBL_EPSILON;
    RITZ_OWN(ritz_dense) stiffness = {0}, mass = {0}, most = {0};

    RITZ_CHECK(ritz_sparse_condense(&component->K, T_b, &stiffness));
    RITZ_CHECK(ritz_sparse_condense(&component->M, T_b, &mass));
    RITZ_CHECK(ritz_sparse_terms(&component->K, T_b, &most));
    for (int64_t k = 0; k < most.nrow * most.ncol; k++)
        if (fabs(stiffness.val[k]) <= rounding * most.val[k])
            stiffness.val[k] = 0.0;
    RITZ_MOVE(*K, stiffness);
    RITZ_MOVE(*M, mass);
    return RITZ_OK;
}

ritz_status ritz_partition_new(const ritz_request *request, ritz_partition *out)
{
    const ritz_sparse *K = &request->component->K;
    const ritz_sparse *M = &request->component->M;
    const ritz_dofs *b = &request->attached;
    RITZ_OWN(ritz_partition) s = {.component = request->component, .b = b};
    const ritz_dofs *i = &s.i;

    RITZ_CHECK(ritz_dofs_complement(b, s.component->num_dofs, &s.i));
    RITZ_CHECK(
        ritz_sparse_extract(K, i->count, i->at, i->count, i->at, &s.K_ii));
    RITZ_CHECK(
        ritz_sparse_extract(K, i->count, i->at, b->count, b->at, &s.K_ib));
    RITZ_CHECK(
        ritz_sparse_extract(M, i->count, i->at, i->count, i->at, &s.M_ii));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

/* Rows of X become the rows `to` of T, in columns from `first` on. */
static void scatter_rows(const ritz_dense *X, const ritz_dofs *to,
                         int64_t first, ritz_dense *T)
{
    for (int64_t j = 0; j < X->ncol; j++)
        for (int64_t k = 0; k < X->nrow; k++)
            ritz_dense_col(T, first + j)[to->at[k]] = ritz_dense_col(X, j)[k];
}

ritz_status ritz_partition_factor(const ritz_partition *s, ritz_factor **out)
{
    int64_t weak = -1;
    ritz_status status = RITZ_OK;

    if (s->i.count > 0)
        status = ritz_factor_spd_weak(&s->K_ii, out, &weak);
    if (status == RITZ_ERR_SINGULAR)
        status = ritz_mechanism_refuse(s, weak);
    return ritz_context(status, "interior stiffness");
}

ritz_status ritz_partition_boundary(const ritz_partition *s, ritz_factor *L,
                                    ritz_basis *out)
{
    const ritz_sparse *K_ib = &s->K_ib;
    const ritz_dofs *b = s->b;
    RITZ_OWN(ritz_dense) Psi = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(ritz_dense_new(s->i.count, b->count, &Psi));
    for (int64_t j = 0; j < b->count; j++)
        for (int64_t p = K_ib->colptr[j]; p < K_ib->colptr[j + 1]; p++)
            ritz_dense_col(&Psi, j)[K_ib->rowind[p]] = -K_ib->val[p];
    if (s->i.count > 0)
        RITZ_CHECK(ritz_factor_solve(L, &Psi));
    RITZ_CHECK(ritz_basis_new(s->component->num_dofs, b->count, &basis));
    scatter_rows(&Psi, &s->i, 0, &basis.T);
    for (int64_t j = 0; j < b->count; j++)
        ritz_dense_col(&basis.T, j)[b->at[j]] = 1.0;
    ritz_columns_label_dofs(b->count, b->at, 0, &basis.columns);
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

ritz_status ritz_partition_join(const ritz_partition *s,
                                const ritz_basis *boundary, const ritz_dense *X,
                                ritz_basis *out)
{
    const ritz_columns *from = &boundary->columns;

    RITZ_CHECK(
        ritz_basis_new(s->component->num_dofs, from->count + X->ncol, out));
    for (int64_t j = 0; j < from->count; j++) {
        out->columns.kind[j] = from->kind[j];
        out->columns.dof[j] = from->dof[j];
        out->columns.hertz[j] = from->hertz[j];
        out->columns.residual[j] = from->residual[j];
    }
    ritz_dense_put(&boundary->T, 0, 0, &out->T);
    scatter_rows(X, &s->i, from->count, &out->T);
    return RITZ_OK;
}

void ritz_partition_free(ritz_partition *s)
{
    ritz_dofs_free(&s->i);
    ritz_sparse_free(&s->K_ii);
    ritz_sparse_free(&s->K_ib);
    ritz_sparse_free(&s->M_ii);
}
