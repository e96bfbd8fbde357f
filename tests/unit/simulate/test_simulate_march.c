/* The loop over time with marches other than those of integrators, and the
   numbers from which a march continues. */
#include "simulate/motion.h"
#include "testing.h"

#include "motions.h"

#include <stdlib.h>
#include <string.h>

static ritz_simulation_request asking(const ritz_integrator *integrator)
{
    ritz_simulation_request request = RITZ_SIMULATION_NONE;

    request.integrator = integrator;
    request.seconds = 1.0;
    request.step = 0.01;
    request.signal = &motions_step;
    request.hold = RITZ_HOLD_ZERO;
    return request;
}

static void take_steps(int count, double u, ritz_march *march)
{
    for (int k = 0; k < count; k++)
        assert_ok(march->advance(march, &u, &u));
}

/* Copy the state of a march, which is the numbers that ritz_march names. */
static void copy_state(const ritz_march *from, ritz_march *to)
{
    size_t size = (size_t)from->motion->n * sizeof(double);

    memcpy(to->x, from->x, size);
    memcpy(to->v, from->v, size);
    assert_int_equal(from->num_memory, to->num_memory);
    if (from->num_memory > 0)
        memcpy(to->memory, from->memory,
               (size_t)from->num_memory * sizeof(double));
    to->work = from->work;
    to->dissipated = from->dissipated;
}

static void continue_march(ritz_model subject, const ritz_integrator *which)
{
    ritz_simulation_request request = asking(which);
    RITZ_OWN(ritz_motion) motion = {0};
    RITZ_OWN(ritz_march) whole = {0}, rest = {0};
    size_t size = 0;

    assert_ok(ritz_motion_new(subject, &request, &motion));
    motion.energies = true;
    assert_ok(ritz_march_new(&motion, which, 0.01, 0.5, &whole));
    assert_ok(ritz_march_new(&motion, which, 0.01, 0.5, &rest));
    whole.x[0] = 0.3;
    if (whole.settle)
        assert_ok(whole.settle(&whole, &(double){1.0}));
    take_steps(20, 1.0, &whole);
    copy_state(&whole, &rest);
    take_steps(20, 0.5, &whole);
    take_steps(20, 0.5, &rest);
    size = (size_t)motion.n * sizeof(double);
    assert_memory_equal(whole.x, rest.x, size);
    assert_memory_equal(whole.v, rest.v, size);
    assert_true(whole.work == rest.work);
    assert_true(whole.dissipated == rest.dissipated);
}

static void a_march_continues_from_its_numbers_bit_for_bit(void **state)
{
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    for (const ritz_integrator *const *i = ritz_integrators; *i; i++) {
        continue_march(m.dense, *i);
        if ((*i)->takes_sparse)
            continue_march(m.sparse, *i);
    }
}

/* Advance full matrices and modes by the same steps; compare outputs, work and
   dissipation. Rounding is that of 400 steps, of some eps each. */
static void compare_forms(ritz_model model, const ritz_integrator *integrator)
{
    ritz_march march[2] = {0};
    ritz_motion motion[2] = {0};
    double most = 0.0, off = 0.0;

    for (int k = 0; k < 2; k++) {
        assert_ok(ritz_motion_dense(model, k == 1, &motion[k]));
        motion[k].energies = true;
        assert_ok(ritz_march_new(&motion[k], integrator, 0.01, 0.6, &march[k]));
        assert_ok(march[k].settle(&march[k], (double[]){0.0}));
    }
    for (int step = 0; step < 400; step++) {
        double y[2];

        for (int k = 0; k < 2; k++) {
            const double u[2] = {sin(0.2 * step), sin(0.2 * (step + 1))};

            assert_ok(march[k].advance(&march[k], &u[0], &u[1]));
            ritz_march_outputs(&march[k], &u[1], &y[k]);
        }
        most = fmax(most, fabs(y[0]));
        off = fmax(off, fabs(y[1] - y[0]));
    }
    assert_near(off, 0.0, 1e-11 * most);
    assert_near(march[1].work, march[0].work, 1e-11 * fabs(march[0].work));
    assert_near(march[1].dissipated, march[0].dissipated,
                1e-11 * fabs(march[0].work));
    for (int k = 0; k < 2; k++) {
        ritz_march_free(&march[k]);
        ritz_motion_free(&motion[k]);
    }
}

/* With no damping, with D that couples modes, and with gyroscopic terms. */
static void modes_advance_as_full_matrices_do(void **state)
{
    enum { INTEGRATORS = 3 };
    static const ritz_integrator *const all[INTEGRATORS] = {
        &ritz_integrator_trapezoidal, &ritz_integrator_generalised_alpha,
        &ritz_integrator_central_difference};

    (void)state;
    for (int damping = 0; damping < 3; damping++) {
        RITZ_OWN(motions) m = {0};

        assert_ok(motions_new(damping > 0, &m));
        for (int64_t j = 0; damping == 2 && j < 2; j++) {
            ritz_dense_col(&m.D, j)[j + 1] += 4.0;
            ritz_dense_col(&m.D, j + 1)[j] -= 4.0;
        }
        for (int k = 0; k < INTEGRATORS; k++)
            compare_forms(m.dense, all[k]);
    }
}

/* A point whose velocity is the input; its output is twice its position. */
static ritz_status advance_point(ritz_march *march, const double *u0,
                                 const double *u1)
{
    (void)u1;
    march->x[0] += march->step * u0[0];
    march->v[0] = u0[0];
    return RITZ_OK;
}

static void find_outputs(const ritz_march *march, const double *u, double *y)
{
    y[0] = march->x[0] + 10.0 * u[0];
}

static void find_energy(const ritz_march *march, double *kinetic,
                        double *potential)
{
    *kinetic = 3.0 * march->v[0];
    *potential = 0.0;
}

static void diagnose(const ritz_march *march, double *out)
{
    out[0] = 2.0 * march->x[0];
    out[1] = (double)march->steps;
}

static ritz_status run_point(const motions *m, ritz_simulation *out)
{
    static const char *const names[] = {"twice", "steps"};
    ritz_simulation_request request = asking(&ritz_integrator_trapezoidal);
    RITZ_OWN(ritz_motion) motion = {0};
    RITZ_OWN(ritz_march) march = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    request.every = 10;
    RITZ_CHECK(ritz_motion_new(m->dense, &request, &motion));
    motion.energies = true;
    RITZ_CHECK(
        ritz_march_new(&motion, request.integrator, request.step, 0.0, &march));
    march.advance = advance_point;
    march.outputs = find_outputs;
    march.energy = find_energy;
    march.diagnose = diagnose;
    march.diagnostic = names;
    march.num_diagnostics = 2;
    RITZ_CHECK(ritz_march_run(&march, &request, NULL, &s));
    RITZ_CHECK(ritz_simulation_label(m->dense, &s));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

static void a_march_may_have_its_own_outputs_and_diagnostics(void **state)
{
    RITZ_OWN(motions) m = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    assert_ok(run_point(&m, &s));
    assert_int_equal(s.count, 11);
    assert_int_equal(s.num_diagnostics, 2);
    assert_string_equal(s.diagnostic[0], "twice");
    for (int64_t k = 0; k < s.count; k++) { /* 0.01 summed 10 k times */
        double place = 0.1 * (double)k;

        assert_near(s.y[k], place + 10.0, 1e-13);
        assert_near(s.diagnosis[2 * k], 2.0 * place, 1e-13);
        assert_true(s.diagnosis[2 * k + 1] == 10.0 * (double)k);
        assert_true(s.kinetic[k] == (k > 0 ? 3.0 : 0.0));
    }
}

/* True after a number of steps. */
static bool count_down(void *context)
{
    int *left = context;

    return (*left)-- == 0;
}

static void same_values(const double *a, const double *b, int64_t count)
{
    if (count > 0)
        assert_memory_equal(a, b, (size_t)count * sizeof *a);
}

static void same_runs(const ritz_simulation *a, const ritz_simulation *b)
{
    assert_int_equal(a->count, b->count);
    assert_int_equal(b->num_state, 0);
    same_values(a->seconds, b->seconds, a->count);
    same_values(a->u, b->u, a->count * a->num_inputs);
    same_values(a->y, b->y, a->count * a->num_outputs);
    same_values(a->q, b->q, a->count * a->num_coordinates);
    same_values(a->v, b->v, a->count * a->num_coordinates);
    same_values(a->a, b->a, a->count * a->num_coordinates);
    assert_int_equal(a->balance != NULL, b->balance != NULL);
    if (a->balance) {
        same_values(a->kinetic, b->kinetic, a->count);
        same_values(a->dissipated, b->dissipated, a->count);
        same_values(a->balance, b->balance, a->count);
    }
}

/* End a run after 7, 8 and 93 of 100 steps, of which every fourth is stored,
   and continue it. */
static void end_and_continue(ritz_model subject,
                             ritz_simulation_request request)
{
    static const int ends[] = {7, 8, 93};
    RITZ_OWN(ritz_simulation) whole = {0}, rest = {0};
    ritz_simulation parts[3] = {0};

    request.every = 4;
    assert_ok(ritz_simulate(subject, &request, &whole));
    assert_int_equal(whole.num_state, 0);
    request.stop = count_down;
    for (int k = 0; k < 3; k++) {
        int left = ends[k] - (k > 0 ? ends[k - 1] : 0);

        request.context = &left;
        assert_ok(ritz_simulate(subject, &request, &parts[k]));
        assert_int_equal(parts[k].count, ends[k] / 4 + 1);
        assert_true(parts[k].state[0] == ends[k]);
        request.from = &parts[k];
    }
    request.stop = NULL;
    assert_ok(ritz_simulate(subject, &request, &rest));
    same_runs(&whole, &rest);
    for (int k = 0; k < 3; k++)
        ritz_simulation_free(&parts[k]);
}

static void a_run_that_ended_early_is_continued_bit_for_bit(void **state)
{
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    for (const ritz_integrator *const *i = ritz_integrators; *i; i++) {
        ritz_simulation_request request = asking(*i);

        end_and_continue(m.dense, request);
        request.coordinates = true;
        end_and_continue(m.dense, request);
        request.coordinates = false;
        if ((*i)->takes_sparse)
            end_and_continue(m.sparse, request);
    }
}

static void another_run_is_not_continued(void **state)
{
    static const char sentence[] = "that is to be continued has another model";
    ritz_simulation_request request = asking(&ritz_integrator_trapezoidal);
    RITZ_OWN(motions) m = {0};
    RITZ_OWN(ritz_simulation) part = {0}, none = {0};
    int left = 5;

    (void)state;
    assert_ok(motions_new(true, &m));
    request.stop = count_down;
    request.context = &left;
    assert_ok(ritz_simulate(m.dense, &request, &part));
    request.stop = NULL;
    request.from = &part;
    request.step = 0.02;
    assert_fails(ritz_simulate(m.dense, &request, &none), RITZ_ERR_ARGUMENT,
                 sentence);
    request.step = 0.01;
    request.every = 2;
    assert_fails(ritz_simulate(m.dense, &request, &none), RITZ_ERR_ARGUMENT,
                 sentence);
    request.every = 1;
    request.coordinates = true;
    assert_fails(ritz_simulate(m.dense, &request, &none), RITZ_ERR_ARGUMENT,
                 sentence);
    request.coordinates = false;
    request.seconds = 0.03;
    assert_fails(ritz_simulate(m.dense, &request, &none), RITZ_ERR_ARGUMENT,
                 sentence);
    request.seconds = 1.0;
    request.integrator = &ritz_integrator_modal;
    assert_fails(ritz_simulate(m.dense, &request, &none), RITZ_ERR_ARGUMENT,
                 sentence);
}

static void a_search_for_the_step_keeps_nothing(void **state)
{
    ritz_simulation_request request = asking(&ritz_integrator_trapezoidal);
    RITZ_OWN(motions) m = {0};
    RITZ_OWN(ritz_simulation) none = {0};
    int left = 5;

    (void)state;
    assert_ok(motions_new(true, &m));
    request.stop = count_down;
    request.context = &left;
    assert_fails(ritz_simulate_accurate(m.dense, &request, 1e-6, NULL, &none),
                 RITZ_ERR_CONVERGENCE, "while the step was chosen");
}

static ritz_status end_early(const motions *m)
{
    ritz_simulation_request request = asking(&ritz_integrator_trapezoidal);
    RITZ_OWN(ritz_simulation) part = {0}, rest = {0};
    int left = 50;

    request.coordinates = true;
    request.stop = count_down;
    request.context = &left;
    RITZ_CHECK(ritz_simulate(m->dense, &request, &part));
    request.stop = NULL;
    request.from = &part;
    return ritz_simulate(m->dense, &request, &rest);
}

static ritz_status try_point(const motions *m)
{
    RITZ_OWN(ritz_simulation) s = {0};

    return run_point(m, &s);
}

static void a_march_survives_every_allocation(void **state)
{
    RITZ_OWN(motions) m = {0};

    (void)state;
    assert_ok(motions_new(true, &m));
    assert_survives_every_allocation(try_point(&m));
    assert_survives_every_allocation(end_early(&m));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_march_continues_from_its_numbers_bit_for_bit),
    cmocka_unit_test(modes_advance_as_full_matrices_do),
    cmocka_unit_test(a_march_may_have_its_own_outputs_and_diagnostics),
    cmocka_unit_test(a_run_that_ended_early_is_continued_bit_for_bit),
    cmocka_unit_test(another_run_is_not_continued),
    cmocka_unit_test(a_search_for_the_step_keeps_nothing),
    cmocka_unit_test(a_march_survives_every_allocation),
};

TEST_MODULE(simulate_march, tests, NULL, NULL)
