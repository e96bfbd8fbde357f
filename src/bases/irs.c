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
#include "bases/interior_statics.h"

#include <lapacke.h>
#include <math.h>
#include <stdio.h>

static ritz_status refuse_mass(const ritz_partition *s, int64_t j)
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
static ritz_status solve_mass(const ritz_partition *s, double tolerance,
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
static ritz_status add_inertia(const ritz_partition *s, const ritz_dense *X,
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
    RITZ_OWN(ritz_partition) s = {0};
    RITZ_OWN(ritz_interior_statics) statics = {0};
    RITZ_OWN(ritz_dense) K_R = {0}, M_R = {0}, none = {0};

    RITZ_CHECK(ritz_refuse_unattached(request, "nothing would be kept"));
    RITZ_CHECK(ritz_partition_hold(request, false, &s));
    if (s.i.count > 0) {
        RITZ_CHECK(ritz_constraint_modes_expand(&s));
        RITZ_CHECK(ritz_condense_boundary(s.component, &s.held.T, &K_R, &M_R));
        RITZ_CHECK(solve_mass(&s, request->tolerance, &M_R, &K_R));
        RITZ_CHECK(add_inertia(&s, &K_R, &s.held.T));
    }
    RITZ_CHECK(ritz_interior_statics_collect(request, &s, 0, &statics));
    RITZ_CHECK(ritz_interior_statics_respond(request, s.L, &statics));
    RITZ_CHECK(ritz_dense_new(s.i.count, 0, &none));
    RITZ_CHECK(ritz_interior_statics_join(request, &s, &none, &statics, out));
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
