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
 * A mode whose poles are farther from all others than from the axis needs a
 * shift of its own. Gramians of many such modes have no low rank: the residuals
 * so far show how many shifts it will take.
 *
 * [LiWhite2002], [BennerKuerschnerSaak2013], [BennerKuerschnerSaak2014]
 */
#include "gramians/low_rank_parts.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/modes.h"
#include "linear/general.h"

#include <ritz/base.h>

#include <complex.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * Columns of a factor Z, which grows, and is compressed now and then: with
 * S Z = Q R, S the units of energy, and R = U s V', Z V has columns that are
 * orthogonal and of the lengths s; the short ones are left out.
 */

/* Columns of a factor Z = [above; below], with room for more. */
typedef struct factor_columns {
    int64_t count, room;
    int64_t settled; /* how many were left when they were compressed last */
    double *val;     /* 2n x room */
} factor_columns;

/* Columns to begin with. */
enum { ROOM = 64 };

/* Room for `more` columns of 2n rows. */
static ritz_status reserve_columns(int64_t n, int64_t more, factor_columns *Z)
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

/* R of S Z = Q R. */
static ritz_status find_triangle(const ritz_low_rank_model *model, int side,
                                 const factor_columns *Z, ritz_dense *R)
{
    int64_t rows = 2 * model->n;
    int64_t k = Z->count;
    RITZ_OWN_ARRAY double *S = NULL, *tau = NULL;

    RITZ_CHECK_NEW(S, rows * k);
    RITZ_CHECK_NEW(tau, k);
    for (int64_t i = 0; i < rows; i++) {
        double by = ritz_low_rank_unit(model, side, i);

        for (int64_t j = 0; j < k; j++)
            S[i + j * rows] = by * Z->val[i + j * rows];
    }
    RITZ_REFUSE_IF(LAPACKE_dgeqrf(LAPACK_COL_MAJOR, (int)rows, (int)k, S,
                                  (int)rows, tau) != 0,
                   RITZ_ERR_CONVERGENCE, "a factor could not be compressed");
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

    RITZ_CHECK_NEW(s, m);
    RITZ_CHECK_NEW(super, m);
    RITZ_REFUSE_IF(LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'N', 'O', m, k, R->val, m,
                                  s, NULL, 1, NULL, 1, super) != 0,
                   RITZ_ERR_CONVERGENCE, "a factor could not be compressed");
    while (r < m && s[r] > RITZ_SHORT_COLUMN * s[0])
        r++;
    RITZ_CHECK(ritz_dense_new(k, r, out));
    for (int64_t j = 0; j < r; j++)
        for (int64_t i = 0; i < k; i++)
            ritz_dense_col(out, j)[i] = ritz_dense_col(R, i)[j];
    return RITZ_OK;
}

/* Turn columns so that those beneath 1e-14 of the largest can be dropped. */
static ritz_status compress_columns(const ritz_low_rank_model *model, int side,
                                    factor_columns *Z)
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

/* The iteration: W of the model shrinks as Z grows. */
typedef struct sweep_state {
    ritz_low_rank_model model;
    ritz_zldl *F;
    ritz_low_rank_window window;
    factor_columns Z[RITZ_SIDES];
    double first[RITZ_SIDES];    /* |W'W| of the start */
    double residual[RITZ_SIDES]; /* |W'W| over that */
    bool open[RITZ_SIDES];
    double tolerance;
    double least; /* damping ratio of the shifts so far */
    int64_t shifts;
} sweep_state;

static void sweep_state_free(sweep_state *sweep)
{
    ritz_zldl_free(&sweep->F);
    ritz_low_rank_window_free(&sweep->window);
    ritz_low_rank_model_free(&sweep->model);
    RITZ_FREE(sweep->Z[RITZ_CONTROLLABLE].val, sweep->Z[RITZ_OBSERVABLE].val);
}

/*
 * v of one side: a pair of halves, each n x 2p, of p columns Re v and then as
 * many Im v.
 */

/* The half of v that is solved for: v_1 for controllability, v_2 for
   observability. */
static int solved_half(int side)
{
    return side == RITZ_CONTROLLABLE ? RITZ_ABOVE : RITZ_BELOW;
}

/* The right-hand side that v of a side is solved from. */
static ritz_status load_side(const ritz_low_rank_model *model, int side,
                             double _Complex p, double _Complex *x)
{
    const ritz_dense *W = model->W[side];
    int64_t size = W[0].nrow * W[0].ncol;
    RITZ_OWN(ritz_dense) MW = {0}, DW = {0};

    if (side == RITZ_OBSERVABLE) {
        for (int64_t k = 0; k < size; k++)
            x[k] = p * W[RITZ_BELOW].val[k] - W[RITZ_ABOVE].val[k];
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_sparse_mul(&model->M, &W[RITZ_ABOVE], &MW));
    RITZ_CHECK(ritz_sparse_mul(&model->D, &W[RITZ_ABOVE], &DW));
    for (int64_t k = 0; k < size; k++)
        x[k] = p * MW.val[k] - DW.val[k] - W[RITZ_BELOW].val[k];
    return RITZ_OK;
}

/* The half that is solved for, x without rigid motion. */
static ritz_status split_parts(const ritz_low_rank_model *model,
                               int64_t columns, const double _Complex *x,
                               ritz_dense *v)
{
    int64_t size = model->n * columns;

    RITZ_CHECK(ritz_dense_new(model->n, 2 * columns, v));
    for (int64_t k = 0; k < size; k++) {
        v->val[k] = creal(x[k]);
        v->val[size + k] = cimag(x[k]);
    }
    for (int part = 0; part < 2 && model->Phi.ncol > 0; part++) {
        ritz_dense X = ritz_dense_part(v, part * columns, columns);

        RITZ_CHECK(ritz_dense_take_out(&model->Phi, &model->MPhi, &X));
    }
    return RITZ_OK;
}

/* The other half: v_2 = W_1 - p v_1, or v_1 = W_2 + D'v_2 - p M v_2 */
static ritz_status find_halves(const ritz_low_rank_model *model, int side,
                               double _Complex p, const double _Complex *x,
                               ritz_dense v[static RITZ_HALVES])
{
    const ritz_sparse *Dt = model->Dt.colptr ? &model->Dt : &model->D;
    const ritz_dense *W = &model->W[side][solved_half(side)];
    const ritz_dense *own = &v[solved_half(side)];
    ritz_dense *other = &v[1 - solved_half(side)];
    int64_t size = W->nrow * W->ncol;
    RITZ_OWN(ritz_dense) Mv = {0};

    RITZ_CHECK(split_parts(model, W->ncol, x, &v[solved_half(side)]));
    if (side == RITZ_OBSERVABLE) {
        RITZ_CHECK(ritz_sparse_mul(&model->M, own, &Mv));
        RITZ_CHECK(ritz_sparse_mul(Dt, own, other));
        own = &Mv;
    } else {
        RITZ_CHECK(ritz_dense_new(own->nrow, own->ncol, other));
    }
    for (int64_t k = 0; k < size; k++) {
        double re = own->val[k], im = own->val[size + k];

        other->val[k] += W->val[k];
        other->val[k] += -creal(p) * re + cimag(p) * im;
        other->val[size + k] += -creal(p) * im - cimag(p) * re;
    }
    return RITZ_OK;
}

/* Factor, and v of both sides that are open. */
static ritz_status solve_shifted(sweep_state *sweep, double _Complex p,
                                 ritz_dense_pair v[static RITZ_SIDES])
{
    ritz_low_rank_model *model = &sweep->model;
    bool symmetric = !model->Dt.colptr;
    int64_t columns[RITZ_SIDES] = {0};
    RITZ_OWN_ARRAY double _Complex *x = NULL;
    double _Complex *of[RITZ_SIDES] = {NULL};

    for (int side = 0; side < RITZ_SIDES; side++)
        columns[side] = sweep->open[side] ? model->W[side][0].ncol : 0;
    RITZ_CHECK_NEW(x, model->n * (columns[0] + columns[1]));
    of[0] = x;
    of[1] = x + model->n * columns[0];
    for (int side = 0; side < RITZ_SIDES; side++)
        if (columns[side] > 0)
            RITZ_CHECK(load_side(model, side, p, of[side]));
    RITZ_CHECK(ritz_zldl_factor(sweep->F, (double _Complex[]){p * p, 1.0, -p}));
    RITZ_CHECK(ritz_zldl_solve(
        sweep->F, false, symmetric ? columns[0] + columns[1] : columns[0], x));
    if (!symmetric)
        RITZ_CHECK(ritz_zldl_solve(sweep->F, true, columns[1], of[1]));
    for (int side = 0; side < RITZ_SIDES; side++)
        if (columns[side] > 0)
            RITZ_CHECK(find_halves(model, side, p, of[side], v[side]));
    return RITZ_OK;
}

/* Columns first .. of half a factor := f X */
static void put_half(const ritz_low_rank_model *model, int half, double f,
                     const ritz_dense *X, int64_t first, factor_columns *Z)
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

static ritz_status append_columns(sweep_state *sweep, int side,
                                  double _Complex p,
                                  const ritz_dense v[static RITZ_HALVES])
{
    ritz_low_rank_model *model = &sweep->model;
    factor_columns *Z = &sweep->Z[side];
    bool pair = cimag(p) != 0.0;
    double d = pair ? creal(p) / cimag(p) : 0.0;
    double g = sqrt((pair ? -4.0 : -2.0) * creal(p));
    int64_t columns = v[0].ncol / 2;
    int64_t added = pair ? 2 * columns : columns;
    const ritz_dense latest = ritz_dense_part(&v[solved_half(side)], 0, added);
    RITZ_OWN(ritz_dense_pair) plus = {0};

    RITZ_CHECK(reserve_columns(model->n, added, Z));
    for (int half = 0; half < RITZ_HALVES; half++) {
        const ritz_dense im = ritz_dense_part(&v[half], columns, columns);

        RITZ_CHECK(ritz_dense_columns(&v[half], 0, columns, &plus[half]));
        ritz_dense_add(d, &im, &plus[half]);
        put_half(model, half, g, &plus[half], Z->count, Z);
        if (pair)
            put_half(model, half, g * sqrt(d * d + 1.0), &im,
                     Z->count + columns, Z);
    }
    Z->count += added;
    RITZ_CHECK(shrink_residual(model, side, g * g, plus));
    return ritz_low_rank_window_add(model, &latest, &sweep->window);
}

RITZ_PAIR_OF(ritz_dense_pair);

/* Take one shift, or a pair of them, and add what it gives. */
static ritz_status take_shift(sweep_state *sweep, double _Complex p)
{
    RITZ_OWN(ritz_dense_pair_pair) v = {0};

    RITZ_CHECK(solve_shifted(sweep, p, v));
    for (int side = 0; side < RITZ_SIDES; side++)
        if (sweep->open[side])
            RITZ_CHECK(append_columns(sweep, side, p, v[side]));
    sweep->shifts++;
    sweep->least = fmin(sweep->least, -creal(p) / cabs(p));
    return RITZ_OK;
}

enum {
    TOGETHER = 2,  /* shifts of one projection */
    GROWN_BY = 256 /* columns are compressed again when there are so many more
                      than twice those that were left the last time */
};

/*
 * If more than `left` of the residual is left after `after` shifts, the search
 * gives up where more than `total` shifts are expected in all.
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

/* A side is open that flexible motion has a part in. */
static ritz_status start_sweep(const ritz_gramians_request *request,
                               sweep_state *sweep)
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

static bool is_open(const sweep_state *sweep)
{
    return sweep->open[RITZ_CONTROLLABLE] || sweep->open[RITZ_OBSERVABLE];
}

/* Residuals after a step, and factors that grew compressed. */
static ritz_status update_residuals(sweep_state *sweep)
{
    for (int side = 0; side < RITZ_SIDES; side++) {
        factor_columns *Z = &sweep->Z[side];
        double size = 0.0;

        if (!sweep->open[side])
            continue;
        RITZ_CHECK(ritz_low_rank_size(&sweep->model, side, &size));
        sweep->residual[side] = size / sweep->first[side];
        sweep->open[side] = sweep->residual[side] > sweep->tolerance;
        if (Z->count > 2 * Z->settled + GROWN_BY)
            RITZ_CHECK(compress_columns(&sweep->model, side, Z));
    }
    ritz_monitor_step("shifts", sweep->shifts, 0);
    return RITZ_OK;
}

static double worst_residual(const sweep_state *sweep)
{
    return fmax(sweep->residual[RITZ_CONTROLLABLE],
                sweep->residual[RITZ_OBSERVABLE]);
}

/* Shifts in all, if the second half of those so far is how it goes on. */
static double expected_shifts(const sweep_state *sweep, const double *history)
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
static ritz_status refuse_slow(const sweep_state *sweep, const double *history)
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

static ritz_status run_sweep(sweep_state *sweep)
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
static ritz_status take_factor(sweep_state *sweep, int side, ritz_dense *out)
{
    factor_columns *Z = &sweep->Z[side];

    RITZ_CHECK(compress_columns(&sweep->model, side, Z));
    if (!Z->val)
        return ritz_dense_new(2 * sweep->model.n, 0, out);
    *out = (ritz_dense){
        .nrow = 2 * sweep->model.n, .ncol = Z->count, .val = Z->val};
    *Z = (factor_columns){0};
    return RITZ_OK;
}

/* [I 0; 0 M] Z */
static ritz_status multiply_mass(const ritz_low_rank_model *model,
                                 const ritz_dense *Z, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) below = {0}, MZ = {0};

    RITZ_CHECK(ritz_dense_block(Z, model->n, model->n, 0, Z->ncol, &below));
    RITZ_CHECK(ritz_sparse_mul(&model->M, &below, &MZ));
    RITZ_CHECK(ritz_dense_copy(Z, out));
    ritz_dense_put(&MZ, model->n, 0, out);
    return RITZ_OK;
}

static ritz_status finish_gramians(sweep_state *sweep, ritz_gramians *out)
{
    const ritz_low_rank_model *model = &sweep->model;
    int64_t n = model->n;
    int64_t a = model->Phi.ncol;

    ritz_zldl_free(&sweep->F);
    RITZ_CHECK(take_factor(sweep, RITZ_CONTROLLABLE, &out->Zc));
    RITZ_CHECK(take_factor(sweep, RITZ_OBSERVABLE, &out->Zo));
    RITZ_CHECK(multiply_mass(model, &out->Zc, &out->EZc));
    RITZ_CHECK(ritz_dense_new(2 * n, 2 * a, &out->T));
    RITZ_CHECK(ritz_dense_new(2 * n, 2 * a, &out->W));
    ritz_dense_put(&model->Phi, 0, 0, &out->T);
    ritz_dense_put(&model->Phi, n, a, &out->T);
    ritz_dense_put(&model->MPhi, 0, 0, &out->W);
    ritz_dense_put(&model->Phi, n, a, &out->W);
    out->residual[0] = sweep->residual[RITZ_CONTROLLABLE];
    out->residual[1] = sweep->residual[RITZ_OBSERVABLE];
    snprintf(out->engine, sizeof out->engine, "ADI, %" PRId64 " shifts",
             sweep->shifts);
    return RITZ_OK;
}

ritz_status ritz_gramians_low_rank(const ritz_gramians_request *request,
                                   ritz_gramians *out)
{
    RITZ_OWN(sweep_state) sweep = {0};
    RITZ_OWN(ritz_gramians) gramians = {0};

    RITZ_CHECK(start_sweep(request, &sweep));
    RITZ_CHECK(run_sweep(&sweep));
    RITZ_CHECK(finish_gramians(&sweep, &gramians));
    if (request->damping.kind != RITZ_DAMPING_NONE)
        ritz_damping_print(&request->damping, gramians.damping);
    RITZ_MOVE(*out, gramians);
    return RITZ_OK;
}
