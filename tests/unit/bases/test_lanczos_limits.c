#include "responses.h"
#include "testing.h"

#include "masses.h"
#include "states.h"

#include <ritz/response.h>

#include <complex.h>
#include <stdio.h>
#include <stdlib.h>

enum { MASSES = 10, STATES = 2 * MASSES };

/* A free chain whose damping leaves rigid motion alone: 2 + N states. */
static void rigid_modes_stand_apart(void **state)
{
    static const double m[] = {1, 2, 1}, k[] = {0, 5, 5};
    static const int64_t ends[] = {0, 2};
    states_fixture local = *(states_fixture *)*state;
    const double hertz[] = {0.05, 0.2, 0.5};
    const ritz_grid grid = {.count = 3, .hertz = hertz};
    const ritz_damping ratio = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.02};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_response) due = {0};

    assert_ok(masses_component(3, m, k, NULL, &chain));
    assert_ok(masses_io(&chain, 1, ends, 1, ends + 1));
    snprintf(chain.damping, sizeof chain.damping, "modal 0.02");
    local.request.component = &chain;
    assert_ok(direct_response(&chain, &ratio, 9.0, &grid, &due));
    for (int t = 0; t < 5; t++) {
        ritz_request request =
            states_asking(&local, 4, t % 2 == 0, (ritz_gramian)(t / 2 % 2));
        RITZ_OWN(ritz_response) r = {0};
        states_outcome got = {0};

        states_run(t < 4 ? &ritz_method_lanczos_one_sided
                         : &ritz_method_lanczos_two_sided,
                   &request, &got);
        assert_int_equal(got.model.A.nrow, 6);
        assert_int_equal(got.model.columns.kind[1], RITZ_COLUMN_RIGID);
        assert_int_equal(got.model.columns.kind[2], RITZ_COLUMN_STATE);
        assert_int_equal(got.probe.verdict, RITZ_MARGINAL);
        assert_near(got.probe.pole[0], 0.0, 1e-12);
        assert_ok(states_response(&got.model, &grid, &r));
        for (int i = 0; i < 3; i++) /* measured: 6e-11, of the direct one */
            assert_true(cabs(r.H[i] - due.H[i]) < 1e-9 * cabs(due.H[i]));
        states_discard(&got);
    }
}

/* Oscillators beside each other, of 1, 2, ... rad/s and damping 0.02. */
static void set_oscillators(int64_t n, ritz_component *out)
{
    ritz_component own = {.num_dofs = n, .units = "none"};
    int64_t row[4];
    double one[4], k[4], c[4];

    assert_non_null(own.dof = calloc((size_t)n, sizeof *own.dof));
    for (int64_t i = 0; i < n; i++) {
        own.dof[i] = (ritz_dof){i + 1, 1};
        row[i] = i;
        one[i] = 1.0;
        k[i] = (double)((i + 1) * (i + 1));
        c[i] = 0.02;
    }
    assert_ok(ritz_sparse_from_triplets(n, n, n, row, row, k, &own.K));
    assert_ok(ritz_sparse_from_triplets(n, n, n, row, row, one, &own.M));
    assert_ok(ritz_sparse_from_triplets(n, n, n, row, row, c, &own.D));
    assert_ok(ritz_component_settle(&own, false));
    *out = own;
}

/*
 * Inputs reach oscillators 1 and 2, outputs see 1 and 3: after the states of 1
 * what is left of the right is orthogonal to what is left of the left.
 */
static void breakdown_stops_with_the_vectors_there_are(void **state)
{
    static const int64_t in[] = {0, 1}, seen[] = {0, 2};
    states_fixture local = *(states_fixture *)*state;
    RITZ_OWN(ritz_component) own = {0};
    ritz_request request = {0};
    states_outcome got = {0};

    set_oscillators(3, &own);
    assert_ok(masses_io(&own, 2, in, 2, seen));
    local.request.component = &own;
    request = states_asking(&local, 5, true, RITZ_GRAMIAN_INPUTS);
    states_run(&ritz_method_lanczos_two_sided, &request, &got);
    assert_int_equal(got.model.A.nrow, 2);
    assert_non_null(strstr(got.basis.remark, "serious breakdown after 2"));
    assert_near(got.probe.pole[0], -0.01, 1e-14);
    states_discard(&got);
}

/* Two inputs and one output: one direction of the right waits each time. */
static void unequal_numbers_of_inputs_and_outputs_are_joined(void **state)
{
    static const int64_t in[] = {9, 4}, seen[] = {0};
    states_fixture *f = *state;
    const double hertz[] = {0.0, 0.02, 0.1};
    const ritz_grid grid = {.count = 3, .hertz = hertz};
    const ritz_damping none = {0};
    ritz_request request = {0};
    RITZ_OWN(ritz_state_space) full = {0};
    RITZ_OWN(ritz_response) r = {0}, due = {0};
    states_outcome got = {0};

    assert_ok(masses_io(&f->chain, 2, in, 1, seen));
    request = states_asking(f, STATES, true, RITZ_GRAMIAN_INPUTS);
    states_run(&ritz_method_lanczos_two_sided, &request, &got);
    assert_int_equal(got.model.A.nrow, STATES);
    assert_ok(ritz_state_space_of_component(&f->chain, &none, &full));
    assert_ok(states_response(&full, &grid, &due));
    assert_ok(states_response(&got.model, &grid, &r));
    for (int k = 0; k < 6; k++) /* measured: 1e-11 */
        assert_true(cabs(r.H[k] - due.H[k]) < 1e-8);
    states_discard(&got);
}

/* A free chain with a dashpot to ground: its rest is a pole at 0. */
static void a_shift_bounds_what_is_not_stable(void **state)
{
    static const double m[] = {1, 2, 1}, k[] = {0, 5, 5}, c[] = {0.1, 0, 0};
    static const int64_t ends[] = {0, 2};
    states_fixture local = *(states_fixture *)*state;
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = {0};
    ritz_basis none = {0};

    assert_ok(masses_component(3, m, k, c, &chain));
    assert_ok(masses_io(&chain, 1, ends, 1, ends + 1));
    local.request.component = &chain;
    request = states_asking(&local, 4, false, RITZ_GRAMIAN_INPUTS);
    assert_fails(
        ritz_basis_make(&ritz_method_lanczos_one_sided, &request, &none),
        RITZ_ERR_ARGUMENT, "has no damping, give some or a shift above 0 Hz");
    request.choice.inverse = true;
    assert_fails(
        ritz_basis_make(&ritz_method_lanczos_two_sided, &request, &none),
        RITZ_ERR_SINGULAR, "the matrix of states has no inverse");
    request.choice.given = RITZ_USES_SHIFTS;
    request.choice.num_shifts = 1;
    request.choice.shift_hz[0] = 0.01;
    for (int t = 0; t < 3; t++) {
        states_outcome got = {0};

        request.choice.inverse = t > 0;
        states_run(t < 2 ? &ritz_method_lanczos_one_sided
                         : &ritz_method_lanczos_two_sided,
                   &request, &got);
        assert_int_equal(got.model.A.nrow, 4);
        if (t < 2) /* right of the shift there is nothing */
            assert_true(got.probe.pole[0] < 0.01 * 6.2831853071795865);
        states_discard(&got);
    }
    /* a spring of -1 on the first mass: growth at 0.5 rad/s or so */
    chain.K.val[0] -= 1.0;
    assert_fails(
        ritz_basis_make(&ritz_method_lanczos_one_sided, &request, &none),
        RITZ_ERR_ARGUMENT, "a pole grows at");
}

static void assert_refused(const ritz_method *method,
                           const ritz_request *request, ritz_status code,
                           const char *words)
{
    ritz_basis none = {0};

    assert_fails(ritz_basis_make(method, request, &none), code, words);
}

static void what_cannot_be_done_is_refused(void **state)
{
    static const int64_t one[] = {0}, last[] = {9};
    states_fixture *f = *state;
    const ritz_method *single = &ritz_method_lanczos_one_sided;
    const ritz_method *both = &ritz_method_lanczos_two_sided;
    ritz_request request = states_asking(f, 4, false, RITZ_GRAMIAN_INPUTS);
    ritz_component *chain = &f->chain;
    RITZ_OWN(ritz_component) rigid = {0};
    static const double mass[] = {2.0}, zero[] = {0.0};

    /* displacement outputs have no first Markov parameter */
    assert_refused(both, &request, RITZ_ERR_SINGULAR,
                   "serious breakdown at the first block: C B is zero");
    request.modes = 0;
    assert_refused(single, &request, RITZ_ERR_ARGUMENT,
                   "no states are asked for");
    request.modes = -1;
    request.up_to_hz = 3.0;
    assert_refused(single, &request, RITZ_ERR_ARGUMENT, "by their number");
    request = states_asking(f, 4, false, RITZ_GRAMIAN_INPUTS);
    request.choice.num_shifts = 2;
    assert_refused(both, &request, RITZ_ERR_ARGUMENT, "not by several");
    request.choice.num_shifts = 0;
    assert_ok(masses_io(chain, 1, last, 0, one));
    assert_refused(both, &request, RITZ_ERR_ARGUMENT, "has no outputs");
    request.choice.gramian = RITZ_GRAMIAN_OUTPUTS;
    assert_refused(single, &request, RITZ_ERR_ARGUMENT, "has no outputs");
    assert_ok(masses_io(chain, 0, last, 1, one));
    request.choice.gramian = RITZ_GRAMIAN_INPUTS;
    assert_refused(single, &request, RITZ_ERR_ARGUMENT, "has no inputs");
    assert_ok(masses_io(chain, 1, last, 1, one));
    ritz_dense_col(&chain->io.B, 0)[9] = 0.0;
    assert_refused(single, &request, RITZ_ERR_ARGUMENT, "the Gramian is zero");
    request.choice.inverse = true;
    assert_refused(both, &request, RITZ_ERR_ARGUMENT,
                   "no flexible state is both controllable and observable");
    ritz_sparse_free(&chain->D);
    assert_ok(masses_io(chain, 1, last, 1, one));
    assert_refused(single, &request, RITZ_ERR_ARGUMENT, "has no damping");
    assert_ok(ritz_sparse_copy(&chain->K, &chain->K4));
    assert_refused(single, &request, RITZ_ERR_ARGUMENT, "structural damping");
    assert_ok(masses_component(1, mass, zero, NULL, &rigid));
    assert_ok(masses_io(&rigid, 1, one, 1, one));
    request.component = &rigid;
    assert_refused(single, &request, RITZ_ERR_ARGUMENT, "no flexible states");
}

/* States are no masses and stiffnesses, and displacements no states. */
static void bases_of_the_wrong_kind_are_refused(void **state)
{
    states_fixture *f = *state;
    ritz_request request = states_asking(f, 4, true, RITZ_GRAMIAN_INPUTS);
    const ritz_damping none = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_reduced reduced = {0};
    ritz_state_space model = {0};

    assert_ok(
        ritz_basis_make(&ritz_method_lanczos_one_sided, &request, &basis));
    assert_fails(ritz_reduce(&f->chain, &basis, &reduced), RITZ_ERR_ARGUMENT,
                 "is of states");
    basis.states = false;
    assert_fails(ritz_reduce_states(&f->chain, &none, &basis, &model),
                 RITZ_ERR_ARGUMENT, "is of displacements");
    basis.states = true;
    basis.T.nrow = 18;
    assert_fails(ritz_reduce_states(&f->chain, &none, &basis, &model),
                 RITZ_ERR_ARGUMENT, "is for 18 states");
    basis.T.nrow = STATES;
    basis.W.ncol = 3;
    assert_fails(ritz_reduce_states(&f->chain, &none, &basis, &model),
                 RITZ_ERR_ARGUMENT, "do not fit");
}

static void no_allocation_failure_leaks(void **state)
{
    states_fixture *f = *state;
    const ritz_damping none = {0};

    for (int t = 0; t < 3; t++) {
        ritz_request request = states_asking(f, 5, t > 0, RITZ_GRAMIAN_OUTPUTS);
        const ritz_method *method = t < 2 ? &ritz_method_lanczos_one_sided
                                          : &ritz_method_lanczos_two_sided;
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_state_space) model = {0};

        assert_survives_every_allocation(method->make(&request, &basis));
        assert_survives_every_allocation(
            ritz_reduce_states(&f->chain, &none, &basis, &model));
    }
}

#define TEST(name)                                                             \
    cmocka_unit_test_setup_teardown(name, states_set_up, states_tear_down)

static const struct CMUnitTest tests[] = {
    TEST(rigid_modes_stand_apart),
    TEST(breakdown_stops_with_the_vectors_there_are),
    TEST(unequal_numbers_of_inputs_and_outputs_are_joined),
    TEST(a_shift_bounds_what_is_not_stable),
    TEST(what_cannot_be_done_is_refused),
    TEST(bases_of_the_wrong_kind_are_refused),
    TEST(no_allocation_failure_leaks),
};

TEST_MODULE(lanczos_limits, tests, NULL, NULL)
