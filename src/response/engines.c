/* The table of engines, how one is found, which `auto` stands for, and what
   happens where that one fails. */
#include "response/responder.h"

#include <stdio.h>
#include <string.h>

const ritz_response_engine *const ritz_response_engines[] = {
    &ritz_response_engine_direct, &ritz_response_engine_krylov,
    &ritz_response_engine_modal,  &ritz_response_engine_rational,
    &ritz_response_engine_states, NULL,
};

enum { MOST = 16 };

const ritz_response_engine *ritz_response_engine_find(const char *name)
{
    char names[MOST][RITZ_NAME_SIZE];
    const char *near = NULL;
    int64_t count = 0;

    for (; ritz_response_engines[count] && count < MOST; count++) {
        if (strcmp(ritz_response_engines[count]->name, name) == 0)
            return ritz_response_engines[count];
        snprintf(names[count], RITZ_NAME_SIZE, "%s",
                 ritz_response_engines[count]->name);
    }
    near = ritz_text_nearest(name, count, names[0], sizeof names[0]);
    ritz_record(near ? "there is no engine '%s', is '%s' meant?"
                     : "there is no engine '%s'",
                name, near ? near : "");
    return NULL;
}

static bool has_matrices(const ritz_component *c)
{
    return c->D.colptr || c->K4.colptr;
}

static bool is_rayleigh(const ritz_response_request *request)
{
    return request->damping && ritz_damping_is_rayleigh(request->damping);
}

const ritz_response_engine *
ritz_response_engine_choose(const ritz_response_request *request,
                            const char **why)
{
    if (request->states) {
        *why = "a state space has no other";
        return &ritz_response_engine_states;
    }
    if (request->matrices) {
        *why = "all modes of a small dense model cost little";
        return &ritz_response_engine_modal;
    }
    if (has_matrices(request->component) || is_rayleigh(request)) {
        *why = "damping matrices act on all modes, which a sum of some misses";
        return &ritz_response_engine_krylov;
    }
    *why =
        "without damping matrices modes and the series of the rest are exact";
    return &ritz_response_engine_modal;
}

ritz_status ritz_responder_auto(const ritz_response_request *request,
                                const char **why, ritz_responder **out)
{
    return ritz_responder_or_direct(ritz_response_engine_choose(request, why),
                                    request, out);
}

ritz_status ritz_responder_or_direct(const ritz_response_engine *engine,
                                     const ritz_response_request *request,
                                     ritz_responder **out)
{
    ritz_status status = ritz_responder_new(engine, request, out);
    char said[RITZ_REMARK_SIZE / 2];

    if (status != RITZ_ERR_CONVERGENCE || !request->component)
        return status;
    (void)snprintf(said, sizeof said, "%.*s", (int)sizeof said - 1,
                   ritz_error_message());
    RITZ_TRY(ritz_responder_new(&ritz_response_engine_direct, request, out));
    (void)snprintf((*out)->remark, sizeof(*out)->remark,
                   "%s gave up, direct instead: %s", engine->name, said);
done:
    return status;
}
