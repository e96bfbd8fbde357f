#include "bases/partition.h"

#include "base/tolerances.h"

#include <ritz/matrix.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

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

ritz_status ritz_mechanism_refuse(const ritz_component *component,
                                  const ritz_sparse *K_ii,
                                  const ritz_sparse *M_ii, const ritz_dofs *i,
                                  int64_t weak)
{
    ritz_status status = RITZ_OK;
    const ritz_span rigid_only = {.modes = 0};
    ritz_pairs pairs = {0};
    char text[160] = "";
    char name[RITZ_DOF_NAME_SIZE];

    status = ritz_eigen_sparse(K_ii, M_ii, &rigid_only, &pairs);
    if (status == RITZ_ERR_MEMORY)
        goto done;
    if (status == RITZ_OK && pairs.num_rigid > 0)
        name_dofs(component, i, ritz_dense_col(&pairs.Phi, 0), text);
    else if (weak >= 0)
        snprintf(text, sizeof text, "%s",
                 ritz_dof_name(component->dof[i->at[weak]], name));
    if (status == RITZ_OK && pairs.num_rigid == 0 && pairs.Phi.ncol > 0 &&
        pairs.lambda[0] < 0.0)
        status = ritz_fail(RITZ_ERR_SINGULAR,
                           "not positive definite: an eigenvalue is %.3g",
                           pairs.lambda[0]);
    else
        status = ritz_fail(
            RITZ_ERR_SINGULAR,
            "singular, is a rigid-body motion or mechanism left free? with "
            "the attached dofs held, %" PRId64 " motion(s) cost no energy; "
            "largest at %s",
            pairs.num_rigid > 0 ? pairs.num_rigid : 1,
            text[0] ? text : "no dof in particular");
done:
    ritz_pairs_free(&pairs);
    return status;
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
    *K = stiffness;
    *M = mass;
    stiffness = mass = (ritz_dense){0};
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

ritz_status ritz_partition_factor(const ritz_partition *s, ritz_factor **out)
{
    ritz_status status = RITZ_OK;
    int64_t weak = -1;

    if (s->i.count == 0)
        goto done;
    status = ritz_factor_spd_weak(&s->K_ii, out, &weak);
    if (status == RITZ_ERR_SINGULAR)
        status = ritz_mechanism_refuse(s->component, &s->K_ii, &s->M_ii, &s->i,
                                       weak);
    RITZ_TRY_IN("interior stiffness", status);
done:
    return status;
}

/* -A as a dense matrix: the right-hand sides of the constraint modes. */
static ritz_status negate_dense(const ritz_sparse *A, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(A->nrow, A->ncol, out));
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            ritz_dense_col(out, j)[A->rowind[p]] = -A->val[p];
    return RITZ_OK;
}

ritz_status ritz_partition_constraint_modes(const ritz_partition *s,
                                            ritz_factor *L, ritz_dense *Psi)
{
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK(negate_dense(&s->K_ib, &X));
    if (s->i.count > 0)
        RITZ_CHECK(ritz_factor_solve(L, &X));
    RITZ_MOVE(*Psi, X);
    return RITZ_OK;
}

void ritz_partition_scatter(const ritz_dense *part, const ritz_dofs *to,
                            int64_t first, ritz_dense *T)
{
    for (int64_t j = 0; j < part->ncol; j++) {
        const double *from = ritz_dense_col(part, j);
        double *into = ritz_dense_col(T, first + j);

        for (int64_t k = 0; k < part->nrow; k++)
            into[to->at[k]] = from[k];
    }
}

void ritz_partition_free(ritz_partition *s)
{
    ritz_dofs_free(&s->i);
    ritz_sparse_free(&s->K_ii);
    ritz_sparse_free(&s->K_ib);
    ritz_sparse_free(&s->M_ii);
}
