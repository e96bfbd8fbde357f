/*
 * One shift p, of both equations at once; a pair of shifts p and conj(p) where
 * p is complex, whose columns are real [BennerKuerschnerSaak2013]. With the
 * halves of W and
 *
 *     Z(p) = p^2 M - p D + K,
 *
 *     (A + p E) v = W:    Z(p) v_1 = (p M - D) W_1 - W_2,  v_2 = W_1 - p v_1
 *     (A' + p E) v = W:   Z(p)'v_2 = p W_2 - W_1,  v_1 = W_2 - (p M - D')v_2
 *
 * so that one factor serves both. The columns added to the factor, and W:
 *
 *     real p:     sqrt(-2 p) v;                    W += -2 p E v
 *     complex p:  g v_+,  g sqrt(d^2 + 1) Im v;    W += g^2 E v_+
 *                 v_+ = Re v + d Im v, g^2 = -4 Re p, d = Re p / Im p
 */
#include "base/alloc.h"
#include "gramians/low_rank_parts.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* v of one side. */
typedef struct block {
    ritz_dense re[RITZ_HALVES], im[RITZ_HALVES];
} block;

static void free_block(block *v)
{
    for (int half = 0; half < RITZ_HALVES; half++) {
        ritz_dense_free(&v->re[half]);
        ritz_dense_free(&v->im[half]);
    }
}

/* What was solved for: v_1 of what is reached, v_2 of what is seen. */
static int solved(int side)
{
    return side == RITZ_REACHED ? RITZ_ABOVE : RITZ_BELOW;
}

/* out := a X + b Y */
static ritz_status combine(double a, const ritz_dense *X, double b,
                           const ritz_dense *Y, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(X->nrow, X->ncol, out));
    for (int64_t k = 0; k < X->nrow * X->ncol; k++)
        out->val[k] = a * X->val[k] + b * Y->val[k];
    return RITZ_OK;
}

/* x := (p M - D) W_1 - W_2 of what is reached. */
static ritz_status load_reached(const ritz_low_rank_model *model,
                                double _Complex p, double _Complex *x)
{
    ritz_status status = RITZ_OK;
    const ritz_dense *W = model->W[RITZ_REACHED];
    ritz_dense MW = {0}, DW = {0};

    RITZ_TRY(ritz_sparse_mul(&model->M, &W[RITZ_ABOVE], &MW));
    RITZ_TRY(ritz_sparse_mul(&model->D, &W[RITZ_ABOVE], &DW));
    for (int64_t k = 0; k < MW.nrow * MW.ncol; k++)
        x[k] = p * MW.val[k] - DW.val[k] - W[RITZ_BELOW].val[k];
done:
    ritz_dense_free(&MW);
    ritz_dense_free(&DW);
    return status;
}

static void load_seen(const ritz_low_rank_model *model, double _Complex p,
                      double _Complex *x)
{
    const ritz_dense *W = model->W[RITZ_SEEN];

    for (int64_t k = 0; k < W[0].nrow * W[0].ncol; k++)
        x[k] = p * W[RITZ_BELOW].val[k] - W[RITZ_ABOVE].val[k];
}

/* Real and imaginary parts of what was solved for, without rigid motion. */
static ritz_status part(const ritz_low_rank_model *model, int64_t columns,
                        const double _Complex *x, int half, block *v)
{
    ritz_dense *re = &v->re[half];
    ritz_dense *im = &v->im[half];

    RITZ_CHECK(ritz_dense_new(model->n, columns, re));
    RITZ_CHECK(ritz_dense_new(model->n, columns, im));
    for (int64_t k = 0; k < model->n * columns; k++) {
        re->val[k] = creal(x[k]);
        im->val[k] = cimag(x[k]);
    }
    if (model->Phi.ncol > 0) {
        RITZ_CHECK(ritz_dense_take_out(&model->Phi, &model->MPhi, re));
        RITZ_CHECK(ritz_dense_take_out(&model->Phi, &model->MPhi, im));
    }
    return RITZ_OK;
}

/* v_2 = W_1 - p v_1 */
static ritz_status finish_reached(const ritz_low_rank_model *model,
                                  double _Complex p, block *v)
{
    const ritz_dense *W = &model->W[RITZ_REACHED][RITZ_ABOVE];
    const ritz_dense *re = &v->re[RITZ_ABOVE];
    const ritz_dense *im = &v->im[RITZ_ABOVE];

    RITZ_CHECK(combine(-creal(p), re, cimag(p), im, &v->re[RITZ_BELOW]));
    RITZ_CHECK(combine(-creal(p), im, -cimag(p), re, &v->im[RITZ_BELOW]));
    for (int64_t k = 0; k < W->nrow * W->ncol; k++)
        v->re[RITZ_BELOW].val[k] += W->val[k];
    return RITZ_OK;
}

/* v_1 = W_2 - p M v_2 + D'v_2 */
static ritz_status finish_seen(const ritz_low_rank_model *model,
                               double _Complex p, block *v)
{
    ritz_status status = RITZ_OK;
    const ritz_sparse *Dt = model->Dt.colptr ? &model->Dt : &model->D;
    const ritz_dense *W = &model->W[RITZ_SEEN][RITZ_BELOW];
    ritz_dense Mre = {0}, Mim = {0}, Dre = {0}, Dim = {0};
    ritz_dense *re = &v->re[RITZ_ABOVE];
    ritz_dense *im = &v->im[RITZ_ABOVE];

    RITZ_TRY(ritz_sparse_mul(&model->M, &v->re[RITZ_BELOW], &Mre));
    RITZ_TRY(ritz_sparse_mul(&model->M, &v->im[RITZ_BELOW], &Mim));
    RITZ_TRY(ritz_sparse_mul(Dt, &v->re[RITZ_BELOW], &Dre));
    RITZ_TRY(ritz_sparse_mul(Dt, &v->im[RITZ_BELOW], &Dim));
    RITZ_TRY(combine(-creal(p), &Mre, cimag(p), &Mim, re));
    RITZ_TRY(combine(-creal(p), &Mim, -cimag(p), &Mre, im));
    for (int64_t k = 0; k < W->nrow * W->ncol; k++) {
        re->val[k] += W->val[k] + Dre.val[k];
        im->val[k] += Dim.val[k];
    }
done:
    ritz_dense_free(&Mre);
    ritz_dense_free(&Mim);
    ritz_dense_free(&Dre);
    ritz_dense_free(&Dim);
    return status;
}

/* Factor, and v of both sides that are open. */
static ritz_status solve(ritz_low_rank_sweep *sweep, double _Complex p,
                         block v[static RITZ_SIDES])
{
    ritz_status status = RITZ_OK;
    ritz_low_rank_model *model = &sweep->model;
    bool symmetric = !model->Dt.colptr;
    int64_t in = sweep->open[RITZ_REACHED] ? model->W[RITZ_REACHED][0].ncol : 0;
    int64_t seen = sweep->open[RITZ_SEEN] ? model->W[RITZ_SEEN][0].ncol : 0;
    double _Complex *x = NULL, *y = NULL;

    RITZ_NEW(x, model->n * (in + seen));
    y = x + model->n * in;
    if (in > 0)
        RITZ_TRY(load_reached(model, p, x));
    if (seen > 0)
        load_seen(model, p, y);
    RITZ_TRY(ritz_zldl_factor(sweep->F, (double _Complex[]){p * p, 1.0, -p}));
    RITZ_TRY(ritz_zldl_solve(sweep->F, symmetric ? in + seen : in, x));
    if (!symmetric)
        RITZ_TRY(ritz_zldl_solve_transposed(sweep->F, seen, y));
    if (in > 0) {
        RITZ_TRY(part(model, in, x, RITZ_ABOVE, &v[RITZ_REACHED]));
        RITZ_TRY(finish_reached(model, p, &v[RITZ_REACHED]));
    }
    if (seen > 0) {
        RITZ_TRY(part(model, seen, y, RITZ_BELOW, &v[RITZ_SEEN]));
        RITZ_TRY(finish_seen(model, p, &v[RITZ_SEEN]));
    }
done:
    free(x);
    return status;
}

/* Columns first .. of half a factor := f X */
static void put(const ritz_low_rank_model *model, int half, double f,
                const ritz_dense *X, int64_t first, ritz_low_rank_columns *Z)
{
    int64_t n = model->n;

    for (int64_t j = 0; j < X->ncol; j++)
        for (int64_t i = 0; i < n; i++)
            Z->val[(first + j) * 2 * n + half * n + i] =
                f * ritz_dense_col(X, j)[i];
}

/* W += f E v */
static ritz_status shrink(ritz_low_rank_model *model, int side, double f,
                          const ritz_dense v[static RITZ_HALVES])
{
    ritz_status status = RITZ_OK;
    ritz_dense *W = model->W[side];
    ritz_dense Mv = {0};

    RITZ_TRY(ritz_sparse_mul(&model->M, &v[RITZ_BELOW], &Mv));
    for (int64_t k = 0; k < Mv.nrow * Mv.ncol; k++) {
        W[RITZ_ABOVE].val[k] += f * v[RITZ_ABOVE].val[k];
        W[RITZ_BELOW].val[k] += f * Mv.val[k];
    }
done:
    ritz_dense_free(&Mv);
    return status;
}

static ritz_status append(ritz_low_rank_sweep *sweep, int side,
                          double _Complex p, const block *v)
{
    ritz_status status = RITZ_OK;
    ritz_low_rank_model *model = &sweep->model;
    ritz_low_rank_columns *Z = &sweep->Z[side];
    bool pair = cimag(p) != 0.0;
    double d = pair ? creal(p) / cimag(p) : 0.0;
    double g = sqrt((pair ? -4.0 : -2.0) * creal(p));
    int64_t columns = v->re[0].ncol;
    ritz_dense plus[RITZ_HALVES] = {0};

    RITZ_TRY(ritz_low_rank_reserve(model->n, pair ? 2 * columns : columns, Z));
    for (int half = 0; half < RITZ_HALVES; half++) {
        RITZ_TRY(combine(1.0, &v->re[half], d, &v->im[half], &plus[half]));
        put(model, half, g, &plus[half], Z->count, Z);
        if (pair)
            put(model, half, g * sqrt(d * d + 1.0), &v->im[half],
                Z->count + columns, Z);
    }
    Z->count += pair ? 2 * columns : columns;
    RITZ_TRY(shrink(model, side, g * g, plus));
    RITZ_TRY(
        ritz_low_rank_window_add(model, &v->re[solved(side)], &sweep->window));
    if (pair)
        RITZ_TRY(ritz_low_rank_window_add(model, &v->im[solved(side)],
                                          &sweep->window));
done:
    ritz_dense_free(&plus[RITZ_ABOVE]);
    ritz_dense_free(&plus[RITZ_BELOW]);
    return status;
}

ritz_status ritz_low_rank_step(ritz_low_rank_sweep *sweep, double _Complex p)
{
    ritz_status status = RITZ_OK;
    block v[RITZ_SIDES] = {0};

    RITZ_TRY(solve(sweep, p, v));
    for (int side = 0; side < RITZ_SIDES; side++)
        if (sweep->open[side])
            RITZ_TRY(append(sweep, side, p, &v[side]));
    sweep->shifts++;
    sweep->least = fmin(sweep->least, -creal(p) / cabs(p));
done:
    free_block(&v[RITZ_REACHED]);
    free_block(&v[RITZ_SEEN]);
    return status;
}
