/*
 * E = L L' where it is definite, L^-1 A L^-T in the place of A, and the scaling
 * of LAPACK's balancing: powers of a base, rows and columns of equal size.
 */
#include "linear/frame.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

/* E = L L' in place, its lower triangle; false if it cannot be trusted. */
static ritz_status factor_cholesky(ritz_dense *E, bool *good)
{
    int n = (int)E->nrow;
    RITZ_OWN_ARRAY double *root = NULL;
    double norm = 0.0, rcond = 0.0;

    *good = false;
    RITZ_CHECK_NEW(root, n);
    for (int64_t i = 0; i < n; i++) {
        root[i] = sqrt(ritz_dense_col(E, i)[i]);
        if (!(root[i] > 0.0))
            return RITZ_OK;
    }
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(E, j)[i] /= root[i] * root[j];
    norm = LAPACKE_dlansy(LAPACK_COL_MAJOR, '1', 'L', n, E->val, n);
    if (LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, E->val, n) != 0)
        return RITZ_OK;
    (void)LAPACKE_dpocon(LAPACK_COL_MAJOR, 'L', n, E->val, n, norm, &rcond);
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = j; i < n; i++)
            ritz_dense_col(E, j)[i] *= root[i];
    *good = rcond > RITZ_WELL_CONDITIONED;
    return RITZ_OK;
}

/* A := L^-1 A L^-T, symmetric if A is, if E is symmetric and definite. */
static ritz_status reduce_pencil(const ritz_dense *A, const ritz_dense *E,
                                 ritz_frame *f, bool *reduced)
{
    RITZ_OWN(ritz_dense) L = {0};
    int n = (int)E->nrow;

    *reduced = false;
    if (ritz_dense_asymmetry(E) > RITZ_SYMMETRIC_SUMS)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(E, &L));
    RITZ_CHECK(factor_cholesky(&L, reduced));
    if (!*reduced)
        return RITZ_OK;
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans,
                CblasNonUnit, n, n, 1.0, L.val, n, f->A.val, n);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit,
                n, n, 1.0, L.val, n, f->A.val, n);
    if (ritz_dense_asymmetry(A) == 0.0)
        ritz_dense_symmetrise(&f->A);
    RITZ_MOVE(f->L, L);
    return RITZ_OK;
}

static double least_of(int64_t count, const double *value)
{
    double least = HUGE_VAL;

    for (int64_t i = 0; i < count; i++)
        least = fmin(least, value[i]);
    return least;
}

static ritz_status scale_frame(ritz_frame *f)
{
    int n = (int)f->A.nrow;
    lapack_int low = 0, high = 0;
    int info = 0;

    if (f->E.val)
        info = LAPACKE_dggbal(LAPACK_COL_MAJOR, 'S', n, f->A.val, n, f->E.val,
                              n, &low, &high, f->left, f->right);
    else
        info = LAPACKE_dgebal(LAPACK_COL_MAJOR, 'S', n, f->A.val, n, &low,
                              &high, f->right);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_ARGUMENT,
                   "a matrix whose poles are wanted is not finite");
    for (int64_t i = 0; i < n && !f->E.val; i++)
        f->left[i] = 1.0 / f->right[i];
    return RITZ_OK;
}

/*
 * Rounding of the scaled matrix, eps |A|, is eps |A| / (left_i right_j) of the
 * given one. Where entries are themselves rounding, scaling magnifies them
 * without bound: then the matrices are left unscaled.
 */
static ritz_status balance_frame(ritz_frame *f)
{
    int64_t n = f->A.nrow;
    RITZ_OWN(ritz_dense) A = {0}, E = {0};
    double most = 0.0;

    RITZ_CHECK_NEW(f->right, n);
    RITZ_CHECK_NEW(f->left, n);
    RITZ_CHECK(ritz_dense_copy(&f->A, &A));
    if (f->E.val)
        RITZ_CHECK(ritz_dense_copy(&f->E, &E));
    if (n > 0)
        RITZ_CHECK(scale_frame(f));
    most = RITZ_FRAME_GROWTH * least_of(n, f->left) * least_of(n, f->right);
    if (n > 0 &&
        (ritz_general_size(&f->A) > most * ritz_general_size(&A) ||
         (E.val && ritz_general_size(&f->E) > most * ritz_general_size(&E)))) {
        memcpy(f->A.val, A.val, (size_t)(n * n) * sizeof *A.val);
        if (E.val)
            memcpy(f->E.val, E.val, (size_t)(n * n) * sizeof *E.val);
        for (int64_t i = 0; i < n; i++)
            f->left[i] = f->right[i] = 1.0;
    }
    return RITZ_OK;
}

ritz_status ritz_frame_new(const ritz_dense *A, const ritz_dense *E,
                           ritz_frame *out)
{
    RITZ_OWN(ritz_frame) f = {0};
    bool reduced = true;

    RITZ_CHECK(ritz_dense_copy(A, &f.A));
    if (E->val)
        RITZ_CHECK(reduce_pencil(A, E, &f, &reduced));
    if (!reduced)
        RITZ_CHECK(ritz_dense_copy(E, &f.E));
    RITZ_CHECK(balance_frame(&f));
    RITZ_MOVE(*out, f);
    return RITZ_OK;
}

/* V := L^-1 V, or L^-T V */
static void divide_factor(const ritz_frame *f, CBLAS_TRANSPOSE trans,
                          ritz_dense *V)
{
    if (f->L.val && V->ncol > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, trans, CblasNonUnit,
                    (int)V->nrow, (int)V->ncol, 1.0, f->L.val, (int)V->nrow,
                    V->val, (int)V->nrow);
}

void ritz_frame_turn_back(const ritz_frame *f, const double *scale,
                          ritz_dense *V)
{
    ritz_dense_scale_rows(scale, V);
    divide_factor(f, CblasTrans, V);
}

ritz_status ritz_frame_forward(const ritz_frame *f, const double *scale,
                               const ritz_dense *V, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_copy(V, out));
    divide_factor(f, CblasNoTrans, out);
    ritz_dense_scale_rows(scale, out);
    return RITZ_OK;
}

ritz_status ritz_frame_system(const ritz_dense *A, const ritz_dense *E,
                              const ritz_dense *B, const ritz_dense *C,
                              ritz_dense *out_A, ritz_dense *out_B,
                              ritz_dense *out_C)
{
    RITZ_OWN(ritz_frame) frame = {0};
    RITZ_OWN(ritz_dense) one = {0}, back = {0};

    RITZ_CHECK(ritz_frame_new(A, E, &frame));
    RITZ_CHECK(ritz_dense_copy(&frame.A, out_A));
    RITZ_CHECK(ritz_frame_forward(&frame, frame.left, B, out_B));
    RITZ_CHECK(ritz_general_transpose(C, &one));
    RITZ_CHECK(ritz_frame_forward(&frame, frame.right, &one, &back));
    RITZ_CHECK(ritz_general_transpose(&back, out_C));
    if (frame.E.val && A->nrow > 0) {
        RITZ_CHECK_IN("E", ritz_general_solve(&frame.E, false, out_A));
        RITZ_CHECK_IN("E", ritz_general_solve(&frame.E, false, out_B));
    }
    return RITZ_OK;
}

void ritz_frame_free(ritz_frame *f)
{
    ritz_dense_free(&f->A);
    ritz_dense_free(&f->E);
    ritz_dense_free(&f->L);
    RITZ_FREE(f->right, f->left);
    *f = (ritz_frame){0};
}
