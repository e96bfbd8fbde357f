/*
 * Rigid-body motions by geometry: R, and an M-orthonormal basis Phi of their
 * span in which Phi'K Phi = diag(mu). A motion without mass has no place in it.
 */
#include "check/audit_parts.h"

#include "base/alloc.h"

#include <ritz/eigen.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Dofs of grids without a position; scalar points need none. */
static ritz_status check_positions(ritz_auditor *it)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = it->component;
    bool *flag = NULL;
    char where[RITZ_WHERE_SIZE];
    int64_t count = 0;

    RITZ_NEW(flag, c->num_dofs);
    for (int64_t k = 0; k < c->num_dofs; k++)
        flag[k] = c->dof[k].component > 0 &&
                  ritz_grids_find(&c->grids, c->dof[k].grid) < 0;
    count = ritz_auditor_where(it, flag, where);
    it->placed = count == 0;
    ritz_auditor_say(it, "positions", (double)count, 0.0,
                     it->placed ? RITZ_PASS : RITZ_WARN, where,
                     it->placed ? "all grids have positions"
                                : "dofs of grids without a position: rotations "
                                  "cannot be checked, and axes are taken as "
                                  "basic");
done:
    free(flag);
    return status;
}

/* Mean position of the dofs' grids, and how far they reach. */
static void measure(ritz_auditor *it)
{
    const ritz_component *c = it->component;
    int64_t count = 0;

    for (int pass = 0; pass < 2; pass++)
        for (int64_t k = 0; k < c->num_dofs; k++) {
            int64_t g = ritz_grids_find(&c->grids, c->dof[k].grid);
            double square = 0.0;

            if (g < 0 || c->dof[k].component == 0)
                continue;
            count += pass == 0;
            for (int i = 0; i < 3; i++) {
                double d = c->grids.position[3 * g + i] - it->centre[i];

                if (pass == 0)
                    it->centre[i] += d / (double)count;
                square += d * d;
            }
            if (pass == 1)
                it->size = fmax(it->size, sqrt(square));
        }
    if (it->size <= 0.0)
        it->size = 1.0;
}

/* Without positions: translations along axes that are taken as basic. */
static ritz_status translate(ritz_auditor *it)
{
    const ritz_component *c = it->component;
    ritz_status status = ritz_dense_new(c->num_dofs, 3, &it->R);

    for (int64_t k = 0; status == RITZ_OK && k < c->num_dofs; k++) {
        int64_t direction = c->dof[k].component;

        if (direction >= 1 && direction <= 3)
            ritz_dense_col(&it->R, direction - 1)[k] = 1.0;
    }
    return status;
}

static ritz_status find_motions(ritz_auditor *it)
{
    int64_t n = it->component->num_dofs;

    measure(it);
    if (!it->placed)
        return translate(it);
    RITZ_CHECK(ritz_rigid_geometry(it->component, it->centre, &it->R));
    for (int64_t k = 3 * n; k < 6 * n; k++)
        it->R.val[k] /= it->size;
    return RITZ_OK;
}

/* Columns of V with lambda above 1e-10 of the largest, over sqrt(lambda). */
static void keep_massive(const ritz_pairs *pairs, ritz_dense *V)
{
    int64_t k = pairs->Phi.ncol;
    double largest = k > 0 ? pairs->lambda[k - 1] : 0.0;
    int64_t kept = 0;

    for (int64_t j = 0; j < k; j++) {
        if (!(pairs->lambda[j] > 1e-10 * largest))
            continue;
        for (int64_t i = 0; i < V->nrow; i++)
            ritz_dense_col(V, kept)[i] =
                ritz_dense_col(&pairs->Phi, j)[i] / sqrt(pairs->lambda[j]);
        kept++;
    }
    V->ncol = kept;
}

static ritz_status eigen_of(const ritz_dense *A, ritz_pairs *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense I = {0};

    RITZ_TRY(ritz_dense_new(A->nrow, A->nrow, &I));
    for (int64_t k = 0; k < A->nrow; k++)
        ritz_dense_col(&I, k)[k] = 1.0;
    RITZ_TRY(ritz_eigen_dense(A, &I, out));
done:
    ritz_dense_free(&I);
    return status;
}

/* R V, M-orthonormal: V from the eigenvectors of R'MR that have mass. */
static ritz_status orthonormalise(const ritz_auditor *it, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense B = {0}, V = {0};
    ritz_pairs pairs = {0};

    RITZ_TRY(ritz_sparse_condense(&it->component->M, &it->R, &B));
    RITZ_TRY(eigen_of(&B, &pairs));
    RITZ_TRY(ritz_dense_new(B.nrow, B.nrow, &V));
    keep_massive(&pairs, &V);
    RITZ_TRY(ritz_dense_mul(&it->R, &V, out));
done:
    ritz_dense_free(&B);
    ritz_dense_free(&V);
    ritz_pairs_free(&pairs);
    return status;
}

ritz_status ritz_audit_geometry(ritz_auditor *it)
{
    ritz_status status = RITZ_OK;
    ritz_dense Q = {0}, A = {0};
    ritz_pairs pairs = {0};

    RITZ_TRY(check_positions(it));
    RITZ_TRY(find_motions(it));
    RITZ_TRY(orthonormalise(it, &Q));
    RITZ_NEW(it->mu, Q.ncol);
    if (Q.ncol == 0)
        goto done;
    RITZ_TRY(ritz_sparse_condense(&it->component->K, &Q, &A));
    RITZ_TRY(eigen_of(&A, &pairs));
    RITZ_TRY(ritz_dense_mul(&Q, &pairs.Phi, &it->Phi));
    memcpy(it->mu, pairs.lambda, (size_t)Q.ncol * sizeof *it->mu);
done:
    ritz_dense_free(&Q);
    ritz_dense_free(&A);
    ritz_pairs_free(&pairs);
    return status;
}
