/*
 * Joined bodies against the eliminated system: numbers of an independent
 * program (matrix exponential, SciPy), convergence, closed forms of violations,
 * energies, and what is refused.
 */
#include "testing.h"

#include "joined.h"
#include "linear/general.h"
#include "motions.h"

#include <float.h>
#include <stdio.h>

enum { VIOLATION, RATE, MULTIPLIER, DIAGNOSTICS };

static ritz_constrained_request holding(const char *text)
{
    ritz_constrained_request how = {0};

    assert_ok(ritz_constrained_parse(text, &how));
    return how;
}

static ritz_simulation_request asking(const ritz_integrator *integrator,
                                      double step)
{
    ritz_simulation_request request = RITZ_SIMULATION_NONE;

    request.integrator = integrator;
    request.seconds = 2.0;
    request.step = step;
    request.signal = &motions_step;
    return request;
}

static ritz_status run(const joined *j, const char *text,
                       const ritz_simulation_request *request,
                       ritz_simulation *out)
{
    const ritz_constrained_request how = holding(text);

    return ritz_simulate_constrained(&j->bodies, &how, request, NULL, out);
}

static double last_diagnosis(const ritz_simulation *s, int which)
{
    return s->diagnosis[(s->count - 1) * DIAGNOSTICS + which];
}

static double most_diagnosis(const ritz_simulation *s, int which)
{
    double most = 0.0;

    for (int64_t k = 0; k < s->count; k++)
        most = fmax(most, s->diagnosis[k * DIAGNOSTICS + which]);
    return most;
}

/* Largest difference of outputs at the times of the coarser run, relative to
   the largest values of the finer one. */
static double find_difference(const ritz_simulation *coarse,
                              const ritz_simulation *fine)
{
    const int64_t times = (fine->count - 1) / (coarse->count - 1);
    double worst = 0.0;

    for (int64_t i = 0; i < coarse->num_outputs; i++) {
        double size = 0.0, off = 0.0;

        for (int64_t k = 0; k < coarse->count; k++) {
            const double y = fine->y[k * times * fine->num_outputs + i];

            size = fmax(size, fabs(y));
            off = fmax(off, fabs(coarse->y[k * coarse->num_outputs + i] - y));
        }
        worst = fmax(worst, off / size);
    }
    return worst;
}

/* Methods with multipliers, at a step so small that its error is below the
   bound; the order of that error is measured below. */
static void outputs_are_those_of_the_eliminated_system(void **state)
{
    /* SciPy's expm of the eliminated system: at 0.5 s, 2 s */
    static const double want[2][3] = {
        {4.836588567831849e-03, 8.609165189554535e-02, 1.080375455603823e-01},
        {1.680830281834361e-02, -7.802044461801852e-02,
         -1.355960691740359e-01}};
    static const double multiplier[2] = {5.295053351129588e-01,
                                         1.647351879846509e+00};
    static const char *const names[] = {"none", "baumgarte:alpha=20,beta=20",
                                        "sliding-mode", "projection",
                                        "index-2"};
    const ritz_simulation_request request =
        asking(&ritz_integrator_trapezoidal, 1e-3);
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (size_t m = 0; m < sizeof names / sizeof *names; m++) {
        RITZ_OWN(ritz_simulation) s = {0};

        assert_ok(run(&j, names[m], &request, &s));
        assert_string_equal(s.output[2], "shake");
        for (int t = 0; t < 2; t++) {
            const int64_t at = t == 0 ? 500 : 2000;

            /* (w h)^2 / 12 of w = 12 is 1e-5, of a phase of 24 */
            for (int i = 0; i < 3; i++)
                assert_near(s.y[at * 3 + i], want[t][i], 3e-5);
            assert_near(s.diagnosis[at * DIAGNOSTICS + MULTIPLIER],
                        multiplier[t], 3e-5);
        }
        /* 2 000 steps, each of a rounding of the place, 0.05 */
        assert_true(most_diagnosis(&s, VIOLATION) < 2000 * 0.05 * DBL_EPSILON);
    }
}

/* A start that violates the first row: c_0 = 0.01, c'_0 = 0.3. */
static const double off_x[] = {0.0, 0.0, 0.01, 0.0, 0.0};
static const double off_v[] = {0.0, 0.0, 0.0, -0.3, 0.0};

/* The error falls to a quarter each time the step is halved, four times from
   one that resolves the springs of a penalty; with @p off from that start. */
static void assert_order(const joined *j, const char *text,
                         const ritz_integrator *integrator, bool off,
                         const ritz_simulation *exact)
{
    enum { HALVINGS = 4 };
    ritz_simulation made[HALVINGS + 2] = {0};
    double last = 0.0;

    for (int k = 0; k < HALVINGS + 2; k++) {
        ritz_simulation_request request =
            asking(integrator, 0.01 / (double)(1 << k));

        request.rho = 0.5;
        request.seconds = 0.25;
        request.x0 = off ? off_x : NULL;
        request.v0 = off ? off_v : NULL;
        assert_ok(run(j, text, &request, &made[k]));
    }
    for (int k = 0; k <= HALVINGS; k++) {
        const double error =
            find_difference(&made[k], exact ? exact : &made[k + 1]);

        /* 4 but for terms of higher order, which are h omega = 0.12 of it */
        if (k > 0 && !(last / error > 3.5 && last / error < 4.6))
            fail_msg("%s by %s: errors %.3e, %.3e", text, integrator->name,
                     last, error);
        last = error;
    }
    for (int k = 0; k < HALVINGS + 2; k++)
        ritz_simulation_free(&made[k]);
}

static const ritz_integrator *const all[] = {
    &ritz_integrator_trapezoidal, &ritz_integrator_generalised_alpha,
    &ritz_integrator_central_difference};

static void multipliers_converge_at_second_order(void **state)
{
    static const char *const names[] = {
        "none", "baumgarte:alpha=10,beta=10",
        "sliding-mode:surface=5,switch=1,layer=0.1", "projection", "index-2"};
    ritz_simulation_request request =
        asking(&ritz_integrator_modal, 0.01 / 32.0);
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_simulation) exact = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    request.seconds = 0.25;
    assert_ok(ritz_simulate(j.eliminated, &request, &exact));
    for (size_t m = 0; m < sizeof names / sizeof *names; m++)
        for (int i = 0; i < (m < 4 ? 3 : 1); i++)
            assert_order(&j, names[m], all[i], false, &exact);
}

static void penalties_converge_at_second_order(void **state)
{
    static const char *const names[] = {"penalty:hz=5,ratio=0.7",
                                        "penalty:hz=5,ratio=0.7,inertia=2",
                                        "hybrid:hz=5,surface=1,smax=0.01"};
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (size_t m = 0; m < sizeof names / sizeof *names; m++)
        for (int i = 0; i < 3; i++)
            assert_order(&j, names[m], all[i], false, NULL);
}

/* [McDaniel2000, figure 4.3]. The violation of a stiff spring is f / k, and f
   itself depends on the spring by as much. */
static void ten_times_the_stiffness_gives_a_tenth_of_the_violation(void **state)
{
    ritz_simulation_request request =
        asking(&ritz_integrator_trapezoidal, 2e-4);
    double last = 0.0;
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (int k = 0; k < 4; k++) {
        char text[64];
        double most = 0.0;
        RITZ_OWN(ritz_simulation) s = {0};

        (void)snprintf(text, sizeof text, "penalty:hz=%.17g,ratio=1",
                       15.0 * pow(10.0, 0.5 * k));
        assert_ok(run(&j, text, &request, &s));
        most = most_diagnosis(&s, VIOLATION);
        if (k > 0) /* (w / w_penalty)^2 = (12 / 94)^2 of the softest */
            assert_near(last / most, 10.0, 10.0 * 0.02);
        last = most;
    }
}

/* Violation of the springs at rest under a constant force; numbers by SciPy. */
static void a_static_violation_is_that_of_the_springs(void **state)
{
    ritz_simulation_request request = asking(&ritz_integrator_modal, 0.05);
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    assert_ok(joined_new(false, &j));
    assert_ok(ritz_dense_new(5, 5, &j.bodies.D));
    for (int k = 0; k < 5; k++) /* all motion decays as exp(-t) or faster */
        ritz_dense_col(&j.bodies.D, k)[k] =
            4.0 * ritz_dense_col(&j.bodies.M, k)[k];
    request.seconds = 40.0;
    assert_ok(run(&j, "penalty:hz=20", &request, &s));
    assert_near(last_diagnosis(&s, VIOLATION), 1.06835523e-04, 1e-12);
}

static void a_violation_without_stabilisation_grows_with_time(void **state)
{
    ritz_simulation_request request =
        asking(&ritz_integrator_central_difference, 1e-3);
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    request.x0 = off_x;
    request.v0 = off_v;
    assert_ok(run(&j, "none", &request, &s));
    for (int64_t k = 0; k < s.count; k++) /* each step rounds what it adds */
        assert_near(s.diagnosis[k * DIAGNOSTICS], 0.01 + 0.3 * s.seconds[k],
                    (double)(k + 8) * 0.61 * DBL_EPSILON);
}

/* c = (c_0 + (c'_0 + beta c_0) t) exp(-beta t) for alpha = beta. It holds for
   each row, as rows are linear combinations of the constraints. */
static void baumgarte_ends_a_violation_by_its_closed_form(void **state)
{
    ritz_simulation_request request =
        asking(&ritz_integrator_trapezoidal, 5e-4);
    const double beta = 8.0;
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    request.x0 = off_x;
    request.v0 = off_v;
    assert_ok(run(&j, "baumgarte:alpha=8,beta=8", &request, &s));
    for (int64_t k = 0; k < s.count; k++) {
        const double t = s.seconds[k];
        const double c = (0.01 + (0.3 + beta * 0.01) * t) * exp(-beta * t);

        /* second order: (beta h)^2 / 12 of 0.05, over some time constants */
        assert_near(s.diagnosis[k * DIAGNOSTICS], fabs(c), 5e-7);
    }
}

/* |S| falls by at least `switch` a second, and then stays within the layer.
   Here S is that of a row, which is `length` = |row| in M^-1 times as large. */
static void a_sliding_mode_reaches_its_surface_in_time(void **state)
{
    static const double layers[] = {0.05, 1e-2, 1e-7};
    const double length = sqrt(1.0 / 1.5 + 1.0);
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (int m = 0; m < 3; m++) {
        const double h = 1e-3, change = 2.0, surface = 4.0;
        ritz_simulation_request request =
            asking(&ritz_integrator_trapezoidal, h);
        double bound = fmax(layers[m], change * h) * length;
        char text[96];
        RITZ_OWN(ritz_simulation) s = {0};

        request.x0 = off_x;
        request.v0 = off_v;
        (void)snprintf(text, sizeof text,
                       "sliding-mode:surface=%g,switch=%g,layer=%g", surface,
                       change, layers[m]);
        assert_ok(run(&j, text, &request, &s));
        for (int64_t k = 0; k < s.count; k++) {
            const double c = s.diagnosis[k * DIAGNOSTICS + VIOLATION];
            const double rate = s.diagnosis[k * DIAGNOSTICS + RATE];

            /* S_0 = 0.34 / 1.29; then c' has the sign of -c */
            if (s.seconds[k] > 0.34 / length / change)
                assert_true(fabs(rate - surface * c) < bound + 1e-12 ||
                            rate + surface * c < bound + 1e-12);
        }
        assert_true(last_diagnosis(&s, VIOLATION) < 0.01 * 0.05 + bound);
    }
}

/* x -= M^-1 C'(C M^-1 C')^-1 C x: the nearest values in M, with C x = 0. They
   are P x = T (T'M T)^-1 T'M x, whose second factor is y. */
static void project_by_hand(const joined *j, const double *x, double y[3])
{
    ritz_dense right = {3, 1, y};
    RITZ_OWN(ritz_dense) MT = {0};

    assert_ok(ritz_dense_mul(&j->bodies.M, &j->T, &MT));
    for (int64_t k = 0; k < 3; k++) {
        y[k] = 0.0;
        for (int64_t i = 0; i < 5; i++)
            y[k] += ritz_dense_col(&MT, k)[i] * x[i];
    }
    assert_ok(ritz_general_solve(&j->M, false, &right));
}

/* |x - T y| / |x| in M */
static double moved_part(const joined *j, const double *x, const double y[3])
{
    double cut = 0.0, whole = 0.0;

    for (int64_t i = 0; i < 5; i++) {
        const double mass = ritz_dense_col(&j->bodies.M, i)[i];
        double off = x[i];

        for (int64_t k = 0; k < 3; k++)
            off -= ritz_dense_col(&j->T, k)[i] * y[k];
        cut += mass * off * off;
        whole += mass * x[i] * x[i];
    }
    return sqrt(cut / whole);
}

static void projection_and_index_2_begin_at_the_nearest_start(void **state)
{
    static const char *const names[] = {"projection", "index-2"};
    ritz_simulation_request request = asking(&ritz_integrator_modal, 1e-2);
    double y[3], rate[3];
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    project_by_hand(&j, off_x, y);
    project_by_hand(&j, off_v, rate);
    request.x0 = off_x;
    request.v0 = off_v;
    for (int m = 0; m < 2; m++) {
        const ritz_constrained_request how = holding(names[m]);
        RITZ_OWN(ritz_constrained_facts) facts = {0};
        RITZ_OWN(ritz_simulation) s = {0};

        assert_ok(
            ritz_simulate_constrained(&j.bodies, &how, &request, &facts, &s));
        assert_near(facts.moved, moved_part(&j, off_x, y), 1e-14);
        assert_near(facts.moved_rate, moved_part(&j, off_v, rate), 1e-14);
        assert_near(s.y[0], ritz_dense_col(&j.T, 0)[0] * y[0], 1e-16);
        for (int64_t k = 0; k < s.count; k++) { /* some eps of 0.3 and h / 4 */
            assert_near(s.diagnosis[k * DIAGNOSTICS + VIOLATION], 0.0, 1e-15);
            assert_near(s.diagnosis[k * DIAGNOSTICS + RATE], 0.0, 1e-14);
        }
    }
}

/* The error against the eliminated system from the nearest start. */
static void from_a_violated_start_both_are_of_second_order(void **state)
{
    ritz_simulation_request request =
        asking(&ritz_integrator_modal, 0.01 / 32.0);
    double y[3], rate[3];
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_simulation) exact = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    project_by_hand(&j, off_x, y);
    project_by_hand(&j, off_v, rate);
    request.seconds = 0.25;
    request.x0 = y;
    request.v0 = rate;
    assert_ok(ritz_simulate(j.eliminated, &request, &exact));
    for (int i = 0; i < 3; i++)
        assert_order(&j, "projection", all[i], true, &exact);
    assert_order(&j, "index-2", all[0], true, &exact);
}

/* Rounding of a start is no violation, and does not make stiff springs ring. */
static void a_start_that_is_rounded_is_not_moved(void **state)
{
    const ritz_constrained_request how = holding("projection");
    ritz_simulation_request request = asking(&ritz_integrator_modal, 1e-2);
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_constrained_facts) facts = {0};
    RITZ_OWN(ritz_simulation) s = {0}, stiff = {0};
    double x[5] = {0.0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (int64_t i = 0; i < 5; i++)
        for (int64_t k = 0; k < 3; k++)
            x[i] += ritz_dense_col(&j.T, k)[i] * (0.1 + 0.7 * (double)k);
    x[2] *= 1.0 + 4.0 * DBL_EPSILON;
    request.x0 = x;
    assert_ok(ritz_simulate_constrained(&j.bodies, &how, &request, &facts, &s));
    assert_true(facts.moved == 0.0 && facts.moved_rate == 0.0);
    assert_ok(run(&j, "penalty:hz=1e9", &request, &stiff));
    assert_true(last_diagnosis(&stiff, MULTIPLIER) <
                10.0 * most_diagnosis(&s, MULTIPLIER));
}

/* Stiffnesses of up to 1e61 times those of the bodies. The motion is that of
   multipliers, but for violations, whose rate is at most f / (m w): 6.4e-10 of
   the softest. The acceleration, the third output, includes forces that
   ring. */
static void stiff_penalties_lose_no_digits_of_the_motion(void **state)
{
    static const char *const names[] = {
        "penalty:hz=5,inertia=1e15",   "penalty:hz=1e8",
        "penalty:hz=1e9,ratio=0.3",    "penalty:hz=1e30",
        "penalty:hz=1e6,inertia=1e12", "hybrid:hz=1e9,smax=1"};
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (int m = 0; m < 6; m++)
        for (int i = 0; i < (m == 0 ? 3 : 2); i++) { /* explicit: the first */
            ritz_constrained_request how = holding(names[m]);
            ritz_simulation_request request = asking(all[i], 1e-2);
            RITZ_OWN(ritz_simulation) s = {0}, exact = {0};

            how.any_step = true; /* forces may be rounding */
            request.rho = 1.0;   /* less ends what rings, by its velocity */
            assert_ok(run(&j, "none", &request, &exact));
            assert_ok(
                ritz_simulate_constrained(&j.bodies, &how, &request, NULL, &s));
            for (int64_t k = 0; k < s.count; k++)
                for (int64_t y = 3 * k; y < 3 * k + 2; y++)
                    assert_near(s.y[y], exact.y[y], 7e-10);
        }
}

/* eps (w h)^2 / 4, and the frequencies at which it is 1e-3 and 1 */
static void
forces_of_stiff_springs_are_rounding_from_a_frequency_on(void **state)
{
    const ritz_simulation_request request =
        asking(&ritz_integrator_trapezoidal, 1e-2);
    ritz_constrained_request how = holding("penalty:hz=2.1e9,inertia=7");
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_constrained_facts) facts = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    assert_ok(ritz_simulate_constrained(&j.bodies, &how, &request, &facts, &s));
    assert_near(facts.force_rounding, 0.96645, 1e-4);
    ritz_simulation_free(&s);
    ritz_constrained_facts_free(&facts);
    how = holding("penalty:hz=2.2e9");
    assert_fails(
        ritz_simulate_constrained(&j.bodies, &how, &request, &facts, &s),
        RITZ_ERR_ARGUMENT, "to a thousandth up to 6.76e+07 Hz");
    how = holding("projection");
    assert_ok(ritz_simulate_constrained(&j.bodies, &how, &request, &facts, &s));
    assert_true(facts.force_rounding == 0.0);
}

/* With the trapezoidal rule energies balance to rounding, including those of
   the springs and dampers between bodies. With the other integrators they
   balance to second order: a tenth of the step gives a hundredth. */
static void energies_balance_as_those_of_the_integrator(void **state)
{
    static const char *const names[] = {"none",
                                        "baumgarte",
                                        "sliding-mode",
                                        "projection",
                                        "penalty:hz=20",
                                        "penalty:hz=20,inertia=1",
                                        "hybrid:hz=20,smax=0.001"};
    const ritz_simulation_request request =
        asking(&ritz_integrator_trapezoidal, 1e-3);
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (size_t m = 0; m < sizeof names / sizeof *names; m++) {
        RITZ_OWN(ritz_simulation) s = {0};
        double most = 0.0;

        assert_ok(run(&j, names[m], &request, &s));
        for (int64_t k = 0; k < s.count; k++)
            most = fmax(most, s.kinetic[k] + s.potential[k]);
        /* some eps of each step's sums, 8 for each */
        for (int64_t k = 0; k < s.count; k++)
            assert_near(s.balance[k], 0.0, 8 * 2000 * DBL_EPSILON * most);
    }
}

static void index_2_balances_energy_at_its_order(void **state)
{
    double last = 0.0;
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (int k = 0; k < 4; k++) {
        ritz_simulation_request request =
            asking(&ritz_integrator_modal, 0.01 / (double)(1 << k));
        double most = 0.0;
        RITZ_OWN(ritz_simulation) s = {0};

        assert_ok(run(&j, "index-2", &request, &s));
        for (int64_t i = 0; i < s.count; i++)
            most = fmax(most, fabs(s.balance[i]));
        if (k > 0)
            assert_near(last / most, 4.0, 0.4); /* (h omega)^2 and higher */
        last = most;
    }
}

/* With three copies of twice the first row the rank stays the same, and the
   copies share the force. */
static void redundant_rows_are_named_and_share_forces(void **state)
{
    const ritz_constrained_request how = holding("projection");
    const ritz_simulation_request request =
        asking(&ritz_integrator_modal, 1e-3);
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_constrained_facts) facts = {0};
    RITZ_OWN(ritz_simulation) alone = {0}, more = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    assert_ok(run(&j, "projection", &request, &alone));
    assert_ok(joined_repeat(3, 1.0, &j));
    assert_ok(
        ritz_simulate_constrained(&j.bodies, &how, &request, &facts, &more));
    assert_int_equal(facts.num_rows, 5);
    assert_int_equal(facts.rank, 2);
    assert_int_equal(facts.num_redundant, 3);
    for (int k = 0; k < 3; k++)
        assert_int_equal(facts.redundant[k], 2 + k);
    assert_near(find_difference(&more, &alone), 0.0, 1e-11);
    assert_near(last_diagnosis(&more, MULTIPLIER),
                0.25 * last_diagnosis(&alone, MULTIPLIER), 1e-11);
}

/* A row that differs from another by 1e-7 is a constraint of its own. Its
   multiplier is large, and the motion is as accurate as with other rows. */
static void nearly_dependent_rows_do_not_drift(void **state)
{
    const ritz_simulation_request request =
        asking(&ritz_integrator_trapezoidal, 1e-3);
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    assert_ok(joined_repeat(1, 1.0, &j));
    ritz_dense_col(&j.bodies.C, 0)[2] = 1e-7;
    assert_ok(run(&j, "none", &request, &s));
    assert_true(most_diagnosis(&s, VIOLATION) < 2000 * 0.05 * DBL_EPSILON);
    /* that constraint holds the first mass */
    assert_near(s.y[2000 * 3], 0.0, 2000 * 0.05 * DBL_EPSILON / 1e-7);
}

static void the_highest_frequency_is_reported(void **state)
{
    static const struct {
        const char *text;
        double hz;
    } known[] = {/* eigenvalues by SciPy; beta / 2 pi */
                 {"none", 1.96182712},
                 {"baumgarte:beta=50,alpha=1", 50.0 / (2.0 * 3.14159265358979)},
                 {"penalty:hz=20", 20.06099398},
                 {"penalty:hz=20,inertia=3", 20.01526595},
                 {"index-2", 1.96182712}};
    const ritz_simulation_request request =
        asking(&ritz_integrator_modal, 1e-2);
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        const ritz_constrained_request how = holding(known[k].text);
        RITZ_OWN(ritz_constrained_facts) facts = {0};
        RITZ_OWN(ritz_simulation) s = {0};

        assert_ok(
            ritz_simulate_constrained(&j.bodies, &how, &request, &facts, &s));
        assert_near(facts.highest_hz, known[k].hz, 1e-7);
        assert_near(facts.joined_hz, 1.96182712, 1e-7);
        assert_near(facts.step_limit * facts.highest_hz, 1.0 / 3.14159265358979,
                    1e-12);
        assert_true(facts.step_cost > 0.0 && facts.step_cost < 1e-2);
    }
}

/* The step does not resolve springs from hz = 1 / (pi step) on. */
static void springs_that_a_step_cannot_resolve_are_reported(void **state)
{
    static const char *const names[] = {"penalty:hz=31.8", "penalty:hz=31.9",
                                        "penalty:hz=31.8,inertia=5",
                                        "baumgarte:beta=1000"};
    const ritz_simulation_request request =
        asking(&ritz_integrator_trapezoidal, 1e-2);
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (int k = 0; k < 4; k++) {
        const ritz_constrained_request how = holding(names[k]);
        RITZ_OWN(ritz_constrained_facts) facts = {0};
        RITZ_OWN(ritz_simulation) s = {0};

        assert_ok(
            ritz_simulate_constrained(&j.bodies, &how, &request, &facts, &s));
        assert_int_equal(facts.unresolved, k == 1);
    }
}

/* Steps just below and just above the limit that the message names. */
static void a_step_beyond_the_limit_is_refused_or_seen_to_fail(void **state)
{
    static const char *const names[] = {"baumgarte:alpha=1,beta=201",
                                        "penalty:hz=40", "hybrid:hz=40,smax=1"};
    ritz_simulation_request request =
        asking(&ritz_integrator_central_difference, 1e-2);
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    request.x0 = off_x;
    request.seconds = 50.0; /* a factor of 1.2 a step at the least */
    assert_ok(joined_new(true, &j));
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        ritz_constrained_request how = holding(names[k]);

        assert_fails(
            ritz_simulate_constrained(&j.bodies, &how, &request, NULL, &s),
            RITZ_ERR_ARGUMENT, "raises the highest frequency from");
        if (k == 2)
            continue; /* its damper bounds what is unstable */
        how.any_step = true;
        assert_fails(
            ritz_simulate_constrained(&j.bodies, &how, &request, NULL, &s),
            RITZ_ERR_CONVERGENCE, "left all bounds");
    }
    assert_ok(run(&j, "baumgarte:alpha=1,beta=199", &request, &s));
    assert_true(last_diagnosis(&s, VIOLATION) < 1e-9);
    request.step = 0.2;
    ritz_simulation_free(&s);
    assert_fails(run(&j, "none", &request, &s), RITZ_ERR_ARGUMENT,
                 "the highest frequency, 1.96183 Hz, limits it");
}

static void an_impulse_moves_the_joined_bodies(void **state)
{
    static const ritz_signal hit = {.kind = RITZ_SIGNAL_IMPULSE,
                                    .amplitude = 2.0};
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (const ritz_stabilisation *const *m = ritz_stabilisations; *m; m++) {
        ritz_simulation_request request = asking(&ritz_integrator_modal, 1e-2);
        RITZ_OWN(ritz_simulation) s = {0}, exact = {0};

        request.signal = &hit;
        assert_ok(ritz_simulate(j.eliminated, &request, &exact));
        assert_ok(run(&j,
                      strcmp((*m)->name, "hybrid") == 0 ? "hybrid:smax=1"
                                                        : (*m)->name,
                      &request, &s));
        assert_near(s.y[1], exact.y[1], 1e-14);
        assert_near(s.work[0], exact.work[0], 1e-14);
        assert_near(s.diagnosis[RATE], 0.0, 1e-15);
    }
}

static bool count_down(void *context)
{
    int *left = context;

    return (*left)-- == 0;
}

static void a_run_that_ended_early_is_continued_bit_for_bit(void **state)
{
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    for (const ritz_stabilisation *const *m = ritz_stabilisations; *m; m++) {
        ritz_simulation_request request =
            asking(&ritz_integrator_generalised_alpha, 0.02);
        int left = 37;
        size_t size = 0;
        RITZ_OWN(ritz_simulation) whole = {0}, part = {0}, rest = {0};

        request.hold = RITZ_HOLD_ZERO;
        request.x0 = off_x;
        request.v0 = off_v;
        assert_ok(run(&j, (*m)->name, &request, &whole));
        request.stop = count_down;
        request.context = &left;
        assert_ok(run(&j, (*m)->name, &request, &part));
        assert_true(part.num_state > 0);
        request.stop = NULL;
        request.from = &part;
        assert_ok(run(&j, (*m)->name, &request, &rest));
        size = (size_t)whole.count * sizeof(double);
        assert_memory_equal(whole.y, rest.y, 3 * size);
        assert_memory_equal(whole.diagnosis, rest.diagnosis,
                            DIAGNOSTICS * size);
        assert_memory_equal(whole.balance, rest.balance, size);
    }
}

static void unknown_words_are_refused_by_name(void **state)
{
    static const struct {
        const char *text, *sentence;
    } bad[] = {{"spring", "no stabilisation is called 'spring'"},
               {"penalty:hertz=3", "'penalty' has no parameter 'hertz'"},
               {"projection:hz=3", "'projection' has no parameter 'hz'"},
               {"penalty:hz", "'hz' is not NAME=VALUE"},
               {"penalty:hz=x", "is a number of 0 or more, not 'x'"},
               {"penalty:hz=-1", "is a number of 0 or more, not '-1'"},
               {"penalty:hz=inf", "is a number of 0 or more, not 'inf'"},
               {"penalty:", "'' is not NAME=VALUE"},
               {"penalty:hz=nan", "is a number of 0 or more, not 'nan'"},
               {"penalty:hz=1,hz=1", "'hz' of penalty is given twice"}};
    ritz_constrained_request how = {0};

    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_fails(ritz_constrained_parse(bad[k].text, &how),
                     RITZ_ERR_ARGUMENT, bad[k].sentence);
    assert_ok(ritz_constrained_parse("penalty:inertia=2,hz=30", &how));
    assert_true(how.gain[0] == 30.0 && isnan(how.gain[1]) &&
                how.gain[2] == 2.0);
}

static void requests_without_sense_are_refused(void **state)
{
    ritz_simulation_request request = asking(&ritz_integrator_modal, 0.01);
    RITZ_OWN(joined) j = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    assert_fails(run(&j, "penalty:hz=0", &request, &s), RITZ_ERR_ARGUMENT,
                 "a frequency above 0");
    assert_fails(run(&j, "penalty:hz=1e155", &request, &s), RITZ_ERR_ARGUMENT,
                 "too large for a double");
    assert_fails(run(&j, "sliding-mode:switch=1,layer=0", &request, &s),
                 RITZ_ERR_ARGUMENT, "'layer' is positive");
    assert_fails(run(&j, "hybrid:smax=0", &request, &s), RITZ_ERR_ARGUMENT,
                 "'smax' is positive");
    request.rho = 2.0;
    assert_fails(run(&j, "index-2", &request, &s), RITZ_ERR_ARGUMENT,
                 "between 0 and 1");
    request.rho = 0.8;
    ritz_dense_col(&j.bodies.M, 0)[0] = 0.0;
    ritz_dense_free(&j.bodies.D);
    assert_fails(run(&j, "none", &request, &s), RITZ_ERR_ARGUMENT,
                 "1 motions of the unjoined bodies have no mass");
    ritz_dense_col(&j.bodies.C, 0)[0] = HUGE_VAL;
    assert_fails(run(&j, "none", &request, &s), RITZ_ERR_ARGUMENT,
                 "not finite");
    j.bodies.num_rows = 1;
    assert_fails(run(&j, "none", &request, &s), RITZ_ERR_ARGUMENT,
                 "constraints are 1 rows");
}

static void without_constraints_bodies_move_by_themselves(void **state)
{
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    ritz_dense_free(&j.bodies.C);
    j.bodies.num_rows = 0;
    for (const ritz_stabilisation *const *m = ritz_stabilisations; *m; m++) {
        const ritz_simulation_request request =
            asking(&ritz_integrator_modal, 0.01);
        RITZ_OWN(ritz_simulation) s = {0};

        assert_ok(run(&j,
                      strcmp((*m)->name, "hybrid") == 0 ? "hybrid:smax=1"
                                                        : (*m)->name,
                      &request, &s));
        assert_true(last_diagnosis(&s, VIOLATION) == 0.0);
        assert_true(s.y[200 * 3] == 0.0); /* the force is on the other row */
    }
}

static ritz_status run_all(const joined *j)
{
    for (const ritz_stabilisation *const *m = ritz_stabilisations; *m; m++) {
        const ritz_constrained_request how = holding((*m)->name);
        ritz_simulation_request request =
            asking(&ritz_integrator_trapezoidal, 0.1);
        RITZ_OWN(ritz_constrained_facts) facts = {0};
        RITZ_OWN(ritz_simulation) s = {0};

        request.seconds = 0.3;
        request.x0 = off_x;
        request.v0 = off_v;
        RITZ_CHECK(
            ritz_simulate_constrained(&j->bodies, &how, &request, NULL, &s));
        if (m == ritz_stabilisations) {
            ritz_simulation_free(&s);
            RITZ_CHECK(ritz_simulate_constrained(&j->bodies, &how, &request,
                                                 &facts, &s));
        }
    }
    return RITZ_OK;
}

static void runs_survive_every_allocation(void **state)
{
    RITZ_OWN(joined) j = {0};

    (void)state;
    assert_ok(joined_new(true, &j));
    assert_survives_every_allocation(run_all(&j));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(outputs_are_those_of_the_eliminated_system),
    cmocka_unit_test(multipliers_converge_at_second_order),
    cmocka_unit_test(penalties_converge_at_second_order),
    cmocka_unit_test(ten_times_the_stiffness_gives_a_tenth_of_the_violation),
    cmocka_unit_test(a_static_violation_is_that_of_the_springs),
    cmocka_unit_test(a_violation_without_stabilisation_grows_with_time),
    cmocka_unit_test(baumgarte_ends_a_violation_by_its_closed_form),
    cmocka_unit_test(a_sliding_mode_reaches_its_surface_in_time),
    cmocka_unit_test(projection_and_index_2_begin_at_the_nearest_start),
    cmocka_unit_test(from_a_violated_start_both_are_of_second_order),
    cmocka_unit_test(a_start_that_is_rounded_is_not_moved),
    cmocka_unit_test(stiff_penalties_lose_no_digits_of_the_motion),
    cmocka_unit_test(forces_of_stiff_springs_are_rounding_from_a_frequency_on),
    cmocka_unit_test(energies_balance_as_those_of_the_integrator),
    cmocka_unit_test(index_2_balances_energy_at_its_order),
    cmocka_unit_test(redundant_rows_are_named_and_share_forces),
    cmocka_unit_test(nearly_dependent_rows_do_not_drift),
    cmocka_unit_test(the_highest_frequency_is_reported),
    cmocka_unit_test(springs_that_a_step_cannot_resolve_are_reported),
    cmocka_unit_test(a_step_beyond_the_limit_is_refused_or_seen_to_fail),
    cmocka_unit_test(an_impulse_moves_the_joined_bodies),
    cmocka_unit_test(a_run_that_ended_early_is_continued_bit_for_bit),
    cmocka_unit_test(unknown_words_are_refused_by_name),
    cmocka_unit_test(requests_without_sense_are_refused),
    cmocka_unit_test(without_constraints_bodies_move_by_themselves),
    cmocka_unit_test(runs_survive_every_allocation),
};

TEST_MODULE(simulate_constrained, tests, NULL, NULL)
