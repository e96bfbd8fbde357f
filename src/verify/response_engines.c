/* The table of engines, how one is found, and which `auto` stands for. */
#include "verify/responder.h"

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
