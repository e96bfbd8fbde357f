/* Switched models: published numbers, energies, stability, refusals. */
#include "base/tolerances.h"
#include "linear/general.h"
#include "simulate/motion.h"
#include "testing.h"

#include "motions.h"
#include "try.h"

#include <ritz/base.h>
#include <ritz/switched.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A mass m on springs k and dashpots c that moves in a plane: inputs are forces
   along x and y, outputs are x, y and x' [McDaniel2000, 6.2.1]. */
typedef struct plane {
    ritz_dense K, M, D;
    ritz_io io;
    ritz_second_order matrices;
    ritz_model model;
} plane;

static void plane_free(plane *p)
{
    ritz_dense_free(&p->K);
    ritz_dense_free(&p->M);
    ritz_dense_free(&p->D);
    ritz_io_free(&p->io);
}

static ritz_status plane_new(plane *p)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_dense_new(2, 2, &p->K));
    RITZ_TRY(ritz_dense_new(2, 2, &p->M));
    RITZ_TRY(ritz_dense_new(2, 2, &p->D));
    RITZ_TRY(ritz_io_new(2, 2, 3, &p->io));
    for (int64_t k = 0; k < 2; k++) {
        p->K.val[3 * k] = 500.0;
        p->M.val[3 * k] = 5.0;
        p->D.val[3 * k] = 15.0;
        ritz_dense_col(&p->io.B, k)[k] = 1.0;
        ritz_dense_col(&p->io.C, k)[k] = 1.0;
    }
    ritz_dense_col(&p->io.Cv, 0)[2] = 1.0;
    p->matrices =
        (ritz_second_order){.K = &p->K, .M = &p->M, .D = &p->D, .io = &p->io};
    p->model = ritz_model_of_dense(&p->matrices, NULL);
done:
    return status;
}

/* Unit vectors at angles in degrees. */
static ritz_status directions(int64_t count, double first, double apart,
                              ritz_dense *out)
{
    ritz_status status = ritz_dense_new(2, count, out);

    for (int64_t k = 0; status == RITZ_OK && k < count; k++) {
        const double angle = (first - (double)k * apart) * RITZ_PI / 180.0;

        ritz_dense_col(out, k)[0] = cos(angle);
        ritz_dense_col(out, k)[1] = sin(angle);
    }
    return status;
}

/* The force 10 sin(10 pi t) along (x, y) until t1, and along (x, -y) from t2
   on. */
typedef struct pushes {
    ritz_signal signal[2];
} pushes;

static void pushes_free(pushes *p)
{
    ritz_signal_free(&p->signal[0]);
    ritz_signal_free(&p->signal[1]);
}

static void pushes_new(double x, double y, double t1, double t2, double step,
                       int64_t count, pushes *out)
{
    for (int64_t j = 0; j < 2; j++) {
        ritz_signal *s = &out->signal[j];

        s->kind = RITZ_SIGNAL_TABLE;
        s->amplitude = 1.0;
        s->count = count + 1;
        s->time = calloc((size_t)count + 1, sizeof *s->time);
        s->value = calloc((size_t)count + 1, sizeof *s->value);
        assert_non_null(s->time);
        assert_non_null(s->value);
        for (int64_t k = 0; k <= count; k++) {
            const double t = (double)k * step;
            const double f = 10.0 * sin(10.0 * RITZ_PI * t);

            s->time[k] = t;
            if (t < t1 - 0.5 * step)
                s->value[k] = (j == 0 ? x : y) * f;
            else if (t > t2 - 0.5 * step)
                s->value[k] = (j == 0 ? x : -y) * f;
        }
    }
}

static ritz_simulation_request asking(double seconds, double step,
                                      const ritz_signal *signal)
{
    ritz_simulation_request request = RITZ_SIMULATION_NONE;

    request.seconds = seconds;
    request.step = step;
    request.signal = signal;
    return request;
}

/* Value of a diagnostic at stored time k. */
static double told(const ritz_simulation *s, const char *name, int64_t k)
{
    for (int64_t j = 0; j < s->num_diagnostics; j++)
        if (strcmp(s->diagnostic[j], name) == 0)
            return s->diagnosis[k * s->num_diagnostics + j];
    fail_msg("no diagnostic '%s'", name);
    return 0.0;
}

static double largest_error(const ritz_simulation *a, const ritz_simulation *b,
                            int64_t output)
{
    double size = 0.0, difference = 0.0;

    ritz_simulation_compare(a, b, output, &size, &difference);
    return difference;
}

/* Run simulation D-3 at density n: the number of the first vector, and the
   largest error of x'. */
static double run_density(int n, int64_t *first)
{
    const double step = 5e-4;
    const int64_t count = (int64_t)1 << (n + 1);
    RITZ_OWN(plane) p = {0};
    RITZ_OWN(pushes) f = {0};
    RITZ_OWN(ritz_dense) library = {0};
    RITZ_OWN(ritz_simulation) full = {0}, s = {0};
    ritz_simulation_request request = {0};
    ritz_switched switched = {.num_libraries = 1,
                              .library = &library,
                              .redundant = true,
                              .interval = 0.01,
                              .indicator = 0.9};

    assert_ok(plane_new(&p));
    pushes_new(0.9397, 0.3420, 0.0, 0.2, step, 6000, &f);
    assert_ok(directions(count, 90.0, 180.0 / (double)count, &library));
    request = asking(3.0, step, f.signal);
    request.every = 20;
    assert_ok(ritz_simulate(p.model, &request, &full));
    assert_ok(ritz_simulate_switched(p.model, &request, &switched, NULL, &s));
    *first = 0;
    for (int64_t k = 0; k < s.count && *first == 0; k++)
        *first = (int64_t)told(&s, "leading vector", k);
    return largest_error(&full, &s, 2);
}

/* Inputs that are linear over h = 5e-4 s differ from a sine by (10 pi h)^2 / 12
   = 2e-5; the rest of 3e-4 is for numbers of four digits. */
static void simulation_d3_has_its_published_numbers(void **state)
{
    static const int64_t firsts[] = {6, 11, 21, 40, 79, 157, 314, 627, 1253};
    static const double errors[] = {1.661e-3, 2.313e-3, 2.474e-3,
                                    1.820e-4, 2.166e-4, 2.579e-4,
                                    2.396e-5, 2.906e-5, 3.685e-5};

    (void)state;
    for (int n = 2; n <= 10; n++) {
        int64_t first = 0;
        const double error = run_density(n, &first);

        assert_int_equal(first, firsts[n - 2]);
        assert_near(error, errors[n - 2], 4e-4 * errors[n - 2]);
    }
}

static void simulation_a_keeps_its_second_basis_until_6_05_s(void **state)
{
    static const double degrees[] = {45.0, -45.0, 60.0, -30.0};
    RITZ_OWN(plane) p = {0};
    RITZ_OWN(pushes) f = {0};
    RITZ_OWN(ritz_dense) library = {0};
    RITZ_OWN(ritz_simulation) full = {0}, s = {0};
    ritz_simulation_request request = {0};
    const ritz_switched switched = {.num_libraries = 1,
                                    .library = &library,
                                    .redundant = true,
                                    .interval = 0.05,
                                    .indicator = 0.9};

    (void)state;
    assert_ok(plane_new(&p));
    pushes_new(sqrt(0.5), sqrt(0.5), 2.0, 6.0, 1e-3, 10000, &f);
    assert_ok(ritz_dense_new(2, 4, &library));
    for (int64_t k = 0; k < 4; k++) {
        ritz_dense_col(&library, k)[0] = cos(degrees[k] * RITZ_PI / 180.0);
        ritz_dense_col(&library, k)[1] = sin(degrees[k] * RITZ_PI / 180.0);
    }
    request = asking(10.0, 1e-3, f.signal);
    request.every = 50;
    assert_ok(ritz_simulate(p.model, &request, &full));
    assert_ok(ritz_simulate_switched(p.model, &request, &switched, NULL, &s));
    for (int64_t k = 1; k < s.count; k++)
        assert_true(told(&s, "leading vector", k) ==
                    (s.seconds[k] < 6.075 ? 1.0 : 2.0));
    assert_near(largest_error(&full, &s, 0), 3.51e-3, 5e-6); /* 3 digits */
    for (int64_t k = 0; s.seconds[k] < 6.025; k++) /* exact to rounding */
        assert_near(s.y[3 * k], full.y[3 * k], 1e-15);
}

/* All modes of a model, as a library. */
static ritz_status all_modes(const motions *m, ritz_dense *out)
{
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_eigen_dense(&m->K, &m->M, &pairs));
    RITZ_MOVE(*out, pairs.Phi);
    return RITZ_OK;
}

/* Six masses in a row, D = 0.8 M or 0.8 M + 0.002 K. */
static ritz_status new_row(bool by_stiffness, motions *out)
{
    static const double m[] = {1.0, 2.0, 1.5, 0.7, 1.0, 3.0};
    static const double k[] = {100.0, 50.0, 80.0, 60.0, 200.0, 90.0};
    RITZ_CHECK(motions_row(6, m, k, NULL, out));
    RITZ_CHECK(ritz_dense_copy(&out->M, &out->D));
    for (int64_t i = 0; i < 36; i++)
        out->D.val[i] =
            0.8 * out->M.val[i] + (by_stiffness ? 0.002 * out->K.val[i] : 0.0);
    out->model.D = &out->D;
    out->dense = ritz_model_of_dense(&out->model, NULL);
    return RITZ_OK;
}

static void all_modes_are_the_full_model(void **state)
{
    static const double x0[] = {0.1, 0.0, -0.2, 0.3, 0.0, 0.1};
    RITZ_OWN(motions) m = {0};
    RITZ_OWN(ritz_dense) library = {0};
    RITZ_OWN(ritz_simulation) full = {0}, s = {0};
    ritz_simulation_request request = asking(5.0, 0.01, &motions_step);
    const ritz_switched switched = {.num_libraries = 1,
                                    .library = &library,
                                    .interval = 0.05,
                                    .indicator = 1.0 - 1e-9};

    (void)state;
    assert_ok(new_row(true, &m));
    assert_ok(all_modes(&m, &library));
    request.x0 = x0;
    assert_ok(ritz_simulate(m.dense, &request, &full));
    assert_ok(ritz_simulate_switched(m.dense, &request, &switched, NULL, &s));
    /* modes with less than 1e-9 of |R|^2 do not move for an interval */
    assert_near(largest_error(&full, &s, 0), 0.0, 1e-5);
    for (int64_t k = 0; k < s.count; k++)
        assert_near(s.balance[k], 0.0, 1e-12); /* 500 steps of some J */
}

/* A set that never changes gives the response of the reduced model with its
   vectors. */
static void a_set_is_propagated_as_its_reduced_model(void **state)
{
    RITZ_OWN(motions) m = {0};
    RITZ_OWN(ritz_dense) T = {0}, K = {0}, M = {0}, D = {0};
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_simulation) reduced = {0}, s = {0};
    ritz_second_order small = {.K = &K, .M = &M, .D = &D, .io = &io};
    const ritz_simulation_request request = asking(4.0, 0.01, &motions_step);
    const ritz_switched switched = {.num_libraries = 1,
                                    .library = &T,
                                    .interval = 0.1,
                                    .indicator = 0.999999};
    ritz_switched_report report = {0};

    (void)state;
    assert_ok(new_row(false, &m));
    assert_ok(ritz_dense_new(6, 3, &T)); /* not modes, as Krylov's */
    for (int64_t i = 0; i < 6; i++) {
        ritz_dense_col(&T, 0)[i] = 1.0 + (double)i;
        ritz_dense_col(&T, 1)[i] = cos((double)i);
        ritz_dense_col(&T, 2)[i] = (double)(i * i);
    }
    assert_ok(ritz_dense_congruence(&m.K, &T, &K));
    assert_ok(ritz_dense_congruence(&m.M, &T, &M));
    assert_ok(ritz_dense_congruence(&m.D, &T, &D));
    assert_ok(ritz_io_project(m.model.io, &T, &io));
    assert_ok(
        ritz_simulate(ritz_model_of_dense(&small, NULL), &request, &reduced));
    assert_ok(
        ritz_simulate_switched(m.dense, &request, &switched, &report, &s));
    assert_true(report.num_fallbacks == 40); /* three of six never suffice */
    assert_true(report.num_switches == 1);
    assert_true(report.vector_steps == 1200.0);
    assert_near(largest_error(&reduced, &s, 0), 0.0, 1e-12);
    for (int64_t k = 0; k < s.count; k++)
        assert_near(s.balance[k], 0.0, 1e-13);
}

/* A component gives the response of its matrices as a dense model. Outputs that
   are accelerations are those of the present set. */
static void a_component_is_switched_as_its_matrices(void **state)
{
    RITZ_OWN(motions) m = {0};
    RITZ_OWN(ritz_dense) library = {0};
    RITZ_OWN(ritz_simulation) dense = {0}, sparse = {0};
    const ritz_simulation_request request = asking(3.0, 0.01, &motions_step);
    const ritz_switched switched = {.num_libraries = 1,
                                    .library = &library,
                                    .interval = 0.03,
                                    .indicator = 0.7,
                                    .jump = RITZ_SWITCH_PROJECT};

    (void)state;
    assert_ok(motions_new(true, &m));
    assert_ok(all_modes(&m, &library));
    ritz_dense_col(&m.component.io.Ca, 1)[0] = 1.0;
    assert_ok(
        ritz_simulate_switched(m.dense, &request, &switched, NULL, &dense));
    assert_ok(
        ritz_simulate_switched(m.sparse, &request, &switched, NULL, &sparse));
    assert_near(largest_error(&dense, &sparse, 0), 0.0, 1e-12);
    assert_true(told(&dense, "switches", dense.count - 1) > 1.0);
}

static void projection_loses_the_energy_that_it_reports(void **state)
{
    static const double v0[] = {1.0, -2.0, 0.5, 0.0, 1.0, 0.3};
    RITZ_OWN(motions) m = {0};
    RITZ_OWN(ritz_dense) library = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    ritz_simulation_request request = asking(3.0, 0.01, &motions_step);
    const ritz_switched switched = {.num_libraries = 1,
                                    .library = &library,
                                    .interval = 0.1,
                                    .indicator = 0.6,
                                    .jump = RITZ_SWITCH_PROJECT};
    double lost = 0.0;
    int64_t jumps = 0, kept = 0;

    (void)state;
    assert_ok(new_row(true, &m));
    assert_ok(all_modes(&m, &library));
    request.v0 = v0;
    assert_ok(ritz_simulate_switched(m.dense, &request, &switched, NULL, &s));
    for (int64_t k = 1; k < s.count; k++) {
        const double now = told(&s, "energy lost at switches", k);

        assert_true(told(&s, "energy gained at switches", k) == 0.0);
        assert_true(now >= lost);
        jumps += now > lost;
        if (now > lost)
            assert_true(told(&s, "jump of velocity", k) > 0.0 ||
                        told(&s, "jump of displacement", k) > 0.0);
        if (told(&s, "switches", k) == told(&s, "switches", k - 1)) {
            kept += told(&s, "jump of velocity", k) > 0.0;
            assert_true(told(&s, "jump of velocity", k) ==
                        told(&s, "jump of velocity", k - 1));
        }
        lost = now;
        assert_near(s.balance[k], 0.0, 1e-12);
    }
    assert_true(jumps > 0 && lost > 0.1 && kept > 10 * jumps);
}

/* --- stability ------------------------------------------------------------ */

static double draw(uint64_t *seed, double low, double high)
{
    return low + 0.5 * (high - low) * (1.0 + ritz_general_noise(seed));
}

typedef struct random_case {
    motions m;
    ritz_dense library;
    ritz_switched switched;
    double x0[5], v0[5];
} random_case;

static void random_case_free(random_case *c)
{
    motions_free(&c->m);
    ritz_dense_free(&c->library);
}

/* Five masses with D = a M or D = a M + b K. The library has random vectors, or
   modes where D or the jump requires them. */
static void draw_case(uint64_t *seed, random_case *c)
{
    double m[5], k[5];
    const bool by_stiffness = draw(seed, 0.0, 1.0) > 0.5;
    const bool project = draw(seed, 0.0, 1.0) > 0.5;
    const double a = draw(seed, 0.05, 2.0);
    const double b = by_stiffness ? draw(seed, 1e-4, 1e-2) : 0.0;
    const int64_t columns = (int64_t)draw(seed, 2.0, 8.0);

    for (int i = 0; i < 5; i++) {
        m[i] = draw(seed, 0.2, 3.0);
        k[i] = draw(seed, 10.0, 300.0);
        c->x0[i] = draw(seed, -1.0, 1.0);
        c->v0[i] = draw(seed, -10.0, 10.0);
    }
    assert_ok(motions_row(5, m, k, NULL, &c->m));
    assert_ok(ritz_dense_copy(&c->m.M, &c->m.D));
    for (int i = 0; i < 25; i++)
        c->m.D.val[i] = a * c->m.M.val[i] + b * c->m.K.val[i];
    c->switched = (ritz_switched){
        .num_libraries = 1,
        .library = &c->library,
        .interval = 0.01 * floor(draw(seed, 1.0, 12.0)),
        .indicator = draw(seed, 0.2, 0.99),
        .jump = project ? RITZ_SWITCH_PROJECT : RITZ_SWITCH_OFFSET};
    if (by_stiffness || project) {
        assert_ok(all_modes(&c->m, &c->library));
        return;
    }
    c->switched.redundant = draw(seed, 0.0, 1.0) > 0.5;
    assert_ok(ritz_dense_new(5, columns, &c->library));
    for (int64_t i = 0; i < 5 * columns; i++)
        c->library.val[i] = draw(seed, -1.0, 1.0);
}

static void no_checked_library_grows_in_1000_random_cases(void **state)
{
    uint64_t seed = 17;
    int64_t switches = 0;

    (void)state;
    for (int n = 0; n < 1000; n++) {
        RITZ_OWN(random_case) c = {0};
        RITZ_OWN(ritz_simulation) s = {0};
        ritz_switched_report report = {0};
        ritz_simulation_request request = asking(1.2, 0.01, NULL);

        draw_case(&seed, &c);
        request.x0 = c.x0;
        request.v0 = c.v0;
        assert_ok(ritz_simulate_switched(c.m.dense, &request, &c.switched,
                                         &report, &s));
        switches += report.num_switches;
        for (int64_t k = 1; k < s.count; k++) /* rounding of a sum of terms */
            assert_true(s.kinetic[k] + s.potential[k] <=
                        (s.kinetic[k - 1] + s.potential[k - 1]) *
                            (1.0 + 1e-12));
    }
    assert_true(switches > 5000);
}

/* Move an oscillator from (x, v) to the next time at which v (or x) is 0. */
static void to_next_axis(double k, double c, bool of_v, double *x, double *v)
{
    double low = 0.0, high = 0.01;
    double end[2] = {*x, *v};
    const double sign = of_v ? *v : *x;

    for (int j = 0; j < 400; j++) {
        const bool bracketed = j >= 300;
        const double h = bracketed ? 0.5 * (low + high) : high;
        const ritz_oscillator o = ritz_oscillator_over(k, c, h);

        end[0] = o.hold * *x + o.S * *v;
        end[1] = -k * o.S * *x + o.rate * *v;
        if ((of_v ? end[1] : end[0]) * sign > 0.0) {
            low = h;
            high = bracketed ? high : high + 0.05;
        } else {
            high = h;
            j = bracketed ? j : 299;
        }
    }
    *x = end[0];
    *v = end[1];
}

/* |x'| after half a turn, from x' = 1. k/m is 1/4 while x x' > 0 and 4
   otherwise; each oscillator alone is stable [McDaniel2000, 5.2.15-17]. */
static double growth_of_half_turn(double c)
{
    double x = 0.0, v = 1.0;

    to_next_axis(0.25, c, true, &x, &v);
    v = -1e-300; /* here x is largest, and x x' changes its sign */
    to_next_axis(4.0, c, false, &x, &v);
    return fabs(v);
}

static void two_stable_oscillators_grow_when_switched(void **state)
{
    (void)state;
    assert_near(growth_of_half_turn(0.0), 4.0, 1e-10);
    assert_near(growth_of_half_turn(0.1), 3.315416, 5e-7); /* 7 digits */
}

/* --- refusals ------------------------------------------------------------- */

typedef struct refused {
    motions m;
    ritz_dense library;
    ritz_switched switched;
    ritz_simulation_request request;
} refused;

static void refused_free(refused *r)
{
    motions_free(&r->m);
    ritz_dense_free(&r->library);
}

static ritz_status try_run(const refused *r)
{
    RITZ_OWN(ritz_simulation) s = {0};

    return ritz_simulate_switched(r->m.dense, &r->request, &r->switched, NULL,
                                  &s);
}

static ritz_status refused_new(refused *r)
{
    RITZ_CHECK(new_row(true, &r->m));
    RITZ_CHECK(all_modes(&r->m, &r->library));
    r->request = asking(1.0, 0.01, &motions_step);
    r->switched = (ritz_switched){.num_libraries = 1,
                                  .library = &r->library,
                                  .interval = 0.05,
                                  .indicator = 0.9};
    return RITZ_OK;
}

static void requests_without_sense_are_refused(void **state)
{
    RITZ_OWN(refused) r = {0};
    const ritz_dense none = {.nrow = 6};

    (void)state;
    assert_ok(refused_new(&r));
    assert_ok(try_run(&r));
    r.switched.interval = 0.015;
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT,
                 "the switch interval of 0.015 s is not of whole steps");
    r.switched.interval = 0.05;
    r.switched.indicator = 1.0;
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT, "below 1, not 1");
    r.switched.indicator = 0.9;
    r.switched.hysteresis = -0.1;
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT, "a hysteresis is");
    r.switched.hysteresis = 0.0;
    r.switched.dwell = -1.0;
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT,
                 "a dwell of -1 s is not within 0 and");
    r.switched.dwell = 0.0;
    r.switched.jump = RITZ_SWITCH_PROJECT;
    r.switched.inner = RITZ_SWITCH_EUCLIDEAN;
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT, "projection is in the inner");
    r.switched.jump = RITZ_SWITCH_OFFSET;
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT, "an eigenvector of M: vector");
    r.switched.inner = RITZ_SWITCH_MASS;
    r.library.val[3] = nan("");
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT, "is not finite");
    memset(r.library.val, 0, 36 * sizeof(double));
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT, "no vector that is not zero");
    r.switched.library = &none;
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT, "the library is empty");
}

static void libraries_of_other_models_are_refused(void **state)
{
    RITZ_OWN(refused) r = {0};

    (void)state;
    assert_ok(refused_new(&r));
    r.library.nrow = 5;
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT, "a library of 5 rows");
    r.library.nrow = 6;
}

/* The library is the unit matrix: D = a M + b K couples its vectors, and so
   does K. */
static void
libraries_without_a_common_lyapunov_function_are_refused(void **state)
{
    RITZ_OWN(refused) r = {0};
    ritz_switched_report report = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    assert_ok(refused_new(&r));
    ritz_dense_free(&r.library);
    assert_ok(ritz_dense_identity(6, &r.library));
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT, "D couples vector");
    r.switched.jump = RITZ_SWITCH_PROJECT;
    assert_fails(
        ritz_simulate_switched(r.m.dense, &r.request, &r.switched, &report, &s),
        RITZ_ERR_ARGUMENT, "sets that dwell");
    assert_true(report.dwell > 0.0 && report.dwell < 1e3);
    r.switched.dwell = report.dwell;
    assert_ok(try_run(&r));
    memset(r.m.D.val, 0, 36 * sizeof(double));
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT,
                 "damping takes it from no motion");
    r.switched.jump = RITZ_SWITCH_OFFSET; /* V' = -v'P'D v = 0 */
    assert_ok(try_run(&r));
    for (int k = 0; k < 36; k++)
        r.m.D.val[k] = -0.1 * r.m.M.val[k];
    assert_fails(try_run(&r), RITZ_ERR_ARGUMENT, "D has the negative value");
}

/* With the dwell time that is required, energy decays from set to set. */
static void sets_that_dwell_decay(void **state)
{
    RITZ_OWN(refused) r = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    ritz_switched_report report = {0};
    const double x0[] = {1.0, -1.0, 0.5, 1.0, -0.3, 0.2};
    int64_t switches = 0;

    (void)state;
    assert_ok(refused_new(&r));
    ritz_dense_free(&r.library);
    assert_ok(ritz_dense_identity(6, &r.library));
    r.switched.jump = RITZ_SWITCH_PROJECT;
    r.switched.indicator = 0.5;
    (void)ritz_simulate_switched(r.m.dense, &r.request, &r.switched, &report,
                                 &s);
    r.switched.dwell = report.dwell;
    r.switched.interval = 0.05;
    r.request.signal = NULL;
    r.request.x0 = x0;
    r.request.seconds = 20.0 * report.dwell;
    assert_ok(ritz_simulate_switched(r.m.dense, &r.request, &r.switched,
                                     &report, &s));
    switches = report.num_switches;
    assert_true(switches > 1);
    assert_true(s.kinetic[s.count - 1] + s.potential[s.count - 1] <
                s.kinetic[0] + s.potential[0]);
}

static void a_state_space_is_refused(void **state)
{
    RITZ_OWN(refused) r = {0};
    RITZ_OWN(ritz_state_space) made = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    const ritz_state_space *space = NULL;

    (void)state;
    assert_ok(refused_new(&r));
    assert_ok(ritz_model_states(r.m.dense, &made, &space));
    assert_fails(ritz_simulate_switched(ritz_model_of_states(space), &r.request,
                                        &r.switched, NULL, &s),
                 RITZ_ERR_ARGUMENT, "a state space has no mass");
}

/* --- the choice ----------------------------------------------------------- */

/* Of equal shares the lowest number is chosen, whatever rounding makes of
   them. */
static void ties_do_not_depend_on_rounding(void **state)
{
    static const double off[] = {-4e-15, 0.0, 4e-15};
    RITZ_OWN(plane) p = {0};
    RITZ_OWN(ritz_dense) library = {0};

    (void)state;
    assert_ok(plane_new(&p));
    assert_ok(directions(2, 0.0, 90.0, &library));
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_simulation) s = {0};
        const ritz_switched switched = {.num_libraries = 1,
                                        .library = &library,
                                        .interval = 0.02,
                                        .indicator = 0.4};
        ritz_simulation_request request = asking(0.04, 0.01, NULL);
        const double x0[] = {0.7, 0.7 + off[k]};

        request.x0 = x0;
        assert_ok(
            ritz_simulate_switched(p.model, &request, &switched, NULL, &s));
        assert_true(told(&s, "leading vector", 1) == 1.0);
        assert_true(told(&s, "vectors", 1) == 1.0);
        assert_near(told(&s, "indicator", 1), 0.5, 1e-13);
    }
}

/* With hysteresis a set is kept if others are hardly better. */
static void hysteresis_switches_less(void **state)
{
    static const double x0[] = {1.0, -1.0, 0.5, 1.0, -0.3, 0.2};
    RITZ_OWN(refused) r = {0};
    int64_t before = INT64_MAX;

    (void)state;
    assert_ok(refused_new(&r));
    r.request.seconds = 4.0;
    r.request.x0 = x0;
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_simulation) s = {0};
        ritz_switched_report report = {0};

        r.switched.hysteresis = 0.45 * k;
        assert_ok(ritz_simulate_switched(r.m.dense, &r.request, &r.switched,
                                         &report, &s));
        assert_true(report.num_switches < before);
        before = report.num_switches;
        for (int64_t i = 1; i < s.count; i++) /* E is reached all the same */
            assert_true(told(&s, "indicator", i) > 0.9 - 1e-9);
    }
}

/* If state and force are 0, the residual is 0 and the present set is kept. */
static void a_residual_of_zero_changes_no_set(void **state)
{
    RITZ_OWN(refused) r = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    ritz_switched_report report = {0};

    (void)state;
    assert_ok(refused_new(&r));
    r.request.signal = NULL;
    assert_ok(ritz_simulate_switched(r.m.dense, &r.request, &r.switched,
                                     &report, &s));
    assert_true(report.num_switches == 0 && report.vector_steps == 0.0);
}

/* A sine is 0 when the run begins: its set must be found by what comes, also
   where inputs are held over a step. */
static void a_force_that_begins_with_the_run_is_found(void **state)
{
    static const ritz_hold holds[] = {RITZ_HOLD_FIRST, RITZ_HOLD_ZERO};
    static const ritz_signal sine = {
        .kind = RITZ_SIGNAL_SINE, .amplitude = 1.0, .hertz = {2.0, 0.0}};

    (void)state;
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(refused) r = {0};
        RITZ_OWN(ritz_simulation) full = {0}, s = {0};
        double size = 0.0, difference = 0.0;

        assert_ok(refused_new(&r));
        r.request.hold = holds[k];
        r.request.signal = &sine;
        r.request.seconds = r.switched.interval = 0.5;
        r.switched.indicator = 1.0 - 1e-9;
        assert_ok(ritz_simulate(r.m.dense, &r.request, &full));
        assert_ok(ritz_simulate_switched(r.m.dense, &r.request, &r.switched,
                                         NULL, &s));
        ritz_simulation_compare(&full, &s, 0, &size, &difference);
        assert_true(size > 1e-6 && difference < 1e-6 * size);
    }
}

/* Two oscillators beside each other, of which the slow one is dropped although
   it has all of the kinetic energy. */
static void what_a_set_leaves_out_is_told(void **state)
{
    static const double m[] = {1.0, 1.0}, k[] = {0.0, 1e6};
    static const double v0[] = {1.0, 0.0};
    RITZ_OWN(motions) row = {0};
    RITZ_OWN(ritz_dense) library = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    ritz_simulation_request request = asking(0.01, 1e-4, NULL);
    const double x0[] = {0.0, 1e-5};
    ritz_switched switched = {.num_libraries = 1,
                              .library = &library,
                              .interval = 1e-3,
                              .indicator = 0.9};
    ritz_switched_report report = {0};

    (void)state;
    assert_ok(motions_row(2, m, k, NULL, &row));
    memset(row.K.val, 0, 4 * sizeof(double));
    row.K.val[3] = 1e6; /* the first is free, the second alone */
    assert_ok(ritz_dense_identity(2, &library));
    request.x0 = x0;
    request.v0 = v0;
    assert_ok(
        ritz_simulate_switched(row.dense, &request, &switched, &report, &s));
    /* R = [1, w; 0, -1e6 x] begins as [1, 0; 0, -10] */
    assert_near(report.left_out, 1.0, 1e-15);
    assert_true(report.left_out_at == 0.0);
    switched.indicator = 1.0 - 1e-9;
    ritz_simulation_free(&s);
    assert_ok(
        ritz_simulate_switched(row.dense, &request, &switched, &report, &s));
    assert_true(report.left_out == 0.0);
}

/* --- runs that are ended early, and failing allocations ------------------- */

static bool count_down(void *context)
{
    int *left = context;

    return (*left)-- == 0;
}

/* End the run after 37 and 61 steps, within an interval and at a switch. */
static void is_continued(refused *r)
{
    static const int ends[] = {37, 60};
    RITZ_OWN(ritz_simulation) whole = {0}, rest = {0};
    ritz_simulation parts[2] = {0};
    size_t size = 0;

    assert_ok(ritz_simulate_switched(r->m.dense, &r->request, &r->switched,
                                     NULL, &whole));
    r->request.stop = count_down;
    for (int k = 0; k < 2; k++) {
        int left = ends[k] - (k > 0 ? ends[k - 1] : 0);

        r->request.context = &left;
        assert_ok(ritz_simulate_switched(r->m.dense, &r->request, &r->switched,
                                         NULL, &parts[k]));
        assert_true(parts[k].state[0] == ends[k]);
        r->request.from = &parts[k];
    }
    r->request.stop = NULL;
    assert_ok(ritz_simulate_switched(r->m.dense, &r->request, &r->switched,
                                     NULL, &rest));
    r->request.from = NULL;
    size = (size_t)whole.count * sizeof(double);
    assert_int_equal(rest.count, whole.count);
    assert_memory_equal(rest.y, whole.y, size * (size_t)whole.num_outputs);
    assert_memory_equal(rest.balance, whole.balance, size);
    assert_memory_equal(rest.diagnosis, whole.diagnosis,
                        size * (size_t)whole.num_diagnostics);
    for (int k = 0; k < 2; k++)
        ritz_simulation_free(&parts[k]);
}

static void a_switched_run_is_continued_bit_for_bit(void **state)
{
    static const double x0[] = {1.0, -1.0, 0.5, 1.0, -0.3, 0.2};
    RITZ_OWN(refused) r = {0};

    (void)state;
    assert_ok(refused_new(&r));
    r.request.x0 = x0;
    is_continued(&r);
    r.switched.jump = RITZ_SWITCH_PROJECT;
    is_continued(&r);
    r.switched.jump = RITZ_SWITCH_OFFSET;
    r.switched.redundant = true; /* vectors that are not modes */
    for (int k = 0; k < 36; k++) {
        r.m.D.val[k] = 0.3 * r.m.M.val[k];
        r.library.val[k] += 0.3 * cos((double)k);
    }
    is_continued(&r);
    r.switched.look_ahead = r.switched.share_of_library = true;
    is_continued(&r);
}

static void a_switched_run_survives_every_allocation(void **state)
{
    RITZ_OWN(refused) r = {0};

    (void)state;
    assert_ok(refused_new(&r));
    r.request.seconds = 0.1;
    assert_survives_every_allocation(try_run(&r));
    for (int k = 0; k < 36; k++)
        r.m.D.val[k] = 0.3 * r.m.M.val[k];
    r.library.val[1] += 0.1;
    r.switched.redundant = true;
    assert_survives_every_allocation(try_run(&r));
    r.switched.jump = RITZ_SWITCH_PROJECT;
    r.switched.dwell = 1e6;
    assert_survives_every_allocation(try_run(&r));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(simulation_d3_has_its_published_numbers),
    cmocka_unit_test(simulation_a_keeps_its_second_basis_until_6_05_s),
    cmocka_unit_test(all_modes_are_the_full_model),
    cmocka_unit_test(a_set_is_propagated_as_its_reduced_model),
    cmocka_unit_test(a_component_is_switched_as_its_matrices),
    cmocka_unit_test(projection_loses_the_energy_that_it_reports),
    cmocka_unit_test(no_checked_library_grows_in_1000_random_cases),
    cmocka_unit_test(two_stable_oscillators_grow_when_switched),
    cmocka_unit_test(requests_without_sense_are_refused),
    cmocka_unit_test(libraries_of_other_models_are_refused),
    cmocka_unit_test(libraries_without_a_common_lyapunov_function_are_refused),
    cmocka_unit_test(sets_that_dwell_decay),
    cmocka_unit_test(a_state_space_is_refused),
    cmocka_unit_test(ties_do_not_depend_on_rounding),
    cmocka_unit_test(hysteresis_switches_less),
    cmocka_unit_test(a_residual_of_zero_changes_no_set),
    cmocka_unit_test(a_force_that_begins_with_the_run_is_found),
    cmocka_unit_test(what_a_set_leaves_out_is_told),
    cmocka_unit_test(a_switched_run_is_continued_bit_for_bit),
    cmocka_unit_test(a_switched_run_survives_every_allocation),
};

TEST_MODULE(switched, tests, NULL, NULL)
