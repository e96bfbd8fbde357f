/*
 * The Lyapunov equation projected on the span of V, and the residual of its
 * solution X = V Y V'. With A_k = (V'E V)^-1 V'A V and F_k = (V'E V)^-1 V'F,
 *
 *     A_k Y + Y A_k' + F_k F_k' = 0,    Y = U U',
 *
 * and with the triangle T of [E V, A V, F] = Q T, Q'Q = I, the residual is
 *
 *     R = Q (T_A Y T_E' + T_E Y T_A' + T_F T_F') Q',
 *
 * whose 2-norm is that of the small matrix in brackets. The residual is known up
 * to the rounding of A X E'.
 */
#include "gramians/galerkin.h"
#include "base/alloc.h"
#include "linear/general.h"

#include <cblas.h>
#include <lapacke.h>

/* A := Q of A = Q T if the vectors are wanted, otherwise A is lost; of n x k, T
   is min(n, k) x k, NULL: not wanted. */
static ritz_status factor_orthogonal(ritz_dense *A, bool vectors, ritz_dense *T)
{
    const int n = (int)A->nrow, k = (int)A->ncol;
    const int64_t rows = n < k ? n : k;
    RITZ_OWN_ARRAY double *tau = NULL;
    int info = 0;

    RITZ_CHECK_NEW(tau, rows);
    info = LAPACKE_dgeqrf(LAPACK_COL_MAJOR, n, k, A->val, n, tau);
    if (info == 0 && T) {
        RITZ_CHECK(ritz_dense_new(rows, k, T));
        for (int64_t j = 0; j < k; j++)
            for (int64_t i = 0; i <= j && i < rows; i++)
                ritz_dense_col(T, j)[i] = ritz_dense_col(A, j)[i];
    }
    if (info == 0 && vectors)
        info = LAPACKE_dorgqr(LAPACK_COL_MAJOR, n, (int)rows, (int)rows, A->val,
                              n, tau);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_MEMORY,
                   "no memory to make %d columns orthogonal", k);
    if (vectors)
        A->ncol = rows;
    return RITZ_OK;
}

/* An orthonormal basis of the span of S. */
static ritz_status span_columns(const ritz_dense *S, ritz_dense *V)
{
    RITZ_CHECK(ritz_dense_copy(S, V));
    for (int64_t j = 0; j < V->ncol; j++) {
        double *v = ritz_dense_col(V, j);
        const double size = cblas_dnrm2((int)V->nrow, v, 1);

        if (size > 0.0)
            cblas_dscal((int)V->nrow, 1.0 / size, v, 1);
    }
    return factor_orthogonal(V, true, NULL);
}

/* U of the solution Y = U U' of the projected equation. */
static ritz_status solve_projected(const ritz_dense *V, const ritz_dense *AV,
                                   const ritz_dense *EV, const ritz_dense *F,
                                   ritz_dense *U)
{
    RITZ_OWN(ritz_dense) A = {0}, E = {0}, f = {0};

    RITZ_CHECK(ritz_dense_mul_tn(V, AV, &A));
    RITZ_CHECK(ritz_dense_mul_tn(V, EV, &E));
    RITZ_CHECK(ritz_dense_mul_tn(V, F, &f));
    RITZ_CHECK(ritz_general_solve(&E, false, &A));
    RITZ_CHECK(ritz_general_solve(&E, false, &f));
    return ritz_general_gramian(&A, &f, U);
}

/* |T_A U (T_E U)' + T_E U (T_A U)' + T_F T_F'| */
static ritz_status measure_residual(const ritz_dense *T, const ritz_dense *U,
                                    double *out)
{
    const int64_t k = U->nrow, r = T->nrow;
    RITZ_OWN(ritz_dense) E = {0}, A = {0}, F = {0}, EU = {0}, AU = {0};
    RITZ_OWN(ritz_dense) R = {0}, Rt = {0}, FF = {0};

    RITZ_CHECK(ritz_dense_block(T, 0, r, 0, k, &E));
    RITZ_CHECK(ritz_dense_block(T, 0, r, k, k, &A));
    RITZ_CHECK(ritz_dense_block(T, 0, r, 2 * k, T->ncol - 2 * k, &F));
    RITZ_CHECK(ritz_dense_mul(&E, U, &EU));
    RITZ_CHECK(ritz_dense_mul(&A, U, &AU));
    RITZ_CHECK(ritz_dense_mul_nt(&AU, &EU, &R));
    RITZ_CHECK(ritz_general_transpose(&R, &Rt));
    RITZ_CHECK(ritz_dense_mul_nt(&F, &F, &FF));
    ritz_dense_add(1.0, &Rt, &R);
    ritz_dense_add(1.0, &FF, &R);
    return ritz_general_norm(&R, out);
}

ritz_status ritz_galerkin_gramian(const ritz_pencil *pencil, bool transposed,
                                  const ritz_dense *S, const ritz_dense *F,
                                  ritz_dense *Z, double *residual)
{
    RITZ_OWN(ritz_dense) V = {0}, AV = {0}, EV = {0}, U = {0};
    RITZ_OWN(ritz_dense) both = {0}, all = {0}, T = {0};

    RITZ_CHECK(span_columns(S, &V));
    RITZ_CHECK(
        ritz_sparse_mul(ritz_pencil_system(pencil, transposed), &V, &AV));
    RITZ_CHECK(
        ritz_sparse_mul(ritz_pencil_descriptor(pencil, transposed), &V, &EV));
    RITZ_CHECK(solve_projected(&V, &AV, &EV, F, &U));
    RITZ_CHECK(ritz_dense_beside(&EV, &AV, &both));
    RITZ_CHECK(ritz_dense_beside(&both, F, &all));
    RITZ_CHECK(factor_orthogonal(&all, false, &T));
    RITZ_CHECK(measure_residual(&T, &U, residual));
    return ritz_dense_mul(&V, &U, Z);
}
