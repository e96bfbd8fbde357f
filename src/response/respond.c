/* The choice of the engine, and a response all at once. */
#include "response/responder.h"

#include <stdio.h>

const ritz_response_engine *ritz_response_engine_find(const char *name)
{
    return ritz_row_find(ritz_response_engines, "engine", name);
}

const ritz_response_engine *
ritz_response_engine_choose(const ritz_response_request *request,
                            const char **why)
{
    const ritz_component *c = request->model.component;
    const ritz_damping *damping = request->model.damping;

    if (request->model.kind == RITZ_MODEL_STATES) {
        bool sparse = ritz_state_space_is_sparse(request->model.states);

        *why = sparse ? "A and E are sparse" : "A is small and dense";
        return sparse ? &ritz_response_engine_sparse
                      : &ritz_response_engine_states;
    }
    if (request->model.kind == RITZ_MODEL_DENSE) {
        *why = "all modes of a small dense model cost little";
        return &ritz_response_engine_modal;
    }
    if (c->D.colptr || c->K4.colptr ||
        (damping && ritz_damping_is_rayleigh(damping))) {
        *why = "damping matrices act on all modes, which a sum of some misses";
        return &ritz_response_engine_krylov;
    }
    *why = "without damping matrices modes and the series of the rest are "
           "exact";
    return &ritz_response_engine_modal;
}

ritz_status ritz_responder_or_direct(const ritz_response_engine *engine,
                                     const ritz_response_request *request,
                                     ritz_responder **out)
{
    ritz_status status = ritz_responder_new(engine, request, out);
    char said[RITZ_REMARK_SIZE / 2];

    if (status != RITZ_ERR_CONVERGENCE ||
        request->model.kind != RITZ_MODEL_COMPONENT)
        return status;
    (void)snprintf(said, sizeof said, "%.*s", (int)sizeof said - 1,
                   ritz_error_message());
    RITZ_CHECK(ritz_responder_new(&ritz_response_engine_direct, request, out));
    (void)snprintf((*out)->remark, sizeof(*out)->remark,
                   "%s gave up, direct instead: %s", engine->name, said);
    return RITZ_OK;
}

ritz_status ritz_response_of(ritz_model model,
                             const ritz_response_engine *engine,
                             double up_to_hz, double tolerance,
                             const ritz_grid *grid, ritz_response *out)
{
    RITZ_OWN(ritz_responder) *responder = NULL;
    const char *why = NULL;
    ritz_response_request request = {
        .model = model, .up_to_hz = up_to_hz, .tolerance = 0.1 * tolerance};

    RITZ_CHECK(ritz_grid_check(grid));
    request.from_hz = grid->hertz ? grid->hertz[0] : grid->from_hz;
    request.to_hz = grid->hertz ? grid->hertz[grid->count - 1] : grid->to_hz;
    if (engine)
        RITZ_CHECK(ritz_responder_new(engine, &request, &responder));
    else
        RITZ_CHECK(ritz_responder_or_direct(
            ritz_response_engine_choose(&request, &why), &request, &responder));
    if (tolerance > 0.0)
        return ritz_responder_follow(responder, grid, tolerance, out);
    return ritz_responder_sample(responder, grid, out);
}
