/*
 * Craig-Bampton reduction: constraint modes and fixed-interface normal modes.
 *
 * Split the dofs into boundary b, which other bodies push on, and interior i:
 *
 *     | u_b |   | I    0   | | u_b |      K_ii Psi = -K_ib
 *     | u_i | = | Psi  Phi | | q   |      K_ii Phi =  M_ii Phi Lambda
 *
 * Psi is the static answer to unit boundary motion, Phi the lowest modes with
 * the boundary clamped, scaled to Phi' M_ii Phi = I. T' K T is then block
 * diagonal, and no eigenvalue of (T' K T, T' M T) lies below the one it stands
 * for in (K, M): tests/unit/test_craig_bampton.c holds the code to both.
 *
 * [CraigBampton1968] R. R. Craig and M. C. C. Bampton, Coupling of
 * substructures for dynamic analyses, AIAA Journal 6 (1968) 1313-1319.
 */
#include "bases/mechanism.h"

#include <ritz/eigen.h>
#include <ritz/factor.h>
#include <ritz/method.h>

#include <stddef.h>
#include <string.h>

/* The blocks of one split. */
typedef struct split {
    const ritz_component *component;
    const ritz_dofs *b;
    ritz_dofs i;
    ritz_sparse K_ii, K_ib, M_ii;
} split;

static void free_split(split *s)
{
    ritz_dofs_free(&s->i);
    ritz_sparse_free(&s->K_ii);
    ritz_sparse_free(&s->K_ib);
    ritz_sparse_free(&s->M_ii);
}

static ritz_status make_split(const ritz_request *request, split *s)
{
    ritz_status status = RITZ_OK;
    const ritz_sparse *K = &request->component->K;
    const ritz_sparse *M = &request->component->M;
    const ritz_dofs *b = &request->attached;
    const ritz_dofs *i = &s->i;

    s->component = request->component;
    s->b = b;
    RITZ_TRY(ritz_dofs_complement(b, s->component->num_dofs, &s->i));
    RITZ_TRY(
        ritz_sparse_extract(K, i->count, i->at, i->count, i->at, &s->K_ii));
    RITZ_TRY(
        ritz_sparse_extract(K, i->count, i->at, b->count, b->at, &s->K_ib));
    RITZ_TRY(
        ritz_sparse_extract(M, i->count, i->at, i->count, i->at, &s->M_ii));
done:
    return status;
}

/* Rows of `part` go to the dofs in `to`, its columns start at `first` in T. */
static void scatter(const ritz_dense *part, const ritz_dofs *to, int64_t first,
                    ritz_dense *T)
{
    for (int64_t j = 0; j < part->ncol; j++) {
        const double *from = ritz_dense_col(part, j);
        double *into = ritz_dense_col(T, first + j);

        for (int64_t k = 0; k < part->nrow; k++)
            into[to->at[k]] = from[k];
    }
}

/* -A as a dense matrix: the right-hand sides of the constraint modes. */
static ritz_status negate(const ritz_sparse *A, ritz_dense *out)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_dense_new(A->nrow, A->ncol, out));
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            ritz_dense_col(out, j)[A->rowind[p]] = -A->val[p];
done:
    return status;
}

static ritz_status find_constraint_modes(const split *s, ritz_dense *Psi)
{
    ritz_status status = RITZ_OK;
    ritz_factor *L = NULL;
    int64_t weak = -1;

    RITZ_TRY(negate(&s->K_ib, Psi));
    if (s->i.count == 0)
        goto done;
    status = ritz_factor_spd_weak(&s->K_ii, &L, &weak);
    if (status == RITZ_ERR_SINGULAR)
        status = ritz_mechanism_refuse(s->component, &s->K_ii, &s->M_ii, &s->i,
                                       weak);
    RITZ_TRY_IN("interior stiffness", status);
    RITZ_TRY(ritz_factor_solve(L, Psi));
done:
    ritz_factor_free(&L);
    return status;
}

/* The number asked for, or all up to the frequency asked for. */
static ritz_status find_normal_modes(const ritz_request *request,
                                     const split *s, ritz_pairs *out)
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

/* [I; Psi] first, a column for each boundary dof, then [0; Phi]. */
static ritz_status join(const split *s, const ritz_dense *Psi,
                        const ritz_pairs *modes, ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    const ritz_dofs *b = s->b;
    int64_t k = modes->Phi.ncol;
    ritz_columns *columns = &out->columns;

    RITZ_TRY(ritz_basis_new(s->component->num_dofs, b->count + k, out));
    scatter(Psi, &s->i, 0, &out->T);
    scatter(&modes->Phi, &s->i, b->count, &out->T);
    for (int64_t j = 0; j < b->count; j++) {
        ritz_dense_col(&out->T, j)[b->at[j]] = 1.0;
        columns->kind[j] = RITZ_COLUMN_CONSTRAINT;
        columns->dof[j] = b->at[j];
    }
    for (int64_t j = 0; j < k; j++) {
        columns->kind[b->count + j] = RITZ_COLUMN_NORMAL;
        columns->hertz[b->count + j] = ritz_eigen_hertz(modes->lambda[j]);
        columns->residual[b->count + j] = modes->residual[j];
    }
    memcpy(out->origin.engine, modes->engine, sizeof out->origin.engine);
done:
    return status;
}

static ritz_status make(const ritz_request *request, ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    split s = {0};
    ritz_dense Psi = {0};
    ritz_pairs modes = {0};

    RITZ_TRY(make_split(request, &s));
    RITZ_TRY(find_constraint_modes(&s, &Psi));
    if (request->modes != 0)
        RITZ_TRY(find_normal_modes(request, &s, &modes));
    RITZ_TRY(join(&s, &Psi, &modes, out));
done:
    free_split(&s);
    ritz_dense_free(&Psi);
    ritz_pairs_free(&modes);
    return status;
}

const ritz_method ritz_method_craig_bampton = {
    .name = "craig-bampton",
    .summary = "constraint modes and fixed-interface normal modes",
    .reference = "CraigBampton1968",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED,
    .make = make,
};
