/*
 * Models in a frame whose rate changes: a point mass in a plane, whose motion
 * in the frame at rest is known in closed form; a constant rate, which is one
 * linear model; order, energy, and continuation.
 */
#include "testing.h"

#include "base/tolerances.h"

#include <ritz/simulate.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/*
 * A unit mass at (1, 0) from the axis that moves by x and y in the plane: v_1 =
 * e_x, v_2 = e_y, so that G = 2 [0 -1; 1 0], S = -I, centrifugal (1, 0) and
 * euler (0, -1). KG is that of a string of length 1, W^2 y^2 / 2.
 */
typedef struct point {
    double K[4], M[4], D[4], G[4], S[4], KG[4], load[4];
    ritz_dense dense[3];
    ritz_io io;
    ritz_second_order model;
    ritz_spin_terms terms; /* borrowed */
} point;

static void point_free(point *p)
{
    ritz_io_free(&p->io);
}

static ritz_status point_new(double stiffness, double damping, point *p)
{
    static const char *const outputs[] = {"x", "y", "ax", "ay"};
    const point filled = {
        .K = {stiffness, 0, 0, stiffness},
        .M = {1, 0, 0, 1},
        .D = {damping, 0, 0, damping},
        .G = {0, 2, -2, 0},
        .S = {-1, 0, 0, -1},
        .KG = {0, 0, 0, 1},
        .load = {1, 0, 0, -1},
    };

    *p = filled;
    RITZ_CHECK(ritz_io_new(2, 1, 4, &p->io));
    snprintf(p->io.input[0], sizeof p->io.input[0], "push");
    for (int k = 0; k < 4; k++)
        snprintf(p->io.output[k], sizeof p->io.output[k], "%s", outputs[k]);
    p->io.B.val[1] = 1.0;
    for (int64_t j = 0; j < 2; j++) {
        ritz_dense_col(&p->io.C, j)[j] = 1.0;
        ritz_dense_col(&p->io.Ca, j)[2 + j] = 1.0;
    }
    p->dense[0] = (ritz_dense){2, 2, p->K};
    p->dense[1] = (ritz_dense){2, 2, p->M};
    p->dense[2] = (ritz_dense){2, 2, p->D};
    p->model = (ritz_second_order){
        .K = &p->dense[0], .M = &p->dense[1], .D = &p->dense[2], .io = &p->io};
    p->terms = (ritz_spin_terms){.G = {2, 2, p->G},
                                 .S = {2, 2, p->S},
                                 .load = {2, 2, p->load},
                                 .inertia = 1.0};
    return RITZ_OK;
}

static ritz_model model_of(const point *p)
{
    return (ritz_model){.kind = RITZ_MODEL_DENSE, .dense = p->model};
}

static ritz_simulation_request asking(double seconds, double step)
{
    ritz_simulation_request request = RITZ_SIMULATION_NONE;

    request.integrator = &ritz_integrator_trapezoidal;
    request.seconds = seconds;
    request.step = step;
    return request;
}

static const double *last_of(const ritz_simulation *s)
{
    return s->y + (s->count - 1) * s->num_outputs;
}

/* A profile whose two corners are within a step. */
static double corner[] = {0.0, 0.7071, 1.4142}, rates[] = {0.0, 3.0, 1.0};
static const ritz_spin_rate profile = {RITZ_SPIN_PROFILE, 3, corner, rates};
static double ramp_time = 1.5, ramp_to = 4.0;
static const ritz_spin_rate ramp = {RITZ_SPIN_RAMP, 1, &ramp_time, &ramp_to};

/*
 * Without springs the mass stays where it is in the frame at rest, at (1, 0):
 * in the frame turned by the angle a it is at (cos a - 1, -sin a).
 */
static double error_of_free_mass(const ritz_spin_rate *rate, double step)
{
    RITZ_OWN(point) p = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    const ritz_simulation_request request = asking(2.0, step);
    const double a = ritz_spin_angle_at(rate, 2.0);
    const double v0[] = {0.0, -ritz_spin_rate_at(rate, 0.0)};
    ritz_simulation_request moving = request;

    moving.v0 = v0;
    assert_ok(point_new(0.0, 0.0, &p));
    assert_ok(ritz_simulate_spun(model_of(&p), &p.terms, rate, &moving, &s));
    return hypot(last_of(&s)[0] - (cos(a) - 1.0), last_of(&s)[1] + sin(a));
}

static void a_free_mass_stays_where_it_is_to_second_order(void **)
{
    const ritz_spin_rate *const courses[] = {&profile, &ramp};

    for (int c = 0; c < 2; c++) {
        double before = error_of_free_mass(courses[c], 0.02);

        for (int k = 1; k <= 4; k++) { /* corners move within a step: 3 to 5 */
            const double error =
                error_of_free_mass(courses[c], 0.02 / (1 << k));

            assert_true(before / error > 3.0 && before / error < 5.5);
            before = error;
        }
        assert_true(before < 5e-5);
    }
}

/* Largest balance of energies, the work of the drive of the spin included,
   relative to the largest energy. */
static double imbalance(double step)
{
    static const ritz_signal push = {
        .kind = RITZ_SIGNAL_SINE, .amplitude = 2.0, .hertz = {1.0}};
    RITZ_OWN(point) p = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    ritz_simulation_request request = asking(3.0, step);
    double most = 0.0, energy = 0.0;

    request.signal = &push;
    assert_ok(point_new(30.0, 0.4, &p));
    p.terms.KG = (ritz_dense){2, 2, p.KG};
    assert_ok(ritz_simulate_spun(model_of(&p), &p.terms, &ramp, &request, &s));
    for (int64_t k = 0; k < s.count; k++) {
        most = fmax(most, fabs(s.balance[k]));
        energy = fmax(energy, s.kinetic[k] + s.potential[k]);
    }
    return most / energy;
}

static void energy_balances_with_the_work_of_the_spin(void **)
{
    double before = imbalance(0.02);

    for (int k = 1; k <= 4; k++) {
        const double now = imbalance(0.02 / (1 << k));

        assert_true(before / now > 3.5 && before / now < 4.5);
        before = now;
    }
    assert_true(before < 1e-4);
}

/*
 * At a constant rate the equations are those of a linear model with the input
 * "centrifugal", which ritz_simulate integrates by the trapezoidal rule. Both
 * agree to rounding, some eps for each of some hundred steps.
 */
static void a_constant_rate_is_one_linear_model(void **)
{
    static const ritz_signal load[] = {
        {0}, {.kind = RITZ_SIGNAL_STEP, .amplitude = 1.0}};
    double time = 0.0, W = 1.7;
    const ritz_spin_rate rate = {RITZ_SPIN_CONSTANT, 1, &time, &W};
    ritz_simulation_request request = asking(2.0, 0.02);
    RITZ_OWN(point) p = {0};
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_simulation) spun = {0}, linear = {0};

    assert_ok(point_new(30.0, 0.4, &p));
    p.terms.KG = (ritz_dense){2, 2, p.KG};
    assert_ok(
        ritz_simulate_spun(model_of(&p), &p.terms, &rate, &request, &spun));
    assert_ok(ritz_io_new(2, 2, 4, &io));
    ritz_dense_put(&p.io.B, 0, 0, &io.B);
    io.B.val[2] = W * W;
    ritz_dense_put(&p.io.C, 0, 0, &io.C);
    ritz_dense_put(&p.io.Ca, 0, 0, &io.Ca);
    for (int k = 0; k < 4; k++) {
        p.K[k] += W * W * (p.S[k] + p.KG[k]);
        p.D[k] += W * p.G[k];
    }
    p.model.io = &io;
    request.signal = load;
    assert_ok(ritz_simulate(model_of(&p), &request, &linear));
    for (int64_t k = 0; k < spun.count * 4; k++)
        assert_near(spun.y[k], linear.y[k], 1e-12);
}

static void diagnostics_hold_rate_and_angle(void **)
{
    RITZ_OWN(point) p = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    const ritz_simulation_request request = asking(2.0, 0.1);

    assert_ok(point_new(30.0, 0.0, &p));
    assert_ok(ritz_simulate_spun(model_of(&p), &p.terms, &ramp, &request, &s));
    assert_int_equal(s.num_diagnostics, 5);
    assert_string_equal(s.diagnostic[0], "rate");
    assert_string_equal(s.diagnostic[4], "stiffening");
    assert_near(s.diagnosis[(s.count - 1) * 5], 4.0, 1e-15);
    assert_near(s.diagnosis[(s.count - 1) * 5 + 2], 3.0 + 2.0, 1e-14);
    assert_true(s.diagnosis[(s.count - 1) * 5 + 3] > 8.0); /* J W^2 / 2 */
}

static bool count_down(void *context)
{
    int *left = context;

    return (*left)-- == 0;
}

static void a_run_continues_bit_for_bit(void **)
{
    RITZ_OWN(point) p = {0};
    RITZ_OWN(ritz_simulation) whole = {0}, part = {0}, rest = {0};
    ritz_simulation_request request = asking(2.0, 0.01);
    int left = 77;

    assert_ok(point_new(30.0, 0.4, &p));
    assert_ok(
        ritz_simulate_spun(model_of(&p), &p.terms, &ramp, &request, &whole));
    request.stop = count_down;
    request.context = &left;
    assert_ok(
        ritz_simulate_spun(model_of(&p), &p.terms, &ramp, &request, &part));
    assert_int_equal(part.count, 78);
    request.stop = NULL;
    request.from = &part;
    assert_ok(
        ritz_simulate_spun(model_of(&p), &p.terms, &ramp, &request, &rest));
    assert_memory_equal(whole.y, rest.y,
                        (size_t)(whole.count * 4) * sizeof(double));
    assert_memory_equal(whole.balance, rest.balance,
                        (size_t)whole.count * sizeof(double));
    assert_memory_equal(whole.diagnosis, rest.diagnosis,
                        (size_t)(whole.count * 5) * sizeof(double));
}

static void requests_that_a_spin_cannot_take_are_refused(void **)
{
    RITZ_OWN(point) p = {0};
    ritz_simulation s = {0};
    ritz_simulation_request request = asking(2.0, 0.01);
    const ritz_spin_terms none = {0};

    assert_ok(point_new(30.0, 0.4, &p));
    assert_fails(ritz_simulate_spun(model_of(&p), &none, &ramp, &request, &s),
                 RITZ_ERR_ARGUMENT,
                 "the spin is of another model: its order is 0");
    request.integrator = &ritz_integrator_modal;
    assert_fails(
        ritz_simulate_spun(model_of(&p), &p.terms, &ramp, &request, &s),
        RITZ_ERR_ARGUMENT, "integrated by trapezoidal alone, not by modal");
}

static ritz_status run_point(void *of)
{
    point *p = of;
    const ritz_simulation_request request = asking(0.1, 0.02);
    RITZ_OWN(ritz_simulation) s = {0};

    return ritz_simulate_spun(model_of(p), &p->terms, &ramp, &request, &s);
}

static void every_allocation_may_fail(void **)
{
    RITZ_OWN(point) p = {0};

    assert_ok(point_new(30.0, 0.4, &p));
    assert_survives_every_allocation(run_point(&p));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_free_mass_stays_where_it_is_to_second_order),
    cmocka_unit_test(energy_balances_with_the_work_of_the_spin),
    cmocka_unit_test(a_constant_rate_is_one_linear_model),
    cmocka_unit_test(diagnostics_hold_rate_and_angle),
    cmocka_unit_test(a_run_continues_bit_for_bit),
    cmocka_unit_test(requests_that_a_spin_cannot_take_are_refused),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(simulate_spin, tests, NULL, NULL)
