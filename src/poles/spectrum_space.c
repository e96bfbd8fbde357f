/*
 * The space in which damped poles of a large component are sought. Undamped
 * modes alone mislead where dampers are discrete: the motion that a truncated
 * set leaves across a damper is far from the true one, and so is the ratio.
 * With the static answers X to a force along each influence vector beside them
 * the small model is near enough for inverse iteration to settle on what is
 * sought.
 *
 *     A = K - sigma M, sigma < 0,   A X = B,   T = [Phi X], T'AT = I
 */
#include "poles/spectrum_parts.h"

#include "base/alloc.h"

#include <ritz/factor.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A column of which less than this is new adds nothing. */
static const double dependent = 1e-8;
/* Undamped modes to scan with, at least; and for each mode before the one. */
enum { LEAST_MODES = 20, EACH_MODE = 2 };

/* |x|_A; Ax is written. */
static ritz_status norm(const ritz_sparse *A, const ritz_dense *x,
                        ritz_dense *Ax, double *out)
{
    double sum = 0.0;

    ritz_dense_free(Ax);
    RITZ_CHECK(ritz_sparse_mul(A, x, Ax));
    for (int64_t i = 0; i < x->nrow; i++)
        sum += x->val[i] * Ax->val[i];
    *out = sqrt(fmax(sum, 0.0));
    return RITZ_OK;
}

/* x -= T T'A x, twice, and divide by what is left; `fresh` if there is any. */
static ritz_status orthogonalise(const ritz_sparse *A, const ritz_dense *T,
                                 int64_t count, ritz_dense *x, bool *fresh)
{
    ritz_status status = RITZ_OK;
    ritz_dense Ax = {0};
    double before = 0.0, left = 0.0;

    RITZ_TRY(norm(A, x, &Ax, &before));
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t j = 0; j < count; j++) {
            const double *t = ritz_dense_col(T, j);
            double q = 0.0;

            for (int64_t i = 0; i < x->nrow; i++)
                q += t[i] * Ax.val[i];
            for (int64_t i = 0; i < x->nrow; i++)
                x->val[i] -= q * t[i];
        }
        RITZ_TRY(norm(A, x, &Ax, &left));
    }
    *fresh = left > dependent * before && left > 0.0;
    for (int64_t i = 0; *fresh && i < x->nrow; i++)
        x->val[i] /= left;
done:
    ritz_dense_free(&Ax);
    return status;
}

/* Append to T, of which `count` columns are there, what X adds. */
static ritz_status append(const ritz_sparse *A, const ritz_dense *X,
                          ritz_dense *T, int64_t *count)
{
    ritz_status status = RITZ_OK;
    ritz_dense x = {0};
    bool fresh = false;

    for (int64_t j = 0; j < X->ncol; j++) {
        RITZ_TRY(ritz_dense_columns(X, j, 1, &x));
        RITZ_TRY(orthogonalise(A, T, *count, &x, &fresh));
        if (fresh)
            memcpy(ritz_dense_col(T, (*count)++), x.val,
                   (size_t)x.nrow * sizeof *x.val);
        ritz_dense_free(&x);
    }
done:
    ritz_dense_free(&x);
    return status;
}

/* T = [Phi X], its columns named. */
static ritz_status span_space(const ritz_component *component,
                              const ritz_pairs *pairs, ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    int64_t m = pairs->Phi.ncol;
    double sigma = pairs->sigma < 0.0 ? pairs->sigma : -1.0;
    ritz_sparse A = {0};
    ritz_factor *F = NULL;
    ritz_dense X = {0};
    ritz_basis basis = {0};
    int64_t count = 0;

    RITZ_TRY(ritz_sparse_add(1.0, &component->K, -sigma, &component->M, &A));
    RITZ_TRY(ritz_basis_new(component->num_dofs, m + component->dampers.count,
                            &basis));
    RITZ_TRY(append(&A, &pairs->Phi, &basis.T, &count));
    if (component->dampers.count > 0) {
        RITZ_TRY(ritz_dense_copy(&component->dampers.B, &X));
        RITZ_TRY_IN("static answer", ritz_factor_spd(&A, &F));
        RITZ_TRY(ritz_factor_solve(F, &X));
        RITZ_TRY(append(&A, &X, &basis.T, &count));
    }
    for (int64_t j = 0; j < pairs->num_rigid && j < count; j++)
        basis.columns.kind[j] = RITZ_COLUMN_RIGID;
    basis.T.ncol = basis.columns.count = count;
    *out = basis;
    basis = (ritz_basis){0};
done:
    ritz_factor_free(&F);
    ritz_sparse_free(&A);
    ritz_dense_free(&X);
    ritz_basis_free(&basis);
    return status;
}

ritz_status ritz_spectrum_space(const ritz_component *component,
                                const ritz_span *span, ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    ritz_pairs pairs = {0};
    ritz_basis basis = {0};

    RITZ_TRY(ritz_eigen_sparse(&component->K, &component->M, span, &pairs));
    RITZ_TRY(span_space(component, &pairs, &basis));
    RITZ_TRY(ritz_reduce(component, &basis, out));
done:
    ritz_pairs_free(&pairs);
    ritz_basis_free(&basis);
    return status;
}

ritz_status ritz_whole_new(const ritz_component *component, ritz_whole *out)
{
    RITZ_CHECK(ritz_sparse_dense(&component->K, &out->K));
    RITZ_CHECK(ritz_sparse_dense(&component->M, &out->M));
    if (component->D.colptr)
        RITZ_CHECK(ritz_sparse_dense(&component->D, &out->D));
    if (component->K4.colptr)
        RITZ_CHECK(ritz_sparse_dense(&component->K4, &out->K4));
    out->model = (ritz_second_order){&out->K, &out->M, &out->D, &out->K4, NULL};
    return RITZ_OK;
}

void ritz_whole_free(ritz_whole *whole)
{
    ritz_dense_free(&whole->K);
    ritz_dense_free(&whole->M);
    ritz_dense_free(&whole->D);
    ritz_dense_free(&whole->K4);
}

ritz_status ritz_scan_component(const ritz_component *component,
                                const ritz_damping *damping,
                                const ritz_scan_request *request,
                                ritz_scan *out)
{
    ritz_status status = RITZ_OK;
    ritz_span span = {.modes = EACH_MODE * (request->mode + 1) + LEAST_MODES};
    ritz_whole w = {0};
    ritz_reduced small = {0};
    const ritz_second_order model = {&small.K, &small.M, &small.D, &small.K4,
                                     NULL};

    if (component->num_dofs <= RITZ_WHOLE_DOFS) {
        RITZ_TRY(ritz_whole_new(component, &w));
        RITZ_TRY(ritz_scan_dampers(&w.model, &component->dampers, damping,
                                   request, out));
        goto done;
    }
    RITZ_TRY(ritz_spectrum_space(component, &span, &small));
    RITZ_TRY(ritz_scan_dampers(&model, &small.dampers, damping, request, out));
done:
    ritz_whole_free(&w);
    ritz_reduced_free(&small);
    return status;
}
