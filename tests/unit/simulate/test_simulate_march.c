/* The loop over time with marches that are no integrator's, and what an
   integrator needs to go on. */
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

/* The state of a march in another one, by the numbers that ritz_march names. */
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

/* A point that moves at the rate of its input, and says twice its place. */
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
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_march_continues_from_its_numbers_bit_for_bit),
    cmocka_unit_test(a_march_may_have_its_own_outputs_and_diagnostics),
    cmocka_unit_test(a_march_survives_every_allocation),
};

TEST_MODULE(simulate_march, tests, NULL, NULL)
