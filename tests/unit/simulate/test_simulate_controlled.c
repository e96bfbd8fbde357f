/* Closed loops in time: closed forms, SciPy's numbers, orders, limits. */
#include "motions.h"
#include "spaces.h"
#include "testing.h"

#include <ritz/controlled.h>

#include <float.h>
#include <stdio.h>
#include <string.h>

/* A plant, its controller and how they are joined. */
typedef struct rig {
    motions row;
    ritz_state_space plant, controller; /* of a plant that is a state space */
    ritz_model subject;
    ritz_loop loop;
    ritz_controlled way;
    ritz_simulation_request request;
} rig;

static void rig_free(rig *r)
{
    motions_free(&r->row);
    ritz_state_space_free(&r->plant);
    ritz_state_space_free(&r->controller);
    ritz_loop_free(&r->loop);
}

static void ask(double seconds, double step, rig *r)
{
    const ritz_simulation_request request = RITZ_SIMULATION_NONE;

    r->request = request;
    r->request.seconds = seconds;
    r->request.step = step;
    r->request.signal = &motions_step;
}

/* Join the only output to the only input of the controller, and back. */
static void join(bool positive, rig *r)
{
    const ritz_io plant = ritz_model_io(r->subject);
    const ritz_io inner = ritz_model_io(ritz_model_of_states(&r->controller));
    char there[2 * RITZ_NAME_SIZE + 2], back[2 * RITZ_NAME_SIZE + 2];
    const char *const pairs[] = {there, back};

    snprintf(r->controller.input[0], RITZ_NAME_SIZE, "in");
    snprintf(r->controller.output[0], RITZ_NAME_SIZE, "out");
    snprintf(there, sizeof there, "%s=in", plant.output[0]);
    snprintf(back, sizeof back, "out=%s", plant.input[0]);
    assert_ok(ritz_loop_match(&plant, &inner, 2, pairs, &r->loop));
    r->loop.positive = positive;
    r->way.controller = &r->controller;
    r->way.loop = &r->loop;
}

static void controller(double a, double b, double c, double d, rig *r)
{
    const spaces_rows rows = {1, 1, 1, &a, &b, &c, &d, NULL};

    assert_ok(spaces_make(&rows, &r->controller));
}

/* Three damped masses, g s / (1 + s / 10) from the first to the last. */
static void derivative(double g, bool positive, rig *r)
{
    assert_ok(motions_new(true, &r->row));
    r->subject = r->row.dense;
    controller(-10.0, 1.0, -100.0 * g, 10.0 * g, r);
    join(positive, r);
    ask(1.0, 0.01, r);
}

/* The acceleration of the last mass is fed back through a lag with feedthrough.
   The feedthroughs 1/1.5 and 0.5 form an algebraic loop. */
static void feedthrough(rig *r)
{
    assert_ok(motions_new(true, &r->row));
    for (int64_t k = 0; k < 3; k++) {
        ritz_dense_col(&r->row.component.io.C, k)[0] = 0.0;
        ritz_dense_col(&r->row.component.io.Ca, k)[0] = k == 2 ? 1.0 : 0.0;
    }
    r->subject = r->row.dense;
    controller(-4.0, 2.0, 3.0, 0.5, r);
    join(false, r);
    ask(1.0, 0.01, r);
}

static void simulate(const rig *r, ritz_simulation *out)
{
    assert_ok(
        ritz_simulate_controlled(r->subject, &r->request, &r->way, NULL, out));
}

/* Compare y after 0, 10, 50 and 100 steps of a run of 1 s. */
static void compare(const rig *r, const double due[4])
{
    static const int64_t steps[] = {0, 10, 50, 100};
    RITZ_OWN(ritz_simulation) s = {0};
    double largest = 0.0;

    simulate(r, &s);
    for (int k = 0; k < 4; k++)
        largest = fmax(largest, fabs(due[k]));
    for (int k = 0; k < 4; k++) /* of the digits that are written here */
        assert_near(s.y[steps[k] * s.num_outputs], due[k], 1e-12 * largest);
    if (s.balance) /* some eps a step of the energy that is exchanged */
        for (int64_t k = 0; k < s.count; k++)
            assert_near(s.balance[k], 0.0, 1e-13 * (1.0 + s.work[k]));
}

/* Numbers by scipy.linalg.expm of the closed loop with its held input. */
static void one_exponential_agrees_with_scipy(void **state)
{
    static const double negative[] = {0.0, 5.3298992897937205e-06,
                                      8.4209694762810931e-03,
                                      1.9825407660943938e-02};
    static const double positive[] = {0.0, 5.329901036340656e-06,
                                      8.434041641787534e-03,
                                      2.085360528596328e-02};
    static const double direct[] = {0.5, 0.2785076259911107,
                                    0.07295398053640828, -0.1908222561274625};
    RITZ_OWN(rig) a = {0}, b = {0}, c = {0};

    (void)state;
    derivative(1.0, false, &a);
    a.way.exact = true;
    compare(&a, negative);
    derivative(1.0, true, &b);
    b.way.exact = b.way.force = true;
    compare(&b, positive);
    feedthrough(&c);
    c.way.exact = true;
    compare(&c, direct);
}

/* Numbers by NumPy from the same difference equations; those of the first case
   also by scipy.signal.cont2discrete and dlsim. */
static void a_sampled_controller_agrees_with_scipy(void **state)
{
    static const struct {
        bool direct;
        double delay, due[4];
    } cases[] = {
        {false,
         0.0,
         {0.0, 5.329899932712919e-06, 8.422243606208557e-03,
          1.973108084157375e-02}},
        {false,
         0.02,
         {0.0, 5.329900146083408e-06, 8.423912171777454e-03,
          1.976650194630105e-02}},
        {false,
         0.13,
         {0.0, 5.329900163067174e-06, 8.427226994362330e-03,
          1.998883270251745e-02}},
        {true,
         0.0,
         {0.5, 0.2619541137278258, 0.08121355949978626, -0.17047567154438892}},
        {true,
         0.03,
         {0.6666666666666666, 0.2363286300404876, 0.08187285452621168,
          -0.1752513695088067}},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RITZ_OWN(rig) r = {0};

        if (cases[k].direct)
            feedthrough(&r);
        else
            derivative(1.0, false, &r);
        r.way.sample = 0.05;
        r.way.delay = cases[k].delay;
        compare(&r, cases[k].due);
    }
}

static void a_discrete_controller_is_taken_as_it_is(void **state)
{
    static const double due[] = {0.0, 5.3298999327129186e-06,
                                 8.4225331055333853e-03,
                                 1.9913687705041976e-02};
    RITZ_OWN(rig) r = {0};

    (void)state;
    assert_ok(motions_new(true, &r.row));
    r.subject = r.row.dense;
    controller(0.6, 0.05, -100.0, 10.0, &r);
    join(false, &r);
    ask(1.0, 0.01, &r);
    r.way.discrete = true;
    r.way.sample = 0.05;
    compare(&r, due);
}

/* A mass of 2 that is pushed by -(8 q + 3 q') at samples 0.1 s apart. */
static void proportional(rig *r)
{
    static const double A[] = {0, 1, 0, 0}, B[] = {0, 0.5}, C[] = {1, 0, 0, 1},
                        D[] = {8, 3};
    static const spaces_rows mass = {2, 1, 2, A, B, C, NULL, NULL};
    static const spaces_rows gains = {0, 2, 1, NULL, NULL, NULL, D, NULL};
    ritz_io plant = {0}, inner = {0};

    assert_ok(spaces_make(&mass, &r->plant));
    assert_ok(spaces_make(&gains, &r->controller));
    for (int k = 0; k < 2; k++) {
        snprintf(r->plant.output[k], RITZ_NAME_SIZE, "y%d", k);
        snprintf(r->controller.input[k], RITZ_NAME_SIZE, "y%d", k);
    }
    snprintf(r->plant.input[0], RITZ_NAME_SIZE, "f");
    snprintf(r->controller.output[0], RITZ_NAME_SIZE, "f");
    r->subject = ritz_model_of_states(&r->plant);
    plant = ritz_model_io(r->subject);
    inner = ritz_model_io(ritz_model_of_states(&r->controller));
    assert_ok(ritz_loop_match(&plant, &inner, 0, NULL, &r->loop));
    r->way.controller = &r->controller;
    r->way.loop = &r->loop;
    ask(2.0, 0.02, r);
}

/* q'' + 1.5 q' + 4 q = 1/2 from rest: q = (1 - e^(-at) (cos wt + a/w sin wt)) /
   8, a = 3/4, w^2 = 4 - 9/16. */
static void a_mass_under_two_gains_moves_as_an_oscillator(void **state)
{
    const double a = 0.75, w = sqrt(4.0 - 0.5625);
    RITZ_OWN(rig) r = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    proportional(&r);
    r.way.exact = true;
    simulate(&r, &s);
    for (int64_t k = 0; k < s.count; k++) {
        const double t = s.seconds[k];
        const double due =
            (1.0 - exp(-a * t) * (cos(w * t) + a / w * sin(w * t))) / 8.0;

        assert_near(s.y[2 * k], due, 1e-14);
        assert_near(s.diagnosis[2 * k], 8.0 * s.y[2 * k] + 3.0 * s.y[2 * k + 1],
                    1e-13);
    }
}

/* With the force held for T: q += v T + f T^2 / 4, v += f T / 2. */
static void a_sampled_mass_moves_by_its_difference_equation(void **state)
{
    const double T = 0.1;
    double q = 0.0, v = 0.0;
    RITZ_OWN(rig) r = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    proportional(&r);
    r.way.sample = T;
    simulate(&r, &s);
    for (int64_t k = 0; k < s.count; k += 5) {
        const double f = 1.0 - 8.0 * q - 3.0 * v;

        assert_near(s.y[2 * k], q, 1e-14);
        assert_near(s.y[2 * k + 1], v, 1e-14);
        assert_near(s.diagnosis[2 * k], 1.0 - f, 1e-13);
        q += v * T + 0.25 * f * T * T;
        v += 0.5 * f * T;
    }
}

/* Errors against the exact propagation are halved with the step. */
static void a_split_loop_converges_at_first_order(void **state)
{
    static const double due = 1.9825407660943938e-02; /* SciPy, after 1 s */
    double error[5] = {0};

    (void)state;
    for (int k = 0; k < 5; k++) {
        RITZ_OWN(rig) r = {0};
        RITZ_OWN(ritz_simulation) s = {0};

        derivative(1.0, false, &r);
        r.request.step = 0.02 / (double)(1 << k);
        simulate(&r, &s);
        assert_string_equal(s.integrator, "modal, split");
        error[k] = fabs(s.y[s.count - 1] - due);
        for (int64_t j = 0; j < s.count; j++)
            assert_near(s.balance[j], 0.0, 1e-13 * (1.0 + s.work[j]));
    }
    assert_near(error[0], 3.903254052459865e-05, 1e-15); /* NumPy */
    for (int k = 0; k < 4; k++) /* and the ratio tends to 2 at that order too */
        assert_near(error[k] / error[k + 1], 2.0, 0.03 / (double)(1 << k));
}

/* With other integrators of the plant the split differs from that with `modal`
   by an error of second order. */
static void any_integrator_moves_the_plant(void **state)
{
    static const ritz_integrator *const which[] = {
        &ritz_integrator_trapezoidal, &ritz_integrator_generalised_alpha,
        &ritz_integrator_central_difference};

    (void)state;
    for (int k = 0; k < 3; k++) {
        double error[2] = {0};

        for (int half = 0; half < 2; half++) {
            RITZ_OWN(rig) r = {0};
            RITZ_OWN(ritz_simulation) s = {0}, exact = {0};

            derivative(1.0, false, &r);
            r.request.step = half ? 1e-3 : 2e-3;
            simulate(&r, &exact);
            r.request.integrator = which[k];
            simulate(&r, &s);
            assert_ok(ritz_simulation_difference(&exact, &s, &error[half]));
        }
        assert_near(error[0] / error[1], 4.0, 0.1);
    }
}

static void refuse(rig *r, const char *words)
{
    RITZ_OWN(ritz_simulation) s = {0};

    assert_fails(
        ritz_simulate_controlled(r->subject, &r->request, &r->way, NULL, &s),
        RITZ_ERR_ARGUMENT, words);
}

/* The split of x' = r - 3 x is x_1 = (1 - 3 h) x_0, unstable from 2/3 s on. */
static void the_limit_of_an_integrator_is_two_over_its_gain(void **state)
{
    static const double zero = 0.0, one = 1.0, gain = 3.0;
    static const spaces_rows integrator = {1,    1,    1,    &zero,
                                           &one, &one, NULL, NULL};
    static const spaces_rows gains = {0, 1, 1, NULL, NULL, NULL, &gain, NULL};
    RITZ_OWN(rig) r = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    ritz_loop_stability stability = {0};

    (void)state;
    assert_ok(spaces_make(&integrator, &r.plant));
    assert_ok(spaces_make(&gains, &r.controller));
    r.subject = ritz_model_of_states(&r.plant);
    join(false, &r);
    ask(10.0, 0.1, &r);
    assert_ok(
        ritz_controlled_examine(r.subject, &r.request, &r.way, &stability));
    assert_near(stability.radius, 0.7, 4.0 * DBL_EPSILON);
    assert_near(stability.limit, 2.0 / 3.0, 1e-4 * 2.0 / 3.0);
    assert_int_equal(stability.loop.verdict, RITZ_STABLE);
    r.request.step = 0.7;
    assert_fails(
        ritz_simulate_controlled(r.subject, &r.request, &r.way, NULL, &s),
        RITZ_ERR_ARGUMENT, "s up, 0.66");
    r.way.any_step = true;
    simulate(&r, &s);
    assert_near(s.y[1], 0.7, 1e-14);
    assert_near(s.y[2] - 1.0 / 3.0, -1.1 * (s.y[1] - 1.0 / 3.0), 1e-14);
}

/* x' = r - 3 x(t - 1): unstable as 3 > pi / 2, at whatever step. */
static void a_delay_that_makes_a_loop_unstable_is_named(void **state)
{
    static const double zero = 0.0, one = 1.0, gain = 3.0;
    static const spaces_rows integrator = {1,    1,    1,    &zero,
                                           &one, &one, NULL, NULL};
    static const spaces_rows gains = {0, 1, 1, NULL, NULL, NULL, &gain, NULL};
    RITZ_OWN(rig) r = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    ritz_loop_stability stability = {0};

    (void)state;
    assert_ok(spaces_make(&integrator, &r.plant));
    assert_ok(spaces_make(&gains, &r.controller));
    r.subject = ritz_model_of_states(&r.plant);
    join(false, &r);
    ask(10.0, 0.1, &r);
    r.way.delay = 1.0;
    r.way.any_step = true;
    assert_ok(
        ritz_controlled_examine(r.subject, &r.request, &r.way, &stability));
    assert_true(stability.unstable_by_delay && isnan(stability.limit));
    assert_fails(
        ritz_simulate_controlled(r.subject, &r.request, &r.way, NULL, &s),
        RITZ_ERR_ARGUMENT, "unstable with its delay of 1 s");
    r.way.delay = 0.4; /* 1.2 < pi / 2 */
    assert_ok(
        ritz_controlled_examine(r.subject, &r.request, &r.way, &stability));
    assert_false(stability.unstable_by_delay || stability.grows);
    r.way.delay = r.request.step = 0.4; /* held for half a step besides */
    assert_ok(
        ritz_controlled_examine(r.subject, &r.request, &r.way, &stability));
    assert_true(stability.grows && !stability.unstable_by_delay);
}

/* The three masses: found by bisection in NumPy on the same map. */
static void the_limit_of_three_masses_is_that_of_their_map(void **state)
{
    RITZ_OWN(rig) r = {0};
    ritz_loop_stability stability = {0};

    (void)state;
    derivative(1.0, false, &r);
    assert_ok(
        ritz_controlled_examine(r.subject, &r.request, &r.way, &stability));
    assert_near(stability.radius, 0.999315815268471, 1e-13);
    assert_near(stability.limit, 0.5193733195648383, 1e-4 * 0.52);
    for (int k = 1; k <= 2; k++) { /* 2 s is stable again */
        r.request.step = k;
        assert_ok(
            ritz_controlled_examine(r.subject, &r.request, &r.way, &stability));
        assert_true(stability.grows == (k == 1));
        assert_near(stability.limit, 0.5193733195648383, 1e-4 * 0.52);
        assert_true(stability.from > 0.0 && stability.from < 0.05);
    }
}

/* q'' - 0.02 q' + 1.5 q = 0.5 q with the right side held: holding delays it by
   h / 2, which acts as a damping of 0.25 h q'. Radii by NumPy. */
static void a_split_that_hides_an_unstable_loop_is_named(void **state)
{
    static const double m = 1.0, k = 1.5, c = -0.02, gain = 0.5;
    static const spaces_rows gains = {0, 1, 1, NULL, NULL, NULL, &gain, NULL};
    RITZ_OWN(rig) r = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    ritz_loop_stability stability = {0};

    (void)state;
    assert_ok(motions_row(1, &m, &k, &c, &r.row));
    r.subject = r.row.dense;
    assert_ok(spaces_make(&gains, &r.controller));
    join(true, &r);
    ask(10.0, 0.1, &r);
    assert_ok(
        ritz_controlled_examine(r.subject, &r.request, &r.way, &stability));
    assert_true(stability.known && stability.hides_instability &&
                isnan(stability.limit));
    assert_near(stability.loop.pole[0], 0.01, 1e-14);
    assert_near(stability.radius, 1.0 - 0.00024913469006393463, 1e-13);
    assert_fails(
        ritz_simulate_controlled(r.subject, &r.request, &r.way, NULL, &s),
        RITZ_ERR_ARGUMENT, "a step of 0.1 s would hide that");
    r.request.step = 0.05;
    assert_fails(
        ritz_simulate_controlled(r.subject, &r.request, &r.way, NULL, &s),
        RITZ_ERR_ARGUMENT, "it grows without bound");
    r.way.force = true;
    simulate(&r, &s);
}

/* A mode of w = 50 rad/s with a damping of -0.01 at w h = 2.5.
   Generalised-alpha dissipates more energy than the loop supplies and hides the
   instability; the trapezoidal rule dissipates nothing and shows it. */
static void a_dissipative_integrator_that_hides_it_is_named(void **state)
{
    static const double m = 1.0, k = 2500.0, c = -1.0, gain = 1.0;
    static const spaces_rows gains = {0, 1, 1, NULL, NULL, NULL, &gain, NULL};
    RITZ_OWN(rig) r = {0};
    ritz_loop_stability stability = {0};

    (void)state;
    assert_ok(motions_row(1, &m, &k, &c, &r.row));
    r.subject = r.row.dense;
    assert_ok(spaces_make(&gains, &r.controller));
    join(false, &r);
    ask(10.0, 0.05, &r);
    r.request.integrator = &ritz_integrator_generalised_alpha;
    r.request.rho = 0.5;
    assert_ok(
        ritz_controlled_examine(r.subject, &r.request, &r.way, &stability));
    assert_true(stability.hides_instability);
    refuse(&r, "a step of 0.05 s would hide that");
    r.request.integrator = &ritz_integrator_trapezoidal;
    assert_ok(
        ritz_controlled_examine(r.subject, &r.request, &r.way, &stability));
    assert_false(stability.hides_instability);
}

/* 90 masses have more than 180 states, so that the radius is estimated from the
   growth of a vector. NumPy's radius is 1.0428774. */
static void a_large_map_is_judged_by_the_growth_of_a_vector(void **state)
{
    enum { N = 90 };
    double m[N], k[N], c[N], gain = 100.0;
    const spaces_rows gains = {0, 1, 1, NULL, NULL, NULL, &gain, NULL};
    RITZ_OWN(rig) r = {0};
    ritz_loop_stability stability = {0};

    (void)state;
    for (int j = 0; j < N; j++) {
        m[j] = 1.0;
        k[j] = 100.0;
        c[j] = 0.1;
    }
    assert_ok(motions_row(N, m, k, c, &r.row));
    r.subject = r.row.dense;
    assert_ok(spaces_make(&gains, &r.controller));
    join(false, &r);
    ask(0.5, 0.5, &r);
    assert_ok(
        ritz_controlled_examine(r.subject, &r.request, &r.way, &stability));
    assert_true(stability.estimated && stability.grows);
    assert_near(stability.radius, 1.04287742715657483,
                2e-3); /* measured: 1e-3 */
    r.request.seconds = r.request.step = 0.01;
    *ritz_dense_col(&r.controller.D, 0) = 0.05;
    assert_ok(
        ritz_controlled_examine(r.subject, &r.request, &r.way, &stability));
    assert_false(stability.grows);
}

static bool stop_once(void *context)
{
    int *left = context;

    return (*left)-- == 0;
}

/* A run is ended between two samples and continued, with the same bits. */
static void a_loop_continues_bit_for_bit(void **state)
{
    static const struct {
        bool exact;
        double sample, delay;
        const ritz_integrator *by;
    } ways[] = {{true, 0.0, 0.0, &ritz_integrator_modal},
                {false, 0.0, 0.0, &ritz_integrator_generalised_alpha},
                {false, 0.05, 0.13, &ritz_integrator_modal}};

    (void)state;
    for (int k = 0; k < 3; k++) {
        int left = 43;
        RITZ_OWN(rig) r = {0};
        RITZ_OWN(ritz_simulation) whole = {0}, part = {0}, rest = {0};

        derivative(1.0, false, &r);
        r.way.exact = ways[k].exact;
        r.way.sample = ways[k].sample;
        r.way.delay = ways[k].delay;
        r.request.integrator = ways[k].by;
        simulate(&r, &whole);
        r.request.stop = stop_once;
        r.request.context = &left;
        simulate(&r, &part);
        assert_int_equal(part.count, 44);
        left = -1;
        r.request.from = &part;
        simulate(&r, &rest);
        assert_int_equal(rest.count, 101);
        assert_memory_equal(whole.y, rest.y, 101 * sizeof *rest.y);
        assert_memory_equal(whole.work, rest.work, 101 * sizeof *rest.y);
        assert_memory_equal(whole.diagnosis, rest.diagnosis,
                            101 * (size_t)rest.num_diagnostics *
                                sizeof *rest.y);
    }
}

static void steps_divide_sample_and_delay(void **state)
{
    ritz_controlled way = {.sample = 0.1, .delay = 0.03};
    double step = 0.0;

    (void)state;
    assert_ok(ritz_controlled_step(&way, 0.03, &step));
    assert_near(step, 0.01, 1e-17);
    way.delay = 0.25;
    assert_ok(ritz_controlled_step(&way, 0.03, &step));
    assert_near(step, 0.025, 1e-17);
    way = (ritz_controlled){.delay = 0.1};
    assert_ok(ritz_controlled_step(&way, 0.03, &step));
    assert_near(step, 0.025, 1e-17);
    way = (ritz_controlled){0};
    assert_ok(ritz_controlled_step(&way, 0.03, &step));
    assert_near(step, 0.03, 0.0);
    way = (ritz_controlled){.sample = 1.0, .delay = 0.70710678118654752};
    assert_fails(ritz_controlled_step(&way, 1.0, &step), RITZ_ERR_ARGUMENT,
                 "no step of at least 0.001 s divides");
}

static void loops_that_cannot_be_run_are_refused(void **state)
{
    RITZ_OWN(rig) r = {0};

    (void)state;
    derivative(1.0, false, &r);
    r.way.discrete = true;
    refuse(&r, "needs the time between two samples");
    r.way.sample = 0.055;
    refuse(&r, "a sample every 0.055 s is no multiple of a step of 0.01 s");
    r.way.sample = 0.05;
    r.way.delay = 0.013;
    refuse(&r, "a delay of 0.013 s is no multiple");
    r.request.integrator = &ritz_integrator_trapezoidal;
    refuse(&r, "needs an exact integrator, modal, not trapezoidal");
    r.request.integrator = &ritz_integrator_modal;
    r.way.exact = true;
    refuse(&r, "needs a continuous controller without a delay");
    r.way = (ritz_controlled){.controller = &r.controller, .loop = &r.loop};
    r.loop.measured[0] = 7;
    refuse(&r, "the plant has no output 8");
    r.loop.measured[0] = 0;
    r.loop.positive = true;
    refuse(&r, "the loop is unstable, pole at +0.025145");
    r.way.sample = 0.05;
    refuse(&r, "the sampled loop is unstable, 1.00");
}

/* y = x + u, v = -y: y has no solution. */
static void a_singular_loop_of_feedthroughs_is_refused(void **state)
{
    static const double zero = 0.0, one = 1.0, gain = -1.0;
    static const spaces_rows plant = {1, 1, 1, &zero, &one, &one, &one, NULL};
    static const spaces_rows gains = {0, 1, 1, NULL, NULL, NULL, &gain, NULL};
    static const bool exact[] = {true, false};

    (void)state;
    for (int k = 0; k < 2; k++) {
        const ritz_loop_stability stability = {0};
        RITZ_OWN(rig) r = {0};
        RITZ_OWN(ritz_simulation) s = {0};

        assert_ok(spaces_make(&plant, &r.plant));
        assert_ok(spaces_make(&gains, &r.controller));
        r.subject = ritz_model_of_states(&r.plant);
        join(false, &r);
        ask(1.0, 0.1, &r);
        r.way.exact = exact[k];
        assert_fails(ritz_simulate_controlled(r.subject, &r.request, &r.way,
                                              &stability, &s),
                     RITZ_ERR_SINGULAR, "form a loop that has no solution");
    }
}

static void a_loop_too_large_for_one_exponential_is_refused(void **state)
{
    enum { N = RITZ_LOOP_EXACT };
    static const double A[N * N] = {-1.0}, B[N] = {1.0};
    static const spaces_rows plant = {N, 1, 1, A, B, B, NULL, NULL};
    const ritz_loop_stability stability = {0};
    RITZ_OWN(rig) r = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    assert_ok(spaces_make(&plant, &r.plant));
    r.subject = ritz_model_of_states(&r.plant);
    controller(-1.0, 1.0, 1e-3, 0.0, &r);
    join(false, &r);
    ask(1.0, 0.1, &r);
    r.way.exact = true;
    assert_fails(
        ritz_simulate_controlled(r.subject, &r.request, &r.way, &stability, &s),
        RITZ_ERR_ARGUMENT,
        "a closed loop of 401 states is too large for one "
        "exponential, which takes 400: use split");
}

static void an_impulse_that_is_measured_is_refused(void **state)
{
    static const ritz_signal impulse = {.kind = RITZ_SIGNAL_IMPULSE,
                                        .amplitude = 1.0};
    RITZ_OWN(rig) r = {0};

    (void)state;
    feedthrough(&r);
    r.request.signal = &impulse;
    refuse(&r, "too, which the controller measures");
}

static ritz_status run_all(const rig *r, bool exact)
{
    ritz_controlled way = r->way;
    RITZ_OWN(ritz_simulation) s = {0};

    way.exact = exact;
    way.delay = exact ? 0.0 : 0.03;
    return ritz_simulate_controlled(r->subject, &r->request, &way, NULL, &s);
}

static void closed_loops_survive_every_failing_allocation(void **state)
{
    RITZ_OWN(rig) r = {0};

    (void)state;
    derivative(1.0, false, &r);
    r.request.seconds = 0.05;
    assert_survives_every_allocation(run_all(&r, true));
    assert_survives_every_allocation(run_all(&r, false));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(one_exponential_agrees_with_scipy),
    cmocka_unit_test(a_sampled_controller_agrees_with_scipy),
    cmocka_unit_test(a_discrete_controller_is_taken_as_it_is),
    cmocka_unit_test(a_mass_under_two_gains_moves_as_an_oscillator),
    cmocka_unit_test(a_sampled_mass_moves_by_its_difference_equation),
    cmocka_unit_test(a_split_loop_converges_at_first_order),
    cmocka_unit_test(any_integrator_moves_the_plant),
    cmocka_unit_test(the_limit_of_an_integrator_is_two_over_its_gain),
    cmocka_unit_test(a_delay_that_makes_a_loop_unstable_is_named),
    cmocka_unit_test(the_limit_of_three_masses_is_that_of_their_map),
    cmocka_unit_test(a_split_that_hides_an_unstable_loop_is_named),
    cmocka_unit_test(a_dissipative_integrator_that_hides_it_is_named),
    cmocka_unit_test(a_large_map_is_judged_by_the_growth_of_a_vector),
    cmocka_unit_test(a_loop_continues_bit_for_bit),
    cmocka_unit_test(steps_divide_sample_and_delay),
    cmocka_unit_test(loops_that_cannot_be_run_are_refused),
    cmocka_unit_test(a_singular_loop_of_feedthroughs_is_refused),
    cmocka_unit_test(a_loop_too_large_for_one_exponential_is_refused),
    cmocka_unit_test(an_impulse_that_is_measured_is_refused),
    cmocka_unit_test(closed_loops_survive_every_failing_allocation),
};

TEST_MODULE(simulate_controlled, tests, NULL, NULL)
