/* The shipped chain, requests for states of it, and what comes of them. */
#ifndef RITZ_TESTS_STATES_H
#define RITZ_TESTS_STATES_H

#include <ritz/method.h>
#include <ritz/probe.h>
#include <ritz/state_space.h>

typedef struct states_fixture {
    ritz_component chain;
    ritz_request request;
} states_fixture;

/** Of cmocka: *state is a states_fixture. */
int states_set_up(void **state);
int states_tear_down(void **state);

/* A basis of states and what it makes of its component. */
typedef struct states_outcome {
    ritz_basis basis;
    ritz_state_space model;
    ritz_probe probe;
} states_outcome;

void states_run(const ritz_method *method, const ritz_request *request,
                states_outcome *out);
void states_discard(states_outcome *out);

ritz_request states_asking(const states_fixture *f, int64_t states,
                           bool inverse, ritz_gramian gramian);

#endif
