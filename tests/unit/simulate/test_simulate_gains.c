/*
 * Parameters of stabilisations that are not given: closed forms, the order in
 * the step that a run with them has, and steps for which there are none.
 */
#include "testing.h"

#include "joined.h"
#include "motions.h"

#include <stdio.h>

static const ritz_integrator *const all[] = {
    &ritz_integrator_trapezoidal, &ritz_integrator_generalised_alpha,
    &ritz_integrator_central_difference};

/* A start that violates the first row: c_0 = 0.01, c'_0 = 0.3. */
static const double off_x[] = {0.0, 0.0, 0.01, 0.0, 0.0};
static const double off_v[] = {0.0, 0.0, 0.0, -0.3, 0.0};

static ritz_simulation_request asking(const ritz_integrator *integrator,
                                      double step)
{
    ritz_simulation_request request = RITZ_SIMULATION_NONE;

    request.integrator = integrator;
    request.seconds = 0.25;
    request.step = step;
    request.rho = 0.5;
    request.signal = &motions_step;
    return request;
}

/* Simulate, and give the parameters that were used. */
static ritz_status run(const joined *j, const char *text,
                       const ritz_simulation_request *request,
                       double gain[RITZ_MOST_GAINS], ritz_simulation *out)
{
    ritz_constrained_request how = {0};
    RITZ_OWN(ritz_constrained_facts) facts = {0};

    assert_ok(ritz_constrained_parse(text, &how));
    RITZ_CHECK(
        ritz_simulate_constrained(&j->bodies, &how, request, &facts, out));
    for (int k = 0; k < RITZ_MOST_GAINS; k++)
        gain[k] = facts.gain[k];
    return RITZ_OK;
}

/* The force on the fifth mass accelerates it by 1 / 2.5, and c of the second
   row by half of that, for which C M^-1 C' is 1 / 2 + 0.5^2 / 2.5 = 0.6. */
static void smax_damps_the_springs_that_are_used_critically(void **state)
{
    static const double hz[] = {5.0, 20.0};
    const double force = 0.5 / 2.5 / sqrt(0.6);
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (int k = 0; k < 4; k++) {
        const double w = 2.0 * 3.14159265358979323846 * hz[k % 2];
        const ritz_simulation_request request =
            asking(all[0], k < 2 ? 1e-2 : 1e-3);
        double gain[RITZ_MOST_GAINS];
        char text[32];
        RITZ_OWN(ritz_simulation) s = {0};

        (void)snprintf(text, sizeof text, "hybrid:hz=%g", hz[k % 2]);
        assert_ok(run(&j, text, &request, gain, &s));
        assert_near(gain[2], force / (2.0 * w * w), 1e-12 * gain[2]);
    }
}

/* A parameter that is given decides about those that are not. */
static void parameters_follow_those_that_are_given(void **state)
{
    static const struct {
        const char *text;
        double gain[RITZ_MOST_GAINS];
        int count;
    } known[] = {
        {"baumgarte", {1e3, 1e3}, 2},
        {"baumgarte:alpha=8", {8.0, 8.0}, 2},
        {"baumgarte:beta=8", {8.0, 8.0}, 2},
        {"baumgarte:alpha=2,beta=8", {2.0, 8.0}, 2},
        {"sliding-mode:surface=4,switch=3", {4.0, 3.0, 3e-3}, 3},
        {"sliding-mode:switch=3,layer=2", {500.0, 3.0, 2.0}, 3},
        {"penalty:hz=5", {5.0, 1.0, 0.0}, 3},
        {"penalty:ratio=2,inertia=3",
         {500.0 / 3.14159265358979323846, 2.0, 3.0},
         3},
    };
    ritz_simulation_request request = asking(all[0], 1e-3);
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    request.x0 = off_x;
    request.v0 = off_v;
    for (size_t m = 0; m < sizeof known / sizeof *known; m++) {
        double gain[RITZ_MOST_GAINS];
        RITZ_OWN(ritz_simulation) s = {0};

        assert_ok(run(&j, known[m].text, &request, gain, &s));
        for (int k = 0; k < known[m].count; k++)
            assert_near(gain[k], known[m].gain[k], 1e-12 * known[m].gain[k]);
    }
}

/* S_0 = |c'_0 + surface c_0| / |row| with the surface that is used. */
static void switch_ends_the_surface_of_the_start_in_ten_steps(void **state)
{
    static const char *const names[] = {"sliding-mode:surface=4",
                                        "sliding-mode"};
    static const double surface[] = {4.0, 500.0};
    const double length = sqrt(1.0 / 1.5 + 1.0), h = 1e-3;
    ritz_simulation_request request = asking(all[0], h);
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    request.x0 = off_x;
    request.v0 = off_v;
    for (int k = 0; k < 2; k++) {
        const double want = (0.3 + surface[k] * 0.01) / length / (10.0 * h);
        double gain[RITZ_MOST_GAINS];
        RITZ_OWN(ritz_simulation) s = {0};

        assert_ok(run(&j, names[k], &request, gain, &s));
        assert_near(gain[1], want, 1e-12 * want);
        assert_near(gain[2], want * h, 1e-12 * want * h);
    }
}

/* The error falls to a quarter each time the step is halved, four times. The
   motion does not change with the step if all that follows from it is given. */
static void with_given_frequencies_runs_are_of_second_order(void **state)
{
    enum { HALVINGS = 4, LAST = HALVINGS + 2 };
    static const char *const names[] = {
        "hybrid:hz=5", "penalty:hz=5", "baumgarte:alpha=8", "baumgarte:beta=8"};
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (int m = 0; m < 12; m++) {
        const char *name = names[m / 3];
        double y[LAST], gain[RITZ_MOST_GAINS];

        for (int k = 0; k < LAST; k++) {
            ritz_simulation_request request =
                asking(all[m % 3], 0.005 / (double)(1 << k));
            RITZ_OWN(ritz_simulation) s = {0};

            request.x0 = m / 3 > 1 ? off_x : NULL;
            assert_ok(run(&j, name, &request, gain, &s));
            y[k] = s.y[(s.count - 1) * s.num_outputs];
        }
        for (int k = 0; k < HALVINGS; k++) {
            const double ratio = (y[k] - y[k + 1]) / (y[k + 1] - y[k + 2]);

            if (!(ratio > 3.5 && ratio < 4.6))
                fail_msg("%s by %s: %g", name, all[m % 3]->name, ratio);
        }
    }
}

/* Default parameters give a stable run at every step for which they exist. */
static void default_parameters_fit_the_step(void **state)
{
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (const ritz_stabilisation *const *m = ritz_stabilisations; *m; m++)
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 4; k++) {
                const double h = 0.1 * pow(0.25, k);
                ritz_simulation_request request = asking(all[i], h);
                double gain[RITZ_MOST_GAINS];
                RITZ_OWN(ritz_simulation) s = {0};

                request.x0 = off_x;
                request.seconds = 300.0 * h;
                assert_ok(run(&j, (*m)->name, &request, gain, &s));
                assert_true(s.diagnosis[(s.count - 1) * s.num_diagnostics] <
                            0.05);
            }
}

static void without_a_stable_default_a_run_is_refused(void **state)
{
    static const char *const names[] = {"baumgarte:beta=1", "baumgarte:alpha=1",
                                        "penalty:hz=0.1", "hybrid:hz=0.1"};
    const ritz_simulation_request request =
        asking(&ritz_integrator_central_difference, 0.14);
    double gain[RITZ_MOST_GAINS];
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    assert_fails(run(&j, "baumgarte", &request, gain, &s), RITZ_ERR_ARGUMENT,
                 "leaves 'alpha' of baumgarte no room at a step of 0.14 s");
    assert_fails(run(&j, "hybrid", &request, gain, &s), RITZ_ERR_ARGUMENT,
                 "leaves 'hz' of hybrid no room at a step of 0.14 s");
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        ritz_simulation_free(&s);
        assert_ok(run(&j, names[k], &request, gain, &s));
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(smax_damps_the_springs_that_are_used_critically),
    cmocka_unit_test(parameters_follow_those_that_are_given),
    cmocka_unit_test(switch_ends_the_surface_of_the_start_in_ten_steps),
    cmocka_unit_test(with_given_frequencies_runs_are_of_second_order),
    cmocka_unit_test(default_parameters_fit_the_step),
    cmocka_unit_test(without_a_stable_default_a_run_is_refused),
};

TEST_MODULE(simulate_gains, tests, NULL, NULL)
