/*
 * Full against reduced, both of first order:
 *
 *     |G - G_r|_inf, |G - G_r|_2, max over a band of |H - H_r|, |G(0) - G_r(0)|
 *
 * Rigid and other poles that are not left of the axis make norms infinite; a
 * reduction keeps them, and norms are those of the other parts of both models.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/space.h"
#include "linear/general.h"
#include "linear/split.h"
#include "model/space.h"
#include "verify/sides.h"

#include <ritz/check.h>
#include <ritz/poles.h>
#include <ritz/verify.h>

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Points before those at the poles are added. */
enum { EVEN_POINTS = 200 };

RITZ_PAIR_OF(ritz_state_space);

void ritz_state_pair_free(ritz_state_pair *p)
{
    for (int k = 0; k < 2; k++) {
        ritz_state_space_free(&p->dense[k]);
        ritz_dense_free(&p->model[k].C);
        ritz_dense_free(&p->model[k].D);
        ritz_state_space_free(&p->stable[k]);
        ritz_dense_free(&p->gain[k]);
    }
    ritz_state_space_free(&p->difference);
}

/* Copy names and limits of a model to one of another number of states. */
static ritz_status make_states(const ritz_state_space *model, int64_t states,
                               ritz_state_space *out)
{
    const ritz_io io = ritz_model_io(ritz_model_of_states(model));

    return ritz_state_space_new(states, &io, out);
}

/* E of a model of n states, or the identity, from (first, first) on. */
static void place_descriptor(const ritz_dense *E, int64_t n, int64_t first,
                             ritz_dense *to)
{
    ritz_general_place(1.0, E, false, first, first, to);
    for (int64_t i = 0; i < n && !E->val; i++)
        ritz_dense_col(to, first + i)[first + i] = 1.0;
}

/* a - b: both models side by side, the outputs of b subtracted. */
ritz_status ritz_state_space_difference(const ritz_state_space *a,
                                        const ritz_state_space *b,
                                        ritz_state_space *out)
{
    RITZ_OWN(ritz_state_space_pair) made = {0};
    RITZ_OWN(ritz_state_space) both = {0};
    int64_t n = ritz_state_space_order(a);
    int64_t m = ritz_state_space_order(b);

    RITZ_CHECK(ritz_state_space_dense(a, &made[0], &a));
    RITZ_CHECK(ritz_state_space_dense(b, &made[1], &b));
    RITZ_CHECK(
        ritz_verify_signals(ritz_model_of_states(a), ritz_model_of_states(b)));
    RITZ_CHECK(make_states(a, n + m, &both));
    memcpy(both.damping, a->damping, sizeof both.damping);
    memcpy(both.units, a->units, sizeof both.units);
    ritz_general_place(1.0, &a->A, false, 0, 0, &both.A);
    ritz_general_place(1.0, &b->A, false, n, n, &both.A);
    ritz_general_place(1.0, &a->B, false, 0, 0, &both.B);
    ritz_general_place(1.0, &b->B, false, n, 0, &both.B);
    ritz_general_place(1.0, &a->C, false, 0, 0, &both.C);
    ritz_general_place(-1.0, &b->C, false, 0, n, &both.C);
    for (int64_t k = 0; k < a->D.nrow * a->D.ncol; k++)
        both.D.val[k] = a->D.val[k] - b->D.val[k];
    if (a->E.val || b->E.val) {
        RITZ_CHECK(ritz_dense_new(n + m, n + m, &both.E));
        place_descriptor(&a->E, n, 0, &both.E);
        place_descriptor(&b->E, m, n, &both.E);
    }
    RITZ_MOVE(*out, both);
    return RITZ_OK;
}

/* C and D are the model's own, over the limits; all else is borrowed. */
static ritz_status divide_outputs(const ritz_state_space *model,
                                  const double *limit, ritz_state_space *out)
{
    *out = *model;
    out->C = out->D = (ritz_dense){0};
    RITZ_CHECK(ritz_dense_copy(&model->C, &out->C));
    RITZ_CHECK(ritz_dense_copy(&model->D, &out->D));
    for (int64_t i = 0; i < model->num_outputs; i++) {
        if (isnan(limit[i]))
            continue;
        for (int64_t j = 0; j < out->C.ncol; j++)
            ritz_dense_col(&out->C, j)[i] /= limit[i];
        for (int64_t j = 0; j < out->D.ncol; j++)
            ritz_dense_col(&out->D, j)[i] /= limit[i];
    }
    return RITZ_OK;
}

/* The part of a model whose poles are left of the axis, in Schur form: Y'A X,
   Y'E X, Y'B, C X. */
static ritz_status take_stable(const ritz_state_space *model,
                               ritz_state_space *out, int64_t *num_unstable)
{
    RITZ_OWN(ritz_split) split = {0};

    RITZ_CHECK(ritz_split_new(&model->A, &model->E, &split));
    *num_unstable = split.T.ncol;
    RITZ_CHECK(make_states(model, split.X.ncol, out));
    ritz_dense_replace(&out->A, &split.S);
    ritz_dense_replace(&out->E, &split.P);
    ritz_dense_put(&model->D, 0, 0, &out->D);
    ritz_dense_free(&out->B);
    ritz_dense_free(&out->C);
    RITZ_CHECK(ritz_dense_mul_tn(&split.Y, &model->B, &out->B));
    return ritz_dense_mul(&model->C, &split.X, &out->C);
}

/* Static gain of a sparse model. */
static ritz_status sparse_gain(const ritz_state_space *model, ritz_dense *out)
{
    RITZ_OWN(ritz_pencil) pencil = {0};
    RITZ_OWN(ritz_dense) gain = {0};
    RITZ_OWN_ARRAY double _Complex *H = NULL;

    RITZ_CHECK_NEW(H, model->num_outputs * model->num_inputs);
    RITZ_CHECK(ritz_pencil_of_space(model, &pencil));
    RITZ_CHECK(ritz_space_transfer(model, &pencil, 0.0, H));
    RITZ_CHECK(ritz_dense_new(model->num_outputs, model->num_inputs, &gain));
    for (int64_t i = 0; i < gain.nrow; i++)
        for (int64_t j = 0; j < gain.ncol; j++)
            ritz_dense_col(&gain, j)[i] = creal(H[i * gain.ncol + j]);
    RITZ_MOVE(*out, gain);
    return RITZ_OK;
}

/* D - C A^-1 B; RITZ_ERR_SINGULAR if there is a pole at 0. */
static ritz_status static_gain(const ritz_state_space *model, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) X = {0};

    if (ritz_state_space_is_sparse(model))
        return sparse_gain(model, out);
    RITZ_CHECK(ritz_dense_copy(&model->B, &X));
    RITZ_CHECK(ritz_general_solve(&model->A, false, &X));
    RITZ_CHECK(ritz_dense_mul(&model->C, &X, out));
    for (int64_t k = 0; k < out->nrow * out->ncol; k++)
        out->val[k] = model->D.val[k] - out->val[k];
    return RITZ_OK;
}

static ritz_status take_gains(ritz_state_pair *p)
{
    for (int k = 0; k < 2; k++) {
        ritz_status status = static_gain(&p->model[k], &p->gain[k]);

        if (status != RITZ_OK)
            return status == RITZ_ERR_SINGULAR ? RITZ_OK : status;
    }
    p->has_gain = true;
    return RITZ_OK;
}

/* Make A, or the identity if A is {0}, the block of @p out that begins at row
   and column `at`; earlier columns are complete. */
static void append_block(const ritz_sparse *A, int64_t rows, int64_t at,
                         ritz_sparse *out)
{
    int64_t next = out->colptr[at];

    for (int64_t j = 0; j < rows; j++) {
        const int64_t from = A->colptr ? A->colptr[j] : 0;
        const int64_t to = A->colptr ? A->colptr[j + 1] : 1;

        for (int64_t q = from; q < to; q++) {
            out->rowind[next] = at + (A->colptr ? A->rowind[q] : j);
            out->val[next++] = A->colptr ? A->val[q] : 1.0;
        }
        out->colptr[at + j + 1] = next;
    }
}

/* [A 0; 0 B] of a dense A and a sparse B, either of which may be {0}, the
   identity. */
static ritz_status join_blocks(const ritz_dense *A, int64_t rows_A,
                               const ritz_sparse *B, int64_t rows_B,
                               ritz_sparse *out)
{
    const int64_t n = rows_A + rows_B;
    RITZ_OWN(ritz_sparse) first = {0};

    if (A->val)
        RITZ_CHECK(ritz_sparse_from_dense(A, &first));
    RITZ_CHECK(ritz_sparse_new(n, n,
                               (first.colptr ? first.colptr[rows_A] : rows_A) +
                                   (B->colptr ? B->colptr[rows_B] : rows_B),
                               out));
    append_block(&first, rows_A, 0, out);
    append_block(B, rows_B, rows_A, out);
    return RITZ_OK;
}

/* Both models as they are compared: dense, unless one is too large. */
static ritz_status take_models(const ritz_state_space *full,
                               const ritz_state_space *reduced,
                               ritz_state_pair *p)
{
    p->given[0] = full;
    p->given[1] = reduced;
    for (int k = 0; k < 2; k++)
        p->large =
            p->large || (ritz_state_space_is_sparse(p->given[k]) &&
                         ritz_state_space_order(p->given[k]) > RITZ_STATE_DOFS);
    for (int k = 0; k < 2 && !p->large; k++)
        RITZ_CHECK(
            ritz_state_space_dense(p->given[k], &p->dense[k], &p->given[k]));
    for (int k = 0; k < 2; k++)
        RITZ_CHECK(divide_outputs(p->given[k], full->limit, &p->model[k]));
    return RITZ_OK;
}

/* A large model, with the small one's stable part in front of it. */
static ritz_status join_sparse(const ritz_state_space *small,
                               const ritz_state_space *large,
                               ritz_state_space *out)
{
    const ritz_io io = ritz_model_io(ritz_model_of_states(large));
    const int64_t r = ritz_state_space_order(small);
    const bool plain = !small->E.val && !large->sE.colptr;
    RITZ_OWN(ritz_sparse) A = {0}, E = {0};

    RITZ_CHECK(join_blocks(&small->A, r, &large->sA,
                           ritz_state_space_order(large), &A));
    if (!plain)
        RITZ_CHECK(join_blocks(&small->E, r, &large->sE,
                               ritz_state_space_order(large), &E));
    RITZ_CHECK(ritz_state_space_of_sparse(&A, &E, &io, out));
    for (int64_t i = 0; i < out->num_outputs; i++)
        out->limit[i] = nan(""); /* outputs are divided already */
    ritz_general_place(1.0, &small->B, false, 0, 0, &out->B);
    ritz_general_place(1.0, &large->B, false, r, 0, &out->B);
    ritz_general_place(-1.0, &small->C, false, 0, 0, &out->C);
    ritz_general_place(1.0, &large->C, false, 0, r, &out->C);
    return RITZ_OK;
}

/* Norms of a large model and its difference from a small one. Without them
   responses are still compared. */
static ritz_status open_large(ritz_state_pair *p)
{
    const ritz_state_space *reduced = p->given[1];
    ritz_status status = RITZ_OK;

    if (!ritz_state_space_is_sparse(p->given[0]) ||
        (ritz_state_space_is_sparse(reduced) &&
         ritz_state_space_order(reduced) > RITZ_STATE_DOFS))
        return RITZ_OK;
    RITZ_CHECK(ritz_state_space_dense(reduced, &p->dense[1], &reduced));
    if (reduced != p->given[1]) {
        ritz_dense_free(&p->model[1].C);
        ritz_dense_free(&p->model[1].D);
        RITZ_CHECK(divide_outputs(reduced, p->given[0]->limit, &p->model[1]));
    }
    RITZ_CHECK(take_stable(&p->model[1], &p->stable[1], &p->num_unstable[1]));
    status =
        ritz_norm_infinity_sparse(&p->model[0], &p->stable[1], RITZ_SPARSE_NORM,
                                  &p->num_unstable[0], &p->full, &p->error);
    if (status != RITZ_OK && status != RITZ_ERR_CONVERGENCE)
        return status;
    p->has_norms =
        status == RITZ_OK && p->num_unstable[0] == p->num_unstable[1];
    return p->has_norms
               ? join_sparse(&p->stable[1], &p->model[0], &p->difference)
               : RITZ_OK;
}

static ritz_status open_pair(const ritz_state_space *full,
                             const ritz_state_space *reduced,
                             const ritz_verify_request *request,
                             ritz_state_pair *p)
{
    p->request = request;
    RITZ_CHECK(ritz_verify_signals(ritz_model_of_states(full),
                                   ritz_model_of_states(reduced)));
    RITZ_CHECK(take_models(full, reduced, p));
    if (p->large)
        return open_large(p);
    for (int k = 0; k < 2; k++)
        RITZ_CHECK(
            take_stable(&p->model[k], &p->stable[k], &p->num_unstable[k]));
    p->has_norms = p->num_unstable[0] == p->num_unstable[1];
    if (p->has_norms)
        RITZ_CHECK(ritz_state_space_difference(&p->stable[1], &p->stable[0],
                                               &p->difference));
    return RITZ_OK;
}

/* A limit of a norm that is infinite cannot be held. */
static ritz_status check_norms(const ritz_state_pair *p)
{
    RITZ_REFUSE_IF(p->large && !p->has_norms &&
                       p->num_unstable[0] == p->num_unstable[1],
                   RITZ_ERR_ARGUMENT,
                   "of two models with more than %d sparse states no norms are "
                   "taken: compare responses over a band",
                   (int)RITZ_STATE_DOFS);
    RITZ_REFUSE_IF(!p->has_norms, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " poles of the full model and %" PRId64
                   " of the reduced one are not left of the axis: the norm "
                   "of their difference is infinite",
                   p->num_unstable[0], p->num_unstable[1]);
    return RITZ_OK;
}

static ritz_status take_norms(ritz_state_pair *p)
{
    const double *limit = p->request->limit;

    if (!isnan(limit[RITZ_MEASURE_INFINITY_RELATIVE]) ||
        !isnan(limit[RITZ_MEASURE_H2]))
        RITZ_CHECK(check_norms(p));
    if (!p->has_norms || p->large)
        return RITZ_OK;
    RITZ_CHECK_IN(
        "full model",
        ritz_norm_infinity_schur(&p->stable[0], RITZ_NORM_TOLERANCE, &p->full));
    RITZ_CHECK_IN("difference",
                  ritz_norm_infinity_schur(&p->difference, RITZ_NORM_TOLERANCE,
                                           &p->error));
    return RITZ_OK;
}

ritz_status ritz_state_pair_new(const ritz_state_space *full,
                                const ritz_state_space *reduced,
                                const ritz_verify_request *request,
                                ritz_state_pair *out)
{
    RITZ_OWN(ritz_state_pair) p = {0};

    RITZ_CHECK(open_pair(full, reduced, request, &p));
    RITZ_CHECK(take_gains(&p));
    RITZ_CHECK(take_norms(&p));
    RITZ_MOVE(*out, p);
    return RITZ_OK;
}

/* "0.83 Hz, less 6 poles not left of axis" */
static void say_where(const ritz_state_pair *p, char where[RITZ_NAME_SIZE])
{
    const ritz_norm *norm = &p->error;
    size_t used = 0;

    if (isfinite(norm->hertz))
        used = (size_t)snprintf(where, RITZ_NAME_SIZE, "%.6g Hz", norm->hertz);
    else
        used = (size_t)snprintf(where, RITZ_NAME_SIZE, "infinite frequency");
    if (p->num_unstable[0] > 0)
        used += (size_t)snprintf(where + used, RITZ_NAME_SIZE - used,
                                 ", less %" PRId64 " poles not left of axis",
                                 p->num_unstable[0]);
    if (norm->lower >= norm->value && used < RITZ_NAME_SIZE - 16)
        snprintf(where + used, RITZ_NAME_SIZE - used, ", at least");
}

/* The norm of the difference, if there is one, over @p unit. */
static ritz_status tell_norm(const ritz_state_pair *p, double unit,
                             ritz_measure *out)
{
    if (!p->has_norms || !(unit > 0.0))
        return RITZ_OK;
    out->value = p->error.value / unit;
    say_where(p, out->where);
    return RITZ_OK;
}

ritz_status ritz_states_infinity(const ritz_state_pair *p, ritz_measure *out)
{
    return tell_norm(p, 1.0, out);
}

ritz_status ritz_states_infinity_relative(const ritz_state_pair *p,
                                          ritz_measure *out)
{
    return tell_norm(p, p->full.value, out);
}

ritz_status ritz_states_infinity_bound(const ritz_state_pair *p,
                                       ritz_measure *out)
{
    const double bound =
        ritz_measures_value(&p->given[1]->estimates, "h-infinity-bound");

    if (isnan(bound))
        return RITZ_OK;
    out->limit = bound + (RITZ_NORM_TOLERANCE * bound +
                          RITZ_BOUND_ROUNDING *
                              (double)ritz_state_space_order(&p->model[0]) *
                              DBL_EPSILON * p->full.value +
                          RITZ_BOUND_CONDITION * p->error.rounding);
    return tell_norm(p, 1.0, out);
}

/* By low-rank Gramians, if they have low rank. */
static ritz_status measure_sparse_two(const ritz_state_pair *p,
                                      ritz_measure *out)
{
    double full = 0.0, error = 0.0;
    ritz_status status = ritz_space_norm_two(
        &p->difference, ritz_state_space_order(p->given[0]), &error, &full);

    if (status == RITZ_ERR_CONVERGENCE && isnan(out->limit))
        return RITZ_OK;
    RITZ_CHECK_IN("--limit-h2", status);
    if (full > 0.0)
        out->value = error / full;
    return RITZ_OK;
}

ritz_status ritz_states_h2(const ritz_state_pair *p, ritz_measure *out)
{
    ritz_norm full = {0}, error = {0};

    if (!p->has_norms)
        return RITZ_OK;
    if (ritz_dense_max(&p->model[0].D) > 0.0 ||
        ritz_dense_max(&p->model[1].D) > 0.0) {
        RITZ_REFUSE_IF(!isnan(out->limit), RITZ_ERR_ARGUMENT,
                       "--limit-h2: an input reaches an output at once (D is "
                       "not 0), there is no H2 norm");
        return RITZ_OK;
    }
    if (p->large)
        return measure_sparse_two(p, out);
    RITZ_CHECK_IN("difference",
                  ritz_norm_two_schur(&p->difference,
                                      ritz_state_space_order(&p->stable[0]),
                                      &error, &full));
    if (full.value > 0.0)
        out->value = error.value / full.value;
    return RITZ_OK;
}

/* Second-order models in first-order form. */
ritz_status ritz_modes_h2(const ritz_sides *sides, ritz_measure *out)
{
    const ritz_verify_request request = RITZ_VERIFY_NONE;
    const ritz_damping *damping = &sides->full->damping;
    const ritz_state_space *full = NULL, *reduced = NULL;
    RITZ_OWN(ritz_state_space_pair) made = {0};
    RITZ_OWN(ritz_state_pair) p = {0};

    RITZ_CHECK_IN("full model",
                  ritz_model_states(
                      ritz_model_of_component(sides->full->component, damping),
                      &made[0], &full));
    RITZ_CHECK_IN("reduced model",
                  ritz_model_states(ritz_model_of_dense(&sides->model, damping),
                                    &made[1], &reduced));
    RITZ_CHECK(open_pair(full, reduced, &request, &p));
    RITZ_CHECK(check_norms(&p));
    return ritz_states_h2(&p, out);
}

RITZ_PAIR_OF(ritz_response);

/* Both at the points that are refined at the poles of one of them. */
static ritz_status compare_at(const ritz_state_pair *p, int refined,
                              const ritz_grid *grid, ritz_gap *gap)
{
    RITZ_OWN(ritz_response_pair) r = {0};
    ritz_grid same = *grid;
    int64_t values = 0;

    RITZ_CHECK(ritz_response_of(ritz_model_of_states(&p->model[refined]), NULL,
                                0.0, 0.0, grid, &r[refined]));
    same.hertz = r[refined].hertz;
    same.count = r[refined].count;
    RITZ_CHECK(ritz_response_of(ritz_model_of_states(&p->model[1 - refined]),
                                NULL, 0.0, 0.0, &same, &r[1 - refined]));
    values = r[0].num_inputs * r[0].num_outputs;
    for (int64_t k = 0; k < r[0].count * values; k++)
        RITZ_CHECK(
            ritz_gap_add(r[0].H[k], r[1].H[k], r[0].hertz[k / values], gap));
    return RITZ_OK;
}

ritz_status ritz_states_response(const ritz_state_pair *p, ritz_measure *out)
{
    ritz_grid grid = {.from_hz = p->request->band_hz[0],
                      .to_hz = p->request->band_hz[1],
                      .count = EVEN_POINTS,
                      .refine = true};
    ritz_gap gap = {0};

    if (grid.to_hz == 0.0)
        return RITZ_OK;
    if (!p->has_gain)
        grid.from_hz = fmax(grid.from_hz, RITZ_BAND_START * grid.to_hz);
    for (int k = 0; k < 2; k++)
        RITZ_CHECK(compare_at(p, k, &grid, &gap));
    if (!(gap.largest > 0.0))
        return RITZ_OK;
    out->value = gap.error.value / gap.largest;
    (void)snprintf(out->where, sizeof out->where, "%.6g Hz", gap.error.hertz);
    return RITZ_OK;
}

ritz_status ritz_states_gain(const ritz_state_pair *p, ritz_measure *out)
{
    if (p->has_gain)
        RITZ_CHECK(ritz_gain_error(&p->gain[0], &p->gain[1], &out->value));
    RITZ_REFUSE_IF(isnan(out->value) && !isnan(out->limit), RITZ_ERR_ARGUMENT,
                   "--limit-gain: there is no static gain, a pole is at 0");
    (void)snprintf(out->where, sizeof out->where, "largest singular value");
    return RITZ_OK;
}

/* Growth is held to rounding unless the full model grows too. */
ritz_status ritz_states_growth(const ritz_state_pair *p, ritz_measure *out)
{
    ritz_probe probe[2] = {0};
    RITZ_OWN(ritz_measures) found = {0};

    if (p->num_unstable[0] > 0) /* otherwise all poles are known to be stable */
        RITZ_CHECK_IN("full model", ritz_probe_states(p->given[0], &probe[0]));
    RITZ_CHECK_IN("reduced model", ritz_probe_states(p->given[1], &probe[1]));
    RITZ_CHECK(ritz_probe_record(&probe[1], &found));
    *out = found.item[0];
    if (probe[0].verdict == RITZ_UNSTABLE)
        out->limit = nan("");
    return RITZ_OK;
}
