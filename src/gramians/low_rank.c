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
#include "gramians/low_rank_parts.h"

#include <ritz/monitor.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double default_tolerance = 1e-10;
/* Of a start without rigid motion: nothing is left but rounding. */
static const double nothing = 1e-24;

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
static ritz_status start(const ritz_gramians_request *request,
                         ritz_low_rank_sweep *sweep)
{
    ritz_low_rank_model *model = &sweep->model;
    const ritz_sparse *const A[] = {&model->M, &model->K, &model->D};

    RITZ_REFUSE_IF(!(request->tolerance >= 0.0 && request->tolerance < 1.0),
                   RITZ_ERR_ARGUMENT, "a tolerance is between 0 and 1, not %g",
                   request->tolerance);
    sweep->tolerance =
        request->tolerance > 0.0 ? request->tolerance : default_tolerance;
    sweep->least = 1.0;
    RITZ_CHECK(ritz_low_rank_model_new(request, model));
    for (int side = 0; side < RITZ_SIDES; side++) {
        RITZ_CHECK(ritz_low_rank_size(model, side, &sweep->first[side]));
        sweep->open[side] = model->num_starts > 0 &&
                            sweep->first[side] > nothing * model->whole[side];
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
static ritz_status settle(ritz_low_rank_sweep *sweep)
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

static double worst(const ritz_low_rank_sweep *sweep)
{
    return fmax(sweep->residual[RITZ_REACHED], sweep->residual[RITZ_SEEN]);
}

/* Shifts in all, if the second half of those so far is how it goes on. */
static double expected(const ritz_low_rank_sweep *sweep, const double *history)
{
    int64_t half = sweep->shifts / 2;
    double now = log(worst(sweep) / sweep->tolerance);
    double rate = (log(history[half]) - log(worst(sweep))) /
                  (double)(sweep->shifts - half);

    if (!(rate > 0.0))
        return HUGE_VAL;
    return (double)sweep->shifts + now / rate;
}

/*
 * Whether it goes too slowly. A small model may take a shift for every mode.
 */
static ritz_status judge(const ritz_low_rank_sweep *sweep,
                         const double *history)
{
    bool small = sweep->model.n < RITZ_LOW_RANK_SHIFTS;
    double total = 0.0;

    for (size_t k = 0; k < sizeof patiences / sizeof *patiences; k++)
        if (sweep->shifts >= patiences[k].after && is_open(sweep) &&
            worst(sweep) > patiences[k].left &&
            (!small || patiences[k].after == RITZ_LOW_RANK_SHIFTS))
            total = fmax(total,
                         expected(sweep, history) / (double)patiences[k].total);
    RITZ_REFUSE_IF(
        total > 1.0, RITZ_ERR_CONVERGENCE,
        "the Gramians have no low rank: after %" PRId64
        " shifts the residual is %.1e, and the lightest damping they "
        "met is a ratio of about %.0e: take engine 'modal', or more damping",
        sweep->shifts, worst(sweep), sweep->least);
    return RITZ_OK;
}

static ritz_status run(ritz_low_rank_sweep *sweep)
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
            RITZ_CHECK(ritz_low_rank_step(sweep, shift[k]));
            RITZ_CHECK(settle(sweep));
            RITZ_CHECK(judge(sweep, history));
            history[sweep->shifts] = worst(sweep);
        }
    }
    return RITZ_OK;
}

/* Z as a matrix of its own columns. */
static ritz_status take(ritz_low_rank_sweep *sweep, int side, ritz_dense *out)
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
static void put(const ritz_dense *X, int64_t first, int64_t from,
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
    ritz_status status = RITZ_OK;
    ritz_dense below = {0}, MZ = {0};

    RITZ_TRY(ritz_dense_new(model->n, Z->ncol, &below));
    for (int64_t j = 0; j < Z->ncol; j++)
        for (int64_t i = 0; i < model->n; i++)
            ritz_dense_col(&below, j)[i] = ritz_dense_col(Z, j)[model->n + i];
    RITZ_TRY(ritz_sparse_mul(&model->M, &below, &MZ));
    RITZ_TRY(ritz_dense_copy(Z, out));
    put(&MZ, model->n, 0, out);
done:
    ritz_dense_free(&below);
    ritz_dense_free(&MZ);
    return status;
}

static ritz_status finish(ritz_low_rank_sweep *sweep, ritz_gramians *out)
{
    const ritz_low_rank_model *model = &sweep->model;
    int64_t n = model->n;
    int64_t a = model->Phi.ncol;

    ritz_zldl_free(&sweep->F);
    RITZ_CHECK(take(sweep, RITZ_REACHED, &out->Zc));
    RITZ_CHECK(take(sweep, RITZ_SEEN, &out->Zo));
    RITZ_CHECK(by_mass(model, &out->Zc, &out->EZc));
    RITZ_CHECK(ritz_dense_new(2 * n, 2 * a, &out->T));
    RITZ_CHECK(ritz_dense_new(2 * n, 2 * a, &out->W));
    put(&model->Phi, 0, 0, &out->T);
    put(&model->Phi, n, a, &out->T);
    put(&model->MPhi, 0, 0, &out->W);
    put(&model->Phi, n, a, &out->W);
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

    RITZ_TRY(start(request, &sweep));
    RITZ_TRY(run(&sweep));
    RITZ_TRY(finish(&sweep, &gramians));
    if (request->damping.kind != RITZ_DAMPING_NONE)
        ritz_damping_print(&request->damping, gramians.damping);
    *out = gramians;
    gramians = (ritz_gramians){0};
done:
    free_sweep(&sweep);
    ritz_gramians_free(&gramians);
    return status;
}
