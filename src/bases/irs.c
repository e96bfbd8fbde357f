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
#include "base/alloc.h"
#include "bases/partition.h"

#include <lapacke.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* [I; Psi], a column for each attached dof. */
static ritz_status find_guyan(const ritz_partition *s, ritz_factor *L,
                              ritz_dense *out)
{
    RITZ_OWN(ritz_dense) Psi = {0};

    RITZ_CHECK(ritz_partition_constraint_modes(s, L, &Psi));
    RITZ_CHECK(ritz_dense_new(s->component->num_dofs, s->b->count, out));
    ritz_partition_scatter(&Psi, &s->i, 0, out);
    for (int64_t j = 0; j < s->b->count; j++)
        ritz_dense_col(out, j)[s->b->at[j]] = 1.0;
    return RITZ_OK;
}

static ritz_status refuse_mass(const ritz_partition *s, int64_t j)
{
    char name[RITZ_DOF_NAME_SIZE];

    return ritz_fail(RITZ_ERR_SINGULAR,
                     "the condensed mass is singular: %s has none of its own "
                     "beside the other attached dofs, leave it out",
                     ritz_dof_name(s->component->dof[s->b->at[j]], name));
}

/* Rows of a matrix in another order, scaled: B(k,:) = d[p[k]] A(p[k],:). */
static void permute_rows(const ritz_dense *A, const int *p, const double *d,
                         ritz_dense *B)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t k = 0; k < A->nrow; k++)
            ritz_dense_col(B, j)[k] =
                d[p[k] - 1] * ritz_dense_col(A, j)[p[k] - 1];
}

/* The inverse: A(p[k],:) = d[p[k]] B(k,:). */
static void restore_rows(const ritz_dense *B, const int *p, const double *d,
                         ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t k = 0; k < A->nrow; k++)
            ritz_dense_col(A, j)[p[k] - 1] =
                d[p[k] - 1] * ritz_dense_col(B, j)[k];
}

/*
 * X := M_R^-1 K_R by Cholesky with pivots, in coordinates that give M_R a unit
 * diagonal, so that pivots are small relative to 1.
 */
static ritz_status solve_mass(const ritz_partition *s, double tolerance,
                              ritz_dense *M_R, ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    int64_t a = M_R->ncol;
    int n = (int)a;
    int rank = 0;
    ritz_dense Y = {0};
    double *d = NULL;
    int *pivot = NULL;

    RITZ_NEW(d, a);
    RITZ_NEW(pivot, a);
    RITZ_TRY(ritz_dense_new(a, a, &Y));
    for (int64_t j = 0; j < a; j++) {
        double own = ritz_dense_col(M_R, j)[j];

        if (!(own > 0.0)) {
            status = refuse_mass(s, j);
            goto done;
        }
        d[j] = 1.0 / sqrt(own);
    }
    for (int64_t k = 0; k < a * a; k++)
        M_R->val[k] *= d[k % a] * d[k / a];
    if (LAPACKE_dpstrf(LAPACK_COL_MAJOR, 'L', n, M_R->val, n, pivot, &rank,
                       tolerance) != 0) {
        status = refuse_mass(s, pivot[rank] - 1);
        goto done;
    }
    permute_rows(X, pivot, d, &Y);
    RITZ_FAIL_IF(
        LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', n, n, M_R->val, n, Y.val, n) != 0,
        RITZ_ERR_MEMORY, "no memory for the condensed mass");
    restore_rows(&Y, pivot, d, X);
done:
    free(d);
    free(pivot);
    ritz_dense_free(&Y);
    return status;
}

/* T_i += K_ii^-1 (M T)_i X. */
static ritz_status add_inertia(const ritz_partition *s, ritz_factor *L,
                               const ritz_dense *X, ritz_dense *T)
{
    RITZ_OWN(ritz_dense) MT = {0}, force = {0}, move = {0};

    RITZ_CHECK(ritz_sparse_mul(&s->component->M, T, &MT));
    RITZ_CHECK(ritz_dense_mul(&MT, X, &force));
    RITZ_CHECK(ritz_dense_new(s->i.count, T->ncol, &move));
    for (int64_t j = 0; j < T->ncol; j++)
        for (int64_t k = 0; k < s->i.count; k++)
            ritz_dense_col(&move, j)[k] = ritz_dense_col(&force, j)[s->i.at[k]];
    RITZ_CHECK(ritz_factor_solve(L, &move));
    for (int64_t j = 0; j < T->ncol; j++)
        for (int64_t k = 0; k < s->i.count; k++)
            ritz_dense_col(T, j)[s->i.at[k]] += ritz_dense_col(&move, j)[k];
    return RITZ_OK;
}

static ritz_status fill_basis(const ritz_request *request,
                              const ritz_partition *s, ritz_dense *T)
{
    RITZ_OWN(ritz_factor) *L = NULL;
    RITZ_OWN(ritz_dense) K_R = {0}, M_R = {0};

    RITZ_CHECK(ritz_partition_factor(s, &L));
    RITZ_CHECK(find_guyan(s, L, T));
    if (s->i.count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_condense(s->component, T, &K_R, &M_R));
    RITZ_CHECK(solve_mass(s, request->tolerance, &M_R, &K_R));
    return add_inertia(s, L, &K_R, T);
}

static ritz_status make_irs(const ritz_request *request, ritz_basis *out)
{
    const ritz_dofs *b = &request->attached;
    RITZ_OWN(ritz_partition) s = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_REFUSE_IF(
        b->count == 0, RITZ_ERR_ARGUMENT,
        "nothing is attached, so nothing would be kept: name a port");
    RITZ_CHECK(ritz_partition_new(request, &s));
    RITZ_CHECK(ritz_columns_new(b->count, &basis.columns));
    RITZ_CHECK(fill_basis(request, &s, &basis.T));
    for (int64_t j = 0; j < b->count; j++) {
        basis.columns.kind[j] = RITZ_COLUMN_CONSTRAINT;
        basis.columns.dof[j] = b->at[j];
    }
    snprintf(basis.origin.engine, sizeof basis.origin.engine, "CHOLMOD");
    RITZ_MOVE(*out, basis);
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
    .uses = RITZ_USES_ATTACHED,
    .make = make_irs,
};
