/*
 * Full against reduced, both of first order:
 *
 *     |G - G_r|_inf, |G - G_r|_2, max over a band of |H - H_r|, |G(0) - G_r(0)|
 *
 * Rigid and other poles that are not left of the axis make norms infinite; a
 * reduction keeps them as they are, and norms are of what is left of both.
 */
#include "base/alloc.h"
#include "linear/general.h"
#include "linear/split.h"

#include <ritz/norms.h>
#include <ritz/probe.h>
#include <ritz/verify.h>

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Relative, of H-infinity norms. */
static const double norm_tolerance = 1e-8;
/*
 * A bound holds in exact arithmetic. Solving Lyapunov equations and projecting
 * moves the response by some n eps |G|. The factor is a choice: no error of
 * tests/claims/states.claims comes near its bound by less.
 */
static const double rounding = 1e3;
/* Points before those at the poles are added. */
enum { EVEN_POINTS = 200 };
/* With a pole at 0 there is no response: begin at this part of the band. */
static const double above_rest = 1e-3;

/* Both models, outputs over their limits; 0 full, 1 reduced. */
typedef struct pair {
    ritz_state_space model[2];
    ritz_state_space stable[2];
    int64_t apart[2];   /* poles that are not left of the axis */
    bool has_gain;      /* neither has a pole at 0 */
    ritz_dense gain[2]; /* static */
} pair;

static void pair_free(pair *p)
{
    for (int k = 0; k < 2; k++) {
        ritz_state_space_free(&p->model[k]);
        ritz_state_space_free(&p->stable[k]);
        ritz_dense_free(&p->gain[k]);
    }
}

/* Names and limits of a model, for another of so many states. */
static ritz_status like(const ritz_state_space *model, int64_t states,
                        ritz_state_space *out)
{
    const ritz_io io = {.num_inputs = model->num_inputs,
                        .num_outputs = model->num_outputs,
                        .input = model->input,
                        .output = model->output,
                        .limit = model->limit};

    return ritz_state_space_new(states, &io, out);
}

/* In the place of a matrix of zeros. */
static ritz_status put(const ritz_dense *from, ritz_dense *to)
{
    ritz_dense_free(to);
    return from->val ? ritz_dense_copy(from, to) : RITZ_OK;
}

/* A row of outputs over its limit. */
static void divide_row(double limit, int64_t i, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol && !isnan(limit); j++)
        ritz_dense_col(A, j)[i] /= limit;
}

static ritz_status scale(const ritz_state_space *model, const double *limit,
                         ritz_state_space *out)
{
    RITZ_CHECK(like(model, model->A.nrow, out));
    RITZ_CHECK(put(&model->A, &out->A));
    RITZ_CHECK(put(&model->B, &out->B));
    RITZ_CHECK(put(&model->C, &out->C));
    RITZ_CHECK(put(&model->D, &out->D));
    RITZ_CHECK(put(&model->E, &out->E));
    for (int64_t i = 0; i < model->num_outputs; i++) {
        divide_row(limit[i], i, &out->C);
        divide_row(limit[i], i, &out->D);
    }
    return RITZ_OK;
}

/* What belongs to poles left of the axis: Y'A X, Y'E X, Y'B, C X. */
static ritz_status take_stable(const ritz_state_space *model,
                               ritz_state_space *out, int64_t *apart)
{
    ritz_status status = RITZ_OK;
    ritz_split split = {0};

    RITZ_TRY(ritz_split_new(&model->A, &model->E, &split));
    *apart = split.T.ncol;
    RITZ_TRY(like(model, split.X.ncol, out));
    RITZ_TRY(put(&split.S, &out->A));
    RITZ_TRY(put(&split.P, &out->E));
    RITZ_TRY(put(&model->D, &out->D));
    ritz_dense_free(&out->B);
    ritz_dense_free(&out->C);
    RITZ_TRY(ritz_dense_mul_tn(&split.Y, &model->B, &out->B));
    RITZ_TRY(ritz_dense_mul(&model->C, &split.X, &out->C));
done:
    ritz_split_free(&split);
    return status;
}

/* D - C A^-1 B; RITZ_ERR_SINGULAR if there is a pole at 0. */
static ritz_status static_gain(const ritz_state_space *model, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense X = {0};

    RITZ_TRY(ritz_dense_copy(&model->B, &X));
    RITZ_TRY(ritz_general_solve(&model->A, false, &X));
    RITZ_TRY(ritz_dense_mul(&model->C, &X, out));
    for (int64_t k = 0; k < out->nrow * out->ncol; k++)
        out->val[k] = model->D.val[k] - out->val[k];
done:
    ritz_dense_free(&X);
    return status;
}

static ritz_status take_gains(pair *p)
{
    ritz_status status = RITZ_OK;

    for (int k = 0; k < 2; k++) {
        status = static_gain(&p->model[k], &p->gain[k]);
        if (status == RITZ_ERR_SINGULAR)
            return RITZ_OK;
        RITZ_TRY(status);
    }
    p->has_gain = true;
done:
    return status;
}

/* "at 0.83 Hz, without 6 poles on or right of the axis" */
static void say_where(const pair *p, const ritz_norm *norm,
                      char where[RITZ_NAME_SIZE])
{
    size_t used = 0;

    if (isfinite(norm->hertz))
        used = (size_t)snprintf(where, RITZ_NAME_SIZE, "%.6g Hz", norm->hertz);
    else
        used = (size_t)snprintf(where, RITZ_NAME_SIZE, "infinite frequency");
    if (p->apart[0] > 0)
        used += (size_t)snprintf(where + used, RITZ_NAME_SIZE - used,
                                 ", less %" PRId64 " poles not left of axis",
                                 p->apart[0]);
    if (norm->lower >= norm->value && used < RITZ_NAME_SIZE - 16)
        snprintf(where + used, RITZ_NAME_SIZE - used, ", at least");
}

static ritz_status add_infinity(const pair *p, const ritz_state_space *apart,
                                double bound,
                                const ritz_verify_request *request,
                                ritz_measures *out)
{
    ritz_norm full = {0}, error = {0};
    char where[RITZ_NAME_SIZE] = "";
    double slack = 0.0;

    RITZ_CHECK_IN("full model",
                  ritz_norm_infinity(&p->stable[0], norm_tolerance, &full));
    RITZ_CHECK_IN("difference",
                  ritz_norm_infinity(apart, norm_tolerance, &error));
    say_where(p, &error, where);
    RITZ_CHECK(
        ritz_measures_add(out, "h-infinity", error.value, nan(""), where));
    if (full.value > 0.0)
        RITZ_CHECK(ritz_measures_add(out, "h-infinity-relative",
                                     error.value / full.value,
                                     request->limit_infinity, where));
    slack = norm_tolerance * bound +
            rounding * (double)p->model[0].A.nrow * DBL_EPSILON * full.value;
    if (!isnan(bound))
        RITZ_CHECK(ritz_measures_add(out, "h-infinity-bound", error.value,
                                     bound + slack, where));
    return RITZ_OK;
}

static ritz_status add_two(const pair *p, const ritz_state_space *apart,
                           double limit, ritz_measures *out)
{
    ritz_norm full = {0}, error = {0};

    if (ritz_dense_max(&p->model[0].D) > 0.0 ||
        ritz_dense_max(&p->model[1].D) > 0.0) {
        RITZ_REFUSE_IF(!isnan(limit), RITZ_ERR_ARGUMENT,
                       "--limit-h2: an input reaches an output at once (D is "
                       "not 0), there is no H2 norm");
        return RITZ_OK;
    }
    RITZ_CHECK_IN("full model", ritz_norm_two(&p->stable[0], &full));
    RITZ_CHECK_IN("difference", ritz_norm_two(apart, &error));
    if (full.value > 0.0)
        RITZ_CHECK(ritz_measures_add(out, "h2-relative",
                                     error.value / full.value, limit, NULL));
    return RITZ_OK;
}

static ritz_status add_norms(const pair *p, double bound,
                             const ritz_verify_request *request,
                             ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    bool limited =
        !isnan(request->limit_infinity) || !isnan(request->limit_two);
    ritz_state_space apart = {0};

    if (p->apart[0] != p->apart[1]) {
        RITZ_FAIL_IF(limited, RITZ_ERR_ARGUMENT,
                     "%" PRId64 " poles of the full model and %" PRId64
                     " of the reduced one are not left of the axis: the norm "
                     "of their difference is infinite",
                     p->apart[0], p->apart[1]);
        return RITZ_OK;
    }
    RITZ_TRY(ritz_state_space_difference(&p->stable[0], &p->stable[1], &apart));
    RITZ_TRY(add_infinity(p, &apart, bound, request, out));
    RITZ_TRY(add_two(p, &apart, request->limit_two, out));
done:
    ritz_state_space_free(&apart);
    return status;
}

/* The largest difference, and the largest response of the full model. */
typedef struct largest {
    double error, full, hertz;
} largest;

/* Both at the points that are refined at the poles of one of them. */
static ritz_status compare_at(const pair *p, int refined, const ritz_grid *grid,
                              largest *found)
{
    ritz_status status = RITZ_OK;
    ritz_response r[2] = {0};
    ritz_grid same = *grid;
    int64_t values = 0;

    RITZ_TRY(ritz_response_states(&p->model[refined], grid, &r[refined]));
    same.hertz = r[refined].hertz;
    same.count = r[refined].count;
    RITZ_TRY(
        ritz_response_states(&p->model[1 - refined], &same, &r[1 - refined]));
    values = r[0].num_inputs * r[0].num_outputs;
    for (int64_t k = 0; k < r[0].count * values; k++) {
        double error = cabs(r[0].H[k] - r[1].H[k]);

        found->full = fmax(found->full, cabs(r[0].H[k]));
        if (error > found->error) {
            found->error = error;
            found->hertz = r[0].hertz[k / values];
        }
    }
done:
    ritz_response_free(&r[0]);
    ritz_response_free(&r[1]);
    return status;
}

static ritz_status add_response(const pair *p,
                                const ritz_verify_request *request,
                                ritz_measures *out)
{
    ritz_grid grid = {.from_hz = request->band_hz[0],
                      .to_hz = request->band_hz[1],
                      .count = EVEN_POINTS,
                      .refine = true};
    largest found = {0};
    char where[RITZ_NAME_SIZE];

    if (grid.to_hz == 0.0) {
        RITZ_REFUSE_IF(!isnan(request->limit_response), RITZ_ERR_ARGUMENT,
                       "--limit-response of a state space needs --band-hz");
        return RITZ_OK;
    }
    if (!p->has_gain)
        grid.from_hz = fmax(grid.from_hz, above_rest * grid.to_hz);
    for (int k = 0; k < 2; k++)
        RITZ_CHECK(compare_at(p, k, &grid, &found));
    snprintf(where, sizeof where, "%.6g Hz", found.hertz);
    if (found.full > 0.0)
        RITZ_CHECK(ritz_measures_add(out, "response-relative",
                                     found.error / found.full,
                                     request->limit_response, where));
    return RITZ_OK;
}

static ritz_status add_gain(const pair *p, double limit, ritz_measures *out)
{
    double error = nan("");

    if (p->has_gain)
        RITZ_CHECK(ritz_gain_error(&p->gain[0], &p->gain[1], &error));
    RITZ_REFUSE_IF(isnan(error) && !isnan(limit), RITZ_ERR_ARGUMENT,
                   "--limit-gain: there is no static gain, a pole is at 0");
    if (!isnan(error))
        RITZ_CHECK(ritz_measures_add(out, "static-gain-relative", error, limit,
                                     "largest singular value"));
    return RITZ_OK;
}

/* Growth is held to rounding unless the full model grows too. */
static ritz_status add_growth(const ritz_state_space *full,
                              const ritz_state_space *reduced,
                              ritz_measures *out)
{
    ritz_probe probe[2] = {0};

    RITZ_CHECK_IN("full model", ritz_probe_states(full, &probe[0]));
    RITZ_CHECK_IN("reduced model", ritz_probe_states(reduced, &probe[1]));
    RITZ_CHECK(ritz_probe_record(&probe[1], out));
    if (probe[0].verdict == RITZ_UNSTABLE)
        out->item[out->count - 1].limit = nan("");
    return RITZ_OK;
}

static ritz_status check(const ritz_state_space *full,
                         const ritz_verify_request *request)
{
    const double *band = request->band_hz;

    RITZ_REFUSE_IF(full->num_inputs == 0 || full->num_outputs == 0,
                   RITZ_ERR_ARGUMENT,
                   "there are no %s, nothing can be compared",
                   full->num_inputs == 0 ? "inputs" : "outputs");
    RITZ_REFUSE_IF(!(band[0] >= 0.0) || !isfinite(band[1]) ||
                       (band[1] != 0.0 && band[0] >= band[1]),
                   RITZ_ERR_ARGUMENT, "a band from %g to %g Hz is none",
                   band[0], band[1]);
    return RITZ_OK;
}

ritz_status ritz_verify_states(const ritz_state_space *full,
                               const ritz_state_space *reduced,
                               const ritz_verify_request *request,
                               ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    ritz_state_space names = {0}; /* refuses what differs by name */
    ritz_measures found = {0};
    pair p = {0};

    RITZ_TRY(check(full, request));
    RITZ_TRY(ritz_state_space_difference(full, reduced, &names));
    RITZ_TRY(scale(full, full->limit, &p.model[0]));
    RITZ_TRY(scale(reduced, full->limit, &p.model[1]));
    for (int k = 0; k < 2; k++)
        RITZ_TRY(take_stable(&p.model[k], &p.stable[k], &p.apart[k]));
    RITZ_TRY(take_gains(&p));
    RITZ_TRY(add_norms(
        &p, ritz_measures_value(&reduced->estimates, "h-infinity-bound"),
        request, &found));
    RITZ_TRY(add_response(&p, request, &found));
    RITZ_TRY(add_gain(&p, request->limit_gain, &found));
    RITZ_TRY(add_growth(full, reduced, &found));
    *out = found;
    found = (ritz_measures){0};
done:
    ritz_state_space_free(&names);
    ritz_measures_free(&found);
    pair_free(&p);
    return status;
}
