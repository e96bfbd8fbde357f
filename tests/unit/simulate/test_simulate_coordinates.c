/* Coordinates, rates and accelerations that a simulation of a dense model
   keeps. */
#include "testing.h"

#include "spring_chain.h"

#include <ritz/basis.h>
#include <ritz/simulate.h>

#include <float.h>
#include <stdio.h>

enum { MASSES = 7 };

static const ritz_signal push = {
    .kind = RITZ_SIGNAL_SINE, .amplitude = 2.0, .hertz = {1.5, 0.0}};

/* A chain pushed and observed at its end, as a reduced component of all its
   dofs with D. */
static void reduce_chain(ritz_component *chain, ritz_reduced *out)
{
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(spring_chain(MASSES, false, chain));
    assert_ok(ritz_sparse_copy(&chain->K, &chain->D));
    for (int64_t p = 0; p < chain->D.colptr[MASSES]; p++)
        chain->D.val[p] *= 1e-3;
    ritz_io_free(&chain->io);
    assert_ok(ritz_io_new(MASSES, 1, 1, &chain->io));
    snprintf(chain->io.input[0], RITZ_NAME_SIZE, "push");
    snprintf(chain->io.output[0], RITZ_NAME_SIZE, "end");
    chain->io.B.val[MASSES - 1] = chain->io.C.val[MASSES - 1] = 1.0;
    assert_ok(ritz_basis_new(MASSES, MASSES, &basis));
    for (int64_t j = 0; j < MASSES; j++)
        ritz_dense_col(&basis.T, j)[j] = 1.0;
    assert_ok(ritz_reduce(chain, &basis, out));
}

static ritz_simulation_request asking(const ritz_integrator *integrator)
{
    ritz_simulation_request request = RITZ_SIMULATION_NONE;

    request.integrator = integrator;
    request.seconds = 2.0;
    request.step = 0.01;
    request.every = 4;
    request.signal = &push;
    request.coordinates = true;
    return request;
}

/* Row i of A x. */
static double row_of(const ritz_dense *A, int64_t i, const double *x)
{
    double sum = 0.0;

    for (int64_t j = 0; j < A->ncol; j++)
        sum += ritz_dense_col(A, j)[i] * x[j];
    return sum;
}

/* M q'' + D q' + K q = B f at each time, whatever the integrator. */
static void coordinates_are_in_equilibrium(void **)
{
    for (const ritz_integrator *const *i = ritz_integrators; *i; i++) {
        RITZ_OWN(ritz_component) chain = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        RITZ_OWN(ritz_simulation) s = {0};
        const ritz_simulation_request request = asking(*i);

        reduce_chain(&chain, &reduced);
        assert_ok(
            ritz_simulate(ritz_model_of_reduced(&reduced, NULL), &request, &s));
        assert_int_equal(s.num_coordinates, MASSES);
        assert_int_equal(s.num_outputs, 1);
        assert_int_equal(s.count, 51);
        for (int64_t k = 0; k < s.count; k++) {
            const double *q = s.q + k * MASSES;

            assert_near(s.y[k], q[MASSES - 1], DBL_EPSILON);
            for (int64_t j = 0; j < MASSES; j++)
                /* terms of 1e3 times displacements below 1, written out by
                   modes: some hundred roundings of them */
                assert_near(row_of(&reduced.M, j, s.a + k * MASSES) +
                                row_of(&reduced.D, j, s.v + k * MASSES) +
                                row_of(&reduced.K, j, q),
                            s.u[k] * reduced.io.B.val[j],
                            100.0 * 1e3 * DBL_EPSILON);
        }
    }
}

/* Outputs and energies are the same with and without coordinates. */
static void outputs_are_the_same(void **)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_simulation) with = {0}, without = {0};
    ritz_simulation_request request = asking(&ritz_integrator_modal);
    ritz_model model;

    reduce_chain(&chain, &reduced);
    model = ritz_model_of_reduced(&reduced, NULL);
    assert_ok(ritz_simulate(model, &request, &with));
    request.coordinates = false;
    assert_ok(ritz_simulate(model, &request, &without));
    assert_int_equal(without.num_coordinates, 0);
    assert_null(without.q);
    assert_string_equal(with.output[0], "end");
    assert_string_equal(with.input[0], "push");
    for (int64_t k = 0; k < with.count; k++) {
        /* sums of a term for each mode, of displacements below 1, in an order
           that depends on how many outputs there are */
        assert_near(with.y[k], without.y[k], MASSES * DBL_EPSILON);
        assert_near(with.balance[k], without.balance[k], 1e2 * DBL_EPSILON);
    }
}

static void models_without_them_are_refused(void **)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    ritz_simulation_request request = asking(&ritz_integrator_modal);

    reduce_chain(&chain, &reduced);
    request.up_to_hz = 10.0;
    assert_fails(
        ritz_simulate(ritz_model_of_component(&chain, NULL), &request, &s),
        RITZ_ERR_ARGUMENT, "coordinates are of reduced components and systems");
}

static ritz_status simulate_once(ritz_model model,
                                 const ritz_simulation_request *request)
{
    RITZ_OWN(ritz_simulation) s = {0};

    return ritz_simulate(model, request, &s);
}

static void all_allocations_may_fail(void **)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    const ritz_simulation_request request = asking(&ritz_integrator_modal);

    reduce_chain(&chain, &reduced);
    assert_survives_every_allocation(
        simulate_once(ritz_model_of_reduced(&reduced, NULL), &request));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(coordinates_are_in_equilibrium),
    cmocka_unit_test(outputs_are_the_same),
    cmocka_unit_test(models_without_them_are_refused),
    cmocka_unit_test(all_allocations_may_fail),
};

TEST_MODULE(simulate_coordinates, tests, NULL, NULL)
