/* The loop over time. */
#include "simulate/run.h"

#include "base/alloc.h"

#include <ritz/monitor.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double most_steps = 1e10;
/* Of more values than this a file is not to be made. */
static const int64_t most_values = INT64_C(1) << 31;
/* A step that ends within this part of itself of the end, ends there. */
static const double close = 1e-6;

ritz_status ritz_request_steps(const ritz_simulation_request *request,
                               int64_t *out)
{
    double steps = request->seconds / request->step;

    RITZ_REFUSE_IF(!isfinite(request->seconds) || request->seconds <= 0.0,
                   RITZ_ERR_ARGUMENT, "there are no %g seconds to simulate",
                   request->seconds);
    RITZ_REFUSE_IF(!isfinite(request->step) || request->step <= 0.0,
                   RITZ_ERR_ARGUMENT, "%g s is no step", request->step);
    RITZ_REFUSE_IF(steps > most_steps, RITZ_ERR_ARGUMENT,
                   "%g steps are too many", steps);
    *out = (int64_t)ceil(steps - close);
    if (*out < 1)
        *out = 1;
    return RITZ_OK;
}

static ritz_status make_room(const ritz_motion *motion,
                             const ritz_simulation_request *request,
                             int64_t steps, ritz_simulation *s)
{
    int64_t every = request->every > 0 ? request->every : 1;
    int64_t values = 0;

    s->num_inputs = motion->feed.ncol;
    s->num_outputs = motion->feed.nrow;
    s->count = steps / every + 1;
    s->step = request->step;
    s->order = motion->n;
    values = s->num_inputs + s->num_outputs + 8;
    RITZ_REFUSE_IF(s->count > most_values / values, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " times are too many to write: give --every",
                   s->count);
    RITZ_CHECK_NEW(s->seconds, s->count);
    RITZ_CHECK_NEW(s->u, s->count * s->num_inputs);
    RITZ_CHECK_NEW(s->y, s->count * s->num_outputs);
    RITZ_CHECK_NEW(s->input, s->num_inputs);
    RITZ_CHECK_NEW(s->output, s->num_outputs);
    if (motion->form != RITZ_FORM_STATES && motion->energies) {
        RITZ_CHECK_NEW(s->kinetic, s->count);
        RITZ_CHECK_NEW(s->potential, s->count);
        RITZ_CHECK_NEW(s->dissipated, s->count);
        RITZ_CHECK_NEW(s->work, s->count);
        RITZ_CHECK_NEW(s->balance, s->count);
    }
    (void)snprintf(s->integrator, sizeof s->integrator, "%s",
                   request->integrator->name);
    (void)snprintf(s->hold, sizeof s->hold, "%s",
                   request->hold == RITZ_HOLD_ZERO ? "zero" : "first");
    return RITZ_OK;
}

static void inputs_at(const ritz_simulation_request *request, int64_t step,
                      int64_t count, double *u)
{
    for (int64_t j = 0; j < count; j++)
        u[j] = request->signal ? ritz_signal_at(&request->signal[j],
                                                (double)step * request->step,
                                                request->seconds)
                               : 0.0;
}

/* out = to'from, or from. */
static void place(const ritz_motion *motion, const double *from, double *out)
{
    if (!from)
        return;
    if (!motion->to.val) {
        memcpy(out, from, (size_t)motion->n * sizeof *out);
        return;
    }
    for (int64_t k = 0; k < motion->n; k++)
        out[k] = ritz_motion_dot(motion->original,
                                 ritz_dense_col(&motion->to, k), from);
}

/*
 * Dofs without mass in equilibrium: K_nn dx_n = (B u - K x)_n, as K with all
 * other rows and columns those of the identity.
 */
static ritz_status balance_massless(const ritz_motion *motion, const double *u,
                                    double *x)
{
    ritz_status status = RITZ_OK;
    int64_t count = 0;
    int64_t *row = NULL;
    double *r = NULL;
    ritz_sparse K = {0};
    ritz_factor *F = NULL;
    ritz_dense part = {0};

    RITZ_NEW(row, motion->n);
    RITZ_NEW(r, motion->n);
    for (int64_t k = 0; motion->massless && k < motion->n; k++)
        if (motion->massless[k])
            row[count++] = k;
    if (count == 0)
        goto done;
    ritz_motion_gemv(&motion->B, 1.0, u, r);
    ritz_motion_stiffness(motion, -1.0, x, r);
    RITZ_TRY(ritz_sparse_extract(&motion->sK, count, row, count, row, &K));
    RITZ_TRY_IN("dofs without mass", ritz_factor_spd(&K, &F));
    RITZ_TRY(ritz_dense_new(count, 1, &part));
    for (int64_t k = 0; k < count; k++)
        part.val[k] = r[row[k]];
    RITZ_TRY(ritz_factor_solve(F, &part));
    for (int64_t k = 0; k < count; k++)
        x[row[k]] += part.val[k];
done:
    free(row);
    free(r);
    ritz_sparse_free(&K);
    ritz_factor_free(&F);
    ritz_dense_free(&part);
    return status;
}

/* Impulses: a jump of x' (of x of states), and the work it takes. */
static void push(const ritz_motion *motion,
                 const ritz_simulation_request *request, ritz_march *march)
{
    double *moved = march->v ? march->v : march->x;
    double before = 0.0, after = 0.0, potential = 0.0;

    if (march->v)
        ritz_march_energy(march, &before, &potential);
    for (int64_t j = 0; request->signal && j < motion->push.ncol; j++) {
        const double *jump = ritz_dense_col(&motion->push, j);
        const ritz_signal *signal = &request->signal[j];

        for (int64_t k = 0;
             signal->kind == RITZ_SIGNAL_IMPULSE && k < motion->n; k++)
            moved[k] += signal->amplitude * jump[k];
    }
    if (march->v)
        ritz_march_energy(march, &after, &potential);
    march->work += after - before;
}

static void note(const ritz_march *march, double start, int64_t k,
                 const double *u, ritz_simulation *s)
{
    for (int64_t j = 0; j < s->num_inputs; j++)
        s->u[k * s->num_inputs + j] = u[j];
    ritz_march_see(march, u, s->y + k * s->num_outputs);
    if (!s->balance)
        return;
    ritz_march_energy(march, &s->kinetic[k], &s->potential[k]);
    s->dissipated[k] = march->dissipated;
    s->work[k] = march->work;
    s->balance[k] = s->kinetic[k] + s->potential[k] + march->dissipated -
                    march->work - start;
}

static bool is_finite(const ritz_march *march)
{
    double sum = 0.0;

    for (int64_t k = 0; k < march->motion->n; k++)
        sum += march->v ? march->v[k] + march->x[k] : march->x[k];
    return isfinite(sum);
}

/* Before the first step; what energy there is before impulses act. */
static ritz_status begin(const ritz_motion *motion,
                         const ritz_simulation_request *request,
                         const double *u, ritz_march *march, double *energy)
{
    double kinetic = 0.0, potential = 0.0;

    place(motion, request->x0, march->x);
    if (march->v)
        place(motion, request->v0, march->v);
    RITZ_CHECK(balance_massless(motion, u, march->x));
    if (march->v)
        ritz_march_energy(march, &kinetic, &potential);
    *energy = kinetic + potential;
    push(motion, request, march);
    if (march->settle)
        RITZ_CHECK(march->settle(march, u));
    return RITZ_OK;
}

ritz_status ritz_run(const ritz_motion *motion,
                     const ritz_simulation_request *request, ritz_reach *reach,
                     ritz_simulation *out)
{
    ritz_status status = RITZ_OK;
    ritz_simulation s = {0};
    ritz_march march = {0};
    double *u0 = NULL, *u1 = NULL;
    int64_t steps = 0;
    int64_t every = request->every > 0 ? request->every : 1;
    double energy = 0.0;

    RITZ_TRY(ritz_request_steps(request, &steps));
    RITZ_TRY(make_room(motion, request, steps, &s));
    RITZ_NEW(u0, s.num_inputs);
    RITZ_NEW(u1, s.num_inputs);
    RITZ_TRY(ritz_march_new(motion, request->integrator, request->step,
                            request->rho, &march));
    inputs_at(request, 0, s.num_inputs, u1);
    RITZ_TRY(begin(motion, request, u1, &march, &energy));
    note(&march, energy, 0, u1, &s);
    if (reach)
        ritz_reach_note(reach, &march, 0.0);
    for (int64_t k = 1; k <= steps; k++) {
        double t = (double)k * request->step;

        memcpy(u0, u1, (size_t)s.num_inputs * sizeof *u0);
        inputs_at(request, k, s.num_inputs, u1);
        RITZ_TRY(march.advance(&march, u0,
                               request->hold == RITZ_HOLD_ZERO ? u0 : u1));
        if (k % every != 0)
            continue;
        RITZ_FAIL_IF(!is_finite(&march), RITZ_ERR_CONVERGENCE,
                     "the motion has left all bounds after %g s: is the model "
                     "stable?",
                     t);
        s.seconds[k / every] = t;
        note(&march, energy, k / every, u1, &s);
        if (reach)
            ritz_reach_note(reach, &march, t);
        ritz_monitor_step("simulation", k, steps);
    }
    *out = s;
    s = (ritz_simulation){0};
done:
    free(u0);
    free(u1);
    ritz_march_free(&march);
    ritz_simulation_free(&s);
    return status;
}
