/* Costs: their steps are closed forms; times are only held to make sense. */
#include "growth.h"
#include "testing.h"

#include "motions.h"

#include <ritz/simulate.h>

static const double pi = 3.14159265358979323846;
static const ritz_damping none = {0};

static void steps_are_those_of_the_scheme(void **state)
{
    const double band[] = {0.0, 1.0};
    ritz_cost cost = {0};
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(false, &m));
    assert_ok(
        ritz_simulate_cost(ritz_model_of_dense(&m.model, &none), band, &cost));
    /* scipy.linalg.eigh */
    assert_near(cost.step_explicit, 0.1555256079217896, 1e-14);
    assert_near(cost.highest_hz, 2.04667187, 1e-8);
    /* (2 pi h)^2 / 12 = 1e-3 */
    assert_near(pow(2.0 * pi * cost.step_accurate, 2.0) / 12.0, 1e-3, 1e-17);
    assert_near(cost.step, cost.step_accurate, 0.0);
    assert_string_equal(cost.integrator, "trapezoidal");
    assert_int_equal(cost.order, 3);
    assert_true(cost.seconds_per_second > 0.0);
    assert_ok(
        ritz_simulate_cost(ritz_model_of_dense(&m.model, &none), NULL, &cost));
    assert_near(pow(2.0 * pi * cost.highest_hz * cost.step_accurate, 2.0) /
                    12.0,
                1e-3, 1e-15);
}

/* h = 2 (sqrt(1 + zeta^2) - zeta) / w of one dof; coupled, as numpy's
 * eigenvalues of [M^-1 D, M^-1 K; I, 0] have it. */
static void the_explicit_step_heeds_damping(void **state)
{
    const double mass = 1.0, k = 9.0, c = 2.0 * 0.3 * 3.0;
    ritz_cost cost = {0};
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_row(1, &mass, &k, &c, &m));
    assert_ok(
        ritz_simulate_cost(ritz_model_of_dense(&m.model, NULL), NULL, &cost));
    assert_near(cost.step_explicit, 2.0 * (sqrt(1.09) - 0.3) / 3.0, 1e-15);
    motions_free(&m);
    assert_ok(motions_new(true, &m));
    assert_ok(
        ritz_simulate_cost(ritz_model_of_dense(&m.model, &none), NULL, &cost));
    assert_near(cost.step_explicit, 1.4821065717397161e-01, 1e-14);
}

static void a_rigid_body_has_no_explicit_limit(void **state)
{
    const double mass = 2.0, k = 0.0;
    const double band[] = {0.0, 10.0};
    ritz_cost cost = {0};
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_row(1, &mass, &k, NULL, &m));
    assert_ok(
        ritz_simulate_cost(ritz_model_of_dense(&m.model, &none), band, &cost));
    assert_true(isinf(cost.step_explicit));
    assert_near(cost.highest_hz, 0.0, 0.0);
    assert_near(cost.step_accurate, sqrt(0.012) / (20.0 * pi), 1e-15);
    assert_ok(
        ritz_simulate_cost(ritz_model_of_dense(&m.model, &none), NULL, &cost));
    assert_near(cost.step_accurate, sqrt(0.012) / (2.0 * pi), 1e-15);
}

/* r^2 a step: of 64 masses more than of 3, by far. */
static void more_coordinates_cost_more(void **state)
{
    double mass[64], k[64];
    RITZ_OWN(motions) small = {0}, large = {0};
    double few = 0.0, many = 0.0;

    (void)state;
    for (int i = 0; i < 64; i++)
        mass[i] = k[i] = 1.0;
    assert_ok(motions_row(3, mass, k, NULL, &small));
    assert_ok(motions_row(64, mass, k, NULL, &large));
    for (int j = 0; ritz_integrators[j]; j++) {
        assert_ok(
            ritz_simulate_step_cost(ritz_model_of_dense(&small.model, &none),
                                    ritz_integrators[j], 0.1, &few));
        assert_ok(
            ritz_simulate_step_cost(ritz_model_of_dense(&large.model, &none),
                                    ritz_integrators[j], 0.1, &many));
        assert_true(few > 0.0 && many > few);
    }
    assert_ok(ritz_simulate_refactor_cost(3, &few));
    assert_ok(ritz_simulate_refactor_cost(200, &many));
    assert_true(few > 0.0 && many > few);
}

static void costs_without_sense_are_refused(void **state)
{
    const double band[] = {0.0, -1.0};
    ritz_cost cost = {0};
    RITZ_OWN(motions) m = {0};
    double time = 0.0;

    (void)state;
    assert_ok(motions_new(false, &m));
    assert_fails(
        ritz_simulate_cost(ritz_model_of_dense(&m.model, &none), band, &cost),
        RITZ_ERR_ARGUMENT, "makes no sense");
    assert_fails(ritz_simulate_step_cost(ritz_model_of_dense(&m.model, &none),
                                         &ritz_integrator_modal, 0.0, &time),
                 RITZ_ERR_ARGUMENT, "no step");
    assert_fails(ritz_simulate_refactor_cost(0, &time), RITZ_ERR_ARGUMENT,
                 "no order");
}

/* A negative dashpot: each way of integrating sees it grow. */
static void growth_tells_an_unstable_model(void **state)
{
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    for (int j = 0; ritz_integrators[j]; j++) {
        double stable = 0.0, unstable = 0.0;

        assert_ok(growth_of(ritz_model_of_dense(&m.model, &none),
                            ritz_integrators[j], 0.02, 2000, 3, &stable));
        /* generalised-alpha and explicit ones conserve an energy near E */
        assert_true(stable > 0.0 && stable < 1.05);
        for (int k = 0; k < 9; k++)
            m.D.val[k] = -m.D.val[k];
        assert_ok(growth_of(ritz_model_of_dense(&m.model, &none),
                            ritz_integrators[j], 0.02, 2000, 3, &unstable));
        assert_true(unstable > 100.0);
        for (int k = 0; k < 9; k++)
            m.D.val[k] = -m.D.val[k];
    }
}

/* D = [0 d; 0 0] takes from one and gives to the other. */
static void growth_tells_an_unsymmetric_damping(void **state)
{
    const double mass[] = {1.0, 1.0}, k[] = {1.0, 1.0};
    double d[4] = {0.0, 0.0, 1.5, 0.0};
    const ritz_dense D = {2, 2, d};
    double growth = 0.0;
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_row(2, mass, k, NULL, &m));
    m.model.D = &D;
    assert_ok(growth_of(ritz_model_of_dense(&m.model, &none),
                        &ritz_integrator_trapezoidal, 0.05, 4000, 2, &growth));
    assert_true(growth > 100.0);
}

static ritz_status measure(const motions *m, int which)
{
    ritz_cost cost = {0};
    double growth = 0.0;

    return which == 0
               ? ritz_simulate_cost(ritz_model_of_dense(&m->model, &none), NULL,
                                    &cost)
               : growth_of(ritz_model_of_dense(&m->model, &none),
                           &ritz_integrator_trapezoidal, 0.1, 2, 1, &growth);
}

static void costs_survive_every_allocation(void **state)
{
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    assert_survives_every_allocation(measure(&m, 0));
    assert_survives_every_allocation(measure(&m, 1));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(steps_are_those_of_the_scheme),
    cmocka_unit_test(the_explicit_step_heeds_damping),
    cmocka_unit_test(a_rigid_body_has_no_explicit_limit),
    cmocka_unit_test(more_coordinates_cost_more),
    cmocka_unit_test(costs_without_sense_are_refused),
    cmocka_unit_test(growth_tells_an_unstable_model),
    cmocka_unit_test(growth_tells_an_unsymmetric_damping),
    cmocka_unit_test(costs_survive_every_allocation),
};

TEST_MODULE(simulate_cost, tests, NULL, NULL)
