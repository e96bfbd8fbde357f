/*
 * Response by modes: all of a small dense model; of a full component its lowest
 * ones and the residual of the rest.
 */
#include "base/alloc.h"

#include "base/tolerances.h"
#include "poles/dense_poles.h"
#include "poles/massless.h"
#include "response/responder.h"

#include <math.h>
#include <stdlib.h>

/* `pairs` and `residual` of a component alone. */
typedef struct modal_responder {
    ritz_pairs pairs;
    ritz_poles poles;
    ritz_residual residual;
} modal_responder;

static void modal_free(modal_responder *m)
{
    ritz_pairs_free(&m->pairs);
    ritz_poles_free(&m->poles);
    ritz_residual_free(&m->residual);
}

static void finish(void *state)
{
    modal_free(state);
    free(state);
}

static ritz_status at(void *state, double hertz, double _Complex *H)
{
    const modal_responder *m = state;

    RITZ_CHECK(ritz_poles_add(&m->poles, hertz, H));
    ritz_residual_add(&m->residual, hertz, H);
    return RITZ_OK;
}

static ritz_status of_component(const ritz_response_request *request,
                                modal_responder *m)
{
    double highest = ritz_response_highest(request);

    RITZ_REFUSE_IF(highest < request->to_hz, RITZ_ERR_ARGUMENT,
                   "modes up to %g Hz cannot give a response up to %g Hz",
                   highest, request->to_hz);
    RITZ_CHECK(ritz_poles_of_component(request->component, request->damping,
                                       highest, &m->pairs, &m->poles));
    return ritz_residual_new(request->component, request->damping, &m->pairs,
                             request->to_hz, highest, &m->residual);
}

static ritz_status make(const ritz_response_request *request,
                        ritz_responder *out)
{
    ritz_status status = RITZ_OK;
    modal_responder *m = NULL;

    RITZ_NEW(m, 1);
    if (request->component)
        RITZ_TRY(of_component(request, m));
    else
        RITZ_TRY(ritz_poles_of_dense(request->matrices, request->damping,
                                     request->to_hz, &m->poles));
    out->poles = &m->poles;
    out->at = at;
    out->free = finish;
    out->state = m;
    m = NULL;
done:
    if (m)
        finish(m);
    return status;
}

const ritz_response_engine ritz_response_engine_modal = {
    .name = "modal",
    .summary = "a sum of modes, and of a component the series of the rest",
    .reference = "Sirlin1992",
    .when = "reduced components and systems; components with damping ratios",
    .cost = "the modes; then O(modes) a point, O(modes^3) where D or K4 "
            "couples them",
    .holds = "exact for dense models; of components without K4, and with no D "
             "but a M + b K, to 1e-12",
    .fails = "of components, K4 and any other D act on the modes that are "
             "summed alone",
    .takes = RITZ_RESPONDS_COMPONENT | RITZ_RESPONDS_MATRICES,
    .make = make,
};

ritz_status ritz_response_modal(const ritz_component *component,
                                const ritz_damping *damping, double up_to_hz,
                                const ritz_grid *grid, ritz_response *out)
{
    ritz_response_request request = {
        .component = component, .damping = damping, .up_to_hz = up_to_hz};

    return ritz_response_once(&ritz_response_engine_modal, &request, grid, out);
}

ritz_status ritz_response_second_order(const ritz_second_order *model,
                                       const ritz_damping *damping,
                                       const ritz_grid *grid,
                                       ritz_response *out)
{
    ritz_response_request request = {.matrices = model, .damping = damping};

    return ritz_response_once(&ritz_response_engine_modal, &request, grid, out);
}

ritz_status ritz_response_dense(const ritz_dense *K, const ritz_dense *M,
                                const ritz_dense *D, const ritz_io *io,
                                const ritz_damping *damping,
                                const ritz_grid *grid, ritz_response *out)
{
    const ritz_second_order model = {.K = K, .M = M, .D = D, .io = io};

    return ritz_response_second_order(&model, damping, grid, out);
}

/* Every mode of a small dense model, for a response by all of them. */

/* Phi'A Phi; {0} of an absent one. */
static ritz_status project(const ritz_dense *A, const ritz_dense *Phi,
                           ritz_dense *out)
{
    return A && A->val ? ritz_dense_project(A, Phi, out) : RITZ_OK;
}

/*
 * Far below 0 an eigenvalue is no rounding: -3e-9 of the largest was seen. All
 * of a rigid body are rounding, of a stiffness that they do not tell of: the
 * largest that matters is then that of the response, (2 pi f)^2.
 */
static ritz_status refuse_unstable(const ritz_pairs *pairs, double to_hz)
{
    int64_t m = pairs->Phi.ncol;
    double largest = pow(2.0 * RITZ_PI * to_hz, 2.0);

    if (m > 0)
        largest = fmax(largest, fabs(pairs->lambda[m - 1]));
    RITZ_REFUSE_IF(m > 0 &&
                       pairs->lambda[0] < -RITZ_NEGATIVE_STIFFNESS * largest,
                   RITZ_ERR_ARGUMENT,
                   "the stiffness has a negative eigenvalue, %.3g where the "
                   "largest is %.3g: an unstable model has no steady response",
                   pairs->lambda[0], pairs->lambda[m - 1]);
    return RITZ_OK;
}

/* Whether A moves with any of N, beyond rounding. */
static ritz_status acts(const ritz_dense *A, const ritz_dense *N, bool *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense AN = {0}, NA = {0};

    if (!A || !A->val || N->ncol == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_dense_mul(A, N, &AN));
    RITZ_TRY(ritz_dense_mul_tn(A, N, &NA));
    if (fmax(ritz_dense_max(&AN), ritz_dense_max(&NA)) >
        RITZ_NO_COUPLING * ritz_dense_max(A) * ritz_dense_max(N))
        *out = true;
done:
    ritz_dense_free(&AN);
    ritz_dense_free(&NA);
    return status;
}

/*
 * Damping of motions without mass couples them with the modes: they are taken
 * beside them, as X = [Phi N], and their lambda is N'KN = 1.
 */
static ritz_status take_massless(const ritz_second_order *model, bool beside,
                                 ritz_pairs *pairs, int64_t *count)
{
    ritz_status status = RITZ_OK;
    ritz_dense N = {0}, X = {0};
    int64_t m = pairs->Phi.ncol;
    bool damped = beside;

    *count = 0;
    if (m == pairs->Phi.nrow)
        return RITZ_OK;
    RITZ_TRY(ritz_massless(model, &pairs->Phi, pairs->lambda, &N));
    RITZ_TRY(acts(model->D, &N, &damped));
    RITZ_TRY(acts(model->K4, &N, &damped));
    if (!damped)
        goto done;
    RITZ_TRY(ritz_dense_beside(&pairs->Phi, &N, &X));
    ritz_dense_free(&pairs->Phi);
    pairs->Phi = X;
    *count = N.ncol;
    for (int64_t j = m; j < X.ncol; j++) /* lambda has room for all rows */
        pairs->lambda[j] = 1.0;
done:
    ritz_dense_free(&N);
    return status;
}

/* The last coordinates are no modes: no ratio acts on them. */
static ritz_status mark_massless(int64_t count, const ritz_dense *D,
                                 const ritz_damping *damping, ritz_poles *poles)
{
    double b = damping && ritz_damping_is_rayleigh(damping) ? damping->b : 0.0;

    poles->count -= count;
    poles->massless = count;
    poles->coupled = poles->coupled || count > 0;
    if (count > 0 && !poles->D.val) /* beside modes that nothing couples */
        RITZ_CHECK(ritz_dense_new(poles->count + count, poles->count + count,
                                  &poles->D));
    for (int64_t j = 0; j < poles->count && count > 0; j++)
        ritz_dense_col(&poles->D, j)[j] = poles->rate[j];
    for (int64_t j = poles->count; j < poles->count + count; j++) {
        poles->rate[j] = b + (D->val ? ritz_dense_col(D, j)[j] : 0.0);
        ritz_dense_col(&poles->D, j)[j] = poles->rate[j];
    }
    return RITZ_OK;
}

ritz_status ritz_poles_of_pairs(const ritz_second_order *model,
                                const ritz_damping *damping, bool beside,
                                ritz_pairs *pairs, ritz_poles *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense D = {0};
    ritz_dense K4 = {0};
    ritz_residual rest = {0};
    int64_t massless = 0;

    RITZ_TRY(ritz_static_rest(model, pairs, &rest));
    RITZ_TRY(take_massless(model, beside, pairs, &massless));
    RITZ_TRY_IN("D", project(model->D, &pairs->Phi, &D));
    RITZ_TRY_IN("K4", project(model->K4, &pairs->Phi, &K4));
    RITZ_TRY(ritz_poles_new(pairs, &D, &K4, model->io, damping, out));
    RITZ_TRY(mark_massless(massless, &D, damping, out));
    if (massless == 0) {
        out->rest = rest;
        if (damping && ritz_damping_is_rayleigh(damping))
            out->rest.b = damping->b;
        rest = (ritz_residual){0};
    }
done:
    ritz_dense_free(&D);
    ritz_dense_free(&K4);
    ritz_residual_free(&rest);
    return status;
}

ritz_status ritz_poles_of_dense(const ritz_second_order *model,
                                const ritz_damping *damping, double to_hz,
                                ritz_poles *out)
{
    ritz_status status = RITZ_OK;
    ritz_pairs pairs = {0};

    RITZ_TRY(ritz_eigen_dense(model->K, model->M, &pairs));
    RITZ_TRY(refuse_unstable(&pairs, to_hz));
    RITZ_TRY(ritz_poles_of_pairs(model, damping, false, &pairs, out));
done:
    ritz_pairs_free(&pairs);
    return status;
}
