/*
 * Low-rank ADI for the Gramians of M u'' + D u' + K u = B f, y = C u + Cv u',
 * of first order E x' = A x + [0; B] f with E = [I 0; 0 M], A = [0 I; -K -D],
 * neither of which is formed. With W_0 = [0; B] and shifts p left of the axis
 *
 *     v_j = (A + p_j E)^-1 W_j-1,    W_j = W_j-1 - 2 p_j E v_j,
 *     Z = [sqrt(-2 p_1) v_1, sqrt(-2 p_2) v_2, ...],
 *
 *     A Z Z'E + E Z Z'A' + B B' = W_j W_j'
 *
 * so that |W_j'W_j| is the residual. Transposed, W_0 = [C'; Cv'], it is the
 * other Gramian, of the same factors. Shifts: low_rank_shifts.c.
 *
 * A mode whose poles lie apart from all others, by more than their distance to
 * the axis, needs a shift of its own. Many such modes have no low rank: what
 * the residual has done so far says how many shifts it will take.
 *
 * [LiWhite2002], [BennerKuerschnerSaak2013], [BennerKuerschnerSaak2014]
 */
#include "gramians/low_rank.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/low_rank_parts.h"

#include <ritz/base.h>

#include <complex.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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

/* v of one side. */
typedef struct half_block {
    ritz_dense re[RITZ_HALVES], im[RITZ_HALVES];
} half_block;

static void free_block(half_block *v)
{
    for (int half = 0; half < RITZ_HALVES; half++) {
        ritz_dense_free(&v->re[half]);
        ritz_dense_free(&v->im[half]);
    }
}

/* The half of v that is solved for: v_1 for controllability, v_2 for
   observability. */
static int solved_half(int side)
{
    return side == RITZ_REACHED ? RITZ_ABOVE : RITZ_BELOW;
}

/* out := a X + b Y */
static ritz_status combine_columns(double a, const ritz_dense *X, double b,
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
    const ritz_dense *W = model->W[RITZ_REACHED];
    RITZ_OWN(ritz_dense) MW = {0}, DW = {0};

    RITZ_CHECK(ritz_sparse_mul(&model->M, &W[RITZ_ABOVE], &MW));
    RITZ_CHECK(ritz_sparse_mul(&model->D, &W[RITZ_ABOVE], &DW));
    for (int64_t k = 0; k < MW.nrow * MW.ncol; k++)
        x[k] = p * MW.val[k] - DW.val[k] - W[RITZ_BELOW].val[k];
    return RITZ_OK;
}

static void load_seen(const ritz_low_rank_model *model, double _Complex p,
                      double _Complex *x)
{
    const ritz_dense *W = model->W[RITZ_SEEN];

    for (int64_t k = 0; k < W[0].nrow * W[0].ncol; k++)
        x[k] = p * W[RITZ_BELOW].val[k] - W[RITZ_ABOVE].val[k];
}

/* Real and imaginary parts of what was solved for, without rigid motion. */
static ritz_status split_parts(const ritz_low_rank_model *model,
                               int64_t columns, const double _Complex *x,
                               int half, half_block *v)
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
                                  double _Complex p, half_block *v)
{
    const ritz_dense *W = &model->W[RITZ_REACHED][RITZ_ABOVE];
    const ritz_dense *re = &v->re[RITZ_ABOVE];
    const ritz_dense *im = &v->im[RITZ_ABOVE];

    RITZ_CHECK(
        combine_columns(-creal(p), re, cimag(p), im, &v->re[RITZ_BELOW]));
    RITZ_CHECK(
        combine_columns(-creal(p), im, -cimag(p), re, &v->im[RITZ_BELOW]));
    for (int64_t k = 0; k < W->nrow * W->ncol; k++)
        v->re[RITZ_BELOW].val[k] += W->val[k];
    return RITZ_OK;
}

/* v_1 = W_2 - p M v_2 + D'v_2 */
static ritz_status finish_seen(const ritz_low_rank_model *model,
                               double _Complex p, half_block *v)
{
    const ritz_sparse *Dt = model->Dt.colptr ? &model->Dt : &model->D;
    const ritz_dense *W = &model->W[RITZ_SEEN][RITZ_BELOW];
    RITZ_OWN(ritz_dense) Mre = {0}, Mim = {0}, Dre = {0}, Dim = {0};
    ritz_dense *re = &v->re[RITZ_ABOVE];
    ritz_dense *im = &v->im[RITZ_ABOVE];

    RITZ_CHECK(ritz_sparse_mul(&model->M, &v->re[RITZ_BELOW], &Mre));
    RITZ_CHECK(ritz_sparse_mul(&model->M, &v->im[RITZ_BELOW], &Mim));
    RITZ_CHECK(ritz_sparse_mul(Dt, &v->re[RITZ_BELOW], &Dre));
    RITZ_CHECK(ritz_sparse_mul(Dt, &v->im[RITZ_BELOW], &Dim));
    RITZ_CHECK(combine_columns(-creal(p), &Mre, cimag(p), &Mim, re));
    RITZ_CHECK(combine_columns(-creal(p), &Mim, -cimag(p), &Mre, im));
    for (int64_t k = 0; k < W->nrow * W->ncol; k++) {
        re->val[k] += W->val[k] + Dre.val[k];
        im->val[k] += Dim.val[k];
    }
    return RITZ_OK;
}

/* Factor, and v of both sides that are open. */
static ritz_status solve_shifted(ritz_low_rank_sweep *sweep, double _Complex p,
                                 half_block v[static RITZ_SIDES])
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
        RITZ_TRY(split_parts(model, in, x, RITZ_ABOVE, &v[RITZ_REACHED]));
        RITZ_TRY(finish_reached(model, p, &v[RITZ_REACHED]));
    }
    if (seen > 0) {
        RITZ_TRY(split_parts(model, seen, y, RITZ_BELOW, &v[RITZ_SEEN]));
        RITZ_TRY(finish_seen(model, p, &v[RITZ_SEEN]));
    }
done:
    free(x);
    return status;
}

/* Columns first .. of half a factor := f X */
static void put_half(const ritz_low_rank_model *model, int half, double f,
                     const ritz_dense *X, int64_t first,
                     ritz_low_rank_columns *Z)
{
    int64_t n = model->n;

    for (int64_t j = 0; j < X->ncol; j++)
        for (int64_t i = 0; i < n; i++)
            Z->val[(first + j) * 2 * n + half * n + i] =
                f * ritz_dense_col(X, j)[i];
}

/* W += f E v */
static ritz_status shrink_residual(ritz_low_rank_model *model, int side,
                                   double f,
                                   const ritz_dense v[static RITZ_HALVES])
{
    ritz_dense *W = model->W[side];
    RITZ_OWN(ritz_dense) Mv = {0};

    RITZ_CHECK(ritz_sparse_mul(&model->M, &v[RITZ_BELOW], &Mv));
    for (int64_t k = 0; k < Mv.nrow * Mv.ncol; k++) {
        W[RITZ_ABOVE].val[k] += f * v[RITZ_ABOVE].val[k];
        W[RITZ_BELOW].val[k] += f * Mv.val[k];
    }
    return RITZ_OK;
}

static ritz_status append_columns(ritz_low_rank_sweep *sweep, int side,
                                  double _Complex p, const half_block *v)
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
        RITZ_TRY(
            combine_columns(1.0, &v->re[half], d, &v->im[half], &plus[half]));
        put_half(model, half, g, &plus[half], Z->count, Z);
        if (pair)
            put_half(model, half, g * sqrt(d * d + 1.0), &v->im[half],
                     Z->count + columns, Z);
    }
    Z->count += pair ? 2 * columns : columns;
    RITZ_TRY(shrink_residual(model, side, g * g, plus));
    RITZ_TRY(ritz_low_rank_window_add(model, &v->re[solved_half(side)],
                                      &sweep->window));
    if (pair)
        RITZ_TRY(ritz_low_rank_window_add(model, &v->im[solved_half(side)],
                                          &sweep->window));
done:
    ritz_dense_free(&plus[RITZ_ABOVE]);
    ritz_dense_free(&plus[RITZ_BELOW]);
    return status;
}

/* Take one shift, or a pair of them, and add what it gives. */
static ritz_status take_shift(ritz_low_rank_sweep *sweep, double _Complex p)
{
    ritz_status status = RITZ_OK;
    half_block v[RITZ_SIDES] = {0};

    RITZ_TRY(solve_shifted(sweep, p, v));
    for (int side = 0; side < RITZ_SIDES; side++)
        if (sweep->open[side])
            RITZ_TRY(append_columns(sweep, side, p, &v[side]));
    sweep->shifts++;
    sweep->least = fmin(sweep->least, -creal(p) / cabs(p));
done:
    free_block(&v[RITZ_REACHED]);
    free_block(&v[RITZ_SEEN]);
    return status;
}

enum {
    TOGETHER = 2,  /* shifts of one projection */
    GROWN_BY = 256 /* columns beside twice what was left, to compress again */
};

/*
 * After so many shifts, if more than so much is left, no more than so many may
 * be expected in all.
 */
typedef struct patience {
    int64_t after, total;
    double left;
} patience;

static const patience patiences[] = {
    {20, 5L * RITZ_LOW_RANK_SHIFTS, 0.9},
    {60, 5L * RITZ_LOW_RANK_SHIFTS, 0.0},
    {120, 2L * RITZ_LOW_RANK_SHIFTS, 0.0},
    {RITZ_LOW_RANK_SHIFTS, RITZ_LOW_RANK_SHIFTS, 0.0},
};

static void free_sweep(ritz_low_rank_sweep *sweep)
{
    ritz_zldl_free(&sweep->F);
    ritz_low_rank_window_free(&sweep->window);
    ritz_low_rank_model_free(&sweep->model);
    free(sweep->Z[RITZ_REACHED].val);
    free(sweep->Z[RITZ_SEEN].val);
}

/* A side is open that flexible motion has a part in. */
static ritz_status start_sweep(const ritz_gramians_request *request,
                               ritz_low_rank_sweep *sweep)
{
    ritz_low_rank_model *model = &sweep->model;
    const ritz_sparse *const A[] = {&model->M, &model->K, &model->D};

    RITZ_REFUSE_IF(!(request->tolerance >= 0.0 && request->tolerance < 1.0),
                   RITZ_ERR_ARGUMENT, "a tolerance is between 0 and 1, not %g",
                   request->tolerance);
    sweep->tolerance =
        request->tolerance > 0.0 ? request->tolerance : RITZ_ADI_TOLERANCE;
    sweep->least = 1.0;
    RITZ_CHECK(ritz_low_rank_model_new(request, model));
    for (int side = 0; side < RITZ_SIDES; side++) {
        RITZ_CHECK(ritz_low_rank_size(model, side, &sweep->first[side]));
        sweep->open[side] =
            model->num_starts > 0 &&
            sweep->first[side] > RITZ_ADI_NOTHING * model->whole[side];
        sweep->residual[side] = sweep->open[side] ? 1.0 : 0.0;
    }
    RITZ_CHECK(ritz_low_rank_window_new(model, &sweep->window));
    RITZ_CHECK(ritz_zldl_new(3, A, &sweep->F));
    ritz_zldl_definite(sweep->F);
    return RITZ_OK;
}

static bool is_open(const ritz_low_rank_sweep *sweep)
{
    return sweep->open[RITZ_REACHED] || sweep->open[RITZ_SEEN];
}

/* Residuals after a step, and factors that grew compressed. */
static ritz_status update_residuals(ritz_low_rank_sweep *sweep)
{
    for (int side = 0; side < RITZ_SIDES; side++) {
        ritz_low_rank_columns *Z = &sweep->Z[side];
        double size = 0.0;

        if (!sweep->open[side])
            continue;
        RITZ_CHECK(ritz_low_rank_size(&sweep->model, side, &size));
        sweep->residual[side] = size / sweep->first[side];
        sweep->open[side] = sweep->residual[side] > sweep->tolerance;
        if (Z->count > 2 * Z->settled + GROWN_BY)
            RITZ_CHECK(ritz_low_rank_compress(&sweep->model, side, Z));
    }
    ritz_monitor_step("shifts", sweep->shifts, 0);
    return RITZ_OK;
}

static double worst_residual(const ritz_low_rank_sweep *sweep)
{
    return fmax(sweep->residual[RITZ_REACHED], sweep->residual[RITZ_SEEN]);
}

/* Shifts in all, if the second half of those so far is how it goes on. */
static double expected_shifts(const ritz_low_rank_sweep *sweep,
                              const double *history)
{
    int64_t half = sweep->shifts / 2;
    double now = log(worst_residual(sweep) / sweep->tolerance);
    double rate = (log(history[half]) - log(worst_residual(sweep))) /
                  (double)(sweep->shifts - half);

    if (!(rate > 0.0))
        return HUGE_VAL;
    return (double)sweep->shifts + now / rate;
}

/*
 * Whether it goes too slowly. A small model may take a shift for every mode.
 */
static ritz_status refuse_slow(const ritz_low_rank_sweep *sweep,
                               const double *history)
{
    bool small = sweep->model.n < RITZ_LOW_RANK_SHIFTS;
    double total = 0.0;

    for (size_t k = 0; k < sizeof patiences / sizeof *patiences; k++)
        if (sweep->shifts >= patiences[k].after && is_open(sweep) &&
            worst_residual(sweep) > patiences[k].left &&
            (!small || patiences[k].after == RITZ_LOW_RANK_SHIFTS))
            total = fmax(total, expected_shifts(sweep, history) /
                                    (double)patiences[k].total);
    RITZ_REFUSE_IF(
        total > 1.0, RITZ_ERR_CONVERGENCE,
        "the Gramians have no low rank: after %" PRId64
        " shifts the residual is %.1e, and the lightest damping they "
        "met is a ratio of about %.0e: take engine 'modal', or more damping",
        sweep->shifts, worst_residual(sweep), sweep->least);
    return RITZ_OK;
}

static ritz_status run_sweep(ritz_low_rank_sweep *sweep)
{
    double history[RITZ_LOW_RANK_SHIFTS + 1] = {1.0};
    double _Complex shift[TOGETHER];
    int64_t starts = sweep->model.num_starts;

    while (is_open(sweep)) {
        int64_t count = 1;

        if (sweep->shifts < starts)
            shift[0] = sweep->model.start[sweep->shifts];
        else
            RITZ_CHECK(ritz_low_rank_shifts(&sweep->model, &sweep->window,
                                            sweep->open, TOGETHER, &count,
                                            shift));
        for (int64_t k = 0; k < count && is_open(sweep); k++) {
            RITZ_CHECK(take_shift(sweep, shift[k]));
            RITZ_CHECK(update_residuals(sweep));
            RITZ_CHECK(refuse_slow(sweep, history));
            history[sweep->shifts] = worst_residual(sweep);
        }
    }
    return RITZ_OK;
}

/* Z as a matrix of its own columns. */
static ritz_status take_factor(ritz_low_rank_sweep *sweep, int side,
                               ritz_dense *out)
{
    ritz_low_rank_columns *Z = &sweep->Z[side];

    RITZ_CHECK(ritz_low_rank_compress(&sweep->model, side, Z));
    if (!Z->val)
        return ritz_dense_new(2 * sweep->model.n, 0, out);
    *out = (ritz_dense){
        .nrow = 2 * sweep->model.n, .ncol = Z->count, .val = Z->val};
    *Z = (ritz_low_rank_columns){0};
    return RITZ_OK;
}

/* Rows first.. of columns from.. of @p to := X */
static void put_rows(const ritz_dense *X, int64_t first, int64_t from,
                     ritz_dense *to)
{
    for (int64_t j = 0; j < X->ncol; j++)
        for (int64_t i = 0; i < X->nrow; i++)
            ritz_dense_col(to, from + j)[first + i] = ritz_dense_col(X, j)[i];
}

/* [I 0; 0 M] Z */
static ritz_status by_mass(const ritz_low_rank_model *model,
                           const ritz_dense *Z, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) below = {0}, MZ = {0};

    RITZ_CHECK(ritz_dense_new(model->n, Z->ncol, &below));
    for (int64_t j = 0; j < Z->ncol; j++)
        for (int64_t i = 0; i < model->n; i++)
            ritz_dense_col(&below, j)[i] = ritz_dense_col(Z, j)[model->n + i];
    RITZ_CHECK(ritz_sparse_mul(&model->M, &below, &MZ));
    RITZ_CHECK(ritz_dense_copy(Z, out));
    put_rows(&MZ, model->n, 0, out);
    return RITZ_OK;
}

static ritz_status finish_gramians(ritz_low_rank_sweep *sweep,
                                   ritz_gramians *out)
{
    const ritz_low_rank_model *model = &sweep->model;
    int64_t n = model->n;
    int64_t a = model->Phi.ncol;

    ritz_zldl_free(&sweep->F);
    RITZ_CHECK(take_factor(sweep, RITZ_REACHED, &out->Zc));
    RITZ_CHECK(take_factor(sweep, RITZ_SEEN, &out->Zo));
    RITZ_CHECK(by_mass(model, &out->Zc, &out->EZc));
    RITZ_CHECK(ritz_dense_new(2 * n, 2 * a, &out->T));
    RITZ_CHECK(ritz_dense_new(2 * n, 2 * a, &out->W));
    put_rows(&model->Phi, 0, 0, &out->T);
    put_rows(&model->Phi, n, a, &out->T);
    put_rows(&model->MPhi, 0, 0, &out->W);
    put_rows(&model->Phi, n, a, &out->W);
    out->residual[0] = sweep->residual[RITZ_REACHED];
    out->residual[1] = sweep->residual[RITZ_SEEN];
    snprintf(out->engine, sizeof out->engine, "ADI, %" PRId64 " shifts",
             sweep->shifts);
    return RITZ_OK;
}

ritz_status ritz_gramians_low_rank(const ritz_gramians_request *request,
                                   ritz_gramians *out)
{
    ritz_status status = RITZ_OK;
    ritz_low_rank_sweep sweep = {0};
    ritz_gramians gramians = {0};

    RITZ_TRY(start_sweep(request, &sweep));
    RITZ_TRY(run_sweep(&sweep));
    RITZ_TRY(finish_gramians(&sweep, &gramians));
    if (request->damping.kind != RITZ_DAMPING_NONE)
        ritz_damping_print(&request->damping, gramians.damping);
    RITZ_MOVE(*out, gramians);
done:
    free_sweep(&sweep);
    ritz_gramians_free(&gramians);
    return status;
}
