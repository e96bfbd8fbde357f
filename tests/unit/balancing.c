#include "balancing.h"

#include "testing.h"

#include "linear/general.h"
#include "masses.h"
#include "spring_chain.h"

#include <ritz/norms.h>

#include <stdio.h>
#include <stdlib.h>

void balancing_chain(int64_t n, bool is_free, int64_t in, int64_t out,
                     const char *damping, ritz_component *chain)
{
    assert_ok(spring_chain(n, is_free, chain));
    assert_ok(masses_io(chain, 1, &in, 1, &out));
    snprintf(chain->damping, sizeof chain->damping, "%s", damping);
}

ritz_request balancing_asking(const ritz_component *component, int64_t modes)
{
    ritz_request request = RITZ_REQUEST_NONE;

    request.component = component;
    request.modes = modes;
    return request;
}

void balancing_full(const ritz_component *component, ritz_state_space *out)
{
    ritz_damping damping = {0};

    assert_ok(ritz_damping_parse(component->damping, &damping));
    assert_ok(ritz_state_space_of_component(component, &damping, out));
}

double balancing_error(const ritz_state_space *a, const ritz_state_space *b)
{
    ritz_state_space difference = {0};
    ritz_norm norm = {0};

    assert_ok(ritz_state_space_difference(a, b, &difference));
    assert_ok(ritz_norm_infinity(&difference, 1e-6, &norm));
    ritz_state_space_free(&difference);
    return norm.value;
}

double _Complex *balancing_response(const ritz_state_space *model, double hertz)
{
    const double at[] = {hertz, 2.0 * hertz};
    const ritz_grid grid = {.hertz = at, .count = 2};
    ritz_response response = {0};
    double _Complex *H = NULL;
    int64_t size = model->num_outputs * model->num_inputs;

    assert_ok(ritz_response_states(model, &grid, &response));
    assert_non_null(H = calloc((size_t)size, sizeof *H));
    for (int64_t i = 0; i < model->num_outputs; i++)
        for (int64_t j = 0; j < model->num_inputs; j++)
            H[i + j * model->num_outputs] =
                response.H[i * model->num_inputs + j];
    ritz_response_free(&response);
    return H;
}

ritz_dense balancing_static(const ritz_state_space *model)
{
    ritz_dense X = {0}, gain = {0};

    assert_ok(ritz_dense_copy(&model->B, &X));
    assert_ok(ritz_general_solve(&model->A, false, &X));
    assert_ok(ritz_dense_mul(&model->C, &X, &gain));
    for (int64_t k = 0; k < gain.nrow * gain.ncol; k++)
        gain.val[k] = model->D.val[k] - gain.val[k];
    ritz_dense_free(&X);
    return gain;
}
