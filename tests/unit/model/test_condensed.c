/*
 * A configuration is converted to a reduced component, and this one to a
 * component and to a state space: all have the same matrices and response;
 * what is left out; refusals.
 */
#include "testing.h"

#include "masses.h"
#include "responses.h"
#include "samples.h"

#include <ritz/matrix.h>
#include <ritz/model.h>
#include <ritz/response.h>

#include <complex.h>
#include <float.h>
#include <stdio.h>

enum { POINTS = 3, ORDER = 4, RIGID = 1 };

static const double hertz[POINTS] = {0.05, 0.3, 2.0};

/* A free chain of masses 1, 2, 1, 3 in modal coordinates, damped by D = 0.01 K
   and by a damper that is installed. */
static ritz_status make_system(ritz_system *out)
{
    static const double m[] = {1, 2, 1, 3}, k[] = {0, 9, 7, 8};
    static const double none[ORDER] = {0.0};
    static const int64_t in[] = {3}, seen[] = {0, 2};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    ritz_configuration *c = NULL;

    RITZ_CHECK(masses_component(ORDER, m, k, none, &chain));
    RITZ_CHECK(masses_io(&chain, 1, in, 2, seen));
    RITZ_CHECK(ritz_sparse_dense(&chain.K, &K));
    RITZ_CHECK(ritz_sparse_dense(&chain.M, &M));
    RITZ_CHECK(ritz_eigen_dense(&K, &M, &pairs));
    snprintf(out->damping, sizeof out->damping, "modal 0.02");
    snprintf(out->units, sizeof out->units, "kg m s");
    RITZ_CHECK_NEW(out->component, 1);
    out->num_components = 1;
    out->component[0] = (ritz_block){.order = ORDER, .order_full = 77};
    RITZ_CHECK_NEW(out->configuration, 1);
    out->num_configurations = 1;
    c = out->configuration;
    snprintf(c->at, sizeof c->at, "clock=60");
    c->num_rigid = pairs.num_rigid;
    RITZ_MOVE(c->lambda, pairs.lambda);
    c->lambda[0] = -1e-15; /* a rigid one, with rounding */
    RITZ_CHECK(ritz_dense_identity(ORDER, &c->M));
    RITZ_CHECK(ritz_dense_new(ORDER, ORDER, &c->K));
    RITZ_CHECK(ritz_dense_new(ORDER, ORDER, &c->D));
    for (int64_t j = 0; j < ORDER; j++) {
        ritz_dense_col(&c->K, j)[j] = c->lambda[j];
        ritz_dense_col(&c->D, j)[j] = j < RIGID ? 0.0 : 0.01 * c->lambda[j];
    }
    RITZ_CHECK(ritz_io_project(&chain.io, &pairs.Phi, &c->io));
    RITZ_CHECK(ritz_dampers_new(ORDER, 1, &c->dampers));
    snprintf(c->dampers.name[0], RITZ_NAME_SIZE, "a/strut");
    c->dampers.c[0] = 0.3;
    ritz_dense_col(&c->dampers.B, 0)[2] = 1.0;
    RITZ_CHECK(ritz_configuration_install(c));
    return ritz_measures_add(&c->errors, "stage1-frequency-relative", 1e-12,
                             nan(""), "mode 2");
}

static const ritz_grid grid = {.count = POINTS, .hertz = hertz};

static void respond(ritz_model model, double _Complex H[2 * POINTS])
{
    const ritz_second_order *m = &model.dense;
    RITZ_OWN(ritz_response) response = {0};

    if (model.kind == RITZ_MODEL_STATES)
        assert_ok(states_response(model.states, &grid, &response));
    else if (model.kind == RITZ_MODEL_COMPONENT)
        assert_ok(direct_response(model.component, model.damping, 0.0, &grid,
                                  &response));
    else
        assert_ok(dense_response(m->K, m->M, m->D, m->io, model.damping, &grid,
                                 &response));
    memcpy(H, response.H, 2 * POINTS * sizeof *H);
}

/* Solves of order four with entries of order ten: 1e4 eps is ample. */
static void assert_same(const double _Complex *a, const double _Complex *b)
{
    for (int k = 0; k < 2 * POINTS; k++)
        assert_near(cabs(a[k] - b[k]), 0.0, 1e4 * DBL_EPSILON * cabs(b[k]));
}

static void a_configuration_responds_as_each_of_its_forms(void **state)
{
    RITZ_OWN(ritz_system) system = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_component) component = {0};
    RITZ_OWN(ritz_state_space) states = {0};
    ritz_damping damping = {0};
    double _Complex H[4][2 * POINTS];

    (void)state;
    assert_ok(make_system(&system));
    assert_ok(
        ritz_reduced_of_configuration(&system, system.configuration, &reduced));
    assert_ok(ritz_component_of_reduced(&reduced, &component));
    assert_ok(ritz_damping_parse(reduced.damping, &damping));
    assert_ok(ritz_states_of_reduced(&reduced, &damping, &states));
    respond(ritz_model_of_configuration(system.configuration, &damping), H[0]);
    respond(ritz_model_of_reduced(&reduced, &damping), H[1]);
    respond(ritz_model_of_component(&component, &damping), H[2]);
    respond(ritz_model_of_states(&states), H[3]);
    for (int k = 1; k < 4; k++)
        assert_same(H[k], H[0]);
    assert_string_equal(states.damping, "modal 0.02");
    assert_int_equal(states.errors.count, 1);
}

static void a_configuration_keeps_all_but_its_bodies(void **state)
{
    RITZ_OWN(ritz_system) system = {0};
    RITZ_OWN(ritz_reduced) r = {0};

    (void)state;
    assert_ok(make_system(&system));
    assert_ok(ritz_reduced_of_configuration(&system, system.configuration, &r));
    assert_string_equal(r.origin.method, "system");
    assert_string_equal(r.origin.options, "clock=60");
    assert_string_equal(r.damping, "modal 0.02");
    assert_string_equal(r.units, "kg m s");
    assert_int_equal(r.num_dofs, 77);
    assert_int_equal(r.num_ports, 0);
    assert_null(r.T.val);
    assert_int_equal(r.columns.kind[0], RITZ_COLUMN_RIGID);
    assert_int_equal(r.columns.kind[1], RITZ_COLUMN_NORMAL);
    assert_near(r.columns.hertz[1],
                ritz_eigen_hertz(system.configuration[0].lambda[1]), 0.0);
    /* the rounding, -1e-15, is dropped */
    assert_near(ritz_dense_col(&r.K, 0)[0], 0.0, 0.0);
    assert_int_equal(r.errors.count, 1);
    /* the damper is in D once */
    assert_ok(ritz_reduced_install(&r));
    assert_near(ritz_dense_col(&r.D, 2)[2],
                ritz_dense_col(&system.configuration[0].D, 2)[2], 0.0);
}

/* The stiffness of a spring on a rigid mode is not taken for rounding. */
static void springs_on_rigid_modes_stay(void **state)
{
    RITZ_OWN(ritz_system) system = {0};
    RITZ_OWN(ritz_reduced) r = {0};
    ritz_configuration *c = NULL;

    (void)state;
    assert_ok(make_system(&system));
    c = system.configuration;
    ritz_dense_col(&c->dampers.B, 0)[0] = 1.0;
    c->dampers.k[0] = 5.0;
    assert_ok(ritz_configuration_install(c));
    assert_ok(ritz_reduced_of_configuration(&system, c, &r));
    assert_near(ritz_dense_col(&r.K, 0)[0], 5.0, 1e-14);
}

static void force_columns_are_no_dofs(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_component) component = {0};

    (void)state;
    assert_ok(sample_reduced(true, &reduced));
    reduced.columns.kind[4] = RITZ_COLUMN_FORCE;
    assert_fails(ritz_component_of_reduced(&reduced, &component),
                 RITZ_ERR_ARGUMENT, "column 5 is a force at an interface");
    reduced.columns.kind[4] = RITZ_COLUMN_NORMAL;
    reduced.columns.hertz[4] = -201.6;
    assert_fails(ritz_component_of_reduced(&reduced, &component),
                 RITZ_ERR_ARGUMENT,
                 "column 5 is a mode of negative eigenvalue, -201.6 Hz");
}

static ritz_status convert_all(const ritz_system *system)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_component) component = {0};
    RITZ_OWN(ritz_state_space) states = {0};
    const ritz_damping none = {0};

    RITZ_CHECK(
        ritz_reduced_of_configuration(system, system->configuration, &reduced));
    RITZ_CHECK(ritz_component_of_reduced(&reduced, &component));
    return ritz_states_of_reduced(&reduced, &none, &states);
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_system) system = {0};

    (void)state;
    assert_ok(make_system(&system));
    assert_survives_every_allocation(convert_all(&system));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_configuration_responds_as_each_of_its_forms),
    cmocka_unit_test(a_configuration_keeps_all_but_its_bodies),
    cmocka_unit_test(springs_on_rigid_modes_stay),
    cmocka_unit_test(force_columns_are_no_dofs),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(condensed, tests, NULL, NULL)
