/*
 * Response by modes: all modes of a small dense model; the lowest modes of a
 * full component, with the residual of the others.
 */
#include "base/alloc.h"
#include "response/responder.h"

#include <stdlib.h>

/* `pairs` and `residual` are those of a component, else empty. */
typedef struct modal_responder {
    ritz_pairs pairs;
    ritz_poles poles;
    ritz_residual residual;
} modal_responder;

static void free_modal(void *state)
{
    modal_responder *m = state;

    ritz_pairs_free(&m->pairs);
    ritz_poles_free(&m->poles);
    ritz_residual_free(&m->residual);
}

static ritz_status modal_at(void *state, double hertz, double _Complex *H)
{
    const modal_responder *m = state;

    RITZ_CHECK(ritz_poles_add(&m->poles, hertz, H));
    ritz_residual_add(&m->residual, hertz, H);
    return RITZ_OK;
}

static ritz_status make_modal(const ritz_response_request *request,
                              ritz_responder *out)
{
    const ritz_model *model = &request->model;
    double highest = ritz_response_highest(request);
    modal_responder *m = NULL;

    RITZ_CHECK_NEW(m, 1);
    out->state = m;
    out->free = free_modal;
    out->poles = &m->poles;
    out->at = modal_at;
    if (model->kind != RITZ_MODEL_COMPONENT)
        return ritz_poles_of_dense(&model->dense, model->damping,
                                   request->to_hz, &m->poles);
    RITZ_REFUSE_IF(highest < request->to_hz, RITZ_ERR_ARGUMENT,
                   "modes up to %g Hz cannot give a response up to %g Hz: "
                   "raise --up-to-hz",
                   highest, request->to_hz);
    RITZ_CHECK(ritz_poles_of_component(model->component, model->damping,
                                       highest, &m->pairs, &m->poles));
    return ritz_residual_new(model->component, model->damping, &m->pairs,
                             request->to_hz, highest, &m->residual);
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
    .takes = (int)RITZ_MODEL_COMPONENT | (int)RITZ_MODEL_DENSE,
    .make = make_modal,
};
