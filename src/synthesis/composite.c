/*
 * The composite mode set, projected on each body. At a configuration the
 * coordinates of body c are q_c = P_c x with x modal, so that its columns are
 *
 *     P_c [Phi_r, Phi_k]                 rigid and kept modes
 *     P_c Phi_t Lambda_t^-1 Phi_t' B     what the truncated ones answer to each
 *                                        input statically [LeeTsuha1992, eq. 37]
 *
 * over all configurations. With M_c = L L' the singular value decomposition of
 * L' W = U S V' tells which directions are independent: V_c = L'^-1 U_1 spans
 * what W spans, to the tolerance, and V_c' M_c V_c = I. Static corrections are
 * scaled to unit mass of the system, as modes are.
 */
#include "base/alloc.h"
#include "synthesis/compare_parts.h"

#include <cblas.h>
#include <lapacke.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Modal coordinates of the static correction of input j, of unit norm. */
static bool correct(const ritz_configuration *c, const bool *kept, int64_t j,
                    double *x)
{
    double norm = 0.0;

    for (int64_t k = 0; k < c->K.ncol; k++) {
        bool truncated = k >= c->num_rigid && !kept[k];

        x[k] = truncated ? ritz_dense_col(&c->io.B, j)[k] / c->lambda[k] : 0.0;
        norm += x[k] * x[k];
    }
    for (int64_t k = 0; k < c->K.ncol && norm > 0.0; k++)
        x[k] /= sqrt(norm);
    return norm > 0.0;
}

/* X, e x m: modal coordinates of all vectors that a configuration gives. */
static ritz_status choose(const ritz_configuration *c,
                          const ritz_compare_row *row, ritz_augment augment,
                          ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int64_t e = c->K.ncol;
    int64_t most = c->num_rigid + row->num_kept + c->io.num_inputs;
    ritz_dense X = {0};
    bool *kept = NULL;
    int64_t m = 0;

    RITZ_NEW(kept, e);
    RITZ_TRY(ritz_dense_new(e, most, &X));
    for (int64_t k = 0; k < c->num_rigid; k++)
        ritz_dense_col(&X, m++)[k] = 1.0;
    for (int64_t k = 0; k < row->num_kept; k++) {
        kept[c->num_rigid + row->kept[k]] = true;
        ritz_dense_col(&X, m++)[c->num_rigid + row->kept[k]] = 1.0;
    }
    for (int64_t j = 0; augment == RITZ_AUGMENT_SYSTEM && j < c->io.num_inputs;
         j++)
        m += correct(c, kept, j, ritz_dense_col(&X, m));
    RITZ_TRY(ritz_dense_columns(&X, 0, m, out));
done:
    free(kept);
    ritz_dense_free(&X);
    return status;
}

/* W = [W, P X]. */
static ritz_status append(const ritz_dense *P, const ritz_dense *X,
                          ritz_dense *W)
{
    ritz_status status = RITZ_OK;
    ritz_dense more = {0}, both = {0};
    int64_t before = W->val ? W->ncol : 0;

    RITZ_TRY(ritz_dense_mul(P, X, &more));
    RITZ_TRY(ritz_dense_new(P->nrow, before + more.ncol, &both));
    if (before > 0)
        memcpy(both.val, W->val, (size_t)(P->nrow * before) * sizeof *both.val);
    if (P->nrow * more.ncol > 0)
        memcpy(ritz_dense_col(&both, before), more.val,
               (size_t)(P->nrow * more.ncol) * sizeof *both.val);
    ritz_dense_free(W);
    *W = both;
    both = (ritz_dense){0};
done:
    ritz_dense_free(&more);
    ritz_dense_free(&both);
    return status;
}

/*
 * Lower Cholesky factor of the mass, in coordinates scaled to unit diagonal;
 * of mass and stiffness where mass alone is singular.
 */
static ritz_status factor(const ritz_reduced *body, const double *scale,
                          ritz_dense *L)
{
    ritz_status status = RITZ_OK;
    int64_t r = body->M.ncol;
    double stiffness = 0.0;
    double heaviest = ritz_dense_max(&body->M);
    double stiffest = ritz_dense_max(&body->K);

    RITZ_TRY(ritz_dense_new(r, r, L));
    for (int attempt = 0; attempt < 2; attempt++) {
        for (int64_t j = 0; j < r; j++)
            for (int64_t i = 0; i < r; i++)
                ritz_dense_col(L, j)[i] =
                    i < j ? 0.0
                          : scale[i] * scale[j] *
                                (ritz_dense_col(&body->M, j)[i] +
                                 stiffness * ritz_dense_col(&body->K, j)[i]);
        if (r == 0 ||
            LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', (int)r, L->val, (int)r) == 0)
            return RITZ_OK;
        stiffness = stiffest > 0.0 ? heaviest / stiffest : 0.0;
    }
    status = ritz_fail(RITZ_ERR_SINGULAR,
                       "the reduced mass is not positive definite");
done:
    return status;
}

/* U of L' W = U S V', and how many singular values exceed the tolerance. */
static ritz_status decompose(const ritz_dense *L, const double *scale,
                             const ritz_dense *W, double tolerance,
                             ritz_dense *U, int64_t *rank)
{
    ritz_status status = RITZ_OK;
    int r = (int)W->nrow;
    int m = (int)W->ncol;
    int least = r < m ? r : m;
    ritz_dense X = {0};
    double *sigma = NULL, *work = NULL;

    *rank = 0;
    RITZ_NEW(sigma, least);
    RITZ_NEW(work, least);
    RITZ_TRY(ritz_dense_copy(W, &X));
    RITZ_TRY(ritz_dense_new(r, least, U));
    if (least == 0)
        goto done;
    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < r; i++)
            ritz_dense_col(&X, j)[i] /= scale[i];
    cblas_dtrmm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit,
                r, m, 1.0, L->val, r, X.val, r);
    RITZ_FAIL_IF(LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'S', 'N', r, m, X.val, r,
                                sigma, U->val, r, NULL, 1, work) != 0,
                 RITZ_ERR_CONVERGENCE,
                 "singular values of the composite set do not converge");
    while (*rank < least && sigma[*rank] > tolerance * sigma[0])
        (*rank)++;
done:
    free(sigma);
    free(work);
    ritz_dense_free(&X);
    return status;
}

static ritz_status identity(int64_t r, ritz_dense *out)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_dense_new(r, r, out));
    for (int64_t j = 0; j < r; j++)
        ritz_dense_col(out, j)[j] = 1.0;
done:
    return status;
}

/* V of one body from the columns W that all configurations gave it. */
static ritz_status orthonormalise(const ritz_reduced *body, const double *scale,
                                  const ritz_dense *W, double tolerance,
                                  ritz_dense *V)
{
    ritz_status status = RITZ_OK;
    int64_t r = W->nrow;
    int64_t rank = 0;
    ritz_dense L = {0}, U = {0};

    RITZ_TRY(factor(body, scale, &L));
    RITZ_TRY(decompose(&L, scale, W, tolerance, &U, &rank));
    if (rank == r) { /* nothing to remove: leave the body as it is */
        RITZ_TRY(identity(r, V));
        goto done;
    }
    RITZ_TRY(ritz_dense_columns(&U, 0, rank, V));
    if (rank > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, (int)r, (int)rank, 1.0, L.val, (int)r, V->val,
                    (int)r);
    for (int64_t j = 0; j < rank; j++)
        for (int64_t i = 0; i < r; i++)
            ritz_dense_col(V, j)[i] *= scale[i];
done:
    ritz_dense_free(&L);
    ritz_dense_free(&U);
    return status;
}

/* Whether configuration k of the scene adds to the composite set. */
static bool counts(const ritz_scene *scene, int64_t k)
{
    for (int64_t j = 0; j < scene->num_reference; j++)
        if (scene->reference[j] == k)
            return true;
    return scene->num_reference == 0;
}

ritz_status ritz_compare_composite(const ritz_stage *stage,
                                   const ritz_system *system,
                                   const ritz_compare_row *row, ritz_dense *V,
                                   int64_t *count)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = stage->scene;
    ritz_dense *W = NULL;
    ritz_dense X = {0};
    double *scale = NULL;

    *count = 0;
    RITZ_NEW(W, stage->count);
    RITZ_NEW(scale, stage->num_coordinates);
    ritz_stage_scale(stage, scale);
    for (int64_t k = 0; k < system->num_configurations; k++) {
        if (!counts(scene, k))
            continue;
        RITZ_TRY(
            choose(&system->configuration[k], &row[k], scene->augment, &X));
        for (int64_t c = 0; c < stage->count; c++)
            RITZ_TRY(append(&system->configuration[k].P[c], &X, &W[c]));
        *count += X.ncol;
        ritz_dense_free(&X);
    }
    for (int64_t c = 0; c < stage->count; c++)
        RITZ_TRY_IN(scene->component[c].name,
                    orthonormalise(&stage->body[c], scale + stage->first[c],
                                   &W[c], scene->composite_tolerance, &V[c]));
done:
    for (int64_t c = 0; W && c < stage->count; c++)
        ritz_dense_free(&W[c]);
    free(W);
    free(scale);
    ritz_dense_free(&X);
    return status;
}
