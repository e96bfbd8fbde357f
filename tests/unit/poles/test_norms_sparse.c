/*
 * Norms of sparse models against those of SLICOT: interpolation of the response,
 * and low-rank Gramians with the correction for their residuals.
 */
#include "testing.h"

#include "spaces.h"

#include "base/alloc.h"
#include "gramians/space.h"
#include "poles/poles.h"

#include <ritz/poles.h>

#include <stdlib.h>

enum { CELLS = 60, KEPT = 3 };

/* A small model of other poles with the inputs and outputs of a rod, diagonal
   and so in Schur form. */
static void make_small(const ritz_state_space *model, double gain,
                       ritz_state_space *out)
{
    const ritz_io io = ritz_model_io(ritz_model_of_states(model));

    assert_ok(ritz_state_space_new(KEPT, &io, out));
    for (int64_t k = 0; k < KEPT; k++) {
        ritz_dense_col(&out->A, k)[k] = -0.003 * (double)(1 + 4 * k);
        for (int64_t j = 0; j < 2; j++) {
            ritz_dense_col(&out->B, j)[k] = gain;
            ritz_dense_col(&out->C, k)[j] = j == 0 ? 0.3 : 0.2;
        }
    }
}

/* RITZ_SPARSE_NORM of the search, and 1e-8 of SLICOT's. */
static void norms_are_those_of_dense_models(void **)
{
    for (int k = 0; k < 4; k++) {
        RITZ_OWN(ritz_state_space) rod = {0}, made = {0}, small = {0};
        RITZ_OWN(ritz_state_space) difference = {0};
        const ritz_state_space *dense = NULL;
        ritz_norm whole = {0}, error = {0}, exact = {0}, least = {0};
        int64_t decoupled = -1;

        assert_ok(spaces_rod(CELLS, k & 1 ? 0.05 : 0.0, k & 2, &rod));
        assert_ok(ritz_state_space_dense(&rod, &made, &dense));
        make_small(&rod, 0.05, &small);
        assert_ok(ritz_norm_infinity_sparse(&rod, &small, 1e-6, &decoupled,
                                            &whole, &error));
        assert_int_equal(decoupled, 0);
        assert_ok(ritz_norm_infinity(dense, 1e-8, &exact));
        assert_near(whole.value, exact.value, 1e-6 * exact.value);
        assert_ok(ritz_state_space_difference(dense, &small, &difference));
        assert_ok(ritz_norm_infinity(&difference, 1e-8, &least));
        assert_near(error.value, least.value, 1e-6 * least.value);
        assert_true(error.value <= least.value * (1.0 + 1e-8));
        assert_non_null(strstr(error.engine, "a lower bound"));
    }
}

/* Two residuals of 1e-10 leave 1e-20 of the square; what is met is rounding of
   some hundred columns. */
static void h2_norms_need_no_small_residual(void **)
{
    RITZ_OWN(ritz_state_space) chains = {0}, chain = {0}, made = {0};
    RITZ_OWN(ritz_state_space) one = {0};
    const ritz_state_space *dense = NULL;
    ritz_norm exact = {0};
    double whole = 0.0, last = 0.0, alone = 0.0;

    assert_ok(spaces_rod(CELLS, 0.05, true, &one));
    assert_ok(ritz_state_space_dense(&one, &made, &dense));
    assert_ok(ritz_norm_two(dense, &exact));
    assert_ok(ritz_space_norm_two(&one, CELLS, &whole, &last));
    assert_near(whole, exact.value, 1e-12 * exact.value);
    assert_near(last, whole, 1e-12 * whole);
    /* two equal chains, one channel each, are sqrt(2) of one; rigid motion is
       left out */
    assert_ok(spaces_chains(1, 12, true, &chain));
    assert_ok(ritz_space_norm_two(&chain, 24, &alone, &last));
    assert_ok(spaces_chains(2, 12, true, &chains));
    assert_ok(ritz_space_norm_two(&chains, 48, &whole, &last));
    assert_near(whole, sqrt(2.0) * alone, 1e-10 * whole);
    assert_true(last == whole);
}

/* Rigid motion is left out: the response of two chains is that of one. */
static void poles_at_0_are_left_out(void **)
{
    double value[2] = {0};

    for (int64_t bodies = 1; bodies <= 2; bodies++) {
        RITZ_OWN(ritz_state_space) chain = {0}, small = {0};
        const ritz_state_space *m = &chain;
        ritz_norm whole = {0}, error = {0};
        int64_t decoupled = -1;

        assert_ok(spaces_chains(bodies, 15, false, &chain));
        const ritz_io io = ritz_model_io(ritz_model_of_states(m));
        assert_ok(ritz_state_space_new(1, &io, &small));
        small.A.val[0] = -1.0;
        assert_ok(ritz_norm_infinity_sparse(m, &small, 1e-6, &decoupled, &whole,
                                            &error));
        assert_int_equal(decoupled, 2 * bodies);
        assert_near(error.value, whole.value, 1e-6 * whole.value);
        value[bodies - 1] = whole.value;
    }
    assert_near(value[1], value[0], 1e-6 * value[0]);
}

static ritz_status take_norms(const ritz_state_space *rod,
                              const ritz_state_space *small)
{
    ritz_norm whole = {0}, error = {0};
    int64_t decoupled = 0;
    double two = 0.0, part = 0.0;

    RITZ_CHECK(ritz_space_norm_two(rod, 8, &two, &part));
    return ritz_norm_infinity_sparse(rod, small, 1e-6, &decoupled, &whole,
                                     &error);
}

static void every_allocation_may_fail(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0}, small = {0};

    assert_ok(spaces_rod(8, 0.0, true, &rod));
    make_small(&rod, 0.05, &small);
    assert_survives_allocations(15, take_norms(&rod, &small));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(norms_are_those_of_dense_models),
    cmocka_unit_test(h2_norms_need_no_small_residual),
    cmocka_unit_test(poles_at_0_are_left_out),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(norms_sparse, tests, NULL, NULL)
