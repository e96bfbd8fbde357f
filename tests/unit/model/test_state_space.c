#include "responses.h"
#include "testing.h"

#include "masses.h"

#include <ritz/basis.h>
#include <ritz/model.h>
#include <ritz/response.h>

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdio.h>

enum { POINTS = 4 };

static const double hertz[POINTS] = {0.05, 0.3, 0.7, 2.0};
static const ritz_grid grid = {.count = POINTS, .hertz = hertz};
static const ritz_damping undamped = {0};

/* Five masses with D of its own, not symmetric, a damper, and outputs of every
   kind. */
static void set_chain(ritz_component *out)
{
    static const double m[] = {1, 2, 1, 3, 1};
    static const double k[] = {9, 7, 8, 6, 5};
    static const double c[] = {0.1, 0, 0.3, 0, 0.2};
    static const int64_t in[] = {4, 1}, seen[] = {0, 2, 4};

    assert_ok(masses_component(5, m, k, c, out));
    assert_ok(masses_io(out, 2, in, 3, seen));
    assert_int_equal(out->D.rowind[1], 1); /* D(1, 0), and D(0, 1) */
    assert_int_equal(out->D.rowind[out->D.colptr[1]], 0);
    out->D.val[1] += 0.3;
    out->D.val[out->D.colptr[1]] -= 0.3;
    ritz_dense_col(&out->io.C, 2)[1] = 0.0;
    ritz_dense_col(&out->io.Cv, 2)[1] = 1.0; /* velocity of mass 3 */
    ritz_dense_col(&out->io.C, 4)[2] = 0.0;
    ritz_dense_col(&out->io.Ca, 4)[2] = 2.0; /* acceleration of mass 5 */
    assert_ok(ritz_dampers_new(5, 1, &out->dampers));
    snprintf(out->dampers.name[0], RITZ_NAME_SIZE, "strut");
    out->dampers.c[0] = 0.4;
    out->dampers.k[0] = 1.5;
    ritz_dense_col(&out->dampers.B, 0)[1] = 1.0;
    ritz_dense_col(&out->dampers.B, 0)[3] = -1.0;
}

/* Largest |difference| over the largest |value| of that output and input. */
static double difference(const ritz_response *a, const ritz_response *b)
{
    int64_t block = a->num_inputs * a->num_outputs;
    double worst = 0.0;

    assert_int_equal(a->count, b->count);
    for (int64_t i = 0; i < block; i++) {
        double size = 0.0, off = 0.0;

        for (int64_t k = 0; k < a->count; k++) {
            size = fmax(size, cabs(b->H[k * block + i]));
            off = fmax(off, cabs(a->H[k * block + i] - b->H[k * block + i]));
        }
        worst = fmax(worst, size > 0.0 ? off / size : off);
    }
    return worst;
}

/* The same of two models, as they respond on the grid. */
static double apart(const ritz_state_space *a, const ritz_state_space *b)
{
    ritz_response of_a = {0}, of_b = {0};
    double worst = 0.0;

    assert_ok(states_response(a, &grid, &of_a));
    assert_ok(states_response(b, &grid, &of_b));
    worst = difference(&of_a, &of_b);
    ritz_response_free(&of_a);
    ritz_response_free(&of_b);
    return worst;
}

/* The last mass of five is nothing: force on it, it and the first are seen. */
static void set_massless(ritz_component *out)
{
    static const double m[] = {1, 2, 1, 3, 0};
    static const double k[] = {9, 7, 8, 6, 5};
    static const int64_t in[] = {4}, seen[] = {4, 0};

    assert_ok(masses_component(5, m, k, NULL, out));
    assert_ok(masses_io(out, 1, in, 2, seen));
}

/* A basis of all states, damped as `words` say, responds as its component. */
static void assert_states_serve(const ritz_request *request, const char *words,
                                int64_t states, double bound)
{
    ritz_damping damping = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_state_space) full = {0}, small = {0};

    assert_ok(ritz_basis_make(&ritz_method_lanczos_one_sided, request, &basis));
    assert_string_equal(basis.damping, words);
    assert_ok(ritz_damping_parse(basis.damping, &damping));
    assert_ok(ritz_reduce_states(request->component, &damping, &basis, &small));
    assert_ok(
        ritz_state_space_of_component(request->component, &damping, &full));
    assert_int_equal(small.A.nrow, states);
    assert_true(apart(&small, &full) < bound);
}

/* Condition numbers here are below 1e3; the direct response nudges by 1e-9. */
static void responses_agree_with_second_order_ones(void **state)
{
    static const ritz_damping cases[] = {
        {.kind = RITZ_DAMPING_NONE},
        {.kind = RITZ_DAMPING_MODAL, .zeta = 0.03},
        {.kind = RITZ_DAMPING_RAYLEIGH, .a = 0.05, .b = 0.01},
    };

    (void)state;
    for (size_t t = 0; t < sizeof cases / sizeof *cases; t++) {
        RITZ_OWN(ritz_component) chain = {0};
        RITZ_OWN(ritz_state_space) model = {0};
        RITZ_OWN(ritz_response) due = {0}, got = {0};

        set_chain(&chain);
        assert_ok(ritz_state_space_of_component(&chain, &cases[t], &model));
        assert_int_equal(model.A.nrow, 10);
        assert_ok(states_response(&model, &grid, &got));
        assert_ok(
            ritz_dampers_install_sparse(&chain.dampers, &chain.K, &chain.D));
        assert_ok(direct_response(&chain, &cases[t], 9.0, &grid, &due));
        assert_true(difference(&got, &due) < 1e-9);
    }
}

/* All modes kept: the reduced component is the component. */
static void reduced_components_respond_as_components(void **state)
{
    static const ritz_damping damping = {.kind = RITZ_DAMPING_MODAL,
                                         .zeta = 0.03};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_state_space) full = {0}, small = {0};
    const ritz_state_space *states = NULL;

    (void)state;
    set_chain(&chain);
    request.component = &chain;
    assert_ok(ritz_basis_make(&ritz_method_full, &request, &basis));
    assert_ok(ritz_reduce(&chain, &basis, &reduced));
    assert_ok(ritz_state_space_of_component(&chain, &damping, &full));
    assert_ok(ritz_reduced_install(&reduced));
    assert_ok(ritz_model_states(ritz_model_of_reduced(&reduced, &damping),
                                &small, &states));
    assert_string_equal(small.damping, "modal 0.03");
    assert_true(apart(&small, &full) < 1e-12);
}

/* E x' = A x with any E that is not singular is the same model. */
static void a_descriptor_responds_as_its_states(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_response) due = {0}, got = {0};
    ritz_dense A = {0}, B = {0};

    (void)state;
    set_chain(&chain);
    assert_ok(ritz_state_space_of_component(&chain, &undamped, &model));
    assert_ok(states_response(&model, &grid, &due));
    assert_ok(ritz_dense_new(10, 10, &model.E));
    for (int64_t j = 0; j < 10; j++)
        for (int64_t i = j; i < 10; i++)
            ritz_dense_col(&model.E, j)[i] = i == j ? 2.0 : 0.1;
    assert_ok(ritz_dense_mul(&model.E, &model.A, &A));
    assert_ok(ritz_dense_mul(&model.E, &model.B, &B));
    ritz_dense_free(&model.A);
    ritz_dense_free(&model.B);
    model.A = A;
    model.B = B;
    assert_ok(ritz_state_space_check(&model));
    assert_ok(states_response(&model, &grid, &got));
    assert_true(difference(&got, &due) < 1e-12);
    ritz_dense_col(&model.E, 3)[3] = 0.0;
    assert_fails(ritz_state_space_check(&model), RITZ_ERR_FORMAT,
                 "'E' is singular");
}

/* The last mass is nothing: its spring answers at once, 1 / 5, through D. */
static void massless_dofs_feed_through(void **state)
{
    static const ritz_damping damping = {.kind = RITZ_DAMPING_MODAL,
                                         .zeta = 0.03};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_state_space model = {0};
    ritz_response due = {0}, got = {0};

    (void)state;
    set_massless(&chain);
    assert_ok(ritz_state_space_of_component(&chain, &damping, &model));
    assert_int_equal(model.A.nrow, 8);
    assert_near(model.D.val[0], 1.0 / 5.0, 64 * DBL_EPSILON);
    assert_near(model.D.val[1], 0.0, 64 * DBL_EPSILON);
    assert_ok(states_response(&model, &grid, &got));
    assert_ok(direct_response(&chain, &damping, 9.0, &grid, &due));
    assert_true(difference(&got, &due) < 1e-9);
    ritz_response_free(&due);
    ritz_response_free(&got);
    ritz_state_space_free(&model);

    ritz_dense_col(&chain.io.Cv, 4)[0] = 1.0;
    assert_fails(ritz_state_space_of_component(&chain, &damping, &model),
                 RITZ_ERR_ARGUMENT,
                 "an output is the velocity of a dof without mass");
    ritz_dense_col(&chain.io.Cv, 4)[0] = 0.0;
    ritz_dense_col(&chain.io.Ca, 4)[1] = 1.0;
    assert_fails(ritz_state_space_of_component(&chain, &damping, &model),
                 RITZ_ERR_ARGUMENT, "is the acceleration of a dof");
    ritz_dense_col(&chain.io.Ca, 4)[1] = 0.0;
    assert_ok(ritz_sparse_copy(&chain.K, &chain.D));
    assert_fails(ritz_state_space_of_component(&chain, &damping, &model),
                 RITZ_ERR_ARGUMENT, "dofs without mass are damped");
}

/* A basis of states that holds all of them keeps what feeds through. */
static void reduction_to_states_keeps_what_feeds_through(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = RITZ_REQUEST_NONE;

    (void)state;
    set_massless(&chain);
    snprintf(chain.damping, sizeof chain.damping, "modal 0.03");
    request.component = &chain;
    request.modes = 8;
    assert_states_serve(&request, "modal 0.03", 8, 1e-9); /* measured: 5e-13 */
}

/* The same of a M + b K, with a damper and outputs of every kind. */
static void reduction_to_states_keeps_rayleigh_damping(void **state)
{
    static const char words[] = "rayleigh 0.05 0.01";
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = RITZ_REQUEST_NONE;

    (void)state;
    set_chain(&chain);
    request.component = &chain;
    request.modes = 10;
    request.choice.given = RITZ_USES_DAMPING;
    assert_ok(ritz_damping_parse(words, &request.choice.damping));
    assert_states_serve(&request, words, 10, 1e-9); /* measured: 3e-13 */
}

/* Without W it is T that stands on the left: T all states, turned. */
static void without_left_vectors_the_right_ones_serve(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_state_space full = {0}, turned = {0};

    (void)state;
    set_chain(&chain);
    assert_ok(ritz_basis_new(10, 10, &basis));
    basis.states = true;
    for (int64_t j = 0; j < 10; j++) {
        ritz_dense_col(&basis.T, j)[j] = 1.0;
        ritz_dense_col(&basis.T, j)[(j + 3) % 10] = 0.5;
    }
    assert_ok(ritz_state_space_of_component(&chain, &undamped, &full));
    assert_ok(ritz_reduce_states(&chain, &undamped, &basis, &turned));
    assert_true(apart(&turned, &full) < 1e-12);
    memset(basis.T.val, 0, 10 * sizeof *basis.T.val); /* a column of nothing */
    ritz_state_space_free(&turned);
    assert_fails(ritz_reduce_states(&chain, &undamped, &basis, &turned),
                 RITZ_ERR_SINGULAR, "left against right vectors");
    ritz_state_space_free(&full);
}

/* A grid that is refined has a point at the peak of each pole it spans. */
static void refined_grids_meet_the_poles(void **state)
{
    static const double one[] = {1}, k[] = {9}, c[] = {0.06};
    static const int64_t at[] = {0};
    const ritz_grid coarse = {
        .from_hz = 0.1, .to_hz = 1.0, .count = 4, .refine = true};
    RITZ_OWN(ritz_component) mass = {0};
    RITZ_OWN(ritz_state_space) model = {0};
    ritz_response r = {0};
    double peak = 0.0;

    (void)state;
    assert_ok(masses_component(1, one, k, c, &mass));
    assert_ok(masses_io(&mass, 1, at, 1, at));
    assert_ok(ritz_state_space_of_component(&mass, &undamped, &model));
    assert_ok(states_response(&model, &coarse, &r));
    for (int64_t i = 0; i < r.count; i++)
        peak = fmax(peak, cabs(r.H[i]));
    /* 1 / (2 zeta sqrt(1 - zeta^2) k), zeta = 0.01 */
    assert_near(peak, 1.0 / (0.02 * sqrt(1.0 - 1e-4) * 9.0), 1e-12);
    ritz_response_free(&r);
    model.A.val[3] = 0.0; /* no damping */
    assert_fails(
        states_response(
            &model,
            &(ritz_grid){
                .count = 1,
                .hertz =
                    (const double[]){3.0 / (2.0 * 3.14159265358979323846)}},
            &r),
        RITZ_ERR_SINGULAR, "is the frequency of a pole");
}

static void structural_damping_and_great_size_are_refused(void **state)
{
    ritz_component chain = {0}, large = {.num_dofs = RITZ_STATE_DOFS + 1};
    ritz_state_space none = {0};

    (void)state;
    set_chain(&chain);
    assert_ok(ritz_sparse_copy(&chain.K, &chain.K4));
    assert_fails(ritz_state_space_of_component(&chain, &undamped, &none),
                 RITZ_ERR_ARGUMENT, "structural damping is of harmonic motion");
    assert_fails(ritz_state_space_of_component(&large, &undamped, &none),
                 RITZ_ERR_ARGUMENT, "1501 dofs are too many");
    ritz_component_free(&chain);
}

static void what_does_not_fit_is_no_model(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_state_space) model = {0};

    (void)state;
    set_chain(&chain);
    assert_ok(ritz_state_space_of_component(&chain, &undamped, &model));
    model.num_inputs = 3;
    assert_fails(ritz_state_space_check(&model), RITZ_ERR_FORMAT,
                 "'B' is 10 x 2 where 10 x 3 is due");
    model.num_inputs = 2;
    model.columns.count = 9;
    assert_fails(ritz_state_space_check(&model), RITZ_ERR_FORMAT,
                 "9 states are described of 10");
    model.columns.count = 10;
    model.D.val[0] = nan("");
    assert_fails(ritz_state_space_check(&model), RITZ_ERR_FORMAT,
                 "'D' is not finite");
}

static void no_allocation_failure_leaks(void **state)
{
    static const ritz_damping damping = {.kind = RITZ_DAMPING_MODAL,
                                         .zeta = 0.03};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_response) r = {0};

    (void)state;
    set_chain(&chain);
    assert_survives_every_allocation(
        ritz_state_space_of_component(&chain, &damping, &model));
    assert_ok(ritz_dense_copy(&model.A, &model.E));
    assert_survives_every_allocation(states_response(&model, &grid, &r));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(responses_agree_with_second_order_ones),
    cmocka_unit_test(reduced_components_respond_as_components),
    cmocka_unit_test(a_descriptor_responds_as_its_states),
    cmocka_unit_test(massless_dofs_feed_through),
    cmocka_unit_test(reduction_to_states_keeps_what_feeds_through),
    cmocka_unit_test(reduction_to_states_keeps_rayleigh_damping),
    cmocka_unit_test(without_left_vectors_the_right_ones_serve),
    cmocka_unit_test(refined_grids_meet_the_poles),
    cmocka_unit_test(structural_damping_and_great_size_are_refused),
    cmocka_unit_test(what_does_not_fit_is_no_model),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(state_space, tests, NULL, NULL)
