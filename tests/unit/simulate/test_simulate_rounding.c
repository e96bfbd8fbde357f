/*
 * Two oscillators without a connection, in axes turned by one radian: what
 * drives the one shows by the other as rounding alone. The step is that which
 * the first asks for.
 */
#include "testing.h"

#include "masses.h"
#include "motions.h"
#include "spaces.h"

#include <ritz/simulate.h>

static const double turned = 1.0; /* radians */

/* Both masses 1, stiffnesses 400 and 900 in axes turned: full 2 x 2. */
static void turn(double weak, double size, motions *m)
{
    const double one[] = {1.0, 1.0};
    const int64_t both[] = {0, 1};
    const double c = cos(turned), s = sin(turned);
    const double K[] = {
        400.0 * c * c + 900.0 * s * s, (400.0 - 900.0) * c * s + weak,
        (400.0 - 900.0) * c * s + weak, 400.0 * s * s + 900.0 * c * c};

    assert_ok(motions_row(2, one, one, NULL, m));
    ritz_io_free(&m->component.io);
    assert_ok(masses_io(&m->component, 1, both, 2, both));
    assert_int_equal(m->component.K.colptr[2], 4);
    memcpy(m->component.K.val, K, sizeof K);
    memcpy(m->K.val, K, sizeof K);
    m->component.io.B.val[0] = c;
    m->component.io.B.val[1] = s;
    ritz_dense_col(&m->component.io.C, 0)[0] = c;
    ritz_dense_col(&m->component.io.C, 1)[0] = s;
    ritz_dense_col(&m->component.io.C, 0)[1] = -s * size;
    ritz_dense_col(&m->component.io.C, 1)[1] = c * size;
}

static ritz_simulation_request asking(const ritz_integrator *integrator)
{
    ritz_simulation_request request = RITZ_SIMULATION_NONE;

    request.integrator = integrator;
    request.seconds = 1.0;
    request.signal = &motions_step;
    return request;
}

/*
 * (1 - cos(20 t)) / 400 errs by (w h)^2 / 12 of a phase of w T = 20 at the
 * most, half of it of its largest, 1/200: within 1e-3 for h < 1.2e-3 by
 * trapezoidal, generalised-alpha's two to three times that. 50 steps halved
 * six times are 3200.
 */
enum { ENOUGH = 3200 };

static void check(ritz_model subject, const ritz_integrator *integrator,
                  double size)
{
    ritz_simulation_request request = asking(integrator);
    RITZ_OWN(ritz_simulation) r = {0};
    ritz_accuracy reached = {0};

    assert_ok(ritz_simulate_accurate(subject, &request, 1e-3, &reached, &r));
    assert_true(reached.error <= 1e-3);
    assert_true(r.count <= ENOUGH + 1);
    if (reached.num_left > 0) {
        assert_int_equal(reached.left, 1);
        assert_true(reached.rounding < 1e-12);
    }
    for (int64_t k = 0; k < r.count; k++) {
        assert_near(r.y[2 * k], (1.0 - cos(20.0 * r.seconds[k])) / 400.0,
                    1e-3 / 200.0 * 1.4); /* a third more beyond half a step */
        assert_near(r.y[2 * k + 1], 0.0, 1e-14 * size);
    }
}

static void an_output_that_is_rounding_does_not_drive_the_step(void **state)
{
    static const double sizes[] = {1.0, 1e12, 1e-12};

    (void)state;
    for (size_t s = 0; s < 3; s++) {
        RITZ_OWN(motions) m = {0};

        turn(0.0, sizes[s], &m);
        for (int k = 0; ritz_integrators[k]; k++) {
            check(m.dense, ritz_integrators[k], sizes[s]);
            if (ritz_integrators[k]->takes_sparse)
                check(m.sparse, ritz_integrators[k], sizes[s]);
        }
    }
}

/* The same as x' = A x + B u, x = (u, u'). */
static void nor_does_one_of_a_state_space(void **state)
{
    const double c = cos(turned), s = sin(turned);
    const double a = -(400.0 * c * c + 900.0 * s * s),
                 b = -(400.0 - 900.0) * c * s,
                 d = -(400.0 * s * s + 900.0 * c * c);
    const double A[] = {0, 0, 1, 0, 0, 0, 0, 1, a, b, 0, 0, b, d, 0, 0};
    const double B[] = {0, 0, c, s};
    const double C[] = {c, s, 0, 0, -s, c, 0, 0};
    const spaces_rows rows = {4, 1, 2, A, B, C, NULL, NULL};
    RITZ_OWN(ritz_state_space) space = {0};
    const ritz_model subject = ritz_model_of_states(&space);

    (void)state;
    assert_ok(spaces_make(&rows, &space));
    check(subject, &ritz_integrator_modal, 1.0);
    check(subject, &ritz_integrator_trapezoidal, 1.0);
}

/* A coupling of 1e-8 of the stiffness is no rounding: both are held to it. */
static void an_output_that_responds_weakly_is_held(void **state)
{
    RITZ_OWN(motions) m = {0};

    (void)state;
    turn(1e-5, 1.0, &m);
    for (int k = 0; ritz_integrators[k]; k++) {
        ritz_simulation_request request = asking(ritz_integrators[k]);
        RITZ_OWN(ritz_simulation) r = {0};
        ritz_accuracy reached = {0};

        assert_ok(
            ritz_simulate_accurate(m.dense, &request, 1e-3, &reached, &r));
        assert_int_equal(reached.num_left, 0);
        assert_int_equal(reached.left, -1);
    }
}

/*
 * x'' + 500^2 x = 0 from 1 and steps of w h = 10, 5 and 2.5: errors near 2 that
 * do not fall are none of rounding. Half of it takes (w h)^2 / 12 * 500 < 1/2.
 */
static void what_a_step_does_not_resolve_is_no_rounding(void **state)
{
    const double mass = 1.0, k = 500.0 * 500.0, x0 = 1.0;
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_row(1, &mass, &k, NULL, &m));
    for (int i = 1; i < 3; i++) {
        ritz_simulation_request request = asking(ritz_integrators[i]);
        RITZ_OWN(ritz_simulation) r = {0};
        ritz_accuracy reached = {0};

        request.signal = NULL;
        request.x0 = &x0;
        assert_ok(ritz_simulate_accurate(m.dense, &request, 0.5, &reached, &r));
        assert_int_equal(reached.num_left, 0);
        assert_true(r.step * 500.0 < 0.15);
    }
}

/* A sine of 100 Hz is 0 at each fiftieth of a second. */
static void a_sine_is_seen_by_the_first_step(void **state)
{
    static const ritz_signal sine = {
        .kind = RITZ_SIGNAL_SINE, .amplitude = 1.0, .hertz = {100.0, 0.0}};
    RITZ_OWN(motions) m = {0};
    ritz_simulation_request request = asking(&ritz_integrator_modal);
    RITZ_OWN(ritz_simulation) r = {0};

    (void)state;
    turn(0.0, 1.0, &m);
    request.signal = &sine;
    assert_ok(ritz_simulate_accurate(m.dense, &request, 1e-2, NULL, &r));
    /* (p sin(20 t) / 20 - sin(p t)) / (p^2 - 400), p = 200 pi */
    for (int64_t k = 0; k < r.count; k++) {
        const double p = 200.0 * 3.14159265358979323846;

        assert_near(
            r.y[2 * k],
            (p * sin(20.0 * r.seconds[k]) / 20.0 - sin(p * r.seconds[k])) /
                (p * p - 400.0),
            2e-2 * p / 20.0 / (p * p - 400.0));
    }
}

/* Steps are counted before they are taken: 100 us of 1e6 s, none of it. */
static void more_steps_than_are_tried_are_refused(void **state)
{
    static const ritz_signal sine = {
        .kind = RITZ_SIGNAL_SINE, .amplitude = 1.0, .hertz = {1e3, 0.0}};
    RITZ_OWN(motions) m = {0};
    ritz_simulation_request request = asking(&ritz_integrator_modal);
    ritz_simulation r = {0};

    (void)state;
    turn(0.0, 1.0, &m);
    request.signal = &sine;
    request.seconds = 1e6;
    assert_fails(ritz_simulate_accurate(m.dense, &request, 1e-3, NULL, &r),
                 RITZ_ERR_CONVERGENCE,
                 "more than 8388608 steps are not tried, and inputs need "
                 "1e+10");
    request.integrator = &ritz_integrator_central_difference;
    request.signal = &motions_step;
    request.seconds = 1e9;
    assert_fails(ritz_simulate_accurate(m.dense, &request, 1e-3, NULL, &r),
                 RITZ_ERR_ARGUMENT, "more than 8388608 steps are not tried: ");
}

static ritz_status ask(ritz_model subject)
{
    ritz_status status = RITZ_OK;
    ritz_simulation_request request = asking(&ritz_integrator_trapezoidal);
    RITZ_OWN(ritz_simulation) r = {0};

    request.seconds = 0.05;
    status = ritz_simulate_accurate(subject, &request, 0.5, NULL, &r);
    return status;
}

static void a_search_survives_every_allocation(void **state)
{
    RITZ_OWN(motions) m = {0};

    (void)state;
    turn(0.0, 1.0, &m);
    assert_survives_every_allocation(ask(m.dense));
    assert_survives_every_allocation(ask(m.sparse));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(an_output_that_is_rounding_does_not_drive_the_step),
    cmocka_unit_test(nor_does_one_of_a_state_space),
    cmocka_unit_test(an_output_that_responds_weakly_is_held),
    cmocka_unit_test(what_a_step_does_not_resolve_is_no_rounding),
    cmocka_unit_test(a_sine_is_seen_by_the_first_step),
    cmocka_unit_test(more_steps_than_are_tried_are_refused),
    cmocka_unit_test(a_search_survives_every_allocation),
};

TEST_MODULE(simulate_rounding, tests, NULL, NULL)
