/* Exact propagation: closed forms, and values of SciPy and of 120 digits. */
#include "testing.h"

#include "motions.h"

#include "linear/general.h"
#include "simulate/motion.h"

#include <ritz/simulate.h>

#include <float.h>

static const double pi = 3.14159265358979323846;

static double larger(double a, double b)
{
    return a > b ? a : b;
}

/* By the series of exp in 120 digits. */
static const struct {
    double lambda, d, h, expected[5]; /* hold, S, rate, P, R */
} oscillators[] = {
    {0, 0, 0.7, {1, 0.7, 1, 0.245, 0.057166666666666664}},
    {0,
     3,
     2,
     {1, 0.33250708260777789, 0.0024787521766663585, 0.55583097246407409,
      0.48138967584530867}},
    {1e-8,
     1000,
     1,
     {0.99999999999000999, 0.00099999999999001994, -9.9999999999003006e-15,
      0.00099899999999501993, 0.00049900099999834334}},
    {1,
     2,
     5,
     {0.040427681994512805, 0.033689734995427337, -0.026951787996341868,
      0.95957231800548715, 3.0471656289935982}},
    {1,
     2.0000000001,
     5,
     {0.040427682008550195, 0.03368973500104229, -0.026951787996903363,
      0.95957231799144982, 3.047165628920101}},
    {1,
     1.9999999999,
     5,
     {0.040427681980475416, 0.033689734989812377, -0.026951787995780373,
      0.95957231801952458, 3.0471656290670959}},
    {39.5,
     0.1,
     10,
     {0.6065340113020693, 0.001465284073667022, 0.60638748289470257,
      0.0099611642708336886, 0.25310224302529744}},
    {1e6,
     20,
     0.05,
     {0.58327570559951869, -0.00016060916519828602, 0.58648788890348436,
      4.1672429440048131e-07, 5.0152274679310279e-08}},
    {4,
     50,
     3,
     {0.78758907501654674, 0.015777065323901437, -0.0012641911785250376,
      0.053102731245863316, 0.082271593095733217}},
    {1e-12,
     2,
     1e3,
     {0.99999999950024998, 0.49999999975025, -2.4999999987518751e-13,
      499.74999987524978, 249750.12495845815}},
    {-9,
     0.5,
     1,
     {8.5769789101736791, 2.6188839902515304, 7.2675369150479128,
      0.8418865455748531, 0.22664747367099519}},
    {9,
     -0.5,
     2,
     {1.6143729754428118, -0.1651120679423401, 1.5318169414716418,
      -0.068263663938090205, 0.23677558177481056}},
    {0,
     1e-9,
     10,
     {1, 9.9999999499999994, 0.99999999000000006, 49.999999833333334,
      166.66666624999999}},
    {0.3,
     0.9,
     1.1,
     {0.86980554127340048, 0.65742129380472714, 0.2781263768491461,
      0.433981529088665, 0.173317766718248}},
    {1e10,
     3e5,
     1e-3,
     {3.0193758860776451e-17, 1.1532989636698301e-22, -4.405210049318449e-18,
      9.9999999999999991e-11, 9.7000000000000003e-14}},
};

/*
 * Against the series of exp in 120 digits. An entry may err by some eps of the
 * largest that its row's states could give: of what they measure, not of what
 * is left where they cancel. Of oscillation the phase errs by eps w h.
 */
static void an_oscillator_is_exact_at_double_and_vanishing_roots(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof oscillators / sizeof *oscillators; k++) {
        double w = sqrt(fabs(oscillators[k].lambda));
        double h = oscillators[k].h;
        const double *e = oscillators[k].expected;
        ritz_oscillator o =
            ritz_oscillator_over(oscillators[k].lambda, oscillators[k].d, h);
        double eps = 16.0 * DBL_EPSILON * (1.0 + w * h);
        double slow = larger(fabs(e[0]), fabs(e[2])); /* fades with them */

        assert_near(o.hold, e[0], eps * slow);
        assert_near(o.S, e[1],
                    eps * larger(fabs(e[1]), slow / larger(w, 1.0 / h)));
        assert_near(o.rate, e[2], eps * slow);
        assert_near(o.P, e[3],
                    eps * larger(fabs(e[3]), larger(slow, 1.0) /
                                                 larger(w * w, 1.0 / (h * h))));
        assert_near(o.R, e[4],
                    eps * larger(fabs(e[4]), h / larger(w * w, 1.0 / (h * h))));
    }
}

/* One dof with K = w^2, D = 2 zeta w, driven by a unit step from rest. */
static double one_dof_step(double w, double zeta, double t)
{
    double r = w * sqrt(fabs(1.0 - zeta * zeta));

    if (zeta < 1.0)
        return (1.0 -
                exp(-zeta * w * t) * (cos(r * t) + zeta * w / r * sin(r * t))) /
               (w * w);
    if (zeta > 1.0) {
        double a = zeta * w - r;
        double b = zeta * w + r;

        return (1.0 - (b * exp(-a * t) - a * exp(-b * t)) / (b - a)) / (w * w);
    }
    return (1.0 - exp(-w * t) * (1.0 + w * t)) / (w * w);
}

static void a_step_response_is_that_of_the_textbook_at_any_step(void **state)
{
    static const double zetas[] = {0.0, 0.02, 0.7, 1.0, 4.0};
    static const double steps[] = {0.01, 0.3, 2.0};
    const double w = 2.0 * pi;

    (void)state;
    for (int z = 0; z < 5; z++) {
        const double m = 1.0, k = w * w, c = 2.0 * zetas[z] * w;
        RITZ_OWN(motions) one = {0};

        assert_ok(motions_row(1, &m, &k, c > 0.0 ? &c : NULL, &one));
        for (int s = 0; s < 3; s++) {
            ritz_simulation_request request = RITZ_SIMULATION_NONE;
            RITZ_OWN(ritz_simulation) r = {0};

            request.seconds = 6.0;
            request.step = steps[s];
            request.signal = &motions_step;
            assert_ok(ritz_simulate(one.dense, &request, &r));
            assert_int_equal(r.count, (int64_t)(6.0 / steps[s] + 0.5) + 1);
            for (int64_t j = 0; j < r.count; j++) /* each step some eps */
                assert_near(r.y[j], one_dof_step(w, zetas[z], r.seconds[j]),
                            8.0 * DBL_EPSILON * (double)(j + 20) / k);
        }
    }
}

/* scipy.linalg.expm and scipy.signal.lsim of the first-order form, 1.10. */
static void
modes_that_damping_couples_go_together_as_scipy_has_them(void **state)
{
    static const struct {
        double t, step, impulse;
    } expected[] = {
        {0.1, 5.3299001630671945e-06, 2.7362654287141483e-04},
        {0.5, 8.4275051865249605e-03, 4.8467777000122780e-02},
        {2.0, -7.6632067512873853e-05, -1.0680177195853031e-02},
    };
    const ritz_signal impulse = {.kind = RITZ_SIGNAL_IMPULSE, .amplitude = 1.0};
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    for (int k = 0; k < 3; k++)
        for (int steps = 1; steps <= 16; steps *= 16) {
            ritz_simulation_request request = RITZ_SIMULATION_NONE;
            RITZ_OWN(ritz_simulation) r = {0};

            request.seconds = expected[k].t;
            request.step = expected[k].t / steps;
            request.every = steps;
            request.signal = &motions_step;
            assert_ok(ritz_simulate(m.dense, &request, &r));
            assert_int_equal(r.count, 2);
            assert_near(r.y[1], expected[k].step, 1e-15); /* of 0.01 */
            ritz_simulation_free(&r);
            request.signal = &impulse;
            assert_ok(ritz_simulate(m.dense, &request, &r));
            assert_near(r.y[1], expected[k].impulse, 1e-14); /* of 0.1 */
        }
}

static void an_input_is_held_or_linear_over_a_step_as_asked(void **state)
{
    const ritz_signal sine = {
        .kind = RITZ_SIGNAL_SINE, .amplitude = 1.0, .hertz = {1.3, 0.0}};
    ritz_simulation_request request = RITZ_SIMULATION_NONE;
    RITZ_OWN(ritz_simulation) first = {0}, zero = {0};
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    request.seconds = 2.0;
    request.step = 0.05;
    request.signal = &sine;
    assert_ok(ritz_simulate(m.dense, &request, &first));
    request.hold = RITZ_HOLD_ZERO;
    assert_ok(ritz_simulate(m.dense, &request, &zero));
    assert_int_equal(first.count, 41);
    /* scipy.signal.lsim, interp True and False */
    assert_near(first.y[40], -1.4103876625323254e-03, 1e-15);
    assert_near(zero.y[40], -2.9868666747586421e-03, 1e-15);
    assert_string_equal(zero.hold, "zero");
}

/* x = t^2 / (2 m) and x' = t / m; with a dashpot c to ground alone, v tends to
 * 1 / c. */
static void a_free_body_is_accelerated(void **state)
{
    const double m[] = {3.0, 1.0}, k[] = {0.0, 10.0};
    ritz_simulation_request request = RITZ_SIMULATION_NONE;
    RITZ_OWN(ritz_simulation) r = {0};
    RITZ_OWN(motions) body = {0};

    (void)state;
    assert_ok(motions_row(2, m, k, NULL, &body));
    /* the centre of mass */
    body.component.io.C.val[0] = 0.75;
    body.component.io.C.val[1] = 0.25;
    request.seconds = 1000.0;
    request.step = 10.0;
    request.signal = &motions_step;
    assert_ok(ritz_simulate(body.dense, &request, &r));
    for (int64_t j = 0; j < r.count; j++) {
        double t = r.seconds[j];

        assert_near(r.y[j], 0.125 * t * t, 1e-14 * (double)(j + 1) * 125e3);
    }
}

/* kinetic + potential + dissipated = work + what was there. */
static void energies_balance_with_coupled_damping_and_inputs(void **state)
{
    static const ritz_damping none = {0};
    static const ritz_damping light = {.kind = RITZ_DAMPING_MODAL,
                                       .zeta = 0.02};
    const ritz_signal signals[] = {
        {.kind = RITZ_SIGNAL_CHIRP, .amplitude = 3.0, .hertz = {0.2, 4.0}},
        {.kind = RITZ_SIGNAL_IMPULSE, .amplitude = 2.0},
        {.kind = RITZ_SIGNAL_STEP, .amplitude = -1.0},
    };
    const double v0[] = {1.0, -2.0, 0.5};

    (void)state;
    for (int damped = 0; damped < 2; damped++)
        for (int s = 0; s < 3; s++)
            for (int hold = 0; hold < 2; hold++) {
                ritz_simulation_request request = RITZ_SIMULATION_NONE;
                RITZ_OWN(ritz_simulation) r = {0};
                double size = 0.0;
                RITZ_OWN(motions) m = {0};

                assert_ok(motions_new(damped, &m));
                m.dense.damping = damped ? &none : &light;
                request.seconds = 10.0;
                request.step = 0.11;
                request.hold = (ritz_hold)hold;
                request.signal = &signals[s];
                request.v0 = v0;
                assert_ok(ritz_simulate(m.dense, &request, &r));
                for (int64_t j = 0; j < r.count; j++) {
                    size = larger(size, r.kinetic[j] + r.potential[j] +
                                            r.dissipated[j]);
                    /* some eps |A| h a step, of what has been turned over */
                    assert_near(r.balance[j], 0.0,
                                1e-15 * (double)(j + 10) * size);
                    assert_true(j == 0 ||
                                r.dissipated[j] >= r.dissipated[j - 1]);
                }
                assert_true(r.dissipated[r.count - 1] > 0.1);
            }
}

/* int_0^h exp(2 a s) ds = (exp(2 a h) - 1) / (2 a), a fast and a slow. */
static void an_integral_of_a_form_is_that_of_its_exponential(void **state)
{
    double a[] = {-3000.0, 0.0, 0.0, -0.02};
    double q[] = {1.0, 0.0, 0.0, 5.0};
    const ritz_dense A = {2, 2, a}, Q = {2, 2, q};
    ritz_dense E = {0}, W = {0};

    (void)state;
    assert_ok(ritz_exponential(&A, 4.0, 1, &Q, &E, &W));
    assert_near(E.val[0], 0.0, DBL_EPSILON);
    /* eps |A| h, as the slow one is squared along with the fast */
    assert_near(E.val[3], exp(-0.08), DBL_EPSILON * 3000.0 * 4.0);
    assert_near(W.val[0], 1.0 / 6000.0, 1e-15);
    assert_near(W.val[3], 5.0 * (1.0 - exp(-0.16)) / 0.04,
                20.0 * DBL_EPSILON * 3000.0 * 4.0);
    ritz_dense_free(&E);
    ritz_dense_free(&W);
}

static void a_step_too_long_for_its_states_is_refused(void **state)
{
    double a = 1e300;
    const ritz_dense A = {1, 1, &a};
    ritz_dense E = {0};

    (void)state;
    assert_fails(ritz_exponential(&A, 1.0, 0, NULL, &E, NULL),
                 RITZ_ERR_ARGUMENT, "too long for the fastest");
}

static ritz_status run(ritz_model subject)
{
    ritz_status status = RITZ_OK;
    ritz_simulation_request request = RITZ_SIMULATION_NONE;
    RITZ_OWN(ritz_simulation) r = {0};

    request.seconds = 0.3;
    request.step = 0.1;
    request.up_to_hz = 1.8;
    request.signal = &motions_step;
    status = ritz_simulate(subject, &request, &r);
    return status;
}

static void modal_survives_every_allocation(void **state)
{
    static const ritz_damping light = {.kind = RITZ_DAMPING_MODAL,
                                       .zeta = 0.02};
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    m.dense.damping = m.sparse.damping = &light;
    assert_survives_every_allocation(run(m.dense));
    assert_survives_every_allocation(run(m.sparse));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(an_oscillator_is_exact_at_double_and_vanishing_roots),
    cmocka_unit_test(a_step_response_is_that_of_the_textbook_at_any_step),
    cmocka_unit_test(modes_that_damping_couples_go_together_as_scipy_has_them),
    cmocka_unit_test(an_input_is_held_or_linear_over_a_step_as_asked),
    cmocka_unit_test(a_free_body_is_accelerated),
    cmocka_unit_test(energies_balance_with_coupled_damping_and_inputs),
    cmocka_unit_test(an_integral_of_a_form_is_that_of_its_exponential),
    cmocka_unit_test(a_step_too_long_for_its_states_is_refused),
    cmocka_unit_test(modal_survives_every_allocation),
};

TEST_MODULE(simulate_modal, tests, NULL, NULL)
