/*
 * Sizes in units of energy, and columns of a factor Z, which grows, and is
 * compressed now and then: with S Z = Q R, S those units, and R = U s V', Z V
 * has columns that are orthogonal and of the lengths s; the short ones are left
 * out.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/low_rank_parts.h"
#include "linear/general.h"

#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns to begin with. */
enum { ROOM = 64 };

ritz_status ritz_low_rank_reserve(int64_t n, int64_t more,
                                  ritz_low_rank_columns *Z)
{
    int64_t room = Z->room > 0 ? Z->room : ROOM;
    double *val = NULL;

    if (Z->count + more <= Z->room)
        return RITZ_OK;
    while (room < Z->count + more)
        room += room / 2;
    RITZ_REFUSE_IF((double)(2 * n) * (double)(Z->count + more) * 8.0 >
                       RITZ_FACTOR_BYTES,
                   RITZ_ERR_CONVERGENCE,
                   "the Gramians have no low rank: %" PRId64
                   " columns of a factor are more than memory shall hold, take "
                   "engine 'modal' or fewer inputs and outputs",
                   Z->count + more);
    RITZ_CHECK_NEW(val, 2 * n * room);
    if (Z->count > 0)
        memcpy(val, Z->val, (size_t)(2 * n * Z->count) * sizeof *val);
    free(Z->val);
    Z->val = val;
    Z->room = room;
    return RITZ_OK;
}

/* Row i of the upper half: W_c has displacements there, W_o forces. */
static double unit_above(const ritz_low_rank_model *model, int side, int64_t i)
{
    double stiff = model->stiff[i];

    if (!(stiff > 0.0))
        return 0.0;
    return side == RITZ_CONTROLLABLE ? sqrt(stiff) : 1.0 / sqrt(stiff);
}

/* Row i of the lower half, velocities; of M times that, one over it. */
static double unit_below(const ritz_low_rank_model *model, int64_t i)
{
    return sqrt(fmax(model->mass[i], 0.0));
}

ritz_status ritz_low_rank_size(const ritz_low_rank_model *model, int side,
                               double *out)
{
    const ritz_dense *W = model->W[side];
    RITZ_OWN(ritz_dense_pair) S = {0}, G = {0};
    RITZ_OWN_ARRAY double *e = NULL;
    int p = (int)W[0].ncol;
    int info = 0;

    RITZ_CHECK_NEW(e, p);
    RITZ_CHECK(ritz_dense_copy(&W[RITZ_ABOVE], &S[RITZ_ABOVE]));
    RITZ_CHECK(ritz_dense_copy(&W[RITZ_BELOW], &S[RITZ_BELOW]));
    for (int64_t i = 0; i < model->n; i++) {
        double above = unit_above(model, side, i);
        double m = unit_below(model, i);

        for (int64_t j = 0; j < p; j++) {
            ritz_dense_col(&S[RITZ_ABOVE], j)[i] *= above;
            ritz_dense_col(&S[RITZ_BELOW], j)[i] *= m > 0.0 ? 1.0 / m : 0.0;
        }
    }
    for (int half = 0; half < RITZ_HALVES; half++)
        RITZ_CHECK(ritz_dense_mul_tn(&S[half], &S[half], &G[half]));
    for (int64_t k = 0; k < G[0].nrow * G[0].ncol; k++)
        G[0].val[k] += G[1].val[k];
    if (p > 0)
        info = LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'L', p, G[0].val, p, e);
    RITZ_REFUSE_IF(info != 0 || (p > 0 && !isfinite(e[p - 1])),
                   RITZ_ERR_CONVERGENCE,
                   "a residual of a Gramian is not finite");
    *out = p > 0 ? fmax(e[p - 1], 0.0) : 0.0;
    return RITZ_OK;
}

/* R of S Z = Q R. */
static ritz_status find_triangle(const ritz_low_rank_model *model, int side,
                                 const ritz_low_rank_columns *Z, ritz_dense *R)
{
    int64_t rows = 2 * model->n;
    int64_t k = Z->count;
    RITZ_OWN_ARRAY double *S = NULL, *tau = NULL;
    int info = 0;

    RITZ_CHECK_NEW(S, rows * k);
    RITZ_CHECK_NEW(tau, k);
    for (int64_t i = 0; i < rows; i++) {
        double by = i < model->n ? unit_above(model, side, i)
                                 : unit_below(model, i - model->n);

        for (int64_t j = 0; j < k; j++)
            S[i + j * rows] = by * Z->val[i + j * rows];
    }
    info =
        LAPACKE_dgeqrf(LAPACK_COL_MAJOR, (int)rows, (int)k, S, (int)rows, tau);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "a factor could not be compressed");
    RITZ_CHECK(ritz_dense_new(rows < k ? rows : k, k, R));
    for (int64_t j = 0; j < k; j++)
        for (int64_t i = 0; i <= j && i < R->nrow; i++)
            ritz_dense_col(R, j)[i] = S[i + j * rows];
    return RITZ_OK;
}

/* V of the long columns, k x r, from R, which is overwritten. */
static ritz_status find_long_columns(ritz_dense *R, ritz_dense *out)
{
    int m = (int)R->nrow;
    int k = (int)R->ncol;
    int64_t r = 0;
    RITZ_OWN_ARRAY double *s = NULL, *super = NULL;
    int info = 0;

    RITZ_CHECK_NEW(s, m);
    RITZ_CHECK_NEW(super, m);
    info = LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'N', 'O', m, k, R->val, m, s, NULL,
                          1, NULL, 1, super);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "a factor could not be compressed");
    while (r < m && s[r] > RITZ_SHORT_COLUMN * s[0])
        r++;
    RITZ_CHECK(ritz_dense_new(k, r, out));
    for (int64_t j = 0; j < r; j++)
        for (int64_t i = 0; i < k; i++)
            ritz_dense_col(out, j)[i] = ritz_dense_col(R, i)[j];
    return RITZ_OK;
}

ritz_status ritz_low_rank_compress(const ritz_low_rank_model *model, int side,
                                   ritz_low_rank_columns *Z)
{
    const ritz_dense all = {
        .nrow = 2 * model->n, .ncol = Z->count, .val = Z->val};
    RITZ_OWN(ritz_dense) R = {0}, V = {0}, turned = {0};

    if (Z->count == 0)
        return RITZ_OK;
    RITZ_CHECK(find_triangle(model, side, Z, &R));
    RITZ_CHECK(find_long_columns(&R, &V));
    RITZ_CHECK(ritz_dense_mul(&all, &V, &turned));
    free(Z->val);
    Z->val = turned.val;
    Z->count = Z->room = Z->settled = turned.ncol;
    turned.val = NULL;
    return RITZ_OK;
}
