#include "states.h"

#include "testing.h"

#include "masses.h"

int states_set_up(void **state)
{
    static states_fixture f;

    f = (states_fixture){.request = RITZ_REQUEST_NONE};
    assert_ok(masses_shipped(&f.chain));
    f.request.component = &f.chain;
    *state = &f;
    return 0;
}

int states_tear_down(void **state)
{
    ritz_component_free(&((states_fixture *)*state)->chain);
    return 0;
}

void states_run(const ritz_method *method, const ritz_request *request,
                states_outcome *out)
{
    ritz_damping damping = {0};

    *out = (states_outcome){0};
    assert_ok(ritz_basis_make(method, request, &out->basis));
    assert_true(out->basis.states);
    assert_ok(ritz_damping_parse(out->basis.damping, &damping));
    assert_ok(ritz_reduce_states(request->component, &damping, &out->basis,
                                 &out->model));
    assert_ok(ritz_probe_states(&out->model, &out->probe));
}

void states_discard(states_outcome *out)
{
    ritz_basis_free(&out->basis);
    ritz_state_space_free(&out->model);
}

ritz_request states_asking(const states_fixture *f, int64_t states,
                           bool inverse, ritz_gramian gramian)
{
    ritz_request request = f->request;

    request.modes = states;
    request.choice.inverse = inverse;
    request.choice.gramian = gramian;
    return request;
}
