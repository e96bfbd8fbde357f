/* The model of engine projection: D split into a M + b K + P diag(c) P'. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/projection.h"
#include "model/local_damping.h"

#include <math.h>
#include <stdlib.h>

/* The first damper with a `value` (damping or stiffness) that is not 0, or
   -1. */
static int64_t find_acting(const ritz_dampers *dampers, const double *value)
{
    for (int64_t k = 0; k < dampers->count; k++)
        if (value[k] != 0.0)
            return k;
    return -1;
}

/*
 * a and b are the sums of those of the component's D and of the damping that
 * the request adds. *whole is false if they do not describe all damping but
 * that of discrete dampers. The K of the model includes the springs of dampers,
 * the K to which the component's D is proportional does not: with such springs
 * D is not a M + b K of the model.
 */
static ritz_status find_proportion(const ritz_gramians_request *request,
                                   double *a, double *b, bool *whole)
{
    const ritz_component *component = request->component;
    const ritz_damping *damping = &request->damping;

    RITZ_CHECK(ritz_damping_proportion(component, a, b, whole));
    if (component->D.colptr && *b != 0.0 && component->dampers.count > 0 &&
        find_acting(&component->dampers, component->dampers.k) >= 0)
        *whole = false;
    if (ritz_damping_is_rayleigh(damping)) {
        *a += damping->a;
        *b += damping->b;
    } else if (damping->kind != RITZ_DAMPING_NONE) {
        *whole = false;
    }
    return RITZ_OK;
}

ritz_status ritz_projection_fits(const ritz_gramians_request *request,
                                 bool *fits)
{
    double a = 0.0, b = 0.0;

    RITZ_CHECK(find_proportion(request, &a, &b, fits));
    *fits = *fits && b >= 0.0 && (a > 0.0 || b > 0.0);
    return RITZ_OK;
}

/* Constants and influence vectors of the dampers that have damping, not only a
   spring. The vectors are made orthogonal to rigid-body modes. */
static ritz_status collect_dampers(const ritz_dampers *dampers,
                                   ritz_projection_model *model)
{
    RITZ_OWN(ritz_dofs) acting = {0};

    RITZ_CHECK_NEW(acting.at, dampers->count);
    for (int64_t k = 0; k < dampers->count; k++)
        if (dampers->c[k] != 0.0)
            acting.at[acting.count++] = k;
    RITZ_CHECK_NEW(model->c, acting.count);
    for (int64_t k = 0; k < acting.count; k++)
        model->c[k] = dampers->c[acting.at[k]];
    if (acting.count == 0)
        return ritz_dense_new(model->low.n, 0, &model->P);
    RITZ_CHECK(
        ritz_dense_pick(&dampers->B, acting.count, acting.at, &model->P));
    return ritz_dense_take_out(&model->low.MPhi, &model->low.Phi, &model->P);
}

ritz_status ritz_projection_model_new(const ritz_gramians_request *request,
                                      ritz_projection_model *out)
{
    const ritz_io *io = &request->component->io;
    RITZ_OWN(ritz_projection_model)
    model = {.inputs = io->num_inputs, .outputs = io->num_outputs};
    bool whole = false;

    RITZ_CHECK(ritz_low_rank_model_new(request, &model.low));
    RITZ_CHECK(find_proportion(request, &model.a, &model.b, &whole));
    RITZ_REFUSE_IF(!whole, RITZ_ERR_ARGUMENT,
                   "the damping matrix is not a M + b K, which engine "
                   "'projection' needs: give local dampers by ritz-import "
                   "--damper, or take engine 'low-rank'");
    RITZ_REFUSE_IF(
        model.b < 0.0 || !(model.a + model.b * model.low.lowest > 0.0),
        RITZ_ERR_ARGUMENT,
        "D = %.3g M + %.3g K does not damp every motion, which engine "
        "'projection' needs: take engine 'low-rank'",
        model.a, model.b);
    model.most = (int64_t)(RITZ_FACTOR_BYTES / 8.0 / (double)model.low.n);
    if (request->most > 0 && request->most < model.most)
        model.most = request->most;
    RITZ_CHECK(collect_dampers(&request->component->dampers, &model));
    RITZ_MOVE(*out, model);
    return RITZ_OK;
}

void ritz_projection_model_free(ritz_projection_model *model)
{
    ritz_low_rank_model_free(&model->low);
    ritz_dense_free(&model->P);
    free(model->c);
    *model = (ritz_projection_model){0};
}
