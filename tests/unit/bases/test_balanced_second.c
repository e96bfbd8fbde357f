#include "testing.h"

#include "balancing.h"
#include "masses.h"
#include "matrices.h"
#include "project.h"

#include <ritz/basis.h>
#include <ritz/check.h>
#include <ritz/matrix.h>
#include <ritz/model.h>

#include <float.h>
#include <lapacke.h>

static const ritz_method *const methods[] = {&ritz_method_balanced_position,
                                             &ritz_method_balanced_velocity};

static double at(const ritz_dense *A, int64_t i, int64_t j)
{
    return ritz_dense_col(A, j)[i];
}

/* What is seen is no displacement but a velocity. */
static void see_velocities(ritz_component *component)
{
    ritz_dense C = component->io.C;

    component->io.C = component->io.Cv;
    component->io.Cv = C;
}

/*
 * One mass m on a spring: the values are |b||c|/m over 4 zeta w^3 of position
 * Gramians and, of a velocity that is seen, over 4 zeta w of velocities.
 */
static void values_of_one_mass_are_known(void **state)
{
    const double m = 2.0, k = 50.0, zeta = 0.03;
    const double w = sqrt(k / m);
    const double expected[] = {1.0 / (m * 4.0 * zeta * w * w * w),
                               1.0 / (m * 4.0 * zeta * w)};
    static const int64_t zero = 0;

    (void)state;
    for (int v = 0; v < 2; v++) {
        RITZ_OWN(ritz_component) mass = {0};
        ritz_request request = {0};
        RITZ_OWN(ritz_basis) basis = {0};

        assert_ok(masses_component(1, &m, &k, NULL, &mass));
        assert_ok(masses_io(&mass, 1, &zero, 1, &zero));
        strcpy(mass.damping, "modal 0.03");
        if (v == 1)
            see_velocities(&mass);
        request = balancing_asking(&mass, 1);
        assert_ok(ritz_basis_make(methods[v], &request, &basis));
        assert_int_equal(basis.T.ncol, 1);
        assert_int_equal(basis.columns.kind[0], RITZ_COLUMN_BALANCED);
        assert_null(basis.W.val);
        assert_near(basis.hankel[0], expected[v],
                    64 * DBL_EPSILON * expected[v]);
        assert_near(fabs(basis.T.val[0]), 1.0 / sqrt(m), 4 * DBL_EPSILON);
        assert_true(isnan(basis.bound));
    }
}

/*
 * Displacement seen where a force acts, or its velocity: the model is its own
 * dual, and what is made of it is symmetric, definite and stable.
 */
static void a_model_that_is_its_own_dual_stays_symmetric(void **state)
{
    enum { MASSES = 10, KEPT = 4 };

    (void)state;
    for (int v = 0; v < 2; v++) {
        RITZ_OWN(ritz_component) chain = {0};
        ritz_request request = {0};
        ritz_basis basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};

        balancing_chain(MASSES, false, 6, 6, "modal 0.05", &chain);
        chain.io.limit[0] = 0.25; /* a factor leaves it its own dual */
        if (v == 1)
            see_velocities(&chain);
        request = balancing_asking(&chain, KEPT);
        assert_ok(ritz_basis_make(methods[v], &request, &basis));
        assert_null(basis.W.val);
        assert_non_null(strstr(basis.remark, "left and right vectors agree"));
        assert_ok(ritz_reduce(&chain, &basis, &reduced));
        assert_int_equal(reduced.K.nrow, KEPT);
        for (int64_t j = 0; j < KEPT; j++)
            for (int64_t i = 0; i < KEPT; i++)
                assert_near(at(&reduced.M, i, j), i == j,
                            MASSES * DBL_EPSILON * 8);
        ritz_basis_free(&basis);
        /* the other half is not balanced by the same vectors */
        assert_ok(ritz_basis_make(methods[1 - v], &request, &basis));
        assert_non_null(basis.W.val);
        ritz_basis_free(&basis);
    }
}

/*
 * The same by the general way: W = L U S^-1/2 and T = Z V S^-1/2 of the
 * Gramians span the same, which is why one of them is left out.
 */
static void of_its_own_dual_left_vectors_are_right_ones(void **state)
{
    enum { MASSES = 10, KEPT = 4 };
    RITZ_OWN(ritz_component) chain = {0};
    ritz_gramians_request asked = {.component = &chain,
                                   .engine = RITZ_ENGINE_DENSE};
    RITZ_OWN(ritz_gramians) states = {0}, half = {0};
    RITZ_OWN(ritz_balanced) balanced = {0};

    (void)state;
    balancing_chain(MASSES, false, 6, 6, "modal 0.05", &chain);
    assert_ok(ritz_damping_parse(chain.damping, &asked.damping));
    assert_ok(ritz_gramians_of_component(&asked, &states));
    assert_ok(ritz_dense_new(MASSES, states.Zc.ncol, &half.Zc));
    assert_ok(ritz_dense_new(MASSES, states.Zo.ncol, &half.Zo));
    for (int64_t i = 0; i < MASSES; i++) {
        for (int64_t j = 0; j < half.Zc.ncol; j++)
            ritz_dense_col(&half.Zc, j)[i] = ritz_dense_col(&states.Zc, j)[i];
        for (int64_t j = 0; j < half.Zo.ncol; j++)
            ritz_dense_col(&half.Zo, j)[i] =
                ritz_dense_col(&states.Zo, j)[MASSES + i];
    }
    assert_ok(ritz_sparse_mul(&chain.M, &half.Zc, &half.EZc));
    assert_ok(ritz_gramians_balance(&half, KEPT, 1e-10, &balanced));
    for (int64_t k = 0; k < MASSES * KEPT; k++) /* measured: 1e-12 */
        assert_near(balanced.W.val[k], balanced.T.val[k], 1e-9);
}

/* All vectors of two sides are the whole model, of whatever half. */
static void all_vectors_give_the_whole_response(void **state)
{
    enum { MASSES = 6 };

    (void)state;
    for (int v = 0; v < 2; v++)
        for (int one_sided = 0; one_sided < 2; one_sided++) {
            RITZ_OWN(ritz_component) chain = {0};
            ritz_request request = {0};
            RITZ_OWN(ritz_basis) basis = {0};
            ritz_damping damping = {0};
            RITZ_OWN(ritz_state_space) full = {0}, made = {0};

            balancing_chain(MASSES, false, 5, 2, "modal 0.1", &chain);
            balancing_full(&chain, &full);
            request = balancing_asking(&chain, MASSES);
            request.choice.one_sided = one_sided == 1;
            assert_ok(ritz_basis_make(methods[v], &request, &basis));
            assert_int_equal(basis.T.ncol, MASSES);
            assert_int_equal(basis.W.val == NULL, one_sided);
            assert_ok(ritz_damping_parse(basis.damping, &damping));
            if (one_sided) {
                RITZ_OWN(ritz_reduced) reduced = {0};
                const ritz_state_space *states = NULL;

                assert_ok(ritz_reduce(&chain, &basis, &reduced));
                assert_ok(ritz_model_states(
                    ritz_model_of_reduced(&reduced, &damping), &made, &states));
            } else {
                assert_ok(
                    ritz_reduce_companion(&chain, &damping, &basis, &made));
            }
            /* measured: 1e-12 of 6e-3 */
            assert_near(balancing_error(&full, &made), 0.0, 1e-9 * 6e-3);
        }
}

/* Numbers between 0 and 1 in no order. */
static double next(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 33) / 2147483648.0;
}

/* Masses in a row, all numbers of which are any, heavy dampers and light. */
static void any_row(uint64_t seed, ritz_component *out)
{
    double m[8], k[8], c[8];
    int64_t n = 2 + (int64_t)(6.0 * next(&seed));
    int64_t in[2], seen[2];

    for (int64_t i = 0; i < n; i++) {
        m[i] = 0.1 + 3.0 * next(&seed);
        k[i] = 100.0 * exp(4.0 * next(&seed));
        c[i] = exp(7.0 * next(&seed) - 4.0);
    }
    for (int64_t i = 0; i < 2; i++) {
        in[i] = (int64_t)((double)n * next(&seed));
        seen[i] = (int64_t)((double)n * next(&seed));
    }
    in[1] = in[1] == in[0] ? (in[0] + 1) % n : in[1];
    seen[1] = seen[1] == seen[0] ? (seen[0] + 1) % n : seen[1];
    assert_ok(masses_component(n, m, k, c, out));
    assert_ok(masses_io(out, 2, in, 2, seen));
}

static bool is_definite(const ritz_dense *A)
{
    RITZ_OWN(ritz_dense) L = {0};
    int info = 0;

    assert_ok(ritz_dense_copy(A, &L));
    info =
        LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', (int)L.nrow, L.val, (int)L.nrow);
    return info == 0;
}

/* Of any row and any order, one side keeps K, M and D definite. */
static void one_side_keeps_definiteness(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 200; seed++) {
        RITZ_OWN(ritz_component) row = {0};
        ritz_request request = {0};
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        ritz_probe probe = {0};

        any_row(seed, &row);
        request = balancing_asking(&row, 1 + (int64_t)(seed % 3));
        request.choice.one_sided = true;
        request.choice.given = RITZ_USES_SIDES;
        assert_ok(ritz_basis_make(methods[seed % 2], &request, &basis));
        assert_null(basis.W.val);
        assert_ok(ritz_reduce(&row, &basis, &reduced));
        assert_true(is_definite(&reduced.K));
        assert_true(is_definite(&reduced.M));
        assert_true(is_definite(&reduced.D));
        assert_ok(ritz_probe_second_order(&reduced.K, &reduced.M, &reduced.D,
                                          NULL, &probe));
        assert_int_equal(probe.verdict, RITZ_STABLE);
    }
}

/*
 * Three masses between dashpots, force at the last, displacement of the first:
 * of two vectors on two sides neither balancing is stable, by SciPy too, whose
 * poles grow at 0.018 and 0.0075 of the largest; the probe says so.
 */
static void two_sides_can_be_unstable_and_the_probe_says_so(void **state)
{
    static const double m[] = {0.7, 1.9, 1.1}, k[] = {1960.0, 350.0, 710.0};
    static const double c[] = {0.5, 1.0, 24.0};
    static const double values[2][3] = {
        {7.306521e-4, 3.211695e-6, 1.457522e-6},
        {7.049561e-3, 1.452827e-4, 5.226208e-5}};
    static const double growth[] = {0.018072632647793796, 0.007518916641264639};
    static const int64_t in = 2, seen = 0;
    RITZ_OWN(ritz_component) row = {0};
    const ritz_damping none = {0};

    (void)state;
    assert_ok(masses_component(3, m, k, c, &row));
    assert_ok(masses_io(&row, 1, &in, 1, &seen));
    for (int v = 0; v < 2; v++) {
        ritz_request request = balancing_asking(&row, 2);
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_state_space) made = {0};
        ritz_probe probe = {0};

        assert_ok(ritz_basis_make(methods[v], &request, &basis));
        for (int64_t i = 0; i < 3; i++) /* as printed */
            assert_near(basis.hankel[i], values[v][i], 1e-6 * values[v][i]);
        assert_ok(ritz_reduce_companion(&row, &none, &basis, &made));
        assert_ok(ritz_probe_states(&made, &probe));
        assert_int_equal(probe.verdict, RITZ_UNSTABLE);
        /* the last value is 2e-3 of the first: measured, 1e-11 */
        assert_near(probe.pole[0] / probe.radius, growth[v], 1e-8);
    }
}

/*
 * A free chain: the rigid motion comes first, W'M T = I, and of the companion
 * its position and velocity are [0 1; 0 0] to the bit.
 */
static void rigid_motion_stands_beside(void **state)
{
    enum { MASSES = 9, KEPT = 3, ALL = KEPT + 1 };

    (void)state;
    for (int v = 0; v < 2; v++)
        for (int engine = RITZ_ENGINE_DENSE; engine <= RITZ_ENGINE_MODAL;
             engine++) {
            RITZ_OWN(ritz_component) chain = {0};
            ritz_request request = {0};
            RITZ_OWN(ritz_basis) basis = {0};
            ritz_damping damping = {0};
            RITZ_OWN(ritz_state_space) made = {0};
            RITZ_OWN(ritz_dense) MT = {0}, one = {0};

            balancing_chain(MASSES, true, 8, 1, "modal 0.05", &chain);
            request = balancing_asking(&chain, KEPT);
            request.choice.engine = (ritz_engine)engine;
            assert_ok(ritz_basis_make(methods[v], &request, &basis));
            assert_int_equal(basis.T.ncol, ALL);
            assert_int_equal(basis.columns.kind[0], RITZ_COLUMN_RIGID);
            assert_true(basis.columns.hertz[0] == 0.0);
            assert_ok(ritz_sparse_mul(&chain.M, &basis.T, &MT));
            assert_ok(ritz_dense_mul_tn(&basis.W, &MT, &one));
            for (int64_t k = 0; k < (int64_t)ALL * ALL; k++)
                assert_near(one.val[k], k % (ALL + 1) == 0, 1e-11);
            assert_ok(ritz_damping_parse(basis.damping, &damping));
            assert_ok(ritz_reduce_companion(&chain, &damping, &basis, &made));
            for (int64_t j = 0; j < (int64_t)ALL; j++) {
                assert_true(at(&made.A, ALL, j) == 0.0);
                assert_true(at(&made.A, ALL + j, 0) == 0.0);
            }
        }
}

/* A damper of negative rate, which no file holds, but D may. */
static void a_pole_that_grows_is_refused(void **state)
{
    static const double m[] = {1.0, 2.0, 1.0}, k[] = {300.0, 200.0, 100.0};
    static const double c[] = {-3.0, 1.0, 2.0};
    static const int64_t in = 2, seen = 0;
    RITZ_OWN(ritz_component) row = {0};
    ritz_request request = {0};
    ritz_basis none = {0};

    (void)state;
    assert_ok(masses_component(3, m, k, c, &row));
    assert_ok(masses_io(&row, 1, &in, 1, &seen));
    request = balancing_asking(&row, 1);
    for (int v = 0; v < 2; v++)
        assert_fails(ritz_basis_make(methods[v], &request, &none),
                     RITZ_ERR_ARGUMENT, "is not left of the axis");
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = {0};
    ritz_basis basis = {0};

    (void)state;
    balancing_chain(5, true, 4, 1, "modal 0.05", &chain);
    request = balancing_asking(&chain, 2);
    for (int one_sided = 0; one_sided < 2; one_sided++) {
        request.choice.one_sided = one_sided == 1;
        assert_survives_every_allocation(
            ritz_method_balanced_position.make(&request, &basis));
        ritz_basis_free(&basis);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(values_of_one_mass_are_known),
    cmocka_unit_test(a_model_that_is_its_own_dual_stays_symmetric),
    cmocka_unit_test(of_its_own_dual_left_vectors_are_right_ones),
    cmocka_unit_test(all_vectors_give_the_whole_response),
    cmocka_unit_test(one_side_keeps_definiteness),
    cmocka_unit_test(two_sides_can_be_unstable_and_the_probe_says_so),
    cmocka_unit_test(rigid_motion_stands_beside),
    cmocka_unit_test(a_pole_that_grows_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(balanced_second, tests, NULL, NULL)
