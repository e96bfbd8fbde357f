/*
 * Exact Hankel singular values from the closed-form Gramians:
 *
 *     sigma_k = sqrt(lambda_k(W_c W_o)) = singular values of R'L,
 *     W_c = L L',   W_o = R R'
 *
 * The states are (w q, q'), and each Gramian is scaled to a unit diagonal
 * before its factor is taken: of lightly damped modes it is then close to the
 * identity however far their values lie apart. The factor is pivoted and stops
 * where the rest is rounding, so modes that are not reached, or not seen, get
 * zero and not a failure.
 *
 * [Moore1981], [McDaniel2000] eq. 3.2.19 to 3.2.21
 */
#include "base/alloc.h"

#include <ritz/modal.h>

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* W(i,j) := scale[i] W(i,j) scale[j] */
static void scale(ritz_dense *W, const double *by)
{
    for (int64_t j = 0; j < W->ncol; j++)
        for (int64_t i = 0; i < W->nrow; i++)
            ritz_dense_col(W, j)[i] *= by[i] * by[j];
}

/* Row permutation[i] of F is row i of the lower triangle of W, times by. */
static void unscramble(const ritz_dense *W, const lapack_int *permutation,
                       const double *by, ritz_dense *F)
{
    for (int64_t j = 0; j < F->ncol; j++)
        for (int64_t i = j; i < W->nrow; i++) {
            int64_t row = permutation[i] - 1;

            ritz_dense_col(F, j)[row] = by[row] * ritz_dense_col(W, j)[i];
        }
}

/* W = F F', F of as many columns as W has rank. Overwrites W. */
static ritz_status factor(ritz_dense *W, ritz_dense *F)
{
    ritz_status status = RITZ_OK;
    int64_t n = W->nrow;
    double *root = NULL;
    double *inverse = NULL;
    lapack_int *permutation = NULL;
    lapack_int rank = 0;
    int info = 0;

    RITZ_NEW(root, n);
    RITZ_NEW(inverse, n);
    RITZ_NEW(permutation, n);
    for (int64_t i = 0; i < n; i++) {
        root[i] = sqrt(fmax(ritz_dense_col(W, i)[i], 0.0));
        inverse[i] = root[i] > 0.0 ? 1.0 / root[i] : 0.0;
    }
    scale(W, inverse);
    if (n > 0) /* a tolerance below 0 stands for n eps max diag */
        info = LAPACKE_dpstrf(LAPACK_COL_MAJOR, 'L', (int)n, W->val, (int)n,
                              permutation, &rank, -1.0);
    RITZ_FAIL_IF(info < 0, RITZ_ERR_CONVERGENCE, "a Gramian is not finite");
    RITZ_TRY(ritz_dense_new(n, rank, F));
    unscramble(W, permutation, root, F);
done:
    free(root);
    free(inverse);
    free(permutation);
    return status;
}

/* Singular values of A, descending; overwrites A. */
static ritz_status singular(ritz_dense *A, double *sigma)
{
    ritz_status status = RITZ_OK;
    int info = 0;

    if (A->nrow > 0 && A->ncol > 0)
        info = LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'N', (int)A->nrow, (int)A->ncol,
                              A->val, (int)A->nrow, sigma, NULL, 1, NULL, 1);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE,
                 "singular values of the Gramians' factors were not found");
done:
    return status;
}

/* From (q, q') to (w q, q'): W_c grows by w, W_o shrinks. */
static ritz_status energy_states(const ritz_modal *modal, ritz_dense *Wc,
                                 ritz_dense *Wo)
{
    ritz_status status = RITZ_OK;
    double *up = NULL;
    double *down = NULL;

    RITZ_NEW(up, 2 * modal->count);
    RITZ_NEW(down, 2 * modal->count);
    for (int64_t k = 0; k < modal->count; k++) {
        up[2 * k] = modal->omega[k];
        down[2 * k] = 1.0 / modal->omega[k];
        up[2 * k + 1] = 1.0;
        down[2 * k + 1] = 1.0;
    }
    scale(Wc, up);
    scale(Wo, down);
done:
    free(up);
    free(down);
    return status;
}

ritz_status ritz_modal_hankel(const ritz_modal *modal, double *sigma)
{
    ritz_status status = RITZ_OK;
    ritz_dense Wc = {0};
    ritz_dense Wo = {0};
    ritz_dense L = {0};
    ritz_dense R = {0};
    ritz_dense RL = {0};

    for (int64_t k = 0; k < 2 * modal->count; k++)
        sigma[k] = 0.0;
    RITZ_TRY(ritz_modal_gramians(modal, &Wc, &Wo));
    RITZ_TRY(energy_states(modal, &Wc, &Wo));
    RITZ_TRY(factor(&Wc, &L));
    RITZ_TRY(factor(&Wo, &R));
    RITZ_TRY(ritz_dense_mul_tn(&R, &L, &RL));
    RITZ_TRY(singular(&RL, sigma));
done:
    ritz_dense_free(&Wc);
    ritz_dense_free(&Wo);
    ritz_dense_free(&L);
    ritz_dense_free(&R);
    ritz_dense_free(&RL);
    return status;
}
