/*
 * exp(A h) = exp(A t)^(2^j), t = h / 2^j with |A t| <= 1/2 in the 1-norm, where
 * 16 terms of its series are enough [MolerVanLoan1978]. The integral follows
 * along,
 *
 *     W(2 t) = W(t) + E(t)'W(t) E(t),
 *
 * and starts as a series too, as d/dt E'QE = E'L(Q)E, L(X) = A'X + X A:
 *
 *     W(t) = sum t^(k+1) / (k+1)! L^k(Q)
 *
 * Nothing in it grows if A is stable, unlike in exponentials of [-A' Q; 0 A].
 */
#include "linear/exponential.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <lapacke.h>
#include <math.h>

/* (1/2)^17 / 17! and 1 / 19! are below the rounding of 1. */
enum { TERMS = 17, INTEGRAL_TERMS = 20, MOST_DOUBLINGS = 60 };

static void scale_matrix(double factor, ritz_dense *A)
{
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        A->val[k] *= factor;
}

/* A := D^-1 A D with D = diag(d) of powers of two. */
static ritz_status balance_matrix(ritz_dense *A, double *d)
{
    lapack_int low = 0, high = 0;
    int n = (int)A->nrow;

    RITZ_REFUSE_IF(LAPACKE_dgebal(LAPACK_COL_MAJOR, 'S', n, A->val, n, &low,
                                  &high, d) != 0,
                   RITZ_ERR_ARGUMENT, "a matrix of states is not finite");
    return RITZ_OK;
}

/* A(i,j) *= d(i)^row d(j)^col, powers being 1 or -1. */
static void turn_matrix(const double *d, int row, int col, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] *=
                (row > 0 ? d[i] : 1.0 / d[i]) * (col > 0 ? d[j] : 1.0 / d[j]);
}

/* E = I + A (I + A / 2 (I + A / 3 (...))) */
static ritz_status sum_series(const ritz_dense *A, ritz_dense *E)
{
    RITZ_OWN(ritz_dense) AE = {0};

    RITZ_CHECK(ritz_dense_identity(A->nrow, E));
    for (int k = TERMS; k > 0; k--) {
        RITZ_CHECK(ritz_dense_mul(A, E, &AE));
        scale_matrix(1.0 / k, &AE);
        for (int64_t j = 0; j < A->nrow; j++)
            ritz_dense_col(&AE, j)[j] += 1.0;
        ritz_dense_replace(E, &AE);
    }
    return RITZ_OK;
}

/* The integral over t of A t = `A`. */
static ritz_status sum_integral(const ritz_dense *A, double t,
                                const ritz_dense *Q, ritz_dense *W)
{
    RITZ_OWN(ritz_dense) X = {0}, XA = {0};

    RITZ_CHECK(ritz_dense_copy(Q, &X));
    scale_matrix(t, &X);
    RITZ_CHECK(ritz_dense_copy(&X, W));
    for (int k = 2; k <= INTEGRAL_TERMS; k++) {
        RITZ_CHECK(ritz_dense_mul(&X, A, &XA));
        ritz_dense_symmetrise(&XA); /* half of X A + A'X */
        scale_matrix(2.0 / k, &XA);
        ritz_dense_replace(&X, &XA);
        ritz_dense_add(1.0, &X, W);
    }
    return RITZ_OK;
}

/* W += E'W E */
static ritz_status double_integral(const ritz_dense *E, ritz_dense *W)
{
    RITZ_OWN(ritz_dense) more = {0};

    RITZ_CHECK(ritz_dense_congruence(W, E, &more));
    ritz_dense_add(1.0, &more, W);
    return RITZ_OK;
}

/* Over t first, then doubled; A is scaled to A t. */
static ritz_status propagate_doubling(ritz_dense *A, double h, int count,
                                      ritz_dense *Q, ritz_dense *E,
                                      ritz_dense *W)
{
    int n = (int)A->nrow;
    double size =
        n > 0 ? h * LAPACKE_dlange(LAPACK_COL_MAJOR, '1', n, n, A->val, n)
              : 0.0;
    RITZ_OWN(ritz_dense) square = {0};
    int doublings = 0;

    (void)frexp(2.0 * size, &doublings);
    doublings = size > 0.5 ? doublings : 0;
    RITZ_REFUSE_IF(
        !isfinite(size) || doublings > MOST_DOUBLINGS, RITZ_ERR_ARGUMENT,
        "a step of %g s is too long for the fastest of its states", h);
    h = ldexp(h, -doublings);
    scale_matrix(h, A);
    RITZ_CHECK(sum_series(A, E));
    for (int k = 0; k < count; k++)
        RITZ_CHECK(sum_integral(A, h, &Q[k], &W[k]));
    for (int j = 0; j < doublings; j++) {
        for (int k = 0; k < count; k++)
            RITZ_CHECK(double_integral(E, &W[k]));
        RITZ_CHECK(ritz_dense_mul(E, E, &square));
        ritz_dense_replace(E, &square);
    }
    return RITZ_OK;
}

ritz_status ritz_exponential(const ritz_dense *A, double h, int count,
                             const ritz_dense *Q, ritz_dense *E, ritz_dense *W)
{
    RITZ_OWN(ritz_dense_pair) form = {0};
    RITZ_OWN(ritz_dense_pair) whole = {0};
    RITZ_OWN(ritz_dense) scaled = {0};
    RITZ_OWN(ritz_dense) made = {0};
    RITZ_OWN_ARRAY double *d = NULL;

    RITZ_REFUSE_IF(count > 2, RITZ_ERR_ARGUMENT, "two forms at most");
    RITZ_CHECK_NEW(d, A->nrow);
    RITZ_CHECK(ritz_dense_copy(A, &scaled));
    if (A->nrow > 0)
        RITZ_CHECK(balance_matrix(&scaled, d));
    for (int k = 0; k < count; k++) {
        RITZ_CHECK(ritz_dense_copy(&Q[k], &form[k]));
        turn_matrix(d, 1, 1, &form[k]);
    }
    RITZ_CHECK(propagate_doubling(&scaled, h, count, form, &made, whole));
    turn_matrix(d, 1, -1, &made);
    for (int k = 0; k < count; k++) {
        turn_matrix(d, -1, -1, &whole[k]);
        RITZ_MOVE(W[k], whole[k]);
    }
    RITZ_MOVE(*E, made);
    return RITZ_OK;
}
