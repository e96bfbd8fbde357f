/*
 * Gramians of a large component by projection: build a Krylov space from static
 * responses, solve the Lyapunov equations of the projected model in closed
 * form, bound the error from the residual of the large model, measure the
 * residuals of the large Lyapunov equations, and enlarge the space until bound
 * and residuals are below the tolerance.
 *
 * With D = a M + b K
 *
 *     (K + s D + s^2 M)^-1 = (K + m(s) M)^-1 / (1 + b s),
 *     m(s) = (s^2 + a s) / (1 + b s),
 *
 * so that the responses at all s are functions of one pencil (K, M), and a
 * space from one real factor approximates all of them. A mode whose resonance
 * is well separated needs several vectors until its eigenvalue has converged;
 * modes with overlapping resonances need fewer.
 *
 * The bound (projection_error.c) is one of the difference of the transfer
 * functions of both models, and therefore of the error of every Hankel value.
 * It is compared with the tolerance times the largest Hankel value.
 *
 * Where high frequencies are strongly damped, few vectors meet this bound, as
 * the Hankel values of such modes are small. But the Gramian of each equation
 * contains these modes, and its residual (projection_residual.c) stays large:
 * vectors of K_s^-1 M reach high frequencies slowly, and the more slowly the
 * finer the mesh is. The space then gets static solutions with K + m M for real
 * shifts m > 0 (projection_shift.c), one shift at a time.
 */
#include "gramians/projection.h"
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What has been found so far. */
typedef struct projection_state {
    ritz_projection_model model;
    ritz_projection_space space;
    ritz_projected projected;
    ritz_gramians small; /* factors in the states of the projected model */
    double sigma;        /* largest Hankel value so far; 0: unknown */
    double bound;        /* of the error of Hankel values */
    double residual[RITZ_SIDES];
    int64_t shifts; /* of the space, in addition to that of K_s */
    double tolerance;
} projection_state;

static void projection_state_free(projection_state *state)
{
    ritz_projected_free(&state->projected);
    ritz_projection_space_free(&state->space);
    ritz_projection_model_free(&state->model);
    ritz_gramians_free(&state->small);
}

static ritz_status start_projection(const ritz_gramians_request *request,
                                    projection_state *state)
{
    RITZ_REFUSE_IF(!(request->tolerance >= 0.0 && request->tolerance < 1.0),
                   RITZ_ERR_ARGUMENT, "a tolerance is between 0 and 1, not %g",
                   request->tolerance);
    state->tolerance = request->tolerance > 0.0 ? request->tolerance
                                                : RITZ_PROJECTION_TOLERANCE;
    RITZ_CHECK(ritz_projection_model_new(request, &state->model));
    return ritz_projection_space_new(&state->model, &state->space);
}

/* Gramians of the projected model, its largest Hankel value, and the residuals
   of the equations of the large one. */
static ritz_status solve_small(projection_state *state)
{
    RITZ_OWN(ritz_modal) modal = {0};
    RITZ_OWN(ritz_product_svd) svd = {0};
    ritz_gramians *small = &state->small;

    ritz_gramians_free(small);
    RITZ_CHECK(ritz_projected_modal(&state->projected, &modal));
    RITZ_CHECK(ritz_modal_factors(&modal, NULL, &small->Zc, &small->Zo));
    RITZ_CHECK(ritz_product_svd_new(&small->Zo, &small->Zc, false, &svd));
    state->sigma = svd.count > 0 ? svd.s[0] : 0.0;
    return ritz_projected_residuals(&state->projected, small, state->residual);
}

/* Project, and find whether the bound and both residuals are below the
   tolerance. The largest Hankel value converges long before the bound is small:
   it is computed first of all, and again, with the residuals, only when the
   bound is met with the value known before. */
static ritz_status measure_errors(projection_state *state, bool *met)
{
    const double *residual = state->residual;

    ritz_projected_free(&state->projected);
    RITZ_CHECK(ritz_projected_new(&state->space, &state->projected));
    RITZ_CHECK(ritz_projected_bound(&state->projected, &state->bound));
    if (state->sigma == 0.0 || state->bound <= state->tolerance * state->sigma)
        RITZ_CHECK(solve_small(state));
    *met = state->bound <= state->tolerance * state->sigma &&
           residual[RITZ_CONTROLLABLE] <= state->tolerance &&
           residual[RITZ_OBSERVABLE] <= state->tolerance;
    return RITZ_OK;
}

/* The bound relative to the largest Hankel value. */
static double relative_error(const projection_state *state)
{
    return state->sigma > 0.0 ? state->bound / state->sigma : 0.0;
}

/* If the space has become too large, add the accuracy reached to the
   message. */
static ritz_status refuse_large(const projection_state *state,
                                ritz_status status)
{
    char reached[200];

    if (status != RITZ_ERR_CONVERGENCE || !(state->sigma > 0.0))
        return status;
    if (relative_error(state) > state->tolerance)
        snprintf(
            reached, sizeof reached,
            "Hankel values are known to %.1e of the largest, %.1e is required",
            relative_error(state), state->tolerance);
    else
        snprintf(reached, sizeof reached,
                 "the Gramians leave residuals of %.1e and %.1e in their "
                 "equations, %.1e is required",
                 state->residual[RITZ_CONTROLLABLE],
                 state->residual[RITZ_OBSERVABLE], state->tolerance);
    return ritz_context(status, reached);
}

/* Add a shift to the space if the bound is met and the residuals of the Lyapunov
   equations are not, and if the static solutions at that shift are not in the
   space already. */
static ritz_status add_shift(projection_state *state, bool *added)
{
    double shift = 0.0, residual = 0.0;

    *added = false;
    if (state->bound > state->tolerance * state->sigma)
        return RITZ_OK;
    RITZ_CHECK(ritz_projected_shift(&state->projected, &shift, &residual));
    if (residual < RITZ_PROJECTION_SHIFT * state->tolerance)
        return RITZ_OK;
    *added = true;
    state->shifts++;
    return refuse_large(state,
                        ritz_projection_space_shift(shift, &state->space));
}

/* Enlarge the space until bound and residuals are below the tolerance. They are
   evaluated each time the number of vectors has grown by an eighth, and after
   each shift. */
static ritz_status grow_space(projection_state *state)
{
    ritz_projection_space *space = &state->space;
    int64_t next = 0;
    bool met = space->count == 0, shifted = false;

    while (!met) {
        RITZ_CHECK(refuse_large(state, ritz_projection_space_extend(space)));
        if (space->last < next && space->count > space->last)
            continue;
        RITZ_CHECK(measure_errors(state, &met));
        if (!met)
            RITZ_CHECK(add_shift(state, &shifted));
        next = shifted ? 0 : space->last + space->last / 8;
    }
    return RITZ_OK;
}

/* modes->Phi := rigid-body modes, followed by Phi = V Y if `all`; MPhi := M
   times them. */
static ritz_status lift_modes(projection_state *state, bool all,
                              ritz_modal_model *modes)
{
    const ritz_low_rank_model *low = &state->model.low;
    const ritz_projected *p = &state->projected;
    const ritz_dense V = ritz_dense_part(&state->space.V, 0, p->count);
    RITZ_OWN(ritz_dense) Phi = {0}, MPhi = {0};

    if (all) {
        RITZ_CHECK(ritz_dense_mul(&V, &p->Y, &Phi));
        ritz_projection_space_free(&state->space);
        RITZ_CHECK(ritz_sparse_mul(&low->M, &Phi, &MPhi));
    }
    RITZ_CHECK(ritz_dense_beside(&low->Phi, &Phi, &modes->Phi));
    RITZ_CHECK(ritz_dense_beside(&low->MPhi, &MPhi, &modes->MPhi));
    modes->num_dofs = low->n;
    modes->num_rigid = low->Phi.ncol;
    modes->count = modes->Phi.ncol;
    return RITZ_OK;
}

static void name_engine(const projection_state *state, size_t size, char *out)
{
    char shifts[40] = "";

    if (state->shifts > 0)
        snprintf(shifts, sizeof shifts, ", %" PRId64 " shift%s", state->shifts,
                 state->shifts == 1 ? "" : "s");
    snprintf(out, size, "projection, %" PRId64 " vectors%s",
             state->projected.count, shifts);
}

static ritz_status finish_projection(projection_state *state, bool values_only,
                                     ritz_gramians *out)
{
    RITZ_OWN(ritz_modal_model) modes = {0};
    RITZ_OWN(ritz_gramians) gramians = {0};
    const ritz_mode_states layout = {&modes, state->model.low.Phi.ncol, 2,
                                     NULL};

    RITZ_CHECK(lift_modes(state, !values_only, &modes));
    RITZ_MOVE(gramians.Zc, state->small.Zc);
    RITZ_MOVE(gramians.Zo, state->small.Zo);
    RITZ_CHECK(ritz_gramians_lift(&layout, &gramians));
    gramians.error = relative_error(state);
    memcpy(gramians.residual, state->residual, sizeof gramians.residual);
    name_engine(state, sizeof gramians.engine, gramians.engine);
    RITZ_MOVE(*out, gramians);
    return RITZ_OK;
}

ritz_status ritz_gramians_projection(const ritz_gramians_request *request,
                                     ritz_gramians *out)
{
    RITZ_OWN(projection_state) state = {0};
    RITZ_OWN(ritz_gramians) gramians = {0};

    RITZ_CHECK(start_projection(request, &state));
    RITZ_CHECK(grow_space(&state));
    RITZ_CHECK(finish_projection(&state, request->values_only, &gramians));
    if (request->damping.kind != RITZ_DAMPING_NONE)
        ritz_damping_print(&request->damping, gramians.damping);
    RITZ_MOVE(*out, gramians);
    return RITZ_OK;
}
