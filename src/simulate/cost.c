/*
 * What a model costs a simulator, in processor time. Full matrices are used, as
 * a simulator of bodies does, whatever the coordinates: modal ones would be
 * cheaper and would say nothing about it.
 *
 * The largest s of det(s^2 M - s D - K) = 0, in modes with y = L^1/2 q / s:
 *
 *     s [q; y] = [D L^1/2; L^1/2 0] [q; y],
 *
 * symmetric with the symmetric part of D.
 */
#include "simulate/motion.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/matrix.h>

#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* Least processor time of one measurement, and how many there are. */
enum { MEASUREMENTS = 5, FIRST_STEPS = 16 };

static double processor_seconds(void)
{
    struct timespec now = {0};

    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + (double)now.tv_nsec / 1e9;
}

/* s, of modes. */
static ritz_status find_fastest(const ritz_motion *modes, double *out)
{
    int64_t m = modes->n;
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN_ARRAY double *w = NULL;
    double top = sqrt(modes->highest);

    for (int64_t j = 0; j < m; j++) {
        double d = ritz_dense_col(&modes->D, j)[j];

        top = fmax(top,
                   0.5 * d + sqrt(0.25 * d * d + fmax(modes->lambda[j], 0.0)));
    }
    *out = top;
    if (m == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(w, 2 * m);
    RITZ_CHECK(ritz_dense_new(2 * m, 2 * m, &A));
    for (int64_t j = 0; j < m; j++) {
        for (int64_t i = 0; i < m; i++)
            ritz_dense_col(&A, j)[i] = 0.5 * (ritz_dense_col(&modes->D, j)[i] +
                                              ritz_dense_col(&modes->D, i)[j]);
        ritz_dense_col(&A, j)[m + j] = sqrt(fmax(modes->lambda[j], 0.0));
    }
    RITZ_REFUSE_IF(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'L', (int)(2 * m),
                                 A.val, (int)(2 * m), w) != 0,
                   RITZ_ERR_CONVERGENCE, "the fastest motion was not found");
    *out = fmax(sqrt(modes->highest), w[2 * m - 1]);
    return RITZ_OK;
}

/* What is repeated while it is measured. */
typedef struct repeated {
    ritz_march *march; /* one step of it, with inputs u; NULL: a factor of A */
    const double *u;
    const ritz_dense *A;
    ritz_dense work;
} repeated;

/* Well-conditioned A: its Cholesky factor. */
static ritz_status factor_once(repeated *r)
{
    int n = (int)r->A->nrow;

    memcpy(r->work.val, r->A->val,
           (size_t)(r->A->nrow * r->A->ncol) * sizeof *r->A->val);
    RITZ_REFUSE_IF(
        LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, r->work.val, n) != 0,
        RITZ_ERR_SINGULAR, "a factor broke down");
    return RITZ_OK;
}

/* Processor time of @p count repetitions. */
static ritz_status run_repeated(repeated *r, int64_t count, double *out)
{
    double began = processor_seconds();

    for (int64_t k = 0; k < count; k++)
        RITZ_CHECK(r->march ? r->march->advance(r->march, r->u, r->u)
                            : factor_once(r));
    *out = processor_seconds() - began;
    return RITZ_OK;
}

/* Processor time of one: repeated until it takes long enough to be measured,
   the least of several measurements. */
static ritz_status measure_repeated(repeated *r, int64_t count, double *out)
{
    double spent = 0.0, least = HUGE_VAL;

    RITZ_CHECK(run_repeated(r, count, &spent));
    while (spent < RITZ_MEASURED_SECONDS) {
        count *= 2;
        RITZ_CHECK(run_repeated(r, count, &spent));
    }
    least = spent;
    for (int k = 1; k < MEASUREMENTS; k++) {
        RITZ_CHECK(run_repeated(r, count, &spent));
        least = fmin(least, spent);
    }
    *out = least / (double)count;
    return RITZ_OK;
}

ritz_status ritz_march_cost(ritz_march *march, const double *u, double *out)
{
    return measure_repeated(&(repeated){.march = march, .u = u}, FIRST_STEPS,
                            out);
}

ritz_status ritz_simulate_step_cost(ritz_model model,
                                    const ritz_integrator *integrator,
                                    double step, double *out)
{
    const ritz_simulation_request request = {
        .integrator = integrator, .step = step, .rho = 0.8};
    RITZ_OWN(ritz_motion) motion = {0};
    RITZ_OWN(ritz_march) march = {0};
    RITZ_OWN_ARRAY double *u = NULL;

    RITZ_REFUSE_IF(!(step > 0.0) || !isfinite(step), RITZ_ERR_ARGUMENT,
                   "%g s is no step", step);
    RITZ_CHECK(ritz_motion_full(model, &request, &motion));
    RITZ_CHECK_NEW(u, motion.B.ncol);
    RITZ_CHECK(ritz_march_new(&motion, integrator, step, request.rho, &march));
    return ritz_march_cost(&march, u, out);
}

ritz_status ritz_simulate_cost(ritz_model model, const double band_hz[2],
                               ritz_cost *out)
{
    ritz_cost cost = {.order = model.dense.K->nrow};
    RITZ_OWN(ritz_motion) modes = {0};
    double end = band_hz ? band_hz[1] : 0.0;
    double root = 0.0;

    RITZ_REFUSE_IF(!isfinite(end) || end < 0.0, RITZ_ERR_ARGUMENT,
                   "a band to %g Hz makes no sense", end);
    RITZ_CHECK(ritz_motion_dense(model, true, &modes));
    RITZ_CHECK(find_fastest(&modes, &root));
    cost.highest_hz = sqrt(modes.highest) / (2.0 * RITZ_PI);
    cost.step_explicit = root > 0.0 ? 2.0 / root : HUGE_VAL;
    if (end <= 0.0)
        end = cost.highest_hz > 0.0 ? cost.highest_hz : 1.0;
    cost.step_accurate = sqrt(12.0 * RITZ_PERIOD_ERROR) / (2.0 * RITZ_PI * end);
    cost.step = cost.step_accurate;
    (void)snprintf(cost.integrator, sizeof cost.integrator, "%s",
                   ritz_integrator_trapezoidal.name);
    RITZ_CHECK(ritz_simulate_step_cost(model, &ritz_integrator_trapezoidal,
                                       cost.step, &cost.seconds_per_second));
    cost.seconds_per_second /= cost.step;
    *out = cost;
    return RITZ_OK;
}

ritz_status ritz_simulate_refactor_cost(int64_t order, double *out)
{
    RITZ_OWN(ritz_dense) A = {0}, work = {0};

    RITZ_REFUSE_IF(order < 1, RITZ_ERR_ARGUMENT, "%" PRId64 " is no order",
                   order);
    RITZ_CHECK(ritz_dense_new(order, order, &A));
    RITZ_CHECK(ritz_dense_new(order, order, &work));
    for (int64_t j = 0; j < order; j++)
        for (int64_t i = 0; i < order; i++)
            ritz_dense_col(&A, j)[i] = i == j ? 2.0 : 1.0 / (double)order;
    return measure_repeated(&(repeated){.A = &A, .work = work}, 1, out);
}
