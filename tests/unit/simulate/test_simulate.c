/* Integrators against closed forms and against the exact propagation. */
#include "growth.h"
#include "testing.h"

#include "motions.h"
#include "spaces.h"

#include <ritz/simulate.h>

#include <float.h>
#include <stdio.h>

static const double pi = 3.14159265358979323846;
static const ritz_damping none = {0};

static ritz_simulation_request asking(const ritz_integrator *integrator,
                                      double seconds, double step)
{
    ritz_simulation_request request = RITZ_SIMULATION_NONE;

    request.integrator = integrator;
    request.seconds = seconds;
    request.step = step;
    request.signal = &motions_step;
    return request;
}

/* Free motion from x = 1 of one dof of frequency w. */
static void oscillate(const ritz_integrator *integrator, double w, double step,
                      double rho, int64_t steps, ritz_simulation *out)
{
    const double m = 1.0, k = w * w, x0 = 1.0;
    ritz_simulation_request request =
        asking(integrator, (double)steps * step, step);
    RITZ_OWN(motions) one = {0};

    assert_ok(motions_row(1, &m, &k, NULL, &one));
    request.signal = NULL;
    request.x0 = &x0;
    request.rho = rho;
    assert_ok(ritz_simulate(one.dense, &request, out));
}

/* x_n = cos(n a): tan(a/2) = w h / 2, and sin(a/2) = w h / 2 of central
 * differences, from which the periods' errors follow. */
static void periods_err_as_the_scheme_says(void **state)
{
    const double w = 3.0, h = 0.2;
    const double a[] = {2.0 * atan(0.5 * w * h), 2.0 * asin(0.5 * w * h)};
    const ritz_integrator *const which[] = {
        &ritz_integrator_trapezoidal, &ritz_integrator_central_difference};

    (void)state;
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_simulation) r = {0};

        oscillate(which[k], w, h, 0.0, 1000, &r);
        for (int64_t j = 0; j < r.count; j++) /* phase: eps a step, squared */
            assert_near(r.y[j], cos((double)j * a[k]),
                        4.0 * DBL_EPSILON * (double)(j + 4));
    }
    assert_near(w * h / a[0] - 1.0, w * h * w * h / 12.0, 1e-3);
    assert_near(w * h / a[1] - 1.0, -w * h * w * h / 24.0, 1e-3);
}

static void the_trapezoidal_rule_keeps_energy(void **state)
{
    RITZ_OWN(ritz_simulation) r = {0};

    (void)state;
    oscillate(&ritz_integrator_trapezoidal, 40.0, 0.3, 0.0, 5000, &r);
    for (int64_t j = 0; j < r.count; j++)
        /* a step rounds h^2 K / 4, 36 times what M holds */
        assert_near(r.kinetic[j] + r.potential[j], 800.0,
                    2.0 * DBL_EPSILON * 37.0 * 800.0 * (double)(j + 1));
}

/* At w h = 1e4 a step shrinks all by rho, but for its powers' polynomials. */
static void generalised_alpha_damps_by_rho_a_step(void **state)
{
    (void)state;
    for (int k = 1; k < 4; k++) {
        double rho = 0.25 * k;
        RITZ_OWN(ritz_simulation) r = {0};

        oscillate(&ritz_integrator_generalised_alpha, 1e4, 1.0, rho, 200, &r);
        /* |x_n| ~ n^2 rho^n at most of three equal roots: by logarithm */
        assert_near(log(fabs(r.y[200]) / fabs(r.y[100])) / 100.0, log(rho),
                    0.02);
    }
}

/* Largest difference from modal at the same step and inputs. */
static double error_of(ritz_model subject, ritz_simulation_request request)
{
    RITZ_OWN(ritz_simulation) made = {0}, exact = {0};
    double error = 0.0;

    assert_ok(ritz_simulate(subject, &request, &made));
    request.integrator = &ritz_integrator_modal;
    assert_ok(ritz_simulate(subject, &request, &exact));
    assert_ok(ritz_simulation_difference(&exact, &made, &error));
    return error;
}

/* Step halved: the error of a second-order scheme falls by 4. */
static void orders_are_two_with_dampers_and_inputs(void **state)
{
    const ritz_signal sine = {
        .kind = RITZ_SIGNAL_SINE, .amplitude = 1.0, .hertz = {0.7, 0.0}};
    const double x0[] = {0.1, -0.2, 0.3};

    (void)state;
    for (int k = 1; ritz_integrators[k]; k++) {
        RITZ_OWN(motions) m = {0};
        double error[5];

        assert_ok(motions_new(true, &m));
        for (int j = 0; j < 5; j++) {
            ritz_simulation_request request =
                asking(ritz_integrators[k], 4.0, ldexp(0.01, -j));

            request.signal = &sine;
            request.x0 = x0;
            error[j] = error_of(m.dense, request);
        }
        assert_true(error[0] < 0.05 && error[4] > 1e-7);
        /* the next term is of order h^2 relative: (w h)^2 = 0.02 */
        for (int j = 0; j < 4; j++)
            assert_near(log2(error[j] / error[j + 1]), 2.0, 0.05);
    }
}

/* An input that jumps between steps, held: a_0 follows, or order 1 is left. */
static void a_held_input_keeps_second_order(void **state)
{
    static double time[] = {0.0, 0.32, 0.32, 2.0};
    static double value[] = {1.0, 1.0, -2.0, -2.0};
    const ritz_signal jump = {.kind = RITZ_SIGNAL_TABLE,
                              .amplitude = 1.0,
                              .count = 4,
                              .time = time,
                              .value = value};

    (void)state;
    for (int k = 1; ritz_integrators[k]; k++) {
        RITZ_OWN(motions) m = {0};
        double error[2];

        assert_ok(motions_new(true, &m));
        for (int j = 0; j < 2; j++) {
            ritz_simulation_request request =
                asking(ritz_integrators[k], 1.6, ldexp(0.02, -j));

            request.signal = &jump;
            request.hold = RITZ_HOLD_ZERO;
            error[j] = error_of(m.dense, request);
        }
        assert_near(log2(error[0] / error[1]), 2.0, 0.15);
    }
}

/* Rounding of this identity: eps of what is turned over, a step. */
static void the_trapezoidal_rule_balances_energies(void **state)
{
    const ritz_signal chirp = {
        .kind = RITZ_SIGNAL_CHIRP, .amplitude = 5.0, .hertz = {0.1, 3.0}};
    ritz_simulation_request request =
        asking(&ritz_integrator_trapezoidal, 20.0, 0.05);
    ritz_model subjects[2];
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    request.signal = &chirp;
    subjects[0] = m.dense;
    subjects[1] = m.sparse;
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_simulation) r = {0};
        double size = 0.0;

        assert_ok(ritz_simulate(subjects[k], &request, &r));
        for (int64_t j = 0; j < r.count; j++) {
            size = fmax(size, r.dissipated[j] + r.kinetic[j] + r.potential[j]);
            assert_near(r.balance[j], 0.0,
                        16.0 * DBL_EPSILON * size * (double)(j + 1));
        }
        assert_true(r.dissipated[r.count - 1] > 0.01);
    }
}

static void an_explicit_step_above_its_limit_is_refused_and_grows(void **state)
{
    RITZ_OWN(ritz_simulation) r = {0};
    RITZ_OWN(motions) m = {0};
    double limit = 0.1555256079217896; /* 2 / omega_3, scipy.linalg.eigh */
    double below = 0.0, above = 0.0;
    ritz_simulation_request request =
        asking(&ritz_integrator_central_difference, 1.0, limit * 1.0001);

    (void)state;
    assert_ok(motions_new(false, &m));
    assert_fails(ritz_simulate(m.dense, &request, &r), RITZ_ERR_ARGUMENT,
                 "2.04667 Hz, limits it to 0.155526 s");
    request.step = limit * 0.9999;
    assert_ok(ritz_simulate(m.dense, &request, &r));
    assert_ok(growth_of(ritz_model_of_dense(&m.model, &none),
                        request.integrator, 0.9 * limit, 3000, 2, &below));
    assert_ok(growth_of(ritz_model_of_dense(&m.model, &none),
                        request.integrator, 1.01 * limit, 3000, 2, &above));
    assert_true(below < 20.0); /* its own energy is (1 - (w h / 2)^2) of E */
    assert_true(above > 1e10);
}

/* Damping leaves the limit where it is; gyroscopic terms too. */
static void central_differences_stand_damping_to_their_limit(void **state)
{
    double skew[9] = {0.0, 5.0, 0.0, -5.0, 0.0, 8.0, 0.0, -8.0, 0.0};
    const double limit = 0.1555256079217896;
    RITZ_OWN(motions) m = {0};
    double damped = 0.0, gyroscopic = 0.0;

    (void)state;
    assert_ok(motions_new(true, &m));
    for (int k = 0; k < 9; k++)
        m.D.val[k] *= 30.0;
    assert_ok(growth_of(ritz_model_of_dense(&m.model, &none),
                        &ritz_integrator_central_difference, 0.999 * limit,
                        2000, 3, &damped));
    memcpy(m.D.val, skew, sizeof skew);
    assert_ok(growth_of(ritz_model_of_dense(&m.model, &none),
                        &ritz_integrator_central_difference, 0.9 * limit, 2000,
                        3, &gyroscopic));
    assert_true(damped < 3000.0); /* (1 - 0.999^2)^-1 and a start */
    assert_true(gyroscopic < 50.0);
}

static void a_component_and_its_dense_matrices_answer_alike(void **state)
{
    const ritz_integrator *const both[] = {&ritz_integrator_trapezoidal,
                                           &ritz_integrator_generalised_alpha};
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    m.component.io.Ca.val[1] = 0.1; /* and an acceleration beside */
    m.component.io.Cv.val[2] = 0.2;
    for (int k = 0; k < 2; k++)
        for (int skew = 0; skew < 2; skew++) {
            ritz_simulation_request request = asking(both[k], 2.0, 0.02);
            RITZ_OWN(ritz_simulation) dense = {0}, sparse = {0};
            double off = 1.0;

            if (skew) { /* one entry of D: unsymmetric, another factor */
                m.D.val[3] += 0.5;
                m.component.D.val[m.component.D.colptr[1]] += 0.5;
            }
            assert_ok(ritz_simulate(m.dense, &request, &dense));
            assert_ok(ritz_simulate(m.sparse, &request, &sparse));
            assert_ok(ritz_simulation_difference(&dense, &sparse, &off));
            assert_true(off < 1e-12); /* some eps a step, 100 steps */
            assert_string_equal(sparse.output[0], "y1");
            if (skew) {
                m.D.val[3] -= 0.5;
                m.component.D.val[m.component.D.colptr[1]] -= 0.5;
            }
        }
}

/* The same dense model with its last coordinate in another unit. */
static void change_unit(motions *m, double by)
{
    ritz_dense *const square[] = {&m->K, &m->M, &m->D};
    ritz_io *io = &m->component.io;
    ritz_dense *const wide[] = {&io->C, &io->Cv, &io->Ca};

    for (int k = 0; k < 3; k++) {
        for (int64_t i = 0; i < 3; i++) {
            ritz_dense_col(square[k], 2)[i] *= by;
            ritz_dense_col(square[k], i)[2] *= by;
        }
        ritz_dense_col(wide[k], 2)[0] *= by;
    }
    io->B.val[2] *= by;
}

/*
 * On steel a static response to a unit force is a column of about 1e-9, so that
 * its entry of M is 1e-18 where that of a mode is 1. Such an M is not singular.
 */
static void coordinates_may_have_any_units(void **state)
{
    enum { ALL = 3 };
    const ritz_integrator *const all[ALL] = {
        &ritz_integrator_trapezoidal, &ritz_integrator_generalised_alpha,
        &ritz_integrator_central_difference};

    (void)state;
    for (int k = 0; k < ALL; k++) {
        ritz_simulation_request request = asking(all[k], 2.0, 0.02);
        RITZ_OWN(motions) m = {0};
        RITZ_OWN(ritz_simulation) plain = {0}, scaled = {0};
        double off = 1.0;

        assert_ok(motions_new(true, &m));
        m.component.io.Ca.val[1] = 0.1;
        assert_ok(ritz_simulate(m.dense, &request, &plain));
        change_unit(&m, 1e-10);
        assert_ok(ritz_simulate(m.dense, &request, &scaled));
        assert_ok(ritz_simulation_difference(&plain, &scaled, &off));
        assert_true(off < 1e-12);
    }
}

/* All modes are the model; and of some, statics are of all. */
static void a_component_goes_by_its_modes(void **state)
{
    ritz_simulation_request request =
        asking(&ritz_integrator_modal, 4000.0, 5.0);
    RITZ_OWN(ritz_simulation) all = {0}, dense = {0}, some = {0};
    RITZ_OWN(motions) m = {0};
    double off = 1.0;

    (void)state;
    assert_ok(motions_new(true, &m));
    request.up_to_hz = 1.8;
    assert_ok(ritz_simulate(m.sparse, &request, &some));
    assert_int_equal(some.order, 2);
    /* u = K^-1 f after all motion has died: 1 / 100 at the first mass */
    assert_near(some.y[some.count - 1], 0.01, 1e-9);
    request.up_to_hz = 10.0;
    assert_ok(ritz_simulate(m.sparse, &request, &all));
    assert_ok(ritz_simulate(m.dense, &request, &dense));
    assert_ok(ritz_simulation_difference(&dense, &all, &off));
    assert_true(off < 1e-11);
}

/* A spring of 50 to a dof without mass, which 1 N pulls: 1/50 at once. */
static void a_dof_without_mass_follows_at_once(void **state)
{
    const double mass[] = {2.0, 0.0}, k[] = {100.0, 50.0};
    const ritz_signal sine = {
        .kind = RITZ_SIGNAL_SINE, .amplitude = 1.0, .hertz = {0.3, 0.0}};
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_row(2, mass, k, NULL, &m));
    m.component.io.C.val[0] = 0.0; /* the place of the second */
    m.component.io.C.val[1] = 1.0;
    for (int s = 0; s < 2; s++) {
        RITZ_OWN(ritz_simulation) exact = {0};
        ritz_simulation_request request =
            asking(&ritz_integrator_modal, 3.0, 0.005);

        request.signal = s == 0 ? &motions_step : &sine;
        assert_ok(ritz_simulate(m.dense, &request, &exact));
        assert_near(exact.y[0], s == 0 ? 0.02 : 0.0, 1e-16);
        for (int j = 1; j < 4; j++) {
            RITZ_OWN(ritz_simulation) r = {0};
            double off = 1.0;

            request.integrator = ritz_integrators[j];
            assert_ok(ritz_simulate(m.dense, &request, &r));
            assert_ok(ritz_simulation_difference(&exact, &r, &off));
            assert_true(off < 2e-3); /* (w h)^2 / 12 of a phase of 21, and as
                                    much again by rho */
            ritz_simulation_free(&r);
            if (ritz_integrators[j]->is_explicit)
                continue;
            assert_ok(ritz_simulate(m.sparse, &request, &r));
            assert_ok(ritz_simulation_difference(&exact, &r, &off));
            assert_true(off < 2e-3);
        }
    }
}

static void an_impulse_is_a_velocity(void **state)
{
    const ritz_signal impulse = {.kind = RITZ_SIGNAL_IMPULSE, .amplitude = 3.0};
    const double v0[] = {0.0, 0.0, 2.0}; /* 3 N s on 1.5 kg */
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    for (int k = 0; ritz_integrators[k]; k++) {
        ritz_simulation_request request =
            asking(ritz_integrators[k], 1.0, 0.02);
        RITZ_OWN(ritz_simulation) pushed = {0}, started = {0};
        double off = 1.0;

        request.signal = &impulse;
        assert_ok(ritz_simulate(m.dense, &request, &pushed));
        assert_near(pushed.work[0], 3.0, 1e-14); /* m v^2 / 2 */
        request.signal = NULL;
        request.v0 = v0;
        assert_ok(ritz_simulate(m.dense, &request, &started));
        assert_ok(ritz_simulation_difference(&started, &pushed, &off));
        assert_true(off < 1e-13);
    }
}

/* x' = -a x + u, E = 2, y = x + u: (1 - exp(-a t / 2)) / a + 1 */
static void a_state_space_is_simulated(void **state)
{
    static const double A = -3.0, B = 1.0, C = 1.0, D = 1.0, E = 2.0;
    const spaces_rows rows = {1, 1, 1, &A, &B, &C, &D, &E};
    RITZ_OWN(ritz_state_space) space = {0};
    const ritz_model subject = ritz_model_of_states(&space);
    ritz_simulation_request request = asking(&ritz_integrator_modal, 5.0, 0.5);
    ritz_simulation r = {0};

    (void)state;
    assert_ok(spaces_make(&rows, &space));
    assert_ok(ritz_simulate(subject, &request, &r));
    for (int64_t k = 0; k < r.count; k++)
        assert_near(r.y[k], (1.0 - exp(-1.5 * r.seconds[k])) / 3.0 + 1.0,
                    1e-15 * (double)(k + 2));
    assert_null(r.balance);
    ritz_simulation_free(&r);
    request.integrator = &ritz_integrator_trapezoidal;
    assert_ok(ritz_simulate(subject, &request, &r));
    for (int64_t k = 0; k < r.count; k++) /* ((1 - z) / (1 + z))^k, z = 3/8 */
        assert_near(r.y[k], (1.0 - pow(0.625 / 1.375, (double)k)) / 3.0 + 1.0,
                    1e-15 * (double)(k + 2));
    ritz_simulation_free(&r);
    request.integrator = &ritz_integrator_central_difference;
    assert_fails(ritz_simulate(subject, &request, &r), RITZ_ERR_ARGUMENT,
                 "is of second-order models");
}

static void a_step_is_halved_until_it_is_accurate(void **state)
{
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    for (int k = 0; ritz_integrators[k]; k++) {
        ritz_simulation_request request = asking(ritz_integrators[k], 3.0, 0.0);
        RITZ_OWN(ritz_simulation) r = {0};
        ritz_accuracy reached = {.error = 1.0};

        assert_ok(
            ritz_simulate_accurate(m.dense, &request, 1e-3, &reached, &r));
        assert_true(reached.error <= 1e-3);
        assert_int_equal(reached.num_left, 0);
        assert_true(r.step <= 0.06);
        /* it halves: twice that step is not yet good enough */
        if (k > 0) {
            request.step = 2.0 * r.step;
            if (request.step < 0.05)
                assert_true(error_of(m.dense, request) > 1e-3);
        }
    }
}

static void what_makes_no_sense_is_refused(void **state)
{
    static const ritz_damping modal = {.kind = RITZ_DAMPING_MODAL,
                                       .zeta = 0.02};
    double k4[9] = {1.0};
    const ritz_dense K4 = {3, 3, k4};
    ritz_simulation_request request = asking(&ritz_integrator_modal, 1.0, 0.1);
    ritz_simulation r = {0};
    ritz_model nothing = {0};
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    assert_fails(ritz_simulate(nothing, &request, &r), RITZ_ERR_ARGUMENT,
                 "not one thing");
    assert_fails(ritz_simulate(m.sparse, &request, &r), RITZ_ERR_ARGUMENT,
                 "no frequency is given");
    request.integrator = &ritz_integrator_central_difference;
    assert_fails(ritz_simulate(m.sparse, &request, &r), RITZ_ERR_ARGUMENT,
                 "is of small dense models");
    request.integrator = &ritz_integrator_trapezoidal;
    m.sparse.damping = &modal;
    assert_fails(ritz_simulate(m.sparse, &request, &r), RITZ_ERR_ARGUMENT,
                 "damping ratios are of modes");
    m.dense.dense.K4 = &K4;
    assert_fails(ritz_simulate(m.dense, &request, &r), RITZ_ERR_ARGUMENT,
                 "structural damping");
    m.dense.dense.K4 = NULL;
    request.integrator = &ritz_integrator_generalised_alpha;
    request.rho = 1.5;
    assert_fails(ritz_simulate(m.dense, &request, &r), RITZ_ERR_ARGUMENT,
                 "spectral radius");
    request.step = 0.0;
    assert_fails(ritz_simulate(m.dense, &request, &r), RITZ_ERR_ARGUMENT,
                 "0 s is no step");
    request.step = 0.1;
    request.seconds = -1.0;
    assert_fails(ritz_simulate(m.dense, &request, &r), RITZ_ERR_ARGUMENT,
                 "no -1 seconds");
    assert_null(ritz_row_find(ritz_integrators, "integrator", "trapezoid"));
    assert_non_null(strstr(ritz_error_message(), "is 'trapezoidal' meant?"));
}

static void damping_of_a_dof_without_mass_is_refused(void **state)
{
    const double mass[] = {2.0, 0.0}, k[] = {100.0, 50.0}, c[] = {0.0, 1.0};
    ritz_simulation_request request =
        asking(&ritz_integrator_trapezoidal, 1.0, 0.1);
    ritz_simulation r = {0};
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_row(2, mass, k, c, &m));
    assert_fails(ritz_simulate(m.dense, &request, &r), RITZ_ERR_ARGUMENT,
                 "dofs without mass are damped");
    assert_fails(ritz_simulate(m.sparse, &request, &r), RITZ_ERR_ARGUMENT,
                 "grid 2 T1 has damping and no mass");
}

static void an_unstable_model_leaves_all_bounds(void **state)
{
    const double mass = 1.0, k = -1e6;
    ritz_simulation_request request = asking(&ritz_integrator_modal, 9.0, 0.01);
    ritz_simulation r = {0};
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_row(1, &mass, &k, NULL, &m));
    assert_fails(ritz_simulate(m.dense, &request, &r), RITZ_ERR_CONVERGENCE,
                 "left all bounds");
}

static void signals_are_words_or_tables(void **state)
{
    static const char *const wrong[][2] = {
        {"step:3", "followed by nothing"}, {"sine", "a frequency in Hz"},
        {"sine:x", "a frequency in Hz"},   {"chirp:1", "two frequencies"},
        {"sine:1,2", "a frequency in Hz"}, {"step*", "no amplitude"},
        {"sine:-1", "a frequency in Hz"},  {"no/such.tsv", "no/such.tsv"},
    };
    ritz_signal s = {0};

    (void)state;
    assert_ok(ritz_signal_parse("chirp:1,3*-2", &s));
    assert_int_equal(s.kind, RITZ_SIGNAL_CHIRP);
    assert_near(s.amplitude, -2.0, 0.0);
    /* phase 2 pi (t + t^2 / 10), t = 2.5 of 10 s */
    assert_near(ritz_signal_at(&s, 2.5, 10.0),
                -2.0 * sin(2.0 * pi * (2.5 + 0.625)), 1e-14);
    assert_ok(ritz_signal_parse("sine:0.25", &s));
    assert_near(ritz_signal_at(&s, 1.0, 10.0), 1.0, 1e-15);
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_true(ritz_signal_parse(wrong[k][0], &s) != RITZ_OK);
        assert_non_null(strstr(ritz_error_message(), wrong[k][1]));
    }
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");

    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void a_table_is_linear_between_its_points(void **state)
{
    const char *path = "test_simulate_table.tsv";
    ritz_signal s = {0};

    (void)state;
    write_text(path, "# s\tN\n0.5\t1\n1 3\n\n1.0, -1\r\n2\t5\n");
    assert_false(!ritz_signal_is_file(path));
    assert_ok(ritz_signal_parse(path, &s));
    assert_int_equal(s.count, 4);
    assert_near(ritz_signal_at(&s, 0.4, 9.0), 0.0, 0.0);
    assert_near(ritz_signal_at(&s, 0.75, 9.0), 2.0, 0.0);
    assert_near(ritz_signal_at(&s, 1.0, 9.0), -1.0, 0.0);
    assert_near(ritz_signal_at(&s, 1.5, 9.0), 2.0, 0.0);
    assert_near(ritz_signal_at(&s, 2.0, 9.0), 5.0, 0.0);
    assert_near(ritz_signal_at(&s, 2.1, 9.0), 0.0, 0.0);
    ritz_signal_free(&s);
    write_text(path, "0 1\n1 2 3\n");
    assert_fails(ritz_signal_parse(path, &s), RITZ_ERR_FORMAT,
                 "line 2 is not a time and a value");
    write_text(path, "0 1\n1\n");
    assert_fails(ritz_signal_parse(path, &s), RITZ_ERR_FORMAT, "no value");
    write_text(path, "1 1\n0 1\n");
    assert_fails(ritz_signal_parse(path, &s), RITZ_ERR_FORMAT, "descends");
    write_text(path, "# empty\n");
    assert_fails(ritz_signal_parse(path, &s), RITZ_ERR_FORMAT, "no line");
    assert_int_equal(remove(path), 0);
    assert_fails(ritz_signal_parse("bump", &s), RITZ_ERR_FILE,
                 "'bump' is neither step, impulse, sine:F nor chirp:F,F, nor "
                 "a file that can be read");
}

static ritz_status run(ritz_model subject, const ritz_integrator *integrator)
{
    ritz_status status = RITZ_OK;
    ritz_simulation_request request = asking(integrator, 0.3, 0.1);
    RITZ_OWN(ritz_simulation) r = {0};

    status = ritz_simulate(subject, &request, &r);
    return status;
}

static void integrators_survive_every_allocation(void **state)
{
    static const ritz_damping light = {.kind = RITZ_DAMPING_MODAL,
                                       .zeta = 0.02};
    static const ritz_damping rayleigh = {
        .kind = RITZ_DAMPING_RAYLEIGH, .a = 0.1, .b = 0.001};
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    m.component.io.Ca.val[1] = 0.1;
    m.dense.damping = &light;
    m.sparse.damping = &rayleigh;
    for (int k = 1; ritz_integrators[k]; k++)
        assert_survives_every_allocation(run(m.dense, ritz_integrators[k]));
    assert_survives_every_allocation(
        run(m.sparse, &ritz_integrator_generalised_alpha));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(periods_err_as_the_scheme_says),
    cmocka_unit_test(the_trapezoidal_rule_keeps_energy),
    cmocka_unit_test(generalised_alpha_damps_by_rho_a_step),
    cmocka_unit_test(orders_are_two_with_dampers_and_inputs),
    cmocka_unit_test(a_held_input_keeps_second_order),
    cmocka_unit_test(the_trapezoidal_rule_balances_energies),
    cmocka_unit_test(an_explicit_step_above_its_limit_is_refused_and_grows),
    cmocka_unit_test(central_differences_stand_damping_to_their_limit),
    cmocka_unit_test(a_component_and_its_dense_matrices_answer_alike),
    cmocka_unit_test(coordinates_may_have_any_units),
    cmocka_unit_test(a_component_goes_by_its_modes),
    cmocka_unit_test(a_dof_without_mass_follows_at_once),
    cmocka_unit_test(an_impulse_is_a_velocity),
    cmocka_unit_test(a_state_space_is_simulated),
    cmocka_unit_test(a_step_is_halved_until_it_is_accurate),
    cmocka_unit_test(what_makes_no_sense_is_refused),
    cmocka_unit_test(damping_of_a_dof_without_mass_is_refused),
    cmocka_unit_test(an_unstable_model_leaves_all_bounds),
    cmocka_unit_test(signals_are_words_or_tables),
    cmocka_unit_test(a_table_is_linear_between_its_points),
    cmocka_unit_test(integrators_survive_every_allocation),
};

TEST_MODULE(simulate, tests, NULL, NULL)
